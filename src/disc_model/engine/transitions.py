"""Events: contact force, impact, and the choice of the next phase (docs/model.md, Contact and
events)."""

from typing import NamedTuple

from . import laws
from .jit import helper, inlined
from .jit.simd import WIDTH, absolute, load, splat, swap_halves, total
from .laws import Instant
from .model import drive_now, load_now
from .state import (
    DIRECTION,
    FORCE,
    KNOWN,
    KNOWN_FORCE,
    PHASE,
    PHI_RATE,
    PROPAGATED,
    PSI,
    SEPARATION,
    SLIP,
    STICK,
    U_VELOCITY,
    U,
)
from .stretching import membrane_at, membrane_force, membrane_force0

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

# Below this fraction of its value without friction the denominator of P counts as zero.
PAINLEVE_MARGIN = 1e-6
ROUNDING = 1e-13  # a force below this fraction of the terms that make it is rounding


# ---- The disc under the slider


@inlined
def disc_point(model, state):
    """Return u, u' and the slope B = dw/dtheta of the disc under the slider."""
    by_u = splat(0.0)
    by_v = splat(0.0)
    by_slope = splat(0.0)
    for b in range(0, len(model.shift), WIDTH):
        z = load(state.z, b)
        amplitude = load(model.mode_amplitude, b)
        by_u = by_u + amplitude * z
        by_v = by_v + amplitude * load(state.e, b)
        by_slope = by_slope + load(model.dw_dtheta, b) * z
    u = total(by_u)
    v = total(by_v)
    dw_dtheta = total(by_slope)
    for j in range(len(model.mode_amplitude0)):
        u += model.mode_amplitude0[j] * state.y[j]
        v += model.mode_amplitude0[j] * state.g[j]
    return u, v + state.x[PHI_RATE] * dw_dtheta, dw_dtheta


@inlined
def slider_motion(model, state):
    """Return u, u' of the slider, which in rigid contact are the disc's; slope B of the disc under
    it."""
    u, v, dw_dtheta = disc_point(model, state)
    if model.has_compliance or state.x[PHASE] == SEPARATION:
        u = state.x[U]
        v = state.x[U_VELOCITY]
    return u, v, dw_dtheta


@inlined
def free_acceleration(model, state):
    """Return A, the disc's acceleration under the slider but for the contact force and f', and the
    sum of the moduli of its terms, in m/s^2."""
    f = splat(state.x[PHI_RATE])
    parts = splat(0.0)
    sizes = splat(0.0)
    for b in range(0, len(model.shift), WIDTH):
        z = load(state.z, b)
        e = load(state.e, b)
        turned = f * load(model.shift, b)
        stiffness = load(model.stiffness, b) + turned * turned
        pull = stiffness * z + load(model.damping, b) * e
        if model.has_stretching:
            pull = pull + membrane_force(state.membrane, 1, 0, b)
        # 2 l f beta_l: dw_dtheta is l psi_l in the lanes of b
        driven = (2.0 * f) * (load(model.dw_dtheta, b) * e)
        part = driven - load(model.mode_amplitude, b) * pull
        parts = parts + part
        sizes = sizes + absolute(part)
    acceleration = total(parts)
    size = total(sizes)
    for j in range(len(model.mode_amplitude0)):
        pull = model.damping0[j] * state.g[j] + model.stiffness0[j] * state.y[j]
        if model.has_stretching:
            pull += membrane_force0(model, state.membrane, 1, 0, j)
        part = -model.mode_amplitude0[j] * pull
        acceleration += part
        size += abs(part)
    return acceleration, size


class Sizes(NamedTuple):
    """Sums of the moduli of terms that may nearly cancel."""

    up: float  # of A, m/s^2
    along: float  # of G, m/s^2


@inlined
def surface_velocity(model, state):
    """Return v_s, the velocity along the path of the surface on which friction acts, under the
    slider, m/s."""
    velocity = splat(0.0)
    if model.has_moving_surface:
        for b in range(0, len(model.shift), WIDTH):
            velocity = velocity + load(model.tangential, b) * load(state.e, b)
    return total(velocity)


