"""Curves in the plane of two parameters on which the cycle loses stability or ceases to exist; see
docs/method.md."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from disc_model.analysis.spectra import Resonance, nearest_resonance
from disc_model.arrays import Array, ComplexArray, Mask
from disc_model.display import counted, drawings
from disc_model.engine.jit.cache import compiling
from disc_model.errors import (
    Fault,
    ParameterError,
    raise_faults,
    require,
    violations,
    with_known_names,
)
from disc_model.parameters import Parameters, Quantity, foreign_case
from disc_model.simulation.states import is_finite_array
from disc_model.stability.continuation import (
    BORDER,
    UNLOCATED,
    Branch,
    Kind,
    StepControl,
    continue_border,
    continue_cycle,
    free_faults,
    interval_in_si,
)
from disc_model.stability.cycle import find_cycle
from disc_model.units import CYCLE_TOLERANCES, is_whole, limits_faults

MOST_ON_LINE = 500  # points of a branch between two points of a line
BORDER_KINDS: Mapping[str, Kind] = {
    "fold": "fold",
    "neimark_sacker": "neutral",
    "period_doubling": "neutral",
}
"""Special points of a branch, and the borders on which they lie."""
MOST_POINTS = 100_000  # largest number of points along a line: an hour of work
SAME_PLACE = 0.01  # distance of a point from a curve through it, over the span of the plane
# relative difference of periods on one curve; those of the two borders of one resonance differ by
# 1 % and more
SAME_PERIOD = 0.004


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


class _Seed(NamedTuple):
    """A special point of a branch from which a curve is followed: its kind, its case, its point of
    the section, its critical multiplier, and its period, s."""

    kind: Kind
    case: Parameters
    point: Array
    mu: complex
    period: float


@compiling()
@with_known_names
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
    # a curve ends where a shorter step would be needed, as where an event grazes
    steps = BORDER.replace(longest=longest, shortest=1e-5, max_points=max_points)
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


class _CurveSearch:
    """The search for curves in a plane of two parameters.

    plane : bounds of both parameters by name, SI units; the first one is scanned
    steps : steps along a curve
    span : (2,), lengths of both intervals, over which distances in the plane are taken
    curves, failures : what was found so far, and descriptions of what could not be followed
    """

    def __init__(
        self,
        p: Parameters,
        plane: Mapping[str, tuple[float, float]],
        tol: float,
        steps: StepControl,
    ) -> None:
        x, y = plane
        self.p = p
        self.plane = plane
        self.names = (x, y)
        self.tol = tol
        self.steps = steps
        self.span = np.array([high - low for low, high in plane.values()])
        self.curves: list[StabilityCurve] = []
        self.failures: list[str] = []

    def scan(self, line: float, points: int) -> None:
        """Follow all curves that pass between the points of a line, on which the second parameter
        has one value."""
        x, y = self.names
        low, high = self.plane[x]
        along = np.linspace(low, high, points).tolist()
        cases = [self.p.replace(**{y: line, x: value}) for value in along]
        for seed in self._seeds(cases):
            self._follow(seed)

    def _seeds(self, cases: Sequence[Parameters]) -> Iterator[_Seed]:
        """Special points along a line where the cycle changes stability or ends, found by
        continuation from both neighbours."""
        growth = [find_cycle(case, self.tol).growth_rate for case in cases]
        exists = [not np.isnan(rate) for rate in growth]
        for i, (before, after) in enumerate(pairwise(growth)):
            if before * after > 0 or not (exists[i] or exists[i + 1]):
                continue
            for begin, end in ((i, i + 1), (i + 1, i)):
                if not exists[begin]:
                    continue
                seed = self._seed_towards(cases, growth, begin, end)
                if seed is not None:
                    yield seed

    def _seed_towards(
        self, cases: Sequence[Parameters], growth: Sequence[float], begin: int, end: int
    ) -> _Seed | None:
        """The special point from a case of a line towards its neighbour, or beyond it as long as the
        stable cycle goes on where the search from the static start finds none that is stable."""
        name = self.names[0]
        step = end - begin
        told = len(self.failures)
        for each in cases[end::step]:
            seed = _border(cases[begin], name, each.numbers[name], self.tol, self.failures)
            lost = seed is not None or len(self.failures) > told
            if lost or not growth[begin] < 0 or growth[end] < 0:
                return seed
            end += step
        return None

    def _follow(self, seed: _Seed) -> None:
        """Follow the curve through a special point, unless it is known."""
        point = np.array([seed.case.numbers[name] for name in self.names])
        if self._is_known(seed.kind, point, seed.period):
            return
        try:
            branch = continue_border(
                seed.kind,
                seed.case,
                self.names,
                self.plane,
                guess=seed.point,
                mu=seed.mu,
                tol=self.tol,
                steps=self.steps,
            )
        except ParameterError as error:
            x, y = self.names
            where = f"{x}={point[0]:.6g}, {y}={point[1]:.6g}"
            self.failures.append(f"{seed.kind} near {where}: {error}")
            return

        # it may turn out to be known at the point halfway along it, since points are dense where
        # two borders meet
        steps = np.linalg.norm(np.diff(branch.values / self.span, axis=0), axis=1)
        length = np.cumsum(steps)
        i = int(np.searchsorted(length, length[-1] / 2)) + 1
        if not self._is_known(seed.kind, branch.values[i], float(branch.period[i])):
            self.curves.append(_curve(seed, branch))

    def _is_known(self, kind: str, point: Array, period: float) -> bool:
        """Whether a known curve of this kind, with cycles of this period (s), passes through a
        point of the plane."""
        for curve in self.curves:
            if curve.kind != kind:
                continue
            distance, period_there = _nearest_on(curve, point, self.span)
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


def _border(
    case: Parameters, name: str, end: float, tol: float, failures: list[str]
) -> _Seed | None:
    """The special point of a branch from a case to another value of a parameter at which a stable
    cycle first gains or loses stability, or ends; without a stable one, the first special point.
    What cannot be followed, or ends elsewhere, is described in `failures`."""
    begin = case.numbers[name]
    bounds = (min(begin, end), max(begin, end))
    direction = 1 if begin < end else -1
    try:
        steps = StepControl(max_points=MOST_ON_LINE)
        branch = continue_cycle(case, name, bounds, direction=direction, tol=tol, steps=steps)
    except ParameterError as error:
        failures.append(f"{name}={begin:.6g}: {error}")
        return None
    if branch.ended.startswith(UNLOCATED):
        failures.append(branch.ended)
    borders = [special for special in branch.special if special.kind in BORDER_KINDS]
    if not borders:
        reaches = (
            branch.values[-1, 0] == end
        )  # the cycle, which is only far from the static start there
        if not reaches:
            failures.append(f"{name} from {begin:.6g} to {end:.6g}: {branch.ended}")
        return None
    stable = branch.stable
    next_to_stable = [each for each in borders if stable[each.after : each.after + 2].any()]
    special = next_to_stable[0] if next_to_stable else borders[0]
    kind = BORDER_KINDS[special.kind]
    return _Seed(kind, special.case, special.point, special.multiplier, special.period)


def _curve(seed: _Seed, branch: Branch) -> StabilityCurve:
    """The curve of a border that was followed from a special point."""
    adjoins_stable = branch.growth_rate < 1e-3  # 1/s; no other multiplier grows
    middle = len(branch) // 2
    if adjoins_stable.any():
        places = np.flatnonzero(adjoins_stable)
        middle = int(places[len(places) // 2])
    values = dict(zip(branch.parameters, branch.values[middle].tolist(), strict=True))
    case = seed.case.replace(**values)
    leading = branch.multipliers[:, 0]
    mu = 1.0 + 0j
    if seed.kind != "fold":
        mu = complex(leading[middle])
    period = float(branch.period[middle])
    return StabilityCurve(
        kind=seed.kind,
        values=branch.values,
        adjoins_stable_cycle=adjoins_stable,
        period=branch.period,
        multipliers=leading,
        resonance=nearest_resonance(case, period, mu, int(branch.diameters[middle])),
    )
