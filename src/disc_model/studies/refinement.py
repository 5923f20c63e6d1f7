"""Outcome of the static start over two parameters, refined at borders, and the cycle at every
point.

Multipliers give the outcome where the start stays on its cycle, or grows too slowly for anything else.
Elsewhere the start is simulated, except within cells all of whose points that were simulated
separate: only separation is inferred. docs/study_method.md, Regions, describes the cells.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any, NamedTuple

import numpy as np

from disc_model.analysis.spectra import modes_at_rest
from disc_model.arrays import Array
from disc_model.data.variables import STABLE_CYCLES, Outcome
from disc_model.stability.cycle import FloquetResult
from disc_model.stability.follower import (
    SAME_POINT,
    NearCycle,
    OutcomeResult,
    cycle_of_static_start,
    find_outcome,
)
from disc_model.stability.return_map import newton
from disc_model.studies.quantity import NUMERICAL, Made, Row, failed

Index = tuple[int, int]

# distances of cycles at neighbouring points, relative to the deflection
SMOOTHLY = 0.002  # within which they are one
APART = 0.02  # beyond which one carried over from a neighbour may be another
MOST_CYCLES = 4  # known at a point; further ones cost too much


class TileOptions(NamedTuple):
    """Options of a tile: horizon (s) and tolerance of its motions, whether their slow departures are
    extrapolated, and intervals along the side of its first cells."""

    horizon: float
    tol: float
    extrapolate: bool
    initial_cell_size: int


@dataclass
class TilePoint:
    """What is known of a point of a tile.

    Attributes
    ----------
    parameters : its case, or the error in its place
    start : the cycle near the static start, what `floquet` says if there is none, or an error
    trend : the outcome by the multipliers, "" if they leave it open
    result : the outcome that was computed, or the error that ended that; None if none was
    inferred : whether the outcome is that of the points around
    """

    parameters: Made
    start: NearCycle | FloquetResult | Exception | None = None
    trend: str = ""
    result: OutcomeResult | Exception | None = None
    inferred: bool = False

    @property
    def word(self) -> str:
        """The outcome that was computed; "failed" after an error."""
        return self.result.word if isinstance(self.result, OutcomeResult) else "failed"

    @property
    def shown(self) -> str:
        """The outcome, computed or inferred."""
        if self.result is not None:
            return self.word
        if self.inferred:
            return Outcome.SEPARATION
        return self.trend

    @property
    def own_cycle(self) -> NearCycle | None:
        """The cycle that the static start follows from its beginning."""
        if isinstance(self.start, NearCycle) and self.start.follows_cycle:
            return self.start
        return None

    @property
    def followed(self) -> NearCycle | None:
        """The cycle that the static start follows, as far as that is known, before any later
        one."""
        own = self.own_cycle
        if not isinstance(self.result, OutcomeResult):
            return own
        if own is not None and self.result.outcome is not Outcome.STICK_SLIP:
            return own
        return self.result.near


class Tile:
    """A tile of the plane; the outcome at the places `sampled` is always computed, and the time of a
    separation there.

    Attributes
    ----------
    shape : numbers of rows and columns
    options : of the motions and the first cells
    sampled : places, by row and column, where the outcome is always computed
    points : what is known of each, by row and column
    """

    def __init__(
        self, points: Sequence[Sequence[Made]], sampled: Sequence[Index], options: TileOptions
    ) -> None:
        self.shape: Index = (len(points), len(points[0]))
        self.options = options
        self.sampled = tuple(sampled)
        self.points: dict[Index, TilePoint] = {}
        for i, row in enumerate(points):
            for j, p in enumerate(row):
                self.points[i, j] = TilePoint(p)

    def compute(self) -> None:
        """Find the cycle at every point, and the outcome where neither multipliers nor the points
        around decide it."""
        for point in self.points.values():
            point.start = _result_or_error(cycle_of_static_start, point.parameters)
            point.trend = self._trend(point)
        for index in self.sampled:
            self._outcome(index)
        # a point on the edge of a cell may be computed later for the next cell: again, until
        # nothing is added
        known = -1
        while known < self._number_computed():
            known = self._number_computed()
            for point in self.points.values():
                point.inferred = False
            self._refine_all()

    def rows(self) -> list[list[tuple[Row, str]]]:
        """Return values and message of each point, by row and column."""
        others = self._others()
        rows = []
        for i in range(self.shape[0]):
            indices = [(i, j) for j in range(self.shape[1])]
            rows.append([self._row(index, others[index]) for index in indices])
        return rows

    # ---- Outcomes

    def _number_computed(self) -> int:
        return sum(point.result is not None for point in self.points.values())

    def _outcome(self, index: Index) -> str:
        """Return the outcome of the static start at a point, computed once."""
        point = self.points[index]
        if point.result is None:
            point.result = self._result(point, timed=index in self.sampled)
        return point.word

    def _result(self, point: TilePoint, *, timed: bool) -> OutcomeResult | Exception:
        """Return the outcome at a point, or the error that ends its computation.

        Parameters
        ----------
        point : of the tile
        timed : whether a separation needs its time, so that nothing is extrapolated
        """
        p = point.parameters
        if isinstance(p, Exception):
            return p

        def find(start: Any) -> OutcomeResult:
            options = self.options
            extrapolate = options.extrapolate and not timed
            times = (options.horizon,) if extrapolate else ()
            return find_outcome(
                p, options.horizon, tol=options.tol, near=start, compared_with=times
            )

        return _result_or_error(find, point.start)

    def _trend(self, point: TilePoint) -> str:
        """Return the outcome at a point from the multipliers, or "" if they leave it open."""
        own = point.own_cycle
        if own is None:
            return ""
        if own.cycle.stable:
            return Outcome.STICK_SLIP
        if own.stays_linear_until(self.options.horizon):
            return Outcome.GROWING
        return ""

    # ---- Cells

    def _refine_all(self) -> None:
        """Refine all first cells."""
        rows = _edges(self.shape[0], self.options.initial_cell_size)
        columns = _edges(self.shape[1], self.options.initial_cell_size)
        for across, along in product(pairwise(rows), pairwise(columns)):
            self._refine(across, along)

    def _refine(self, rows: Index, columns: Index) -> None:
        """Infer the outcomes within a cell, given by the indices of its edges, or divide it."""
        across = range(rows[0], rows[1] + 1)
        along = range(columns[0], columns[1] + 1)
        inside = list(product(across, along))
        if all(self.points[index].trend for index in inside):
            return

        separates = self._separates(rows, columns, inside)
        side = max(rows[1] - rows[0], columns[1] - columns[0])
        if separates and side <= max(1, self.options.initial_cell_size // 2):
            for index in inside:
                point = self.points[index]
                point.inferred |= point.result is None
            return

        halves = list(product(_halves(*rows), _halves(*columns)))
        if len(halves) > 1:
            for half_rows, half_columns in halves:
                self._refine(half_rows, half_columns)
            return

        for index in inside:
            if not self.points[index].trend:
                self._outcome(index)

    def _separates(self, rows: Index, columns: Index, inside: Sequence[Index]) -> bool:
        """Tell whether a cell separates at its corners, in its middle, and where else it was
        computed, and multipliers say nothing else of any of its points."""
        if any(self.points[index].trend for index in inside):
            return False
        probes = {*product(rows, columns), _middle(inside)}
        probes.update(index for index in inside if self.points[index].result is not None)
        return all(self._outcome(index) is Outcome.SEPARATION for index in sorted(probes))

    # ---- Rows

    def _row(self, index: Index, others: int) -> tuple[Row, str]:
        """Return values and message of a point with a number of other cycles."""
        point = self.points[index]
        for error in (point.start, point.result):
            if isinstance(error, Exception):
                return failed(error)
        i, j = index
        row: dict[str, Any] = {
            "status": "ok",
            "other_cycles": others,
            "branch_continues_first": self._joined(index, (i + 1, j)),
            "branch_continues_second": self._joined(index, (i, j + 1)),
        }
        row.update(_outcome_columns(point))
        row.update(_cycle_columns(point))
        message = point.result.message if isinstance(point.result, OutcomeResult) else ""
        return row, message

    def _joined(self, index: Index, ahead: Index) -> str:
        """Return "yes" if a point's cycle continues into the cycle of the next point, else "no"."""
        if ahead not in self.points:
            return "no"
        here = self.points[index].followed
        further = self.points[ahead].followed
        if here is None or further is None or here.x.shape != further.x.shape:
            return "no"
        if here.cycle.releases != further.cycle.releases:
            return "no"
        size = further.map.deflection  # the unit of points, which varies with the parameters
        x = here.x * size / here.map.deflection
        if np.linalg.norm(x - further.x) <= SMOOTHLY * size:
            return "yes"
        orbit = newton(further.map, x, releases=further.cycle.releases)
        if orbit is not None and np.linalg.norm(orbit.start - further.x) <= SAME_POINT * size:
            return "yes"
        return "no"

    def _others(self) -> dict[Index, int]:
        """Return the number of known cycles at each point besides the one nearest to the start,
        carried along rows both ways."""
        known: dict[Index, list[Array]] = {}
        for index, point in self.points.items():
            known[index] = [point.start.x] if isinstance(point.start, NearCycle) else []
        for i in range(self.shape[0]):
            row = [(i, j) for j in range(self.shape[1])]
            for before, index in (*pairwise(row), *pairwise(row[::-1])):
                self._carry(known[before], before, known[index], index)
        return {index: max(0, len(cycles) - 1) for index, cycles in known.items()}

    def _carry(
        self, carried: Sequence[Array], before: Index, cycles: list[Array], index: Index
    ) -> None:
        """Add, to the known cycles of a point, those of the point before that continue to it and
        are others."""
        start = self.points[index].start
        last = self.points[before].start
        if not isinstance(start, NearCycle) or not isinstance(last, NearCycle):
            return
        if start.x.shape != last.x.shape:
            return
        size = start.map.deflection  # the unit of points, which varies with the parameters
        scale = size / last.map.deflection
        for cycle in carried:
            if len(cycles) >= MOST_CYCLES:
                return
            guess = scale * cycle
            if _distance(guess, cycles) <= APART * size:  # not another one
                continue
            orbit = newton(start.map, guess, releases=last.cycle.releases)
            if orbit is not None and _distance(orbit.start, cycles) > SAME_POINT * size:
                cycles.append(orbit.start)


