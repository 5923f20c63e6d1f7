"""What happens at a switch: contact force, impact, and which phase comes next (docs/model.md, Contact and switches)."""

from __future__ import annotations

from .compile import inlined, kernel
from .layout import COASTED, DIRECTION, FORCE, KNOWN, PHASE, PSI, SEPARATION, SLIP, SPEED, STICK, U_VELOCITY, U
from .outcomes import CONSISTENT, NO_SOLUTION

# What can end a step.
NOTHING, RELEASE_FORWARD, RELEASE_BACKWARD, AT_REST, CONTACT_LOST, GAP_CLOSED = range(6)

# More switches than this without the clock moving end a motion: a guard, not a tuned interval.
MAX_EVENTS_IN_A_ROW = 200
# Below this share of its value without friction the denominator of P counts as zero: Painleve's paradox.
PAINLEVE_MARGIN = 1e-6
# A force below this share of the terms that make it is rounding.
ROUNDING = 1e-13


@inlined
def disc_point(model, state):
    """u, u' and the slope B = dw/dtheta of the disc under the slider."""
    f = state.x[SPEED]
    u, v, slope = 0.0, 0.0, 0.0
    for j in range(len(model.shift)):
        u += model.force[j] * state.z[j]
        v += model.force[j] * state.e[j]
        slope += model.slope[j] * state.z[j]
    for j in range(len(model.force0)):
        u += model.force0[j] * state.y[j]
        v += model.force0[j] * state.g[j]
    return u, v + f * slope, slope


@inlined
def spring_force(model, state):
    """F = k_p psi + c_p (Omega - f), N/m... the in-plane force divided by r_0."""
    return model.k_p * state.x[PSI] + model.c_p * (model.Omega - state.x[SPEED])


@inlined
def never_pulled(model, state):
    """Whether the drive neither pulls at the slider in stick nor ever will."""
    return model.k_p * model.Omega == 0.0 and spring_force(model, state) == 0.0


@inlined
def _free_force(model, state):
    """N + k (u - u_0) + c u' + m A, which is P but for its denominator and the term with B; size of its terms."""
    f = state.x[SPEED]
    u, v, _ = disc_point(model, state)
    acceleration, size = 0.0, 0.0
    for j in range(len(model.shift)):
        a = -model.damping[j] * state.e[j] - (model.stiffness[j] + (model.shift[j] * f) ** 2) * state.z[j]
        # 2 l f beta_l: slope is l psi_l in the lanes of b
        part = model.force[j] * a + 2.0 * f * model.slope[j] * state.e[j]
        acceleration += part
        size += abs(part)
    for j in range(len(model.force0)):
        part = -model.force0[j] * (model.damping0[j] * state.g[j] + model.stiffness0[j] * state.y[j])
        acceleration += part
        size += abs(part)
    spring, damper = model.k * (u - model.u_0), model.c * v
    value = model.N + spring + damper + model.m * acceleration
    return value, model.N + abs(spring) + abs(damper) + model.m * size


@inlined
def stick_force(model, state):
    """Contact force P in stick (f = 0)."""
    force, _ = _free_force(model, state)
    return force / (1.0 + model.m * model.compliance)


@inlined
def slip_force(model, state, direction):
    """Contact force P in slip, its denominator, and how much of P may be rounding."""
    _, _, slope = disc_point(model, state)
    denominator = 1.0 + model.m * model.compliance + direction * model.mu_k * slope / model.r_0
    force, size = _free_force(model, state)
    pull = slope * spring_force(model, state)
    return (force + pull) / denominator, denominator, ROUNDING * (size + abs(pull)) / abs(denominator)


@inlined
def impact(model, state):
    """Plastic impact (Eqs. 29-37).  Returns the impulse p; the slider takes the disc's velocity."""
    _, v, _ = disc_point(model, state)
    p = (v - state.x[U_VELOCITY]) / (model.compliance + 1.0 / model.m)
    for j in range(len(model.shift)):
        state.e[j] -= model.force[j] * p
    for j in range(len(model.force0)):
        state.g[j] -= model.force0[j] * p
    state.x[U], state.x[U_VELOCITY], _ = disc_point(model, state)
    return p


