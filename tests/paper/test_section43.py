"""Statements of Section 4.3 judged by made-up cases."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.analysis.classify import Motion
from disc_model.analysis.spectra import Line
from disc_model.data.dataset import Missing
from disc_model.data.variables import PHASES, Outcome
from disc_model.parameters import Parameters
from tests.paper.evidence import grid
from tests.paper.known import Known, known
from workflow.paper import growth
from workflow.paper.measures import Range
from workflow.paper.model import AMBIGUOUS, FALSE, NOT_TESTED, PART, TRUE, Answer
from workflow.paper.section43 import (
    LOADS,
    SPEEDS,
    _mostly,
    bounded,
    critical_speed,
    damping_at_large_preloads,
    damping_stabilises,
    faster_and_sooner,
    growth_over_steps,
    hardly_moves,
    inplane_damping,
    only_between,
    plane,
    seen_in_section,
    soft_disc,
    softer_separates_sooner,
    stays_small,
    stays_steady,
    stick_may_vanish,
    stiff_enough,
    two_frequencies,
    undamped_separates_lower,
    wanders,
)

NAN = math.nan


def judged(*times: tuple[float, float]) -> Answer:
    """Judge the printed speed of 15 rad/s by speeds and times of first separation.

    The case of the paper separates after 100 s, and all end after 500 s.
    """
    known = {"N": 385.0, "first_separation": 100.0}
    cases = [
        {"Omega": speed, "first_separation": time, "time_reached": 500.0} for speed, time in times
    ]
    return critical_speed(known, *cases, printed=15.0, within=0.5)


@pytest.mark.parametrize(
    ("times", "verdict", "lower"),
    [
        ([(15.0, 80.0), (14.0, NAN)], TRUE, []),
        ([(15.0, 100.0), (14.0, NAN)], TRUE, []),
        ([(15.0, 120.0), (14.0, NAN)], FALSE, []),  # after the horizon
        ([(15.0, NAN), (16.0, 20.0)], FALSE, []),
        ([(16.0, 20.0), (15.0, 80.0), (14.0, 90.0)], PART, [14.0]),
        ([(15.0, 80.0), (14.0, 120.0)], TRUE, []),
        ([(15.0, 80.0), (14.6, 90.0)], TRUE, []),  # within what is printed
        ([(15.0, 80.0), (14.4, 90.0), (13.0, 100.0)], PART, [13.0, 14.4]),
        ([(15.0, 120.0), (14.0, 90.0)], FALSE, [14.0]),
        ([(15.0, 80.0), (16.0, 20.0)], TRUE, []),
    ],
)
def test_the_lowest_speed_that_separates_within_the_horizon_is_critical(
    times: list[tuple[float, float]], verdict: str, lower: list[float]
) -> None:
    found = judged(*times)
    assert found.verdict == verdict
    assert found.values["lower"] == lower
    assert found.values["never"] == sorted(speed for speed, time in times if math.isnan(time))
    known = sorted((speed, time) for speed, time in times if not math.isnan(time))
    assert found.values["rows"] == known
    assert found.values["horizon"] == 100.0
    assert found.values["end"] == 500.0


# ---- Steady motions


@pytest.mark.parametrize(
    ("late", "separates", "steady"),
    [
        (Range(395, 405), False, True),
        (Range(394.9, 405.09), False, True),  # two per cent of sampling
        (Range(394.8, 405.05), False, False),
        (Range(398, 402), False, True),  # smaller
        (Range(395, 405), True, False),
    ],
)
def test_contact_is_steady_if_its_force_has_no_wider_range_in_the_end(
    late: Range, separates: bool, steady: bool
) -> None:
    assert stays_steady(known(late=late, separates=separates)) is steady


def vibrating(
    widths: tuple[float, float] = (5.0, 1e-3), spread: float = 0.01, points: int = 1
) -> Known:
    """Return a case with ranges of force in N and of the disc in m, and points of a section."""
    force, disc = widths
    place = np.tile(np.arange(points) / max(points - 1, 1), 20)[-20:]
    samples = xr.Dataset(dict.fromkeys(("w_point", "w_point_velocity"), ("time", place)))
    return known(
        early=Range(400, 400 + force),
        late=Range(400, 400 + force),
        disc=Range(0.0, disc),
        intervals=lambda: 0.0125 * (1 + spread * np.array([1, -1] * 10)),
        samples=lambda name: samples,
        late_range=lambda name: Range(0.0, 3e-6),
    )


@pytest.mark.parametrize(
    ("case", "verdict"),
    [
        (vibrating(), TRUE),
        (vibrating((39.0, 1e-3)), TRUE),  # less than a tenth of 400 N
        (vibrating((41.0, 1e-3)), FALSE),
        (vibrating(spread=0.03), FALSE),
        (vibrating((5.0, 3.9e-3)), TRUE),  # an amplitude below the thickness
        (vibrating((5.0, 4.1e-3)), PART),
        (vibrating(points=10), TRUE),
        (vibrating(points=11), PART),
    ],
)
def test_a_vibration_is_small_by_force_intervals_disc_and_section(
    case: Known, verdict: str
) -> None:
    found = stays_small(case, share=0.1, within=0.02, last=20)
    assert found.verdict == verdict
    assert found.values["rate"] == pytest.approx(80.0)
    assert found.values["widths"] == pytest.approx((1e3 * case.disc.width, 3.0))


@pytest.mark.parametrize(
    ("stable", "verdict"),
    [
        ([True, False, True, True], TRUE),
        ([True, False, True, False], PART),  # beyond the paper's last preload
        ([True, True, True, True], FALSE),
        ([False, False, True, True], FALSE),
        ([True, False, False, True], FALSE),
    ],
)
def test_only_the_second_of_three_preloads_is_unstable(stable: list[bool], verdict: str) -> None:
    preloads = (200.0, 385.0, 510.0, 600.0)
    cases = [known({"N": N}, separates=not one) for N, one in zip(preloads, stable, strict=True)]
    found = only_between(*cases, largest=510)
    assert found.verdict == verdict
    assert [one for _, one in found.values["rows"]] == stable


@pytest.mark.parametrize(
    ("stick", "separates", "held", "verdict"),
    [
        (1.0, False, 5.0, TRUE),
        (1.0, False, 6.0, AMBIGUOUS),  # released after 16 / 3 s
        (0.99, False, 5.0, FALSE),
        (1.0, True, 5.0, FALSE),
    ],
)
def test_a_huge_preload_holds_the_slider_until_its_spring_pulls_it_loose(
    stick: float, separates: bool, held: float, verdict: str
) -> None:
    p = Parameters(N=4e5, Omega=15)
    huge = known(parameters=p, stick_in_all=stick, separates=separates)
    found = hardly_moves(known(stick_in_all=0.5), huge, held=held)
    assert found.verdict == verdict
    released = 0.4 * 4e5 / (0.1 * 2e4 * 15)
    assert found.values["released"] == pytest.approx(released)
    assert found.values["needed"] == pytest.approx(1e-6 * 4e5 * held / released)


# ---- Damping


def test_damping_is_counted_over_all_combinations(monkeypatch: pytest.MonkeyPatch) -> None:
    """One growing cycle is not lowered from the first to the second value, another one is lost, and
    a stable one is raised. A step that ends in a stable cycle counts."""
    steps = {0.0: 0, 0.1: 1, 0.2: 2}

    def growth_of(p: Parameters) -> float:
        step = steps[round(p.c, 12)]
        if (p.N, p.Omega) == (50, 10):
            return (0.2, 0.3, 0.1)[step]
        if (p.N, p.Omega) == (600, 40):
            return (0.2, 0.1, math.nan)[step]
        if (p.N, p.Omega) == (300, 30):
            return (0.2, -0.1, -0.2)[step]
        if (p.N, p.Omega) == (125, 20):
            return (-0.3, -0.2, -0.4)[step]
        return -0.5 - 0.1 * step

    monkeypatch.setattr(growth, "growth_of", growth_of)
    found = damping_stabilises(known(), name="c", value=0.1)
    assert found.verdict == PART
    counted = {name: found.values[name] for name in ("growing", "lowered", "lost")}
    assert counted == {"growing": 4, "lowered": 3, "lost": 1}
    assert found.values["raised"] == ["125 N, 20 rad/s"]
    assert "0.2" in found.values["most"]

    monkeypatch.setattr(growth, "growth_of", lambda p: 0.1 - p.c)
    assert damping_stabilises(known(), name="c", value=0.02).verdict == TRUE
    monkeypatch.setattr(growth, "growth_of", lambda p: 0.1 + p.c)
    assert damping_stabilises(known(), name="c", value=0.02).verdict == FALSE


def plane_of(words: list[list[str]], **changes: Any) -> xr.Dataset:
    """Return a map over four preloads and three dampings, in no order."""
    axes = {"normalization": ["as_published"], "N": [200.0, 100, 300, 400], "c_p": [0.1, 0.0, 0.5]}
    rates = np.arange(12.0).reshape(4, 3)
    return grid(axes, outcome=[words], growth_rate=[rates], **changes)


def test_a_map_is_in_the_order_of_its_parameters() -> None:
    words = [["stick_slip", "separation", "stick_slip"]] + [["stick_slip"] * 3] * 2
    words.append(["separation", "stick_slip", "stick_slip"])
    found = plane(plane_of(words), "N", "c_p")
    assert found.first.tolist() == [100, 200, 300, 400]
    assert found.second.tolist() == [0, 0.1, 0.5]
    assert np.argwhere(found.separates).tolist() == [[1, 0], [3, 1]]
    assert found.growth[0].tolist() == [4, 3, 5]
    # the least second value does not separate
    assert found.newly_separating().tolist() == [False, False, False, True]
    turned = plane(plane_of(words), "c_p", "N")
    assert np.argwhere(turned.separates).tolist() == [[0, 1], [1, 3]]


@pytest.mark.parametrize(
    ("letters", "verdict", "newly", "never"),
    [
        # rows at 200, 100, 300, 400 N; columns at 0.1, 0 and 0.5 N s/m
        ("sqs sss sqs sqs", TRUE, [200, 300, 400], []),
        ("sqs sss sqs qqq", PART, [200, 300], [400]),
        ("sqs qqq sqs sqs", TRUE, [200, 300, 400], []),  # below the largest
        ("qqq qqq qqs qqq", FALSE, [], [100, 200, 400]),
        ("sss sss sss sss", FALSE, [], []),
    ],
)
def test_damping_brings_separation_where_there_was_none(
    letters: str, verdict: str, newly: list[float], never: list[float]
) -> None:
    words = [
        ["separation" if one == "s" else "stick_slip" for one in row] for row in letters.split()
    ]
    found = damping_at_large_preloads(plane_of(words), c_p=0.1)
    assert found.verdict == verdict
    assert found.values["newly"] == newly
    assert found.values["never"] == never


# ---- Stiffness


@pytest.mark.parametrize(
    ("rates", "verdict", "counts"),
    [
        ([[0.4, 0.3, 0.2, 0.1]], TRUE, (3, 3, 0)),
        ([[0.4, 0.3, 0.2, -0.1], [-1, 0.3, 0.2, 0.1]], TRUE, (5, 5, 1)),
        ([[0.4, 0.2, 0.3, 0.1]], PART, (2, 3, 0)),
        ([[0.4, 0.2, NAN, 0.3], [0.1, 0.2, -0.1, -0.2]], PART, (2, 3, 1)),
        ([[0.4, 0.1, 0.2, NAN]], FALSE, (1, 2, 0)),  # half of the steps
        ([[0.1, 0.2, 0.3, 0.4]], FALSE, (0, 3, 0)),
    ],
)
def test_growth_falls_over_steps_from_growing_cycles(
    rates: list[list[float]], verdict: str, counts: tuple[int, int, int]
) -> None:
    """Steps from a growing to a stable cycle used to be left out, and lost cycles to be skipped."""
    found = growth_over_steps(stiffened(rates), name="k_p", larger=True)
    assert found.verdict == verdict
    assert [found.values[name] for name in ("holds", "counted", "stable")] == [*counts]
    # the same steps from large to small values: growth rises in the others
    backwards = stiffened([row[::-1] for row in rates])
    turned = growth_over_steps(backwards, name="k_p", larger=False)
    assert turned.values["counted"] == counts[1]
    assert turned.values["holds"] == counts[1] - counts[0]
    with pytest.raises(Missing, match="has no growing cycle"):
        growth_over_steps(stiffened((-np.abs(rates)).tolist()), name="k_p", larger=True)


def stiffened(rates: list[list[float]]) -> xr.Dataset:
    """Return a map of growth rates over speeds and four in-plane stiffnesses."""
    axes = {
        "normalization": ["as_published"],
        "Omega": 10.0 * np.arange(1, len(rates) + 1),
        "k_p": [1e4, 2e4, 3e4, 4e4],
    }
    return grid(axes, growth_rate=[rates])


def test_springs_are_told_in_kilonewtons_and_separate_again_in_groups() -> None:
    axes = {
        "normalization": ["as_published"],
        "Omega": [10.0, 11, 12, 13, 14],
        "k": [1e4, 2e4, 3e4],
    }
    letters = ("sqq", "qqs", "qsq", "sss", "qqs")
    words = [["separation" if one == "s" else "stick_slip" for one in row] for row in letters]
    study = grid(axes, outcome=[words], growth_rate=[np.zeros((5, 3))])
    cases = [known({"k": 1e4, "first_separation": 5.0}), known({"k": 5e4, "first_separation": 9.0})]
    found = softer_separates_sooner(*cases, study)
    assert found.verdict == PART
    assert found.values["returns"] == [(11, 12), (14, 14)]
    assert found.values["rows"] == [(10.0, "so long"), (50.0, "so long")]
    assert softer_separates_sooner(*cases[::-1], study).verdict == FALSE
    assert softer_separates_sooner(*cases, study.isel(Omega=[0, 3])).verdict == TRUE


def test_a_stiffness_is_enough_if_all_combinations_are_stable(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Cycles grow at 50 N below 30 kN/m; sliding, where there is no cycle, below 20 kN/m."""

    def growth_of(p: Parameters) -> float:
        if p.N == 600:
            return math.nan
        if p.N == 50 and p.k_p < 30e3:
            return 0.1
        return -0.1

    monkeypatch.setattr(growth, "growth_of", growth_of)
    monkeypatch.setattr(growth, "sliding_growth", lambda p: 0.1 if p.k_p < 20e3 else -0.1)
    size = len(LOADS) * len(SPEEDS)
    enough = {"name": "k_p", "larger": [30, 50]}
    found = stiff_enough(known(parameters=Parameters(N=1, Omega=1, k_p=30e3)), **enough)
    assert found.verdict == TRUE
    assert found.values["stable"] == size
    assert found.values["more"] == [(30, size), (50, size)]
    soft = stiff_enough(known(parameters=Parameters(N=1, Omega=1, k_p=25e3)), **enough)
    assert soft.verdict == PART
    assert soft.values["stable"] == size - len(SPEEDS)
    softer = stiff_enough(known(parameters=Parameters(N=1, Omega=1, k_p=15e3)), **enough)
    assert softer.values["stable"] == size - 2 * len(SPEEDS)
    assert stiff_enough(known(separates=True), **enough).verdict == FALSE


