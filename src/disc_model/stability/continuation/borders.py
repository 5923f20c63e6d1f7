"""Borders of stability in the plane of two parameters, followed along the surface of cycles, and
`neutral_curves`, which finds them from lines across the plane; see docs/method.md."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Literal, NamedTuple

import numpy as np

from disc_model.analysis.spectra import Resonance, nearest_resonance
from disc_model.arrays import Array, ComplexArray, Mask
from disc_model.display import counted, drawings
from disc_model.engine.jit.cache import compiling
from disc_model.errors import Fault, ParameterError, raise_faults, require, violations
from disc_model.parameters import Parameters, Quantity, foreign_case
from disc_model.simulation.states import is_finite_array
from disc_model.stability.continuation.arguments import free_faults, interval_in_si
from disc_model.stability.continuation.curve import (
    DIVERGES,
    CurvePoint,
    Evaluation,
    Rejected,
    StepControl,
    check_step,
    follow_curve,
    interpolate,
    solve,
    spectrum_of,
)
from disc_model.stability.continuation.cycles import (
    FOLD,
    NEIMARK_SACKER,
    PERIOD_DOUBLING,
    Course,
    CycleProblem,
    Entry,
    Search,
    first_cycle,
    leading,
    parameter_scale,
)
from disc_model.stability.cycle import find_cycle, multipliers
from disc_model.stability.return_map import newton_step
from disc_model.units import CYCLE_TOLERANCES, is_whole, limits_faults

Kind = Literal["neutral", "fold"]
BORDER = StepControl(
    step=0.01, longest=0.05, shortest=1e-5, max_points=400, growth=1.4, easy=0.98, sharpest=0.8
)
"""Steps along borders, where each point costs several cycles; one ends where a shorter step would be
needed, as where an event grazes."""
LEAST_RESEMBLANCE = 0.6  # of a multiplier's eigenvectors at two neighbouring points, at most 1
DIFFERENCE = 1e-4  # arclength of the difference that gives a multiplier's gradient
DEFECT = 0.1  # of a step along a border, which turns by up to 37 degrees; see `check_step`
ON_BORDER = 1e-10  # value of the test function that counts as zero
LONGEST_REACH = 0.1  # longest step on the way to a border
LARGEST_TURN = (
    0.1  # largest change of the multiplier in it; and half of it in a step along a border
)
REACHES = 60  # largest number of such steps
HALVINGS = 6  # of one of them, before it is given up
MOST_CORRECTIONS = 12  # of Newton's method at a point of a border
LARGEST_GROWTH = 1e3  # of its error over the least one: a first update of the gradient may be rough
CLOSES = 0.01  # distance from the first point of a border at which it has closed, over the step
MOST_ON_LINE = StepControl(max_points=500)  # of a branch between two points of a line
BORDER_KINDS: Mapping[str, Kind] = {
    FOLD: "fold",
    NEIMARK_SACKER: "neutral",
    PERIOD_DOUBLING: "neutral",
}
"""Special points of a branch, and the borders on which they lie."""
MOST_POINTS = 100_000  # largest number of points along a line: an hour of work
SAME_PLACE = 0.01  # distance of a point from a curve through it, over the span of the plane
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
        self, kind: Kind, p: Parameters, names: tuple[str, str], tol: float, steps: StepControl
    ) -> None:
        self.kind = kind
        self.steps = steps
        self.cycles = CycleProblem(p, names, None, tol)
        self.column = np.zeros(self.cycles.n)
        self.row = np.zeros(self.cycles.n)
        self.left = np.zeros(self.cycles.n, complex)

    def first(self, x: Array, mu: complex) -> CurvePoint:
        """The point of the border next to a cycle of the case at the point x of its section, with
        `mu` as its critical multiplier."""
        z = self.cycles.place(x)
        found = self.cycles.evaluate(z)
        self._keep_vectors(found.jacobian, mu)
        return self._reach(z, found)

    def next_point(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """The border's point at arclength ds beyond the last of some; raises `Rejected` if a
        shorter step is needed."""
        current = points[-1]
        ahead = self._correct(current, ds)
        if float(ahead.tangent @ current.tangent) < 0:
            ahead = ahead.reversed()
        check_step(current, ahead, self.steps.sharpest, DEFECT)
        return [ahead]

    def _keep_vectors(self, jacobian: Array, mu: complex) -> None:
        """Keep, of a point of the border, the singular vectors that border J - I on a fold, or the
        left eigenvector by which the multiplier is known again."""
        if self.kind == "fold":
            left, _, right = np.linalg.svd(jacobian - np.eye(self.cycles.n))
            self.column = left[:, -1]
            self.row = right[-1]
        else:
            spectrum = spectrum_of(jacobian)
            self.left = spectrum.left[int(np.argmin(np.abs(spectrum.values - mu)))]

    def _test(self, jacobian: Array) -> tuple[float, complex]:
        """Value of the test function, and the multiplier that gives it: the one whose eigenvector
        resembles that of the last point. Raises `Rejected` if none does."""
        if self.kind == "fold":
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

    def _point(self, z: Array, found: Evaluation, mu: complex) -> CurvePoint:
        """A cycle on the surface, with the tangent of the curve on which the test function keeps
        its value."""
        self._keep_vectors(found.jacobian, mu)
        basis = np.linalg.svd(found.by)[2][self.cycles.n :]
        slopes = np.zeros(2)
        turns = np.zeros(2, complex)
        for i, unit in enumerate(basis):
            ends_of_difference = []
            for side in (1, -1):
                beside = self.cycles.evaluate(z + side * DIFFERENCE * unit)
                ends_of_difference.append(self._test(beside.jacobian))
            (value, multiplier), (former_value, former_multiplier) = ends_of_difference
            slopes[i] = (value - former_value) / (2 * DIFFERENCE)
            turns[i] = (multiplier - former_multiplier) / (2 * DIFFERENCE)
        steepness = float(np.linalg.norm(slopes))
        if not steepness > 0:
            raise Rejected("the multiplier does not depend on the parameters")
        along = np.array([-slopes[1], slopes[0]]) / steepness
        tangent = along @ basis
        gradient = slopes @ basis
        sign, _ = np.linalg.slogdet(np.vstack([found.by, gradient, tangent]))
        return CurvePoint(
            z,
            found.by,
            tangent,
            float(sign),
            found.orbit,
            found.jacobian,
            mu=mu,
            gradient=gradient,
            turning=turns @ basis,
        )

    def _reach(self, z: Array, found: Evaluation) -> CurvePoint:
        """Move from a cycle near the border onto it, by the shortest way on the surface."""
        value, mu = self._test(found.jacobian)
        for _ in range(REACHES):
            here = self._point(z, found, mu)
            if abs(value) < ON_BORDER:
                return here
            move = -value * here.gradient / (here.gradient @ here.gradient)
            turn = abs(complex(here.turning @ move))
            shares = (
                1.0,
                LONGEST_REACH / float(np.linalg.norm(move)),
                LARGEST_TURN / max(turn, 1e-300),
            )
            z, found, value, mu = self._moved(here, min(shares) * move)
        raise Rejected("no point of the curve was found near the first cycle")

    def _moved(self, here: CurvePoint, move: Array) -> tuple[Array, Evaluation, float, complex]:
        """The cycle in the direction of a move on the surface, at a shorter distance if need be,
        and the test function there."""
        rows = np.vstack([here.tangent, here.gradient / np.linalg.norm(here.gradient)])
        matrix = np.vstack([here.by, rows])
        for _ in range(HALVINGS):
            try:
                z, found = solve(self.cycles, here.z + move, rows, matrix)
                return z, found, *self._test(found.jacobian)
            except Rejected:
                move = move / 2
        raise Rejected(DIVERGES)

    def _correct(self, start: CurvePoint, ds: float) -> CurvePoint:
        """The border's point at arclength ds: F = 0, test = 0, and the plane normal to the
        tangent."""
        expected = start.mu + complex(start.turning @ (ds * start.tangent))
        if abs(expected - start.mu) > 2 * LARGEST_TURN:
            raise Rejected("the multiplier turns too fast")
        guess = start.z + ds * start.tangent
        rows = start.tangent[None, :]
        gradient = start.gradient
        z = guess
        found = self.cycles.evaluate(z)
        value, mu = self._test(found.jacobian)
        least = math.inf
        for _ in range(MOST_CORRECTIONS):
            right = np.concatenate([found.residual, [value], rows @ (z - guess)])
            error = float(np.linalg.norm(right))
            if error < ON_BORDER:
                return self._point(z, found, mu)
            least = min(least, error)
            if not error <= LARGEST_GROWTH * least:
                break
            move = -newton_step(np.vstack([found.by, gradient, rows]), right)
            z = z + move
            found = self.cycles.evaluate(z)
            former = value
            value, mu = self._test(found.jacobian)
            # Broyden's update: a gradient by differences would take four orbits at each correction
            gradient = gradient + (value - former - gradient @ move) / (move @ move) * move
        raise Rejected(DIVERGES)


class _Watch:
    """Whether a border ends at its last point: out of the bounds, or back at its first point."""

    def __init__(
        self, problem: BorderProblem, first: CurvePoint, bounds: Mapping[str, tuple[float, float]]
    ) -> None:
        self.first = first
        self.n = problem.cycles.n
        self.low, self.high = np.array(list(bounds.values())).T / problem.cycles.scales
        self.closed = False

    def __call__(self, points: list[CurvePoint]) -> bool:
        values = points[-1].z[self.n :]
        if np.any(values < self.low) or np.any(values > self.high):
            return True
        if len(points) > 3 and self._closes(*points[-2:]):
            points[-1] = self.first
            self.closed = True
        return self.closed

    def _closes(self, before: CurvePoint, new: CurvePoint) -> bool:
        chord = new.z - before.z
        length = float(np.linalg.norm(chord))
        share = float((self.first.z - before.z) @ chord) / length**2
        if not 0 < share <= 1 or abs(self.first.mu - new.mu) > 2 * LARGEST_TURN:
            return False
        expected = interpolate(before, new, share)
        return float(np.linalg.norm(expected.z - self.first.z)) < CLOSES * length


def follow_border(
    problem: BorderProblem, first: CurvePoint, bounds: Mapping[str, tuple[float, float]]
) -> list[CurvePoint]:
    """The points of a border through its first one, both ways until it leaves the bounds, closes or
    ends; raises `Rejected` if no step along it succeeds."""
    slopes = first.tangent[problem.cycles.n :]
    slope = slopes[0] if abs(slopes[0]) > 1e-12 else slopes[1]
    onward = first.turned(-1 if slope < 0 else 1)
    watch = _Watch(problem, onward.reversed(), bounds)
    points, _ = follow_curve(onward.reversed(), problem.next_point, problem.steps, watch)
    if not watch.closed:
        ahead = _Watch(problem, onward, bounds)
        onwards, _ = follow_curve(onward, problem.next_point, problem.steps, ahead)
        points = [*points[:0:-1], *onwards]
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
        ranges = [f"{name} from {low:g} to {high:g}" for name, (low, high) in self.bounds.items()]
        plane = " and ".join(ranges)
        return f"NeutralCurves({counted(len(self), 'curve')} over {plane}, {len(self.failures)} not followed)"

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the curves with their resonances, thick beside a stable cycle and dashed where cycles end
        in a fold, on axes or in a new figure; returns the axes.

        `look` is as in `FloquetResult.plot`. Raises `ParameterError` without a curve.
        """
        rule = "there is nothing to draw: no curve was found, try other lines"
        require((len(self), "curves", 0, rule))
        return drawings().curves(ax, self, **look)


