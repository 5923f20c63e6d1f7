"""Initial states of the motions of a study: at rest, perturbed, or after another motion."""

from __future__ import annotations

from functools import lru_cache

from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.simulation import states
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Start
from disc_model.simulation.states import State


def make_initial_state(p: Parameters, start: Start, tol: float) -> State | None:
    """The initial state of a motion of case `p`, at time 0; None is the static start. Raises
    `SimulationError` if the preceding motion ends early, `ParameterError` if its disc has another
    number of modes."""
    state = None
    if start.prerun is not None:
        other = p.replace(**start.prerun.parameters)
        rules = []
        for name in ("n_diameters", "n_circles"):
            count = getattr(other, name)
            needed = getattr(p, name)
            path = f"start.prerun.parameters.{name}"
            rules.append((count == needed, path, count, f"must be that of the case, {needed}"))
        require(*rules)
        state = states.transfer_state(p, _end_of(other, start.prerun.time, tol))

    kick = {name: value for name, value in start.perturbation.items() if value}
    if not kick:
        return state
    if state is None:
        state = states.static_start(p)
    return states.perturb(p, state, **kick)


def state_after(p: Parameters, start: Start, time: float, tol: float) -> State:
    """The state of case `p` at a time (s) after its start; raises `SimulationError`."""
    run = simulate(p, time, tol=tol, initial_state=make_initial_state(p, start, tol), events=False)
    return run.raise_for_status().final_state


@lru_cache(maxsize=8)
def _end_of(p: Parameters, time: float, tol: float) -> State:
    return simulate(p, time, tol=tol).raise_for_status().final_state
