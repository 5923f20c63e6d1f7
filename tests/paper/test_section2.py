"""Statements of Section 2 and of the precursor judged by made-up cases."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.disc.modes import plate_modes
from tests.paper.evidence import grid, sliding_growths
from tests.paper.known import known
from workflow.paper import measures, section2
from workflow.paper.measures import Range
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE
from workflow.paper.section2 import (
    BASE,
    additional,
    different,
    moving_load,
    moving_load_speed,
    reduced,
    slip_condition,
    survive,
    truncation,
)


def test_a_moving_load_is_critical_where_a_mode_stands_for_it() -> None:
    modes = plate_modes(BASE)
    speeds = [mode.omega / mode.diameters for mode in modes.itertuples() if mode.diameters > 0]
    assert moving_load_speed(BASE) == min(speeds)


def stopping(psi: list[float], P: list[float], **scalars: float) -> Any:
    """Return a case with these angles and contact forces where slip ends."""
    stops = xr.Dataset({"psi": ("event", psi), "P": ("event", P)})
    usual = {"c_p": 0.0, "r_0": 0.1, "mu_s": 0.4, **scalars}
    return known(usual, switches=lambda kind: stops)


@pytest.mark.parametrize(
    ("psi", "P", "held", "verdict"),
    [
        ([0.07], [400.0], 1, FALSE),  # 140 N below 160 N
        ([-0.07], [400.0], 1, FALSE),
        ([0.09], [400.0], 0, TRUE),
        ([-0.09], [400.0], 0, TRUE),
        ([0.07, 0.07], [400.0, 300.0], 1, FALSE),
    ],
)
def test_the_spring_pulls_less_than_friction_holds_where_the_slider_stops(
    psi: list[float], P: list[float], held: int, verdict: str
) -> None:
    found = slip_condition(stopping(psi, P))
    assert found.verdict == verdict
    assert found.values["held"] == held
    assert found.values["ends"] == len(psi)


def modes_case(first: float, rate: float, stick: float = 0.25) -> Any:
    return known(
        {"first_separation": first},
        rate_of=lambda kind: rate,
        phase_share=lambda phase: 0.13,
        stick=stick,
    )


@pytest.mark.parametrize(
    ("first", "rates", "verdict"),
    [
        ([54.0, 54.1, 54.1, 54.2, 54.3, 54.3], [135, 134, 134], TRUE),
        ([54.0, 54.1, 54.1, 54.2, 55.0, 54.3], [135, 134, 134], PART),
        ([54.0, 54.1, 54.1, 54.2, 54.3, 54.3], [135, 134, 120], PART),
        ([54.0, 54.1, 54.1, 54.2, 54.3, 54.3], [135, 120, 134], PART),
        ([54.0, 54.1, 54.1, 54.2, 54.3, 54.3], [120, 134, 134], FALSE),
        ([54.0, 54.1, 55.1, 54.2, 54.3, 54.3], [135, 134, 134], FALSE),
        ([54.0, 54.1, 54.1, 55.2, 54.3, 54.3], [135, 134, 134], FALSE),
        ([54.0, np.nan, 54.1, 54.2, 54.3, 54.3], [135, 134, 134], FALSE),
    ],
)
def test_more_modes_change_nothing_by_times_rates_and_shares(
    first: list[float], rates: list[float], verdict: str
) -> None:
    """Rates of those with eight diameters, and with one and two circles, beside 135/s."""
    each = [135.0, 0.0, 0.0, *rates]
    cases = [modes_case(*pair) for pair in zip(first, each, strict=True)]
    assert truncation(*cases, seconds=0.5, share=0.02).verdict == verdict


def test_stick_is_compared_as_well() -> None:
    cases = [modes_case(54.0, 135.0) for _ in range(6)]
    cases[3] = modes_case(54.0, 135.0, stick=0.3)
    found = truncation(*cases, seconds=0.5, share=0.02)
    assert found.verdict == FALSE
    assert found.values["change"] == ["change", "hardly change"]


@pytest.mark.parametrize(
    ("width", "stick", "both", "verdict"),
    [
        (0.005, 0.2, False, TRUE),  # half of the range without separation
        (0.006, 0.2, False, FALSE),
        (0.02, 0.2, False, FALSE),  # it may only be smaller
        (0.006, 0.1, False, TRUE),  # half of the stick, or twice
        (0.006, 0.4, False, TRUE),
        (0.005, 0.2, True, FALSE),
        (0.005, 0.4, True, TRUE),
    ],
)
def test_separation_changes_the_range_or_the_stick_by_a_factor(
    width: float, stick: float, both: bool, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = known(disc=Range(0.0, width), stick=stick)
    other = known(disc=Range(0.0, 0.01), stick=0.2)
    monkeypatch.setattr(measures, "pairs", lambda cases: [(case, other)])
    found = different(case, other, factor=2, both=both)
    assert found.verdict == verdict
    assert found.values["rows"] == [("here", pytest.approx(width / 0.01), stick, 0.2, width, 0.01)]


@pytest.mark.parametrize(("share", "verdict"), [(0.0, TRUE), (0.5, TRUE), (0.6, FALSE)])
def test_one_pair_of_two_differs(
    share: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = known(disc=Range(0.0, 0.001), stick=0.2)
    other = known(disc=Range(0.0, 0.01), stick=0.2)
    monkeypatch.setattr(measures, "pairs", lambda cases: [(small, other), (other, other)])
    assert different(small, other, factor=2, share=share).verdict == verdict


SLOW = 500.0
FAST = 1200.0
"""Speeds below and above that at which a moving load is critical, rad/s."""


@pytest.mark.parametrize(
    ("damped", "verdict", "counts", "slowest"),
    [
        ((0.3, 0.3, 0.6), TRUE, (2, 2, 1), SLOW),
        ((0.1, 0.3, 0.6), NOT_COMPUTED, (2, 1, 1), FAST),
        ((0.1, 0.1, 0.6), FALSE, (2, 0, 1), np.inf),
    ],
)
def test_friction_makes_speeds_unstable_and_the_damper_raises_growth_there(
    damped: tuple[float, float, float], verdict: str, counts: tuple[int, int, int], slowest: float
) -> None:
    """Growth at 0.2/s with friction alone where it is stable without."""
    table = sliding_growths(
        (SLOW, -1.0, 0.2, damped[0]), (FAST, -1.0, 0.2, damped[1]), (1500.0, 0.5, 0.5, damped[2])
    )
    assert SLOW < moving_load_speed(BASE) < FAST
    found = additional(precursor=table)
    assert found.verdict == verdict
    assert found.values["counts"] == counts
    assert found.values["slowest"] == slowest


@pytest.mark.parametrize(
    ("both", "verdict", "counts"),
    [
        ((-0.1, 0.4), TRUE, (2, 1, 2)),
        ((0.4, 0.4), NOT_COMPUTED, (2, 0, 2)),
        ((0.4, 0.6), NOT_COMPUTED, (2, 0, 1)),
        ((0.6, 0.6), FALSE, (2, 0, 0)),
    ],
)
def test_friction_lowers_growth_where_sliding_is_unstable_without_it(
    both: tuple[float, float], verdict: str, counts: tuple[int, int, int]
) -> None:
    table = sliding_growths(
        (SLOW, -1.0, 0.2, 0.3), (FAST, 0.5, both[0], 0.0), (1500.0, 0.5, both[1], 0.0)
    )
    found = reduced(precursor=table)
    assert found.verdict == verdict
    assert found.values["counts"] == counts
    assert found.values["size"] == 3


def test_a_wrong_critical_speed_may_be_that_of_the_next_number_of_diameters() -> None:
    modes = plate_modes(BASE)
    speeds = [mode.omega / (mode.diameters + 1) for mode in modes.itertuples()]
    critical = moving_load_speed(BASE)
    wrong = moving_load(printed=0.5 * critical, within=1.0)
    assert wrong.verdict == FALSE
    assert wrong.values["ours"] == critical
    assert wrong.values["shifted"] == pytest.approx(min(speeds))
    right = moving_load(printed=critical + 0.5, within=1.0)
    assert right.verdict == TRUE
    assert right.values["shifted"] == ""


@pytest.mark.parametrize(
    ("lowest", "verdict"), [((10.0, 10.0), TRUE), ((10.0, 2000.0), PART), ((2000.0, 2000.0), FALSE)]
)
def test_separating_cases_are_counted_with_both_sets_of_modes(
    lowest: tuple[float, float], verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of four, one separates with normalised modes, one grows, and two are quiet."""
    norms = ["as_published", "orthonormal"]
    later = ["separation", "growing", "stick_slip", "stick_slip"]
    points = {}
    for number, word in enumerate(later):
        words = ["separation", word]
        points[str(number)] = grid({"normalization": norms}, {"horizon": 1000.0}, outcome=words)
    monkeypatch.setattr(section2, "separating_points", lambda maps: points)
    speeds = np.array([10.0, 2000.0])
    planes = []
    for speed in lowest:
        planes.append([["separation" if each >= speed else "stick_slip"] for each in speeds])
    axes = {"normalization": norms, "Omega": speeds, "N": [300.0]}
    plane = grid(axes, outcome=planes).assign_attrs(study="map_N")
    found = survive(plane, share=0.5)
    assert found.verdict == verdict
    assert found.values["counts"] == (4, 4, 1, 2, 1)
    assert found.values["until"] == Range(1000.0, 1000.0)
    assert found.values["lowest"] == list(lowest)
