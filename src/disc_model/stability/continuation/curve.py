"""Pseudo-arclength: steps along a curve F(z) = 0, the test that a step
stays on it, and the multipliers of its cycles, followed from point to point.

F has one row less than z has entries.  A step predicts on the cubic through the former point, and
a corrector goes on within a plane; `check_step` then compares both points as those of a smooth curve.  The
sign of det [F'; tangent] is constant along a curve of regular points: a corrector that has come to
another part of the curve often shows the other one.

A multiplier keeps its eigenvector while its angle turns.  The vector thus tells the sense in which
it turned, which the set of multipliers, symmetric about the real axis, does not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import linear_sum_assignment

from disc_model.arrays import Array, ComplexArray, Indices
from disc_model.errors import DiscModelError
from disc_model.stability.return_map import Orbit
from disc_model.units import Count, Positive, Strict

# A step is taken along one smooth curve if, relative to its length, the corrector moves by no more
# than DRIFT, and the chord differs from the mean tangent by no more than DEFECT: for an arc that
# turns by an angle t they are t^2 / 4 and t^2 / 12 at most, a sixteenth and a fiftieth for 30 deg.
DRIFT = 0.25
DEFECT = 0.02
MOST_POINTS = "max_points"  # why a curve ends that has as many points as it may
SAME = 0.01  # distance of a curve from a point through which it passes, over the step
FARTHEST_PREDICTION = 2  # length of a step that is predicted from the former one, over that
FARTHEST = 0.5  # of a single corrector's way, relative to the step, before it is given up
SHARPEST = 0.9  # cosine of the angle between successive tangents, below which a step is shortened
EASY = 0.99  # the same, above which the next step is longer
GROWTH = 1.5  # factor of such a step
STRONGLY_DAMPED = 0.5  # modulus below which a multiplier causes neither a resonance nor a loss
FASTEST_TURN = 1.2  # rad, of a multiplier within a step: its sense would be in doubt beyond pi
RESONANT = 2.0  # distance from a resonance at which it shows, over its width
NARROWEST = 1e-5  # width of a resonance of undamped multipliers, rad
MOST_TONGUES = 6  # resonances within a step, but forced ones, that are looked at


class Rejected(DiscModelError):
    """A point that cannot be computed, or a step that must be shorter; the message says why."""


class StepControl(Strict):
    """Step lengths and limits of a continuation.

    Steps become shorter by themselves where the curve bends, where multipliers turn fast, and where
    the corrector moves far, as before a jump to another part of the branch.

    Parameters
    ----------
    step, longest, shortest : arclength of the first, the longest and the shortest step
    max_points : largest number of points in each direction

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=14.9)
    >>> dm.continue_cycle(case, "Omega", (14.8, 15.2), steps=dm.StepControl(max_points=3)).ended
    'bound; max_points'
    """

    step: Positive = 0.02
    longest: Positive = 0.1
    shortest: Positive = 1e-7
    max_points: Annotated[Count, Field(ge=1)] = 2000


class Evaluation(NamedTuple):
    """F at a point z: its value (n,), its derivative `by` z, the orbit of the return map, and the
    Jacobian of the map by x, (n, n). Of a border of stability it also has the multiplier `mu` that is
    followed, and its derivative by z, `turning`."""

    residual: Array
    by: Array
    orbit: Orbit
    jacobian: Array
    mu: complex = 1.0
    turning: ComplexArray = np.zeros(0, complex)


@dataclass(frozen=True, eq=False)
class CurvePoint:
    """A point z of a curve, with what is known of F there, the unit tangent, and the sign of
    det [by; tangent]."""

    z: Array
    found: Evaluation
    tangent: Array
    orientation: float

    @property
    def orbit(self) -> Orbit:
        return self.found.orbit

    @cached_property
    def spectrum(self) -> Spectrum:
        return spectrum_of(self.found.jacobian)

    @property
    def value(self) -> float:
        """The last entry of z, which is the scaled parameter of a curve in one parameter."""
        return float(self.z[-1])

    @property
    def leading(self) -> complex:
        """The multiplier of largest modulus; 0 on a section of a single point."""
        return complex(next(iter(self.spectrum.values), 0.0))

    @property
    def slope(self) -> float:
        """The parameter's share of the unit tangent, which vanishes at a fold."""
        return float(self.tangent[-1])

    def reversed(self) -> CurvePoint:
        """The same point of a curve that is followed in the other sense."""
        return replace(self, tangent=-self.tangent, orientation=-self.orientation)


