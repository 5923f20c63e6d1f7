"""Taylor coefficients of the three phases, mode by mode: the plain twin of ``disc_model.engine.series``.

Same interface and same numbers (up to rounding) as the vectorised functions, written as the equations of docs/model.md
read.

Every function fills ``s`` (coefficients 0 are given) up to degree ``order``; P up to ``order - 1``.
"""

from __future__ import annotations

from disc_model.engine.layout import HALF, WIDTH


def _product(f, x, k, width, lane):
    """Coefficient k of f(t) x(t), x in lane ``lane``."""
    total = 0.0
    for i in range(k + 1):
        total += f[i] * x[(k - i) * width + lane]
    return total


def _partner(lane):
    """Lane of the other member of the pair."""
    return lane + HALF if lane % WIDTH < HALF else lane - HALF


def _disc_rates(model, s, k):
    """Order k of everything in the modal equations but the contact force.

    Writes z_{k+1}; leaves the force-free part of e'_k in scratch; returns u'' without P and without f'_k B.
    """
    width, width0 = len(model.shift), len(model.force0)
    for j in range(width):
        turned = model.shift[j] * _product(s.f, s.z, k, width, _partner(j))
        s.z[(k + 1) * width + j] = (s.e[k * width + j] + turned) * s.up[k]
    acceleration = 0.0
    for j in range(width):
        rate = model.shift[j] * _product(s.f, s.e, k, width, _partner(j))
        rate -= model.damping[j] * s.e[k * width + j] + model.stiffness[j] * s.z[k * width + j]
        s.scratch[j] = rate
        # l psi (f b)' without f'_k b_0: that one is unknown until P is
        carried = 0.0
        for i in range(k + 1):
            carried += s.f[i] * s.z[(k + 1 - i) * width + j]
        acceleration += model.force[j] * rate + s.down[k] * model.slope[j] * carried
    for j in range(width0):
        i = k * width0 + j
        s.y[i + width0] = s.g[i] * s.up[k]
        acceleration -= model.force0[j] * (model.damping0[j] * s.g[i] + model.stiffness0[j] * s.y[i])
    return acceleration


def _slider_load(model, s, k):
    """Order k of the in-plane force F, and of springs, damper and preload on the slider."""
    F = model.k_p * s.psi[k] - model.c_p * s.f[k]
    vertical = model.k * s.u[k] + model.c * s.v[k]
    if k == 0:
        F += model.c_p * model.Omega
        vertical += model.N - model.k * model.u_0
    return F, vertical


def _advance(model, s, k, P, f_rate, v_rate):
    """Order k + 1 of all velocities and of the slider's motion, once the contact force of order k is known."""
    drive = model.Omega if k == 0 else 0.0
    s.P[k] = P
    s.f[k + 1] = f_rate * s.up[k]
    s.psi[k + 1] = (drive - s.f[k]) * s.up[k]
    s.u[k + 1] = s.v[k] * s.up[k]
    s.v[k + 1] = v_rate * s.up[k]
    width, width0 = len(model.shift), len(model.force0)
    for j in range(width):
        s.e[(k + 1) * width + j] = (s.scratch[j] - model.force[j] * P) * s.up[k]
    for j in range(width0):
        i = k * width0 + j
        rate = -model.damping0[j] * s.g[i] - model.stiffness0[j] * s.y[i]
        s.g[i + width0] = (rate - model.force0[j] * P) * s.up[k]


def _disc_point(model, s):
    """u, u' and the slope B of the disc under the slider, from the coefficients 0."""
    width, width0 = len(model.shift), len(model.force0)
    slope = model.slope @ s.z[:width]
    u = model.force @ s.z[:width] + model.force0 @ s.y[:width0]
    v = model.force @ s.e[:width] + model.force0 @ s.g[:width0]
    return u, v + s.f[0] * slope, slope


def slip_series(model, s, order, direction):
    """Slip with sgn(f) = ``direction``.  Returns the denominator of P, whose zero is Painleve's paradox."""
    s.u[0], s.v[0], slope = _disc_point(model, s)
    friction = direction * model.mu_k / model.r_0
    denominator = 1.0 + model.m * model.compliance + friction * slope
    for k in range(order):
        acceleration = _disc_rates(model, s, k)
        F, vertical = _slider_load(model, s, k)
        P = (vertical + model.m * acceleration + slope * F) / denominator
        rate = (F - friction * P) / model.m
        _advance(model, s, k, P, rate, acceleration + rate * slope - model.compliance * P)
    s.P[order] = 0.0
    for k in range(order + 1):
        s.switch[k] = direction * s.f[k]
    return denominator


def stick_series(model, s, order):
    """Stick: f = 0, the slider rests on the disc.  Fills both release functions mu_s P -/+ r_0 F."""
    s.f[: order + 1] = 0.0
    s.u[0], s.v[0], _ = _disc_point(model, s)
    denominator = 1.0 + model.m * model.compliance
    s.P[order] = s.switch[order] = s.switch2[order] = 0.0
    for k in range(order):
        acceleration = _disc_rates(model, s, k)
        F, vertical = _slider_load(model, s, k)
        P = (vertical + model.m * acceleration) / denominator
        s.switch[k] = model.mu_s * P - model.r_0 * F
        s.switch2[k] = model.mu_s * P + model.r_0 * F
        _advance(model, s, k, P, 0.0, acceleration - model.compliance * P)


def separation_series(model, s, order):
    """No contact: P = 0, disc and slider each for themselves.  Fills the gap u - w."""
    for k in range(order):
        _disc_rates(model, s, k)
        F, vertical = _slider_load(model, s, k)
        _advance(model, s, k, 0.0, F / model.m, -vertical / model.m)
    width, width0 = len(model.shift), len(model.force0)
    for k in range(order + 1):
        w = model.force @ s.z[k * width : (k + 1) * width] + model.force0 @ s.y[k * width0 : (k + 1) * width0]
        s.switch[k] = s.u[k] - w
