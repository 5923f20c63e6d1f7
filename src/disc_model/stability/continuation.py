"""Continuation of a cycle in one parameter, and of its stability borders in two, by
pseudo-arclength.

A cycle is a zero of F(x, q) = R(x, q) - x.  R is the return map, x the point of the section and q
the free parameters; the Jacobian of F by both comes from the variational equations.  A fold, where
two cycles meet, is a regular point of the curve F = 0.  Distances mix x, over the norm of the
static deflection, with q, over the parameters' scales.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from disc_model.display import counted, draw
from disc_model.engine.jit.cache import compiling
from disc_model.errors import Fault, ParameterError, raise_faults, require, suggestion, violations
from disc_model.parameters import DEFAULTS, Parameters, Quantity, foreign_case
from disc_model.simulation.states import State, is_finite_array
from disc_model.stability.cycle import FloquetResult, find_cycle, guess_faults, multipliers
from disc_model.stability.return_map import (
    ENDS,
    PARAMETERS,
    Array,
    Counts,
    Flight,
    ReturnMap,
    newton_step,
    rounding,
)
from disc_model.units import (
    CYCLE_TOLERANCES,
    Count,
    Finite,
    Positive,
    Strict,
    in_si,
    is_number,
    limits_faults,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# typical values of parameters whose value in Table 1 is missing or 0
USUAL = {"Omega": 20.0, "N": 300.0, "c": 0.5, "c_p": 0.5, "contact_compliance": 1e-8}
USUAL |= {"damping_ratio": 1e-3, "friction_decay": 1.0}
DIFFERENCE = 1e-5  # over a parameter's scale: flights are accurate to 1e-13, their second derivatives of order one


@dataclass(frozen=True)
class Place:
    """A point z of the surface F = 0, with F's derivative `by` z; of a curve also its unit tangent;
    of a border the multiplier `mu` that is followed, and the gradients of the test function and of
    `mu` within the surface."""

    z: Array
    residual: Array
    by: Array
    flight: Flight
    jacobian: Array
    tangent: Array = field(default_factory=lambda: np.zeros(0))
    mu: complex = 1.0
    gradient: Array = field(default_factory=lambda: np.zeros(0))
    turning: NDArray[np.complex128] = field(default_factory=lambda: np.zeros(0, complex))

    @cached_property
    def basis(self) -> Array:
        """Orthonormal basis of the null space of `by`: (number of parameters, n + number of
        parameters)."""
        return np.asarray(np.linalg.svd(self.by)[2][len(self.residual) :], dtype=float)


class CycleProblem:
    """F(x, q) in unknowns z = (x / size, q / scales); a `scale` replaces a parameter's value, or a
    fifth of a typical one. With an `order` cycles may lose contact, and must have these numbers of
    events: elsewhere the map has a corner.
    """

    def __init__(
        self,
        p: Parameters,
        names: tuple[str, ...],
        scale: float | None,
        tol: float,
        order: Counts | None = None,
    ) -> None:
        self.base, self.names, self.tol, self.order = p, names, tol, order
        self._analytic = tuple(name for name in names if name in PARAMETERS)
        self._reference = reference = ReturnMap(p, tol)
        self.n, self.scale, self.size = reference.size, reference.scale, reference.deflection
        usual = DEFAULTS | USUAL
        self.scales = np.array(
            [scale or max(abs(p.numbers[name]), 0.2 * usual.get(name, 0.0)) for name in names]
        )

    def case(self, z: Array) -> Parameters:
        values = (z[self.n :] * self.scales).tolist()
        return self.base.replace(**dict(zip(self.names, values, strict=True)))

    def evaluate(self, z: Array) -> Place:
        p = self.case(z)
        if min(p.Omega, p.N, p.k_p) <= 0:
            raise ParameterError("the drive, the preload or the in-plane spring vanishes")
        flight, turn, residual = self._fly(p, z, self._analytic)
        if self.order and flight.counts != self.order:
            counts = zip(Counts._fields, self.order, flight.counts, strict=True)
            changes = (
                f"{name.replace('_', ' ')} {before} to {now}"
                for name, before, now in counts
                if before != now
            )
            raise ParameterError(f"the order of events changes: {', '.join(changes)}")
        jacobian = flight.jacobian * turn[:, None] / turn[None, :]
        if not (
            np.all(np.isfinite(jacobian))
            and np.all(np.isfinite(flight.by))
            and np.all(np.isfinite(residual))
        ):
            raise ParameterError("the variational equations are singular: a switch is grazed")
        parameters = np.zeros((self.n, len(self.names)))
        known = [name in self._analytic for name in self.names]
        parameters[:, known] = flight.by * turn[:, None] * self.scales[None, known] / self.size
        for i in np.flatnonzero(np.logical_not(known)):
            move = DIFFERENCE * np.eye(len(z))[self.n + i]
            ends = [self._fly(self.case(z + side * move), z, tangent=False)[2] for side in (1, -1)]
            parameters[:, i] = (ends[0] - ends[1]) / (2 * DIFFERENCE)
        return Place(
            z, residual, np.hstack([jacobian - np.eye(self.n), parameters]), flight, jacobian
        )

    def _fly(
        self, p: Parameters, z: Array, names: tuple[str, ...] = (), *, tangent: bool = True
    ) -> tuple[Flight, Array, Array]:
        """The flight from the point of z, the factor to the reference's coordinates, and the
        residual in these."""
        map_ = ReturnMap(p, self.tol, names, patient=self.order is not None)
        x = z[: self.n] * self.size / self.scale * map_.scale
        releases = self.order.releases if self.order else 1
        flight = map_.evaluate(
            x, releases=releases, tangent=tangent, may_separate=self.order is not None
        )
        if not flight.returned:
            raise ParameterError(f"the motion does not return: {ENDS[flight.outcome]}")
        turn = (
            self.scale / map_.scale
        )  # they differ where frequencies of the disc are not those of the reference
        return flight, turn, (flight.end - x) * turn / self.size

    def correct(self, z: Array, rows: Array, targets: Array) -> Place:
        """Solve F = 0 with `rows` z = `targets`, in at most seven steps of Newton's method."""
        point, last = self.evaluate(z), math.inf
        for _ in range(8):
            right = np.concatenate([point.residual, rows @ point.z - targets])
            error = float(np.linalg.norm(right))
            if error <= 30 * self.tol:
                return point
            if error > 0.8 * last:
                if error <= rounding(self.tol, 1e4):
                    return point
                break
            last = error
            point = self.evaluate(point.z - newton_step(np.vstack([point.by, rows]), right))
        raise ParameterError("Newton's method does not converge")

    def leading_diameters(self, jacobian: Array) -> int:
        """Nodal diameters of the modes with most energy in the leading multiplier's eigenvector."""
        values, vectors = np.linalg.eig(jacobian)
        energy = np.abs(vectors[: len(self._reference.diameters), np.argmax(np.abs(values))]) ** 2
        return int(np.argmax(np.bincount(self._reference.diameters, energy)))

    def start(self, cycle: FloquetResult) -> Place:
        """A cycle as a point of the curve; raises `ParameterError` if it cannot be followed."""
        start = (
            "guess: must lie near a cycle" if self.order else "p: must have a cycle of one release"
        )
        try:
            if cycle.state is None or (cycle.releases > 1 and not self.order):
                raise ParameterError(cycle.message)
            q = np.array([self.base.numbers[name] for name in self.names]) / self.scales
            return self.evaluate(
                np.concatenate([self._reference.point(cycle.state) / self.size, q])
            )
        except ParameterError as lost:
            raise ParameterError(
                f"{start} that can be followed, but the search ended with {lost}"
            ) from None

    def branch(self, points: Sequence[Place], folds: Array, ended: str) -> Branch:
        values = [multipliers(point.jacobian) for point in points]
        period = np.array([point.flight.period for point in points])
        return Branch(
            parameters=self.names,
            values=np.array([point.z[self.n :] * self.scales for point in points]),
            period=period,
            stick_fraction=np.array([point.flight.stick_time for point in points]) / period,
            growth_rate=np.array([math.log(abs(v[0])) for v in values]) / period,
            multipliers=np.array(values),
            diameters=np.array([self.leading_diameters(point.jacobian) for point in points]),
            points=np.array([point.z[: self.n] * self.size for point in points]),
            folds=folds,
            ended=ended,
            case=self.base,
        )

    def follow(
        self, point: Place, span: tuple[float, float], steps: StepControl, tangent: Array
    ) -> tuple[list[Place], list[float], str]:
        """The cycles along a tangent until the parameter leaves the span, the folds between them,
        and why they end."""
        (name,), scale = self.names, self.scales[0]
        low, high = (bound / scale for bound in span)
        left, folds = f"{name} has left {span[0]:g} .. {span[1]:g}", list[float]()

        def leave(points: list[Place], new: Place, _: float) -> str:
            if new.tangent[-1] * points[-1].tangent[-1] < 0:
                fold = self._locate_fold(points[-1], new)
                if not (steps.beyond or low <= fold <= high):
                    return left
                folds.append(fold * scale)
            return "" if low <= new.z[-1] <= high else left

        points, ended = follow_curve(replace(point, tangent=tangent), self.next_place, steps, leave)
        if (
            ended == left and not steps.beyond
        ):  # the last cycle is that at the bound, if it is found
            beyond = points.pop().z
            z, tangent = points[-1].z, points[-1].tangent
            along = tangent if low <= beyond[-1] <= high else beyond - z  # the former after a fold
            bound = high if along[-1] > 0 else low
            if z[-1] != bound:
                guess = z + (bound - z[-1]) / along[-1] * along
                with suppress(ParameterError):
                    points.append(self.correct(guess, np.eye(len(guess))[-1:], np.array([bound])))
        return points, folds, ended

    def next_place(self, current: Place, ds: float) -> Place:
        """The place at arclength ds along the tangent."""
        tangent, z = current.tangent, current.z
        new = self.correct(z + ds * tangent, tangent[None, :], np.array([tangent @ z + ds]))
        return replace(new, tangent=new.basis[0])

    def _locate_fold(self, before: Place, after: Place) -> float:
        """Scaled parameter at the fold between two points, where the tangent has no component along
        the parameter."""
        start, tangent = before.z, before.tangent
        length = float(tangent @ (after.z - start))
        chord = (after.z - start) / length

        def point_at(s: float) -> Place:
            return self.correct(
                start + s * chord, tangent[None, :], np.array([tangent @ start + s])
            )

        def turned(s: float) -> float:
            tangent_there = point_at(s).basis[0]
            return float(tangent_there[-1] / (tangent_there @ tangent))

        from scipy.optimize import brentq

        try:
            return float(point_at(brentq(turned, 0.0, length, xtol=1e-12, rtol=1e-12)).z[-1])
        except ParameterError as lost:
            where = f"{self.names[0]}={start[-1] * self.scales[0]:.6g}"
            raise ParameterError(f"{UNLOCATED} near {where}: {lost}") from None


