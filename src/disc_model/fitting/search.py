"""The search for the least chi squared, and gaps in front of which it stops.

A measured quantity may not exist at some values of the parameters, such as the period where a case has no cycle. Steps
into such a gap are shortened until the search stops in front of it, as if it had found a minimum. It then goes on from
where the other measurements lead, if all exist there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from disc_model.arrays import Array
from disc_model.errors import ParameterError
from disc_model.fitting.arguments import Interval
from disc_model.fitting.combinations import combinations_of
from disc_model.fitting.determination import indistinct_names, sensitivity_of
from disc_model.fitting.problem import Problem
from disc_model.fitting.result import Combined, Gap

TOLERANCE = 1e-10
"""Relative change of parameters, cost and gradient at which the search ends."""
UNFINISHED = 1.0
"""Decrease of chi squared by one more step, if predictions were linear, from which the search has not
ended at a minimum: up to there the end is within a standard deviation of it."""
RATIO = 1e-3
"""Such a decrease over chi squared, and that from which an end is better than another."""
PARTS = tuple(0.5**i for i in range(15))
"""Parts of that step at which measured quantities may be missing."""
BEYOND = (1.0, 2.0, 4.0)
"""Steps beyond a gap, over that to where the other measurements lead."""
PATIENCE = 30
"""Number of steps after which a search that is still under way asks whether it creeps along a gap."""
OUT_OF_STEPS = 0
"""Status of a search that has used up its steps."""
JUMPS = 3
"""Largest number of gaps that a search passes."""


class Search:
    """The search over scaled parameters, which are those of a problem over its scale.

    Attributes
    ----------
    problem : predictions over the parameters
    first : Jacobian of the weighted deviations where the first search began, (m, n)
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.first: Array | None = None
        self._values = np.array([each.value for each in problem.measurements])
        self._weights = 1 / np.array([each.uncertainty for each in problem.measurements])

    def deviations(self, x: Array) -> Array:
        """Return the weighted deviations, (m,); nan where a measured quantity does not exist."""
        computed = self.problem.trial(x * self.problem.scale)
        return np.asarray((computed - self._values) * self._weights)

    def slopes(self, x: Array) -> Array:
        """Return the derivatives of the weighted deviations, (m, n)."""
        jacobian = self.problem.jacobian(x * self.problem.scale)
        jacobian = np.asarray(jacobian * self._weights[:, None] * self.problem.scale)
        if self.first is None:
            self.first = jacobian
        return jacobian

    def run(self, x: Array, limits: Mapping[str, Interval], steps: int | None = None) -> Any:
        """Return the end of a search from scaled parameters, as scipy describes it, after so many steps
        at most, which scipy chooses for None."""
        from scipy import optimize

        ends = [limits.get(name, (-np.inf, np.inf)) for name in self.problem.names]
        return optimize.least_squares(
            self.deviations,
            x,
            jac=self.slopes,
            bounds=np.array(ends).T / self.problem.scale,
            xtol=TOLERANCE,
            ftol=TOLERANCE,
            gtol=TOLERANCE,
            max_nfev=steps,
        )

    def run_across_gaps(self, x: Array, limits: Mapping[str, Interval]) -> tuple[Any, Gap | None]:
        """Return the end of a search that goes on beyond gaps, and the one at which it has stopped."""
        first = self.run(x, limits, PATIENCE)
        end = self._past_gaps(first, limits)
        if end.status == OUT_OF_STEPS:
            # what has passed no gap begins anew: a search in one go takes other steps
            begin = x if end is first else end.x
            end = self._past_gaps(self.run(begin, limits), limits)
        return end, self.gap_at(end)

    def _past_gaps(self, end: Any, limits: Mapping[str, Interval]) -> Any:
        """Return the end of a search beyond the gaps that it can pass."""
        for _ in range(JUMPS):
            gap = self.gap_at(end)
            better = self._beyond(end, gap, limits) if gap else None
            if better is None:
                break
            end = better
        return end

    def indistinct(self, end: Any) -> tuple[str, ...]:
        """Return the names of parameters that the measurements do not determine at an end."""
        assert self.first is not None
        return indistinct_names(self.problem, end, self.first, self.deviations)

    def covariance(self, end: Any) -> Array:
        """Return the covariance of the parameters at an end, (n, n)."""
        spread = self._spread(end)
        return np.asarray(spread @ spread.T)

    def combinations(self, end: Any, names: Sequence[str]) -> dict[str, Combined]:
        """Return what is known at an end of parameters that are not told apart, by its formula."""
        values = end.x * self.problem.scale
        return combinations_of(self.problem.names, names, values, self._spread(end))

    def _spread(self, end: Any) -> Array:
        """Return what has with its transpose the covariance of the parameters as its product, (n, n)."""
        return np.asarray(sensitivity_of(end.jac).inverse * self.problem.scale[:, None])

    def gap_at(self, end: Any) -> Gap | None:
        """Return the gap in front of which a search has ended, None at a minimum."""
        step = _next_step(end)
        now = float(end.fun @ end.fun)
        linear = end.fun + end.jac @ step
        decrease = now - float(linear @ linear)
        if decrease <= max(UNFINISHED, RATIO * now):
            return None
        scale = self.problem.scale
        for part in reversed(PARTS):
            values = (end.x + part * step) * scale
            missing = self.problem.missing(values)
            if missing:
                place = dict(zip(self.problem.names, values.tolist(), strict=True))
                return Gap(place, missing)
        return None

    def _beyond(self, end: Any, gap: Gap, limits: Mapping[str, Interval]) -> Any:
        """Return a better end of a search from beyond a gap; None where none is found."""
        others = self.problem.without(gap.measurements)
        if len(others.measurements) < len(others.names):
            return None
        try:
            led = Search(others).run(end.x, limits, PATIENCE).x
        except ParameterError:
            return None
        for length in BEYOND:
            x = end.x + length * (led - end.x)
            if not self._can_start(x, limits):
                continue
            try:
                found = self.run(x, limits, PATIENCE)
            except ParameterError:
                continue
            if found.cost < (1 - RATIO) * end.cost:
                return found
        return None

    def _can_start(self, x: Array, limits: Mapping[str, Interval]) -> bool:
        """Whether scaled parameters lie within limits, and all measured quantities exist there."""
        for name, value in zip(self.problem.names, x * self.problem.scale, strict=True):
            low, high = limits.get(name, (-np.inf, np.inf))
            if not low < value < high:
                return False
        return bool(np.isfinite(self.deviations(x)).all())


def _next_step(end: Any) -> Array:
    """Return the step of scaled parameters from the end of a search to where chi squared would be
    least if predictions were linear, (n,); 0 for those at a limit."""
    free = end.active_mask == 0
    step = np.zeros(len(end.x))
    step[free] = -np.linalg.lstsq(end.jac[:, free], end.fun, rcond=None)[0]
    return step
