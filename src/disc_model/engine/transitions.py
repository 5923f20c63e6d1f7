"""Events: contact force, impact, and the choice of the next phase (docs/model.md, Contact and
events)."""

from . import laws, layout
from .jit import helper, inlined
from .jit.simd import WIDTH, absolute, add, fma, load, mul, splat, sub, total

# Exit codes of events, of runs and of integrations. The motion continues after an event, after a
# pause because a buffer is full, after a stop at the first loss of contact, and at the end time or
# the section. It cannot continue: Painleve's paradox, events without the clock advancing, overflow.
# It was stopped: too many steps, not on the section.
(
    CONSISTENT,
    PAUSED,
    STOPPED,
    TIME_OVER,
    RETURNED,
    NO_SOLUTION,
    STALLED,
    NON_FINITE,
    STEP_LIMIT,
    OFF_SECTION,
) = range(10)
# Causes of the end of a step.
NOTHING, RELEASE_FORWARD, RELEASE_BACKWARD, AT_REST, CONTACT_LOST, GAP_CLOSED = range(6)

MAX_EVENTS_IN_A_ROW = (
    200  # more without the clock advancing end a motion: a guard, not a tuned interval
)
PAINLEVE_MARGIN = (
    1e-6  # below this fraction of its value without friction the denominator of P counts as zero
)
ROUNDING = 1e-13  # a force below this fraction of the terms that make it is rounding


@inlined
def disc_point(model, state):
    """u, u' and the slope B = dw/dtheta of the disc under the slider."""
    f, zero = state.x[layout.F], splat(0.0)
    by_u, by_v, by_slope = zero, zero, zero
    for b in range(0, len(model.shift), WIDTH):
        z, amplitude = load(state.z, b), load(model.mode_amplitude, b)
        by_u, by_v = fma(amplitude, z, by_u), fma(amplitude, load(state.e, b), by_v)
        by_slope = fma(load(model.dw_dtheta, b), z, by_slope)
    u, v, dw_dtheta = total(by_u), total(by_v), total(by_slope)
    for j in range(len(model.mode_amplitude0)):
        u += model.mode_amplitude0[j] * state.y[j]
        v += model.mode_amplitude0[j] * state.g[j]
    return u, v + f * dw_dtheta, dw_dtheta


@inlined
def slider_motion(model, state):
    """u, u' of the slider, which in rigid contact are the disc's; slope B of the disc under it."""
    u, v, dw_dtheta = disc_point(model, state)
    if model.compliant or state.x[layout.PHASE] == layout.SEPARATION:
        u, v = state.x[layout.U], state.x[layout.U_VELOCITY]
    return u, v, dw_dtheta


@inlined
def instant(model, state):
    """The arguments of the laws of contact; size of the terms of A."""
    # Read in this order, before the sums over modes: it decides which product in F the optimiser
    # does not round (see ``jit``). In another order results with c_p differ in their last bits.
    x, N, Omega = state.x, layout.load_now(model, state), layout.drive_now(model, state)
    k_p, c_p, f, compliance, psi = (
        model.k_p,
        model.c_p,
        x[layout.F],
        model.compliance,
        x[layout.PSI],
    )
    w, velocity, dw_dtheta = disc_point(model, state)
    f_lanes, parts, sizes = splat(f), splat(0.0), splat(0.0)
    for b in range(0, len(model.shift), WIDTH):
        z, e, turned = load(state.z, b), load(state.e, b), mul(f_lanes, load(model.shift, b))
        pull = fma(load(model.damping, b), e, mul(fma(turned, turned, load(model.stiffness, b)), z))
        # 2 l f beta_l: dw_dtheta is l psi_l in the lanes of b
        driven = mul(mul(splat(2.0), f_lanes), mul(load(model.dw_dtheta, b), e))
        part = sub(driven, mul(load(model.mode_amplitude, b), pull))
        parts, sizes = add(parts, part), add(sizes, absolute(part))
    free, size = total(parts), total(sizes)
    for j in range(len(model.mode_amplitude0)):
        single = -model.mode_amplitude0[j] * (
            model.damping0[j] * state.g[j] + model.stiffness0[j] * state.y[j]
        )
        free += single
        size += abs(single)
    return laws.Instant(
        N, model.k, model.c, model.m, k_p, c_p, Omega, compliance, psi, f,
        w, velocity, dw_dtheta, free, x[layout.U], x[layout.U_VELOCITY],
    ), size  # fmt: skip


@inlined
def inplane_force_per_radius(model, state):
    i, _ = instant(model, state)
    return laws.inplane_force_per_radius(i)


@inlined
def deflection_size(model, state):
    """Size of w - u where both are states: of the modes' parts of w, which may nearly cancel."""
    sizes = splat(0.0)
    for b in range(0, len(model.mode_amplitude), WIDTH):
        sizes = add(sizes, absolute(mul(load(model.mode_amplitude, b), load(state.z, b))))
    size = total(sizes) + abs(state.x[layout.U])
    for j in range(len(model.mode_amplitude0)):
        size += abs(model.mode_amplitude0[j] * state.y[j])
    return size