def free_faults(p: Parameters, names: Sequence[Any]) -> list[str]:
    known = p.numbers
    wrong = [name for name in names if not isinstance(name, str) or name not in known]
    return [
        Fault.of(("name",), name, f"must be a number of the case{suggestion(name, known)}")
        for name in wrong
    ]


@dataclass(frozen=True, eq=False, repr=False)
class Branch:
    """Cycles along a curve.

    Attributes
    ----------
    parameters : names of the free parameters
    values : shape (n_points, n_parameters), in SI units
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes with most energy in the leading multiplier's eigenvector
    points : (n_points, n), on the section, in the coordinates of `ReturnMap` for the case followed
    folds : (n_folds, n_parameters), values at which the first parameter turns, located to rounding; only on a branch
        in one parameter
    ended : reason for which the branch ends
    case : whose cycle is followed; its own values of the free parameters do not count
    """

    parameters: tuple[str, ...]
    values: Array = field(repr=False)
    period: Array = field(repr=False)
    stick_fraction: Array = field(repr=False)
    growth_rate: Array = field(repr=False)
    multipliers: NDArray[np.complex128] = field(repr=False)
    diameters: NDArray[np.int64] = field(repr=False)
    points: Array = field(repr=False)
    folds: Array
    ended: str
    case: Parameters = field(repr=False)

    def __len__(self) -> int:
        return len(self.period)

    def __repr__(self) -> str:
        spans = zip(self.parameters, self.values.min(axis=0), self.values.max(axis=0), strict=True)
        spanned = ", ".join(f"{name} from {low:.6g} to {high:.6g}" for name, low, high in spans)
        folds = counted(len(self.folds), "fold")
        return f"Branch({len(self)} cycles, {spanned}, {folds}; ended: {self.ended})"

    def plot(self, y: str = "growth_rate", *, ax: Axes | None = None) -> Axes:
        """Draw growth_rate, period or stick_fraction over the parameter, thick where the cycle is
        stable.

        A branch in two parameters is drawn as the second over the first. Returns the axes; raises
        `ParameterError` if `y` is another name, or `ax` no axes.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2)).plot("period").get_ylabel()
        'Period (ms)'
        """
        return draw("plot_branch", self, y, ax=ax)


