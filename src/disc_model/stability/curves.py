"""Curves in the plane of two parameters on which the cycle loses stability or ceases to exist; see
docs/method.md."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.analysis.spectra import Resonance, nearest_resonance
from disc_model.data.variables import STABLE_CYCLES
from disc_model.display import Drawn, counted, html_table
from disc_model.engine.jit.cache import compiling
from disc_model.errors import ParameterError, raise_faults, violations
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
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.stability.return_map import Array, ComplexArray, case_faults
from disc_model.units import CYCLE_TOLERANCES, is_number, is_whole, limits_faults

MOST_ON_LINE = 500  # points of a branch between two points of a line
BORDER_KINDS: Mapping[str, Kind] = {
    "fold": "fold",
    "neimark_sacker": "neutral",
    "period_doubling": "neutral",
}
"""Special points of a branch, and the borders on which they lie."""
MOST_POINTS = 100_000  # largest number of points along a line: an hour of work


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
    adjoins_stable_cycle: NDArray[np.bool_] = field(repr=False)
    period: Array = field(repr=False)
    multipliers: NDArray[np.complex128] = field(repr=False)
    resonance: Resonance


@dataclass(frozen=True, repr=False)
class NeutralCurves(Drawn):
    """Curves in the plane of two parameters; iterating yields them, `plot` draws them, thick beside
    a stable cycle.

    Attributes
    ----------
    parameters, bounds : the case, and the bounds of both parameters by name, as given to `neutral_curves`
    curves : those that could be followed
    failures : descriptions of those that could not
    """

    _picture = "plot_neutral_curves"
    parameters: Parameters
    bounds: Mapping[str, tuple[float, float]]
    curves: tuple[StabilityCurve, ...] = field(repr=False)
    failures: tuple[str, ...] = field(repr=False)

    def __iter__(self) -> Iterator[StabilityCurve]:
        return iter(self.curves)

    def __len__(self) -> int:
        return len(self.curves)

    def __repr__(self) -> str:
        plane = " and ".join(
            f"{name} from {low:g} to {high:g}" for name, (low, high) in self.bounds.items()
        )
        return f"NeutralCurves({counted(len(self), 'curve')} over {plane}, {len(self.failures)} not followed)"


class _Seed(NamedTuple):
    """A special point of a branch from which a curve is followed: its kind, its case, its point of
    the section, its critical multiplier, and its period, s."""

    kind: Kind
    case: Parameters
    point: Array
    mu: complex
    period: float


@compiling()
def neutral_curves(
    p: Parameters,
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
    p : the case; its values of the two parameters are ignored
    bounds : bounds of both, by their names: two of `Parameters.numbers`; SI units, or texts with units
    lines : values of the second parameter; along each of these lines the first parameter is scanned for curves
    points : cycles computed along each line; a curve lies between two that differ in stability or existence
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
    >>> case = dm.Parameters(N=385, Omega=15, mu_k_over_mu_s=0.6)
    >>> curves = dm.neutral_curves(case, {"Omega": (14, 15.5), "mu_s": (0.38, 0.42)}, [0.4], points=5)
    >>> len(curves), curves.curves[0].resonance.label
    (1, '2 f_s = 135.42 Hz')
    """
    raise_faults(foreign_case(p))
    # a curve ends where a shorter step would be needed, as where an event grazes
    steps = BORDER.replace(longest=longest, shortest=1e-5, max_points=max_points)
    free = isinstance(bounds, Mapping) and len(bounds) == 2
    plane: Any = {name: interval_in_si(name, ends) for name, ends in bounds.items()} if free else {}
    within = free and all(ends is not None for ends in plane.values())
    counts = is_whole(points) and 2 <= points <= MOST_POINTS
    wrong = limits_faults("tol", tol, CYCLE_TOLERANCES) + violations(
        (
            within,
            "bounds",
            bounds,
            "must be two ascending finite numbers, by the names of two parameters",
        ),
        (is_finite_array(lines), "lines", lines, "must be finite numbers"),
        (counts, "points", points, f"must be a whole number from 2 to {MOST_POINTS}"),
    )
    raise_faults(wrong + (free_faults(p, [*bounds]) if free else []))
    tol = float(tol)
    names = x, y = tuple(plane)
    curves = list[StabilityCurve]()
    notes = list[str]()
    span = np.array([high - low for low, high in plane.values()])
    for line in map(float, lines):
        along = np.linspace(plane[x][0], plane[x][1], points).tolist()
        for seed in _seeds([p.replace(**{y: line, x: value}) for value in along], x, tol, notes):
            point = np.array([seed.case.numbers[name] for name in names])
            if _known(curves, seed.kind, point, seed.period, span):
                continue
            where = ", ".join(
                f"{name}={value:.6g}" for name, value in zip(names, point, strict=True)
            )
            try:
                branch = continue_border(
                    seed.kind,
                    seed.case,
                    names,
                    plane,
                    guess=seed.point,
                    mu=seed.mu,
                    tol=tol,
                    steps=steps,
                )
            except ParameterError as error:
                notes.append(f"{seed.kind} near {where}: {error}")
                continue
            # the place halfway along the curve, since places are dense where two borders meet
            length = np.cumsum(np.linalg.norm(np.diff(branch.values / span, axis=0), axis=1))
            i = int(np.searchsorted(length, length[-1] / 2)) + 1
            if not _known(curves, seed.kind, branch.values[i], float(branch.period[i]), span):
                curves.append(_curve(seed, branch))
    return NeutralCurves(p, plane, tuple(curves), tuple(notes))


