"""State and contact force at a point of the dense output."""

from __future__ import annotations

from .coasting import coast_to
from .compile import inlined
from .lanes import WIDTH, fma, item, load, splat, store
from .layout import (
    DRIVE,
    DRIVE_SERIES,
    LOAD,
    LOAD_SERIES,
    PHASE,
    PSI,
    SEPARATION,
    SPEED,
    STICK,
    U_VELOCITY,
    E,
    U,
    is_compliant,
    is_normal,
    is_ramped,
    ramp_of,
)
from .polynomial import value
from .series import lane_count
from .switches import force_in_stick, stick_force

# Stands for the order of a series where stick has no series but its closed form.
COAST = 0


@inlined
def _modes_at(model, s, order, x, state):
    """Modal displacements and velocities at x."""
    width, n, at = lane_count(model), len(model.force0), splat(x)
    for b in range(0, width, WIDTH):
        i = order * width + b
        z, e = load(s.modes, i), load(s.modes, E * width + i)
        for _ in range(order):
            i -= width
            z, e = fma(z, at, load(s.modes, i)), fma(e, at, load(s.modes, E * width + i))
        store(state.z, b, z)
        store(state.e, b, e)
    for j in range(n):
        i = order * n + j
        y, g = item(s.y, i), item(s.g, i)
        for _ in range(order):
            i -= n
            y, g = y * x + item(s.y, i), g * x + item(s.g, i)
        state.y[j], state.g[j] = y, g


@inlined
def state_at(model, s, order, x, phase, state):
    """Fill ``state`` with the series' value at x (time units); u, u' only where they are not the disc's."""
    _modes_at(model, s, order, x, state)
    psi, f = item(s.psi, order), item(s.f, order)
    if is_compliant(model) or phase == SEPARATION:
        # in one loop: each of the four waits for its own last term only
        u, v = item(s.u, order), item(s.v, order)
        for k in range(order - 1, -1, -1):
            psi, f = psi * x + item(s.psi, k), f * x + item(s.f, k)
            u, v = u * x + item(s.u, k), v * x + item(s.v, k)
        state.x[U], state.x[U_VELOCITY] = u, v
    else:
        for k in range(order - 1, -1, -1):
            psi, f = psi * x + item(s.psi, k), f * x + item(s.f, k)
    state.x[PHASE] = phase
    state.x[PSI] = psi
    state.x[SPEED] = 0.0 if phase == STICK else f
    if is_ramped(model):
        state.x[DRIVE] = s.slider[DRIVE_SERIES] + x * s.slider[DRIVE_SERIES + 1]
        state.x[LOAD] = s.slider[LOAD_SERIES] + x * s.slider[LOAD_SERIES + 1]


@inlined
def move_to(model, s, order, x, phase, state):
    """Fill ``state`` with the dense output at x (time units): the series of this order, or the closed form of stick."""
    if order == COAST:
        coast_to(model, s, x, state)
    else:
        state_at(model, s, order, x, phase, state)


@inlined
def force_at(model, s, order, x, phase, state):
    """Contact force at x, where ``move_to`` has put ``state``."""
    if order == COAST:
        return stick_force(model, state)
    if phase == SEPARATION:
        return 0.0
    P = value(s.P, 0, order - 1, x)
    return force_in_stick(model, state, P) if is_normal(model) and phase == STICK else P


@inlined
def load_state(model, s, state):
    """The series' coefficients 0 from ``state``."""
    for b in range(0, len(state.z), WIDTH):
        store(s.z, b, load(state.z, b))
        store(s.e, b, load(state.e, b))
    for j in range(len(state.y)):
        s.y[j], s.g[j] = state.y[j], state.g[j]
    s.psi[0] = state.x[PSI]
    s.f[0] = state.x[SPEED]
    s.u[0] = state.x[U]
    s.v[0] = state.x[U_VELOCITY]
    if is_ramped(model):
        s.slider[DRIVE_SERIES], s.slider[DRIVE_SERIES + 1] = state.x[DRIVE], ramp_of(model.ramp, 2) * model.unit
        s.slider[LOAD_SERIES], s.slider[LOAD_SERIES + 1] = state.x[LOAD], ramp_of(model.ramp, 3) * model.unit
