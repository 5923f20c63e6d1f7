"""Motions near a cycle: whether they depart or approach as its multipliers predict.

That is tested over some seconds: near repetition alone proves nothing, because a torus shows it as
well.
"""

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array, ComplexArray
from disc_model.data.variables import CycleStatus, Outcome
from disc_model.parameters import Parameters
from disc_model.stability import thresholds
from disc_model.stability.cycle import (
    FloquetResult,
    cycle_from_rest,
    cycle_of,
    find_cycle,
    may_stick_and_slip,
    run_through_once,
)
from disc_model.stability.return_map import Orbit, Passage, ReturnMap, newton


@dataclass(frozen=True, eq=False)
class NearCycle:
    """A cycle and a motion near it, which is on the section of `map` at some time.

    cycle, x, jacobian : the cycle, its point (n,) on the section, the return map's Jacobian there
    follows_cycle : whether the motion follows the linear map near the cycle
    distance : (n,), of the motion from `x` on the section, at `time`
    time : s, of the motion; if it follows the linear map only after some waiting, the end of that
    """

    cycle: FloquetResult
    follows_cycle: bool
    map: ReturnMap
    x: Array
    distance: Array
    jacobian: Array
    time: float = 0.0

    @cached_property
    def leading(self) -> ComplexArray:
        """Left eigenvector of the leading multiplier, (n,)."""
        return left_vector(self.jacobian)

    @cached_property
    def right(self) -> ComplexArray:
        """Right eigenvector of the leading multiplier, (n,)."""
        return left_vector(self.jacobian.T)

    @property
    def leading_part(self) -> float:
        """Size of the leading multiplier's part of the distance; above zero, for its logarithm."""
        part = float(abs(self.leading @ self.distance)) / float(abs(self.leading @ self.right))
        return max(part, sys.float_info.min)

    @property
    def kind(self) -> Outcome:
        """Outcome of a motion on the cycle: stick-slip if the cycle is that of the static start, or near
        it."""
        if self.cycle.separations:
            return Outcome.SEPARATING
        start = self.map.first_release
        if start.reached:
            apart = float(np.linalg.norm(self.x - start.x))
            if apart <= thresholds.NEAR * self.map.deflection:
                return Outcome.STICK_SLIP
        cycle = find_cycle(self.cycle.parameters)
        same_period = math.isclose(cycle.period, self.cycle.period, rel_tol=thresholds.ARRIVED)
        if same_period and cycle.releases == self.cycle.releases:
            return Outcome.STICK_SLIP
        return Outcome.OTHER_CYCLE

    @property
    def lingers(self) -> bool:
        """Whether the motion stays near an unstable cycle: over a period it hardly moves."""
        still = thresholds.LINGERS * self.map.deflection
        return not self.cycle.stable and self.advance(self.x + self.distance, 1).residual <= still

    def advance(self, x: Array, periods: int, *, coarse: bool = True) -> Orbit:
        """The motion from a point of the section over some periods of the cycle."""
        n = periods * self.cycle.releases
        separates = self.cycle.separations > 0
        return self.map.evaluate(
            x, releases=n, tangent=False, may_separate=separates, coarse=coarse
        )

    def orbits(
        self, x: Array, times: Sequence[float], coarse: bool = True
    ) -> Iterator[tuple[int, Orbit]]:
        """The motion from a point of the section to about these times (s): periods since the last,
        and the orbit."""
        done = 0
        for i, time in enumerate(times, 1):
            count = max(i, round(time / self.cycle.period))
            orbit = self.advance(x, count - done, coarse=coarse)
            yield count - done, orbit
            x = orbit.end
            done = count

    def follows_multipliers(self, x: Array) -> bool:
        """Whether the motion at a point of the section departs or approaches as the multipliers
        predict. On a section of a single point it is on the cycle."""
        if not len(x):
            return True
        return any(self._is_linear(x - self.x, times) for times in thresholds.TEST_TIMES)

    def stays_linear_until(self, horizon: float) -> bool:
        """Whether a motion that leaves an unstable cycle is still near it at the horizon (s), as
        the linear map predicts."""
        periods = self.periods_left(horizon)
        near = thresholds.NEAR * self.map.deflection
        # the leading part alone excludes most motions
        growth = periods * math.log(abs(self.cycle.multipliers[0]))
        grown = math.log(self.leading_part) + growth
        if not grown <= math.log(2 * near):
            return False
        distance = np.linalg.matrix_power(self.jacobian, periods) @ self.distance
        if not np.linalg.norm(distance) <= near:
            return False
        excess = self._excess_rate(distance)
        if excess is not None and abs(excess) <= thresholds.LARGEST_OUTSIDE:
            return True
        return self._is_linear(distance, thresholds.TEST_TIMES[0])

    def extrapolate(self, latest: float) -> "Departure | None":
        """Where a motion that slowly leaves an unstable cycle comes to as long as the linear map
        describes it, no later than at a time (s); None if it leaves faster, or is there already.

        The growth rate's excess over the leading multiplier's is measured at larger and larger
        distances, as the motion might settle on a torus at any of them. It rises with the square of
        the distance, so that half of it has come together on the way.
        """
        cycle = self.cycle
        if cycle.growth_rate > thresholds.SLOW_DEPARTURE:
            return None
        growth = math.log(abs(cycle.multipliers[0]))
        # the test after it ends within `NEAR`
        tested = thresholds.TEST_TIMES[-1][-1]
        factor = math.exp(cycle.growth_rate * tested)
        last = self.periods_left(latest)
        departure: Departure | None = None
        for share in thresholds.DEPARTURES:
            size = share * thresholds.NEAR / factor * self.map.deflection
            periods = min(math.floor(math.log(size / self.leading_part) / growth), last)
            if periods <= 0:
                continue
            distance = np.linalg.matrix_power(self.jacobian, periods) @ self.distance
            if self._share_outside(distance) > thresholds.LARGEST_OUTSIDE:
                continue  # parts of other multipliers have not decayed yet
            if not np.linalg.norm(distance) <= thresholds.NEAR * self.map.deflection:
                break
            excess = self._excess_rate(distance)
            if excess is None or abs(excess) > thresholds.LARGEST_EXCESS:
                break
            time = self.time + periods * cycle.period
            gained = excess * tested / (factor**2 - 1)
            departure = Departure(self.x + distance, time - gained, periods)
            if periods == last:
                break
        return departure

    def periods_left(self, horizon: float) -> int:
        """Periods of the cycle from `time` to the horizon (s)."""
        return max(0, math.ceil((horizon - self.time) / self.cycle.period))

    @np.errstate(over="ignore", invalid="ignore")  # powers of a strongly unstable cycle's Jacobian
    def _is_linear(self, distance: Array, times: tuple[float, float]) -> bool:
        """Whether the motion at that distance departs from the cycle, or approaches it, as its
        multipliers predict."""
        cycle = self.cycle
        deflection = self.map.deflection
        least = 0.0
        if cycle.stable:
            least = thresholds.ARRIVED * deflection
        # the errors of coarse orbits would matter at a smaller distance
        coarse = bool(np.linalg.norm(distance) > thresholds.SAME_POINT * deflection)
        expected = distance
        parts = list[float]()
        periods = 0
        for periods, orbit in self.orbits(self.x + distance, times, coarse):
            expected = np.linalg.matrix_power(self.jacobian, periods) @ expected
            error = float(np.linalg.norm(orbit.end - self.x - expected))
            largest = max(thresholds.LARGEST_ERROR * float(np.linalg.norm(expected)), least)
            if not (orbit.returned and error <= largest):
                return False
            parts.append(float(abs(self.leading @ (orbit.end - self.x))))
        return grows_at_rate(parts, periods * cycle.period, cycle.growth_rate, least)

    def _excess_rate(self, distance: Array) -> float | None:
        """Relative excess of the growth rate over the leading multiplier's; None unless the motion
        departs. Its phase, which drifts with the amplitude long before the growth rate does and
        matters only near borders, is ignored."""
        part = self.leading @ distance
        count = 0
        before = float(abs(part))
        for periods, orbit in self.orbits(self.x + distance, thresholds.TEST_TIMES[-1]):
            if not orbit.returned:
                return None
            apart = orbit.end - self.x
            count += periods
            part = self.leading @ apart
            if not self._share_outside(apart) <= thresholds.LARGEST_OUTSIDE:
                return None
        rate = math.log(abs(part) / before) / (count * self.cycle.period)
        return float(rate / self.cycle.growth_rate - 1)

    def _share_outside(self, distance: Array) -> float:
        """Share of a distance from the cycle that lies outside the leading multiplier's
        eigenspace."""
        right = self.right / (self.leading @ self.right)
        is_real = self.cycle.multipliers[0].imag == 0
        eigenspace = right if is_real else 2 * right  # with that of the conjugate multiplier
        within = np.real((self.leading @ distance) * eigenspace)
        return float(np.linalg.norm(distance - within) / np.linalg.norm(distance))


