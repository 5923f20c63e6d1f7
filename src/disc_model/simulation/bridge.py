"""Between `Parameters` and `State` (modes in the order of `plate_modes`) and the engine's lanes."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from disc_model.data.variables import PHASES
from disc_model.engine import layout
from disc_model.engine.lanes import aligned
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import modal_damping, mode_arrays
from disc_model.schema import is_number, shown
from disc_model.simulation.result import State

CASES = 32
"""Cases whose constants are kept: less than a megabyte each."""


class Case(NamedTuple):
    """What the engine is given of a case.  Shared by all runs of the case, and therefore never written.

    model, start : the engine's constants, and the published start
    pairs, single : rows of `plate_modes` with and without nodal diameters
    lane : of the pairs' a
    places : of a, b, alpha and beta of every mode in `layout.State.disc`; b and beta mean nothing for `single`
    """

    model: layout.Model
    start: layout.State
    pairs: np.ndarray
    single: np.ndarray
    lane: np.ndarray
    places: np.ndarray


@lru_cache(maxsize=CASES)
def engine_case(p: Parameters) -> Case:
    """The engine's constants of a case; what equal parameters have found before is found again."""
    modes = mode_arrays(p)
    model = layout.build_model(
        modes.diameters,
        modes.omega,
        modes.psi,
        modal_damping(p),
        N=p.N,
        Omega=p.Omega,
        k=p.k,
        c=p.c,
        m=p.m,
        k_p=p.k_p,
        c_p=p.c_p,
        mu_s=p.mu_s,
        mu_k=p.mu_k,
        r_0=p.r_0,
        bonded=p.contact == "bonded",
    )
    pairs, single = np.flatnonzero(modes.diameters > 0), np.flatnonzero(modes.diameters == 0)
    lane, width = layout.pair_lanes(len(pairs)), len(model.shift)
    places = np.zeros((4, len(modes.diameters)), np.intp)
    places[:, pairs] = lane + np.array([[0], [layout.HALF], [width], [width + layout.HALF]])
    places[0::2, single] = 2 * width + np.arange(len(single)) + np.array([[0], [len(single)]])
    return Case(model, layout.build_state(model), pairs, single, lane, places)


def fresh_states(case: Case) -> tuple[layout.State, layout.State]:
    """Two states at the published start, a run's own: where it is, and where it looks ahead."""
    n, width, n0 = len(case.start.disc), len(case.model.force), len(case.model.force0)
    both = aligned(2 * n)  # in one piece, since to align takes longer than to cut
    both[:n] = both[n:] = case.start.disc
    return _state(both[:n], width, n0, case.start.x.copy()), _state(both[n:], width, n0, case.start.x.copy())


def _state(disc: np.ndarray, width: int, n0: int, x: np.ndarray) -> layout.State:
    y, g, end = 2 * width, 2 * width + n0, 2 * (width + n0)
    return layout.State(disc, disc[:width], disc[width:y], disc[y:g], disc[g:end], x)


def build_model(p: Parameters) -> layout.Model:
    """The engine's constants of a case, not to be written."""
    return engine_case(p).model


def read_state(p: Parameters, model: layout.Model, state: layout.State) -> State:
    """The engine's state as a `State`."""
    case = engine_case(p)
    modal = state.disc[case.places]
    modal[1::2, case.single] = 0.0  # b and beta
    modal.setflags(write=False)
    a, b, alpha, beta = modal
    x = state.x
    phase = int(x[layout.PHASE])
    u, v = float(x[layout.U]), float(x[layout.U_VELOCITY])
    if phase != layout.SEPARATION:
        u = float(model.force @ state.z + model.force0 @ state.y)
        v = float(model.force @ state.e + model.force0 @ state.g + x[layout.SPEED] * (model.slope @ state.z))
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
        a=a,
        b=b,
        alpha=alpha,
        beta=beta,
    )


def write_state(p: Parameters, model: layout.Model, given: State, state: layout.State) -> None:
    """Put ``given`` into the engine's state.

    Raises
    ------
    ParameterError
        If arrays have the wrong shape, numbers are not finite, or the phase contradicts the velocities.
    """
    _, _, pairs, single, lane, _ = engine_case(p)
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
