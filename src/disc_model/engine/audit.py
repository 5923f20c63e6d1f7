"""Energy balances of a step (docs/model.md, Energy), by Gauss-Legendre quadrature of the dense
output.

d/dt (disc + vertical slider) = V g B + H v_s - sum 2 xi omega (alpha^2 + beta^2) - c u'^2
d/dt (in-plane)               = Omega r_0^2 F - H r_0 f - c_p r_0^2 (Omega - f)^2

V and H are the vertical and horizontal forces of contact on the disc, v_s the velocity of the
surface on which friction acts, and g = f - v_s / r_0. Together they take T v, the power of friction
T at the slip speed v = r_0 g, from the motion, and V g B - (H - T) v feeds it, which is 0 under the
normal force but for friction on the slope. On a ramp of N the first balance gains N' (u - u_0),
because the energy contains N (u - u_0).
"""

import math
from typing import NamedTuple

import numpy as np

from .dense_output import force_at, move_to
from .jit import helper, inlined
from .laws import friction_coefficient, hold_per_radius
from .model import drive_now, load_now
from .state import DIRECTION, PHASE, PHI_RATE, PSI, SEPARATION, SLIP, STICK, U_VELOCITY, U
from .stretching import membrane_at, membrane_force0
from .transitions import (
    disc_point,
    inplane_force_per_radius,
    instant,
    slider_motion,
    slider_rate,
    surface_velocity,
)

# 24 nodes integrate degree 47: products of two series of the usual order are exact to rounding.
_NODES, _WEIGHTS = (a * 0.5 for a in np.polynomial.legendre.leggauss(24))
_NODES = _NODES + 0.5
_PANEL = 8.0  # time units that the nodes resolve; only stick in closed form is longer
# Places of the sums in the audit's array. TRANSVERSE, INPLANE: sums of the residuals; *_SCALE:
# largest energy exchanged in one step; *_TURNOVER: sum of the moduli of all energy put in and taken
# out; SURFACE: largest abs(v_s) / (r_0 Omega) at the starts of steps,
# audited or not.
STEPS, WORST, TRANSVERSE, INPLANE, TRANSVERSE_SCALE, INPLANE_SCALE = range(6)
TRANSVERSE_TURNOVER, INPLANE_TURNOVER, SURFACE, N_SUMS = range(6, 10)
# In-plane energy over that of the transverse motion, below which it is rounding: nothing moves yet.
NEGLIGIBLE = 1e-9


class Powers(NamedTuple):
    """Powers, W."""

    transverse: float  # into the transverse motion
    inplane: float  # into the in-plane motion
    transverse_size: float  # sum of the moduli of the parts of the former
    inplane_size: float  # of the latter


# ---- Energies and powers


@helper
def transverse_energy(model, state, phase):
    """Return the energy of the disc, of the slider's vertical motion and of a compliant contact,
    J."""
    u = state.x[U]
    v = state.x[U_VELOCITY]
    energy = 0.0
    if model.has_stretching:
        membrane_at(model, state)
    if phase != SEPARATION:
        if model.has_compliance:
            w, _, _ = disc_point(model, state)
            energy += (w - u) ** 2 / model.compliance
        else:
            u, v, _ = disc_point(model, state)
    for j in range(len(model.shift)):
        energy += state.e[j] ** 2 + model.stiffness[j] * state.z[j] ** 2
        if model.has_stretching:
            energy += 0.5 * state.membrane[j] * state.z[j]
    for j in range(len(model.mode_amplitude0)):
        energy += state.g[j] ** 2 + model.stiffness0[j] * state.y[j] ** 2
        if model.has_stretching:
            energy += 0.5 * membrane_force0(model, state.membrane, 1, 0, j) * state.y[j]
    raised = u - model.u_0
    slider = 0.5 * model.m * v * v + 0.5 * model.k * raised**2
    return 0.5 * energy + slider + load_now(model, state) * raised


@helper
def inplane_energy(model, state):
    """Return the energy of the slider's motion in the plane and of its spring there, J."""
    f = slider_rate(model, state)
    psi = state.x[PSI]
    return 0.5 * model.r_0**2 * (model.m * f**2 + model.k_p * psi**2)


@inlined
def surface_share(model, series):
    """Return abs(v_s) over the speed of the drive point at the start of a step by series; 0 if that
    rests."""
    speed = series.drive[0]
    return abs(series.slider[0] - series.f[0]) / speed if speed > 0.0 else 0.0


@inlined
def _forces_on_disc(model, state, phase, direction, P):
    """Return the forces V and H of contact in a phase; P: the contact force, of which H in stick is
    only found where the surface moves."""
    V = P
    H = 0.0
    if phase == SLIP:
        H = friction_coefficient(model, direction, state.x[PHI_RATE]) * P
        if model.has_normal_force:
            _, _, dw_dtheta = disc_point(model, state)
            V -= H * dw_dtheta / model.r_0
            H += P * dw_dtheta / model.r_0
    elif model.has_moving_surface and phase == STICK:
        i, _ = instant(model, state)
        H = model.r_0 * hold_per_radius(model, i)
    return V, H


