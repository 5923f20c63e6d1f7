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
from disc_model.stability.return_map import Array, ReturnMap, case_faults
from disc_model.units import CYCLE_TOLERANCES, is_number, is_whole, limits_faults

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
    kind: Kind
    case: Parameters
    point: Array
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
    steps = BORDER.replace(longest=longest, shortest=1e-4, max_points=max_points)
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
    curves, notes = list[StabilityCurve](), list[str]()
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
                    seed.kind, seed.case, names, plane, guess=seed.point, tol=tol, steps=steps
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
            if seed := _first_event(cases[begin], name, cases[end].numbers[name], tol, notes):
                yield seed
                if seed.kind == "neutral":
                    break


def _first_event(
    case: Parameters, name: str, end: float, tol: float, notes: list[str]
) -> _Seed | None:
    """The first fold or crossing of the unit circle between a case and another value of a
    parameter."""
    begin = case.numbers[name]
    bounds, direction = (min(begin, end), max(begin, end)), 1 if begin < end else -1
    try:
        steps = StepControl(scale=abs(end - begin), max_points=40, beyond=True)
        branch = continue_cycle(case, name, bounds, direction=direction, tol=tol, steps=steps)
    except ParameterError as error:
        notes.append(f"{name}={begin:.6g}: {error}")
        return None
    values, growth = branch.values[:, 0], branch.growth_rate
    turns = np.flatnonzero(np.diff(values)[:-1] * np.diff(values)[1:] < 0) + 1
    crossings = np.flatnonzero(growth[:-1] * growth[1:] < 0)
    fold = int(turns[0]) if len(turns) else len(values)
    if len(crossings) and crossings[0] + 1 < fold:
        kind: Kind = "neutral"
        i = int(crossings[0])
        j = i if abs(growth[i]) < abs(growth[i + 1]) else i + 1
    elif len(turns):
        kind, j = "fold", fold
    else:
        if branch.ended.startswith(UNLOCATED):
            notes.append(branch.ended)
        return None
    moved = case.replace(**{name: float(values[j])})
    point = branch.points[j]
    scale, new = (ReturnMap(each, tol).scale for each in (case, moved))
    if not np.array_equal(
        scale, new
    ):  # frequencies scale the coordinates, and the branch uses those of its first case
        point = point / scale * new
    return _Seed(kind, moved, point, float(branch.period[j]))


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

ROUNDS = 5  # number of times that places of resonance are predicted anew, from the multipliers beside them
STRONGLY_DAMPED = (
    0.5  # modulus below which a multiplier takes part in no resonance that could make it one
)


