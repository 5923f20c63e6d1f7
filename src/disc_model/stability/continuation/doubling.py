"""Period doublings seen from the cycle of twice the period: where it begins and ends.

A cycle of an even number of releases shrinks at a period doubling to one of half as many. A curve
of such cycles goes through that point, and from there on along the same cycles, half a period
later. A branch therefore begins and ends there.
"""

from __future__ import annotations

import numpy as np

from disc_model.display import counted
from disc_model.errors import ParameterError
from disc_model.stability.continuation.curve import CurvePoint, Rejected, curve_point, solve
from disc_model.stability.continuation.ends import DOUBLED, End
from disc_model.stability.continuation.problem import CycleProblem
from disc_model.stability.continuation.spectrum import spectrum_of
from disc_model.stability.return_map import Array

# largest distance, over the deflection, of a cycle from itself half a period later that is looked at
# as one of half the period: at a doubling, Newton's method comes to a double zero
SAME = 1e-3
NEAR_DOUBLING = 0.02  # distance from -1 of the multiplier from which a branch is sought there
DEPARTURE = 5e-3  # distance of a branch's first cycle from the doubling, over the deflection


def releases_in_half(problem: CycleProblem) -> int:
    """Releases in half a period of the problem's cycles; 0 if a period has an odd number."""
    if problem.order is None or problem.order.releases % 2:
        return 0
    return problem.order.releases // 2


def half_a_period_on(problem: CycleProblem, z: Array) -> Array:
    """The way on the section from a cycle of an even number of releases to itself half a period
    later, (n,), over the deflection; raises `Rejected` without a return."""
    return problem.residual(z, releases_in_half(problem))


def passes_doubling(problem: CycleProblem, before: CurvePoint, after: CurvePoint) -> bool:
    """Whether two neighbours on a branch of cycles of an even number of releases are the same ones,
    half a period apart: the curve passes a period doubling between them."""
    if not releases_in_half(problem):
        return False
    try:
        first = half_a_period_on(problem, before.z)
        second = half_a_period_on(problem, after.z)
    except Rejected:
        return False
    return float(first @ second) < 0


def doubling_end(problem: CycleProblem, point: CurvePoint) -> End:
    """The end of a branch at a period doubling near a point, in words."""
    half = counted(releases_in_half(problem), "release")
    text = f"a period doubling at {problem.words(point)}: the cycle becomes one of {half}"
    return End(DOUBLED, text)


def leave_doubling(problem: CycleProblem, start: CurvePoint) -> CurvePoint | None:
    """The first cycle of a branch that begins at a period doubling, near a cycle of half as many
    releases, with the tangent away from it; None if the start is no such cycle.

    Raises `ParameterError` if the start is one of half as many releases, and not at a doubling.
    """
    half = releases_in_half(problem)
    if not half or np.linalg.norm(half_a_period_on(problem, start.z)) > SAME:
        return None
    shorter = problem.evaluate(start.z, half)
    spectrum = spectrum_of(shorter.jacobian)
    critical = int(np.argmin(np.abs(spectrum.values + 1)))
    rule = f"releases={2 * half}: the cycle at this state repeats after {counted(half, 'release')}"
    if abs(spectrum.values[critical] + 1) > NEAR_DOUBLING:
        raise ParameterError(f"{rule}; follow it with releases={half}")

    # along the eigenvector, and across the branch of half the period, on which the plane has no cycle
    away = np.append(np.real(spectrum.right[:, critical]), 0.0)
    away /= np.linalg.norm(away)
    along = np.linalg.svd(shorter.by)[2][-1]
    row = away - (away @ along) * along
    row /= np.linalg.norm(row)
    guess = start.z + DEPARTURE * away
    try:
        matrix = np.vstack([problem.evaluate(guess).by, row])
        z, found = solve(problem, guess, row[None, :], matrix, DEPARTURE)
    except Rejected as lost:
        raise ParameterError(f"{rule}, and no cycle of twice the period is near: {lost}") from None
    return curve_point(z, found, row)
