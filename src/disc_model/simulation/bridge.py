"""Between `State` (modes in the order of `plate_modes`) and the engine's lanes."""

from __future__ import annotations

import math

import numpy as np

from disc_model.data.variables import PHASES
from disc_model.engine import layout
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.schema import is_number, shown
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
    a, b, alpha, beta = (np.asarray(array, dtype=float) for array in (given.a, given.b, given.alpha, given.beta))
    state.z[lane], state.z[lane + layout.HALF] = a[pairs], b[pairs]
    state.e[lane], state.e[lane + layout.HALF] = alpha[pairs], beta[pairs]
    state.y[: len(single)], state.g[: len(single)] = a[single], alpha[single]
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
    faults: list[str] = []

    def add(name: str, rule: str, value: object = None) -> None:
        faults.append(Fault(("initial_state", name), "" if value is None else shown(value), rule))

    for name in ("a", "b", "alpha", "beta"):
        if not _is_finite_array(getattr(given, name), n_modes):
            add(name, f"must be {n_modes} finite numbers, one per row of plate_modes")
    finite = {name: _is_finite(getattr(given, name)) for name in ("time", "time_low", "psi", "f", "u", "u_velocity")}
    for name in ("time", "psi", "f", "u", "u_velocity"):
        if not finite[name]:
            add(name, "must be finite", getattr(given, name))
    # the clock's compensation is at most a unit in the last place of the time
    last_digit = np.spacing(abs(float(given.time))) if finite["time"] else math.inf
    if not (finite["time_low"] and abs(given.time_low) <= last_digit):
        add("time_low", "must be less than the last digit of the time", given.time_low)
    if given.known not in range(4):
        add("known", "must be 0, 1, 2 or 3", given.known)
    if given.phase not in PHASES:
        add("phase", f"must be one of {', '.join(PHASES)}", given.phase)
    elif given.phase == "stick" and finite["f"] and given.f != 0:
        add("f", "must be 0 in stick", given.f)
    elif given.phase == "slip" and given.direction not in (-1, 1):
        add("direction", "must be -1 or 1 in slip", given.direction)
    elif given.phase == "slip" and finite["f"] and given.f * given.direction < 0:
        add("f", f"must have the sign of direction={given.direction}", given.f)
    return faults


def _is_finite(value: object) -> bool:
    return is_number(value) and math.isfinite(value)  # type: ignore[arg-type]


def _is_finite_array(values: object, size: int) -> bool:
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        return False
    return array.shape == (size,) and bool(np.all(np.isfinite(array)))
