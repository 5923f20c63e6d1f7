"""Outcome of one simulation within a horizon: the motion stays on a cycle, grows in contact, or
separates."""

from dataclasses import asdict
from typing import Any, ClassVar

import numpy as np

from disc_model.data.variables import OF_QUANTITIES, Outcome
from disc_model.simulation.case import Start
from disc_model.studies.quantity import (
    COME_TO,
    COME_TO_BY,
    OutcomeResult,
    Point,
    Quantity,
    Result,
    Segment,
    State,
)
from disc_model.units import Seconds, Tolerance

_TIMES = (
    "evaluation_time={0.evaluation_time:g} must be <= after_separation={0.after_separation:g} and <= "
    "horizon={0.horizon:g}"
)
FEWEST = 4  # least number of checks of a motion that give a rate


class HorizonOutcome(Start, Quantity):
    """Outcome of one simulation at each point, within a horizon."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    early_end: bool = True
    """whether a simulation ends as soon as its outcome is known"""
    extrapolate: bool = False
    """whether slow departures from cycles are extrapolated, which halves the time; their separations are not timed"""
    horizon: Seconds
    """longest simulated time"""
    evaluation_time: Seconds = 1.0
    """length of the late stretch, over which ranges and shares are taken"""
    after_separation: Seconds = 5.0
    """time from the first separation to the end of the late stretch"""

    _rules = ((lambda o: o.evaluation_time <= min(o.after_separation, o.horizon), _TIMES),)
    points_per_job: ClassVar = 80
    motions: ClassVar = 4
    motion: ClassVar = COME_TO
    motion_by: ClassVar = COME_TO_BY
    COLUMNS: ClassVar = OF_QUANTITIES["outcome"]["columns"]

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        reached, result, late = _late(point, self)
        last = reached if result is None else result
        values: dict[str, Any] = {
            "status": "ok" if last.status.complete else last.status.value,
            "outcome": reached.word,
            "first_separation": reached.timed_separation,
            "time_reached": reached.time,
            "cycle_distance": reached.distance,
        }
        if reached.changes:
            values["return_map_residual"] = reached.changes[-1]
        times = np.array(reached.times[-FEWEST:])
        changes = np.array(reached.changes[-FEWEST:])
        if len(times) == FEWEST and np.all(changes > 0):
            rate, _ = np.polyfit(times, np.log(changes), 1)
            values["return_map_residual_rate"] = float(rate)
        if reached.outcome is Outcome.SEPARATION and result is not None:
            values["time_reached"] = result.final_state.time
        elif reached.outcome is not None and reached.time < self.horizon:
            values["left_at"] = reached.time
        if late is not None:
            values.update(asdict(late))
        message = "" if last.status.complete else last.message
        return values, message

    def state_at(self, point: Point) -> State:
        reached, result, _ = _late(point, self)
        last = reached.failed or result
        state = reached.state
        if last is not None:
            state = last.raise_for_status().final_state
        assert state is not None
        return state


def _late(
    point: Point, options: HorizonOutcome
) -> tuple[OutcomeResult, Result | None, Segment | None]:
    """The outcome, the run beyond it, if any, and the late stretch."""
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.follower import find_outcome
    from disc_model.stability.segments import final_segment

    p = point.parameters
    length = options.evaluation_time
    start = make_initial_state(p, point.start, options.tol)
    reached = find_outcome(
        p,
        options.horizon,
        tol=options.tol,
        start=start,
        early=options.early_end,
        late=length,
        compared_with=(options.horizon,) if options.extrapolate else (),
    )
    if reached.outcome is Outcome.SEPARATION:
        return reached, *final_segment(
            p, reached.state, options.after_separation, length, options.tol
        )
    if reached.outcome is None or reached.segment is not None:
        return reached, None, reached.segment
    # a stable cycle is known exactly; elsewhere the motion is steady
    on = reached.state
    if reached.near is not None and reached.near.cycle.stable:
        on = reached.near.cycle.state
    return reached, *final_segment(p, on, length, length, options.tol)