@inlined
def _enter_separation(model, state, P, noise):
    """Contact is lost where P, up to ``noise``, would be: the gap starts as t**3 from P = 0, as t**2 from P < 0."""
    state.x[U], state.x[U_VELOCITY], _ = disc_point(model, state)
    state.x[PHASE] = SEPARATION
    state.x[DIRECTION] = 0.0
    state.x[KNOWN] = 2 if noise < -P else 3
    state.x[FORCE] = 0.0


@inlined
def _enter_stick(state, P):
    state.x[PHASE] = STICK
    state.x[DIRECTION] = 0.0
    state.x[KNOWN] = 0
    state.x[COASTED] = 0.0
    state.x[FORCE] = P


@kernel
def enter_slip(model, state, direction):
    """Slip in ``direction``, or separation at once if P would be negative.  Returns CONSISTENT or NO_SOLUTION."""
    P, denominator, noise = slip_force(model, state, direction)
    if denominator <= PAINLEVE_MARGIN * (1.0 + model.m * model.compliance):
        return NO_SOLUTION
    if P < 0.0 and not model.bonded:
        _enter_separation(model, state, P, noise)
        return CONSISTENT
    state.x[PHASE] = SLIP
    state.x[DIRECTION] = direction
    state.x[FORCE] = P
    state.x[KNOWN] = 0
    if state.x[SPEED] == 0.0:
        # f starts at zero: the root at the start is known.  It is double where f', which points into the direction of
        # slip or vanishes, as (1 + m S2 + s mu_k B / r_0) f' m = (1 + m S2) (|F| - mu_k P_stick / r_0), is rounding.
        F, friction = spring_force(model, state), model.mu_k * P / model.r_0
        rounding = ROUNDING * abs(F) + model.mu_k * noise / model.r_0
        state.x[KNOWN] = 2 if direction * F - friction <= rounding else 1
    return CONSISTENT


@kernel
def break_loose(model, state, direction, at_once):
    """Friction holds the slider no longer: slip in ``direction``.  Returns CONSISTENT or NO_SOLUTION.

    at_once: stick has not lasted at all, so that the spring may pull harder than friction can hold.
    """
    outcome = enter_slip(model, state, direction)
    if state.x[PHASE] == SLIP and model.mu_s == model.mu_k and not at_once:
        # no jump of friction: f' = 0, whatever the error of the switch's time makes of it
        state.x[KNOWN] = 2
    return outcome


@kernel
def lose_contact(model, state):
    """P has reached zero, or was negative from the start."""
    if state.x[PHASE] == SLIP:
        P, _, noise = slip_force(model, state, state.x[DIRECTION])
    else:
        P, size = _free_force(model, state)
        noise = ROUNDING * size
    _enter_separation(model, state, P, noise)
    return CONSISTENT


@kernel
def come_to_rest(model, state):
    """f has reached zero: stick if friction can hold the spring, else slip to the side of the spring's pull."""
    state.x[SPEED] = 0.0
    P = stick_force(model, state)
    F = spring_force(model, state)
    if model.r_0 * abs(F) < model.mu_s * P:
        _enter_stick(state, P)
        return CONSISTENT
    # contact may hold although P in stick is negative: in slip the spring presses the slider on with B F
    return enter_slip(model, state, -1.0 if F < 0.0 else 1.0)


@kernel
def touch_down(model, state):
    """The gap has closed: impact, then contact."""
    impact(model, state)
    f = state.x[SPEED]
    if f == 0.0:
        return come_to_rest(model, state)
    return enter_slip(model, state, 1.0 if f > 0.0 else -1.0)


@inlined
def change_phase(model, state, cause, at_once):
    """Carry out a switch, of a phase that may have ended ``at_once``.  Returns CONSISTENT or NO_SOLUTION."""
    if cause == GAP_CLOSED:
        return touch_down(model, state)
    if cause == AT_REST:
        return come_to_rest(model, state)
    if cause == CONTACT_LOST:
        return lose_contact(model, state)
    return break_loose(model, state, 1.0 if cause == RELEASE_FORWARD else -1.0, at_once)
