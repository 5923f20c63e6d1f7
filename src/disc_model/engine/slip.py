"""Taylor coefficients of slip (docs/model.md, Slip), with the law of contact as a stage.

In rigid contact the slider moves with the disc under it: with u'' = A + B f' - S V, its equation of
motion gives the contact force of order k (see `contact` for the letters),

    R_k denominator = (N + k (u - u_0) + c u' + m A + B F)_k + known

On a compliant contact u, u' are states, and R_k denominator = V_k + known with V = (w - u) / C.
Where the surface on which friction acts moves with the velocity v_s, v_s' = G + S_t H, the rate of
the contact over the material, f here, is less than the slider's by v_s / r_0; F - m G / r_0 stands in
place of F, and (1 + m S_t) H in place of H.
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
    by_f: float  # f in G
    by_V: float  # impulse of V of the order before in G; twice this is that of H in A
    by_H: float  # impulse of H of the order before in G
    pull_by_f: float  # f in -F / m + G / r_0
    pull_by_V: float  # impulses in it
    pull_by_H: float
    pull_by_drift: float  # v_s without the impulse of H in it


class Factors(NamedTuple):
    """Constants of a step, by which terms are multiplied."""

    spring: float  # psi in F / m
    damper: float  # the rate of psi in F / m
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
    factors = _factors(model, law, f, B, disc.along_by_f)
    acceleration = disc.acceleration
    pending = disc.pending
    along_known = disc.along - f * disc.along_by_f
    surface = surface_velocity(model, series)
    drift = surface
    series.surface[0] = surface
    V_impulse = 0.0
    H_impulse = 0.0
    for k in range(order):
        # u'' of the disc without the forces of this order, and F / m
        if k > 0:
            pairs, single, pending = next_turning(
                model, series, k, f, V_impulse, H_impulse, pending
            )
            by_speed = disc.by_f + disc.by_f_rate * series.down[k]
            rest = single + f * by_speed + V_impulse * model.damped_inverse_mass
            if model.has_moving_surface:
                rest += 2.0 * factors.surface.by_V * H_impulse
                along_known = total(pairs.along)
            acceleration = total(pairs.up) + rest
        # in this order: only the last terms wait for f and the impulses
        pull = factors.spring * psi + factors.damper * series.drive[k]
        if model.has_moving_surface:
            pull = _pull_on_surface(
                factors.surface, pull, along_known, drift, f, V_impulse, H_impulse
            )
        else:
            pull -= factors.damper * f

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
        rate_f = pull - factors.brake * R
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

        # the slider and the surface under it
        up = series.up[k]
        psi = (series.drive[k] - f) * up
        if model.has_moving_surface:
            turn = factors.surface.inverse_radius * surface * up
            psi -= turn
            of_forces = factors.surface.by_V * V_impulse + factors.surface.by_H * H_impulse
            drift = (along_known + factors.surface.by_f * f + of_forces) * up
            surface = drift + model.surface_inverse_mass * (H * up)
            series.turn[k + 1] = turn
            series.surface[k + 1] = surface
        V_impulse = V * up
        H_impulse = H * up
        f = rate_f * up
        u = v * up
        v = rate_v * up
        series.psi[k + 1] = psi
        series.f[k + 1] = f
        series.u[k + 1] = u
        series.v[k + 1] = v

    put_last_forces(model, series, order, V_impulse, H_impulse)
    for j in range(0, order + 1, WIDTH):
        store(series.switch, j, direction * load(series.f, j))
    # remains of an earlier step in another phase
    series.switch[order + 1] = 0.0
    series.P[order] = 0.0
    return law.denominator


@inlined
def _pull_on_surface(by, spring, along, drift, f, V_impulse, H_impulse):
    """F / m - G / r_0 of an order, from what the spring and the drive give; along: G without f and
    the impulses of the order before, drift: v_s without that of H."""
    known = spring - by.inverse_radius * along - by.pull_by_drift * drift
    return (known - by.pull_by_f * f) - (by.pull_by_V * V_impulse + by.pull_by_H * H_impulse)


@inlined
def _factors(model, law, f, B, along_by_f):
    """`Factors` of a step that begins at the rate f on the slope B; along_by_f: f in G."""
    S = model.inverse_effective_mass
    lightness = 1.0 / model.m
    lever = lightness / model.r_0 * surface_mobility(model, model.m)
    brake = lever * law.share_H
    inverse = 1.0 / law.denominator
    by_acceleration = inverse * model.m
    return Factors(
        spring=model.k_p * lightness,
        damper=model.c_p * lightness,
        lever=lever,
        brake=brake,
        recoil=S * law.share_V + B * brake,
        inverse=inverse,
        by_acceleration=by_acceleration,
        by_u=inverse * model.k,
        by_v=inverse * model.c,
        by_pull=by_acceleration * B,
        surface=_surface_factors(model, f, along_by_f),
    )


@inlined
def _surface_factors(model, f, along_by_f):
    """`SurfaceFactors` of a step that begins at the rate f; along_by_f: f in G."""
    inverse_radius = 1.0 / model.r_0
    damper = model.c_p / model.m
    by_V = f * model.surface_swing
    by_H = -model.damped_surface_inverse_mass
    return SurfaceFactors(
        inverse_radius=inverse_radius,
        by_f=along_by_f,
        by_V=by_V,
        by_H=by_H,
        pull_by_f=damper + inverse_radius * along_by_f,
        pull_by_V=inverse_radius * by_V,
        pull_by_H=inverse_radius * (by_H + damper * model.surface_inverse_mass),
        pull_by_drift=inverse_radius * damper,
    )