@helper
def _powers_in(model, state, phase, direction, P):
    """Return the `Powers` in a state of a phase under the contact force P."""
    u, v, dw_dtheta = slider_motion(model, state)
    f = slider_rate(model, state)
    F = inplane_force_per_radius(model, state)
    Omega = drive_now(model, state)

    # what dampers take out
    lost = model.c * v * v
    for j in range(len(model.shift)):
        lost += model.damping[j] * state.e[j] ** 2
    for j in range(len(model.mode_amplitude0)):
        lost += model.damping0[j] * state.g[j] ** 2
    damped = model.c_p * model.r_0**2 * (Omega - f) ** 2

    # what the forces of contact do
    V, H = _forces_on_disc(model, state, phase, direction, P)
    driven = V * state.x[PHI_RATE] * dw_dtheta
    carried = H * surface_velocity(model, state)
    supplied = Omega * model.r_0**2 * F
    braked = H * model.r_0 * f
    if model.has_ramp:
        driven += model.N_rate * (u - model.u_0)
    return Powers(
        transverse=driven + carried - lost,
        inplane=supplied - braked - damped,
        transverse_size=abs(driven) + abs(carried) + lost,
        inplane_size=abs(supplied) + abs(braked) + damped,
    )


# ---- Balances


@helper
def audit_step(model, series, order, x_end, state, probe, audit):
    """Add the residuals of both balances over the step (0, x_end) of the phase of ``state`` to
    ``audit``; ``probe`` is a work state."""
    phase = state.x[PHASE]
    direction = state.x[DIRECTION]

    # work done, and sums of the moduli of its parts
    work_t = 0.0
    work_p = 0.0
    size_t = 0.0
    size_p = 0.0
    panels = max(1, math.ceil(x_end / _PANEL))
    length = x_end / panels
    for i in range(len(_NODES) * panels):
        node = i % len(_NODES)
        x = (i // len(_NODES) + _NODES[node]) * length
        move_to(model, series, order, x, phase, probe)
        P = force_at(model, series, order, phase, probe)
        power = _powers_in(model, probe, phase, direction, P)
        weight = _WEIGHTS[node] * length * model.unit
        work_t += weight * power.transverse
        work_p += weight * power.inplane
        size_t += weight * power.transverse_size
        size_p += weight * power.inplane_size

    # energies at both ends
    move_to(model, series, order, 0.0, phase, probe)
    start_t = transverse_energy(model, probe, phase)
    start_p = inplane_energy(model, probe)
    move_to(model, series, order, x_end, phase, probe)
    residual_t = transverse_energy(model, probe, phase) - start_t - work_t
    residual_p = inplane_energy(model, probe) - start_p - work_p

    reference_t = size_t + abs(start_t)
    reference_p = size_p + abs(start_p)
    accumulate_residuals(audit, residual_t, residual_p, reference_t, reference_p)
    audit[TRANSVERSE_TURNOVER] += size_t
    audit[INPLANE_TURNOVER] += size_p
    audit[STEPS] += 1.0


@helper
def accumulate_residuals(audit, residual_t, residual_p, size_t, size_p):
    """Add residuals, with their reference energies ``size_t`` and ``size_p``, J."""
    audit[TRANSVERSE] += residual_t
    audit[INPLANE] += residual_p
    audit[TRANSVERSE_SCALE] = max(audit[TRANSVERSE_SCALE], size_t)
    audit[INPLANE_SCALE] = max(audit[INPLANE_SCALE], size_p)
    if audit[TRANSVERSE_SCALE] > 0.0:
        audit[WORST] = max(audit[WORST], abs(residual_t) / audit[TRANSVERSE_SCALE])
    inplane_scale = max(audit[INPLANE_SCALE], NEGLIGIBLE * audit[TRANSVERSE_SCALE])
    if inplane_scale > 0.0:
        audit[WORST] = max(audit[WORST], abs(residual_p) / inplane_scale)


@helper
def audit_impact(model, before, impulse, dw_dtheta, state, audit):
    """Add the balance of a plastic impact: Delta E = -p^2 (S + 1/m) / 2 + p g B, g being that after
    it. The normal force changes f: the energy that the slope takes from the in-plane motion beyond
    p f B is lost. It also pushes the surface, by the impulse p B / r_0.

    before : transverse energy before the impact, J
    impulse : p, N s
    dw_dtheta : B
    state : after the impact
    """
    lost = 0.5 * impulse**2 * (model.inverse_effective_mass + 1.0 / model.m)
    expected = -lost + impulse * state.x[PHI_RATE] * dw_dtheta
    if model.has_normal_force and model.has_moving_surface:
        along = impulse * dw_dtheta / model.r_0
        mean = surface_velocity(model, state) - 0.5 * model.surface_inverse_mass * along
        expected += along * mean
    after = transverse_energy(model, state, SEPARATION)
    accumulate_residuals(audit, after - before - expected, 0.0, abs(before) + abs(expected), 0.0)
    audit[TRANSVERSE_TURNOVER] += abs(expected)