@pytest.mark.parametrize(
    ("base", "verdict"), [((50.0, 0.3), TRUE), ((50.0, 0.1), PART), ((90.0, 0.1), FALSE)]
)
def test_the_stiffer_spring_grows_faster_and_separates_sooner(
    base: tuple[float, float], verdict: str
) -> None:
    first, rate = base
    soft = known({"k_p": 1e4, "first_separation": 80.0}, growth_rate=0.2, contact_and_growth="")
    stiff = known(
        {"first_separation": first}, growth_rate=rate, contact_and_growth="", separates=True
    )
    found = faster_and_sooner(soft, stiff)
    assert found.verdict == verdict
    assert [k_p for k_p, _ in found.values["rows"]] == [10.0, 20.0]


@pytest.mark.parametrize(
    ("widths", "separates", "cause", "verdict"),
    [
        ([30, 30, 30, 30], False, False, TRUE),
        ([30, 30, 30, 30], False, True, NOT_TESTED),
        ([30, 30, 30, 30], True, False, FALSE),
        ([19, 19, 30, 30], False, False, FALSE),  # it has not doubled
        ([30, 30, 19, 19], False, False, FALSE),  # it still grows, by more than a half
        ([30, 30, 21, 21], False, False, TRUE),
    ],
)
def test_a_soft_disc_grows_and_stays_bounded(
    widths: list[float], separates: bool, cause: bool, verdict: str
) -> None:
    """By the medians of the last and of the second last quarter: 160 s are two of four."""
    asked = []

    def last_widths(name: str, length: float, count: int) -> list[float]:
        asked.append((name, length, count))
        return widths

    case = known({"time_reached": 170.0}, last_widths=last_widths, separates=separates)
    found = soft_disc(case, factor=2, bounded=1.5, cause=cause)
    assert found.verdict == verdict
    assert asked == [("P", 20.0, 4)]
    with pytest.raises(Missing, match="ends at 70 s, 80 s are needed"):
        soft_disc(known({"time_reached": 70.0}), factor=2, bounded=1.5)


