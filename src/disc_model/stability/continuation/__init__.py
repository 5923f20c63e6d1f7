"""Continuation of a cycle in one parameter, and of its stability borders in two, by
pseudo-arclength.

A cycle is a zero of F(x, q) = R(x, q) - x.  R is a return map, x the point of the section and q
the free parameters; the Jacobian of F by both comes from the variational equations.  A fold, where
two cycles meet, is a regular point of the curve F = 0.  Distances mix x, over the norm of the
static deflection, with q, over the parameters' scales.

`curve` predicts and corrects points of any curve, and tests whether a step stays on it; `problem`
is F, and `first_cycle` a zero of it; `spectrum` follows multipliers from point to point.  In one
parameter `tracing` takes a step, `course` both ways from a cycle, `special` locates special points,
`ends` finds the reason for which a branch ends, and `cycles` does all of it; `arguments` reads what
it is asked, and `found` makes a `Branch` of the result.
`borders` follows borders of stability.
"""

from disc_model.stability.continuation.arguments import free_faults, interval_in_si
from disc_model.stability.continuation.borders import BORDER, Kind, continue_border
from disc_model.stability.continuation.branch import Branch
from disc_model.stability.continuation.course import UNLOCATED
from disc_model.stability.continuation.curve import StepControl
from disc_model.stability.continuation.cycles import continue_cycle
from disc_model.stability.continuation.problem import CycleProblem
from disc_model.stability.continuation.special_point import SpecialPoint

__all__ = [
    "BORDER",
    "UNLOCATED",
    "Branch",
    "CycleProblem",
    "Kind",
    "SpecialPoint",
    "StepControl",
    "continue_border",
    "continue_cycle",
    "free_faults",
    "interval_in_si",
]