@helper
def force_error(model, state, tolerance):
    """Error of the force of a compliant contact that has just begun, for series of this relative
    ``tolerance``."""
    rounding = ROUNDING * deflection_size(model, state) / model.compliance
    return rounding + tolerance * layout.load_now(model, state)


@helper
def gap_error(model, state, order, tolerance):
    """Error of a coefficient of the gap's series, of this order, where contact has just been lost:
    of rounding and, on the side of the force that has ended, of series of this relative
    ``tolerance``. The force decides the gap itself, or its acceleration in rigid contact."""
    rounding = ROUNDING * deflection_size(model, state)
    force = tolerance * layout.load_now(model, state)
    if model.compliant:
        return rounding + force * model.compliance if order == 0 else rounding
    if order < 2:
        return rounding
    inverse_mass = 1.0 / model.m + model.inverse_effective_mass
    return rounding + 0.5 * model.unit**2 * force * inverse_mass


@helper
def slip_error(model, state, tolerance):
    """Error of f' where slip has just begun, rad/s per time unit: of rounding if ``tolerance`` is
    0, else of series of this relative tolerance too."""
    P, _, noise = slip_force(model, state, state.x[layout.DIRECTION])
    F = inplane_force_per_radius(model, state)
    resistance = model.mu_s if model.decaying else model.mu_k
    if model.normal:
        _, _, dw_dtheta = disc_point(model, state)
        resistance += abs(dw_dtheta) / model.r_0
    load = max(abs(P), layout.load_now(model, state))
    pull_error = (ROUNDING + tolerance) * abs(F)
    friction_error = resistance * (noise + tolerance * load) / model.r_0
    return model.unit * (pull_error + friction_error) / model.m


@inlined
def _rounding(model, state, i, size):
    """Rounding error of V in stick, or of the numerator of P where B F is rounded too."""
    if model.compliant:
        return ROUNDING * deflection_size(model, state) / i.compliance
    return ROUNDING * (i.N + abs(i.k * (i.w - model.u_0)) + abs(i.c * i.w_velocity) + i.m * size)


@inlined
def stick_force(model, state):
    """Vertical contact force in stick (f = 0): P, or V under the normal force."""
    i, _ = instant(model, state)
    return laws.vertical_in_stick(model, i)


@inlined
def force_in_stick(model, state, V):
    """The contact force in stick: V, or R under the normal force."""
    if not model.normal:
        return V
    i, _ = instant(model, state)
    _, press = laws.stick_loads(model, i, V)
    return press / (1.0 + (i.dw_dtheta / model.r_0) ** 2)


@inlined
def friction_force(model, state, phase, direction, P):
    """Friction T on the disc, in the direction of the slider's path; P: the contact force, used in
    slip."""
    if phase == layout.SLIP:
        return laws.friction_coefficient(model, direction, state.x[layout.F]) * P
    if phase == layout.SEPARATION:
        return 0.0
    i, _ = instant(model, state)
    return laws.friction_in_stick(model, i, laws.vertical_in_stick(model, i))


@inlined
def usual_denominator(model):  # of the contact force in slip without friction
    return 1.0 if model.compliant else 1.0 + model.m * model.inverse_effective_mass


@inlined
def slip_force(model, state, direction):
    """Contact force in slip (P, or R under the normal force), its denominator, and its rounding
    error."""
    i, size = instant(model, state)
    friction = laws.friction_coefficient(model, direction, i.f)
    denominator = laws.slip_denominator(model, i.m, friction, i.dw_dtheta)
    noise = _rounding(model, state, i, size)
    if not model.compliant:
        noise += ROUNDING * abs(i.dw_dtheta * laws.inplane_force_per_radius(i))
    return laws.slip_numerator(model, i) / denominator, denominator, noise / abs(denominator)


@inlined
def impact(model, state):
    """Plastic impact (Eqs. 29-37).  Returns the impulse p; the slider takes the disc's velocity."""
    i, _ = instant(model, state)
    p, state.x[layout.F] = laws.impact(model, i)
    for j in range(len(model.shift)):
        state.e[j] -= model.mode_amplitude[j] * p
    for j in range(len(model.mode_amplitude0)):
        state.g[j] -= model.mode_amplitude0[j] * p
    state.x[layout.U], state.x[layout.U_VELOCITY], _ = disc_point(model, state)
    return p


@inlined
def event_function(model, i, cause, slipping):
    """The event function of a cause at an instant; slipping: whether it ends slip."""
    if cause == AT_REST:
        return i.f
    if cause == GAP_CLOSED:
        return i.u - i.w
    if cause == CONTACT_LOST:
        if model.compliant:
            return i.w - i.u
        return laws.slip_numerator(model, i) if slipping else laws.stick_numerator(model, i)
    pull, press = laws.stick_loads(model, i, laws.vertical_in_stick(model, i))
    return model.mu_s * press - (1.0 if cause == RELEASE_FORWARD else -1.0) * pull


