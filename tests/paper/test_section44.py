"""Statements of Section 4.4 judged by made-up cases."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from disc_model.analysis.classify import Motion
from disc_model.analysis.spectra import Line
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from tests.paper.evidence import grid
from tests.paper.known import Known, known
from workflow.paper import paper_tables, section44
from workflow.paper.measures import Range
from workflow.paper.model import FALSE, NOT_TESTED, PART, TRUE
from workflow.paper.section44 import (
    caused_by_friction,
    close_to_natural,
    constant_by_separation,
    errs,
    explained_by_slider,
    fuzz_goes,
    fuzz_stays,
    growth_stages,
    higher,
    inplane_contribution,
    inplane_frequency,
    later_periodic,
    reattaches,
    rest_late,
    soft_enough,
    when_it_separates,
)


@pytest.mark.parametrize(
    ("first", "verdict"),
    [(54.0, TRUE), (53.5, TRUE), (54.5, TRUE), (53.4, FALSE), (54.6, FALSE), (np.nan, FALSE)],
)
def test_a_printed_time_is_right_within_some_seconds(first: float, verdict: str) -> None:
    case = known({"first_separation": first}, contact="lost")
    found = when_it_separates(case, printed=54.0, within=0.5)
    assert found.verdict == verdict
    assert found.values["contact"] == "Lost"


# ---- Lines


def with_lines(frequencies: Callable[[str, float], list[float]]) -> Known:
    """Return a case with lines of these frequencies, Hz, by window and start of a stretch."""

    def signal(window: str, start: float, stop: float) -> Any:
        found = [Line(frequency, 1.0) for frequency in frequencies(window, start)]
        return SimpleNamespace(lines=lambda **_: found)

    return known({"first_separation": 54.0}, signal=signal)


def drifting(early: float, late: float) -> Known:
    """Return a case with a line at rest and one that moves by so many Hz between the halves of the
    first ten seconds, and of those from 100 s on."""
    moved = {5.0: early, 105.0: late}
    return with_lines(lambda window, start: [60.0, 130.0 - moved.get(start, 0.0)])


@pytest.mark.parametrize(
    ("early", "late", "verdict"), [(0.5, 0.4, TRUE), (0.5, 0.1, PART), (0.1, 0.1, FALSE)]
)
def test_lines_move_between_the_halves_of_a_stretch(
    early: float, late: float, verdict: str
) -> None:
    found = rest_late(drifting(early, late), within=0.3)
    assert found.verdict == verdict
    np.testing.assert_allclose(found.values["drifts"], [(0, early), (0, late)], atol=1e-9)


@pytest.mark.parametrize(
    ("with_it", "without", "verdict"),
    [(0.1, 0.5, TRUE), (0.1, 0.1, PART), (0.5, 0.5, FALSE), (0.5, 0.1, FALSE)],
)
def test_lines_come_to_rest_by_separation_if_they_do_not_without(
    with_it: float, without: float, verdict: str
) -> None:
    pair = (drifting(0, with_it), drifting(0, without))
    found = constant_by_separation(*pair, within=0.3)
    assert found.verdict == verdict
    assert (found.values["drift"], found.values["other"]) == pytest.approx((with_it, without))


def tabled(monkeypatch: pytest.MonkeyPatch, computed: list[float], names: list[str]) -> None:
    """Let Table 2 have these frequencies in Hz and names, and f_s be 67 Hz."""
    table = pd.DataFrame({"ours_Hz": computed, "ours_is": names})
    monkeypatch.setattr(paper_tables, "table_2", lambda case: table)
    monkeypatch.setattr(paper_tables, "stick_slip_rate", lambda case: 67.0)


@pytest.mark.parametrize(
    ("second", "printed", "verdict"),
    [
        ("f_s − f_Ω", 67.2, TRUE),
        ("f_s − f_Ω", 67.4, PART),
        ("f_s", 67.2, PART),
        ("f_s", 67.4, FALSE),
    ],
)
def test_the_drive_splits_the_rate_of_stick_and_slip(
    second: str, printed: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = ["f_Ω", second, "f_s + f_Ω", "2 f_s"]
    tabled(monkeypatch, [2.4, 64.6, 69.4, 134.0], names)
    found = inplane_frequency(known(drive=2.4), printed=printed, within=0.3)
    assert found.verdict == verdict
    assert found.values["lines"] == [64.6, 69.4]
    if printed == 67.4:
        # that of the slider on its spring
        assert found.values["free"] == pytest.approx(np.sqrt(2e4 / 0.1) / (2 * np.pi))
    else:
        assert found.values["free"] == ""


@pytest.mark.parametrize(
    ("off", "far", "verdict"),
    [
        ([0.0, 0.4, -0.4, 0.1, 0.2, 0.3], 0, TRUE),
        ([0.0, 0.6, -0.6, 0.6, 0.2, 0.3], 3, PART),
        ([0.0, 0.6, -0.6, 0.6, 0.7, 0.7], 5, PART),
        ([0.6, 0.6, -0.6, 0.6, 0.7, 0.7], 6, FALSE),
    ],
)
def test_some_of_the_higher_lines_may_be_far_from_natural_frequencies(
    off: list[float], far: int, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    natural = np.array([130.0, 200.0, 270.0, 340.0])
    monkeypatch.setattr(section44, "natural_frequencies", lambda case: natural)
    near = np.array([130.0, 130, 200, 200, 270, 340]) + off
    tabled(monkeypatch, [2.4, 65.0, 70.0, *near], [""] * 9)
    found = close_to_natural(known(), within=0.5)
    assert found.verdict == verdict
    assert found.values["far"] == (far, 6)
    assert found.values["rows"][0] == f"{near[0]:.1f} Hz (130.0 Hz)"


def test_power_is_that_of_squares_of_amplitudes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines of amplitude 3 at 2 f_s, and of 1 beside combinations: nine tenths of the power."""
    tabled(monkeypatch, [], [])
    found_lines = [Line(134.2, 3.0), Line(100.0, 1.0)]
    signal = SimpleNamespace(lines=lambda **_: found_lines)
    case = known(drive=2.4, signal=lambda *_: signal)
    found = inplane_contribution(case, share=0.89)
    assert found.verdict == TRUE
    assert found.values["part"] == pytest.approx(0.9)
    assert found.values["counts"] == (1, 2)
    assert inplane_contribution(case, share=0.91).verdict == FALSE


