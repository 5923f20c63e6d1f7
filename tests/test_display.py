"""Numbers and summaries in words."""

from disc_model import Parameters
from disc_model.display import rounded_text
from disc_model.mode_choice import ModeChoice

P = Parameters(N=385, Omega=15)


def test_a_choice_of_modes_is_shown_with_what_it_was_compared_with() -> None:
    found = ModeChoice(
        parameters=P.replace(n_diameters=6, n_circles=1),
        tolerance=1e-2,
        error=0.004,
        modes=26,
        rich=(8, 1),
        quantity="growth",
        values={(4, 0): -0.1, (8, 1): -0.125},
    )
    assert repr(found).startswith("ModeChoice(6 diameters, 1 circle (26 real modes), by growth")
    assert dict(found.summary()) == {
        "n_diameters": "6",
        "n_circles": "1",
        "modes": "26, a pair counts as two",
        "chosen by": "growth",
        "at": "15 rad/s, 385 N; other speeds may need more modes",
        "error": "0.004, relative; 0.01 was asked for",
        "largest model compared": "8 diameters, 1 circle",
        "highest mode": "waves of 33.4 thicknesses, frequency of a thin plate 0.6 % too high",
        "growth with 4 diameters, 0 circles": "-0.1",
        "growth with 8 diameters, 1 circle": "-0.125",
    }


def test_numbers_below_a_million_are_written_out() -> None:
    """A standard deviation of 120 was "1.2e+02"."""
    assert [rounded_text(each, 2) for each in (123.4, 0.0123, -98765.0, 4.5e8)] == [
        "120",
        "0.012",
        "-99000",
        "4.5e+08",
    ]
