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
from disc_model.errors import Fault, ParameterError
from disc_model.fitting.arguments import Interval
from disc_model.fitting.combinations import combinations_of
from disc_model.fitting.descent import decrease_over, free_of_limits, lower_point, next_step
from disc_model.fitting.determination import indistinct_names, names_alike, sensitivity_of
from disc_model.fitting.nearness import (
    HALVINGS,
    cost_that_is_as_good,
    other_directions,
    undetermined_directions,
)
from disc_model.fitting.problem import Problem
from disc_model.fitting.result import Combined, Gap

TOLERANCE = 1e-10
"""Relative change of parameters, cost and gradient at which the search ends."""
UNFINISHED = 1.0
"""Decrease of chi squared by one more step, if predictions were linear, from which the search has not
ended at a minimum: up to there the end is within a standard deviation of it."""
RATIO = 1e-3
"""Such a decrease over chi squared, and that from which an end is better than another."""
SMALL = 0.01
"""Such a decrease up to which the end is a minimum without further steps."""
ROUNDS = 5
"""Number of times that a search is continued."""
FAR, FAR_RATIO = 10.0, 0.01
"""Such a decrease from which limits hold a search back, and over chi squared."""
UNCHANGED = "No direction is determined."
"""Message of a search that leaves all parameters at the start."""
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

        return optimize.least_squares(
            self.deviations,
            x,
            jac=self.slopes,
            bounds=self._scaled(limits),
            xtol=TOLERANCE,
            ftol=TOLERANCE,
            gtol=TOLERANCE,
            max_nfev=steps,
        )

    def _scaled(self, limits: Mapping[str, Interval]) -> Array:
        """Return the lower and upper limits of the scaled parameters, (2, n)."""
        ends = [limits.get(name, (-np.inf, np.inf)) for name in self.problem.names]
        return np.array(ends).T / self.problem.scale

    def to_minimum(self, end: Any, limits: Mapping[str, Interval]) -> tuple[Any, bool]:
        """Return the end of a search that is continued where it has not ended at a minimum, and whether
        it has ended at one then."""
        low, high = self._scaled(limits)
        for _ in range(ROUNDS):
            if self.fall(end, limits) <= SMALL:
                return end, True
            free = free_of_limits(end, low, high)
            x = lower_point(end, free, low, high, self.deviations)
            if x is None:
                return end, True
            try:
                end = self.run(x, limits, PATIENCE)
            except ParameterError:
                return end, False
        return end, self.fall(end, limits) <= UNFINISHED

    def fall(self, end: Any, limits: Mapping[str, Interval]) -> float:
        """Return how much smaller chi squared would be than at an end if predictions were linear."""
        low, high = self._scaled(limits)
        step = next_step(end, free_of_limits(end, low, high))
        return decrease_over(end, step)

    def is_held_back(self, end: Any, limits: Mapping[str, Interval]) -> bool:
        """Whether a search would have gone on by far if limits were not in the way."""
        return self.fall(end, limits) > max(FAR, FAR_RATIO * 2 * end.cost)

    def near_start(
        self, start: Array, end: Any, names: Sequence[str], limits: Mapping[str, Interval]
    ) -> Any:
        """Return the end of a search that is as good and nearest to the start in directions of parameters
        that are not determined: there the way from the given end back to the start is halved.

        start : scaled parameters
        """
        assert self.first is not None
        places = [self.problem.names.index(name) for name in names]
        unknown = undetermined_directions(self.first, places)
        known = other_directions(unknown)
        enough = cost_that_is_as_good(end)
        found = self._end_along(start, known)
        if found and self._is_as_good(found, enough, limits):
            return found
        begin = found.x if found else start
        for _ in range(HALVINGS):
            middle = 0.5 * (begin + end.x)
            found = self._end_along(middle, known)
            if found and self._is_as_good(found, enough, limits):
                end = found
            else:
                begin = found.x if found else middle
        return end

    def _is_as_good(self, end: Any, enough: float, limits: Mapping[str, Interval]) -> bool:
        """Whether the end of a search lies within limits and has no larger cost than is enough."""
        return end.cost <= enough and self._is_within(end.x, limits)

    def _end_along(self, x: Array, directions: Array) -> Any:
        """Return the end of such a search as `_run_along` makes; None where measured quantities do not
        exist."""
        try:
            return self._run_along(x, directions)
        except ParameterError:
            return None

    def _run_along(self, x: Array, directions: Array) -> Any:
        """Return the end of a search from scaled parameters that changes them along some directions
        only, (n, k)."""
        from scipy import optimize

        if not np.isfinite(self.deviations(x)).all():
            rule = "cannot be computed there"
            raise ParameterError(Fault(("measured",), "", rule))
        if not directions.size:
            end = optimize.OptimizeResult(x=x, success=True, message=UNCHANGED, status=1)
        else:
            end = optimize.least_squares(
                lambda moved: self.deviations(x + directions @ moved),
                np.zeros(directions.shape[1]),
                jac=lambda moved: self.slopes(x + directions @ moved) @ directions,
                xtol=TOLERANCE,
                ftol=TOLERANCE,
                gtol=TOLERANCE,
            )
            end.x = x + directions @ end.x
        end.fun = self.deviations(end.x)
        end.jac = self.slopes(end.x)
        end.cost = 0.5 * float(end.fun @ end.fun)
        end.active_mask = np.zeros(len(end.x), int)
        return end

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

    def alike(self, end: Any) -> tuple[str, ...]:
        """Return the names of parameters that act alike by derivatives alone, as in front of a gap, beyond
        which nothing can be computed."""
        assert self.first is not None
        return names_alike(self.problem.names, end, self.first)

    def covariance(self, end: Any) -> Array:
        """Return the covariance of the parameters at an end, (n, n)."""
        spread = self._spread(end.jac)
        return np.asarray(spread @ spread.T)

    def changes(self, end: Any, names: Sequence[str]) -> Array:
        """Return how all parameters change along the interval of each, in columns, (n, n): as the covariance
        says, but along no direction of parameters that are not determined.

        names : of these
        """
        covariance = self.covariance(end)
        if names:
            assert self.first is not None
            places = [self.problem.names.index(name) for name in names]
            known = other_directions(undetermined_directions(self.first, places))
            if not known.size:
                return np.zeros_like(covariance)
            spread = known @ sensitivity_of(end.jac @ known).inverse
            spread = spread * self.problem.scale[:, None]
            covariance = np.asarray(spread @ spread.T)
        variances = np.diag(covariance)
        return np.asarray(covariance / np.where(variances > 0, variances, 1.0))

    def combinations(self, ends: Sequence[Any], names: Sequence[str]) -> dict[str, Combined]:
        """Return what is known of parameters that are not told apart, by its formula: by derivatives at
        ends of searches, of which the first has the values, or at the start, whichever gives the
        simplest formula of several parameters, since predictions may have kinks where others are taken."""
        assert self.first is not None
        values = ends[0].x * self.problem.scale
        found = []
        for jacobian in (*(end.jac for end in ends), self.first):
            spread = self._spread(jacobian)
            known = combinations_of(self.problem.names, names, values, spread)
            if known:
                found.append(known)
        return min(found, key=lambda known: _complexity(known, names), default={})

    def _spread(self, jacobian: Array) -> Array:
        """Return what has with its transpose the covariance of the parameters as its product, (n, n)."""
        return np.asarray(sensitivity_of(jacobian).inverse * self.problem.scale[:, None])

    def gap_at(self, end: Any) -> Gap | None:
        """Return the gap in front of which a search has ended, None at a minimum."""
        step = next_step(end, end.active_mask == 0)
        if decrease_over(end, step) <= max(UNFINISHED, RATIO * 2 * end.cost):
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
            if not (self._is_within(x, limits) and np.isfinite(self.deviations(x)).all()):
                continue
            try:
                found = self.run(x, limits, PATIENCE)
            except ParameterError:
                continue
            if found.cost < (1 - RATIO) * end.cost:
                return found
        return None

    def _is_within(self, x: Array, limits: Mapping[str, Interval]) -> bool:
        """Whether scaled parameters lie within limits."""
        low, high = self._scaled(limits)
        return bool(((low < x) & (x < high)).all())


def _complexity(known: Mapping[str, Combined], names: Sequence[str]) -> tuple[bool, int]:
    """How little the formulas of known combinations say: whether one is of a single parameter, which is not
    told apart from others, and how long they are."""
    is_alone = any(name in known for name in names)
    return is_alone, len("".join(known))
