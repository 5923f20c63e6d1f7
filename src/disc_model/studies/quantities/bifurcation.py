"""Samples of the settled motion, once a turn of the drive or at events."""

from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from pydantic import Field

from disc_model.analysis.classify import Motion, Settling, closure
from disc_model.data.variables import OF_QUANTITIES, Outcome
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.simulation.case import Poincare, Start
from disc_model.stability.follower import FIRST_LEG
from disc_model.studies.quantity import (
    MOST,
    SETTLED_TO_BY,
    Arrival,
    Coordinate,
    Point,
    Quantity,
    Result,
    State,
)
from disc_model.units import Count, Finite, Seconds, Tolerance, Unit

SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")


class Bifurcation(Start, Quantity):
    """Samples of the motion after a transient, for bifurcation diagrams.

    Once a turn, a periodic stick-slip cycle fills an interval, as its period is no multiple of a
    turn: `kind` tells it from motions that do not repeat.
    At events, which are separations if there are any, else releases, a periodic motion shows as
    many points as its period has events. The transient is doubled there until the motion has
    settled, up to `max_transient`.
    """

    section: Literal["stroboscopic", "event"] = "stroboscopic"
    """whether samples are taken once a turn of the drive, or at events"""
    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    transient: Seconds
    """time left out at the beginning; at events it is doubled until the motion has settled"""
    max_transient: Seconds = 480.0
    """longest time left out"""
    samples: Annotated[Count, Field(ge=1, le=MOST)] = 50
    """number of samples"""
    theta: Annotated[Finite, Unit("rad")] = 1.0
    """angle of the disc's point whose displacement is sampled once a turn"""

    _rules = (
        (
            lambda o: o.section == "stroboscopic" or o.max_transient >= o.transient,
            "max_transient={0.max_transient:g} must be >= transient={0.transient:g}",
        ),
    )
    points_per_job: ClassVar = 110
    motions: ClassVar = 8
    motion: ClassVar = "After the transient."
    motion_by: ClassVar = SETTLED_TO_BY
    COLUMNS: ClassVar = OF_QUANTITIES["bifurcation"]["columns"]
    COORDINATES: ClassVar = {"sample": Coordinate(lambda o: range(o.samples))}

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        return (
            _once_a_turn(point, self)
            if self.section == "stroboscopic"
            else _at_switches(point, self)
        )

    def state_at(self, point: Point) -> State:
        from disc_model.simulation.starts import state_after

        if self.section == "event":
            transient = _transient_of(point, self)
            transient.run.raise_for_status()
            return transient.end
        return state_after(point.parameters, point.start, self.transient, self.tol)


def _once_a_turn(point: Point, options: Bifurcation) -> tuple[dict[str, Any], str]:
    """Sample at t = i 2 pi / Omega after the transient; samples that the run does not reach are
    missing."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.attractors import Arrival, arrival

    p = point.parameters
    require((p.Omega > 0, "Omega", p.Omega, "must be > 0, because samples are taken once a turn"))
    turn = 2 * np.pi / p.Omega
    first = int(np.ceil(options.transient / turn))
    # both ends lie between samples, so that rounding neither adds one nor leaves one out
    end = (first + options.samples - 0.5) * turn
    turns = Poincare(start=max(first - 0.25, 0.0) * turn, stop=end, theta=options.theta)
    start = make_initial_state(p, point.start, options.tol)
    run = simulate(p, end, {"turns": turns}, tol=options.tol, initial_state=start)
    time = run.final_state.time
    taken = run.samples["turns"]
    reached = Arrival(Settling())
    motion = Motion(Outcome.UNDECIDED)
    if run.status.complete:
        reached = arrival(p, [run])
        motion = _motion_reached(p, reached, run, options.tol)
    values: dict[str, Any] = {name: taken[name] for name in SAMPLED}
    values |= _answer(reached.settling, motion)
    values |= {
        "status": run.status.value,
        "phase": taken["phase"] + 1,  # 0 is "none"
        "first_separation": run.first_separation,
        "separations": int(run.statistics["n_separations"]),
        "transient_time": options.transient,
        "stick_fraction": run.statistics["time_stick"] / time if time else np.nan,
    }
    if not run.status.complete:
        return values, f"the simulation ended early: {run.status}"
    if not reached.settled:
        return values, f"not settled after {time:g} s: {reached.settling}; raise transient"
    return values, ""


class _Transient(NamedTuple):
    """The time left out before samples at events.

    Attributes
    ----------
    run : its last part
    reached : what it has come to
    length : in all, s
    first : time of its first separation, s, nan without
    separations : their number
    """

    run: Result
    reached: Arrival
    length: float
    first: float
    separations: int

    @property
    def end(self) -> State:
        """The state in which samples begin: on the attractor, if that is known exactly."""
        near = self.reached.near
        if near is None:
            return self.run.final_state
        assert near.cycle.state is not None
        return near.cycle.state


def _transient_of(point: Point, options: Bifurcation) -> _Transient:
    """The transient of a point, doubled until the motion has settled; its run may end early."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.attractors import Arrival, arrival

    p = point.parameters
    state = make_initial_state(p, point.start, options.tol)
    length = options.transient
    first = np.nan
    separations = 0
    legs: list[Result] = []
    while True:
        run = simulate(p, length, tol=options.tol, initial_state=state)
        if np.isnan(first):
            first = run.first_separation
        separations += int(run.statistics["n_separations"])
        if not run.status.complete:
            return _Transient(run, Arrival(Settling()), length, first, separations)
        legs.append(run)
        state = run.final_state
        reached = arrival(p, legs)
        if reached.settled or 2 * length > options.max_transient:
            return _Transient(run, reached, length, first, separations)
        length *= 2


