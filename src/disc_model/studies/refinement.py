"""Outcome of the static start over two parameters, refined at borders, and the cycle at every
point.

Multipliers give the outcome where the start stays quiet, or grows too slowly for anything else.
Elsewhere the start is simulated, except within cells all of whose points that were simulated
separate: only separation is inferred. docs/study_method.md, Regions, describes the cells.
"""

import math
from collections.abc import Callable, Collection, Sequence
from itertools import pairwise, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from disc_model.analysis.spectra import modes_at_rest
from disc_model.data.variables import STABLE_CYCLES, Outcome
from disc_model.stability.cycle import FloquetResult
from disc_model.stability.linear_motion import NearCycle, cycle_of_static_start
from disc_model.stability.outcome import OutcomeResult, find_outcome
from disc_model.stability.return_map import newton
from disc_model.stability.thresholds import SAME_POINT
from disc_model.studies.quantity import NUMERICAL, Made, Row, failed

Array = NDArray[np.float64]
Index = tuple[int, int]


class Tile:
    """A tile of the plane, with the options of `Regions`; the outcome at the places `sampled` is
    always computed."""

    def __init__(
        self, points: Sequence[Sequence[Made]], sampled: Collection[Index], options: Any
    ) -> None:
        self.options, self.shape = options, (len(points), len(points[0]))
        self.points: dict[Index, Any] = {
            (i, j): p for i, row in enumerate(points) for j, p in enumerate(row)
        }
        self.starts = {
            index: _result_or_error(cycle_of_static_start, p) for index, p in self.points.items()
        }
        self.results: dict[Index, OutcomeResult | Exception] = {}
        self.inferred: set[Index] = set()  # points that separate like those around them
        self.trends = {index: self._trend(index) for index in self.starts}
        for index in sampled:
            self.outcome(index)
        rows, columns = (_edges(size, options.initial_cell_size) for size in self.shape)
        known = -1
        while known < len(self.results):  # a point on the edge of a cell may have been computed
            known = len(self.results)
            self.inferred.clear()
            for across, along in product(pairwise(rows), pairwise(columns)):
                self._refine(across, along)

    def _own(self, index: Index) -> NearCycle | None:
        """The cycle that the static start follows from its beginning."""
        start = self.starts[index]
        return start if isinstance(start, NearCycle) and start.follows_cycle else None

    def _shown(self, index: Index) -> str:
        """The outcome at a point, computed or inferred."""
        if index in self.results:
            return self.outcome(index)
        return Outcome.SEPARATION if index in self.inferred else self.trends[index]

    def outcome(self, index: Index) -> str:
        """Outcome of the static start at a point, computed once."""
        if index not in self.results:
            self.results[index] = self._result(index)
        result = self.results[index]
        return result.word if isinstance(result, OutcomeResult) else "failed"

    def _result(self, index: Index) -> OutcomeResult | Exception:
        p, horizon, tol = self.points[index], self.options.horizon, self.options.tol
        return _result_or_error(
            lambda start: find_outcome(p, horizon, tol=tol, near=start), self.starts[index]
        )

    def _trend(self, index: Index) -> str:
        """The outcome at a point from the multipliers, or "" if they leave it open."""
        start = self._own(index)
        if start is not None and start.cycle.stable:
            return Outcome.QUIET
        return (
            Outcome.GROWING
            if start is not None and start.stays_linear_until(self.options.horizon)
            else ""
        )

    def _refine(self, rows: Index, columns: Index) -> None:
        """Infer the outcomes within a cell, given by the indices of its edges, or divide it."""
        inside = list(product(range(rows[0], rows[1] + 1), range(columns[0], columns[1] + 1)))
        if all(self.trends[index] for index in inside):
            return
        probes = {*product(rows, columns), _middle(inside), *(self.results.keys() & {*inside})}
        separates = not any(self.trends[index] for index in inside) and all(
            self.outcome(index) is Outcome.SEPARATION for index in sorted(probes)
        )
        side = max(rows[1] - rows[0], columns[1] - columns[0])
        if separates and side <= max(1, self.options.initial_cell_size // 2):
            self.inferred |= set(inside) - self.results.keys()
            return
        halves = [_halves(*edges) for edges in (rows, columns)]
        if len(halves[0]) * len(halves[1]) > 1:
            for i, j in product(*halves):
                self._refine(i, j)
            return
        for index in inside:
            if not self.trends[index]:
                self.outcome(index)

    def rows(self) -> list[list[tuple[Row, str]]]:
        others = self._others()
        self.followed = {index: self._follow(index) for index in self.starts}
        return [
            [self._row((i, j), others[i, j]) for j in range(self.shape[1])]
            for i in range(self.shape[0])
        ]

    def _follow(self, index: Index) -> NearCycle | None:
        """The cycle that the static start follows at a point, if that is known, before any later
        one."""
        cycle, result = self._own(index), self.results.get(index)
        if not isinstance(result, OutcomeResult):
            return cycle
        return cycle if cycle is not None and result.outcome is not Outcome.QUIET else result.near

    def _joined(self, index: Index, ahead: Index) -> str:
        """Whether, and how, a point's cycle continues into the cycle of the next point."""
        near, further = self.followed.get(index), self.followed.get(ahead)
        if near is None or further is None or near.x.shape != further.x.shape:
            return "no"
        if near.cycle.releases != further.cycle.releases:
            return "no"
        size = further.map.deflection  # the unit of points, which varies with the parameters
        x = near.x * size / near.map.deflection
        if np.linalg.norm(x - further.x) <= 0.002 * size:  # smoothly
            return "yes"
        orbit = newton(further.map, x, releases=further.cycle.releases)
        return (
            "yes"
            if orbit is not None and np.linalg.norm(orbit.start - further.x) <= SAME_POINT * size
            else "no"
        )

    def _row(self, index: Index, others: int) -> tuple[Row, str]:
        (i, j), start, result = index, self.starts[index], self.results.get(index)
        if isinstance(start, Exception):
            return failed(start)
        if isinstance(result, Exception):
            return failed(result)
        row: dict[str, Any] = {"status": "ok", "other_cycles": others}
        row["branch_continues_first"] = self._joined(index, (i + 1, j))
        row["branch_continues_second"] = self._joined(index, (i, j + 1))
        if result is None:
            method = "inferred" if index in self.inferred else "multipliers"
            row |= {"outcome": self._shown(index), "method": method}
        else:
            row["method"] = "simulation" if result.simulated else "multipliers"
            row |= {
                "status": result.status,
                "outcome": result.word,
                "simulated_time": result.simulated,
            }
            row["first_separation"] = result.first_separation
        if (followed := self.followed[index]) is None:
            row["cycle"] = "nearby_only" if isinstance(start, NearCycle) else "no_cycle"
            if result is not None and result.outcome is Outcome.STEADY_SLIDING:
                row["cycle"] = "steady_sliding"
            elif isinstance(start, FloquetResult) and start.motion in STABLE_CYCLES:
                row["cycle"] = start.motion
        else:
            cycle = followed.cycle
            lowest = min(
                frequency for frequency, _, bound in modes_at_rest(cycle.parameters) if bound
            )
            row |= {"cycle": "followed", "growth_rate": cycle.growth_rate, "period": cycle.period}
            row |= {"releases": cycle.releases, "period_ratio": cycle.period * lowest}
        return row, "" if result is None else result.message

    def _others(self) -> dict[Index, int]:
        """Number of known cycles at each point besides the one nearest to the start, carried along
        rows both ways."""
        known = {
            index: [start.x] if isinstance(start, NearCycle) else []
            for index, start in self.starts.items()
        }
        for i in range(self.shape[0]):
            row = [(i, j) for j in range(self.shape[1])]
            for before, index in (*pairwise(row), *pairwise(row[::-1])):
                start, last, cycles = self.starts[index], self.starts[before], known[index]
                if (
                    not (isinstance(start, NearCycle) and isinstance(last, NearCycle))
                    or start.x.shape != last.x.shape
                ):
                    continue
                size = start.map.deflection  # the unit of points, which varies with the parameters
                scale = size / last.map.deflection
                for cycle in known[before]:
                    if len(cycles) >= 4:  # further ones cost too much
                        break
                    if (
                        min(np.linalg.norm(scale * cycle - x) for x in cycles) <= 0.02 * size
                    ):  # not another one
                        continue
                    orbit = newton(start.map, scale * cycle, releases=last.cycle.releases)
                    if (
                        orbit is not None
                        and min(np.linalg.norm(orbit.start - x) for x in cycles) > SAME_POINT * size
                    ):
                        cycles.append(orbit.start)
        return {index: max(0, len(cycles) - 1) for index, cycles in known.items()}


def _result_or_error(compute: Callable[[Any], Any], argument: Any) -> Any:
    """The result of an argument, or the error in its place, which it may be already."""
    try:
        return argument if isinstance(argument, Exception) else compute(argument)
    except NUMERICAL as error:
        return error


def _middle(indices: Sequence[Index]) -> Index:
    """The indices nearest to the middle of several; the first of equally near ones."""
    middle = np.mean(indices, axis=0)
    return min(indices, key=lambda index: (float(np.sum((np.array(index) - middle) ** 2)), index))


def _edges(size: int, coarse: int) -> list[int]:
    """Indices of the edges of coarse cells along `size` points; a single point is both edges of its
    cell."""
    cells = max(1, math.ceil((size - 1) / coarse))
    return [round(i * (size - 1) / cells) for i in range(cells + 1)]


def _halves(first: int, last: int) -> list[Index]:
    """The two halves of an interval of indices, or the interval itself if it cannot be divided."""
    middle = (first + last) // 2
    return [(first, middle), (middle, last)] if middle > first else [(first, last)]
