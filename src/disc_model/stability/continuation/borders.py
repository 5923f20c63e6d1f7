"""Borders of stability in the plane of two parameters, followed along the surface of cycles, and
`neutral_curves`, which finds them from lines across the plane; see docs/method.md."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy.interpolate import make_interp_spline

from disc_model.analysis.spectra import Resonance, nearest_resonance
from disc_model.arrays import Array, ComplexArray, Mask
from disc_model.display import counted, drawings
from disc_model.engine.jit.cache import compiling
from disc_model.errors import ParameterError, require
from disc_model.parameters import Parameters
from disc_model.stability.continuation.arguments import CHANGES, require_interval
from disc_model.stability.continuation.curve import (
    CurvePoint,
    Evaluation,
    Rejected,
    StepControl,
    check_step,
    curve_point,
    follow_curve,
    passes,
    spectrum_of,
)
from disc_model.stability.continuation.cycles import (
    BOUND,
    CLOSED,
    FOLD,
    CycleProblem,
    Entry,
    follow_between,
)
from disc_model.stability.cycle import find_cycle
from disc_model.stability.return_map import newton_step
from disc_model.units import UNITS, Count, CycleTolerance, Finite, Positive, Unit, checked

# of steps along borders, where each point costs several cycles: the first and the shortest length, as where
# an event grazes; the growth of a step, and cosines of the angle of successive tangents, above which it grows
# and below which it is shortened
FIRST_STEP = 0.01
SHORTEST_STEP = 1e-5
GROWTH = 1.4
EASY = 0.98
SHARPEST = 0.8
LEAST_RESEMBLANCE = 0.6  # of a multiplier's eigenvectors at two neighbouring points, at most 1
DIFFERENCE = 1e-4  # arclength of the difference that gives a multiplier's gradient
DEFECT = 0.1  # of a step along a border, which turns by up to 37 degrees; see `check_step`
ON_BORDER = 1e-10  # value of the test function that counts as zero
MOST_CORRECTIONS = 12  # of Newton's method at a point of a border
LARGEST_TURN = 0.2  # largest change of the multiplier in a step along a border
MOST_POINTS = 100_000  # largest number of points along a line: an hour of work
SAME_PLACE = 0.01  # distance of a point from a curve through it, over the span of the plane
BETWEEN = 100  # places on a curve between two of its points that are looked at
# relative difference of periods on one curve; those of the two borders of one resonance differ by
# 1 % and more
SAME_PERIOD = 0.004
NEUTRAL = 1e-3  # 1/s, growth rate of a cycle on a border beside a stable one


class BorderProblem:
    """A border of stability on the surface of cycles in two parameters, where a test function
    vanishes.

    On a "neutral" border it is the logarithm of a multiplier's modulus. On a "fold" J - I is
    singular: its inverse, bordered by a row and a column near its null vectors, has a last entry
    that vanishes with it, and is smooth also where a second multiplier comes to 1 (Govaerts,
    Numerical methods for bifurcations of dynamical equilibria, 2000, Section 4.1).
    """

    def __init__(
        self, kind: str, p: Parameters, bounds: Mapping[str, tuple[float, float]], tol: float
    ) -> None:
        self.kind = kind
        self.cycles = CycleProblem(p, bounds, tol)
        self.column = np.zeros(self.cycles.n)
        self.row = np.zeros(self.cycles.n)
        self.left = np.zeros(self.cycles.n, complex)

    def first(self, x: Array, mu: complex) -> CurvePoint:
        """The point of the border next to a cycle of the case at the point x of its section, with
        `mu` as its critical multiplier."""
        z = self.cycles.place(x)
        found = self.cycles.evaluate(z)
        self._keep_vectors(found.jacobian, mu)
        extended = self._extended(z, found, self._test(found.jacobian)[1])
        along = np.linalg.svd(extended.by)[2][-1]
        return self._corrected(curve_point(z, extended, along), 0.0)

    def next_point(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """The border's point at arclength ds beyond the last of some; raises `Rejected` if a
        shorter step is needed."""
        current = points[-1]
        if abs(ds * (current.found.turning @ current.tangent)) > LARGEST_TURN:
            raise Rejected("the multiplier turns too fast")
        ahead = self._corrected(current, ds)
        check_step(current, ahead, DEFECT, SHARPEST)
        return [ahead]

    def _corrected(self, start: CurvePoint, ds: float) -> CurvePoint:
        """The border's point in the plane normal to the tangent at arclength ds, where F and the test
        function vanish."""
        along = start.tangent
        guess = start.z + ds * along
        gradient = start.found.by[-1]
        z = guess
        found = self.cycles.evaluate(z)
        value, mu = self._test(found.jacobian)
        for _ in range(MOST_CORRECTIONS):
            right = np.concatenate([found.residual, [value, along @ (z - guess)]])
            if float(np.linalg.norm(right)) < ON_BORDER:
                return curve_point(z, self._extended(z, found, mu), along)
            move = -newton_step(np.vstack([found.by, gradient, along]), right)
            z = z + move
            found = self.cycles.evaluate(z)
            former = value
            value, mu = self._test(found.jacobian)
            # Broyden's update: a gradient by differences would take four orbits at each correction
            gradient = gradient + (value - former - gradient @ move) / (move @ move) * move
        raise Rejected("Newton's method does not converge")

    def _extended(self, z: Array, found: Evaluation, mu: complex) -> Evaluation:
        """F of a cycle with the derivative of the test function by differences within the surface of
        cycles, and with the multiplier and its derivative."""
        self._keep_vectors(found.jacobian, mu)
        basis = np.linalg.svd(found.by)[2][self.cycles.n :]
        changes = np.zeros((2, 2), complex)
        for i, unit in enumerate(basis):
            for side in (1, -1):
                beside = self.cycles.evaluate(z + side * DIFFERENCE * unit)
                changes[i] += side * np.array(self._test(beside.jacobian)) / (2 * DIFFERENCE)
        gradient, turning = changes.T @ basis
        by = np.vstack([found.by, gradient.real])
        return found._replace(by=by, mu=mu, turning=turning)

    def _keep_vectors(self, jacobian: Array, mu: complex) -> None:
        """Keep, of a point of the border, the singular vectors that border J - I on a fold, or the
        left eigenvector by which the multiplier is known again."""
        if self.kind == FOLD:
            left, _, right = np.linalg.svd(jacobian - np.eye(self.cycles.n))
            self.column = left[:, -1]
            self.row = right[-1]
        else:
            spectrum = spectrum_of(jacobian)
            self.left = spectrum.left[int(np.argmin(np.abs(spectrum.values - mu)))]

    def _test(self, jacobian: Array) -> tuple[float, complex]:
        """Value of the test function, and the multiplier that gives it: the one whose eigenvector
        resembles that of the last point. Raises `Rejected` if none does."""
        if self.kind == FOLD:
            corner = np.zeros((1, 1))
            singular = jacobian - np.eye(self.cycles.n)
            bordered = np.block([[singular, self.column[:, None]], [self.row[None, :], corner]])
            return float(newton_step(bordered, np.append(np.zeros(self.cycles.n), 1.0))[-1]), 1.0
        values, right = np.linalg.eig(jacobian)
        resemblance = np.abs(self.left @ right)
        best = int(np.argmax(resemblance))
        if not resemblance[best] > LEAST_RESEMBLANCE:
            raise Rejected("the multiplier changes its shape too fast")
        return math.log(abs(values[best])), complex(values[best])


def follow_border(
    problem: BorderProblem, first: CurvePoint, steps: StepControl
) -> list[CurvePoint]:
    """The points of a border through its first one, both ways until it leaves the bounds, closes or
    ends; raises `Rejected` if no step along it succeeds."""
    n = problem.cycles.n
    low, high = problem.cycles.bounds

    def watch(points: list[CurvePoint]) -> str:
        """Whether a border ends at its last point: out of the bounds, or back at its first point."""
        start, new = points[0], points[-1]
        if np.any((new.z[n:] < low) | (new.z[n:] > high)):
            return BOUND
        if len(points) > 3 and passes(points[-2], new, start):
            points[-1] = start
            return CLOSED
        return ""

    onward = first if first.tangent[n] >= 0 else first.reversed()
    follow = partial(follow_curve, advance=problem.next_point, steps=steps, watch=watch)
    points, end = follow(onward.reversed(), growth=GROWTH, easy=EASY)
    if end != CLOSED:
        ahead, _ = follow(onward, growth=GROWTH, easy=EASY)
        points = [*points[:0:-1], *ahead]
    if len(points) == 1:
        raise Rejected("no step along the curve succeeds")
    return points


# ---- Curves from lines across the plane


@dataclass(frozen=True, eq=False)
class StabilityCurve:
    """A curve in the plane of two parameters.

    Attributes
    ----------
    kind : "neutral", the leading multiplier has modulus one; or "fold", two cycles meet and vanish
    values : shape (n_points, 2), SI units
    adjoins_stable_cycle : bool, (n_points,), whether a stable cycle is on one side: no other multiplier has modulus > 1
    period : s, (n_points,)
    multipliers : complex, (n_points,), the leading multiplier
    resonance : the resonance to which the curve belongs, determined at its middle
    """

    kind: str
    values: Array = field(repr=False)
    adjoins_stable_cycle: Mask = field(repr=False)
    period: Array = field(repr=False)
    multipliers: ComplexArray = field(repr=False)
    resonance: Resonance


@dataclass(frozen=True, repr=False)
class NeutralCurves:
    """Curves in the plane of two parameters; iterating yields them.

    Attributes
    ----------
    parameters, bounds : the case, and the bounds of both parameters by name, as given to `neutral_curves`
    curves : those that could be followed
    failures : descriptions of those that could not, and of places between points of a line where the branch ends at
        something else, such as a grazing, which is not followed
    """

    parameters: Parameters
    bounds: Mapping[str, tuple[float, float]]
    curves: tuple[StabilityCurve, ...] = field(repr=False)
    failures: tuple[str, ...] = field(repr=False)

    def __iter__(self) -> Iterator[StabilityCurve]:
        return iter(self.curves)

    def __len__(self) -> int:
        return len(self.curves)

    def __repr__(self) -> str:
        found = f"{counted(len(self), 'curve')} over {' and '.join(self.bounds)}"
        return f"NeutralCurves({found}, {len(self.failures)} not followed)"

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the curves with their resonances, thick beside a stable cycle and dashed where cycles end
        in a fold, on axes or in a new figure; returns the axes.

        `look` is as in `FloquetResult.plot`. Raises `ParameterError` without a curve.
        """
        rule = "there is nothing to draw: no curve was found, try other lines"
        require((len(self), "curves", 0, rule))
        return drawings().curves(ax, self, **look)


