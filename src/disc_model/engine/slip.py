"""Taylor coefficients of slip (docs/model.md, Slip), with the law of contact as a stage.

In rigid contact the slider moves with the disc under it: with u'' = A + B f' - S V, its equation of
motion gives the contact force of order k (see `contact` for the letters),

    R_k denominator = (N + k (u - u_0) + c u' + m A + B F)_k + known

On a compliant contact u, u' are states, and R_k denominator = V_k + known with V = (w - u) / C.

Where the surface on which friction acts moves with the velocity v_s, v_s' = G + S_t H, the slider's
own rate follows the paper's equation, and f, that of the contact over the material, is less by
v_s / r_0. In the numerator A - B G / r_0, u'' at a steady rate of the slider, stands in place of A.
"""

from typing import NamedTuple

from .contact import known_forces, known_numerator, slip_law
from .jit import inlined
from .jit.simd import WIDTH, load, store, total
from .laws import surface_mobility
from .modes import (
    begin_turning,
    deflection,
    next_turning,
    put_last_forces,
    rest_on_disc,
    slope,
    surface_velocity,
)


class SurfaceFactors(NamedTuple):
    """Constants of a step for a surface that moves."""

    inverse_radius: float
    lever: float  # H in minus the rate of the slider's own rate
    lean: float  # G in -u'' at a steady rate of the slider
    by_f: float  # f in G
    by_V: float  # impulse of V of the order before in G
    by_H: float  # impulse of H of the order before in G


class Factors(NamedTuple):
    """Constants of a step, by which terms are multiplied."""

    spring: float  # psi in F / m
    damper: float  # the rate of psi in F / m
    by_f: float  # f in u'' at a steady rate of the slider, but for f'
    by_V: float  # impulse of V of the order before in it
    by_H: float  # impulse of H of the order before in it
    lever: float  # H in -f'
    brake: float  # R in -f', by its share of H
    recoil: float  # R in -u'', by its shares of V and H
    inverse: float  # the numerator in R; the others are those of its terms in rigid contact:
    by_acceleration: float
    by_u: float
    by_v: float
    by_pull: float  # F / m
    surface: SurfaceFactors


