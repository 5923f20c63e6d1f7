"""Sweeps up and down, in steps and on ramps."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.analysis.classify import Settled, Settling
from disc_model.engine.record import EVENT_ROW, LOSS_OF_CONTACT
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.stability import attractors
from disc_model.stability.segments import Segment
from disc_model.studies.quantities.hysteresis import Hysteresis
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantity import Point
from tests.studies.conftest import SCAN, compute


@pytest.mark.usefixtures("fake_motions")
def test_a_stay_is_doubled_until_its_whole_record_has_settled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stays = []

    def settles_above_13(p, legs):
        ends = [leg.final_state.time for leg in legs]
        if len(legs) == 1:
            stays.append([ends[0] - 60])  # the begin, since a stay begins with `dwell`
        stays[-1] = [stays[-1][0], *ends]
        answer = Settled.UNDECIDED
        if p.Omega > 13:
            answer = Settled.SETTLED
        return attractors.Arrival(Settling(answer))

    monkeypatch.setattr(attractors, "arrival", settles_above_13)
    options = Hysteresis.model_validate(
        {"scan": SCAN, "dwell": 60, "max_dwell": 250, "evaluation_time": 2}
    )
    found = compute(options, [Point(Parameters(N=200, Omega=0))]).arrays
    assert [np.diff(stay).tolist() for stay in stays] == 3 * [[60, 60, 120]] + 8 * [[60]] + 3 * [
        [60, 60, 120]
    ]
    assert found["sweep_settled"][0].tolist() == 2 * [3 * [0] + 4 * [2]]
    assert found["stay"][0].tolist() == 2 * [3 * [240.0] + 4 * [60.0]]


def test_onset_and_offset_are_speeds_at_which_it_separates(sweep: xr.Dataset) -> None:
    """It begins at 14 rad/s on the way up, and persists down to 13."""
    assert sweep["onset_speed"].values.ravel().tolist() == [14.0, 14.0]
    assert sweep["offset_speed"].values.ravel().tolist() == [13.0, 13.0]
    rates = sweep["separation_rate"].squeeze("normalization").sel(N=200)
    apart = rates.sweep_Omega.values[rates.sel(direction="down").values > 0]
    assert apart.min() == 13.0
    assert rates.sweep_Omega.values[rates.sel(direction="up").values > 0].min() == 14.0


@pytest.mark.parametrize(
    ("falling", "offset"),
    [
        ([0, 0, 0, 0], None),  # it has ended at the top already
        ([9, 9, 9, 9], None),  # it persists at the lowest speed, and may do so below
        ([9, 0, 9, 9], 12.0),  # a gap ends it, though it begins again below
        ([0, 0, 0, 9], 13.0),
    ],
)
def test_the_offset_is_above_the_first_gap_on_the_way_down(
    falling: list[float], offset: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    speeds = [10.0, 11.0, 12.0, 13.0]

    def sweep(p, name, values, *times):
        assert name == "Omega"
        assert values == speeds
        for step in [(0, i) for i in range(4)] + [(1, i) for i in (3, 2, 1, 0)]:
            rate = 0
            if step[0]:
                rate = falling[step[1]]
            segment = Segment(0, 1, 0, 1, 0.5, 0.5, 0.0, rate)
            yield step, None, segment, attractors.Arrival(Settling(Settled.SETTLED))

    monkeypatch.setattr(attractors, "sweep", sweep)
    options = Hysteresis(scan={"start": 10, "stop": 13, "step": 1}, dwell=9, evaluation_time=1)
    values, _ = options.compute_point(Point(Parameters(N=200, Omega=0)))
    assert values.get("offset_speed") == offset
    assert "onset_speed" not in values


@pytest.mark.parametrize(
    ("rising", "onset"),
    [
        ([0, 0, 0, 0], None),
        ([0, 0, 9, 9], 12.0),
        ([9, 9, 9, 9], None),  # it begins at the lowest speed, or would below
        ([9, 0, 0, 9], None),
    ],
)
def test_the_onset_is_above_a_speed_at_which_contact_is_kept(
    rising: list[float], onset: float | None
) -> None:
    """It was the lower bound where contact was lost there already."""
    options = Hysteresis(scan={"start": 10, "stop": 13, "step": 1}, dwell=9, evaluation_time=1)
    rates = np.array([rising, np.zeros(4)])
    edges = options._edges({"sweep_status": np.zeros((2, 4), int), "separation_rate": rates})
    assert edges.get("onset_speed") == onset


def test_there_is_no_offset_where_the_sweep_fails_before_separation_ends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def sweep(*_: Any) -> Any:
        settled = attractors.Arrival(Settling(Settled.SETTLED))
        segment = Segment(0, 1, 0, 1, 0.5, 0.5, 0.0, 9)
        for step in [(0, 0), (0, 1), (0, 2), (0, 3), (1, 3), (1, 2)]:
            yield step, None, segment, settled
        lost = SimpleNamespace(status=Status.NON_FINITE, message="lost")
        yield (1, 1), lost, None, attractors.Arrival(Settling())

    monkeypatch.setattr(attractors, "sweep", sweep)
    options = Hysteresis(scan={"start": 10, "stop": 13, "step": 1}, dwell=9, evaluation_time=1)
    values, message = options.compute_point(Point(Parameters(N=200, Omega=0)))
    assert "offset_speed" not in values
    assert message == "Omega = 11 rad/s: lost"


def test_on_ramps_the_offset_is_that_of_the_last_separation_unless_it_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Contact is lost once a second until 130 s: on the way down at 0.1 rad/s^2, in the stay at the
    lowest speed at 0.2 rad/s^2."""

    def simulated(p: Parameters, until: float, **how: Any) -> Any:
        before = how.get("initial_state")
        if before is None:
            begin = 0.0
        else:
            begin = before.time
        times = np.arange(1.0, 131.0)
        times = times[(times > begin) & (times <= until)]
        rows = np.zeros((times.size, len(EVENT_ROW)))
        rows[:, EVENT_ROW.index("time")] = times
        rows[:, EVENT_ROW.index("kind")] = LOSS_OF_CONTACT
        return SimpleNamespace(
            status=Status.OK,
            first_separation=1.0,
            statistics={"n_separations": times.size},
            event_rows=rows,
            final_state=SimpleNamespace(time=until),
        )

    monkeypatch.setattr("disc_model.simulation.api.simulate", simulated)
    rates = {"start": 0.1, "stop": 0.2, "count": 2}
    options = Ramps.model_validate({"low": 8, "high": 12, "dwell": 60, "rates": rates})
    found = compute(options, [Point(Parameters(N=385, Omega=1))]).arrays
    np.testing.assert_allclose(found["offset_speed"], [[9.0, np.nan]])
    np.testing.assert_allclose(found["onset_speed"], [[8.1, 8.2]])
    np.testing.assert_allclose(found["top_separation_rate"], [[1.0, 1.0]])