Plane = Annotated[dict[str, tuple[Finite, Finite]], Unit(UNITS), Field(min_length=2, max_length=2)]
"""Bounds of two parameters by their names."""


@checked
@compiling()
def neutral_curves(
    case: Parameters,
    bounds: Plane,
    lines: tuple[Finite, ...],
    *,
    points: Annotated[Count, Field(ge=2, le=MOST_POINTS)] = 31,
    max_points: Annotated[Count, Field(ge=1)] = 200,
    longest: Positive = 0.1,
    tol: CycleTolerance = 1e-12,
) -> NeutralCurves:
    """Neutral curves and folds, on which stable cycles near the static start lose stability or end, in the
    plane of two parameters.

    Parameters
    ----------
    case : the case; its values of the two parameters are ignored
    bounds : bounds of both, by their names: two of `Parameters.numbers`; SI units, or texts with units
    lines : values of the second parameter, within its bounds; along each of these lines the first parameter is
        scanned for curves
    points : cycles computed along each line; a curve lies between two of which one is stable. Of several
        between the same two only the first is followed: `critical` lists the crossings of a line
    max_points : largest number of points of a curve in each direction from the line
    longest : arclength of the longest step along a curve, see `disc_model.stability.continuation`
    tol : as in `floquet`

    Returns
    -------
    NeutralCurves
        The curves that were found, and descriptions of those that could not be followed.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names each such argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> curves = dm.neutral_curves(case, {"Omega": (14, 15.5), "mu_s": (0.38, 0.42)}, [0.4], points=5)
    >>> len(curves), curves.curves[0].resonance.label
    (1, '2 f_s = 135.42 Hz')
    """
    for name, ends in bounds.items():
        require_interval(case, name, ends)
    y, (low, high) = list(bounds.items())[1]
    beside = [line for line in lines if not low <= line <= high]
    rule = f"must lie within the bounds of {y}, {low:g} to {high:g}"
    require((not beside, "lines", beside, rule))
    steps = StepControl(
        step=FIRST_STEP, longest=longest, shortest=SHORTEST_STEP, max_points=max_points
    )
    search = _CurveSearch(case, bounds, tol, steps)
    for line in lines:
        search.scan(line, points)
    return NeutralCurves(case, bounds, tuple(search.curves), tuple(search.failures))