def interval_in_si(name: Any, bounds: Any) -> Any:
    """Bounds of a parameter in SI units, from texts with units too; None unless they are two
    ascending numbers."""
    ends = in_si(bounds, Parameters.unit(name) if isinstance(name, str) else "", [], ())
    return ends if is_finite_array(ends, 2) and ends[0] < ends[1] else None


class StepControl(Strict):
    """Step lengths and limits of a continuation.

    Parameters
    ----------
    step, longest, shortest : arclength of the first, the longest and the shortest step
    max_points : largest number of points
    scale : value of the parameter that counts as one in the arclength; by default its own. For one parameter only
    growth, easy, sharpest : factor by which a step grows if the cosine of the angle between successive tangents exceeds
        `easy`; below `sharpest` the step is shortened
    beyond : whether a branch in one parameter ends at the first point beyond a bound, instead of at the bound
    """

    step: Positive = 0.02
    longest: Positive = 0.1
    shortest: Positive = 1e-7
    max_points: Annotated[Count, Field(ge=1)] = 1000
    scale: Positive | None = None
    growth: Finite = 1.5
    easy: Finite = 0.99
    sharpest: Finite = 0.9
    beyond: bool = False


def follow_curve(
    start: Place,
    take: Callable[[Place, float], Place],
    steps: StepControl,
    leave: Callable[[list[Place], Place, float], str],
) -> tuple[list[Place], str]:
    """Places along a curve, and why they end. `take` finds the next one at an arclength, with
    either sign of the tangent; from the places before it and the length of the step to it, `leave`
    tells why it is the last, or ""."""
    points, ds = [start], steps.step
    try:
        while len(points) < steps.max_points:
            try:
                new = take(points[-1], ds)
                cosine = float(new.tangent @ points[-1].tangent)
                if abs(cosine) < steps.sharpest:
                    raise ParameterError("the curve bends too sharply")
            except ParameterError:
                ds /= 2
                if ds < steps.shortest:
                    raise
                continue
            new = new if cosine > 0 else replace(new, tangent=-new.tangent)
            ended = leave(points, new, ds)
            points.append(new)
            if ended:
                return points, ended
            if abs(cosine) > steps.easy:
                ds = min(steps.longest, steps.growth * ds)
    except ParameterError as lost:
        return points, str(lost)
    return points, "the number of points allowed is reached"