@dataclass(frozen=True, eq=False, repr=False)
class Critical(Drawn):
    """Values of a parameter at which the motion near the static start gains or loses stability.

    `plot` draws the growth rate of the cycle over the parameter, with the intervals in which that
    motion is unstable.

    Attributes
    ----------
    parameters, name : the case, and the parameter
    value : the least value at which the motion near the static start is unstable; nan if none is within the bounds
    crossings : shape (n,), all values at which stability changes, ascending
    unstable_above : bool, (n,), whether that motion is unstable just above each
    values, growth_rate : shape (m,), the values computed, ascending, and growth rates of the cycle (1/s; nan without)
    resolution : a tongue of instability narrower than this may have been stepped over
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
        seen = f"{len(self.values)} cycles, tongues down to {self.resolution:.2g} seen"
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
    points: int = 41,
    precision: float | None = None,
    tol: float = 1e-12,
) -> Critical:
    """The least parameter value with unstable motion near the static start, and all stability
    changes above it.

    That motion is the stick-slip cycle, or steady sliding or rest if there is no cycle. Instability
    often lies in narrow tongues, where multipliers meet on the unit circle. Their angles change
    smoothly, so that these places are predicted from the multipliers of neighbouring values, and
    computed, until the predictions no longer move.

    Parameters
    ----------
    p : the case; its value of the parameter is not used
    name : one of `Parameters.numbers`, such as "mu_s"
    bounds : lowest and highest value; SI units, or texts with units
    points : number of values from which the search starts
    precision : to which crossings are bisected; a millionth of the range if not given
    tol : as in `floquet`

    Returns
    -------
    Critical
        `value`, `crossings`, and `resolution`, the width of the narrowest tongue that cannot be overlooked.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does at a value within the bounds.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=12, mu_k_over_mu_s=0.6)
    >>> dm.critical(case, "mu_s", (0.3, 0.42), points=7)
    Critical(mu_s: unstable from 0.3, 1 crossing, ... cycles, tongues down to ... seen)
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
    shortest = 1e-6 * (ends[1] - ends[0]) if precision is None else float(precision)
    cycles: dict[float, FloquetResult] = {}

    def stable(x: float) -> bool:
        if x not in cycles:
            cycles[x] = find_cycle(p.replace(**{name: x}), tol)
        return cycles[x].motion in STABLE_CYCLES

    def located(interval: tuple[float, float]) -> float:
        """The upper end of a short interval within which stability changes."""
        (a, b), before = interval, stable(interval[0])
        while b - a > shortest and a < (middle := 0.5 * (a + b)) < b:
            a, b = (middle, b) if stable(middle) == before else (a, middle)
        return b

    for x in values:
        stable(x)
    resolution = math.inf
    for _ in range(ROUNDS):
        gaps = [(a, b, _resonances(cycles[a], cycles[b])) for a, b in pairwise(sorted(cycles))]
        new = {
            a + share * (b - a): min(share, 1 - share) * (b - a)
            for a, b, shares in gaps
            for share in shares
        }
        resolution = max(
            [shortest, *new.values(), *(b - a for a, b, shares in gaps if shares is NO_CYCLES)]
        )
        far = sorted(x for x, distance in new.items() if distance > shortest)
        if not far:
            break
        for x in far:
            stable(x)
    changes = [(a, b) for a, b in pairwise(sorted(cycles)) if stable(a) != stable(b)]
    crossings = [located(interval) for interval in changes]
    unstable_above = [stable(a) for a, _ in changes]
    first = [] if stable(values[0]) else [float(ends[0])]
    first += [x for x, grows in zip(crossings, unstable_above, strict=True) if grows]
    values = sorted(cycles)
    return Critical(
        parameters=p,
        name=name,
        value=first[0] if first else math.nan,
        crossings=np.array(crossings),
        unstable_above=np.array(unstable_above, dtype=bool),
        values=np.array(values),
        growth_rate=np.array([cycles[x].growth_rate for x in values]),
        resolution=resolution,
    )


NO_CYCLES: tuple[float, ...] = (
    0.5,
)  # of an interval one of whose ends has no cycle the middle is computed


def _resonances(first: FloquetResult, second: FloquetResult) -> Sequence[float]:
    """Shares of the way from one cycle to another at which multipliers are predicted to meet on the
    unit circle."""
    if not (len(first.multipliers) and len(second.multipliers)):
        return NO_CYCLES if len(first.multipliers) != len(second.multipliers) else ()
    distance = np.abs(first.multipliers[:, None] - second.multipliers[None, :])
    from scipy.optimize import linear_sum_assignment

    rows, columns = linear_sum_assignment(distance)
    before, after = first.multipliers[rows], second.multipliers[columns]
    chosen = (before.imag > 0) & (np.minimum(abs(before), abs(after)) > STRONGLY_DAMPED)
    angle, turn = np.angle(before[chosen]), np.angle(after[chosen] / before[chosen])
    i, j = np.triu_indices(len(angle))
    # a multiplier that comes to the real axis meets its conjugate, as the sum of an angle with
    # itself comes to 2 pi
    begin = np.concatenate([angle[i] + angle[j], (angle[i] - angle[j])[i != j]]) / math.tau
    end = begin + np.concatenate([turn[i] + turn[j], (turn[i] - turn[j])[i != j]]) / math.tau
    meets = np.floor(begin) != np.floor(end)
    level = np.maximum(np.floor(begin), np.floor(end))
    return [
        float(share) for share in ((level - begin)[meets] / (end - begin)[meets]) if 0 < share < 1
    ]