def _seeds(cases: Sequence[Parameters], name: str, tol: float, notes: list[str]) -> Iterator[_Seed]:
    """Places along a line where the cycle changes stability or ends, found by continuation from
    both neighbours."""
    growth = np.array([find_cycle(case, tol).growth_rate for case in cases])
    for i, (before, two) in enumerate(pairwise(growth)):
        if (np.isnan(before) and np.isnan(two)) or before * two > 0:
            continue
        for begin, end in ((i, i + 1), (i + 1, i)):
            if np.isnan(growth[begin]):
                continue
            seed = _border(cases[begin], name, cases[end].numbers[name], tol, notes)
            if seed is not None:
                yield seed


def _border(case: Parameters, name: str, end: float, tol: float, notes: list[str]) -> _Seed | None:
    """The special point of a branch from a case to another value of a parameter at which a stable
    cycle first gains or loses stability, or ends; without a stable one, the first special point."""
    begin = case.numbers[name]
    bounds = (min(begin, end), max(begin, end))
    direction = 1 if begin < end else -1
    try:
        steps = StepControl(scale=abs(end - begin), max_points=MOST_ON_LINE)
        branch = continue_cycle(case, name, bounds, direction=direction, tol=tol, steps=steps)
    except ParameterError as error:
        notes.append(f"{name}={begin:.6g}: {error}")
        return None
    if branch.ended.startswith(UNLOCATED):
        notes.append(branch.ended)
    borders = [special for special in branch.special if special.kind in BORDER_KINDS]
    stable = branch.growth_rate < 0
    beside = [each for each in borders if stable[each.after : each.after + 2].any()]
    for special in [*beside, *borders][:1]:
        kind = BORDER_KINDS[special.kind]
        return _Seed(kind, special.case, special.point, special.multiplier, special.period)
    return None


def _known(
    curves: Sequence[StabilityCurve], kind: str, point: Array, period: float, span: Array
) -> bool:
    """Whether a known curve of this kind, with cycles of this period, passes through a place of the
    plane."""
    for curve in (curve for curve in curves if curve.kind == kind):
        corners = (curve.values - point) / span
        steps = np.diff(corners, axis=0)
        size = np.sum(steps**2, axis=1)
        share = np.clip(
            -np.sum(corners[:-1] * steps, axis=1) / np.where(size > 0, size, 1.0), 0.0, 1.0
        )
        distance = np.linalg.norm(corners[:-1] + share[:, None] * steps, axis=1)
        i = int(np.argmin(distance))
        period_there = curve.period[i] + share[i] * (curve.period[i + 1] - curve.period[i])
        # periods of the two borders of one resonance differ by 1 % and more
        if distance[i] < 0.01 and abs(period_there / period - 1) < 0.004:
            return True
    return False