@inlined
def _begin(state, phase, direction, known, force, known_force=0):
    """Begin a phase; known, known_force: multiplicity of the root there, of event function and
    force of the contact. Returns CONSISTENT."""
    x = state.x
    x[layout.PHASE], x[layout.DIRECTION], x[layout.KNOWN], x[layout.KNOWN_FORCE] = (
        phase,
        direction,
        known,
        known_force,
    )
    x[layout.FORCE], x[layout.PROPAGATED] = force, 0.0
    return CONSISTENT


@inlined
def _enter_separation(model, state, P, noise):
    """Begin separation at the force P, up to ``noise``: the gap starts as t**3 from P = 0, as t**2
    from P < 0; that of a compliant contact starts as t, or is already open.  Returns CONSISTENT."""
    known = 0 if noise < -P else 1
    if not model.compliant:
        state.x[layout.U], state.x[layout.U_VELOCITY], _ = disc_point(model, state)
        known += 2
    return _begin(state, layout.SEPARATION, 0.0, known, 0.0)


@helper
def enter_slip(model, state, direction):
    """Begin slip in ``direction``, or separation at once if P would be negative.  Returns
    CONSISTENT or NO_SOLUTION."""
    P, denominator, noise = slip_force(model, state, direction)
    if denominator <= PAINLEVE_MARGIN * usual_denominator(model):
        return NO_SOLUTION
    if P < 0.0 and not model.bonded:
        return _enter_separation(model, state, P, noise)
    known = 0
    if state.x[layout.F] == 0.0:
        # f starts at zero: the root at the start is known.  It is double where f', which points
        # into the direction of slip or vanishes, as (1 + m S2 + s mu B / r_0) f' m = (1 + m S2)
        # (|F| - mu P_stick / r_0), is rounding.
        resistance = bound = model.mu_s if model.decaying else model.mu_k
        if model.normal:
            _, _, dw_dtheta = disc_point(model, state)
            resistance += direction * dw_dtheta / model.r_0
            bound += abs(dw_dtheta) / model.r_0
        F, friction = inplane_force_per_radius(model, state), resistance * P / model.r_0
        rounding = ROUNDING * abs(F) + bound * noise / model.r_0
        known = 2 if direction * F - friction <= rounding else 1
    return _begin(state, layout.SLIP, direction, known, P)


@inlined
def friction_drops(model):
    return (
        model.mu_s > model.mu_k and len(model.decaying) == 0
    )  # numba has no `not` of a tuple as a value


@helper
def stop_slip(model, state):
    """f has reached zero: stick if friction holds the spring, else slip to the side of the spring's
    pull."""
    state.x[layout.F] = 0.0
    i, _ = instant(model, state)
    P = laws.vertical_in_stick(model, i)
    pull, press = laws.stick_loads(model, i, P)
    if abs(pull) < model.mu_s * press:
        return _begin(state, layout.STICK, 0.0, 0, force_in_stick(model, state, P))
    # contact may hold although P in stick is negative: in slip the spring presses the slider on
    # with B F
    return enter_slip(model, state, -1.0 if pull < 0.0 else 1.0)


@helper
def reattach(model, state):
    """The gap has closed: impact, then contact. A compliant contact has no impact, and its force
    rises from zero."""
    if model.compliant:
        f, F = state.x[layout.F], inplane_force_per_radius(model, state)
        if f == 0.0 and F == 0.0:
            return _begin(state, layout.STICK, 0.0, 0, 0.0, 1)
        direction = 1.0 if (f if f != 0.0 else F) > 0.0 else -1.0
        _, denominator, _ = slip_force(model, state, direction)
        if denominator <= PAINLEVE_MARGIN:
            return NO_SOLUTION
        return _begin(state, layout.SLIP, direction, 1 if f == 0.0 else 0, 0.0, 1)
    impact(model, state)
    f = state.x[layout.F]
    if f == 0.0:
        return stop_slip(model, state)
    return enter_slip(model, state, 1.0 if f > 0.0 else -1.0)


@helper
def change_phase(model, state, cause, at_once):
    """Carry out an event; ``at_once``: the phase had no duration.  Returns CONSISTENT or
    NO_SOLUTION."""
    if cause == GAP_CLOSED:
        return reattach(model, state)
    if cause == AT_REST:
        return stop_slip(model, state)
    if cause == CONTACT_LOST:
        # P has reached zero, or was negative from the start
        if state.x[layout.PHASE] == layout.SLIP:
            P, _, noise = slip_force(model, state, state.x[layout.DIRECTION])
        else:
            i, size = instant(model, state)
            P, noise = laws.stick_numerator(model, i), _rounding(model, state, i, size)
        return _enter_separation(model, state, P, noise)
    outcome = enter_slip(model, state, 1.0 if cause == RELEASE_FORWARD else -1.0)
    if state.x[layout.PHASE] == layout.SLIP and not friction_drops(model) and not at_once:
        # friction does not jump: f' = 0, despite the error of the event's time. Where stick had no
        # duration, the spring may pull harder than friction can hold.
        state.x[layout.KNOWN] = 2
    return outcome
