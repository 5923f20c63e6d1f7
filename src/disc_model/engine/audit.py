"""Energy balances of a step (docs/model.md, Energy), by Gauss-Legendre quadrature of the dense
output.

d/dt (disc + vertical slider) = P f B + T v_s - sum 2 xi omega (alpha^2 + beta^2) - c u'^2
d/dt (in-plane)               = Omega r_0^2 F - mu r_0 P |f| - c_p r_0^2 (Omega - f)^2

T v_s is the work of friction T on the disc's surface, whose velocity is v_s; it has no counterpart
in the plane. On a ramp of N the first balance gains N' (u - u_0), because the energy contains N (u
- u_0).
"""

import math

import numpy as np

from . import layout
from .dense_output import force_at, move_to
from .jit import helper, inlined
from .jit.simd import WIDTH, fma, load, splat, total
from .laws import friction_coefficient
from .transitions import disc_point, friction_force, inplane_force_per_radius, slider_motion

# 24 nodes integrate degree 47: products of two series of the usual order are exact to rounding.
_NODES, _WEIGHTS = (a * 0.5 for a in np.polynomial.legendre.leggauss(24))
_NODES = _NODES + 0.5
_PANEL = 8.0  # time units that the nodes resolve; only stick in closed form is longer
# Indices of the sums in the audit's array. TRANSVERSE, INPLANE: sums of the residuals; *_SCALE:
# largest energy exchanged in one step; *_TURNOVER: sum of the moduli of all energy put in and taken
# out; COUPLE: sum of the work T v_s; SURFACE: largest abs(v_s) / (r_0 Omega) at the ends of steps,
# audited or not.
STEPS, WORST, TRANSVERSE, INPLANE, TRANSVERSE_SCALE, INPLANE_SCALE = range(6)
TRANSVERSE_TURNOVER, INPLANE_TURNOVER, COUPLE, SURFACE, N_SUMS = range(6, 11)


@helper
def transverse_energy(model, state, phase):
    """Energy of the disc, of the slider's vertical motion and of a compliant contact, J."""
    u, v = state.x[layout.U], state.x[layout.U_VELOCITY]
    energy = 0.0
    if phase != layout.SEPARATION:
        if model.compliant:
            w, _, _ = disc_point(model, state)
            energy += (w - u) ** 2 / model.compliance
        else:
            u, v, _ = disc_point(model, state)
    for j in range(len(model.shift)):
        energy += state.e[j] ** 2 + model.stiffness[j] * state.z[j] ** 2
    for j in range(len(model.mode_amplitude0)):
        energy += state.g[j] ** 2 + model.stiffness0[j] * state.y[j] ** 2
    raised = u - model.u_0
    return (
        0.5 * energy
        + 0.5 * model.m * v * v
        + 0.5 * model.k * raised**2
        + layout.load_now(model, state) * raised
    )


@helper
def inplane_energy(model, state):
    x = state.x
    return 0.5 * model.r_0**2 * (model.m * x[layout.F] ** 2 + model.k_p * x[layout.PSI] ** 2)


@inlined
def surface_velocity(model, state):
    """v_s: velocity of the disc's surface under the slider, along its path, by which friction bends
    the disc; m/s."""
    velocity = splat(0.0)
    for b in range(0, len(model.shift), WIDTH):
        velocity = fma(load(model.couple, b), load(state.e, b), velocity)
    return -total(velocity)


