"""Small changes across an event: the saltation matrix, applied to columns.

At an event h = 0 the columns change with the jump of the vector field. With dtau = -dh / h' the change of the event's
time, J the Jacobian of the jump and v the rates before and after,

    dx(after) = J (dx(before) + v(before) dtau) - v(after) dtau.
"""

from . import laws, tangent, transitions
from .jit import helper, inlined, kernel
from .jit.simd import WIDTH, fma, load, mul, splat, store, sub, total
from .layout import DIRECTION, HALF, PHASE, PSI, SEPARATION, SLIP, STICK, U_VELOCITY, F, U
from .tangent import N_SCALARS, point_change, slider_row
from .transitions import CONSISTENT, NO_SOLUTION, RETURNED, change_phase, disc_point, event_function, instant

PASSED = 1e-9  # radians of the fastest motion by which a root was passed before the phase began; less is rounding


@kernel
def rates(model, state, out):
    """Rates of all rows in the state's phase, into the first lane of ``out`` ([row][8])."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    phase, direction = state.x[PHASE], state.x[DIRECTION]
    i, _ = instant(model, state)
    f, V, T, rate_f = i.f, 0.0, 0.0, 0.0
    if phase == STICK:
        V = laws.vertical_in_stick(model, i)
        T = laws.friction_in_stick(model, i, V)
    elif phase == SLIP:
        friction = laws.friction_coefficient(model, direction, f)
        force = laws.slip_numerator(model, i) / laws.slip_denominator(model, i.m, friction, i.dw_dtheta)
        V, rate_f = laws.slip_rates(model, i, friction, force)
        T = friction * force
    else:
        rate_f = laws.inplane_force_per_radius(i) / i.m
    for j in range(width):
        other = j + HALF if j % WIDTH < HALF else j - HALF
        out[j * WIDTH] = state.e[j] + model.shift[j] * f * state.z[other]
        rate = model.shift[j] * f * state.e[other] - model.damping[j] * state.e[j] - model.stiffness[j] * state.z[j]
        out[(width + j) * WIDTH] = rate - model.mode_amplitude[j] * V
        if model.coupled:
            out[(width + j) * WIDTH] -= model.couple[j] * T
    for j in range(n0):
        out[(2 * width + j) * WIDTH] = state.g[j]
        rate = -model.damping0[j] * state.g[j] - model.stiffness0[j] * state.y[j]
        out[(2 * width + n0 + j) * WIDTH] = rate - model.mode_amplitude0[j] * V
    out[slider_row(model, PSI) * WIDTH] = model.Omega - f
    out[slider_row(model, F) * WIDTH] = rate_f
    u, v = (i.u, i.u_velocity) if model.compliant or phase == SEPARATION else (i.w, i.w_velocity)
    out[slider_row(model, U) * WIDTH] = v
    out[slider_row(model, U_VELOCITY) * WIDTH] = (V - model.N - model.k * (u - model.u_0) - model.c * v) / model.m


@inlined
def _free_change(model, state, x, at, q, parameters, changes):
    """Change of A, ``transitions.Instant.free`` (lanes)."""
    width, n0, f = len(model.mode_amplitude), len(model.mode_amplitude0), state.x[F]
    df, acceleration = load(x, at + slider_row(model, F) * WIDTH), splat(0.0)
    for j in range(width):
        if model.shift[j] > 0.0:
            i, l = j + HALF, model.shift[j]
            z, e = load(x, at + j * WIDTH), load(x, at + (width + j) * WIDTH)
            part = fma(splat(-(model.stiffness[j] + (l * f) ** 2)), z, mul(splat(-model.damping[j]), e))
            part = fma(splat(2.0 * l * f), load(x, at + (width + i) * WIDTH), part)
            part = fma(splat(2.0 * l * state.e[i] - 2.0 * l * l * f * state.z[j]), df, part)
            if changes:
                part = sub(part, mul(splat(state.z[j]), load(parameters, q + (N_SCALARS + j) * WIDTH)))
                part = sub(part, mul(splat(state.e[j]), load(parameters, q + (N_SCALARS + width + j) * WIDTH)))
            acceleration = fma(splat(model.mode_amplitude[j]), part, acceleration)
    for j in range(n0):
        y, g = load(x, at + (2 * width + j) * WIDTH), load(x, at + (2 * width + n0 + j) * WIDTH)
        part = fma(splat(-model.stiffness0[j]), y, mul(splat(-model.damping0[j]), g))
        if changes:
            part = sub(part, mul(splat(state.y[j]), load(parameters, q + (N_SCALARS + 2 * width + j) * WIDTH)))
            part = sub(part, mul(splat(state.g[j]), load(parameters, q + (N_SCALARS + 2 * width + n0 + j) * WIDTH)))
        acceleration = fma(splat(model.mode_amplitude0[j]), part, acceleration)
    return acceleration


@inlined
def _change(t, row):
    """Change of the law whose derivatives stand in a row of ``t.gradient``, for the columns of ``t.change`` (lanes)."""
    change = splat(0.0)
    for entry in range(laws.N_ENTRIES):
        change = fma(splat(t.gradient[row * laws.N_ENTRIES + entry]), load(t.change, entry * WIDTH), change)
    return change


@inlined
def put_changes(model, state, t, x, c, changes):
    """Changes of an instant's entries for the block of columns x that begins with ``c``, into ``t.change``;
    ``changes``: whether columns change parameters. Returns that of the law whose derivatives begin ``t.gradient``."""
    at, q, slider = c * t.rows, c * t.inputs, c * t.rows + slider_row(model, 0) * WIDTH
    for entry in range(N_SCALARS):
        store(t.change, entry * WIDTH, load(t.parameters, q + entry * WIDTH) if changes else splat(0.0))
    _, _, dw_dtheta = disc_point(model, state)
    dw, dv, d_slope = point_change(model, x, at, state.x[F], dw_dtheta)
    store(t.change, laws.PSI_ENTRY * WIDTH, load(x, slider + PSI * WIDTH))
    store(t.change, laws.F_ENTRY * WIDTH, load(x, slider + F * WIDTH))
    store(t.change, laws.W_ENTRY * WIDTH, dw)
    store(t.change, laws.W_VELOCITY_ENTRY * WIDTH, dv)
    store(t.change, laws.DW_DTHETA_ENTRY * WIDTH, d_slope)
    store(t.change, laws.FREE_ENTRY * WIDTH, _free_change(model, state, x, at, q, t.parameters, changes))
    store(t.change, laws.U_ENTRY * WIDTH, load(x, slider + U * WIDTH))
    store(t.change, laws.U_VELOCITY_ENTRY * WIDTH, load(x, slider + U_VELOCITY * WIDTH))
    return _change(t, 0)


@inlined
def _set_derivative(model, i, t, row, entry, value):
    """Enter a derivative, ``value`` being the law's after a complex step of an entry. The columns' change of N contains
    that of -k u_0, and their change of the compliance is relative."""
    derivative = value.imag / laws.TINY
    if entry == tangent.D_K:
        derivative += model.u_0 * t.gradient[row * laws.N_ENTRIES + tangent.LOAD]
    elif entry == tangent.D_COMPLIANCE:
        derivative *= i.compliance
    t.gradient[row * laws.N_ENTRIES + entry] = derivative


@helper
def event_gradient(model, state, t, cause):
    """Derivatives of the event function of ``cause``, into ``t.gradient``."""
    i, _ = instant(model, state)
    slipping = state.x[PHASE] == SLIP
    for entry in range(laws.N_ENTRIES):
        _set_derivative(model, i, t, 0, entry, event_function(model, laws.stepped(i, entry), cause, slipping))


@helper
def event_times(model, state, t, cause, at_once):
    """``t.tau``: change of the time of the event ``cause`` for every column.  Returns the event function's rate. A
    phase that ended ``at_once``, its event function negative from the start, does so in neighbouring motions, too."""
    event_gradient(model, state, t, cause)
    rate = total(put_changes(model, state, t, t.before, 0, False))  # the other lanes of ``before`` are zero
    i, _ = instant(model, state)
    value = abs(event_function(model, i, cause, state.x[PHASE] == SLIP))
    by_rate = 0.0 if at_once and value > PASSED * model.unit * abs(rate) else -1.0 / rate
    for c in range(0, t.columns, WIDTH):
        store(t.tau, c, mul(splat(by_rate), put_changes(model, state, t, t.now, c, c >= t.plain)))
    return rate


@helper
def shift(t, rates_at, sign):
    """t.now += sign * rates * tau."""
    for c in range(0, t.columns, WIDTH):
        tau = load(t.tau, c)
        for r in range(t.rows):
            at = c * t.rows + r * WIDTH
            store(t.now, at, fma(splat(sign * rates_at[r * WIDTH]), tau, load(t.now, at)))


@helper
def impact_change(model, state, t):
    """Jacobian of the plastic impact, applied to the columns; ``state`` is the one before."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    i, _ = instant(model, state)
    for entry in range(laws.N_ENTRIES):
        p, f = laws.impact(model, laws.stepped(i, entry))
        _set_derivative(model, i, t, 0, entry, p)
        _set_derivative(model, i, t, 1, entry, f)
    for c in range(0, t.columns, WIDTH):
        block, dp = c * t.rows, put_changes(model, state, t, t.now, c, c >= t.plain)
        store(t.now, block + slider_row(model, F) * WIDTH, _change(t, 1))
        for j in range(width):
            at = block + (width + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.mode_amplitude[j]), dp)))
        for j in range(n0):
            at = block + (2 * width + n0 + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.mode_amplitude0[j]), dp)))


