"""Initial states of the motions of a study: at rest, perturbed, or after another motion."""

from __future__ import annotations

from functools import lru_cache

from disc_model.disc.plate import mode_arrays
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.simulation import states
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Start
from disc_model.simulation.states import State
from disc_model.units import Tolerance, checked


@checked
def initial_state(case: Parameters, start: Start | None = None, *, tol: Tolerance = 1e-10) -> State:
    """State from which `outcome`, or a point of a study, starts, for the `initial_state` of
    `simulate`, `snapshots` and `lyapunov_exponents`.

    Parameters
    ----------
    case : the case
    start : as in `outcome` and in study files, by name: u (m), u_velocity (m/s) and f (rad/s) are added to the static
        start, or to the state after a "prerun", another case that is simulated first, from the static start: its
        "parameters" that differ from the case's, which must leave the modes of the disc as they are, and the "time" (s)
        after which its state is taken
    tol : as in `simulate`, of the prerun

    Returns
    -------
    State
        At time 0.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.
    SimulationError
        If the prerun ends early.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=13)
    >>> pushed = dm.initial_state(case, {"u": -0.00275, "u_velocity": 1.375})
    >>> run = dm.simulate(case, 60, initial_state=pushed)
    >>> print(f"{dm.simulate(case, 60).first_separation} s, {run.first_separation:.2f} s")
    nan s, 42.23 s
    """
    return make_initial_state(case, start or Start(), tol) or states.static_start(case)


def make_initial_state(p: Parameters, start: Start, tol: float) -> State | None:
    """The initial state of a motion of case `p`, at time 0; None is the static start. Raises
    `SimulationError` if the preceding motion ends early, `ParameterError` if its disc has other
    modes."""
    state = None
    if start.prerun is not None:
        other = p.replace(**start.prerun.parameters)
        state = _end_of(other, start.prerun.time, tol).replace(time=0.0)
        same = states.belongs_to(state, mode_arrays(p).psi)
        rule = "must leave the modes of the disc as they are"
        require((same, "start.prerun.parameters", start.prerun.parameters, rule))
    kick = {name: value for name, value in start if name != "prerun" and value}
    if not kick:
        return state
    return states.perturb(p, state or states.static_start(p), **kick)


def state_after(p: Parameters, start: Start, time: float, tol: float) -> State:
    """The state of case `p` at a time (s) after its start; raises `SimulationError`."""
    run = simulate(p, time, tol=tol, initial_state=make_initial_state(p, start, tol), events=False)
    return run.raise_for_status().final_state


@lru_cache(maxsize=8)
def _end_of(p: Parameters, time: float, tol: float) -> State:
    return simulate(p, time, tol=tol).raise_for_status().final_state
