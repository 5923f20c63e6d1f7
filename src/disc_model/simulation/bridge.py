"""Between `State` (modes in the order of `plate_modes`) and the engine's lanes."""

from __future__ import annotations

import numpy as np

from disc_model.data.variables import PHASES
from disc_model.engine import layout
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.simulation.result import State


def read_state(p: Parameters, model: layout.Model, state: layout.State) -> State:
    """The engine's state as a `State`."""
    pairs, single, lane = _places(p)
    modal = {name: np.zeros(len(pairs) + len(single)) for name in ("a", "b", "alpha", "beta")}
    modal["a"][pairs], modal["b"][pairs] = state.z[lane], state.z[lane + layout.HALF]
    modal["alpha"][pairs], modal["beta"][pairs] = state.e[lane], state.e[lane + layout.HALF]
    modal["a"][single], modal["alpha"][single] = state.y[: len(single)], state.g[: len(single)]
    x = state.x
    phase = int(x[layout.PHASE])
    u, v = float(x[layout.U]), float(x[layout.U_VELOCITY])
    if phase != layout.SEPARATION:
        u = float(model.force @ state.z + model.force0 @ state.y)
        v = float(model.force @ state.e + model.force0 @ state.g + x[layout.SPEED] * (model.slope @ state.z))
    for array in modal.values():
        array.setflags(write=False)
    return State(
        time=float(x[layout.TIME]),
        time_low=float(x[layout.TIME_LOW]),
        phase=PHASES[phase],
        direction=int(x[layout.DIRECTION]),
        psi=float(x[layout.PSI]),
        f=float(x[layout.SPEED]),
        u=u,
        u_velocity=v,
        known=int(x[layout.KNOWN]),
        **modal,
    )


def write_state(p: Parameters, model: layout.Model, given: State, state: layout.State) -> None:
    """Put ``given`` into the engine's state.

    Raises
    ------
    ParameterError
        If arrays have the wrong shape, numbers are not finite, or the phase contradicts the velocities.
    """
    pairs, single, lane = _places(p)
    faults = _faults(given, len(pairs) + len(single))
    if faults:
        raise ParameterError(*faults)
    for array in (state.z, state.e, state.y, state.g, state.x):
        array[:] = 0.0
    state.z[lane], state.z[lane + layout.HALF] = given.a[pairs], given.b[pairs]
    state.e[lane], state.e[lane + layout.HALF] = given.alpha[pairs], given.beta[pairs]
    state.y[: len(single)], state.g[: len(single)] = given.a[single], given.alpha[single]
    x = state.x
    x[layout.TIME], x[layout.TIME_LOW] = given.time, given.time_low
    x[layout.PSI], x[layout.SPEED] = given.psi, given.f
    x[layout.U], x[layout.U_VELOCITY] = given.u, given.u_velocity
    x[layout.PHASE], x[layout.DIRECTION] = PHASES.index(given.phase), given.direction
    x[layout.KNOWN] = given.known


def _places(p: Parameters) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows of the pairs, rows of the axisymmetric modes, lanes of the pairs' a."""
    diameters = mode_arrays(p).diameters
    pairs = np.flatnonzero(diameters > 0)
    return pairs, np.flatnonzero(diameters == 0), layout.pair_lanes(len(pairs))


def _faults(given: State, n_modes: int) -> list[str]:
    faults = []
    for name in ("a", "b", "alpha", "beta"):
        array = np.asarray(getattr(given, name))
        if array.shape != (n_modes,) or not np.all(np.isfinite(array)):
            faults.append(f"initial_state.{name}: must be {n_modes} finite numbers, one per row of plate_modes")
    for name in ("time", "psi", "f", "u", "u_velocity"):
        if not np.isfinite(getattr(given, name)):
            faults.append(f"initial_state.{name}={getattr(given, name)!r}: must be finite")
    # the clock's compensation is at most a unit in the last place of the time
    if not abs(given.time_low) <= np.spacing(abs(float(given.time))):
        faults.append(f"initial_state.time_low={given.time_low!r}: must be less than the last digit of the time")
    if given.known not in range(4):
        faults.append(f"initial_state.known={given.known!r}: must be 0, 1, 2 or 3")
    if given.phase not in PHASES:
        faults.append(f"initial_state.phase={given.phase!r}: must be one of {', '.join(PHASES)}")
    elif given.phase == "stick" and given.f != 0:
        faults.append(f"initial_state.f={given.f!r}: must be 0 in stick")
    elif given.phase == "slip" and given.direction not in (-1, 1):
        faults.append(f"initial_state.direction={given.direction!r}: must be -1 or 1 in slip")
    elif given.phase == "slip" and given.f * given.direction < 0:
        faults.append(f"initial_state.f={given.f!r}: must have the sign of direction={given.direction}")
    return faults