@helper
def _powers_in(model, state, phase, direction, P):
    """Power into the transverse and the in-plane motion, the sums of the moduli of their parts, and
    T v_s, W."""
    u, v, dw_dtheta = slider_motion(model, state)
    f, F, Omega = (
        state.x[layout.F],
        inplane_force_per_radius(model, state),
        layout.drive_now(model, state),
    )
    lost = model.c * v * v
    for j in range(len(model.shift)):
        lost += model.damping[j] * state.e[j] ** 2
    for j in range(len(model.mode_amplitude0)):
        lost += model.damping0[j] * state.g[j] ** 2
    driven = P * f * dw_dtheta
    supplied = Omega * model.r_0**2 * F
    friction = friction_coefficient(model, direction, f)
    rubbed = friction * model.r_0 * P * f if phase == layout.SLIP else 0.0
    if model.normal:
        # P is R: V = R (1 - s mu B / r_0) is what acts vertically, and R B / r_0 acts in the plane
        rubbed += driven
        driven *= 1.0 - friction * dw_dtheta / model.r_0
    damped = model.c_p * model.r_0**2 * (Omega - f) ** 2
    if model.ramped:
        driven += model.N_rate * (u - model.u_0)
    size, couple = abs(driven) + lost, 0.0
    if model.coupled:
        couple = friction_force(model, state, phase, direction, P) * surface_velocity(model, state)
        driven += couple
        size += abs(couple)
    return (
        driven - lost,
        supplied - rubbed - damped,
        size,
        abs(supplied) + abs(rubbed) + damped,
        couple,
    )


@helper
def audit_step(model, s, order, x_end, phase, direction, probe, audit):
    """Add the residuals of both balances over the step (0, x_end) to ``audit``."""
    work_t, work_p, size_t, size_p = 0.0, 0.0, 0.0, 0.0
    panels = math.ceil(x_end / _PANEL)
    for i in range(len(_NODES) * panels):
        x = (i // len(_NODES) + _NODES[i % len(_NODES)]) * x_end / panels
        move_to(model, s, order, x, phase, probe)
        P = force_at(model, s, order, phase, probe)
        weight = _WEIGHTS[i % len(_NODES)] * x_end / panels * model.unit
        t, p, st, sp, couple = _powers_in(model, probe, phase, direction, P)
        work_t += weight * t
        work_p += weight * p
        size_t += weight * st
        size_p += weight * sp
        audit[COUPLE] += weight * couple
    move_to(model, s, order, 0.0, phase, probe)
    start_t, start_p = transverse_energy(model, probe, phase), inplane_energy(model, probe)
    move_to(model, s, order, x_end, phase, probe)
    residual_t = transverse_energy(model, probe, phase) - start_t - work_t
    residual_p = inplane_energy(model, probe) - start_p - work_p
    accumulate_residuals(
        audit, residual_t, residual_p, size_t + abs(start_t), size_p + abs(start_p)
    )
    audit[TRANSVERSE_TURNOVER] += size_t
    audit[INPLANE_TURNOVER] += size_p
    audit[STEPS] += 1.0


@helper
def accumulate_residuals(audit, residual_t, residual_p, size_t, size_p):
    """Add residuals, with their reference energies ``size_t`` and ``size_p``."""
    audit[TRANSVERSE] += residual_t
    audit[INPLANE] += residual_p
    audit[TRANSVERSE_SCALE] = max(audit[TRANSVERSE_SCALE], size_t)
    audit[INPLANE_SCALE] = max(audit[INPLANE_SCALE], size_p)
    if audit[TRANSVERSE_SCALE] > 0.0:
        audit[WORST] = max(audit[WORST], abs(residual_t) / audit[TRANSVERSE_SCALE])
    if audit[INPLANE_SCALE] > 0.0:
        audit[WORST] = max(audit[WORST], abs(residual_p) / audit[INPLANE_SCALE])


@helper
def audit_impact(model, before, impulse, dw_dtheta, state, audit):
    """Balance of a plastic impact: Delta E = -p^2 (S2 + 1/m) / 2 + p f B, f being that after it.
    The normal force changes f: the energy that the slope takes from the in-plane motion beyond p f
    B is lost."""
    lost, f = 0.5 * impulse**2 * (model.inverse_effective_mass + 1.0 / model.m), state.x[layout.F]
    expected = -lost + impulse * f * dw_dtheta
    after = transverse_energy(model, state, layout.SEPARATION)
    accumulate_residuals(audit, after - before - expected, 0.0, abs(before) + abs(expected), 0.0)
    audit[TRANSVERSE_TURNOVER] += abs(expected)
