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


def _apply_force(model, s, k, P):
    """Velocities of order k + 1, once the contact force of order k is known."""
    width, width0 = len(model.shift), len(model.force0)
    for j in range(width):
        s.e[(k + 1) * width + j] = (s.scratch[j] - model.force[j] * P) * s.up[k]
    for j in range(width0):
        i = k * width0 + j
        rate = -model.damping0[j] * s.g[i] - model.stiffness0[j] * s.y[i]
        s.g[i + width0] = (rate - model.force0[j] * P) * s.up[k]


def _disc_point(model, s):
    """u, u' and the slope B of the disc under the slider, from the coefficients 0."""
    u, v, slope = 0.0, 0.0, 0.0
    for j in range(len(model.shift)):
        u += model.force[j] * s.z[j]
        v += model.force[j] * s.e[j]
        slope += model.slope[j] * s.z[j]
    for j in range(len(model.force0)):
        u += model.force0[j] * s.y[j]
        v += model.force0[j] * s.g[j]
    return u, v + s.f[0] * slope, slope


def slip_series(model, s, order, direction):
    """Slip with sgn(f) = ``direction``.  Returns the denominator of P, whose zero is Painleve's paradox."""
    s.u[0], s.v[0], slope = _disc_point(model, s)
    friction = direction * model.mu_k / model.r_0
    denominator = 1.0 + model.m * model.compliance + friction * slope
    for k in range(order):
        acceleration = _disc_rates(model, s, k)
        F = model.k_p * s.psi[k] - model.c_p * s.f[k]
        vertical = model.k * s.u[k] + model.c * s.v[k]
        drive = 0.0
        if k == 0:
            F += model.c_p * model.Omega
            vertical += model.N - model.k * model.u_0
            drive = model.Omega
        P = (vertical + model.m * acceleration + slope * F) / denominator
        s.P[k] = P
        rate = (F - friction * P) / model.m
        s.f[k + 1] = rate * s.up[k]
        s.psi[k + 1] = (drive - s.f[k]) * s.up[k]
        s.u[k + 1] = s.v[k] * s.up[k]
        s.v[k + 1] = (acceleration + rate * slope - model.compliance * P) * s.up[k]
        _apply_force(model, s, k, P)
    s.P[order] = 0.0
    for k in range(order + 1):
        s.switch[k] = direction * s.f[k]
    return denominator


def stick_series(model, s, order):
    """Stick: f = 0, the slider rests on the disc.  Fills both release functions mu_s P -/+ r_0 F."""
    s.f[: order + 1] = 0.0
    s.u[0], s.v[0], _ = _disc_point(model, s)
    denominator = 1.0 + model.m * model.compliance
    s.psi[1 : order + 1] = 0.0
    s.psi[1] = model.Omega * model.unit
    s.P[order] = s.switch[order] = s.switch2[order] = 0.0
    for k in range(order):
        acceleration = _disc_rates(model, s, k)
        vertical = model.k * s.u[k] + model.c * s.v[k]
        F = model.k_p * s.psi[k]
        if k == 0:
            vertical += model.N - model.k * model.u_0
            F += model.c_p * model.Omega
        P = (vertical + model.m * acceleration) / denominator
        s.P[k] = P
        s.u[k + 1] = s.v[k] * s.up[k]
        s.v[k + 1] = (acceleration - model.compliance * P) * s.up[k]
        s.switch[k] = model.mu_s * P - model.r_0 * F
        s.switch2[k] = model.mu_s * P + model.r_0 * F
        _apply_force(model, s, k, P)


def separation_series(model, s, order):
    """No contact: P = 0, disc and slider each for themselves.  Fills the gap u - w."""
    for k in range(order):
        _disc_rates(model, s, k)
        F = model.k_p * s.psi[k] - model.c_p * s.f[k]
        vertical = model.k * s.u[k] + model.c * s.v[k]
        drive = 0.0
        if k == 0:
            F += model.c_p * model.Omega
            vertical += model.N - model.k * model.u_0
            drive = model.Omega
        s.P[k] = 0.0
        s.f[k + 1] = F / model.m * s.up[k]
        s.psi[k + 1] = (drive - s.f[k]) * s.up[k]
        s.u[k + 1] = s.v[k] * s.up[k]
        s.v[k + 1] = -vertical / model.m * s.up[k]
        _apply_force(model, s, k, 0.0)
    width, width0 = len(model.shift), len(model.force0)
    for k in range(order + 1):
        w = 0.0
        for j in range(width):
            w += model.force[j] * s.z[k * width + j]
        for j in range(width0):
            w += model.force0[j] * s.y[k * width0 + j]
        s.switch[k] = s.u[k] - w