# ---- Power and fuzz


def with_shares(shares: dict[float, float], member: str = "power_above") -> Known:
    """Return a case that separates at 54 s, with shares of power, or filled shares, by the start of
    the stretch."""

    def signal(window: str, start: float, stop: float, name: str = "w_point") -> Any:
        value = shares[start]
        if member == "power_above":
            return SimpleNamespace(power_above=lambda frequency: value)
        return SimpleNamespace(filled=value)

    return known({"first_separation": 54.0}, signal=signal)


@pytest.mark.parametrize(
    ("after", "control", "verdict"),
    [
        (2.1e-3, 1e-3, TRUE),
        (1.9e-3, 1e-3, FALSE),  # it has not doubled
        (2.1e-3, 3e-3, PART),  # without separation as well
    ],
)
def test_power_at_high_frequencies_comes_with_separation(
    after: float, control: float, verdict: str
) -> None:
    case = with_shares({50.0: 1e-3, 54.0: after})
    bilateral = with_shares({50.0: 1e-3, 54.0: control})
    options = {"windows": "zoom", "spans": [50.0, 58.0]}
    found = higher(case, bilateral, factor=2, floor=1e-4, **options)
    assert found.verdict == verdict
    assert found.values["rows"] == [("here", 1e-3, after, control, 50.0, 54.0, 58.0)]
    assert higher(case, bilateral, factor=2, floor=5e-3, **options).verdict == FALSE


@pytest.mark.parametrize(("late", "goes"), [(0.19, True), (0.21, False)])
def test_fuzz_goes_below_half_of_what_it_was(late: float, goes: bool) -> None:
    case = with_shares({38.0: 0.4, 100.0: late}, "filled")
    bilateral = with_shares({38.0: 0.4, 100.0: 0.01}, "filled")
    found = fuzz_goes(case, bilateral, share=0.5)
    assert found.verdict == (TRUE if goes else FALSE)
    assert found.values["filled"] == [0.4, late, 0.4, 0.01]


