"""Small changes at events.

At an event h = 0 the columns change with the jump of the vector field (the saltation matrix). With
dtau = -dh / h' the change of the event's time, J the Jacobian of the jump and v the rates before
and after,

    dx(after) = J (dx(before) + v(before) dtau) - v(after) dtau.
"""

from . import laws
from .columns import (
    BACK_RELEASES,
    D_COMPLIANCE,
    D_K,
    D_LOAD,
    N_INPUTS,
    RELEASES,
    REVERSALS,
    SEPARATIONS,
    STICKS,
    entry,
    has_inputs,
    inputs_at,
    now_at,
    put_entry,
)
from .jit import helper, inlined, kernel
from .jit.simd import WIDTH, load, splat, store, total
from .laws import N_ENTRIES, friction_coefficient, slip_denominator
from .model import is_rigid
from .state import (
    DIRECTION,
    HALF,
    PHASE,
    PHI_RATE,
    PSI,
    SEPARATION,
    SLIP,
    STICK,
    U_VELOCITY,
    U,
    displacement0_place,
    other_lane,
    slider_place,
    velocity0_place,
    velocity_place,
)
from .stretching import membrane_change, membrane_force0
from .tangent import point_change, surface_change
from .transitions import (
    AT_REST,
    CONSISTENT,
    GAP_CLOSED,
    NO_SOLUTION,
    RELEASE_BACKWARD,
    RELEASE_FORWARD,
    RETURNED,
    change_phase,
    disc_point,
    event_function,
    instant,
)

# Radians of the fastest motion by which a root was passed before the phase began; less is rounding.
PASSED = 1e-9


# ---- Rates


@kernel
def rates(model, state, out):
    """Put the rates of all rows in the state's phase into the first lane of ``out`` ([row][8])."""
    phase = state.x[PHASE]
    i, _ = instant(model, state)
    f = i.g
    V, H, rate_f = _forces(model, i, phase, state.x[DIRECTION])

    # the disc
    for j in range(len(model.mode_amplitude)):
        shift = model.shift[j]
        other = other_lane(j)
        own = -model.damping[j] * state.e[j] - model.stiffness[j] * state.z[j]
        if model.has_stretching:
            own -= state.membrane[j]
        out[j * WIDTH] = state.e[j] + shift * f * state.z[other]
        row = velocity_place(model, j)
        out[row * WIDTH] = own + shift * f * state.e[other] - model.mode_amplitude[j] * V
        if model.has_moving_surface:
            out[row * WIDTH] += model.tangential[j] * H
    for j in range(len(model.mode_amplitude0)):
        own = -model.damping0[j] * state.g[j] - model.stiffness0[j] * state.y[j]
        if model.has_stretching:
            own -= membrane_force0(model, state.membrane, 1, 0, j)
        out[displacement0_place(model, j) * WIDTH] = state.g[j]
        out[velocity0_place(model, j) * WIDTH] = own - model.mode_amplitude0[j] * V

    # the slider
    u = i.w
    v = i.w_velocity
    if model.has_compliance or phase == SEPARATION:
        u = i.u
        v = i.u_velocity
    vertical = model.N + model.k * (u - model.u_0) + model.c * v
    out[slider_place(model, PSI) * WIDTH] = model.Omega - laws.slider_rate(model, i)
    out[slider_place(model, PHI_RATE) * WIDTH] = rate_f
    out[slider_place(model, U) * WIDTH] = v
    out[slider_place(model, U_VELOCITY) * WIDTH] = (V - vertical) / model.m


@inlined
def _forces(model, i, phase, direction):
    """V, H and g' at an instant of a phase."""
    if phase == STICK:
        return laws.vertical_in_stick(model, i), model.r_0 * laws.hold_per_radius(model, i), 0.0
    if phase == SEPARATION:
        return 0.0, 0.0, laws.free_pull(model, i) / i.m
    friction = friction_coefficient(model, direction, i.g)
    force = laws.slip_numerator(model, i) / slip_denominator(model, i.m, friction, i.dw_dtheta)
    return laws.slip_rates(model, i, friction, force)


# ---- Changes of laws at an instant