@helper
def slider_rows(model, state, t):
    """Rows of the slider that follow from the others in contact: u, u' if it is rigid, and df = 0 in stick, exactly."""
    _, _, B = disc_point(model, state)
    for c in range(0, t.columns, WIDTH):
        block = c * t.rows
        if not model.compliant:
            du, dv, _ = point_change(model, t.now, block, state.x[F], B)
            store(t.now, block + slider_row(model, U) * WIDTH, du)
            store(t.now, block + slider_row(model, U_VELOCITY) * WIDTH, dv)
        if state.x[PHASE] == STICK:
            store(t.now, block + slider_row(model, F) * WIDTH, splat(0.0))


@helper
def count_event(state, cause, log):
    phase = state.x[PHASE]
    if cause == transitions.RELEASE_FORWARD:
        log[tangent.RELEASES] += 1.0
    elif cause == transitions.RELEASE_BACKWARD:
        log[tangent.BACK_RELEASES] += 1.0
    elif cause == transitions.AT_REST and phase == SLIP:
        log[tangent.REVERSALS] += 1.0
    if phase == SEPARATION:
        log[tangent.SEPARATIONS] += 1.0
    elif phase == STICK:
        log[tangent.STICKS] += 1.0


@helper
def pass_event(model, state, t, cause, at_once, returns, changes):
    """Carry out and count an event, and, if requested, change the columns.  Returns the exit code. ``at_once``: the
    phase had no duration; ``returns``: the integration ends at this event, still in the phase before it."""
    if cause == transitions.AT_REST:
        state.x[F] = 0.0
    if changes:
        rates(model, state, t.before)
        event_times(model, state, t, cause, at_once)
        shift(t, t.before, 1.0)
        if cause == transitions.GAP_CLOSED and not model.compliant:
            impact_change(model, state, t)
    if returns:
        t.log[tangent.RELEASES] += 1.0
        return RETURNED
    if change_phase(model, state, cause, at_once) == NO_SOLUTION:
        return NO_SOLUTION
    count_event(state, cause, t.log)
    if changes:
        if state.x[PHASE] == SEPARATION:
            slider_rows(model, state, t)
        rates(model, state, t.after)
        shift(t, t.after, -1.0)
        if state.x[PHASE] != SEPARATION:
            slider_rows(model, state, t)
    return CONSISTENT
