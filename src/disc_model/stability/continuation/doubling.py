"""Period doublings seen from the cycle of twice the period: where it begins and ends.

A cycle of an even number of releases shrinks at a period doubling to one of half as many. A curve
of such cycles goes through that point, and from there on along the same cycles, half a period
later. A branch therefore begins and ends there.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import newton as root_by_secants

from disc_model.display import counted
from disc_model.errors import ParameterError
from disc_model.stability.continuation.curve import CurvePoint, Rejected, curve_point, solve
from disc_model.stability.continuation.ends import DOUBLED, End
from disc_model.stability.continuation.problem import CycleProblem
from disc_model.stability.continuation.spectrum import spectrum_of
from disc_model.stability.return_map import Array, Orbit, newton

# largest distance, over the deflection, of a cycle from itself half a period later that is looked at
# as one of half the period: at a doubling, Newton's method comes to a double zero
SAME = 1e-3
NEAR_DOUBLING = 0.02  # distance from -1 of the multiplier from which a branch is sought there
# the first change of the parameter in the search for a doubling, and the last one, over its scale; how
# far a doubling may be from the cycle beside which it is sought
BESIDE = 1e-6
ROUNDING = 1e-12
FARTHEST = 0.2
# distances of a branch's first cycle from the doubling, over the deflection: the branch may end nearer
DEPARTURES = (5e-3, 1e-3, 2e-4)


def releases_in_half(problem: CycleProblem) -> int:
    """Releases in half a period of the problem's cycles; 0 if a period has an odd number."""
    if problem.order is None or problem.order.releases % 2:
        return 0
    return problem.order.releases // 2


def half_a_period_on(problem: CycleProblem, z: Array) -> Array:
    """The way on the section from a cycle of an even number of releases to itself half a period
    later, (n,), over the deflection; raises `Rejected` without a return."""
    return problem.residual(z, releases_in_half(problem))


def comes_to_doubling(problem: CycleProblem, before: CurvePoint, after: CurvePoint) -> bool:
    """Whether a branch of cycles of an even number of releases comes to a period doubling at the
    second of two neighbours: both are the same cycles, half a period apart, or the second one hardly
    differs from itself half a period later."""
    if not releases_in_half(problem):
        return False
    try:
        first = half_a_period_on(problem, before.z)
        second = half_a_period_on(problem, after.z)
    except Rejected:
        return False
    if float(first @ second) < 0:
        return True
    return bool(np.linalg.norm(second) < min(SAME, float(np.linalg.norm(first))))


def locate_doubling(problem: CycleProblem, near: CurvePoint) -> CurvePoint | None:
    """The period doubling beside a cycle of twice the period, where that of half the releases has the
    multiplier -1; None if it is not found.

    The shorter cycle is regular there, while F of the longer one has a double zero.
    """
    half = releases_in_half(problem)
    z = near.z.copy()
    z[: problem.n] += half_a_period_on(problem, near.z) / 2

    def excess(value: float) -> float:
        """By how much the critical multiplier exceeds -1 at a scaled value of the parameter; `z` is
        then the shorter cycle there."""
        nonlocal z
        z[-1] = value
        orbit = _shorter_cycle(problem, z, half)
        if orbit is None:
            raise Rejected("the shorter cycle is not found")
        z = problem.moved_to(z, orbit.start)
        values = spectrum_of(orbit.jacobian).values
        return float(np.real(values[np.argmin(np.abs(values + 1))] + 1))

    try:
        value = root_by_secants(excess, near.value, x1=near.value + BESIDE, tol=ROUNDING)
        excess(value)
        found = problem.evaluate(z)
    except (Rejected, RuntimeError):  # which scipy raises where a search does not converge
        return None
    if np.linalg.norm(z - near.z) > FARTHEST:
        return None
    return curve_point(z, found, near.tangent)


def _shorter_cycle(problem: CycleProblem, z: Array, releases: int) -> Orbit | None:
    """The orbit of the shorter cycle near a point of the longer one's problem; None if it is not
    found."""
    start = problem.section_point(z)
    return newton(problem.map_at(z), start, releases=releases, may_separate=True)


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
    # at a doubling the longer cycle is a double solution, which its search misses by some 1e-4
    z = start.z
    orbit = _shorter_cycle(problem, z, half)
    if orbit is not None:
        z = problem.moved_to(z, orbit.start)
    shorter = problem.evaluate(z, half)
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
    for distance in DEPARTURES:
        guess = z + distance * away
        try:
            matrix = np.vstack([problem.evaluate(guess).by, row])
            first, found = solve(problem, guess, row[None, :], matrix, distance)
        except Rejected as lost:
            reason = str(lost)
        else:
            return curve_point(first, found, row)
    raise ParameterError(f"{rule}, and no cycle of twice the period is near: {reason}")