def cycle_of_static_start(p: Parameters) -> NearCycle | FloquetResult:
    """The cycle near the static start, and whether the start follows it; without a cycle, the
    result of the search."""
    if not may_stick_and_slip(p):
        return find_cycle(p)
    map_ = ReturnMap(p)
    cycle = cycle_from_rest(map_)
    if cycle.status is not CycleStatus.OK:
        return cycle
    return _relate(map_, cycle, map_.first_release)


class Departure(NamedTuple):
    """Where a motion that leaves an unstable cycle comes to: a point of the section, the time (s),
    and the number of periods since it was at the cycle."""

    x: Array
    time: float
    periods: int


class CloseReturn(NamedTuple):
    """The return of a motion to the section at which it repeats best: its change since a release,
    over the static deflection, and the number of releases between them."""

    change: float
    releases: int


def find_cycle_near(
    map_: ReturnMap,
    release: Passage,
    close_return: CloseReturn | None,
    unstable: Sequence[float] = (),
) -> NearCycle | None:
    """The cycle near a motion at one of its releases, and whether the motion follows it. If the
    cycle is unstable, tests for that begin at the times `unstable`, s after the release."""
    if close_return is None or not close_return.change <= thresholds.NEAR / 2:
        return None
    orbit = newton(map_, release.x, releases=close_return.releases, may_separate=map_.patient)
    if orbit is None:
        return None
    if np.linalg.norm(orbit.start - release.x) > thresholds.NEAR * map_.deflection:
        return None
    cycle = cycle_of(map_, run_through_once(map_, orbit))
    waits = thresholds.WAITS if cycle.stable else unstable
    return _relate(map_, cycle, release, waits)


