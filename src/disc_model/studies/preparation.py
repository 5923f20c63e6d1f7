"""The state in which a motion starts: after another motion, with a kick."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.simulation.api import published_start, simulate
from disc_model.simulation.result import State

if TYPE_CHECKING:
    from disc_model.studies.start import Start


def prepared(p: Parameters, start: Start, tol: float) -> State | None:
    """The state that a motion of case `p` starts from, at time 0; None is the published start.

    Raises
    ------
    SimulationError, ParameterError
        If the other motion ends early, or its parameters are not right.
    """
    kick = {name: value for name, value in start.kick.items() if value}
    state = None
    if start.prepare is not None:
        state = _end_of(p.replace(**start.prepare.parameters), start.prepare.time, tol)
    return kicked(p, published_start(p) if state is None else state, **kick) if kick else state


def kicked(p: Parameters, state: State, u: float = 0.0, u_velocity: float = 0.0, f: float = 0.0) -> State:
    """A state with something added to the slider's coordinates, the disc under it going along.

    Parameters
    ----------
    u : m, in the shape in which the disc gives way to a steady force at the slider: a_l grows by
        u (psi_l/omega_l^2) / sum psi^2/omega^2
    u_velocity : m/s, as a blow at the slider leaves it: alpha_l grows by u_velocity psi_l / sum psi^2
    f : rad/s; a slider that sticks then slips, one that is stopped then sticks
    """
    modes = mode_arrays(p)
    give = modes.psi / modes.omega**2
    speed = state.f + f
    phase, direction = state.phase, state.direction
    if f and phase != "separation":
        phase, direction = ("slip" if speed else "stick"), int(np.sign(speed))
    return state.replace(
        a=state.a + u * give / (modes.psi @ give),
        alpha=state.alpha + u_velocity * modes.psi / (modes.psi @ modes.psi),
        u=state.u + u,
        u_velocity=state.u_velocity + u_velocity,
        f=speed,
        phase=phase,
        direction=direction,
        known=0,
    )


@lru_cache(maxsize=8)
def _end_of(p: Parameters, time: float, tol: float) -> State:
    return simulate(p, time, tol=tol).raise_for_status().final_state.replace(time=0.0, time_low=0.0)
