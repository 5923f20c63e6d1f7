"""Outcome of one simulation within a horizon: the motion stays on a cycle, grows in contact, or
separates."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from xarray import Dataset

from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import COME_TO, STATIC, Motion, Row, found, quantity
from disc_model.units import Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.result import Result
    from disc_model.simulation.states import State
    from disc_model.stability.follower import OutcomeResult
    from disc_model.stability.segments import Segment

_TIMES = (
    "evaluation_time={0.evaluation_time:g} must be <= after_separation={0.after_separation:g} and <= "
    "horizon={0.horizon:g}"
)


def _late(
    case: Parameters,
    horizon: float,
    start: Start,
    evaluation_time: float,
    after_separation: float,
    early_end: bool,
    tol: float,
) -> tuple[OutcomeResult, Result | None, Segment | None]:
    """The outcome, the run beyond it, if any, and the late stretch."""
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.follower import find_outcome
    from disc_model.stability.segments import final_segment

    state = make_initial_state(case, start, tol)
    reached = find_outcome(
        case, horizon, tol=tol, start=state, early=early_end, late=evaluation_time
    )
    on = reached.state
    duration = evaluation_time
    if reached.outcome is Outcome.SEPARATION:
        duration = after_separation
    elif reached.outcome is None or reached.segment is not None:
        return reached, None, reached.segment
    elif reached.near is not None and reached.near.cycle.stable:
        # a stable cycle is known exactly; elsewhere the motion is steady
        on = reached.near.cycle.state
    return reached, *final_segment(case, on, duration, evaluation_time, tol)


def come_to(case: Parameters, *args: Any, **options: Any) -> State:
    """The state that the motion has come to."""
    reached, result, _ = _late(case, *args, **options)
    state = reached.state
    if last := reached.failed or result:
        state = last.raise_for_status().final_state
    assert state is not None
    return state


@quantity(
    points_per_job=80,
    rules=((lambda o: o.evaluation_time <= min(o.after_separation, o.horizon), _TIMES),),
    motion=Motion(100, COME_TO, come_to),
)
def outcome(
    case: Parameters,
    horizon: Seconds = 1000.0,
    *,
    start: Start = STATIC,
    evaluation_time: Seconds = 1.0,
    after_separation: Seconds = 5.0,
    early_end: bool = True,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Long-term behaviour within a horizon, such as "stick_slip" or "separation", with ranges and phases
    late in the run.

    Parameters
    ----------
    horizon : longest simulated time
    start : start of the motion
    evaluation_time : length of the late stretch, over which ranges and shares are taken
    after_separation : time from the first separation to the end of the late stretch
    early_end : whether a simulation ends as soon as its outcome is known
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        `outcome`, `first_separation` (s), and the stretch: P_min, P_max (N), u_min, u_max (m), stick_fraction, ...
        Of stable cycles in contact, "stick_slip" are that of `floquet`, and one whose release differs from the first
        release of the static start by at most a tenth of the static deflection; "other_cycle" are all others

    Examples
    --------
    >>> import disc_model as dm
    >>> reached = dm.outcome(dm.Parameters(N=385, Omega=15.1), 100)
    >>> print(reached["outcome"].item(), f"{reached['first_separation'].item():.1f} s")
    separation 54.4 s
    """
    reached, result, late = _late(
        case, horizon, start, evaluation_time, after_separation, early_end, tol
    )
    values: Row = {
        "status": "ok",
        "outcome": reached.word,
        "first_separation": reached.timed_separation,
        "time_reached": reached.time,
    }
    if late is not None:
        values |= asdict(late)
    message = ""
    last = result or reached
    if not last.status.complete:
        values["status"] = last.status.value
        message = last.message
    if reached.outcome is Outcome.SEPARATION and result is not None:
        values["time_reached"] = result.final_state.time
    return found("outcome", values, message)