def find_close_return(
    map_: ReturnMap, x: Array, most: int = thresholds.LARGEST_PERIOD
) -> CloseReturn | None:
    """The first of the next returns of a motion from a release at `x`, at most `most`, that changes
    about least; None if the motion does not return to the section at all."""
    later = map_.returns(x, most, may_separate=map_.patient, coarse=True)
    changes = [float(np.linalg.norm(point - x) / map_.deflection) for point in later]
    least = min(changes, default=math.nan)
    for i, change in enumerate(changes, 1):
        if change <= 2 * least:
            return CloseReturn(change, i)
    return None


def _relate(
    map_: ReturnMap,
    cycle: FloquetResult,
    release: Passage,
    waits: Sequence[float] = thresholds.WAITS,
) -> NearCycle:
    """The motion at one of its releases in relation to a cycle; tests whether it follows the cycle
    begin at the times `waits`, s after the release."""
    assert cycle.state is not None
    fixed_point = map_.point(cycle.state)
    orbit = map_.evaluate(fixed_point, releases=cycle.releases, may_separate=cycle.separations > 0)
    near = NearCycle(
        cycle, False, map_, fixed_point, release.x - fixed_point, orbit.jacobian, release.time
    )
    if not release.reached:
        return near
    x = release.x
    waited = 0.0
    for wait in waits:
        if wait > waited:
            orbit = near.advance(x, max(1, round((wait - waited) / cycle.period)), coarse=False)
            if not orbit.returned:
                break
            x = orbit.end
            waited += orbit.period
        if near.follows_multipliers(x):
            time = release.time + waited
            return replace(near, follows_cycle=True, distance=x - fixed_point, time=time)
    return near


def grows_at_rate(parts: Sequence[float], time: float, rate: float, least: float) -> bool:
    """Whether the leading part grows at a rate (1/s) between two times, or has fallen to
    `least`."""
    if not min(parts) > 0 or parts[1] <= least:
        return parts[1] <= least
    error = math.log(parts[1] / parts[0]) / time - rate
    return abs(error) <= thresholds.LARGEST_RATE_ERROR * abs(rate)


def left_vector(jacobian: Array, size: Callable[[ComplexArray], Array] = np.abs) -> ComplexArray:
    """Left eigenvector of the eigenvalue of most `size`: its product with a distance is the
    eigenvalue's part of it."""
    values, vectors = np.linalg.eig(jacobian.T)
    return np.asarray(vectors[:, np.argmax(size(values))], dtype=complex)
