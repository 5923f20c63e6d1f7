"""Crossings of Campbell diagrams beside gaps and ends of the scan, and the steps that resolve them."""

import numpy as np
import pytest

from disc_model.studies.quantities.campbell import Campbell
from tests.studies.quantities.test_campbell import effects, found_crossings, made_up

SPEEDS = np.linspace(8, 12, 401)
MEETING = 10.0  # rad/s, where the stick-slip frequency meets the mode in `made_up`


def without(missing: np.ndarray) -> dict[str, np.ndarray]:
    """Changes of a made-up study that has no cycle at some speeds."""
    peak = made_up()
    lost = {}
    for name in ("growth_rate", "stick_slip_frequency"):
        lost[name] = np.where(missing, np.nan, peak[name].values)
    return lost


def test_no_crossing_lies_within_a_gap() -> None:
    """It was interpolated, and its speed depended on the ends of the gap."""
    gap = np.abs(SPEEDS - MEETING) < 0.055
    assert Campbell().summarise(made_up(**without(gap)))["n_crossings"] == 0


def test_no_crossing_lies_where_the_motion_is_not_near_the_cycle() -> None:
    gap = np.abs(SPEEDS - MEETING) < 0.055
    away = made_up(near_motion=np.where(gap, 0.0, np.nan))
    assert Campbell().summarise(away)["n_crossings"] == 0


@pytest.mark.parametrize("gap", [MEETING + 0.05, MEETING - 0.05])
def test_a_crossing_beside_a_gap_in_its_window_has_no_cycle(gap: float) -> None:
    lost = np.abs(SPEEDS - gap) < 0.015
    assert effects(made_up(**without(lost))) == ["no_cycle"]


@pytest.mark.parametrize("beyond", [SPEEDS > MEETING + 0.001, SPEEDS < MEETING - 0.001])
def test_a_crossing_at_the_last_speed_before_a_gap_is_found(beyond: np.ndarray) -> None:
    at_last = made_up(**without(beyond))
    at_last["stick_slip_frequency"][200] = 100.0
    [crossing] = found_crossings(at_last)
    assert crossing[0] == pytest.approx(MEETING)


def test_the_drive_meets_modes_without_a_cycle() -> None:
    """Its frequency is known there; growth rates of the cycle are not."""
    everywhere = SPEEDS > 0
    turning = made_up(rotation_frequency=10 * SPEEDS, **without(everywhere))
    [crossing] = found_crossings(turning)
    assert crossing[3] == "rotation"
    assert effects(turning) == ["no_cycle"]


@pytest.mark.parametrize("part", [slice(195, 401), slice(0, 206)])
def test_a_window_that_leaves_the_scan_has_a_word_of_its_own(part: slice) -> None:
    """It was "unresolved", and stayed so at any step."""
    half = made_up().isel(Omega=part)
    assert effects(half) == ["beyond_scan"]
    assert effects(half.isel(Omega=slice(1, None, 2))) == ["beyond_scan"]


def test_a_gap_is_known_in_a_window_that_leaves_the_scan() -> None:
    """No wider scan helps there."""
    gap = np.abs(SPEEDS - MEETING - 0.05) < 0.015
    half = made_up(**without(gap)).isel(Omega=slice(195, 401))
    assert effects(half) == ["no_cycle"]


def test_the_step_of_a_crossing_resolves_it() -> None:
    """The window is 0.2 rad/s wide."""
    coarse = made_up().isel(Omega=slice(5, 401, 20))
    found = Campbell().summarise(coarse)
    assert found["crossing_effect"] == ["unresolved"]
    [step] = found["crossing_step"]
    assert step == pytest.approx(0.2 / 3)
    spacing = int(step / 0.01)
    for first in range(spacing):
        finer = made_up().isel(Omega=slice(first, 401, spacing))
        assert effects(finer) == ["rises"]


def jumping() -> np.ndarray:
    """A stick-slip frequency that jumps over that of the mode between two speeds."""
    return np.where(SPEEDS < MEETING - 0.005, SPEEDS * 9.0, SPEEDS * 11.0)


def test_no_crossing_lies_where_the_stick_slip_frequency_jumps() -> None:
    """Its table had one there, and asked for steps of 0.0003 rad/s."""
    assert Campbell().summarise(made_up(stick_slip_frequency=jumping()))["n_crossings"] == 0


def test_a_crossing_at_the_last_speed_before_a_jump_is_found() -> None:
    at_last = made_up(stick_slip_frequency=np.where(SPEEDS > MEETING + 0.001, 130.0, 10 * SPEEDS))
    [crossing] = found_crossings(at_last)
    assert crossing[0] == pytest.approx(MEETING)


def test_growth_rates_are_not_compared_over_a_jump() -> None:
    """The rate falls there to that of another kind of cycle, which said nothing of the crossing."""
    beyond = SPEEDS > MEETING + 0.035
    frequency = np.where(beyond, 130.0, 10 * SPEEDS)
    assert effects(made_up(stick_slip_frequency=frequency)) == ["unresolved"]