@inlined
def _change(tangent, law):
    """Change of the law whose derivatives stand in a row of ``Tangent.gradient``, for the columns of
    ``Tangent.change`` (lanes)."""
    change = splat(0.0)
    for place in range(N_ENTRIES):
        derivative = tangent.gradient[law * N_ENTRIES + place]
        change = change + derivative * load(tangent.change, place * WIDTH)
    return change


@inlined
def put_changes(model, state, tangent, rows, block, changes):
    """Put the changes of an instant's entries into ``Tangent.change``, for a block of columns in
    ``rows``; ``changes``: whether the columns change parameters. Returns the change of the law whose
    derivatives begin ``Tangent.gradient`` (lanes)."""
    at = now_at(tangent, block)
    inputs = inputs_at(tangent, block)
    out = tangent.change
    for place in range(N_INPUTS):
        value = splat(0.0)
        if changes:
            value = entry(tangent.inputs, inputs, place)
        put_entry(out, 0, place, value)
    _, _, dw_dtheta = disc_point(model, state)
    dw, dv, d_slope = point_change(model, rows, at, state.x[PHI_RATE], dw_dtheta)
    put_entry(out, 0, laws.PSI_ENTRY, entry(rows, at, slider_place(model, PSI)))
    put_entry(out, 0, laws.G_ENTRY, entry(rows, at, slider_place(model, PHI_RATE)))
    put_entry(out, 0, laws.W_ENTRY, dw)
    put_entry(out, 0, laws.W_VELOCITY_ENTRY, dv)
    put_entry(out, 0, laws.DW_DTHETA_ENTRY, d_slope)
    put_entry(out, 0, laws.FREE_ENTRY, _free_change(model, state, tangent, rows, block, changes))
    if model.has_moving_surface:
        along = _along_change(model, state, tangent, rows, block, changes)
        put_entry(out, 0, laws.SURFACE_VELOCITY_ENTRY, surface_change(model, rows, at))
        put_entry(out, 0, laws.SURFACE_FREE_ENTRY, along)
    put_entry(out, 0, laws.U_ENTRY, entry(rows, at, slider_place(model, U)))
    put_entry(out, 0, laws.U_VELOCITY_ENTRY, entry(rows, at, slider_place(model, U_VELOCITY)))
    return _change(tangent, 0)


@inlined
def _stretched(model, state, j):
    """Displacement in lane j, with that which the membrane's force would make: what a change of
    stiffness multiplies, as it is the plate's material that changes."""
    if model.has_stretching:
        return state.z[j] + state.membrane[j] / model.stiffness[j]
    return state.z[j]


@inlined
def _free_change(model, state, tangent, rows, block, changes):
    """Change of A, ``laws.Instant.free`` (lanes); arguments as in `put_changes`."""
    at = now_at(tangent, block)
    inputs = inputs_at(tangent, block)
    f = state.x[PHI_RATE]
    df = entry(rows, at, slider_place(model, PHI_RATE))
    acceleration = splat(0.0)
    for j in range(len(model.mode_amplitude)):
        if model.shift[j] > 0.0:
            i = j + HALF
            l = model.shift[j]
            alpha_row = velocity_place(model, j)
            beta_row = velocity_place(model, i)
            stiffness = model.stiffness[j] + (l * f) ** 2
            part = -stiffness * entry(rows, at, j)
            part = part - model.damping[j] * entry(rows, at, alpha_row)
            part = part + (2.0 * l * f) * entry(rows, at, beta_row)
            part = part + (2.0 * l * state.e[i] - 2.0 * l * l * f * state.z[j]) * df
            if model.has_stretching:
                part = part - membrane_change(model, state.membrane, 1, 0, rows, at, 0, j)
            if changes:
                d_stiffness = entry(tangent.inputs, inputs, N_INPUTS + j)
                d_damping = entry(tangent.inputs, inputs, N_INPUTS + alpha_row)
                part = part - _stretched(model, state, j) * d_stiffness - state.e[j] * d_damping
            acceleration = acceleration + model.mode_amplitude[j] * part
    for j in range(len(model.mode_amplitude0)):
        y_row = displacement0_place(model, j)
        g_row = velocity0_place(model, j)
        part = -model.stiffness0[j] * entry(rows, at, y_row)
        part = part - model.damping0[j] * entry(rows, at, g_row)
        if model.has_stretching:
            row = len(model.shift) + j
            part = part - membrane_change(model, state.membrane, 1, 0, rows, at, 0, row)
        if changes:
            d_stiffness = entry(tangent.inputs, inputs, N_INPUTS + y_row)
            d_damping = entry(tangent.inputs, inputs, N_INPUTS + g_row)
            y = state.y[j]
            if model.has_stretching:
                y += membrane_force0(model, state.membrane, 1, 0, j) / model.stiffness0[j]
            part = part - y * d_stiffness - state.g[j] * d_damping
        acceleration = acceleration + model.mode_amplitude0[j] * part
    return acceleration