# ---- One parameter

CYCLE = StepControl()
BORDER = StepControl(
    step=0.01, longest=0.05, shortest=1e-6, max_points=400, growth=1.4, easy=0.98, sharpest=0.8
)
"""Steps along borders, where each point costs several cycles."""
UNLOCATED = (
    "a fold that cannot be located"  # beginning of one of the reasons for which a branch ends
)


@compiling()
def continue_cycle(
    p: Parameters,
    name: str,
    bounds: tuple[Quantity, Quantity],
    *,
    direction: int = 0,
    guess: State | None = None,
    releases: int = 1,
    tol: float = 1e-12,
    steps: StepControl = CYCLE,
) -> Branch:
    """Follow a cycle in one parameter by pseudo-arclength, through folds, until it leaves `bounds`.

    The branch goes both ways from the case. From a state `guess` the cycle may lose contact; with
    its impacts it is followed as long as its events keep their order. Where an event would appear
    or vanish, the return map has a corner: the branch ends and says how the numbers of events
    change.

    Parameters
    ----------
    p : case whose cycle is followed; its value of the parameter must lie within the bounds
    name : the free parameter, one of `Parameters.numbers`
    bounds : values of the parameter between which the cycle is followed; SI units, or texts with units
    direction : 0 for both ways; 1 to begin with increasing values alone, -1 with decreasing ones
    guess, releases, tol : as in `floquet`
    steps : length and number of the steps

    Returns
    -------
    Branch
        The cycles in their order along the curve, its folds, and in `ended` why it ends; if for two reasons, that of
        its first point, then that of its last.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or no cycle is found to start from.

    Examples
    --------
    The fold of the cycle at 385 N:

    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    >>> branch
    Branch(17 cycles, Omega from 14.8 to 15.0949, 1 fold; ended: Omega has left 14.8 .. 15.2)
    """
    wrong = violations(
        (
            (span := interval_in_si(name, bounds)) is not None,
            "bounds",
            bounds,
            "must be two ascending finite numbers",
        ),
        (isinstance(steps, StepControl), "steps", steps, "must be StepControl"),
        (
            is_number(direction) and direction in (-1, 0, 1),
            "direction",
            direction,
            "must be -1, 0 or 1",
        ),
    )
    wrong += limits_faults("tol", tol, CYCLE_TOLERANCES) + guess_faults(guess, releases)
    raise_faults(foreign_case(p) or wrong + free_faults(p, [name]))
    tol = float(tol)
    start, slack = p.numbers[name], 1e-9 * (span[1] - span[0])  # ratios are rounded
    within = span[0] - slack <= start <= span[1] + slack
    require(
        (
            within,
            name,
            start,
            f"must lie within the bounds, {span[0]:g} to {span[1]:g}, to start from there",
        )
    )
    cycle = find_cycle(p, tol, guess, releases)
    order = None if guess is None else Counts(*(getattr(cycle, name) for name in Counts._fields))
    problem = CycleProblem(p, (name,), steps.scale, tol, order)
    point = problem.start(cycle)
    tangent = point.basis[0] * (1.0 if point.basis[0, -1] >= 0 else -1.0)
    follow = partial(problem.follow, point, span, steps)
    if direction:
        points, folds, ended = follow(direction * tangent)
    else:
        (down, below, first), (up, above, last) = follow(-tangent), follow(tangent)
        points, folds, ended = (
            down[::-1] + up[1:],
            below[::-1] + above,
            first if first == last else f"{first}; {last}",
        )
    return problem.branch(points, np.array(folds).reshape(-1, 1), ended)