@pytest.mark.parametrize(("after", "stays"), [(0.31, True), (0.29, False)])
def test_fuzz_stays_for_four_seconds_after_separation(after: float, stays: bool) -> None:
    case = with_shares({50.0: 0.4, 54.0: after}, "filled")
    found = fuzz_stays(case, case, share=0.75)
    assert found.verdict == (TRUE if stays else FALSE)


@pytest.mark.parametrize(
    ("disc", "slider", "verdict"),
    [
        ((0.1, 0.4), (0.1, 0.4), NOT_TESTED),
        ((0.1, 0.4), (0.4, 0.4), FALSE),  # the slider's stays
        ((0.1, 0.1), (0.1, 0.1), NOT_TESTED),
        ((0.1, 0.4), (0.1, 0.1), FALSE),
        ((0.4, 0.4), (0.4, 0.4), FALSE),
    ],
)
def test_fuzz_goes_where_it_goes_in_the_slider_s_motion(
    disc: tuple[float, float], slider: tuple[float, float], verdict: str
) -> None:
    """In late stretches, with separation and without it."""
    pair = []
    for late_disc, late_slider in zip(disc, slider, strict=True):
        shares = {38.0: 0.4, 50.0: 0.4, 54.0: 0.4}

        def signal(
            window: str,
            start: float,
            stop: float,
            name: str,
            shares: dict[float, float] = shares,
            late: tuple[float, float] = (late_disc, late_slider),
        ) -> Any:
            if start == 100.0:
                value = late[name == "psi"]
            else:
                value = shares[start]
            return SimpleNamespace(filled=value)

        pair.append(known({"first_separation": 54.0}, signal=signal))
    assert explained_by_slider(*pair, share=0.5).verdict == verdict


# ---- Stages


@pytest.mark.parametrize(
    ("sharp", "last", "verdict"), [(0.21, 0.1, TRUE), (0.19, 0.1, FALSE), (0.21, 0.22, FALSE)]
)
def test_the_vibration_grows_slowly_then_sharply_then_slowly(
    sharp: float, last: float, verdict: str
) -> None:
    """At 0.1/s up to the half of 60 s, sharply from 45 s on."""

    def slope(name: str, start: float, stop: float) -> float:
        if stop == np.inf:
            return 0.001
        if start == 57.0:
            return last
        if start == 45.0:
            return sharp
        return 0.1

    case = known({"first_separation": 60.0, "time_reached": 100.0}, slope=slope)
    found = growth_stages(case, factor=2, least=0.05)
    assert found.verdict == verdict
    assert found.values["rates"] == pytest.approx((0.1, sharp, last, 0.001))
    assert found.values["when"] == 47.5
    assert growth_stages(case, factor=2, least=0.3).verdict == FALSE