@inlined
def _along_change(model, state, tangent, rows, block, changes):
    """Change of G, ``laws.Instant.surface_free`` (lanes); arguments as in `put_changes`."""
    at = now_at(tangent, block)
    inputs = inputs_at(tangent, block)
    f = state.x[PHI_RATE]
    df = entry(rows, at, slider_place(model, PHI_RATE))
    acceleration = splat(0.0)
    for j in range(len(model.mode_amplitude)):
        if model.shift[j] > 0.0:
            i = j + HALF
            l = model.shift[j]
            alpha_row = velocity_place(model, j)
            part = -model.stiffness[i] * entry(rows, at, i)
            part = part - model.damping[i] * entry(rows, at, velocity_place(model, i))
            part = part - (l * f) * entry(rows, at, alpha_row) - (l * state.e[j]) * df
            if model.has_stretching:
                part = part - membrane_change(model, state.membrane, 1, 0, rows, at, 0, i)
            if changes:
                d_stiffness = entry(tangent.inputs, inputs, N_INPUTS + j)
                d_damping = entry(tangent.inputs, inputs, N_INPUTS + alpha_row)
                part = part - _stretched(model, state, i) * d_stiffness - state.e[i] * d_damping
            acceleration = acceleration + model.tangential[i] * part
    return acceleration


@inlined
def _set_derivative(model, i, tangent, law, place, value):
    """Enter a derivative, ``value`` being the law's after a complex step of an entry. The columns'
    change of N contains that of -k u_0, and their change of the compliance is relative."""
    derivative = value.imag / laws.TINY
    if place == D_K:
        derivative += model.u_0 * tangent.gradient[law * N_ENTRIES + D_LOAD]
    elif place == D_COMPLIANCE:
        derivative *= i.compliance
    tangent.gradient[law * N_ENTRIES + place] = derivative


@helper
def event_gradient(model, state, tangent, cause):
    """Put the derivatives of the event function of ``cause`` into ``Tangent.gradient``."""
    i, _ = instant(model, state)
    slipping = state.x[PHASE] == SLIP
    for place in range(N_ENTRIES):
        value = event_function(model, laws.stepped(i, place), cause, slipping)
        _set_derivative(model, i, tangent, 0, place, value)