# ---- After separation


def section(separated: list[int], w: list[float]) -> xr.Dataset:
    """Return points of a section at 0, 1, 2 s and so on, of which some are separated."""
    phase = np.full(len(w), PHASES.index("slip"))
    phase[separated] = PHASES.index("separation")
    return xr.Dataset(
        {"w_point": ("time", w), "phase": ("time", phase)}, {"time": np.arange(float(len(w)))}
    )


@pytest.mark.parametrize(
    ("separated", "verdict", "lost"),
    [([3], FALSE, (-9, -9)), ([3, 4], PART, (-9, -2)), ([2, 3], FALSE, (-10, -9))],
)
def test_separations_in_a_section_lie_at_its_least_displacements(
    separated: list[int], verdict: str, lost: tuple[float, float]
) -> None:
    """After the first separation at 1.5 s, from -10 to 10 mm; the lowest tenth ends at -8 mm."""
    samples = section(separated, [-0.05, 0.05, -0.010, -0.009, -0.002, 0.010])
    case = known({"first_separation": 1.5}, samples=lambda name: samples)
    found = seen_in_section(case, share=0.1)
    assert found.verdict == verdict
    assert found.values["lost"] == pytest.approx(lost)
    assert found.values["every"] == pytest.approx((-10, 10))


def test_the_range_is_bounded_from_the_third_quarter_to_the_last() -> None:
    cases = [
        known(last_quarters=lambda name: [0.03, 0.028]),
        known(last_quarters=lambda name: [0.02, 0.03]),
    ]
    found = bounded(*cases, factor=1.1)
    assert found.verdict == TRUE
    assert found.values["widest"] == pytest.approx(30 / 28)
    assert found.values["most"] == pytest.approx(15)  # 30 mm, in thicknesses
    assert bounded(*cases, factor=1.05).verdict == PART


