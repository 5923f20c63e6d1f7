"""Sweeps up and down."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.stability.attractor import arrival
from disc_model.studies.quantities import hysteresis
from disc_model.studies.quantities.hysteresis import Hysteresis
from disc_model.studies.quantity import Point
from tests.studies.conftest import SCAN, compute


@pytest.mark.compiled
def test_hysteresis_at_385_N() -> None:
    """Separation begins beyond the fold at 15.09 rad/s and persists below it on the way down."""
    scan = {"start": 12, "stop": 16, "step": 0.5}
    options = Hysteresis.model_validate({"scan": scan, "dwell": 60, "evaluation_time": 2})
    found = compute(options, [Point(Parameters(N=385, Omega=0))]).arrays
    assert found["onset_speed"][0] == 15.5
    assert found["offset_speed"][0] < 15
    assert found["separation_rate"].shape == (1, 2, 9)
    assert (found["sweep_status"] == 0).all()


def test_hysteresis_is_the_gap_between_the_ways(sweep: xr.Dataset) -> None:
    one = sweep.squeeze("normalization").sel(N=200)
    assert one["onset_speed"] == 14.0
    assert one["offset_speed"] == 13.0
    assert (one["separation_rate"].sel(direction="up") > 0).values.tolist() == [False] * 4 + [True] * 3
    assert (one["separation_rate"].sel(direction="down") > 0).values.tolist() == [False] * 2 + [True] * 5


@pytest.mark.usefixtures("fake_motions")
@pytest.mark.parametrize(
    ("way", "breaks_at", "onset", "offset"),
    [(0, 13.5, math.nan, math.nan), (1, 13.5, 14.0, math.nan), (1, 12.5, 14.0, math.nan), (1, 12.0, 14.0, 13.0)],
)
def test_a_sweep_that_cannot_go_on_says_where_and_what_it_has_seen(
    way: int, breaks_at: float, onset: float, offset: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On its way up or down."""
    whole, passed = arrival.simulate, []

    def simulate(p, *how, **more):
        passed.append(p.Omega)
        if passed.count(breaks_at) > way and p.Omega == breaks_at:
            return SimpleNamespace(status=Status.STALLED, message="why", final_state=None)
        return whole(p, *how, **more)

    monkeypatch.setattr(arrival, "simulate", simulate)
    options = Hysteresis.model_validate({"scan": SCAN, "dwell": 60, "evaluation_time": 2})
    table = compute(options, [Point(Parameters(N=200, Omega=0))])
    found = table.arrays
    assert list(table.messages) == [f"Omega={breaks_at:g}: why"]
    np.testing.assert_array_equal([found["onset_speed"][0], found["offset_speed"][0]], [onset, offset])
    statuses = np.array(hysteresis.STATUSES)[found["sweep_status"][0]]
    assert hysteresis.STATUSES[found["status"][0]] == statuses[way, round((breaks_at - 12) / 0.5)] == "stalled"
    assert (statuses[way] == "failed").sum() == (3 if way == 0 else round((breaks_at - 12) / 0.5))
    assert np.array_equal(np.isnan(found["P_min"][0]), statuses != "ok")
