"""Statements of Section 4.1 and 4.2 judged by made-up studies and cases."""

import math
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.parameters import Parameters
from tests.paper.evidence import grid
from tests.paper.known import Known, known
from workflow.paper import judging_tables, section41
from workflow.paper.measures import SEPARATION, Absent, Range
from workflow.paper.model import AMBIGUOUS, FALSE, PART, TRUE
from workflow.paper.section2 import BASE, moving_load_speed
from workflow.paper.section41 import (
    both_at_low_speed,
    bounded_by_separation,
    bracketed,
    excites_less,
    falls_then_rises,
    far_below,
    force_grows_to_zero,
    keeps_sticking,
    maintained_below,
    preload_closes,
    quiet,
    releases_regularly,
    separations_are_short,
    smaller_range,
    upward,
)

NAN = math.nan


def critical_speeds(*speeds: float) -> xr.Dataset:
    """Return critical speeds at preloads of 100 N, 200 N and so on, for two horizons.

    That of the shorter one is 5 rad/s higher.
    """
    preloads = 100.0 * np.arange(1, len(speeds) + 1)
    both = np.array(speeds)[:, None] + [5.0, 0.0]
    axes = {"normalization": ["as_published"], "N": preloads, "horizon": [10.0, 1000.0]}
    return grid(axes, status=[["ok"] * len(speeds)], critical_speed=[both])


def sweeps(up: list[float], down: list[float], persisting: bool = False) -> xr.Dataset:
    """Return speeds at which separation begins and ends on sweeps from 12 rad/s on; it may persist
    on all ways down."""
    axes = {
        "normalization": ["as_published"],
        "N": 100.0 * np.arange(1, len(up) + 1),
        "direction": ["up", "down"],
        "sweep_Omega": [12.0, 22.0],
    }
    rates = np.zeros((1, len(up), 2, 2))
    if persisting:
        rates[:, :, 1] = 9.0
    return grid(axes, onset_speed=[up], offset_speed=[down], separation_rate=rates)


def test_a_sweep_that_separates_down_to_its_lowest_speed_does_so_below_the_critical_speed() -> None:
    """No speed is known at which it ends then."""
    study = sweeps([15.5, 21.0], [NAN, NAN], persisting=True)
    found = maintained_below(critical_speeds(15.0, 20.0), study, None, within=0.1)
    assert found.verdict == PART
    assert found.values["below"] == [(100.0, 15.5, 12.0, 15.0), (200.0, 21.0, 12.0, 20.0)]


@pytest.mark.parametrize(
    ("up", "down", "below"),
    [
        (15.5, 14.0, True),  # it persists on the way down
        (14.0, 15.5, True),
        (14.0, 14.0, True),
        (15.5, 15.5, False),
        (14.95, 14.95, False),  # no more than speeds are known to
        (15.5, 14.95, False),
        (15.5, 14.85, True),
        (NAN, NAN, False),
    ],
)
def test_a_sweep_in_either_direction_may_separate_below_the_critical_speed(
    up: float, down: float, below: bool
) -> None:
    found = maintained_below(
        critical_speeds(15.0, 20.0), sweeps([up, 21.0], [down, 20.5]), None, within=0.1
    )
    verdict = TRUE
    if below:
        verdict = PART
    assert found.verdict == verdict
    rows = []
    if below:
        rows = [(100.0, up, down, 15.0)]
    assert found.values["below"] == rows


def basins(share: float, undecided: int = 0) -> xr.Dataset:
    """Return a study of 30 kicks of up to 2 J, of which some are undecided, and of the others a share
    separates at 15 rad/s."""
    axes = {
        "normalization": ["as_published"],
        "Omega": [14.0, 15.0],
        "energy": [0.5, 1.0, 2.0],
        "start": np.arange(10),
    }
    kinds = ["undecided"] * undecided + ["stick_slip"] * (30 - undecided)
    both_speeds = np.reshape(2 * kinds, (1, 2, 3, 10))
    return grid(axes, separating_fraction=[[0.9, share]], kind=both_speeds)