# ---- Two parameters

Kind = Literal["neutral", "fold"]
CLOSED = "the curve is closed"
_DIFFERENCE = (
    1e-4  # arclength of the finite difference for a multiplier's gradient along the surface
)
# on the way to a curve: longest step, largest change of the multiplier in a step, and number of
# steps
LONGEST_REACH, LARGEST_TURN, REACHES = 0.1, 0.1, 60


class BorderProblem(CycleProblem):
    """With a test function that vanishes on the border: the logarithm of a multiplier's modulus on
    a neutral curve, a real multiplier less one on a fold."""

    def __init__(self, kind: Kind, p: Parameters, names: tuple[str, ...], tol: float) -> None:
        super().__init__(p, names, None, tol)
        self.kind = kind

    def _evaluate_test(self, jacobian: Array, former: complex) -> tuple[float, complex]:
        """Value of the test function, and the multiplier nearest to `former`, which gives it."""
        values = np.linalg.eigvals(jacobian).astype(complex)
        if self.kind == "fold":
            values = values[values.imag == 0]
            if len(values) == 0:
                raise ParameterError("no multiplier is real any more")
        mu = complex(values[np.argmin(np.abs(values - former))])
        return (mu.real - 1.0 if self.kind == "fold" else math.log(abs(mu))), mu

    def _place(self, point: Place, mu: complex) -> Place:
        """A cycle on the surface, with the tangent of the curve on which the test function keeps
        its value."""
        basis = point.basis
        slopes, turns = np.zeros(2), np.zeros(2, complex)
        for i, unit in enumerate(basis):
            ends = [
                self._evaluate_test(self.evaluate(point.z + s * _DIFFERENCE * unit).jacobian, mu)
                for s in (-1, 1)
            ]
            slopes[i] = (ends[1][0] - ends[0][0]) / (2 * _DIFFERENCE)
            turns[i] = (ends[1][1] - ends[0][1]) / (2 * _DIFFERENCE)
        size = float(np.linalg.norm(slopes))
        if not size > 0:
            raise ParameterError("the multiplier does not depend on the parameters")
        along = np.array([-slopes[1], slopes[0]]) / size
        turning = np.asarray(turns @ basis, dtype=complex)
        return replace(
            point, tangent=along @ basis, mu=mu, gradient=slopes @ basis, turning=turning
        )

    def reach(self, point: Place, mu: complex) -> Place:
        """Move from a cycle near the curve onto the curve, by the shortest way on the surface."""
        value, mu = self._evaluate_test(point.jacobian, mu)
        for _ in range(REACHES):
            new = self._place(point, mu)
            if abs(value) < 1e-10:
                return new
            move = -value * new.gradient / (new.gradient @ new.gradient)
            turn = abs(complex(new.turning @ move))
            move *= min(
                1.0, LONGEST_REACH / float(np.linalg.norm(move)), LARGEST_TURN / max(turn, 1e-300)
            )
            rows = np.vstack([new.tangent, new.gradient / np.linalg.norm(new.gradient)])
            for halvings in range(6):
                step = move * 0.5**halvings
                guess, expected = new.z + step, new.mu + complex(new.turning @ step)
                try:
                    point = self.correct(guess, rows, rows @ guess)
                    value, mu = self._evaluate_test(point.jacobian, expected)
                    break
                except ParameterError:
                    if halvings == 5:
                        raise
        raise ParameterError("no point of the curve was found near the first cycle")

    def next_place(self, start: Place, ds: float) -> Place:
        """The curve's place at arclength ds: F = 0, test = 0, and the plane normal to the
        tangent."""
        expected = start.mu + complex(start.turning @ (ds * start.tangent))
        if abs(expected - start.mu) > 2 * LARGEST_TURN:
            raise ParameterError("the multiplier turns too fast")
        guess, rows = start.z + ds * start.tangent, start.tangent[None, :]
        point, gradient, errors = self.evaluate(guess), start.gradient, [math.inf, math.inf]
        value, mu = self._evaluate_test(point.jacobian, expected)
        for _ in range(12):
            right = np.concatenate([point.residual, [value], rows @ point.z - rows @ guess])
            errors.append(float(np.linalg.norm(right)))
            if errors[-1] < 1e-10:
                return self._place(point, mu)
            if errors[-1] > 0.9 * errors[-3]:
                break
            before, last = point, value
            point = self.evaluate(
                before.z - newton_step(np.vstack([before.by, gradient, rows]), right)
            )
            value, mu = self._evaluate_test(point.jacobian, mu)
            # Broyden's update: a gradient by differences would take four flights at each correction
            move = point.z - before.z
            gradient = gradient + (value - last - gradient @ move) / (move @ move) * move
        raise ParameterError("Newton's method does not converge")