@inlined
def surface_acceleration(model, state):
    """Return G, the acceleration of that surface but for the contact force, and the sum of the
    moduli of its terms, in m/s^2."""
    parts = splat(0.0)
    sizes = splat(0.0)
    if model.has_moving_surface:
        f = splat(state.x[PHI_RATE])
        for b in range(0, len(model.shift), WIDTH):
            e = load(state.e, b)
            pull = load(model.stiffness, b) * load(state.z, b) + load(model.damping, b) * e
            if model.has_stretching:
                pull = pull + membrane_force(state.membrane, 1, 0, b)
            turned = f * (load(model.shift, b) * swap_halves(e))
            part = load(model.tangential, b) * (turned - pull)
            parts = parts + part
            sizes = sizes + absolute(part)
    return total(parts), total(sizes)


@inlined
def slider_rate(model, state):
    """Return f, the slider's angular speed, rad/s."""
    if model.has_moving_surface:
        return state.x[PHI_RATE] + surface_velocity(model, state) / model.r_0
    return state.x[PHI_RATE]


@inlined
def instant(model, state):
    """Return the arguments of the laws of contact, and `Sizes`. Enters the membrane's force at the
    state."""
    if model.has_stretching:
        membrane_at(model, state)
    w, velocity, dw_dtheta = disc_point(model, state)
    acceleration, size = free_acceleration(model, state)
    along, along_size = surface_acceleration(model, state)
    arguments = Instant(
        N=load_now(model, state),
        k=model.k,
        c=model.c,
        m=model.m,
        k_p=model.k_p,
        c_p=model.c_p,
        Omega=drive_now(model, state),
        compliance=model.compliance,
        psi=state.x[PSI],
        g=state.x[PHI_RATE],
        w=w,
        w_velocity=velocity,
        dw_dtheta=dw_dtheta,
        free=acceleration,
        surface_velocity=surface_velocity(model, state),
        surface_free=along,
        u=state.x[U],
        u_velocity=state.x[U_VELOCITY],
    )
    return arguments, Sizes(size, along_size)


@inlined
def inplane_force_per_radius(model, state):
    """Return F, N/m."""
    i, _ = instant(model, state)
    return laws.inplane_force_per_radius(model, i)


@inlined
def _free_pull(model, i, sizes):
    """Return what pulls the slider over the material but for contact, over r_0, and its size, N/m."""
    pull = laws.free_pull(model, i)
    if model.has_moving_surface:
        return pull, abs(pull) + i.m / model.r_0 * sizes.along
    return pull, abs(pull)


# ---- Forces


@inlined
def deflection_size(model, state):
    """Size of w - u where both are states: of the modes' parts of w, which may nearly cancel."""
    sizes = splat(0.0)
    for b in range(0, len(model.mode_amplitude), WIDTH):
        sizes = sizes + absolute(load(model.mode_amplitude, b) * load(state.z, b))
    size = total(sizes) + abs(state.x[U])
    for j in range(len(model.mode_amplitude0)):
        size += abs(model.mode_amplitude0[j] * state.y[j])
    return size


@inlined
def _rounding(model, state, i, sizes):
    """Rounding error of V in stick, or of the numerator of P where B F is rounded too."""
    if model.has_compliance:
        return ROUNDING * deflection_size(model, state) / i.compliance
    return ROUNDING * (
        i.N + abs(i.k * (i.w - model.u_0)) + abs(i.c * i.w_velocity) + i.m * sizes.up
    )


@inlined
def stick_force(model, state):
    """Return the vertical contact force in stick (g = 0): P, or V under the normal force."""
    i, _ = instant(model, state)
    return laws.vertical_in_stick(model, i)


@inlined
def force_in_stick(model, state, V):
    """Return the contact force in stick: V, or R under the normal force."""
    if not model.has_normal_force:
        return V
    i, _ = instant(model, state)
    _, press = laws.stick_loads(model, i, V)
    return press / (1.0 + (i.dw_dtheta / model.r_0) ** 2)


@inlined
def usual_denominator(model):
    """Return the denominator of the contact force in slip without friction."""
    if model.has_compliance:
        return 1.0
    return 1.0 + model.m * model.inverse_effective_mass


@inlined
def slip_force(model, state, direction):
    """Return the contact force in slip (P, or R under the normal force), its denominator, and its
    rounding error."""
    i, sizes = instant(model, state)
    friction = laws.friction_coefficient(model, direction, i.g)
    denominator = laws.slip_denominator(model, i.m, friction, i.dw_dtheta)
    noise = _rounding(model, state, i, sizes)
    if not model.has_compliance:
        _, pull_size = _free_pull(model, i, sizes)
        noise += ROUNDING * abs(i.dw_dtheta) * pull_size
    return laws.slip_numerator(model, i) / denominator, denominator, noise / abs(denominator)