@helper
def event_times(model, state, tangent, cause, at_once):
    """Put the change of the time of the event ``cause`` into ``Tangent.tau``, for every column.
    Returns the event function's rate. A phase that ended ``at_once``, its event function negative
    from the start, does so in neighbouring motions, too."""
    event_gradient(model, state, tangent, cause)
    # the other lanes of ``before`` are zero
    rate = total(put_changes(model, state, tangent, tangent.before, 0, False))
    i, _ = instant(model, state)
    value = abs(event_function(model, i, cause, state.x[PHASE] == SLIP))
    by_rate = -1.0 / rate
    if at_once and value > PASSED * model.unit * abs(rate):
        by_rate = 0.0
    for block in range(tangent.columns // WIDTH):
        changes = has_inputs(tangent, block)
        change = put_changes(model, state, tangent, tangent.now, block, changes)
        store(tangent.tau, block * WIDTH, by_rate * change)
    return rate


# ---- Jumps of columns


@helper
def _jump(tangent, rates_at, sign):
    """Add sign * rates * tau to the columns."""
    for block in range(tangent.columns // WIDTH):
        tau = load(tangent.tau, block * WIDTH)
        at = now_at(tangent, block)
        for row in range(tangent.rows):
            rate = sign * rates_at[row * WIDTH]
            put_entry(tangent.now, at, row, entry(tangent.now, at, row) + rate * tau)


@helper
def impact_change(model, state, tangent):
    """Apply the Jacobian of the plastic impact to the columns; ``state`` is the one before."""
    i, _ = instant(model, state)
    impulse, _ = laws.impact(model, i)
    for place in range(N_ENTRIES):
        p, g = laws.impact(model, laws.stepped(i, place))
        _set_derivative(model, i, tangent, 0, place, p)
        _set_derivative(model, i, tangent, 1, place, g)
    now = tangent.now
    for block in range(tangent.columns // WIDTH):
        at = now_at(tangent, block)
        changes = has_inputs(tangent, block)
        dp = put_changes(model, state, tangent, now, block, changes)
        # change of the impulse p B / r_0 along the path
        d_slope = load(tangent.change, laws.DW_DTHETA_ENTRY * WIDTH)
        along = (i.dw_dtheta * dp + impulse * d_slope) * (1.0 / model.r_0)
        put_entry(now, at, slider_place(model, PHI_RATE), _change(tangent, 1))
        for j in range(len(model.mode_amplitude)):
            row = velocity_place(model, j)
            d_velocity = entry(now, at, row) - model.mode_amplitude[j] * dp
            if model.has_moving_surface and model.has_normal_force:
                d_velocity = d_velocity + model.tangential[j] * along
            put_entry(now, at, row, d_velocity)
        for j in range(len(model.mode_amplitude0)):
            row = velocity0_place(model, j)
            put_entry(now, at, row, entry(now, at, row) - model.mode_amplitude0[j] * dp)


@helper
def slider_rows(model, state, tangent):
    """Set rows of the slider that follow from the others in contact: u, u' if it is rigid, and dg =
    0 in stick, exactly."""
    _, _, B = disc_point(model, state)
    for block in range(tangent.columns // WIDTH):
        at = now_at(tangent, block)
        if is_rigid(model):
            du, dv, _ = point_change(model, tangent.now, at, state.x[PHI_RATE], B)
            put_entry(tangent.now, at, slider_place(model, U), du)
            put_entry(tangent.now, at, slider_place(model, U_VELOCITY), dv)
        if state.x[PHASE] == STICK:
            put_entry(tangent.now, at, slider_place(model, PHI_RATE), splat(0.0))


# ---- Events


@helper
def count_event(state, cause, log):
    """Count an event by its cause, and the phase that it begins; log: ``Tangent.log``."""
    phase = state.x[PHASE]
    if cause == RELEASE_FORWARD:
        log[RELEASES] += 1.0
    elif cause == RELEASE_BACKWARD:
        log[BACK_RELEASES] += 1.0
    elif cause == AT_REST and phase == SLIP:
        log[REVERSALS] += 1.0
    if phase == SEPARATION:
        log[SEPARATIONS] += 1.0
    elif phase == STICK:
        log[STICKS] += 1.0


@helper
def pass_event(model, state, tangent, step, returns, changes):
    """Carry out and count the event that ends a step, and, if ``changes``, change the columns.
    Returns the exit code. ``returns``: the integration ends at this event, still in the phase
    before it."""
    at_once = step.length == 0.0
    if step.cause == AT_REST:
        state.x[PHI_RATE] = 0.0
    if changes:
        rates(model, state, tangent.before)
        event_times(model, state, tangent, step.cause, at_once)
        _jump(tangent, tangent.before, 1.0)
        if step.cause == GAP_CLOSED and is_rigid(model):
            impact_change(model, state, tangent)
    if returns:
        tangent.log[RELEASES] += 1.0
        return RETURNED
    if change_phase(model, state, step.cause, at_once) == NO_SOLUTION:
        return NO_SOLUTION
    count_event(state, step.cause, tangent.log)
    if changes:
        if state.x[PHASE] == SEPARATION:
            slider_rows(model, state, tangent)
        rates(model, state, tangent.after)
        _jump(tangent, tangent.after, -1.0)
        if state.x[PHASE] != SEPARATION:
            slider_rows(model, state, tangent)
    return CONSISTENT
