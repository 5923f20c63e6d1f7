"""Samples of the settled motion at its events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from xarray import Dataset

from disc_model.analysis.classify import Motion as MotionKind
from disc_model.analysis.classify import Settled
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import STATIC, Motion, Row, found, quantity
from disc_model.units import Seconds, Size, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.result import Result
    from disc_model.simulation.states import State
    from disc_model.stability.attractors import Arrival

LATE = 5.0  # s, of motion from which samples and a period are taken: dozens of cycles


def _settled(
    case: Parameters, *, transient: float, max_transient: float, start: Start, tol: float, **_: Any
) -> State:
    """The state in which samples begin."""
    legs, reached = _transient_of(case, start, transient, max_transient, tol)
    return reached.end(legs[-1])


@quantity(
    points_per_job=110,
    rules=(
        (
            lambda o: o.max_transient >= o.transient,
            "max_transient={0.max_transient:g} must be >= transient={0.transient:g}",
        ),
    ),
    motion=Motion(100, "After the transient.", _settled),
)
def bifurcation(
    case: Parameters,
    *,
    transient: Seconds,
    max_transient: Seconds = 480.0,
    samples: Size = 50,
    start: Start = STATIC,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Samples of the motion after a transient, for bifurcation diagrams, at separations if there are any, else at
    releases: a periodic motion shows as many points as its period has events.

    Parameters
    ----------
    transient : time left out at the beginning, doubled until the motion has settled
    max_transient : longest time left out
    samples : number of samples
    start : start of the motion
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.bifurcation(dm.Parameters(N=385, Omega=15), transient=20, samples=3)["kind"].item()
    'stick_slip'
    """
    legs, reached = _transient_of(case, start, transient, max_transient, tol)
    values = _at_switches(case, legs, reached, samples, tol)
    message = ""
    if values["settled"] != "settled":
        message = f"{values['settled']} after {reached.stay:g} s: raise max_transient"
    values |= {"status": "ok", "transient_time": reached.stay}
    return found("bifurcation", values, message, sample=range(samples))


def _transient_of(
    case: Parameters, start: Start, transient: float, max_transient: float, tol: float
) -> tuple[list[Result], Arrival]:
    """The runs of the time left out, and what they have come to; raises `SimulationError`."""
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.attractors import settle

    state = make_initial_state(case, start, tol)
    legs, reached = settle(case, state, transient, max_transient, tol)
    legs[-1].raise_for_status()
    return legs, reached


def _at_switches(
    case: Parameters, legs: list[Result], reached: Arrival, samples: int, tol: float
) -> Row:
    """Samples at separations, or at releases where there are none."""
    from disc_model.simulation.api import simulate
    from disc_model.stability.segments import stick_share

    last = legs[-1]
    state = reached.end(last)
    record = simulate(case, state.time + LATE, tol=tol, initial_state=state).raise_for_status()
    every = [*legs, record]
    firsts = [run.first_separation for run in every if not np.isnan(run.first_separation)]
    if reached.near is not None:  # the attractor is known exactly
        stick = reached.near.cycle.stick_fraction
    else:
        stick = stick_share(last if reached.calm is None else record)
    events = record.events
    taken, phase = events[events["kind"] == "separation"], "separation"
    if taken.empty:
        taken, phase = events[events["kind"] == "stick_to_slip"], "stick"
    shown = taken.iloc[-samples:]
    return {
        **{name: shown[name].to_numpy(dtype=float) for name in ("psi", "P", "u")},
        "psi_velocity": case.Omega - shown["f"].to_numpy(dtype=float),
        **_motion_reached(case, reached, last, tol),
        "phase": [phase] * len(shown),
        "first_separation": next(iter(firsts), np.nan),
        "separations": sum(int(run.statistics["n_separations"]) for run in every),
        "stick_fraction": stick,
    }


def _motion_reached(case: Parameters, reached: Arrival, run: Result, tol: float) -> Row:
    """Columns that say whether a motion has settled at the end of a run, and on what: by the proof of its
    arrival, or else by its regularity if the record shows that it has settled."""
    from disc_model.stability.attractors import regularity

    motion = MotionKind(reached.calm or Outcome.UNDECIDED)
    if reached.near is not None:
        cycle = reached.near.cycle
        motion = MotionKind(reached.near.kind, cycle.separations or cycle.releases)
    elif reached.calm is None and reached.answer is Settled.SETTLED:
        motion = regularity(case, run.final_state, tol)
    return {"settled": reached.answer.value, "kind": motion.kind, "period_events": motion.period}