@dataclass
class _CurveSearch:
    """The search for curves in a plane of two parameters.

    plane : bounds of both parameters by name, SI units; the first one is scanned
    steps : steps along a curve
    curves, failures : what was found so far, and descriptions of what could not be followed
    """

    p: Parameters
    plane: Mapping[str, tuple[float, float]]
    tol: float
    steps: StepControl
    curves: list[StabilityCurve] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    def scan(self, line: float, points: int) -> None:
        """Follow all curves that pass between the points of a line, on which the second parameter
        has one value, by continuation from both neighbours: from special points where a stable cycle
        loses stability or ends."""
        x, y = self.plane
        along = np.linspace(*self.plane[x], points).tolist()
        cases = [self.p.replace(**{y: line, x: value}) for value in along]
        growth = [find_cycle(case, self.tol).growth_rate for case in cases]
        for i in range(points - 1):
            if not growth[i] * growth[i + 1] > 0:
                self._seek(cases[i], growth[i], along[i + 1 :], growth[i + 1 :])
                self._seek(cases[i + 1], growth[i + 1], along[i::-1], growth[i::-1])

    def _seek(
        self, case: Parameters, rate: float, ends: Sequence[float], rates: Sequence[float]
    ) -> None:
        """Follow the curve at which a stable cycle first gains or loses stability, or ends, on the way of
        the cycle of a case to the first of some values of the first parameter. What cannot be followed,
        or ends elsewhere, is among the failures.

        A stable cycle may go on where the search from the static start finds none that is stable: it is
        followed to the next values until one is found there.
        """
        if math.isnan(rate):
            return
        name = next(iter(self.plane))
        begin = case.numbers[name]
        for end, there in zip(ends, rates, strict=True):
            try:
                problem, course = follow_between(case, name, begin, end, self.tol)
            except (ParameterError, Rejected) as error:
                self.failures.append(f"{name}={begin:.6g}: {error}")
                return
            border = _border_of(course.entries)
            if border is not None:
                self._follow(problem, border)
                return
            if course.last != BOUND:
                self.failures.append(f"{name} from {begin:.6g} to {end:.6g}: {course.last}")
                return
            if rate > 0 or there < 0:
                return

    def _follow(self, found: CycleProblem, border: Entry) -> None:
        """Follow the curve through a special point of cycles, unless it is known."""
        kind = FOLD if border.kind == FOLD else "neutral"
        case = found.case(border.point.z)
        place = np.array([case.numbers[name] for name in self.plane])
        if self._is_known(kind, place, border.point.orbit.period):
            return
        try:
            problem = BorderProblem(kind, case, self.plane, self.tol)
            first = problem.first(found.section_point(border.point.z), border.multiplier)
            points = follow_border(problem, first, self.steps)
        except (ParameterError, Rejected) as error:
            where = dict(zip(self.plane, place.tolist(), strict=True))
            self.failures.append(f"{kind} near {where}: {error}")
        else:
            self.curves.append(_curve(problem, points))

    def _is_known(self, kind: str, place: Array, period: float) -> bool:
        """Whether a known curve of this kind, with cycles of this period (s), passes through a
        place of the plane."""
        span = np.diff(list(self.plane.values()))[:, 0]
        for curve in self.curves:
            aside = (curve.values - place) / span / SAME_PLACE
            away = np.column_stack([aside, (curve.period / period - 1) / SAME_PERIOD])
            numbers = np.arange(len(away))
            between = np.linspace(0, numbers[-1], BETWEEN * len(numbers))
            distances = np.linalg.norm(make_interp_spline(numbers, away, k=1)(between), axis=1)
            if curve.kind == kind and distances.min() < 1:
                return True
        return False