@pytest.mark.parametrize(
    ("stick", "in_all", "vanishes"),
    [(0.001, 0.3, True), (0.01, 0.3, True), (0.02, 0.3, False), (0.001, 0.01, False)],
)
def test_stick_vanishes_where_it_was(stick: float, in_all: float, vanishes: bool) -> None:
    case = known(stick=stick, stick_in_all=in_all)
    elsewhere = known(stick=0.0, stick_in_all=0.5, from_rest=False)
    found = stick_may_vanish(case, elsewhere, share=0.01)
    assert found.verdict == (TRUE if vanishes else FALSE)
    assert found.values["begun"] == [[("here", stick, in_all)], [("here", 0.0, 0.5)]]


def with_line(frequency: float) -> Known:
    """A case of the drive's frequency 2 Hz that slips at 10 Hz, with a line of the disc."""

    def signal(window: str, start: float, stop: float, variable: str = "w") -> Any:
        shown = 10.0 if variable == "psi" else frequency
        line = Line(shown, 1.0)
        return SimpleNamespace(lines=lambda *_, **__: [line])

    time = xr.DataArray([0.0, 1.0], dims="time")
    early = {"time": time}
    return known({"first_separation": 50.0}, drive=2.0, signal=signal, samples=lambda _: early)


@pytest.mark.parametrize(
    ("frequency", "verdict", "with_rate"), [(12.0, TRUE, 1.0), (4.0, FALSE, 0.0)]
)
def test_multiples_of_the_drive_alone_are_no_two_frequencies(
    frequency: float, verdict: str, with_rate: float
) -> None:
    """12 Hz are the rate of slip and the drive's; 4 Hz are twice the drive's alone."""
    case = with_line(frequency)
    found = two_frequencies(case, share=0.9, least=0.5)
    assert found.verdict == verdict
    assert found.values["part"] == 1.0
    assert found.values["with_rate"] == with_rate