def _at_switches(point: Point, options: Bifurcation) -> tuple[dict[str, Any], str]:
    from disc_model.simulation.api import simulate
    from disc_model.stability.segments import shares

    p = point.parameters
    before = _transient_of(point, options)
    if not before.run.status.complete:
        return _ended_early(before.run, before.first, before.separations)
    state = before.end
    reached = before.reached
    stick = shares(before.run).stick
    if reached.near is not None:  # the attractor is known exactly
        stick = reached.near.cycle.stick_fraction
    record = simulate(p, state.time + FIRST_LEG, tol=options.tol, initial_state=state)
    if reached.calm is not None:  # the run has its transient
        stick = shares(record).stick
    first = before.first
    if np.isnan(first):
        first = record.first_separation
    separations = before.separations + int(record.statistics["n_separations"])
    if not record.status.complete:
        return _ended_early(record, first, separations)
    events = record.events
    kind = "stick_to_slip"
    phase = "stick"
    if (events["kind"] == "separation").any():
        kind = "separation"
        phase = "separation"
    taken = events[events["kind"] == kind]
    motion = _motion_reached(p, reached, before.run, options.tol)
    shown = taken.iloc[-options.samples :]
    columns = {
        "psi": shown["psi"],
        "psi_velocity": p.Omega - shown["f"],
        "P": shown["P"],
        "u": shown["u"],
    }
    values: dict[str, Any] = {
        **{name: column.to_numpy(dtype=float) for name, column in columns.items()},
        **_answer(reached.settling, motion),
        "status": "ok",
        "phase": [phase] * len(shown),
        "first_separation": first,
        "separations": separations,
        "stick_fraction": stick,
        "transient_time": before.length,
    }
    if reached.settled:
        return values, ""
    message = f"not settled after {before.length:g} s: {reached.settling}"
    if taken.empty:
        message = f"{message}; no event in the {FIRST_LEG:g} s sampled after that"
    return values, f"{message}; raise max_transient"


def _ended_early(run: Result, first: float, separations: int) -> tuple[dict[str, Any], str]:
    """What is known of a motion whose simulation ended early: its first separation, and the number of
    separations up to then."""
    known = {"status": run.status.value, "first_separation": first, "separations": separations}
    return known, f"the simulation ended early: {run.status}"


def _motion_reached(p: Parameters, reached: Arrival, run: Result, tol: float) -> Motion:
    """What a motion has come to at the end of a run: by the proof of its arrival, or else by its
    regularity if the record shows that it has settled."""
    from disc_model.stability.attractors import regularity

    if reached.calm is not None:
        return Motion(reached.calm)
    if reached.near is None:
        if not reached.settled:
            return Motion(Outcome.UNDECIDED)
        return regularity(p, run.final_state, tol)
    cycle = reached.near.cycle
    n = cycle.releases
    kind = "stick_to_slip"
    if cycle.separations:
        n = cycle.separations
        kind = "separation"
    times = run.events["time"][run.events["kind"] == kind]
    intervals = np.diff(times[times > run.final_state.time - FIRST_LEG])
    if n >= len(intervals):
        return Motion(reached.near.kind, n, np.nan)
    return Motion(reached.near.kind, n, closure(intervals, n))


def _answer(settling: Settling, motion: Motion) -> dict[str, Any]:
    """Columns that say whether a motion has settled, and on what."""
    return {
        "settled": settling.answer.value,
        "change_rate": settling.rate,
        "least_rate": settling.least,
        "kind": motion.kind,
        "period_events": motion.period,
        "period_residual": motion.closure,
    }
