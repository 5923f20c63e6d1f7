"""How many modes a study needs: for quantities of the motion, and for frequencies of the disc."""

import math
import pickle
from collections.abc import Callable
from typing import Any

import pytest

from disc_model import Disc, Parameters, choose_modes, mode_choice, steady_sliding
from disc_model.errors import DiscModelError
from disc_model.mode_choice import RICH, UndecidedModes, frequency_error
from tests.blocks import STEEL
from tests.refusals import refusal

P = Parameters(N=385.0, Omega=15.1)
RESIDUAL = P.replace(contact_compliance="residual")
Measured = Callable[[Callable[[int, int], float]], list[tuple[int, int]]]


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> Measured:
    """Puts a function of (diameters, circles) in place of the growth rate; gives the list of what
    was asked for."""

    def put(value: Callable[[int, int], float]) -> list[tuple[int, int]]:
        asked: list[tuple[int, int]] = []

        def measure(p: Parameters) -> float:
            asked.append((p.n_diameters, p.n_circles))
            return value(p.n_diameters, p.n_circles)

        monkeypatch.setitem(mode_choice.MEASURES, "growth", measure)
        return asked

    return put


def test_the_first_model_is_taken_with_which_two_larger_ones_agree(measured: Measured) -> None:
    asked = measured(lambda d, c: 1.0 + 0.1 / d**2)
    choice = choose_modes(RESIDUAL, 1e-2, quantity="growth")
    # 1 + 0.1/9 against 1 + 0.1/36: 0.8 % apart; two diameters are 1.9 % from four
    assert choice.parameters == RESIDUAL.replace(n_diameters=3, n_circles=0)
    assert choice.modes == 7
    assert choice.rich == (6, 1)
    coarse = 0.1 / 9
    fine = 0.1 / 36
    change = coarse - fine
    assert choice.error == pytest.approx(change / (1 + fine))
    assert len(asked) == len(set(asked))  # nothing is simulated twice
    assert choice == choose_modes(RESIDUAL.replace(n_diameters=12), quantity="growth")


def test_a_bar_counts_the_models(measured: Measured, capsys: pytest.CaptureFixture[str]) -> None:
    asked = measured(lambda d, c: 1.0 + 0.1 / d**2)
    choose_modes(RESIDUAL, 1e-2, quantity="growth")
    assert capsys.readouterr().err == ""
    count = len(asked)
    choose_modes(RESIDUAL, 1e-2, quantity="growth", progress=True)
    said = capsys.readouterr().err
    assert "choose_modes: 26 modes" in said  # of 6 diameters and a circle, the last
    assert f" {count} " in said
    with refusal("progress=1: must be True or False"):
        choose_modes(RESIDUAL, progress=1)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [float, lambda d: math.nan], ids=["changing", "missing"])
def test_an_undecided_choice_has_the_values_it_looked_at(
    value: Callable[[int], float], measured: Measured
) -> None:
    """They were computed and lost."""
    asked = measured(lambda d, c: value(d))
    with pytest.raises(UndecidedModes, match="n_diameters: undecided: ") as raised:
        choose_modes(P, quantity="growth")
    error = pickle.loads(pickle.dumps(raised.value))
    assert [*error.values] == asked
    assert error.values[2, 0] == pytest.approx(value(2), nan_ok=True)
    assert error.__notes__[1].startswith("growth with 2 diameters, 0 circles (5 real modes): ")


@pytest.mark.parametrize(
    ("least", "words"),
    [
        (16, "some models have a cycle and others none, among 34, 66, 99 modes; "),
        (8, "models of 34, 66, 99 modes have no cycle, and others do; "),
    ],
)
def test_models_without_a_cycle_are_told_in_words(
    least: int, words: str, measured: Measured
) -> None:
    """The growth rate changed "by inf of itself"."""
    measured(lambda d, c: math.nan if d >= least else float(d))
    with pytest.raises(UndecidedModes) as raised:
        choose_modes(P, quantity="growth")
    assert words in str(raised.value)
    assert "inf" not in str(raised.value)