def curve_point(z: Array, found: Evaluation, along: Array) -> CurvePoint:
    """A point of a curve with the tangent that makes an acute angle with the vector `along`."""
    matrix = np.vstack([found.by, along])
    end = np.zeros(len(z))
    end[-1] = 1.0
    try:
        tangent = np.linalg.solve(matrix, end)
    except np.linalg.LinAlgError:  # the curve is normal to the vector
        tangent = np.linalg.svd(found.by)[2][-1]
    tangent = np.asarray(tangent, dtype=float) / float(np.linalg.norm(tangent))
    sign, _ = np.linalg.slogdet(np.vstack([found.by, tangent]))
    return CurvePoint(z, found, tangent, float(sign))


def predict(points: Sequence[CurvePoint], ds: float) -> tuple[Array, Array]:
    """The point expected at arclength ds beyond the last of some, and F' there: on the cubic through it
    and the one before, or along the tangent if that is much nearer, because little is known of a long way
    from a short one."""
    current = points[-1]
    if len(points) > 1:
        length = float(np.linalg.norm(current.z - points[-2].z))
        if ds <= FARTHEST_PREDICTION * length:
            return interpolate(points[-2], current, 1 + ds / length)
    return current.z + ds * current.tangent, current.found.by


def interpolate(before: CurvePoint, after: CurvePoint, share: float) -> tuple[Array, Array]:
    """The point at a share of the way between two, on the cubic with both tangents, and F' there; beyond
    the second for a share above one."""
    length = float(np.linalg.norm(after.z - before.z))
    slopes = [length * before.tangent, length * after.tangent]
    cubic = CubicHermiteSpline([0.0, 1.0], [before.z, after.z], slopes)
    return cubic(share), (1 - share) * before.found.by + share * after.found.by


def check_step(
    before: CurvePoint,
    after: CurvePoint,
    largest_defect: float = DEFECT,
    sharpest: float = SHARPEST,
) -> None:
    """Raise `Rejected` unless two points are neighbours on a smooth curve: the tangents enclose an
    angle of a cosine of at least `sharpest`, and the chord differs from their mean by no more than
    `largest_defect` of its length."""
    chord = after.z - before.z
    length = float(np.linalg.norm(chord))
    if float(before.tangent @ after.tangent) < sharpest:
        raise Rejected("the curve bends too sharply")
    defect = chord - length / 2 * (before.tangent + after.tangent)
    if np.linalg.norm(defect) > largest_defect * length:
        raise Rejected("the curve bends within the step")


def passes(before: CurvePoint, after: CurvePoint, known: CurvePoint) -> bool:
    """Whether the curve between two neighbours passes through a known point in its sense."""
    chord = after.z - before.z
    length = float(np.linalg.norm(chord))
    share = float((known.z - before.z) @ chord) / length**2
    if not 0 < share <= 1 or known.tangent @ chord < 0:
        return False
    there, _ = interpolate(before, after, share)
    return bool(np.linalg.norm(there - known.z) <= SAME * length)


