"""Samples of the settled motion, once a turn of the drive or at events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.classify import Motion as MotionKind
from disc_model.analysis.classify import Settling, closure
from disc_model.data.variables import Outcome
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.simulation.case import Poincare, Start
from disc_model.stability.follower import FIRST_LEG
from disc_model.studies.quantity import MOST, STATIC, Motion, Starting, found, quantity
from disc_model.units import Count, Finite, Seconds, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.simulation.result import Result
    from disc_model.simulation.states import State
    from disc_model.stability.attractors import Arrival

SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
SETTLED_TO = {
    "stick_slip": "After the transient, of a motion that comes to the cycle of the static start.",
    "other_cycle": "After the transient, of a motion that comes to another cycle in contact.",
    "separating": "After the transient, of a motion that comes to a cycle with separations.",
    "quasi_periodic": "After the transient, of a motion that is quasi-periodic.",
    "irregular": "After the transient, of a motion that is irregular.",
    "steady_sliding": "After the transient, of a motion that comes to steady sliding.",
    "at_rest": "After the transient, of a motion that comes to permanent stick.",
    "undecided": "After the transient, of a motion that has not shown what it comes to.",
}
"""What a stored motion is, by the kind that the samples of its point have."""
Answer = tuple[dict[str, Any], str]
"""Values by variable, and a message."""


def _settled(
    case: Parameters,
    *,
    section: str,
    start: Start,
    transient: float,
    max_transient: float,
    tol: float,
    **_: Any,
) -> State:
    """The state in which samples begin."""
    from disc_model.simulation.starts import state_after

    if section == "stroboscopic":
        return state_after(case, start, transient, tol)
    before = _transient_of(case, start, transient, max_transient, tol)
    before.run.raise_for_status()
    return before.end


@quantity(
    points_per_job=110,
    rules=(
        (
            lambda o: o.section == "stroboscopic" or o.max_transient >= o.transient,
            "max_transient={0.max_transient:g} must be >= transient={0.transient:g}",
        ),
    ),
    motion=Motion(8, "After the transient.", SETTLED_TO, _settled),
)
def bifurcation(
    case: Parameters,
    *,
    transient: Seconds,
    max_transient: Seconds = 480.0,
    section: Literal["stroboscopic", "event"] = "stroboscopic",
    samples: Annotated[Count, Field(ge=1, le=MOST)] = 50,
    theta: Annotated[Finite, Unit("rad")] = 1.0,
    start: Starting = STATIC,
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """Samples of the motion after a transient, for bifurcation diagrams.

    Once a turn, a periodic stick-slip cycle fills an interval, as its period is no multiple of a turn: `kind`
    tells it from motions that do not repeat. At events, which are separations if there are any, else releases,
    a periodic motion shows as many points as its period has events.

    Parameters
    ----------
    transient : time left out at the beginning; at events it is doubled until the motion has settled
    max_transient : longest time left out
    section : whether samples are taken once a turn of the drive, or at events
    samples : number of samples
    theta : angle of the disc's point whose displacement is sampled once a turn
    start : start of the motion
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.bifurcation(dm.Parameters(N=385, Omega=15), transient=20, samples=3)["kind"].item()
    'stick_slip'
    """
    if section == "stroboscopic":
        values, message = _once_a_turn(case, start, transient, samples, theta, tol)
    else:
        before = _transient_of(case, start, transient, max_transient, tol)
        values, message = _at_switches(case, before, samples, tol)
    return found("bifurcation", values, message, sample=range(samples))


def _once_a_turn(
    case: Parameters, start: Start, transient: float, samples: int, theta: float, tol: float
) -> Answer:
    """Sample at t = i 2 pi / Omega after the transient; samples that the run does not reach are
    missing."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.attractors import Arrival, arrival

    rule = "must be > 0, because samples are taken once a turn"
    require((case.Omega > 0, "Omega", case.Omega, rule))
    turn = 2 * np.pi / case.Omega
    first = int(np.ceil(transient / turn))
    # both ends lie between samples, so that rounding neither adds one nor leaves one out
    end = (first + samples - 0.5) * turn
    turns = Poincare(start=max(first - 0.25, 0.0) * turn, stop=end, theta=theta)
    state = make_initial_state(case, start, tol)
    run = simulate(case, end, {"turns": turns}, tol=tol, initial_state=state)
    time = run.final_state.time
    taken = run.samples["turns"]
    reached = Arrival(Settling())
    motion = MotionKind(Outcome.UNDECIDED)
    if run.status.complete:
        reached = arrival(case, [run])
        motion = _motion_reached(case, reached, run, tol)
    values: dict[str, Any] = {
        **{name: taken[name] for name in SAMPLED},
        **_answer(reached.settling, motion),
        "status": run.status.value,
        "phase": taken["phase"] + 1,  # 0 is "none"
        "first_separation": run.first_separation,
        "separations": int(run.statistics["n_separations"]),
        "transient_time": transient,
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


def _transient_of(
    case: Parameters, start: Start, transient: float, max_transient: float, tol: float
) -> _Transient:
    """The transient, doubled until the motion has settled; its run may end early."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.attractors import Arrival, arrival

    state = make_initial_state(case, start, tol)
    length = transient
    first = np.nan
    separations = 0
    legs: list[Result] = []
    while True:
        run = simulate(case, length, tol=tol, initial_state=state)
        if np.isnan(first):
            first = run.first_separation
        separations += int(run.statistics["n_separations"])
        if not run.status.complete:
            return _Transient(run, Arrival(Settling()), length, first, separations)
        legs.append(run)
        state = run.final_state
        reached = arrival(case, legs)
        if reached.settled or 2 * length > max_transient:
            return _Transient(run, reached, length, first, separations)
        length *= 2


def _at_switches(case: Parameters, before: _Transient, samples: int, tol: float) -> Answer:
    """Samples at separations, or at releases where there are none."""
    from disc_model.simulation.api import simulate
    from disc_model.stability.segments import stick_share

    if not before.run.status.complete:
        return _ended_early(before.run, before.first, before.separations)
    state = before.end
    reached = before.reached
    record = simulate(case, state.time + FIRST_LEG, tol=tol, initial_state=state)
    first = record.first_separation if np.isnan(before.first) else before.first
    separations = before.separations + int(record.statistics["n_separations"])
    if not record.status.complete:
        return _ended_early(record, first, separations)
    if reached.calm is not None:  # the run has its transient
        stick = stick_share(record)
    elif reached.near is not None:  # the attractor is known exactly
        stick = reached.near.cycle.stick_fraction
    else:
        stick = stick_share(before.run)
    events = record.events
    apart = bool((events["kind"] == "separation").any())
    taken = events[events["kind"] == ("separation" if apart else "stick_to_slip")]
    shown = taken.iloc[-samples:]
    values: dict[str, Any] = {
        "psi": shown["psi"].to_numpy(dtype=float),
        "psi_velocity": case.Omega - shown["f"].to_numpy(dtype=float),
        "P": shown["P"].to_numpy(dtype=float),
        "u": shown["u"].to_numpy(dtype=float),
        **_answer(reached.settling, _motion_reached(case, reached, before.run, tol)),
        "status": "ok",
        "phase": ["separation" if apart else "stick"] * len(shown),
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


def _ended_early(run: Result, first: float, separations: int) -> Answer:
    """What is known of a motion whose simulation ended early: its first separation, and the number of
    separations up to then."""
    known = {"status": run.status.value, "first_separation": first, "separations": separations}
    return known, f"the simulation ended early: {run.status}"


def _motion_reached(case: Parameters, reached: Arrival, run: Result, tol: float) -> MotionKind:
    """What a motion has come to at the end of a run: by the proof of its arrival, or else by its
    regularity if the record shows that it has settled."""
    from disc_model.stability.attractors import regularity

    if reached.calm is not None:
        return MotionKind(reached.calm)
    if reached.near is None:
        if not reached.settled:
            return MotionKind(Outcome.UNDECIDED)
        return regularity(case, run.final_state, tol)
    cycle = reached.near.cycle
    kind = "separation" if cycle.separations else "stick_to_slip"
    n = cycle.separations or cycle.releases
    times = run.events["time"][run.events["kind"] == kind]
    intervals = np.diff(times[times > run.final_state.time - FIRST_LEG])
    rest = closure(intervals, n) if n < len(intervals) else np.nan
    return MotionKind(reached.near.kind, n, rest)


def _answer(settling: Settling, motion: MotionKind) -> dict[str, Any]:
    """Columns that say whether a motion has settled, and on what."""
    return {
        "settled": settling.answer.value,
        "change_rate": settling.rate,
        "least_rate": settling.least,
        "kind": motion.kind,
        "period_events": motion.period,
        "period_residual": motion.closure,
    }
