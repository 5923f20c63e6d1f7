"""Speed ramps up and down, of motions whose separations are known, and of a real one."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.engine.event_loop import EVENT_ROW, LOSS_OF_CONTACT
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.ramps import values_at
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantity import STATUSES, Point
from tests.studies.conftest import compute

SPAN = {"low": 10, "high": 20, "dwell": 7}
EVERY = 0.125
"""s between two separations of the made-up motion."""


def swept(rates: tuple[float, float], **more) -> dict[str, np.ndarray]:
    options = Ramps.model_validate({**SPAN, "rates": {"start": rates[0], "stop": rates[1], "count": 2}} | more)
    return compute(options, [Point(Parameters(N=385, Omega=1))]).arrays


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Separation begins 4 s after 12 rad/s is passed, and ends 2 s after 11 rad/s is passed on the way down."""
    world = SimpleNamespace(calls=[])

    def simulate(p, until, *, tol, initial_state, events, stop_at, ramps):
        start = 0.0 if initial_state is None else initial_state.time
        world.calls.append((start, until))
        up, down = ramps
        rate = (up.to - p.Omega) / up.end
        begins, ends = (12 - p.Omega) / rate + 4, down.start + (up.to - 11) / rate + 2
        times = np.arange(begins, ends, EVERY)
        lost = times[(times > start) & (times <= until)]
        first = float(lost[0]) if lost.size else math.nan
        end, status = until, Status.OK
        if stop_at and lost.size:
            end, status = first, Status.STOPPED
        rows = np.zeros((len(lost), len(EVENT_ROW)))
        rows[:, 0], rows[:, 1] = lost, LOSS_OF_CONTACT
        assert values_at(p, ramps, "Omega", down.start - 1e-9) == pytest.approx(20)
        return SimpleNamespace(
            status=status, message="why", final_state=SimpleNamespace(time=end), first_separation=first,
            event_rows=rows if events else rows[:0], statistics={"separations": len(lost)},
        )  # fmt: skip

    monkeypatch.setattr("disc_model.simulation.api.simulate", simulate)
    return world


def test_onset_and_end_are_speeds_of_the_ramps(made_up: SimpleNamespace) -> None:
    found = swept((0.01, 0.1))
    np.testing.assert_allclose(found["onset_speed"][0], [12.04, 12.4], atol=1e-9)
    # the last separation is the last one before that, some time below EVERY
    assert ((found["offset_speed"][0] - [10.98, 10.8]) / [0.01, 0.1] >= 0).all()
    assert ((found["offset_speed"][0] - [10.98, 10.8]) / [0.01, 0.1] <= EVERY + 1e-9).all()
    np.testing.assert_allclose(found["top_separation_rate"], 1 / EVERY, atol=1 / SPAN["dwell"])
    assert (found["rate_status"] == STATUSES.index("ok")).all()
    assert max(end - start for start, end in made_up.calls if start > 1000) <= 100


@pytest.mark.compiled
def test_onset_at_385_N_comes_late_and_the_end_is_far_below() -> None:
    """The cycle ends at 15.09 rad/s; separation takes some 50 s to grow, and persists to below 10."""
    found = swept((0.05, 0.1), low=8, high=22, dwell=20)
    onset, end = found["onset_speed"][0], found["offset_speed"][0]
    assert ((onset > 16) & (onset < 20)).all()
    assert onset[0] < onset[1]
    assert ((end > 8.5) & (end < 10)).all()
    assert (found["top_separation_rate"] > 100).all()
