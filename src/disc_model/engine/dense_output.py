"""State and contact force at a point of the dense output."""

from . import layout
from .jit import inlined
from .jit.simd import WIDTH, fma, load, splat, store
from .layout import DRIVE_SERIES, LOAD_SERIES, ROWS, E
from .polynomial import dot, set_powers
from .series import lane_count
from .stick_propagator import propagate_stick
from .transitions import force_in_stick, stick_force

# In place of a series' order where stick has a closed form instead.
CLOSED_FORM = 0


@inlined
def _pairs_at(model, s, order, x, state):
    """Displacements and velocities of the pairs at x; even and odd powers do not wait for each other."""
    width, at, square = lane_count(model), splat(x), splat(x * x)
    for b in range(0, width, WIDTH):
        i = order * width + b
        z, e = load(s.modes, i), load(s.modes, E * width + i)
        z_odd, e_odd = load(s.modes, i - width), load(s.modes, E * width + i - width)
        for _ in range(order // 2 - 1):
            i -= 2 * width
            z, e = fma(z, square, load(s.modes, i)), fma(e, square, load(s.modes, E * width + i))
            z_odd = fma(z_odd, square, load(s.modes, i - width))
            e_odd = fma(e_odd, square, load(s.modes, E * width + i - width))
        store(state.z, b, fma(z_odd, at, fma(z, square, load(s.modes, b))))
        store(state.e, b, fma(e_odd, at, fma(e, square, load(s.modes, E * width + b))))


@inlined
def state_at(model, s, order, x, phase, state):
    """Fill ``state`` with the series' value at x (time units); u, u' only where they are not the disc's.

    The order is even.
    """
    set_powers(s.powers, x, order)
    psi, f = dot(s.psi, 0, s.powers, order), dot(s.f, 0, s.powers, order)
    _pairs_at(model, s, order, x, state)
    for j in range(len(model.mode_amplitude0)):
        state.y[j], state.g[j] = dot(s.y, j * ROWS, s.powers, order), dot(s.g, j * ROWS, s.powers, order)
    if model.compliant or phase == layout.SEPARATION:
        state.x[layout.U] = dot(s.u, 0, s.powers, order)
        state.x[layout.U_VELOCITY] = dot(s.v, 0, s.powers, order)
    state.x[layout.PHASE] = phase
    state.x[layout.PSI] = psi
    state.x[layout.F] = 0.0 if phase == layout.STICK else f
    if model.ramped:
        state.x[layout.DRIVE] = s.slider[DRIVE_SERIES] + x * s.slider[DRIVE_SERIES + 1]
        state.x[layout.LOAD] = s.slider[LOAD_SERIES] + x * s.slider[LOAD_SERIES + 1]


@inlined
def move_to(model, s, order, x, phase, state):
    """Fill ``state`` with the dense output at x (time units): the series of this order, or the closed form of stick."""
    if order == CLOSED_FORM:
        propagate_stick(model, s, x, state)
    else:
        state_at(model, s, order, x, phase, state)


@inlined
def force_at(model, s, order, phase, state):
    """Contact force where ``move_to`` has put ``state``, which leaves the powers of that place in ``s.powers``."""
    if order == CLOSED_FORM:
        return stick_force(model, state)
    if phase == layout.SEPARATION:
        return 0.0
    P = dot(s.P, 0, s.powers, order)
    return force_in_stick(model, state, P) if model.normal and phase == layout.STICK else P


@inlined
def load_state(model, s, state):
    """The series' coefficients 0 from ``state``."""
    for b in range(0, len(state.z), WIDTH):
        store(s.z, b, load(state.z, b))
        store(s.e, b, load(state.e, b))
    for j in range(len(state.y)):
        s.y[j * ROWS], s.g[j * ROWS] = state.y[j], state.g[j]
    s.psi[0], s.f[0] = state.x[layout.PSI], state.x[layout.F]
    s.u[0], s.v[0] = state.x[layout.U], state.x[layout.U_VELOCITY]
    if model.ramped:
        s.slider[DRIVE_SERIES], s.slider[DRIVE_SERIES + 1] = state.x[layout.DRIVE], model.Omega_rate * model.unit
        s.slider[LOAD_SERIES], s.slider[LOAD_SERIES + 1] = state.x[layout.LOAD], model.N_rate * model.unit
