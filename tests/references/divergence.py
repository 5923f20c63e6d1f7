"""The divergence of the equations of motion, for Liouville's formula."""

from __future__ import annotations

from disc_model.engine.layout import DIRECTION, PHASE, SEPARATION, SLIP, SPEED
from disc_model.engine.switches import disc_point


def divergence(model, state):
    """Trace of the Jacobian of the rates in the state's phase, 1/s (rows z, e, y, g, psi, f; f fixed in stick)."""
    phase, trace = state.x[PHASE], 0.0
    for j in range(len(model.force)):
        trace -= model.damping[j]
    for j in range(len(model.force0)):
        trace -= model.damping0[j]
    if phase == SEPARATION:
        return trace - model.c_p / model.m
    direction = state.x[DIRECTION] if phase == SLIP else 0.0
    _, _, B = disc_point(model, state)
    D = 1.0 + model.m * model.compliance + direction * model.mu_k * B / model.r_0
    # -sum psi dP/dalpha
    trace -= (model.c * model.compliance - model.m * model.damped_compliance) / D
    if phase == SLIP:
        f, by_f = state.x[SPEED], 0.0
        for j in range(len(model.force)):
            by_f += 2.0 * model.slope[j] * state.e[j] + 2.0 * f * model.bend[j] * state.z[j]
        by_f = (model.m * by_f + (model.c - model.c_p) * B) / D
        trace -= (model.c_p + direction * model.mu_k / model.r_0 * by_f) / model.m
    return trace
