"""Numbers and summaries in words."""

from disc_model import Parameters
from disc_model.display import rounded_text
from disc_model.mode_choice import ModeChoice

P = Parameters(N=385, Omega=15)


def test_a_choice_of_modes_is_shown() -> None:
    found = ModeChoice(P.replace(n_diameters=6, n_circles=1), "growth", 1e-2, 0.004, (12, 2))
    assert repr(found).startswith(
        "ModeChoice(6 diameters, 1 circle: 26 real modes, by growth at 15"
    )
    assert dict(found.summary())["error"] == "0.004, relative; 0.01 was asked for"


def test_numbers_below_a_million_are_written_out() -> None:
    """A standard deviation of 120 was "1.2e+02"."""
    assert [rounded_text(each, 2) for each in (123.4, 0.0123, -98765.0, 4.5e8)] == [
        "120",
        "0.012",
        "-99000",
        "4.5e+08",
    ]
