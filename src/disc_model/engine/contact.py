"""The law of contact as a stage of the recurrences: forces of one order of the series, and their
changes.

With the coefficient of friction q (with the sign of the path) and beta = B / r_0, the contact force
R makes friction T, the vertical force V and the force H that brakes the slider (docs/model.md,
Other laws of contact):

    slip:   T = q R               V = R - beta T        H = T + beta R

The disc itself feels V and H alone. In stick these do not depend on T and R, so that they need no
products (`stick`).

Under the vertical force, the paper's, beta counts as zero here. The coefficient k of a product is
the product of the first coefficient of one factor and the k-th of the other, and terms that lower
orders determine, here called known:

    T_k = q_0 R_k + known,    V_k = share_V R_k - known,    H_k = share_H R_k + known

These are linear in what is known and in R_k, and so the same functions serve coefficients, which
are numbers, and changes of coefficients, which are lanes (`tangent`).
"""

from typing import NamedTuple

from .jit import inlined
from .laws import (
    friction_coefficient,
    remaining_fall,
    slip_denominator,
    slip_shares,
    surface_mobility,
)
from .modes import slope


@inlined
def leverage(lever, force, k):
    """Coefficient k of a product without ``lever[0] * force[k]``, in two sums: neither waits."""
    odd = 0.0
    even = 0.0
    for j in range(1, k, 2):
        odd += lever[j] * force[k - j]
        even += lever[j + 1] * force[k - j - 1]
    if k % 2 == 1:
        odd += lever[k] * force[0]
    return odd + even


# ---- Slip


class SlipLaw(NamedTuple):
    """The law of slip at the start of a step."""

    friction: float  # q_0
    beta: float
    share_V: float
    share_H: float
    denominator: float  # of R


class Known(NamedTuple):
    """What lower orders determine of the forces of an order: numbers, or lanes of changes."""

    T: object
    V: object
    H: object


@inlined
def slip_law(model, direction, f, dw_dtheta):
    """Return the law of slip at the rate f on the slope ``dw_dtheta``."""
    friction = friction_coefficient(model, direction, f)
    beta = dw_dtheta / model.r_0
    share_V, share_H = slip_shares(model, friction, beta)
    denominator = slip_denominator(model, model.m, friction, dw_dtheta)
    return SlipLaw(friction, beta, share_V, share_H, denominator)


@inlined
def known_forces(model, series, law, k, direction):
    """Return what lower orders determine of the forces of order k in slip. Enters the coefficient
    of friction of order k where it depends on the speed, for which f is needed up to this order."""
    T = 0.0
    leaning_R = 0.0
    leaning_T = 0.0
    if model.has_varying_friction:
        put_coefficient(model, series, k, direction)
        T = leverage(series.coefficient, series.P, k)
    if model.has_normal_force:
        series.slope[k] = slope(model, series, k) / model.r_0
        leaning_R = leverage(series.slope, series.P, k)
        leaning_T = law.friction * leaning_R
        if model.has_varying_friction:
            leaning_T = leverage(series.slope, series.friction, k)
    return known_of(model, law, T, leaning_R, leaning_T)


@inlined
def known_of(model, law, T, leaning_R, leaning_T):
    """Return `Known` from the known parts of T, beta R and beta T, numbers or lanes."""
    if model.has_normal_force:
        return Known(T, law.beta * T + leaning_T, T + leaning_R)
    return Known(T, 0.0 * T, T)


@inlined
def known_numerator(model, law, known):
    """Return what the known forces add to the numerator of R in rigid contact, numbers or lanes."""
    braked = 0.0 - law.beta * known.H
    if model.has_moving_surface:
        braked = surface_mobility(model, model.m) * braked
    if model.has_normal_force:
        mobility = 1.0 + model.m * model.inverse_effective_mass
        return mobility * known.V + braked
    return braked


@inlined
def put_coefficient(model, series, k, direction):
    """Enter order k of the coefficient q of friction that depends on the speed, of the share phi of
    ``remaining_fall`` and of its lever: with s = ``direction`` and the model's ``decay`` d

        q = s mu_k + s (mu_s - mu_k) phi + mu_v r_0 f
        hyperbolic: (1 + d s f) phi = 1,    exponential: phi' = -d s f' phi

    Both are products of phi and its lever, which is f or the series of k f_k.
    """
    fall = direction * model.decay
    if k == 0:
        series.share[0] = remaining_fall(model, direction, series.f[0])
        series.lever[0] = 0.0
        series.coefficient[0] = friction_coefficient(model, direction, series.f[0])
        return
    if model.has_exponential_friction:
        series.lever[k] = k * series.f[k]
        factor = -fall / k
    else:
        series.lever[k] = series.f[k]
        factor = -fall / (1.0 + fall * series.f[0])
    series.share[k] = factor * leverage(series.lever, series.share, k)
    excess = direction * model.fall_of_friction * series.share[k]
    series.coefficient[k] = excess + model.viscous * series.f[k]


@inlined
def put_sensitivity(model, series, k, direction):
    """Enter order k of R dq/df, the change of T with f at the same R, in the letters of
    `put_coefficient`, and of its part w by which friction falls. With e = s (mu_s - mu_k) phi R

        hyperbolic: (1 + d s f) w = -d s e,    exponential: w = -d s e,    R dq/df = w + mu_v r_0 R
    """
    fall = direction * model.decay
    excess = series.share[0] * series.P[k] + leverage(series.share, series.P, k)
    excess = direction * model.fall_of_friction * excess
    if model.has_exponential_friction:
        series.weakening[k] = -fall * excess
    else:
        excess += leverage(series.f, series.weakening, k)
        series.weakening[k] = -fall * excess / (1.0 + fall * series.f[0])
    series.sensitivity[k] = series.weakening[k] + model.viscous * series.P[k]


@inlined
def slip_growth(model, series, direction):
    """Return the rate at which a change of g grows or decays at the start of a step of slip where
    friction depends on the speed, 1/s."""
    put_sensitivity(model, series, 0, direction)
    growth = abs(series.sensitivity[0]) / (model.m * model.r_0)
    return growth * surface_mobility(model, model.m)
