"""Sweeps up and down."""

import pytest
import xarray as xr

from disc_model.parameters import Parameters
from disc_model.studies.quantities.hysteresis import Hysteresis
from disc_model.studies.quantity import Point
from tests.studies.conftest import compute


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