@pytest.mark.parametrize(
    ("separates", "rate", "verdict"), [(True, -0.1, TRUE), (False, -0.1, FALSE), (True, 0.1, FALSE)]
)
def test_friction_is_the_cause_where_sliding_without_it_is_stable(
    separates: bool, rate: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def sliding_growth(p: Parameters) -> float:
        assert p.mu_s == 0
        assert p.mu_k == 0
        return rate

    monkeypatch.setattr(section44.growth_rates, "sliding_growth", sliding_growth)
    found = caused_by_friction(known(separates=separates), growth=0.0)
    assert found.verdict == verdict
    assert found.values["most"] == rate


@pytest.mark.parametrize(
    ("rate", "follows"),
    [
        (100.0, False),  # it does not change with the spring
        (200.0, True),  # as the slider on the spring alone, with the root of its stiffness
        (168.0, True),  # as the coupled mode, from 135.4 to 227.2 Hz
        (400.0, False),
    ],
)
def test_separations_follow_a_frequency_of_the_slider_on_its_spring(
    rate: float, follows: bool
) -> None:
    cases = []
    for stiffness, at in ((5e4, 100.0), (2e5, rate)):
        p = Parameters(N=400, Omega=15, k=stiffness)
        intervals = np.full(3, 1 / at)
        separations = {"separation": intervals}
        cases.append(known({"k": stiffness}, parameters=p, intervals=separations.get))
    assert section44._vertical_branch(*cases, within=0.1)["contributes"] == follows


# ---- Conclusions


def separating(begins: list[float], ends: list[float]) -> Known:
    """Return a case with these separations, which keeps its events from 90 to 100 s."""
    times = {"separation": np.array(begins), "reattachment": np.array(ends)}
    return known(kept_span=Range(90.0, 100.0), times_of=times.get)


def test_separations_end_with_contact_the_longest_of_all_cases_in_milliseconds() -> None:
    """One that begins within half a second of the end does not count."""
    long = separating([91.0, 93.0, 99.9], [91.25, 93.125])
    short = separating([95.0], [95.0625])
    found = reattaches(long, short, longest=0.5)
    assert found.verdict == TRUE
    assert found.values["cases"] == 2
    assert found.values["begins"] == 3
    assert found.values["ends"] == 3
    assert found.values["lasts"] == 250.0


def test_a_separation_that_goes_on_is_none_that_ends() -> None:
    short = separating([95.0], [95.0625])
    apart = separating([95.0], [])
    found = reattaches(short, apart, longest=0.5)
    assert found.verdict == PART
    assert found.values["begins"] == 2
    assert found.values["ends"] == 1
    assert found.values["lasts"] == 62.5
    alone = reattaches(apart, longest=0.5)
    assert alone.verdict == FALSE
    with pytest.raises(Missing, match="keeps no separation"):
        reattaches(separating([], []), longest=0.5)


def test_growth_without_friction_is_the_largest_of_all_cases(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rates = {20.0: -0.1, 30.0: -0.3}
    monkeypatch.setattr(section44.growth_rates, "sliding_growth", lambda p: rates[p.Omega])
    cases = [
        known(separates=True, parameters=Parameters(N=385, Omega=20)),
        known(separates=False, parameters=Parameters(N=385, Omega=30)),
    ]
    found = caused_by_friction(*cases, growth=-0.2)
    assert found.verdict == FALSE
    assert found.values["most"] == -0.1
    both = caused_by_friction(*cases, growth=0.0)
    assert both.verdict == TRUE


QUIET = "stick_slip"
APART = "separation"


@pytest.mark.parametrize(
    ("rows", "verdict", "quiet", "softer"),
    [
        ([[QUIET, QUIET], [QUIET, APART], [APART, APART]], TRUE, [100], []),
        ([[APART, QUIET], [QUIET, QUIET], [APART, APART]], PART, [150], [100]),
        ([[QUIET, QUIET], [QUIET, QUIET], [QUIET, QUIET]], FALSE, [100, 150, 200], []),
        ([[APART, QUIET], [APART, QUIET], [APART, APART]], FALSE, [], []),
    ],
)
def test_a_disc_is_soft_enough_if_no_softer_one_separates(
    rows: list[list[str]], verdict: str, quiet: list[float], softer: list[float]
) -> None:
    """Of moduli in GPa, at two speeds."""
    axes = {"E": [1.0e11, 1.5e11, 2.0e11], "Omega": [10.0, 20.0], "normalization": ["as_published"]}
    words = np.array(rows)[..., None]
    rates = np.zeros(words.shape)
    study = grid(axes, outcome=words, growth_rate=rates)
    found = soft_enough(study, slow=10.0)
    assert found.verdict == verdict
    assert found.values["quiet"] == pytest.approx(quiet)
    assert found.values["softer"] == pytest.approx(softer)


def test_a_late_motion_without_separation_is_told_if_it_repeats() -> None:
    span = Range(90.0, 100.0)
    repeats = Motion(Outcome.OTHER_CYCLE, 3)
    wanders = Motion(Outcome.QUASI_PERIODIC)
    periodic = known(late_motion=repeats, motion="it repeats", kept_span=span)
    torus = known(late_motion=wanders, motion="it does not", kept_span=span)
    both = later_periodic(periodic, periodic)
    assert both.verdict == TRUE
    assert both.values["other"] == "it repeats"
    without = later_periodic(periodic, torus)
    assert without.values["other"] == ""
    assert later_periodic(torus, periodic).verdict == FALSE


def test_a_rise_below_the_floor_is_none_without_separation_either() -> None:
    """Of five times, from a hundred-thousandth."""
    case = with_shares({50.0: 1e-3, 54.0: 5e-3})
    bilateral = with_shares({50.0: 1e-5, 54.0: 5e-5})
    options = {"windows": "zoom", "spans": [50.0, 58.0]}
    found = higher(case, bilateral, factor=2, floor=1e-4, **options)
    assert found.verdict == TRUE


@pytest.mark.parametrize(
    ("chance", "apart", "verdict"), [(4e-4, 0.2, TRUE), (6e-4, 0.2, FALSE), (4e-4, 0.6, FALSE)]
)
def test_lines_are_found_unless_noise_has_one_of_them(
    chance: float, apart: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The chances of two lines add up."""
    table = pd.DataFrame(
        {
            "ours_Hz": [65.0, 70.0 - apart],
            "paper_Hz": [65.0, 70.0],
            "ours_is": ["1 f_s", paper_tables.UNNAMED],
        }
    )
    both = [Line(65.0, 1.0), Line(70.0, 1.0)]
    monkeypatch.setattr(paper_tables, "table_2_lines", lambda case: both)
    monkeypatch.setattr(paper_tables, "table_2", lambda case: table)
    monkeypatch.setattr(paper_tables, "stick_slip_rate", lambda case: 67.0)
    monkeypatch.setattr(section44.signals, "chance", lambda *_: chance)
    samples = SimpleNamespace(time=None, values=None)
    case = known(signal=lambda *_: samples)
    found = section44.lines(case, bound=0.5)
    assert found.verdict == verdict
    assert found.values["named"] == 1
    assert found.values["off"] == pytest.approx(apart)
    assert found.values["rate"] == 67.0


def test_growth_needs_twenty_seconds_on_both_sides_of_the_separation() -> None:
    usual = {"first_separation": 20.0, "time_reached": 40.0}
    case = known(usual, slope=lambda *_: 0.1)
    found = growth_stages(case, factor=2, least=0.05)
    assert found.verdict == FALSE
    for name, value in (("first_separation", 19.9), ("time_reached", 39.9)):
        short = known({**usual, name: value}, slope=lambda *_: 0.1)
        with pytest.raises(Missing, match="does not run for 20 s both before and after"):
            growth_stages(short, factor=2, least=0.05)


def with_ranges(disc: float, psi: float) -> Known:
    """Return a case with ranges of its disc and of the slider in the plane."""
    ranges = {"psi": Range(0.0, psi)}
    return known(disc=Range(0.0, disc), late_range=ranges.get)


def test_errors_without_separation_are_counted_on_both_sides_and_on_both_discs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of ranges that are twice and half as large, and equal ones."""
    usual = with_ranges(1.0, 1.0)
    pairs = [
        (usual, with_ranges(2.0, 0.5)),
        (usual, with_ranges(1.0, 2.0)),
        (usual, with_ranges(1.1, 0.5)),
    ]
    monkeypatch.setattr(section44.measures, "pairs", lambda cases: pairs)
    axes = {
        "disc": ["surface"],
        "contact": ["unilateral", "bilateral"],
        "Omega": [10.0, 20.0, 30.0, 40.0],
    }
    tops = [[1.0, 1.0, 1.0, 1.0], [2.0, 0.5, 2.0, 9.0]]
    words = [
        ["separation", "separation", "separation", "stick_slip"],
        ["growing", "stick_slip", "growing", "growing"],
    ]
    study = grid(
        axes, {"after_separation": 5.0}, u_max=[tops], u_min=np.zeros((1, 2, 4)), outcome=[words]
    )
    found = errs(study, within=0.2, share=0.5)
    assert found.verdict == TRUE
    values = found.values
    assert values["wider"] == (1, 3)
    assert values["narrower"] == (0, 3)
    assert values["more"] == (1, 3)
    assert values["less"] == (2, 3)
    assert values["brake"] == (2, 1)
    assert values["of"] == 3
    assert values["kept"] == 1
    assert values["unsettled"] == 2
    assert values["after"] == 5.0