def test_modes_that_grow_and_are_left_out_are_told() -> None:
    """One mode has the largest rate of all five, and the growth of two others was not mentioned."""
    disc = Disc(
        diameters=(1, 0, 2, 1, 3),
        omega=[math.tau * frequency for frequency in (551, 929, 1212, 1760, 2400)],
        amplitude=(0.556, 0.431, 0.543, 0.139, 0.5),
        tangential=(-0.268, 0, -0.129, 0.354, -0.05),
        damping_ratio=(0.001,) * 5,
    )
    case = Parameters(
        N=3000, Omega=60, k=1e6, k_p=1e6, m=0.5, mu_s=0.5, mu_k=0.35, c_p=1, r_0=0.11,
        friction_offset="surface", disc=disc,
    )  # fmt: skip
    choice = choose_modes(case, quantity="sliding_growth")
    assert steady_sliding(case).growing.size == 3
    assert steady_sliding(choice.parameters).growing.size == 1
    assert choice.growing == (1, 3)
    assert repr(choice).endswith("; with all 5 modes 3 grow, with these 1)")
    assert dict(choice.summary())["modes that grow"] == "with all 5 modes 3 grow, with these 1"


def test_growth_of_steady_sliding_converges_under_a_pad_and_not_at_a_point(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Under a pad to 3.48/s, with up to 14 diameters and 20 circles."""
    choice = choose_modes(STEEL.replace(contact_arc=0.4), quantity="sliding_growth")
    assert choice.quantity == "sliding_growth"
    found = steady_sliding(choice.parameters).growth_rate
    assert found == pytest.approx(3.479, rel=2e-2)
    assert choice.error < 1e-2
    assert choice.growing is not None
    assert choice.growing[0] == steady_sliding(choice.parameters).growing.size
    # at a point from 1.5/s with four diameters to 134/s with 40; the largest models take half a minute
    monkeypatch.setattr(mode_choice, "LARGER", ())
    with pytest.raises(DiscModelError, match=r"sliding_growth still changes .* give contact_arc"):
        choose_modes(STEEL, quantity="sliding_growth")


@pytest.fixture
def one_grows_at_86_khz(monkeypatch: pytest.MonkeyPatch) -> None:
    """All models from 14 diameters and 3 circles on agree on a mode at 11 kHz, but a mode of one of
    them at 86.6 kHz grows faster."""

    def judged(p: Parameters, highest: float) -> tuple[float, float]:
        if (p.n_diameters, p.n_circles) == (28, 3) and highest > 86.6e3:
            return 45.0, 86.6e3
        if p.n_diameters >= 14 and p.n_circles >= 3:
            return 27.0, 11.1e3
        return float(p.n_diameters + p.n_circles), 4e3

    for place, name in enumerate(("sliding_growth", "growing_frequency")):
        monkeypatch.setattr(mode_choice, name, lambda p, top, i=place: judged(p, top)[i])


@pytest.mark.usefixtures("one_grows_at_86_khz")
def test_a_refusal_has_the_frequencies_of_modes_that_grow() -> None:
    """It said by how much the growth rate changes, and not that one mode is at 86.6 kHz."""
    with pytest.raises(UndecidedModes) as raised:
        choose_modes(STEEL.replace(contact_arc=0.35), quantity="sliding_growth")
    said = str(raised.value)
    assert "116, 228, 285 modes (27/s at 11.1 kHz, 45/s at 86.6 kHz, 27/s at 11.1 kHz)" in said
    assert "or highest_frequency, up to which growing modes are judged" in said
    [note] = [note for note in raised.value.__notes__ if "28 diameters, 3 circles" in note]
    assert note.endswith(": 45 at 86.6 kHz")
    choice = choose_modes(
        STEEL.replace(contact_arc=0.35), quantity="sliding_growth", highest_frequency="20 kHz"
    )
    assert (choice.parameters.n_diameters, choice.parameters.n_circles) == (14, 3)
    assert choice.frequencies[28, 3] == pytest.approx(11.1e3)


@pytest.mark.parametrize(("highest", "text"), [("12 kHz", "up to 12 kHz"), (900.0, "up to 900 Hz")])
def test_only_modes_up_to_a_frequency_are_judged(highest: Any, text: str) -> None:
    """There was no upper frequency to set, and none is too high for a thin plate."""
    case = STEEL.replace(contact_arc=0.4)
    choice = choose_modes(case, quantity="sliding_growth", highest_frequency=highest)
    assert dict(choice.summary())["modes judged"] == text
    assert choice.highest_frequency is not None
    limit = math.tau * choice.highest_frequency
    for frequency in choice.frequencies.values():
        assert frequency <= choice.highest_frequency

    found = steady_sliding(choice.parameters)
    judged = found.eigenvalues[abs(found.eigenvalues.imag) <= limit]
    size = (choice.parameters.n_diameters, choice.parameters.n_circles)
    assert choice.values[size] == pytest.approx(judged.real.max())
    assert choice.growing is not None
    assert choice.growing[0] == (found.growing.imag <= limit).sum()


def test_a_highest_frequency_is_that_of_modes_of_sliding() -> None:
    with refusal("highest_frequency=20000: is used with quantity='sliding_growth' only"):
        choose_modes(STEEL, highest_frequency="20 kHz")
    with refusal("highest_frequency='20 N': must be a number in Hz"):
        choose_modes(STEEL, quantity="sliding_growth", highest_frequency="20 N")


def test_a_refusal_says_which_tolerance_would_do(measured: Measured) -> None:
    """It advised a larger tolerance, and the flexibility of the modes left out to a case that has it."""
    measured(lambda d, c: 1.0 + 0.5 / d + 0.05 * c)
    with pytest.raises(UndecidedModes) as raised:
        choose_modes(P, quantity="growth")
    ways = "give the number of modes, a tolerance of {}, or contact_compliance='residual'"
    change = max(abs(1.1125 / other - 1) for other in (1.08125, 1.13125))
    enough = math.ceil(1000 * change) / 1000
    assert str(raised.value).endswith(ways.format(enough))
    assert choose_modes(P, enough, quantity="growth").error <= enough
    with pytest.raises(UndecidedModes) as raised:
        choose_modes(RESIDUAL, quantity="growth")
    assert str(raised.value).endswith(f"give the number of modes, or a tolerance of {enough}")


@pytest.mark.compiled
def test_a_disc_that_does_not_swing_has_no_first_separation() -> None:
    assert math.isnan(mode_choice.MEASURES["first_separation"](P.replace(n_diameters=-1)))


@pytest.mark.compiled
@pytest.mark.slow  # kernels of more than one block of modes, for two laws of contact
def test_residual_flexibility_needs_fewer_modes_for_growth_rate_and_first_separation() -> None:
    grows = Parameters(N=300, Omega=20, contact_compliance="residual")
    by_growth = choose_modes(grows, 1e-2, quantity="growth")
    assert by_growth.modes <= 9
    assert all(
        value == pytest.approx(0.0458, abs=5e-4)
        for size, value in by_growth.values.items()
        if size[0] >= 4
    )
    first = choose_modes(RESIDUAL, 2e-3, quantity="first_separation")
    assert first.modes <= 9
    assert first.values[first.rich] == pytest.approx(51.12, abs=0.05)
    with pytest.raises(DiscModelError, match="n_diameters: undecided: first_separation"):
        choose_modes(P, 2e-3, quantity="first_separation")


# ---- by frequencies of the disc


@pytest.mark.parametrize(
    ("normalization", "tolerance", "size"),
    [("as_published", 1e-4, (5, 3)), ("orthonormal", 1e-2, (4, 0))],
)
def test_choice_meets_the_tolerance_with_the_fewest_modes(normalization, tolerance, size):
    p = P.replace(normalization=normalization)
    choice = choose_modes(p, tolerance)
    chosen = choice.parameters
    assert (chosen.n_diameters, chosen.n_circles) == size
    assert choice.error <= tolerance
    rich = p.replace(n_diameters=RICH[0], n_circles=RICH[1])
    assert frequency_error(chosen, rich) == pytest.approx(choice.error, rel=1e-9)
    smaller = chosen.replace(n_diameters=chosen.n_diameters - 1)
    assert frequency_error(smaller, rich) > tolerance


def test_a_choice_says_for_which_speed_it_is(measured: Measured) -> None:
    """At the highest speed of interest more modes may take part."""
    measured(lambda l, c: 1.0)
    choice = choose_modes(P, quantity="growth")
    assert repr(choice) == (
        "ModeChoice(1 diameter, 0 circles (3 real modes), by growth at 15.1 rad/s, error 0)"
    )
    assert dict(choice.summary())["at"].startswith("15.1 rad/s, 385 N")
    at_rest = choose_modes(P, 1e-2)
    assert "at" not in dict(at_rest.summary()), "frequencies are those at rest"
    assert ", by frequencies, error " in repr(at_rest)
