"""The laws of friction and contact at an instant (docs/model.md, Contact), each written once.

A law takes an `Instant`, whose entries are real or complex numbers.  After a complex step of one
entry, the imaginary part holds the derivative with respect to it, exact to rounding (Squire and
Trapp, SIAM Review 40, 1998).

Letters are those of docs/model.md: P or R is the contact force, V its vertical part with that of
friction, T friction, H the force that brakes the slider in the plane, F the pull of the spring in
the plane divided by r_0, B the slope of the disc under the slider and beta = B / r_0.
"""

from typing import NamedTuple

import numpy as np

from .jit import inlined

TINY = 1e-100  # the complex step: its square is far below rounding, but not zero


class Instant(NamedTuple):
    """Arguments of the laws, with respect to which they are differentiated: parameters of the
    model, then entries of a state."""

    N: float
    k: float
    c: float
    m: float
    k_p: float
    c_p: float
    Omega: float
    compliance: float  # 0 if contact is rigid
    psi: float
    g: float  # rate of the contact over the material
    w: float  # displacement of the disc under the slider
    w_velocity: float  # its velocity, in the slider's frame
    dw_dtheta: float  # B
    free: float  # A, the disc's acceleration there but for the contact force and g'
    surface_velocity: float  # v_s of the surface on which friction acts; 0 if it does not move
    surface_free: float  # G, its acceleration but for the contact force, likewise
    u: float  # of the slider, where that is a state of its own
    u_velocity: float


(
    PSI_ENTRY,
    G_ENTRY,
    W_ENTRY,
    W_VELOCITY_ENTRY,
    DW_DTHETA_ENTRY,
    FREE_ENTRY,
    SURFACE_VELOCITY_ENTRY,
    SURFACE_FREE_ENTRY,
    U_ENTRY,
    U_VELOCITY_ENTRY,
    N_ENTRIES,
) = range(8, 19)


@inlined
def slider_rate(model, i):
    """The slider's angular speed f: that over the material and that of the surface."""
    if model.has_moving_surface:
        return i.g + i.surface_velocity / model.r_0
    return i.g


@inlined
def inplane_force_per_radius(model, i):
    """F = k_p psi + c_p (Omega - f): the in-plane force divided by r_0, N/m."""
    return i.k_p * i.psi + i.c_p * (i.Omega - slider_rate(model, i))


@inlined
def free_pull(model, i):
    """F - m G / r_0: what accelerates the slider over the material but for contact, divided by r_0,
    N/m."""
    if model.has_moving_surface:
        return inplane_force_per_radius(model, i) - i.m / model.r_0 * i.surface_free
    return inplane_force_per_radius(model, i)


@inlined
def surface_mobility(model, m):
    """1 + m S_t: by how much more a force H accelerates slider and surface apart than the slider
    alone."""
    if model.has_moving_surface:
        return 1.0 + m * model.surface_inverse_mass
    return 1.0


@inlined
def free_force(model, i):
    """N + k (u - u_0) + c u' + m A: the contact force without its denominator and the term with B
    (rigid contact)."""
    return i.N + i.k * (i.w - model.u_0) + i.c * i.w_velocity + i.m * i.free


# ---- Slip


@inlined
def remaining_fall(model, direction, f):
    """The share of mu_s - mu_k by which friction in slip has not fallen yet: phi, 1 where slip
    begins."""
    fallen = direction * model.decay * f
    if model.has_exponential_friction:
        return np.exp(-fallen)
    return 1.0 / (1.0 + fallen)


@inlined
def friction_coefficient(model, direction, f):
    """The coefficient of friction in slip, with the sign of ``direction``."""
    if model.has_varying_friction:
        excess = model.fall_of_friction * remaining_fall(model, direction, f)
        return direction * (model.mu_k + excess) + model.viscous * f
    return direction * model.mu_k


@inlined
def slip_shares(model, friction, beta):
    """V and H per unit of the contact force, under a ``friction_coefficient``: the vertical force
    is a normal force without slope."""
    if model.has_normal_force:
        return 1.0 - friction * beta, friction + beta
    return 1.0, friction