# ---- Dampers of single cases


def at_speed(speed: float, damping: float, separates: bool) -> Known:
    """Return a case by its speed and the damping of its disc."""
    scalars = {"Omega": speed, "D_star": damping}
    contact = "lost" if separates else "kept"
    return known(scalars, separates=separates, contact=contact)


@pytest.mark.parametrize(
    ("undamped", "damped", "verdict", "lowest"),
    [
        (12.0, 14.0, TRUE, [12.0, 14.0]),
        (14.0, 14.0, FALSE, [14.0, 14.0]),
        (14.0, 12.0, FALSE, [14.0, 12.0]),
        (12.0, math.inf, TRUE, [12.0, math.inf]),
        (math.inf, math.inf, FALSE, [math.inf, math.inf]),
    ],
)
def test_the_lowest_speeds_with_and_without_damping_are_compared(
    undamped: float, damped: float, verdict: str, lowest: list[float]
) -> None:
    """Of three speeds each, of which those from a given one on separate."""
    cases = []
    for speed in (12.0, 13.0, 14.0):
        cases.append(at_speed(speed, 0.0, speed >= undamped))
        cases.append(at_speed(speed, 1e-5, speed >= damped))
    found = undamped_separates_lower(*cases)
    assert found.verdict == verdict
    assert found.values["lowest"] == lowest
    assert len(found.values["contacts"]) == 3
    assert found.values["contacts"][0].endswith(" at 12 rad/s")


