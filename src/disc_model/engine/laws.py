"""The laws of friction and contact at an instant (docs/model.md, Contact), each written once.

A law takes an `Instant`, whose entries are real or complex numbers.  After a complex step of one
entry, the imaginary part holds the derivative with respect to it, exact to rounding (Squire and
Trapp, SIAM Review 40, 1998).
"""

from collections import namedtuple

from .jit import inlined

TINY = 1e-100  # the complex step: its square is far below rounding, but not zero


# Arguments of the laws, with respect to which they are differentiated: parameters of the model, and
# those of a state. compliance: 0 if rigid; w, w_velocity, dw_dtheta: of the disc under the slider,
# in its frame; free: A, the disc's acceleration there but for the contact force and f'; u,
# u_velocity: of the slider, where that is a state of its own.
Instant = namedtuple(
    "Instant", "N k c m k_p c_p Omega compliance psi f w w_velocity dw_dtheta free u u_velocity"
)
(
    PSI_ENTRY, F_ENTRY, W_ENTRY, W_VELOCITY_ENTRY, DW_DTHETA_ENTRY, FREE_ENTRY, U_ENTRY, U_VELOCITY_ENTRY, N_ENTRIES,
) = range(8, 17)  # fmt: skip


@inlined
def inplane_force_per_radius(i):
    """F = k_p psi + c_p (Omega - f): the in-plane force divided by r_0, N/m."""
    return i.k_p * i.psi + i.c_p * (i.Omega - i.f)


@inlined
def free_force(model, i):
    """N + k (u - u_0) + c u' + m A: the contact force without its denominator and the term with B
    (rigid contact)."""
    return i.N + i.k * (i.w - model.u_0) + i.c * i.w_velocity + i.m * i.free


@inlined
def stick_numerator(model, i):
    """The vertical contact force V in stick (f = 0), multiplied by 1 + m S2 in rigid contact."""
    return (i.w - i.u) / i.compliance if model.compliant else free_force(model, i)


@inlined
def vertical_in_stick(model, i):
    """Vertical contact force V in stick (f = 0)."""
    if model.compliant:
        return stick_numerator(model, i)
    return stick_numerator(model, i) / (1.0 + i.m * model.inverse_effective_mass)


@inlined
def friction_coefficient(model, direction, f):
    """The coefficient of friction in slip, with the sign of ``direction``."""
    if model.decaying:
        return direction * (
            model.mu_k + (model.mu_s - model.mu_k) / (1.0 + direction * model.decay * f)
        )
    return direction * model.mu_k


@inlined
def slip_denominator(model, m, friction, dw_dtheta):
    """The denominator of the contact force in slip under a ``friction_coefficient``."""
    if model.normal:
        beta = dw_dtheta / model.r_0
        if model.compliant:
            return 1.0 - friction * beta
        return (1.0 + m * model.inverse_effective_mass) * (1.0 - friction * beta) + (
            friction + beta
        ) * beta
    if model.compliant:
        return 1.0
    return 1.0 + m * model.inverse_effective_mass + friction * dw_dtheta / model.r_0


@inlined
def slip_numerator(model, i):
    """The contact force in slip, P, or R under the normal force, multiplied by its denominator."""
    if model.compliant:
        return stick_numerator(model, i)
    return free_force(model, i) + i.dw_dtheta * inplane_force_per_radius(i)


@inlined
def slip_rates(model, i, friction, force):
    """Vertical force V on the disc, and f', under the contact force of slip and a
    ``friction_coefficient``."""
    if model.normal:
        beta = i.dw_dtheta / model.r_0
        V, held = force * (1.0 - friction * beta), (friction + beta) * force
    else:
        V, held = force, friction * force
    return V, (inplane_force_per_radius(i) - held / model.r_0) / i.m


@inlined
def stick_loads(model, i, V):
    """Tangential load (pull) and normal load (press) of stick under V: friction holds while
    abs(pull) <= mu_s press. Under the normal force both are in units of 1 / (1 + (B / r_0)^2), a
    common factor."""
    pull, press = model.r_0 * inplane_force_per_radius(i), V
    if model.normal:
        press = press + inplane_force_per_radius(i) * i.dw_dtheta
        pull = pull - i.dw_dtheta / model.r_0 * V
    return pull, press


@inlined
def friction_in_stick(model, i, V):
    """Friction T in stick under V, N."""
    pull, _ = stick_loads(model, i, V)
    return pull / (1.0 + (i.dw_dtheta / model.r_0) ** 2) if model.normal else pull


@inlined
def impact(model, i):
    """Plastic impact (Eqs. 29-37): the impulse, and f after it, which the slope reduces if the
    force is normal."""
    lever = (
        i.dw_dtheta / (i.m * model.r_0**2) if model.normal else 0.0 * i.dw_dtheta
    )  # of the type of an entry
    p = (i.w_velocity - i.u_velocity) / (
        model.inverse_effective_mass + 1.0 / i.m + i.dw_dtheta * lever
    )
    return p, i.f - p * lever


@inlined
def _step(value, here):
    return complex(value, TINY if here else 0.0)


@inlined
def stepped(i, entry):
    """An instant with a complex step in one entry."""
    return Instant(
        _step(i.N, entry == 0), _step(i.k, entry == 1), _step(i.c, entry == 2), _step(i.m, entry == 3),
        _step(i.k_p, entry == 4), _step(i.c_p, entry == 5), _step(i.Omega, entry == 6), _step(i.compliance, entry == 7),
        _step(i.psi, entry == PSI_ENTRY), _step(i.f, entry == F_ENTRY),
        _step(i.w, entry == W_ENTRY), _step(i.w_velocity, entry == W_VELOCITY_ENTRY),
        _step(i.dw_dtheta, entry == DW_DTHETA_ENTRY), _step(i.free, entry == FREE_ENTRY),
        _step(i.u, entry == U_ENTRY), _step(i.u_velocity, entry == U_VELOCITY_ENTRY),
    )  # fmt: skip
