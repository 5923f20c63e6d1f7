"""Sweeps up and down, in steps and on ramps."""

import numpy as np
import pytest

from disc_model.analysis.classify import Settled, Settling
from disc_model.parameters import Parameters
from disc_model.stability import attractors
from disc_model.studies.quantities.hysteresis import Hysteresis
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantity import Point
from tests.studies.conftest import SCAN, compute


@pytest.mark.usefixtures("fake_motions")
def test_a_stay_is_doubled_until_its_whole_record_has_settled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stays = []

    def settles_above_13(p, legs, tol):
        ends = [leg.final_state.time for leg in legs]
        if len(legs) == 1:
            stays.append([ends[0] - 60])  # the begin, since a stay begins with `dwell`
        stays[-1] = [stays[-1][0], *ends]
        return attractors.Arrival(Settling(Settled.SETTLED if p.Omega > 13 else Settled.UNDECIDED))

    monkeypatch.setattr(attractors, "arrival", settles_above_13)
    options = Hysteresis.model_validate(
        {"scan": SCAN, "dwell": 60, "max_dwell": 250, "evaluation_time": 2}
    )
    found = compute(options, [Point(Parameters(N=200, Omega=0))]).arrays
    assert [np.diff(stay).tolist() for stay in stays] == 3 * [[60, 60, 120]] + 8 * [[60]] + 3 * [
        [60, 60, 120]
    ]
    assert found["sweep_settled"][0].tolist() == 2 * [3 * [0] + 4 * [2]]


@pytest.mark.compiled
def test_on_ramps_at_385_N_onset_comes_late_and_the_end_is_far_below() -> None:
    """The cycle ends at 15.09 rad/s; separation takes some 50 s to grow, and persists to below
    10."""
    options = {"low": 8, "high": 22, "dwell": 20, "rates": {"start": 0.05, "stop": 0.1, "count": 2}}
    found = compute(Ramps.model_validate(options), [Point(Parameters(N=385, Omega=1))]).arrays
    onset, end = found["onset_speed"][0], found["offset_speed"][0]
    assert ((onset > 16) & (onset < 20)).all()
    assert onset[0] < onset[1]
    assert ((end > 8.5) & (end < 10)).all()
    assert (found["top_separation_rate"] > 100).all()