def test_kicks_that_separate_are_counted() -> None:
    speeds = critical_speeds(15.0)
    found = maintained_below(speeds, None, basins(0.2), within=0.1)
    assert found.verdict == PART
    assert found.values["kicks"] == (6, 30, (0.5, 2.0))
    assert maintained_below(speeds, None, basins(0.0), within=0.1).verdict == TRUE
    some_undecided = maintained_below(speeds, None, basins(0.25, undecided=6), within=0.1)
    assert some_undecided.values["kicks"] == (6, 30, (0.5, 2.0))
    all_undecided = maintained_below(speeds, None, basins(NAN, undecided=30), within=0.1)
    assert all_undecided.verdict == TRUE
    assert maintained_below(speeds, None, None, within=0.1).verdict == TRUE


def test_without_any_separation_there_is_no_critical_speed() -> None:
    assert maintained_below(critical_speeds(NAN, NAN), None, None, within=0.1).verdict == FALSE


FALLS_AND_RISES = [30.0, 20.0, 12.0, NAN]
FALLS_AGAIN = [30.0, 12.0, 20.0, 14.0]
FALLS_ONLY = [30.0, 20.0, 14.0, 12.0]


@pytest.mark.parametrize(
    ("soon", "late", "verdict"),
    [
        (FALLS_AND_RISES, FALLS_AND_RISES, TRUE),
        (FALLS_AND_RISES, FALLS_AGAIN, PART),
        (FALLS_AGAIN, FALLS_AND_RISES, TRUE),
        (FALLS_ONLY, FALLS_AND_RISES, FALSE),
        (FALLS_AND_RISES, FALLS_ONLY, FALSE),
    ],
)
def test_lowest_speeds_are_judged_within_the_longest_time_unless_one_refutes_all(
    soon: list[float], late: list[float], verdict: str
) -> None:
    axes = {
        "normalization": ["as_published"],
        "N": [50.0, 100.0, 200.0, 385.0],
        "horizon": [10.0, 1000.0],
        "scan_Omega": [5.0, 24.0],
    }
    both = np.transpose([soon, late])
    study = grid(axes, status=[["ok"] * 4], critical_speed=[both])
    assert falls_then_rises(study, depth=0.3).verdict == verdict


# ---- Cases


def test_the_force_s_range_grows_before_contact_is_lost() -> None:
    ranges = {(60.0, 80.0): Range(300.0, 520.0)}
    case = known(
        {"first_separation": 80.0},
        separates=True,
        range_of=lambda name, low, high: ranges[low, high],
    )
    assert force_grows_to_zero(case, factor=21.9).verdict == TRUE
    assert force_grows_to_zero(case, factor=22.1).verdict == FALSE
    with pytest.raises(Absent, match="no separation in 100 s"):
        force_grows_to_zero(known(), factor=2)


def separating(*velocities: float) -> Known:
    """Return a case with these velocities of the slider at its separations, m/s."""
    events = xr.Dataset({"u_velocity": ("event", np.array(velocities))})
    return known(switches=lambda kind: events)


def test_the_share_of_separations_upward_is_the_least_of_all_cases() -> None:
    cases = (separating(1.0, 2.0, -1.0, 0.5), separating(0.1, 0.2))
    assert upward(*cases, share=0.75).verdict == TRUE
    assert upward(*cases, share=0.76).verdict == FALSE
    assert upward(*cases, share=0.5).values["up"] == (75, 100)
    assert upward(separating(0.0, 1.0), share=0.5).values["up"] == (50, 50)
    with pytest.raises(Missing, match="keeps no separation"):
        upward(separating(), share=0.5)