@compiling()
def neutral_curves(
    case: Parameters,
    bounds: Mapping[str, tuple[Quantity, Quantity]],
    lines: Sequence[float],
    *,
    points: int = 31,
    max_points: int = 200,
    longest: float = 0.1,
    tol: float = 1e-12,
) -> NeutralCurves:
    """Neutral curves and folds of the cycles near the static start, in the plane of two parameters.

    Parameters
    ----------
    case : the case; its values of the two parameters are ignored
    bounds : bounds of both, by their names: two of `Parameters.numbers`; SI units, or texts with units
    lines : values of the second parameter, within its bounds; along each of these lines the first parameter is
        scanned for curves
    points : cycles computed along each line; a curve lies between two that differ in stability or existence. Of several
        between the same two only one is followed: `critical` lists the crossings of a line
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
    raise_faults(foreign_case(case))
    steps = BORDER.replace(longest=longest, max_points=max_points)
    of_bounds: list[Fault] = []
    plane = _plane_in_si(bounds, of_bounds)
    within = bool(plane) and all(ends is not None for ends in plane.values())
    counts = is_whole(points) and 2 <= points <= MOST_POINTS
    rule = "must be two ascending finite numbers, by the names of two parameters"
    wrong = limits_faults("tol", tol, CYCLE_TOLERANCES) + violations(
        (within or bool(of_bounds), "bounds", bounds, rule),
        (is_finite_array(lines), "lines", lines, "must be finite numbers"),
        (counts, "points", points, f"must be a whole number from 2 to {MOST_POINTS}"),
    )
    wrong += of_bounds
    if within and not wrong:
        low, high = list(plane.values())[1]
        beside = [line for line in lines if not low <= line <= high]
        y = list(plane)[1]
        wrong += violations(
            (not beside, "lines", beside, f"must lie within the bounds of {y}, {low:g} to {high:g}")
        )
    raise_faults(wrong + free_faults(case, list(plane)))

    search = _CurveSearch(case, plane, float(tol), steps)
    for line in map(float, lines):
        search.scan(line, points)
    return NeutralCurves(case, plane, tuple(search.curves), tuple(search.failures))


def _plane_in_si(bounds: Any, faults: list[Fault]) -> dict[Any, Any]:
    """Bounds of two parameters in SI units, by name, None for bounds that are not an interval;
    empty unless there are two names. Units of another kind are added to the faults."""
    if not isinstance(bounds, Mapping) or len(bounds) != 2:
        return {}
    return {name: interval_in_si(name, ends, faults) for name, ends in bounds.items()}


class _Seed(NamedTuple):
    """A special point of a branch from which a curve is followed: its kind, its case, its point of
    the section, its critical multiplier, and its period, s."""

    kind: Kind
    case: Parameters
    x: Array
    mu: complex
    period: float


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

    def __post_init__(self) -> None:
        x, y = self.plane
        self.names = (x, y)
        self.span = np.array([high - low for low, high in self.plane.values()])

    def scan(self, line: float, points: int) -> None:
        """Follow all curves that pass between the points of a line, on which the second parameter
        has one value: from special points where the cycle changes stability or ends, by continuation
        from both neighbours."""
        x, y = self.names
        along = np.linspace(*self.plane[x], points).tolist()
        cases = [self.p.replace(**{y: line, x: value}) for value in along]
        growth = np.array([find_cycle(case, self.tol).growth_rate for case in cases])
        for i, (before, after) in enumerate(pairwise(growth)):
            if before * after > 0:
                continue
            for begin, end in ((i, i + 1), (i + 1, i)):
                if not np.isnan(growth[begin]):
                    seed = self._seed_towards(cases, growth, begin, end)
                    if seed is not None:
                        self._follow(seed)

    def _seed_towards(
        self, cases: Sequence[Parameters], growth: Array, begin: int, end: int
    ) -> _Seed | None:
        """The special point from a case of a line towards its neighbour, or beyond it as long as the
        stable cycle goes on where the search from the static start finds none that is stable."""
        name = self.names[0]
        step = end - begin
        told = len(self.failures)
        for each in cases[end::step]:
            seed = self._seed(cases[begin], each.numbers[name])
            lost = seed is not None or len(self.failures) > told
            if lost or not growth[begin] < 0 or growth[end] < 0:
                return seed
            end += step
        return None

    def _seed(self, case: Parameters, end: float) -> _Seed | None:
        """The special point of a branch from a case to another value of the first parameter at which a
        stable cycle first gains or loses stability, or ends; without a stable one, the first special
        point. What cannot be followed, or ends elsewhere, is among the failures."""
        name = self.names[0]
        begin = case.numbers[name]
        span = (min(begin, end), max(begin, end))
        scale = parameter_scale(case, name, max(map(abs, span)))
        try:
            problem, cycle = first_cycle(case, name, scale, self.tol)
            search = Search(problem, MOST_ON_LINE, span)
            course = search.follow(problem.start(cycle), 1 if begin < end else -1)
        except ParameterError as error:
            self.failures.append(f"{name}={begin:.6g}: {error}")
            return None
        border = _border_of(course)
        if border is None:
            # the cycle may reach the other value, where it is only far from the static start
            if abs(problem.values(course.points[-1])[0] / end - 1) > 1e-12:
                self.failures.append(f"{name} from {begin:.6g} to {end:.6g}: {course.last}")
            return None
        z = border.point.z
        return _Seed(
            BORDER_KINDS[border.kind],
            problem.case(z),
            problem.section_point(z),
            border.multiplier,
            border.point.orbit.period,
        )

    def _follow(self, seed: _Seed) -> None:
        """Follow the curve through a special point, unless it is known."""
        place = np.array([seed.case.numbers[name] for name in self.names])
        if self._is_known(seed.kind, place, seed.period):
            return
        try:
            problem = BorderProblem(seed.kind, seed.case, self.names, self.tol, self.steps)
            points = follow_border(problem, problem.first(seed.x, seed.mu), self.plane)
        except (ParameterError, Rejected) as error:
            x, y = self.names
            where = f"{x}={place[0]:.6g}, {y}={place[1]:.6g}"
            self.failures.append(f"{seed.kind} near {where}: {error}")
            return

        # it may turn out to be known at the point halfway along it, since points are dense where
        # two borders meet
        curve = _curve(problem, points)
        steps = np.linalg.norm(np.diff(curve.values / self.span, axis=0), axis=1)
        length = np.cumsum(steps)
        i = int(np.searchsorted(length, length[-1] / 2)) + 1
        if not self._is_known(seed.kind, curve.values[i], float(curve.period[i])):
            self.curves.append(curve)

    def _is_known(self, kind: str, place: Array, period: float) -> bool:
        """Whether a known curve of this kind, with cycles of this period (s), passes through a
        place of the plane."""
        for curve in self.curves:
            if curve.kind != kind:
                continue
            distance, period_there = _nearest_on(curve, place, self.span)
            if distance < SAME_PLACE and abs(period_there / period - 1) < SAME_PERIOD:
                return True
        return False


def _nearest_on(curve: StabilityCurve, point: Array, span: Array) -> tuple[float, float]:
    """Distance of a point of the plane from a curve, over the span, and the period of the cycle
    there, s."""
    corners = (curve.values - point) / span
    steps = np.diff(corners, axis=0)
    size = np.sum(steps**2, axis=1)
    projection = -np.sum(corners[:-1] * steps, axis=1)
    share = np.clip(projection / np.where(size > 0, size, 1.0), 0.0, 1.0)
    distance = np.linalg.norm(corners[:-1] + share[:, None] * steps, axis=1)
    i = int(np.argmin(distance))
    change = curve.period[i + 1] - curve.period[i]
    return float(distance[i]), float(curve.period[i] + share[i] * change)


def _border_of(course: Course) -> Entry | None:
    """The first special point of a branch beside a stable cycle, or the first of all, on a border."""
    points = course.points
    passed = 0
    first = None
    for entry in course.entries:
        if not entry.kind:
            passed += 1
        if entry.kind in BORDER_KINDS:
            first = first or entry
            if any(abs(leading(point)) < 1 for point in points[max(passed - 1, 0) : passed + 1]):
                return entry
    return first


def _curve(problem: BorderProblem, points: Sequence[CurvePoint]) -> StabilityCurve:
    """The curve of a border that was followed."""
    cycles = problem.cycles
    mu = np.array([multipliers(point.jacobian)[0] for point in points])
    period = np.array([point.orbit.period for point in points])
    adjoins_stable = np.log(np.abs(mu)) / period < NEUTRAL  # no other multiplier grows
    places = np.flatnonzero(adjoins_stable)
    middle = int(places[len(places) // 2]) if places.size else len(points) // 2
    critical = 1.0 + 0j if problem.kind == "fold" else complex(mu[middle])
    diameters = cycles.leading_diameters(points[middle])
    return StabilityCurve(
        kind=problem.kind,
        values=np.array([cycles.values(point) for point in points]),
        adjoins_stable_cycle=adjoins_stable,
        period=period,
        multipliers=mu,
        resonance=nearest_resonance(
            cycles.case(points[middle].z), float(period[middle]), critical, diameters
        ),
    )
