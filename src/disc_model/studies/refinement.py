"""Outcome of the static start over two parameters, refined at borders, and the cycle at every
point.

Multipliers give the outcome where the start stays quiet, or grows too slowly for anything else.
Elsewhere it is simulated at the corners of coarse cells, which are divided as docs/study_method.md,
Regions, describes, or filled.
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
from disc_model.stability.outcome import OutcomeResult, Stage, find_outcome
from disc_model.stability.return_map import newton
from disc_model.stability.thresholds import AMPLITUDES, SAME_POINT
from disc_model.studies.quantity import NUMERICAL, Made, Row, failed

Array = NDArray[np.float64]
Index = tuple[int, int]

GROWN = {Outcome.GROWING, Outcome.OTHER_CYCLE}
CALM = (Outcome.QUIET, Outcome.STEADY_SLIDING, Outcome.AT_REST)


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
        self.filled: dict[Index, str] = {}
        self.presumed: dict[Index, str] = {}
        self.trends = {index: self._trend(index) for index in self.starts}
        for index in sampled:
            self.outcome(index)
        rows, columns = (_edges(size, options.initial_cell_size) for size in self.shape)
        known = -1
        while (
            known < len(self.results) or self._confirm()
        ):  # a result on its edge may require a cell to be divided
            known = len(self.results)
            self.filled.clear()
            self.presumed.clear()
            for across, along in product(pairwise(rows), pairwise(columns)):
                self._refine(across, along)
        self._check_what_is_filled()

    def _own(self, index: Index) -> NearCycle | None:
        """The cycle that the static start follows from its beginning."""
        start = self.starts[index]
        return start if isinstance(start, NearCycle) and start.follows_cycle else None

    def _check_what_is_filled(self) -> None:
        """Compute points whose start follows a growing cycle but counts as calm, or none though
        most neighbours do."""
        for (i, j), outcome in (self.presumed | self.filled).items():
            beside = [
                index
                for index in ((i - 1, j), (i, j - 1), (i, j + 1), (i + 1, j))
                if index in self.starts
            ]
            doubtful = outcome in CALM
            if self._own((i, j)) is None:
                # the strip of points without a cycle is thinner than the grid
                doubtful = sum(self._own(index) is None for index in beside) <= 1
            if doubtful:
                self.outcome((i, j))

    def _confirm(self) -> bool:
        """Whether an outcome changes if its departure, of which multipliers do not keep the phase,
        is simulated as a whole, where both points beside have another."""
        changed = False
        for (i, j), result in list(self.results.items()):
            if not isinstance(result, OutcomeResult) or result.extrapolated is None:
                continue
            sides = [((i - 1, j), (i + 1, j)), ((i, j - 1), (i, j + 1))]
            beside = {
                self._shown(before)
                for before, after in sides
                if self._shown(before) == self._shown(after)
            }
            if any(
                both != result.word and {both, result.word} - GROWN == {Outcome.SEPARATION}
                for both in beside
            ):
                whole = self._result((i, j), furthest=0.0)
                if isinstance(whole, OutcomeResult):
                    whole.simulated += result.simulated
                self.results[i, j] = whole
                changed |= self.outcome((i, j)) != result.word
        return changed

    def _shown(self, index: Index) -> str | None:
        """The outcome at a point as far as it is known."""
        if index in self.results:
            return self.outcome(index)
        return self.trends.get(index) or self.filled.get(index, self.presumed.get(index))

    def outcome(self, index: Index) -> str:
        """Outcome of the static start at a point, computed once."""
        if index not in self.results:
            self.results[index] = self._result(index)
        result = self.results[index]
        return result.word if isinstance(result, OutcomeResult) else "failed"

    def _result(self, index: Index, furthest: float = AMPLITUDES[0]) -> OutcomeResult | Exception:
        p, horizon, how = (
            self.points[index],
            self.options.horizon,
            {"tol": self.options.tol, "furthest": furthest},
        )
        return _result_or_error(
            lambda start: find_outcome(p, horizon, near=start, **how), self.starts[index]
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
        """Divide a cell, given by the indices of its edges, or fill it."""
        inside = list(product(range(rows[0], rows[1] + 1), range(columns[0], columns[1] + 1)))
        undecided = [index for index in inside if not self.trends[index]]
        if not undecided:
            return
        corners = [corner for corner in product(rows, columns) if not self.trends[corner]]
        for index in corners or (
            [] if any(index in self.results for index in undecided) else [_middle(undecided)]
        ):
            if index not in self.presumed:
                self.outcome(index)
        # Between slow growth and separation there may be faster growth, still without separation.
        # If all corners show only that, stripes of separation may lie between them: these cells are
        # divided once more.
        outcomes = {self.outcome(index) for index in undecided if index in self.results}
        outcomes |= {self.presumed[corner] for corner in corners if corner not in self.results}
        outcomes |= {
            self.trends[index] for index in inside if self.trends[index] is Outcome.GROWING
        }
        halves = [_halves(*edges) for edges in (rows, columns)]
        side = max(rows[1] - rows[0], columns[1] - columns[0])
        most = max(1, self.options.initial_cell_size // 2)
        if len(outcomes) == 1 and outcomes <= GROWN and 1 < side <= most:
            # late separations depend on rounding: all corners may miss them by chance
            outcomes.add(self.outcome(_middle(undecided)))
        if len(outcomes) == 1 and (not outcomes <= GROWN or side <= most):
            self.filled |= {index: next(iter(outcomes)) for index in undecided}
        elif len(halves[0]) * len(halves[1]) > 1:
            if side <= 2:
                self._presume(rows, columns)
            for i, j in product(*halves):
                self._refine(i, j)

    def _presume(self, rows: Index, columns: Index) -> None:
        """Presume that an edge of a small cell has the outcome of its equal corners; a cell beside
        it may differ."""

        def outcome(corner: Index) -> str:
            return self.trends[corner] or (
                self.outcome(corner) if corner in self.results else self.presumed[corner]
            )

        edges = [((row, columns[0]), (row, columns[1])) for row in rows]
        edges += [((rows[0], column), (rows[1], column)) for column in columns]
        for first, two in edges:
            middle = (first[0] + two[0]) // 2, (first[1] + two[1]) // 2
            if (
                middle not in (first, two)
                and not self.trends[middle]
                and outcome(first) == outcome(two)
            ):
                self.presumed.setdefault(middle, outcome(first))

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
            row |= {
                "outcome": self._shown(index),
                "method": "multipliers" if self.trends[index] else "inferred",
            }
        else:
            method = "simulation" if result.simulated else "multipliers"
            row["method"] = "settled" if result.stage is Stage.STEADY else method
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