@inlined
def event_function(model, i, cause, slipping):
    """Return the event function of a cause at an instant; slipping: whether it ends slip."""
    if cause == AT_REST:
        return i.g
    if cause == GAP_CLOSED:
        return i.u - i.w
    if cause == CONTACT_LOST:
        if model.has_compliance:
            return i.w - i.u
        return laws.slip_numerator(model, i) if slipping else laws.stick_numerator(model, i)
    pull, press = laws.stick_loads(model, i, laws.vertical_in_stick(model, i))
    sign = 1.0 if cause == RELEASE_FORWARD else -1.0
    return model.mu_s * press - sign * pull


# ---- Errors of event functions where a phase has just begun


@helper
def force_error(model, state, tolerance):
    """Return the error of the force of a compliant contact that has just begun, in N; tolerance:
    the relative one of the series."""
    rounding = ROUNDING * deflection_size(model, state) / model.compliance
    return rounding + tolerance * load_now(model, state)


@helper
def gap_error(model, state, order, tolerance):
    """Return the error of a coefficient of the gap's series, of this order, where contact has just
    been lost, in m.

    It comes from rounding and, on the side of the force that has ended, from series of this
    relative ``tolerance``. The force decides the gap itself, or its acceleration in rigid contact.
    """
    rounding = ROUNDING * deflection_size(model, state)
    force = tolerance * load_now(model, state)
    if model.has_compliance:
        return rounding + force * model.compliance if order == 0 else rounding
    if order < 2:
        return rounding
    inverse_mass = 1.0 / model.m + model.inverse_effective_mass
    return rounding + 0.5 * model.unit**2 * force * inverse_mass


@helper
def slip_error(model, state, tolerance):
    """Return the error of g' where slip has just begun, in rad/s per time unit: that of rounding if
    ``tolerance`` is 0, else also that of series of this relative tolerance."""
    P, _, noise = slip_force(model, state, state.x[DIRECTION])
    i, sizes = instant(model, state)
    _, pull_size = _free_pull(model, i, sizes)
    resistance = model.onset_friction
    if model.has_normal_force:
        resistance += abs(i.dw_dtheta) / model.r_0
    resistance *= laws.surface_mobility(model, i.m)
    load = max(abs(P), load_now(model, state))
    pull_error = (ROUNDING + tolerance) * pull_size
    friction_error = resistance * (noise + tolerance * load) / model.r_0
    return model.unit * (pull_error + friction_error) / model.m


# ---- The next phase


@inlined
def _begin(state, phase, direction, known, force, known_force=0):
    """Begin a phase under a contact force; known, known_force: multiplicity of the root there, of
    event function and contact force. Returns CONSISTENT."""
    x = state.x
    x[PHASE] = phase
    x[DIRECTION] = direction
    x[KNOWN] = known
    x[KNOWN_FORCE] = known_force
    x[FORCE] = force
    x[PROPAGATED] = 0.0
    return CONSISTENT


@inlined
def _enter_separation(model, state, P, noise):
    """Begin separation at the force P, up to ``noise``: the gap starts as t**3 from P = 0, as t**2
    from P < 0; that of a compliant contact starts as t, or is already open.  Returns CONSISTENT."""
    known = 0 if noise < -P else 1
    if not model.has_compliance:
        state.x[U], state.x[U_VELOCITY], _ = disc_point(model, state)
        known += 2
    return _begin(state, SEPARATION, 0.0, known, 0.0)


@inlined
def _known_at_rest(model, state, direction, P, noise):
    """Multiplicity of the root of g where slip begins at g = 0 under the contact force P, up to
    ``noise``.

    It is two where g', which points into the direction of slip or vanishes, is rounding: (1 + m S +
    s mu B / r_0) g' m = (1 + m S) (|F| - mu P_stick / r_0), if the surface does not move.
    """
    resistance = model.onset_friction
    bound = resistance
    i, sizes = instant(model, state)
    if model.has_normal_force:
        resistance += direction * i.dw_dtheta / model.r_0
        bound += abs(i.dw_dtheta) / model.r_0
    mobility = laws.surface_mobility(model, i.m)
    pull, size = _free_pull(model, i, sizes)
    rounding = ROUNDING * size + mobility * bound * noise / model.r_0
    return 2 if direction * pull - mobility * resistance * P / model.r_0 <= rounding else 1


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
    if state.x[PHI_RATE] == 0.0:
        known = _known_at_rest(model, state, direction, P, noise)
    return _begin(state, SLIP, direction, known, P)