def continue_border(
    kind: Kind,
    p: Parameters,
    names: tuple[str, str],
    bounds: Mapping[str, tuple[float, float]],
    *,
    guess: Array | None = None,
    tol: float = 1e-12,
    steps: StepControl = BORDER,
) -> Branch:
    """Follow a border of stability in two parameters from the cycle of a case near the point
    `guess` of the section, both ways until it leaves the bounds, closes or ends; raises
    `ParameterError` if no cycle, or no curve, is near, or no step along it succeeds.

    A "neutral" border is one of the first cycle's leading multiplier; a "fold" starts from a
    branch's point next to it.
    """
    problem = BorderProblem(kind, p, names, tol)
    point = problem.start(find_cycle(p, tol, guess))
    mu = complex(multipliers(point.jacobian)[0]) if kind == "neutral" else 1.0 + 0j
    first = problem.reach(point, mu)
    lead = (
        first.tangent[problem.n]
        if abs(first.tangent[problem.n]) > 1e-12
        else first.tangent[problem.n + 1]
    )
    onward = first.tangent * math.copysign(1.0, lead)
    low, high = np.array([bounds[name] for name in names]).T / problem.scales

    def leave(points: list[Place], new: Place, ds: float) -> str:
        q = new.z[problem.n :]
        if np.any(q < low) or np.any(q > high):
            return f"{' or '.join(names)} has left the bounds"
        return CLOSED if len(points) >= 8 and np.linalg.norm(new.z - first.z) < 0.6 * ds else ""

    ways = (
        follow_curve(replace(first, tangent=way), problem.next_place, steps, leave)
        for way in (-onward, onward)
    )
    points, ended = next(ways)
    if ended != CLOSED:
        ahead, ended = next(ways)
        points = [*points[:0:-1], *ahead]
    if len(points) == 1:
        raise ParameterError("no step along the curve succeeds")
    return problem.branch(points, np.zeros((0, 2)), ended)