@inlined
def slip_series(model, series, order, direction):
    """Fill ``series``, whose coefficients 0 are given, up to degree ``order`` with slip in the
    sense of ``direction``; P, which is R, up to ``order - 1``, and the event function direction *
    f. Returns the denominator of R, whose zero is Painleve's paradox, or a jammed contact."""
    f = series.f[0]
    psi = series.psi[0]
    B = slope(model, series, 0)
    law = slip_law(model, direction, f, B)
    rest_on_disc(model, series, B)
    u = series.u[0]
    v = series.v[0]
    disc = begin_turning(model, series)
    factors = _factors(model, law, f, B, disc)
    acceleration = disc.acceleration
    pending = disc.pending
    slider = f
    G = disc.along
    if model.has_moving_surface:
        acceleration -= factors.surface.lean * G
        slider += factors.surface.inverse_radius * surface_velocity(model, series)
        series.slider[0] = slider
    V_impulse = 0.0
    H_impulse = 0.0
    for k in range(order):
        # u'' at a steady rate of the slider without the forces of this order, and F / m
        if k > 0:
            pairs, single, pending = next_turning(
                model, series, k, f, V_impulse, H_impulse, pending
            )
            by_speed = factors.by_f + disc.by_f_rate * series.down[k]
            rest = single + f * by_speed + V_impulse * factors.by_V
            if model.has_moving_surface:
                rest += factors.by_H * H_impulse
                along = total(pairs.along)
                rest -= factors.surface.lean * along
                G = _surface_acceleration(factors.surface, along, f, V_impulse, H_impulse)
            acceleration = total(pairs.up) + rest
        # in this order: only the last term waits for the slider
        pull = factors.spring * psi + factors.damper * series.drive[k]
        pull -= factors.damper * slider
        free = pull
        if model.has_moving_surface:
            free -= factors.surface.inverse_radius * G

        # the law of contact
        known = known_forces(model, series, law, k, direction)
        if model.has_compliance:
            V = (deflection(model, series, k) - u) / model.compliance
            R = factors.inverse * (V + known.V)
        else:
            rest = factors.inverse * series.preload[k] + factors.by_u * u + factors.by_v * v
            rest += factors.by_pull * pull
            R = factors.by_acceleration * acceleration + rest
            if model.has_normal_force or model.has_varying_friction:
                R += factors.inverse * known_numerator(model, law, known)
        series.P[k] = R
        V = law.share_V * R
        H = law.share_H * R
        rate_f = free - factors.brake * R
        rate_v = acceleration + B * pull - factors.recoil * R
        if model.has_normal_force or model.has_varying_friction:
            V -= known.V
            H += known.H
            braked = factors.lever * known.H
            rate_f -= braked
            rate_v += model.inverse_effective_mass * known.V - B * braked
            series.friction[k] = law.friction * R + known.T
        if model.has_compliance:
            series.V[k] = V
            rate_v = (V - (series.preload[k] + model.k * u + model.c * v)) / model.m

        # the slider
        up = series.up[k]
        psi = (series.drive[k] - slider) * up
        V_impulse = V * up
        H_impulse = H * up
        f = rate_f * up
        slider = f
        if model.has_moving_surface:
            slider = (pull - factors.surface.lever * H) * up
            series.slider[k + 1] = slider
        u = v * up
        v = rate_v * up
        series.psi[k + 1] = psi
        series.f[k + 1] = f
        series.u[k + 1] = u
        series.v[k + 1] = v

    put_last_forces(model, series, order, V_impulse, H_impulse)
    for j in range(0, order + 1, WIDTH):
        store(series.switch, j, direction * load(series.f, j))
        if model.has_moving_surface:
            carried = load(series.slider, j) - load(series.f, j)
            store(series.turn, j + 1, carried * load(series.up, j))
    # remains of an earlier step in another phase
    series.switch[order + 1] = 0.0
    series.P[order] = 0.0
    return law.denominator


@inlined
def _surface_acceleration(by, along, f, V_impulse, H_impulse):
    """G of an order; along: what the pairs give to it but for f and the impulses of the order
    before."""
    return along + (by.by_f * f + (by.by_V * V_impulse + by.by_H * H_impulse))


@inlined
def _factors(model, law, f, B, disc):
    """`Factors` of a step that begins at the rate f on the slope B; disc: `Turning` at its start."""
    S = model.inverse_effective_mass
    lightness = 1.0 / model.m
    lever = lightness / model.r_0 * surface_mobility(model, model.m)
    brake = lever * law.share_H
    inverse = 1.0 / law.denominator
    by_acceleration = inverse * model.m
    surface = _surface_factors(model, f, B, disc.along_by_f)
    by_f = disc.by_f
    by_V = model.damped_inverse_mass
    by_H = 0.0
    if model.has_moving_surface:
        by_f -= surface.lean * surface.by_f
        by_V -= surface.lean * surface.by_V
        by_H = 2.0 * surface.by_V - surface.lean * surface.by_H
    return Factors(
        spring=model.k_p * lightness,
        damper=model.c_p * lightness,
        by_f=by_f,
        by_V=by_V,
        by_H=by_H,
        lever=lever,
        brake=brake,
        recoil=S * law.share_V + B * brake,
        inverse=inverse,
        by_acceleration=by_acceleration,
        by_u=inverse * model.k,
        by_v=inverse * model.c,
        by_pull=by_acceleration * B,
        surface=surface,
    )


@inlined
def _surface_factors(model, f, B, along_by_f):
    """`SurfaceFactors` of a step that begins at the rate f on the slope B; along_by_f: f in G."""
    inverse_radius = 1.0 / model.r_0
    return SurfaceFactors(
        inverse_radius=inverse_radius,
        lever=inverse_radius / model.m,
        lean=inverse_radius * B,
        by_f=along_by_f,
        by_V=f * model.surface_swing,
        by_H=-model.damped_surface_inverse_mass,
    )