@inlined
def friction_drops(model):
    """Return whether friction falls at once where slip begins."""
    return model.mu_s > model.onset_friction


@helper
def stop_slip(model, state):
    """g has reached zero: begin stick if friction holds the slider, else slip to the side of the
    pull. Returns CONSISTENT or NO_SOLUTION."""
    state.x[PHI_RATE] = 0.0
    i, _ = instant(model, state)
    P = laws.vertical_in_stick(model, i)
    pull, press = laws.stick_loads(model, i, P)
    if abs(pull) < model.mu_s * press:
        return _begin(state, STICK, 0.0, 0, force_in_stick(model, state, P))
    # contact may hold although P in stick is negative: in slip the spring presses the slider on
    # with B F
    return enter_slip(model, state, -1.0 if pull < 0.0 else 1.0)


@inlined
def impact(model, state):
    """Carry out the plastic impact (Eqs. 29-37), in which the slider takes the disc's velocity.
    Returns the impulse p, N s."""
    i, _ = instant(model, state)
    p, g = laws.impact(model, i)
    state.x[PHI_RATE] = g
    for j in range(len(model.shift)):
        state.e[j] -= model.mode_amplitude[j] * p
    if model.has_moving_surface and model.has_normal_force:
        along = p * i.dw_dtheta / model.r_0
        for j in range(len(model.shift)):
            state.e[j] += model.tangential[j] * along
    for j in range(len(model.mode_amplitude0)):
        state.g[j] -= model.mode_amplitude0[j] * p
    state.x[U], state.x[U_VELOCITY], _ = disc_point(model, state)
    return p


@inlined
def _touch(model, state):
    """Begin contact on a compliant contact, whose force rises from zero without an impact. Returns
    CONSISTENT or NO_SOLUTION."""
    i, _ = instant(model, state)
    pull = laws.free_pull(model, i)
    if i.g == 0.0 and pull == 0.0:
        return _begin(state, STICK, 0.0, 0, 0.0, 1)
    ahead = i.g if i.g != 0.0 else pull
    direction = 1.0 if ahead > 0.0 else -1.0
    _, denominator, _ = slip_force(model, state, direction)
    if denominator <= PAINLEVE_MARGIN:
        return NO_SOLUTION
    return _begin(state, SLIP, direction, 1 if i.g == 0.0 else 0, 0.0, 1)


@helper
def reattach(model, state):
    """The gap has closed: impact, then contact. Returns CONSISTENT or NO_SOLUTION."""
    if model.has_compliance:
        return _touch(model, state)
    impact(model, state)
    g = state.x[PHI_RATE]
    if g == 0.0:
        return stop_slip(model, state)
    return enter_slip(model, state, 1.0 if g > 0.0 else -1.0)


@helper
def lose_contact(model, state):
    """Begin separation: P has reached zero, or was negative from the start. Returns CONSISTENT."""
    if state.x[PHASE] == SLIP:
        P, _, noise = slip_force(model, state, state.x[DIRECTION])
    else:
        i, sizes = instant(model, state)
        P = laws.stick_numerator(model, i)
        noise = _rounding(model, state, i, sizes)
    return _enter_separation(model, state, P, noise)


@helper
def change_phase(model, state, cause, at_once):
    """Carry out an event; ``at_once``: the phase had no duration.  Returns CONSISTENT or
    NO_SOLUTION."""
    if cause == GAP_CLOSED:
        return reattach(model, state)
    if cause == AT_REST:
        return stop_slip(model, state)
    if cause == CONTACT_LOST:
        return lose_contact(model, state)
    outcome = enter_slip(model, state, 1.0 if cause == RELEASE_FORWARD else -1.0)
    if state.x[PHASE] == SLIP and not friction_drops(model) and not at_once:
        # friction does not jump: g' = 0, despite the error of the event's time. Where stick had no
        # duration, the spring may pull harder than friction can hold.
        state.x[KNOWN] = 2
    return outcome