def _outcome_columns(point: TilePoint) -> dict[str, Any]:
    """Return the columns of a point's outcome, and how it is known."""
    result = point.result
    if not isinstance(result, OutcomeResult):
        method = "inferred" if point.inferred else "multipliers"
        return {"outcome": point.shown, "method": method}
    method = "simulation" if result.simulated else "multipliers"
    if result.extrapolated:
        method = "extrapolation"
    return {
        "method": method,
        "status": result.status,
        "outcome": result.word,
        "simulated_time": result.simulated,
        "first_separation": result.timed_separation,
    }


def _cycle_columns(point: TilePoint) -> dict[str, Any]:
    """Return the columns of the cycle that a point's static start follows."""
    followed = point.followed
    if followed is None:
        return {"cycle": _word_without_cycle(point)}
    cycle = followed.cycle
    bound = [frequency for frequency, _, moves in modes_at_rest(cycle.parameters) if moves]
    return {
        "cycle": "followed",
        "growth_rate": cycle.growth_rate,
        "period": cycle.period,
        "releases": cycle.releases,
        "period_ratio": cycle.period * min(bound),
    }


def _word_without_cycle(point: TilePoint) -> str:
    """Return what a static start does that follows no cycle."""
    result = point.result
    if isinstance(result, OutcomeResult) and result.outcome is Outcome.STEADY_SLIDING:
        return "steady_sliding"
    of_search = (*STABLE_CYCLES, "unstable_sliding")
    if isinstance(point.start, FloquetResult) and point.start.motion in of_search:
        return point.start.motion
    return "nearby_only" if isinstance(point.start, NearCycle) else "no_cycle"


