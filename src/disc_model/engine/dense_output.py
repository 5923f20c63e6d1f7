"""State and contact force anywhere in a step: from the series or, in stick, in closed form."""

from .jit import inlined
from .jit.simd import WIDTH, splat, store
from .model import ROWS, lane_count
from .roots import dot, set_powers
from .series import displacement, load_at_start, velocity
from .state import DRIVE, LOAD, PHASE, PHI_RATE, PSI, SEPARATION, STICK, SURFACE_TURN, U_VELOCITY, U
from .stick_propagator import propagate_stick
from .transitions import force_in_stick, stick_force

CLOSED_FORM = 0  # in place of a series' order where stick has a closed form instead


@inlined
def _pairs_at(model, series, order, x, state):
    """Displacements and velocities of the pairs at x; even and odd powers do not wait for each
    other."""
    at = splat(x)
    square = splat(x * x)
    for b in range(0, lane_count(model), WIDTH):
        # from the highest orders down
        z = displacement(series, order, b)
        e = velocity(series, order, b)
        z_odd = displacement(series, order - 1, b)
        e_odd = velocity(series, order - 1, b)
        for k in range(order - 2, 0, -2):
            z = displacement(series, k, b) + z * square
            e = velocity(series, k, b) + e * square
            z_odd = displacement(series, k - 1, b) + z_odd * square
            e_odd = velocity(series, k - 1, b) + e_odd * square
        z = displacement(series, 0, b) + z * square
        e = velocity(series, 0, b) + e * square
        store(state.z, b, z + z_odd * at)
        store(state.e, b, e + e_odd * at)


@inlined
def state_at(model, series, order, x, phase, state):
    """Fill ``state`` with the series' value, of even order, at x (time units); u, u' only where
    they are not the disc's."""
    powers = series.powers
    set_powers(powers, x, order)
    psi = dot(series.psi, 0, powers, order)
    f = dot(series.f, 0, powers, order)
    _pairs_at(model, series, order, x, state)
    for j in range(len(model.mode_amplitude0)):
        state.y[j] = dot(series.y, j * ROWS, powers, order)
        state.g[j] = dot(series.g, j * ROWS, powers, order)
    if model.has_compliance or phase == SEPARATION:
        state.x[U] = dot(series.u, 0, powers, order)
        state.x[U_VELOCITY] = dot(series.v, 0, powers, order)
    state.x[PHASE] = phase
    state.x[PSI] = psi
    state.x[PHI_RATE] = 0.0 if phase == STICK else f
    if model.has_moving_surface:
        state.x[SURFACE_TURN] = dot(series.turn, 0, powers, order)
    if model.has_ramp:
        state.x[DRIVE] = series.drive[0] + x * series.drive[1]
        state.x[LOAD] = load_at_start(model, series) + x * series.preload[1]


@inlined
def move_to(model, series, order, x, phase, state):
    """Fill ``state`` with the dense output at x: the series of this order, or the closed form of
    stick."""
    if order == CLOSED_FORM:
        propagate_stick(model, series, x, state)
    else:
        state_at(model, series, order, x, phase, state)


@inlined
def force_at(model, series, order, phase, state):
    """Return the contact force where ``move_to`` has put ``state``, which leaves the powers of that
    place in ``series.powers``."""
    if order == CLOSED_FORM:
        return stick_force(model, state)
    if phase == SEPARATION:
        return 0.0
    P = dot(series.P, 0, series.powers, order)
    if model.has_normal_force and phase == STICK:
        return force_in_stick(model, state, P)
    return P