def _curve(seed: _Seed, branch: Branch) -> StabilityCurve:
    border = branch.growth_rate < 1e-3  # 1/s; no other multiplier grows
    middle = int(np.flatnonzero(border)[border.sum() // 2]) if border.any() else len(branch) // 2
    case = seed.case.replace(
        **dict(zip(branch.parameters, map(float, branch.values[middle]), strict=True))
    )
    leading = branch.multipliers[:, 0]
    mu = 1.0 + 0j if seed.kind == "fold" else complex(leading[middle])
    resonance = nearest_resonance(
        case, float(branch.period[middle]), mu, int(branch.diameters[middle])
    )
    return StabilityCurve(seed.kind, branch.values, border, branch.period, leading, resonance)


# ---- One parameter

ROUNDS = (
    8  # times that places of suspected instability are predicted anew, from the cycles beside them
)
NARROWEST = 1e-5  # of the range: between values closer than that no further ones are computed
# modulus below which a multiplier takes part in no resonance that could make it one
STRONGLY_DAMPED = 0.5
# rad, by which a multiplier may turn from one value to the next; beyond, multipliers cannot be told
# apart by their distances
LONGEST_TURN = 0.3
# the angles of a pair at two values, from the real axis, over the longest turn of any multiplier:
# up to this, the pair may have met the axis in between, and have left it again on the same side
MAY_HAVE_MET = 1.5
# exponents of distances by which multipliers are matched. One that passes another moves as far, in
# sum, as two that follow each other: the first exponent does not tell them apart, the second one
# takes them to have passed
MATCHES = (1.0, 0.5)


@dataclass(frozen=True, eq=False, repr=False)
class Critical(Drawn):
    """Values of a parameter at which the motion near the static start gains or loses stability.

    `plot` draws the growth rate of the cycle over the parameter, with the intervals in which that
    motion is unstable.

    Attributes
    ----------
    parameters, name : the case, and the parameter
    value : the least value computed at which the motion near the static start is unstable; nan if
        there is none
    crossings : shape (n,), all values at which stability was seen to change, ascending
    unstable_above : bool, (n,), whether that motion is unstable just above each
    values, growth_rate : shape (m,), the values computed, ascending, and growth rates of the cycle (1/s; nan without)
    resolution : the largest step between neighbouring values computed. No stretch of stability or
        of instability that is wider has been overlooked. Most narrower ones are seen, because they
        are looked for where multipliers meet
    """

    _picture = "plot_critical"
    parameters: Parameters
    name: str
    value: float
    crossings: Array
    unstable_above: NDArray[np.bool_]
    values: Array
    growth_rate: Array
    resolution: float

    def __repr__(self) -> str:
        first = f"unstable from {self.value:.6g}" if math.isfinite(self.value) else "stable"
        crossings = counted(len(self.crossings), "crossing")
        seen = f"{len(self.values)} values, steps of at most {self.resolution:.2g}"
        return f"Critical({self.name}: {first}, {crossings}, {seen})"

    def _repr_html_(self) -> str:
        """The intervals of one stability in a notebook, and what may have been overlooked."""
        unit = self.parameters.unit(self.name).removeprefix("1")
        edges = [float(self.values[0]), *self.crossings.tolist(), float(self.values[-1])]
        unstable = {float(low) for low, _ in self.unstable}
        rows = [
            (f"{low:.9g}", f"{high:.9g}", "unstable" if low in unstable else "stable")
            for low, high in pairwise(edges)
        ]
        rows.append(("tongues overlooked", f"below {self.resolution:.2g} {unit}".strip(), ""))
        head = (
            f"{self.name} from",
            f"to ({unit})" if unit else "to",
            "motion near the static start",
        )
        return html_table(head, rows)

    @property
    def unstable(self) -> Array:
        """The intervals in which that motion is unstable, shape (n_intervals, 2). Another one may
        be stable there."""
        edges = np.array([self.values[0], *self.crossings, self.values[-1]])
        grows = [
            not self.unstable_above[0] if len(self.crossings) else math.isfinite(self.value),
            *self.unstable_above,
        ]
        return np.column_stack([edges[:-1], edges[1:]])[np.array(grows)]


@compiling()
def critical(
    p: Parameters,
    name: str,
    bounds: tuple[Quantity, Quantity],
    *,
    points: int = 201,
    precision: float | None = None,
    tol: float = 1e-12,
) -> Critical:
    """The least parameter value with unstable motion near the static start, and all stability
    changes above it.

    That motion is the stick-slip cycle, or steady sliding or rest if there is no cycle. It is
    computed at equal steps, which alone limit what can be overlooked. Instability often lies in
    much narrower tongues, where multipliers meet on the unit circle. Their angles change smoothly,
    so that these places are predicted from neighbouring values, and computed as well.

    Parameters
    ----------
    p : the case; its value of the parameter is not used
    name : one of `Parameters.numbers`, such as "mu_s"
    bounds : lowest and highest value; SI units, or texts with units
    points : number of evenly spaced values, which determines the `resolution`. With nine modes,
        the scan takes one or two seconds by default
    precision : to which crossings are bisected; a millionth of the range if not given
    tol : as in `floquet`

    Returns
    -------
    Critical
        `value`, `crossings`, and `resolution`, beyond which nothing can have been overlooked.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does at a value within the bounds.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=12, mu_k_over_mu_s=0.6)
    >>> dm.critical(case, "mu_s", (0.3, 0.42), points=7)
    Critical(mu_s: unstable from 0.3, 1 crossing, ... values, steps of at most ...)
    """
    counts = is_whole(points) and 2 <= points <= MOST_POINTS
    good = precision is None or (is_number(precision) and precision > 0)
    wrong = limits_faults("tol", tol, CYCLE_TOLERANCES) + violations(
        (
            (ends := interval_in_si(name, bounds)) is not None,
            "bounds",
            bounds,
            "must be two ascending finite numbers",
        ),
        (counts, "points", points, f"must be a whole number from 2 to {MOST_POINTS}"),
        (good, "precision", precision, "must be a number > 0"),
    )
    raise_faults(case_faults(p, "critical") or wrong + free_faults(p, [name]))
    tol = float(tol)
    values = np.linspace(ends[0], ends[1], points).tolist()
    for x in values:
        p.replace(**{name: x})
    span = ends[1] - ends[0]
    shortest = 1e-6 * span if precision is None else float(precision)
    scan = _Scan(p, name, tol)
    for x in values:
        scan.stable(x)
    scan.refine(max(shortest, NARROWEST * span))
    changes = [(a, b) for a, b in pairwise(sorted(scan.cycles)) if scan.stable(a) != scan.stable(b)]
    crossings = [scan.located(a, b, shortest) for a, b in changes]
    unstable_above = [scan.stable(a) for a, _ in changes]
    computed = sorted(scan.cycles)
    return Critical(
        parameters=p,
        name=name,
        value=next((x for x in computed if not scan.stable(x)), math.nan),
        crossings=np.array(crossings),
        unstable_above=np.array(unstable_above, dtype=bool),
        values=np.array(computed),
        growth_rate=np.array([scan.cycles[x].growth_rate for x in computed]),
        resolution=max(b - a for a, b in pairwise(computed)),
    )


class _Scan:
    """Cycles of a case by the value of one parameter, each computed once."""

    def __init__(self, p: Parameters, name: str, tol: float) -> None:
        self.p, self.name, self.tol = p, name, tol
        self.cycles: dict[float, FloquetResult] = {}

    def stable(self, x: float) -> bool:
        if x not in self.cycles:
            self.cycles[x] = find_cycle(self.p.replace(**{self.name: x}), self.tol)
        return self.cycles[x].motion in STABLE_CYCLES

    def refine(self, narrowest: float) -> None:
        """Compute further values where the cycles beside them leave a change of stability in doubt,
        none closer than `narrowest` to another one."""
        looked_at = set[tuple[float, float]]()
        for _ in range(ROUNDS):
            gaps = {gap for gap in pairwise(sorted(self.cycles)) if gap not in looked_at}
            looked_at |= gaps
            for a, b in sorted(gaps):
                for share in _doubtful_shares(self.cycles[a], self.cycles[b]):
                    if min(share, 1 - share) * (b - a) > narrowest:
                        self.stable(a + share * (b - a))

    def located(self, a: float, b: float, shortest: float) -> float:
        """The upper end of a short interval within a longer one, from a to b, at whose ends
        stability differs."""
        before = self.stable(a)
        while b - a > shortest:
            middle = 0.5 * (a + b)
            if not a < middle < b:
                break
            if self.stable(middle) == before:
                a = middle
            else:
                b = middle
        return b


def _doubtful_shares(first: FloquetResult, second: FloquetResult) -> list[float]:
    """Shares of the way from one cycle to another at which stability may change, or the cycle
    end."""
    if not (len(first.multipliers) and len(second.multipliers)):
        return [0.5] if len(first.multipliers) != len(second.multipliers) else []
    shares = set[float]()
    for exponent in MATCHES:
        before, after = _matched(first.multipliers, second.multipliers, exponent)
        shares |= _shares_of_change(before, after)
    return sorted(shares)


def _matched(
    first: ComplexArray, second: ComplexArray, exponent: float
) -> tuple[ComplexArray, ComplexArray]:
    """Multipliers of two cycles, each beside the one that it becomes: the sum of distances, to the
    power `exponent`, is least."""
    from scipy.optimize import linear_sum_assignment

    distance = np.abs(first[:, None] - second[None, :])
    rows, columns = linear_sum_assignment(distance**exponent)
    return first[rows], second[columns]


def _shares_of_change(before: ComplexArray, after: ComplexArray) -> set[float]:
    """As `_doubtful_shares`, from multipliers that are matched."""
    weak = np.minimum(abs(before), abs(after)) > STRONGLY_DAMPED
    on_axis = [int(np.sum(weak & (values.imag == 0))) for values in (before, after)]
    upper = weak & (before.imag > 0)
    angle = np.angle(before[upper])
    turn = np.angle(after[upper] / before[upper])
    longest = float(np.abs(turn).max(initial=0))
    shares = {*_meetings(angle, turn), *_returns_from_axis(angle, angle + turn, longest)}
    if longest > LONGEST_TURN or on_axis[0] != on_axis[1]:
        shares.add(0.5)
    return shares


def _meetings(angle: Array, turn: Array) -> list[float]:
    """Shares of the way at which multipliers meet on the unit circle, from their angles (rad) and
    by how much they turn: those of the upper half, with each other and with the conjugate ones."""
    i, j = np.triu_indices(len(angle))
    # a multiplier that comes to the real axis meets its conjugate, as the sum of an angle with
    # itself comes to 2 pi
    begin = np.concatenate([angle[i] + angle[j], (angle[i] - angle[j])[i != j]]) / math.tau
    end = begin + np.concatenate([turn[i] + turn[j], (turn[i] - turn[j])[i != j]]) / math.tau
    meets = np.floor(begin) != np.floor(end)
    level = np.maximum(np.floor(begin), np.floor(end))
    shares = (level - begin)[meets] / (end - begin)[meets]
    return [float(share) for share in shares if 0 < share < 1]


def _returns_from_axis(before: Array, after: Array, longest: float) -> list[float]:
    """Shares of the way at which multipliers may have met the real axis, from their angles at both
    ends (rad): a pair that passes through the axis looks like one that has turned back."""
    shares = list[float]()
    for first, second in ((before, after), (math.pi - before, math.pi - after)):
        way = first + second
        near = (first > 0) & (second > 0) & (way <= MAY_HAVE_MET * longest)
        shares += (first[near] / way[near]).tolist()
    return shares