@pytest.mark.compiled
def test_on_ramps_at_385_N_onset_comes_late_and_the_end_is_far_below() -> None:
    """The cycle ends at 15.09 rad/s; separation takes some 50 s to grow, and persists to below
    10."""
    options = {"low": 8, "high": 22, "dwell": 20, "rates": {"start": 0.05, "stop": 0.1, "count": 2}}
    found = compute(Ramps.model_validate(options), [Point(Parameters(N=385, Omega=1))]).arrays
    onset = found["onset_speed"][0]
    end = found["offset_speed"][0]
    assert ((onset > 16) & (onset < 20)).all()
    assert onset[0] < onset[1]
    assert ((end > 8.5) & (end < 10)).all()
    assert (found["top_separation_rate"] > 100).all()


def test_a_sweep_that_ends_says_at_which_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    lost: Any = SimpleNamespace(status=Status.NON_FINITE, message="no steps")
    arrival = attractors.Arrival(Settling())
    monkeypatch.setattr(attractors, "sweep", lambda *how: [((0, 3), lost, None, arrival)])
    options = Hysteresis.model_validate({"scan": SCAN, "dwell": 60})
    table = compute(options, [Point(Parameters(N=200, Omega=0))])
    assert table.messages == ["Omega = 13.5 rad/s: no steps"]
