"""Samples of the settled motion at its events."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from xarray import Dataset

from disc_model.analysis.classify import Motion, Settled
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import STATIC, Row, found, quantity
from disc_model.units import Seconds, Size, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.result import Result
    from disc_model.stability.attractors import Arrival

LATE = 5.0  # s, of motion from which samples are taken: dozens of cycles


@quantity(
    points_per_job=110,
    rules=(
        (
            lambda o: o.max_transient >= o.transient,
            "max_transient={0.max_transient:g} must be >= transient={0.transient:g}",
        ),
    ),
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
    from disc_model.simulation.api import simulate
    from disc_model.simulation.starts import make_initial_state
    from disc_model.stability.attractors import settle

    first = make_initial_state(case, start, tol)
    legs, reached = settle(case, first, transient, max_transient, tol)
    last = legs[-1].raise_for_status()
    state = reached.end(last)
    record = simulate(case, state.time + LATE, tol=tol, initial_state=state).raise_for_status()
    every = [*legs, record]
    separations = [run.first_separation for run in every if not np.isnan(run.first_separation)]
    events = record.events
    taken, phase = events[events["kind"] == "separation"], "separation"
    if taken.empty:
        taken, phase = events[events["kind"] == "stick_to_slip"], "stick"
    shown = taken.iloc[-samples:]
    settled = reached.answer.value
    values = {
        **{name: shown[name].to_numpy(dtype=float) for name in ("psi", "P", "u")},
        "psi_velocity": case.Omega - shown["f"].to_numpy(dtype=float),
        "phase": [phase] * len(shown),
        "first_separation": next(iter(separations), np.nan),
        "separations": sum(int(run.statistics["n_separations"]) for run in every),
        "transient_time": reached.stay,
        "settled": settled,
        **_attractor(case, reached, last, record, tol),
    }
    message = ""
    if settled != "settled":
        message = f"{settled} after {reached.stay:g} s: raise max_transient"
    return found("bifurcation", values, message, sample=range(samples))


def _attractor(case: Parameters, reached: Arrival, last: Result, record: Result, tol: float) -> Row:
    """Columns of what a motion has come to: by the proof of its arrival, or else by its regularity if the last
    run shows that it has settled."""
    from disc_model.stability.attractors import regularity
    from disc_model.stability.segments import stick_share

    motion = Motion(reached.calm or Outcome.UNDECIDED)
    if reached.calm is not None:
        stick = stick_share(record)
    elif reached.near is not None:  # known exactly
        cycle = reached.near.cycle
        stick = cycle.stick_fraction
        motion = Motion(reached.near.kind, cycle.separations or cycle.releases)
    else:
        stick = stick_share(last)
        if reached.answer is Settled.SETTLED:
            motion = regularity(case, last.final_state, tol)
    return {"kind": motion.kind, "period_events": motion.period, "stick_fraction": stick}
