"""Statements of Section 4.1 judged by made-up studies."""

import math

import numpy as np
import pytest
import xarray as xr

from disc_model.paper.model import FALSE, PART, TRUE
from disc_model.paper.section41 import maintained_below
from tests.paper.evidence import grid

NAN = math.nan


def critical_speeds(*speeds: float) -> xr.Dataset:
    """Return critical speeds at preloads of 100 N, 200 N and so on, for two horizons.

    That of the shorter one is 5 rad/s higher.
    """
    preloads = 100.0 * np.arange(1, len(speeds) + 1)
    both = np.array(speeds)[:, None] + [5.0, 0.0]
    axes = {"normalization": ["as_published"], "N": preloads, "horizon": [10.0, 1000.0]}
    return grid(axes, status=[["ok"] * len(speeds)], critical_speed=[both])


def sweeps(up: list[float], down: list[float]) -> xr.Dataset:
    """Return speeds at which separation begins and ends on sweeps."""
    axes = {"normalization": ["as_published"], "N": 100.0 * np.arange(1, len(up) + 1)}
    return grid(axes, onset_speed=[up], offset_speed=[down])


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
    assert found.verdict == (PART if below else TRUE)
    rows = []
    if below:
        rows = [(100.0, up, down, 15.0)]
    assert found.values["below"] == rows


def basins(share: float) -> xr.Dataset:
    """Return a study of 30 kicks of up to 2 J, of which a share separates at 15 rad/s."""
    axes = {
        "normalization": ["as_published"],
        "Omega": [14.0, 15.0],
        "energy": [0.5, 1.0, 2.0],
        "start": np.arange(10),
    }
    return grid(axes, separating_fraction=[[0.9, share]])


def test_kicks_that_separate_are_counted() -> None:
    speeds = critical_speeds(15.0)
    found = maintained_below(speeds, None, basins(0.2), within=0.1)
    assert found.verdict == PART
    assert found.values["kicks"] == (6, 30, (0.5, 2.0))
    assert maintained_below(speeds, None, basins(0.0), within=0.1).verdict == TRUE
    assert maintained_below(speeds, None, None, within=0.1).verdict == TRUE


def test_without_any_separation_there_is_no_critical_speed() -> None:
    assert maintained_below(critical_speeds(NAN, NAN), None, None, within=0.1).verdict == FALSE