def test_separations_are_short_beside_the_time_between_them() -> None:
    cases = [
        known(longest_separation=1e-3, rate_of=lambda kind: 135.0),
        known(longest_separation=2e-3, rate_of=lambda kind: 50.0),
    ]
    found = separations_are_short(*cases, share=0.14)
    assert found.verdict == TRUE
    assert found.values["lasts"] == pytest.approx((1, 2))
    assert found.values["parts"] == pytest.approx((0.1, 0.135))
    assert separations_are_short(*cases, share=0.13).verdict == FALSE


@pytest.mark.parametrize(
    ("height", "share", "verdict"),
    [
        (0.002, 0.79, TRUE),  # 100 N of the spring beside 400 N
        (0.002, 0.81, PART),
        (-0.004, 0.8, TRUE),  # below its length without load
        (-0.02, 0.8, FALSE),
    ],
)
def test_the_preload_is_a_share_of_what_closes_the_gap(
    height: float, share: float, verdict: str
) -> None:
    phase = [SEPARATION, SEPARATION, SEPARATION + 1 if SEPARATION == 0 else 0]
    samples = xr.Dataset(
        {"u": ("time", [height + 0.001, height - 0.001, 7.0]), "phase": ("time", phase)}
    )
    lifted = samples.assign(u=samples["u"] + 0.01)
    case = known({"u_0": 0.01}, samples=lambda name: lifted)
    found = preload_closes(case, share=share)
    assert found.verdict == verdict
    assert found.values["spring"] == pytest.approx(5e4 * height)


def test_stick_is_told_by_the_motions_that_have_settled() -> None:
    axes = {"N": [100.0, 200.0], "Omega": [10.0, 20.0]}
    study = grid(
        axes,
        settled=[["settled", "changing"], ["settled", "settled"]],
        stick_fraction=[[0.3, 0.01], [0.2, 0.5]],
    )
    found = keeps_sticking(known(stick=0.4), known(stick=0.25), study, share=0.19)
    assert found.verdict == AMBIGUOUS
    assert found.values["sticks"] == ["40 % at here", "25 % at here"]
    assert found.values["extent"] == pytest.approx((20, 50))
    assert found.values["settled"] == 3
    assert found.values["size"] == 4
    assert keeps_sticking(known(stick=0.4), study, share=0.2).verdict == FALSE
    assert keeps_sticking(known(stick=0.15), study, share=0.19).verdict == FALSE


def test_intervals_between_releases_spread_by_a_share_of_their_mean() -> None:
    case = known(intervals=lambda: 0.0125 * np.array([0.99, 1.01] * 10))
    found = releases_regularly(case, within=0.0101)
    assert found.verdict == TRUE
    assert found.values["rows"] == [("here", pytest.approx(12.5), pytest.approx(0.01))]
    assert releases_regularly(case, within=0.0099).verdict == FALSE
    wide = known(intervals=lambda: 0.0125 * np.array([0.9, 1.1] * 10))
    assert releases_regularly(case, wide, within=0.0101).verdict == PART


