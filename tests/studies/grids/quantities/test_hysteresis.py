"""Sweeps up and down."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.stability.attractor import outcome as attractor_outcome
from disc_model.stability.attractor.outcome import Segment
from disc_model.studies.document import HysteresisOptions
from disc_model.studies.grids.points import Point
from disc_model.studies.grids.quantities import hysteresis
from disc_model.studies.grids.run import Table, compute
from tests.studies.grids.conftest import SCAN


def swept(N: float, scan: dict[str, float]) -> Table:
    options = HysteresisOptions.model_validate({"scan": scan, "dwell": 60, "evaluation_time": 2})
    return compute(hysteresis, [Point(Parameters(N=N, Omega=0))], options)


def test_hysteresis_is_the_gap_between_the_ways(sweep: xr.Dataset) -> None:
    one = sweep.squeeze("normalization").sel(N=200)
    assert one["onset_speed"] == 14.0
    assert one["offset_speed"] == 13.0
    assert (one["separation_rate"].sel(direction="up") > 0).values.tolist() == [False] * 4 + [True] * 3
    assert (one["separation_rate"].sel(direction="down") > 0).values.tolist() == [False] * 2 + [True] * 5


def test_a_sweep_that_cannot_go_on_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    def final_segment(p, state, *_):
        failed = p.Omega > 13
        result = SimpleNamespace(status=Status.PARADOX if failed else Status.OK, message="why", final_state=state)
        return result, None if failed else Segment(1, 2, 3, 4, 0.5, 0.5, 0, 0)

    monkeypatch.setattr(attractor_outcome, "final_segment", final_segment)
    table = swept(200, SCAN)
    assert list(table.messages) == ["Omega=13.5: why"]
    statuses = [[hysteresis.STATUSES[i] for i in row] for row in table.arrays["sweep_status"][0]]
    assert statuses == [["ok", "ok", "ok", "paradox", "failed", "failed", "failed"], ["failed"] * 7]
    assert np.isnan(table.arrays["P_min"][0, 0, 3:]).all()
    assert np.isnan(table.arrays["onset_speed"][0])


@pytest.mark.parametrize(("breaks_at", "offset_speed"), [(13.5, math.nan), (12.5, math.nan), (12.0, 13.0)])
def test_a_sweep_that_breaks_off_on_the_way_down_says_what_it_has_seen(
    breaks_at: float, offset_speed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Separation begins at 14 rad/s and persists to 13."""

    def final_segment(p, state, *_):
        down = bool(state) and (state == "down" or p.Omega == 15)
        failed = down and p.Omega == breaks_at
        rate = float(p.Omega >= (13 if down else 14))
        end = "down" if down or p.Omega == 15 else "up"
        result = SimpleNamespace(status=Status.STALLED if failed else Status.OK, message="why", final_state=end)
        return result, None if failed else Segment(1, 2, 3, 4, 0.5, 0.5, 0, rate)

    monkeypatch.setattr(attractor_outcome, "final_segment", final_segment)
    found = swept(200, SCAN).arrays
    assert found["onset_speed"][0] == 14.0
    assert found["offset_speed"][0] == pytest.approx(offset_speed, nan_ok=True)
    assert hysteresis.STATUSES[found["status"][0]] == "stalled"


@pytest.mark.compiled
def test_hysteresis_at_385_N() -> None:
    """Separation begins beyond the fold at 15.09 rad/s and persists below it on the way down."""
    found = swept(385, {"start": 12, "stop": 16, "step": 0.5}).arrays
    assert found["onset_speed"][0] == 15.5
    assert found["offset_speed"][0] < 15
    assert found["separation_rate"].shape == (1, 2, 9)
    assert (found["sweep_status"] == 0).all()
