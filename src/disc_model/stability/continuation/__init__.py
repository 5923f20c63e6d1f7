"""Continuation of a cycle in one parameter, and of its stability borders in two, by
pseudo-arclength.

A cycle is a zero of F(x, q) = R(x, q) - x.  R is a return map, x the point of the section and q
the free parameters; the Jacobian of F by both comes from the variational equations.  A fold, where
two cycles meet, is a regular point of the curve F = 0.  Distances mix x, over the norm of the
static deflection, with q, over the parameters' scales.

`curve` predicts points of any curve, tests whether a step stays on it, and follows multipliers;
`cycles` is F, a branch in one parameter and its special points, `borders` those of
stability in two; `branch` is the result, and `arguments` reads what is asked.
"""

from disc_model.stability.continuation.arguments import CHANGES, Bounds, require_interval
from disc_model.stability.continuation.borders import NeutralCurves, StabilityCurve, neutral_curves
from disc_model.stability.continuation.branch import Branch, continue_cycle
from disc_model.stability.continuation.curve import Rejected, StepControl
from disc_model.stability.continuation.cycles import follow_between

__all__ = [
    "CHANGES",
    "Bounds",
    "Branch",
    "NeutralCurves",
    "Rejected",
    "StabilityCurve",
    "StepControl",
    "continue_cycle",
    "follow_between",
    "neutral_curves",
    "require_interval",
]