@inlined
def slip_denominator(model, m, friction, dw_dtheta):
    """The denominator of the contact force in slip under a ``friction_coefficient``."""
    beta = dw_dtheta / model.r_0
    vertical, inplane = slip_shares(model, friction, beta)
    if model.has_compliance:
        return vertical
    if model.has_moving_surface:
        inplane = inplane * surface_mobility(model, m)
    # in this order: the quotient does not wait for the slope
    return (1.0 + m * model.inverse_effective_mass) * vertical + inplane / model.r_0 * dw_dtheta


@inlined
def slip_numerator(model, i):
    """The contact force in slip, P, or R under the normal force, multiplied by its denominator."""
    if model.has_compliance:
        return stick_numerator(model, i)
    return free_force(model, i) + i.dw_dtheta * free_pull(model, i)


@inlined
def slip_rates(model, i, friction, force):
    """Forces V and H on the disc, and g', under the contact force of slip and a
    ``friction_coefficient``."""
    vertical, inplane = slip_shares(model, friction, i.dw_dtheta / model.r_0)
    H = inplane * force
    braked = surface_mobility(model, i.m) * H / model.r_0
    return vertical * force, H, (free_pull(model, i) - braked) / i.m


# ---- Stick


@inlined
def stick_numerator(model, i):
    """The vertical contact force V in stick (g = 0), multiplied by 1 + m S in rigid contact."""
    if model.has_compliance:
        return (i.w - i.u) / i.compliance
    return free_force(model, i)


@inlined
def vertical_in_stick(model, i):
    """Vertical contact force V in stick (g = 0)."""
    if model.has_compliance:
        return stick_numerator(model, i)
    return stick_numerator(model, i) / (1.0 + i.m * model.inverse_effective_mass)


@inlined
def hold_per_radius(model, i):
    """The force H by which the disc holds the slider in stick (g = 0), divided by r_0, N/m."""
    if model.has_moving_surface:
        return free_pull(model, i) / surface_mobility(model, i.m)
    return free_pull(model, i)


@inlined
def stick_loads(model, i, V):
    """Tangential load (pull) and normal load (press) of stick under V: friction holds while
    abs(pull) <= mu_s press. Under the normal force both are in units of 1 / (1 + beta^2), a common
    factor."""
    hold = hold_per_radius(model, i)
    pull = model.r_0 * hold
    press = V
    if model.has_normal_force:
        press = press + hold * i.dw_dtheta
        pull = pull - i.dw_dtheta / model.r_0 * V
    return pull, press


# ---- Impact


@inlined
def impact(model, i):
    """Plastic impact (Eqs. 29-37): the vertical impulse, and g after it, which the slope reduces if
    the force is normal."""
    lever = 0.0 * i.dw_dtheta  # of the type of an entry
    if model.has_normal_force:
        lever = i.dw_dtheta / (i.m * model.r_0**2) * surface_mobility(model, i.m)
    give = model.inverse_effective_mass + 1.0 / i.m + i.dw_dtheta * lever
    p = (i.w_velocity - i.u_velocity) / give
    return p, i.g - p * lever


# ---- Derivatives


@inlined
def _step(value, here):
    return complex(value, TINY if here else 0.0)


@inlined
def stepped(i, entry):
    """An instant with a complex step in one entry."""
    return Instant(
        N=_step(i.N, entry == 0),
        k=_step(i.k, entry == 1),
        c=_step(i.c, entry == 2),
        m=_step(i.m, entry == 3),
        k_p=_step(i.k_p, entry == 4),
        c_p=_step(i.c_p, entry == 5),
        Omega=_step(i.Omega, entry == 6),
        compliance=_step(i.compliance, entry == 7),
        psi=_step(i.psi, entry == PSI_ENTRY),
        g=_step(i.g, entry == G_ENTRY),
        w=_step(i.w, entry == W_ENTRY),
        w_velocity=_step(i.w_velocity, entry == W_VELOCITY_ENTRY),
        dw_dtheta=_step(i.dw_dtheta, entry == DW_DTHETA_ENTRY),
        free=_step(i.free, entry == FREE_ENTRY),
        surface_velocity=_step(i.surface_velocity, entry == SURFACE_VELOCITY_ENTRY),
        surface_free=_step(i.surface_free, entry == SURFACE_FREE_ENTRY),
        u=_step(i.u, entry == U_ENTRY),
        u_velocity=_step(i.u_velocity, entry == U_VELOCITY_ENTRY),
    )