@pytest.mark.parametrize(
    ("supplied", "pulls", "verdict"),
    [
        (0.6, -1.0, AMBIGUOUS),  # the negative force takes energy
        (0.8, -1.0, AMBIGUOUS),  # nothing is withheld, either
        (0.8, 1.0, AMBIGUOUS),
        (0.6, 1.0, TRUE),
    ],
)
def test_excitation_is_withheld_over_periods_and_while_the_force_is_negative(
    supplied: float, pulls: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The words were cut off before those on the negative force, and judged by the first reading.

    Without separation 0.8 mJ are supplied, of which 0.3 mJ are gained; half of them decide.
    """
    table = pd.DataFrame({"case": ["free"]})
    table[judging_tables.ENERGIES] = [supplied, 0.8, 0.3, 0.0, 0.3]
    table[judging_tables.POWERS] = [4.0, pulls]
    table[judging_tables.COMPLIANT] = [0.75 * supplied, 0.6 * supplied, 0.8 * supplied]
    pair = [known(name="free"), known(name="kept")]
    monkeypatch.setattr(section41, "pairs", lambda _: [pair])
    found = excites_less(*pair, energies=table, share=0.5)
    assert found.verdict == verdict
    assert found.values["by_sign"] == [("here", 4.0, pulls)]
    assert found.values["least_less"] == pytest.approx(0.2)
    assert found.values["most_less"] == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({}, TRUE),
        ({"late": Range(380, 421)}, FALSE),  # more than a tenth of 400 N
        ({"early": Range(380, 421), "late": Range(380, 418)}, FALSE),
        ({"late": Range(380, 392)}, FALSE),  # risen by more than 1 N
        ({"late": Range(380, 390.9)}, TRUE),
        ({"disc": Range(0.0, 0.0223)}, FALSE),  # 20 mm, within a tenth
        ({"disc": Range(0.0, 0.0217)}, TRUE),
        ({"disc": Range(0.0, 0.0177)}, FALSE),
        ({"separates": True}, FALSE),
        ({"under": 0.0021}, FALSE),  # more than the thickness
    ],
)
def test_a_disc_is_quiet_by_force_and_range(changes: dict[str, Any], verdict: str) -> None:
    usual: dict[str, Any] = {
        "early": Range(380, 390),
        "late": Range(380, 390),
        "disc": Range(0.0, 0.02),
        "under": 0.0001,
    }
    members = {**usual, **changes}
    under = members.pop("under")
    case = known(
        {"h": 0.03 if under < 0.001 else 0.002},
        range_of=lambda *_: Range(0.0, 0.02),
        late_range=lambda name: Range(0.0, under),
        **members,
    )
    found = quiet(case, share=0.1, newtons=1.0, within=0.1)
    assert found.verdict == verdict
    widths = (20.0, 1e3 * case.disc.width, 1e3 * under)
    assert found.values["widths"] == pytest.approx(widths)


def test_a_quiet_disc_may_move_through_more_than_its_thickness() -> None:
    case = known(
        {"h": 0.002},
        disc=Range(0.0, 0.002),
        range_of=lambda *_: Range(0.0, 0.002),
        late_range=lambda name: Range(0.0, 1e-4),
    )
    assert quiet(case, share=0.1, newtons=1.0, within=0.1).verdict == PART


def test_parameters_are_named_of_which_a_thousandth_decides() -> None:
    """A thousandth more of k makes the first case separate, one of mu_s keeps the second."""
    first = {
        ("below", "k"): 50.0,
        ("below", "mu_s"): NAN,
        ("above", "k"): 60.0,
        ("above", "mu_s"): NAN,
    }
    rows = [(*names, time) for names, time in first.items()]
    table = pd.DataFrame(rows, columns=["case", "parameter", "first_s"])
    below = known({"Omega": 14.0}, name="below")
    above = known({"Omega": 16.0}, name="above", separates=True)
    found = bracketed(below, above, small_changes=table)
    assert found.verdict == TRUE
    assert found.values["lost"] == [["k"], ["mu_s"]]
    assert found.values["speeds"] == (14, 16)
    calm = known({"Omega": 16.0}, name="above", separates=False)
    assert bracketed(below, calm, small_changes=table).verdict == FALSE


def test_a_case_separates_far_below_the_speed_of_a_moving_load() -> None:
    """At a tenth of it, and not at a fifth."""
    critical = moving_load_speed(Parameters(N=400, Omega=15))
    slow = known({"Omega": 0.1 * critical}, separates=True, place="slow")
    fast = known({"Omega": 0.2 * critical}, separates=True, place="fast")
    calm = known({"Omega": 0.05 * critical}, separates=False)
    found = far_below(slow, fast, calm, share=0.15)
    assert found.verdict == TRUE
    assert found.values["rows"] == [("slow", pytest.approx(0.1))]
    assert far_below(fast, calm, share=0.15).verdict == FALSE


@pytest.mark.parametrize(
    ("rates", "words", "verdict"),
    [
        ([0.1, -0.1, 0.2], ["separation", "stick_slip", "stick_slip"], TRUE),
        (
            [-0.1, -0.1, 0.2],
            ["separation", "stick_slip", "stick_slip"],
            FALSE,
        ),  # grows at high speed only
        ([0.1, -0.1, 0.2], ["stick_slip", "stick_slip", "separation"], FALSE),
        ([0.1, NAN, 0.2], ["stick_slip", "separation", "stick_slip"], TRUE),
        ([0.1, NAN, 0.2], ["separation", "stick_slip", "stick_slip"], TRUE),
    ],
)
def test_growth_and_separation_are_both_found_at_low_speed(
    rates: list[float], words: list[str], verdict: str
) -> None:
    critical = moving_load_speed(BASE)
    axes = {
        "normalization": ["as_published"],
        "Omega": critical * np.array([0.05, 0.09, 0.2]),
        "N": [100.0],
    }
    study = grid(
        axes,
        growth_rate=[np.array(rates)[:, None]],
        outcome=[[[word] for word in words]],
        method=[[["simulation"], ["inferred"], ["inferred"]]],
    )
    found = both_at_low_speed(study, share=0.1)
    assert found.verdict == verdict
    grows = np.array(rates) > 0
    separates = np.array(words) == "separation"
    lost = np.isnan(rates)
    expected = [grows, separates, grows & ~separates, separates & lost]
    assert found.values["counts"] == [int(each.sum()) for each in expected]
    assert found.values["inferred"] == 2
    assert found.values["part"] == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("widths", "factor", "verdict"),
    [([2.0, 1.0], 1.5, TRUE), ([1.4, 1.0], 1.5, PART), ([1.0, 2.0], 1.5, PART)],
)
def test_without_separation_the_vibration_keeps_growing(
    widths: list[float], factor: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = known(last_widths=lambda name, length, count: widths)
    monkeypatch.setattr(section41, "pairs", lambda cases: [(cases[0], other)])
    found = bounded_by_separation(known(), factor=factor)
    assert found.verdict == verdict
    assert found.values["also"] == int(verdict == PART)
    assert found.values["of"] == 1


def test_of_two_cases_one_may_stay_bounded_without_separation(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    grows = known(last_widths=lambda name, length, count: [2.0, 1.0])
    stays = known(last_widths=lambda name, length, count: [1.0, 1.0])
    both = [(known(), grows), (known(), stays)]
    monkeypatch.setattr(section41, "pairs", lambda cases: both)
    found = bounded_by_separation(known(), known(), factor=1.5)
    assert found.verdict == PART
    assert found.values["also"] == 1
    assert found.values["of"] == 2


def ranged(width: float) -> Known:
    """Return a case whose disc has a range in m."""
    return known(disc=Range(0.0, width))


@pytest.mark.parametrize(("shown", "verdict"), [(1, TRUE), (2, FALSE)])
def test_ranges_are_compared_in_the_cases_that_the_paper_shows(
    shown: int, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fifth of that without separation in the first case, and as much in another one."""
    first = (ranged(0.002), ranged(0.010))
    second = (ranged(0.010), ranged(0.010))
    monkeypatch.setattr(section41, "pairs", lambda cases: [first, second])
    found = smaller_range(known(), known(), ratio=0.5, shown=shown)
    assert found.verdict == verdict
    parts = [row[1] for row in found.values["rows"]]
    assert parts == pytest.approx([0.2, 1.0])


def test_without_a_preload_nothing_but_the_spring_closes_the_gap() -> None:
    samples = xr.Dataset({"u": ("time", [0.002]), "phase": ("time", [SEPARATION])})
    case = known({"N": 0.0}, samples=lambda name: samples)
    found = preload_closes(case, share=0.5)
    assert found.verdict == FALSE
    assert found.values["part"] == 0