def _distance(x: Array, cycles: Sequence[Array]) -> float:
    """Return the distance of a point on the section from the nearest of some others."""
    return float(min(np.linalg.norm(cycle - x) for cycle in cycles))


def _result_or_error(compute: Callable[[Any], Any], argument: Any) -> Any:
    """The result of an argument, or the error in its place, which it may be already."""
    if isinstance(argument, Exception):
        return argument
    try:
        return compute(argument)
    except NUMERICAL as error:
        return error


def _middle(indices: Sequence[Index]) -> Index:
    """The indices nearest to the middle of several; the first of equally near ones."""
    middle = np.mean(indices, axis=0)

    def far(index: Index) -> tuple[float, Index]:
        squares = (np.array(index) - middle) ** 2
        return float(np.sum(squares)), index

    return min(indices, key=far)


def _edges(size: int, coarse: int) -> list[int]:
    """Indices of the edges of coarse cells along `size` points; a single point is both edges of its
    cell."""
    cells = max(1, math.ceil((size - 1) / coarse))
    return [round(i * (size - 1) / cells) for i in range(cells + 1)]


def _halves(first: int, last: int) -> list[Index]:
    """The two halves of an interval of indices, or the interval itself if it cannot be divided."""
    middle = (first + last) // 2
    if middle == first:
        return [(first, last)]
    return [(first, middle), (middle, last)]