def follow_curve(
    start: CurvePoint,
    advance: Callable[[Sequence[CurvePoint], float], list[CurvePoint]],
    steps: StepControl,
    watch: Callable[[list[CurvePoint]], str],
    growth: float = GROWTH,
    easy: float = EASY,
) -> tuple[list[CurvePoint], str | Rejected]:
    """Points along a curve from `start` on, at most `max_points`, and why it ends.

    From the points so far, `advance` finds the next ones within an arclength, or raises `Rejected`;
    the step is then halved, and the rejection is the end if the step becomes too short. After each
    point, `watch` looks at all of them, may change the last, and says in a word why the curve ends
    there, or "". A step grows where successive tangents enclose an angle of a cosine above `easy`.
    """
    points = [start]
    ds = min(steps.step, steps.longest)
    while len(points) < steps.max_points:
        try:
            ahead = advance(points, ds)
        except Rejected as rejected:
            ds /= 2
            if ds < steps.shortest:
                return points, rejected
            continue
        for point in ahead:
            points.append(point)
            if end := watch(points):
                return points, end
        if float(points[-1].tangent @ points[-2].tangent) > easy:
            ds = min(steps.longest, growth * ds)
    return points, MOST_POINTS


# ---- Multipliers along a curve


class Spectrum(NamedTuple):
    """Eigenvalues of the return map's Jacobian, (n,), largest modulus first; right eigenvectors as
    columns, and left ones as rows with the product one, (n, n) each."""

    values: ComplexArray
    right: ComplexArray
    left: ComplexArray


def spectrum_of(jacobian: Array) -> Spectrum:
    """The spectrum of a Jacobian (n, n)."""
    values, right = np.linalg.eig(jacobian)
    order = np.argsort(-np.abs(values), kind="stable")
    values = values[order].astype(complex)
    right = right[:, order].astype(complex)
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:  # two multipliers with one eigenvector, as where a pair parts
        left = np.linalg.pinv(right)
    return Spectrum(values, right, left)


def follow_multipliers(before: Spectrum, after: Spectrum) -> Indices:
    """Numbers of the multipliers `after` that continue those `before`, by their eigenvectors."""
    resemblance = np.abs(before.left @ after.right)
    return np.asarray(linear_sum_assignment(-resemblance)[1])


def hidden_resonances(before: Spectrum, after: Spectrum) -> list[tuple[float, bool]]:
    """The resonances between two points that neither of them is near enough to show: where the product of
    two multipliers, or of one with the conjugate of another, comes to an angle of 0. In their order,
    each with its share of the way, if angles change evenly, and whether a multiplier passes 1 itself,
    so that the cycle responds.

    All of the latter are among them, and those of the least damped others.  Multipliers that are
    strongly damped at one of the points count for nothing.  Raises `Rejected` if one turns so fast
    that its sense is in doubt.
    """
    successors = after.values[follow_multipliers(before, after)]
    weakly_damped = np.minimum(np.abs(before.values), np.abs(successors)) > STRONGLY_DAMPED
    followed = weakly_damped & (before.values.imag > 0)
    both = np.array([before.values[followed], successors[followed]])
    if np.abs(np.angle(both[1] / both[0])).max(initial=0.0) > FASTEST_TURN:
        raise Rejected("a multiplier turns too fast")

    # each with itself and others, and each with the conjugates of others
    same = np.triu_indices(both.shape[1])
    other = np.triu_indices(both.shape[1], 1)
    sums = both[:, same[0]] * both[:, same[1]]
    differences = both[:, other[0]] * both[:, other[1]].conj()
    start, end = np.hstack([sums, differences])
    angles = np.angle(start)
    turns = np.angle(end / start)
    distances = np.abs([angles, angles + turns])
    nearer = np.argmin(distances, axis=0)
    i, j = np.hstack([same, other])
    damping = np.abs(1 - np.abs(both))
    widths = damping[nearer, i] + damping[nearer, j]
    hidden = angles * (angles + turns) < 0
    hidden &= distances.min(axis=0) > RESONANT * np.maximum(widths, NARROWEST)
    forced = (i == j) & (both[0, i].real > 0)
    others = np.sort(widths[hidden & ~forced])[:MOST_TONGUES]
    hidden &= forced | np.isin(widths, others)
    shares = -angles[hidden] / turns[hidden]
    return sorted(zip(shares.tolist(), forced[hidden].tolist(), strict=True))