def _border_of(entries: Sequence[Entry]) -> Entry | None:
    """The first special point of a branch, on a border, beside a stable cycle."""
    for i, entry in enumerate(entries):
        beside = [each for each in entries[max(i - 1, 0) : i + 2] if each.kind not in CHANGES]
        if entry.kind in CHANGES and any(abs(each.point.leading) < 1 for each in beside):
            return entry
    return None


def _curve(problem: BorderProblem, points: Sequence[CurvePoint]) -> StabilityCurve:
    """The curve of a border that was followed."""
    cycles = problem.cycles
    mu = np.array([point.leading for point in points])
    period = np.array([point.orbit.period for point in points])
    adjoins_stable = np.log(np.abs(mu)) / period < NEUTRAL  # no other multiplier grows
    places = np.flatnonzero(adjoins_stable)
    middle = int(places[len(places) // 2]) if places.size else len(points) // 2
    critical = 1.0 + 0j if problem.kind == FOLD else complex(mu[middle])
    diameters = cycles.leading_diameters(points[middle])
    return StabilityCurve(
        kind=problem.kind,
        values=np.array([cycles.values(point.z) for point in points]),
        adjoins_stable_cycle=adjoins_stable,
        period=period,
        multipliers=mu,
        resonance=nearest_resonance(
            cycles.case(points[middle].z), float(period[middle]), critical, diameters
        ),
    )
