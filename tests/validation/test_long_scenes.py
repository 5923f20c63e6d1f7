"""Long motions with friction on the surface: each event against the long-double reference."""

import numpy as np
import pytest

from disc_model import Parameters, simulate
from disc_model.engine.record import EVENT_ROW
from tests.references import stored, taylor

LONG = Parameters(
    N=385, Omega=2, c=3, c_p=0.2, friction_offset=0.02, contact_compliance=1e-6,
)  # fmt: skip
FALLING = {"friction_law": "exponential", "friction_decay": 2.0, "viscous_friction": 0.005}


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize(("law", "length"), [({}, 0.6), (FALLING, 1.0)], ids=["jump", "falling"])
def test_a_long_motion_with_separations_and_backward_slips(law: dict, length: float) -> None:
    """Some thousand events: 2.4e-10 s and 2.2e-11 s off were measured."""
    p = LONG.replace(**law)
    q = taylor.problem_of(p)
    start = taylor.violent_start(1.3)
    a, b, alpha = (np.array(getattr(start, name)) for name in ("a", "b", "alpha"))
    start.u = q.s @ a + 1e-5
    rate = start.f - q.surface_speed(np.array(start.beta)) / q.r_0
    start.u_velocity = q.s @ (alpha + q.l * rate * b)
    start = stored.rounded(start)

    result = simulate(p, length, tol=1e-13, initial_state=stored.engine_state(start, p))
    events = taylor.Reference(q, start).run(length).events
    assert list(result.events["kind"]) == [event["kind"] for event in events]
    wanted = [float(event["time"]) for event in events]
    np.testing.assert_allclose(result.events["time"], wanted, rtol=0, atol=5e-9)
    assert len(events) > 2126
    assert result.statistics["n_separations"] > 377
    assert np.sum(result.event_rows[:, EVENT_ROW.index("direction")] < 0) > 10