@pytest.mark.parametrize(
    ("separates", "verdict"),
    [((False, True), TRUE), ((True, True), FALSE), ((False, False), FALSE)],
)
def test_in_plane_damping_makes_a_quiet_case_separate(
    separates: tuple[bool, bool], verdict: str
) -> None:
    """At one of four preloads of the map it does at 0.1 N s/m, and at one more at 0.5."""
    letters = "sqs qqs qqq sss"
    rows = letters.split()
    words = [["separation" if one == "s" else "stick_slip" for one in row] for row in rows]
    before, after = separates
    without = known(separates=before, fate="before")
    case = known({"c_p": 0.1}, separates=after, fate="after")
    found = inplane_damping(without, case, plane_of(words))
    assert found.verdict == verdict
    assert found.values["newly"] == [200]
    assert found.values["size"] == 4
    assert found.values["fates"] == ("before", "after")
    alone = inplane_damping(without, case, None)
    assert alone.verdict == verdict
    assert alone.values["newly"] == []


def test_a_period_is_told_in_turns_of_the_drive() -> None:
    """Of three releases in 0.6 s, at 5 turns a second."""
    points = xr.Dataset(
        {
            "w_point": ("time", [0.0, 1.0, 0.0, 1.0]),
            "w_point_velocity": ("time", [0.0, 1.0, 0.0, 1.0]),
        }
    )
    intervals = np.array([0.1, 0.2, 0.3, 0.1, 0.2])
    motion = Motion(Outcome.OTHER_CYCLE, 3)
    case = known(
        samples=lambda window: points,
        intervals=lambda: intervals,
        late_motion=motion,
        separates=True,
        drive=5.0,
    )
    found = wanders(case, case, last=4)
    assert found.verdict == FALSE
    assert found.values["points"] == 2
    assert found.values["turns"] == pytest.approx(3.0)
    assert found.values["near"] == "repeats after 3 releases"


@pytest.mark.parametrize(
    ("holding", "counted", "verdict"),
    [
        (20, 20, TRUE),
        (19, 20, PART),
        (11, 20, PART),
        (10, 20, FALSE),
        (0, 20, FALSE),
        (0, 0, FALSE),
    ],
)
def test_what_holds_in_more_than_half_of_the_steps_is_true_in_part(
    holding: int, counted: int, verdict: str
) -> None:
    numbers = np.arange(20)
    holds = numbers < holding
    counts = numbers < counted
    assert _mostly(holds, counts) == verdict
