"""What a motion comes to: a cycle's multipliers or the eigenvalues of steady sliding prove it where the
motion follows the linear one near them, otherwise it is simulated.

That is tested over some seconds: near repetition alone proves nothing, because a torus shows it as
well. Distances are on the section of the return map, relative to the norm of the static deflection.
docs/method.md, Outcomes, describes the search.
"""

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from scipy.linalg import expm

from disc_model.arrays import Array, ComplexArray
from disc_model.data.variables import CycleStatus, Outcome
from disc_model.disc.plate import mode_arrays
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability.cycle import (
    FloquetResult,
    cycle_from_rest,
    cycle_of,
    find_cycle,
    may_stick_and_slip,
    never_pulls,
    run_through_once,
)
from disc_model.stability.return_map import Orbit, Passage, ReturnMap, newton
from disc_model.stability.segments import (
    TIME,
    Segment,
    duration_of,
    late_window,
    segment_of,
    stick_share,
)
from disc_model.stability.sliding import energy_weights, rows_of_state, steady_sliding

FIRST_LEG = 5.0  # s, before a motion is examined: dozens of cycles, and some turns of the disc
LONGEST_LEG = 160.0  # s, of later legs: the tests after each cost little beside so much simulation
NEAR = 0.1  # distance from a cycle within which a motion counts as near it: none is linear beyond
SAME_POINT = 1e-4  # nearer fixed points are the same: known cycles differ by 0.1
ARRIVED = 1e-8  # a motion as near to a stable cycle is on it: 10,000 times the rounding
# errors of a long simulation, over its tolerance, in weakly damped modes: 12 were seen in the
# paper's, 7,000 in modes of 2 kHz that decay at 0.4/s
ERROR_OF_TOL = 10_000
# s, at which a motion is compared with the linear one; if the first test fails, the longer one
# resolves slower rates
TEST_TIMES = ((0.3, 1.2), (1.5, 6.0))
TEST_TOL = 1e-13  # of simulations in these tests, whose errors must be below `ARRIVED`
# s, at which tests begin: near a resonance the strongly damped modes must decay first
WAITS = (0.0, 1.5, 6.0, 15.0)
LARGEST_ERROR = 0.1  # of the linear motion, relative to it: second order in the distance
LARGEST_RATE_ERROR = 0.5  # of the growth rate, relative to it: it decides the sign of the rate
LARGEST_PERIOD = 8  # releases in a period of cycles that are sought, to limit the time
LINGERS = 1e-3  # largest change over a period of a motion that stays near an unstable cycle
RISE = 1.5  # factor between changes of periods that shows growth
LARGEST_OUTSIDE = 0.25  # share of a departure outside the leading eigenspace
SLOW_DEPARTURE = 0.2  # growth rate, 1/s, up to which a departure is extrapolated
# shares of `NEAR` up to which it is, as long as its growth rate differs from the multiplier's by no
# more than this, relative
DEPARTURES = (0.1, 0.25, 0.5, 1.0)
LARGEST_EXCESS = 0.05
# relative difference of a separation from a time with which it is compared up to which it is simulated
# from the start: 98 of 100 extrapolated separations come within it
BORDER = 0.01


# ---- Motions near a cycle or near steady sliding


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
        """Left eigenvector of the leading multiplier, (n,): its product with a distance is the
        multiplier's part of it."""
        return _leading(self.jacobian.T, np.abs)

    @cached_property
    def right(self) -> ComplexArray:
        """Right eigenvector of the leading multiplier, (n,), whose product with `leading` is one."""
        right = _leading(self.jacobian, np.abs)
        return np.asarray(right / (self.leading @ right), dtype=complex)

    @property
    def kind(self) -> Outcome:
        """Outcome of a motion on the cycle: stick-slip if the cycle is that of the static start, or
        near it."""
        if self.cycle.separations:
            return Outcome.SEPARATING
        start = self.map.first_release
        if start.reached and self.map.apart(start.x, self.x) <= NEAR:
            return Outcome.STICK_SLIP
        cycle = find_cycle(self.cycle.parameters)
        same_period = math.isclose(cycle.period, self.cycle.period, rel_tol=ARRIVED)
        is_same = same_period and cycle.releases == self.cycle.releases
        if is_same:
            return Outcome.STICK_SLIP
        return Outcome.OTHER_CYCLE

    @property
    def lingers(self) -> bool:
        """Whether the motion stays near an unstable cycle: over a period it hardly moves, as it
        would on a torus."""
        still = LINGERS * self.map.deflection
        return not self.cycle.stable and self.advance(self.x + self.distance, 1).residual <= still

    @np.errstate(over="ignore", invalid="ignore")  # powers of a strongly unstable cycle's Jacobian
    def follows_multipliers(self, x: Array) -> bool:
        """Whether the motion at a point of the section departs or approaches as the multipliers
        predict. On a section of a single point it is on the cycle."""
        least = 0.0
        if self.cycle.stable:
            least = ARRIVED * self.map.deflection
        rate = self.cycle.growth_rate
        return not len(x) or any(
            _is_as_expected(self._motion(x - self.x, times), self.leading, rate, least)
            for times in TEST_TIMES
        )

    def extrapolate(self, latest: float) -> tuple[Array, float] | None:
        """Where a motion that slowly leaves an unstable cycle comes to as long as the linear map
        describes it, no later than at a time (s): point of the section and time; None if it leaves
        faster, or is there already.

        The growth rate's excess over the leading multiplier's is measured at larger and larger
        distances, as the motion might settle on a torus at any of them. It rises with the square of
        the distance, so that half of it has come together on the way.
        """
        rate = self.cycle.growth_rate
        period = self.cycle.period
        if rate > SLOW_DEPARTURE:
            return None
        tested = TEST_TIMES[-1][-1]  # the test after it ends within `NEAR`
        factor = math.exp(rate * tested)
        last = max(0, math.ceil((latest - self.time) / period))
        part = float(abs(self.leading @ self.distance)) * float(np.linalg.norm(self.right))
        part = max(part, sys.float_info.min)  # for its logarithm
        farthest = NEAR * self.map.deflection
        reached = None
        for share in DEPARTURES:
            size = share * farthest / factor
            periods = min(math.floor(math.log(size / part) / (rate * period)), last)
            if periods <= 0:
                continue
            distance = np.linalg.matrix_power(self.jacobian, periods) @ self.distance
            if self._share_outside(distance) > LARGEST_OUTSIDE:
                continue  # parts of other multipliers have not decayed yet
            if np.linalg.norm(distance) > farthest:
                break
            excess = self._excess_rate(distance)
            if abs(excess) > LARGEST_EXCESS:
                break
            gained = excess * tested / (factor**2 - 1)
            reached = self.x + distance, self.time + periods * period - gained
        return reached

    def advance(self, x: Array, periods: int, *, coarse: bool = True) -> Orbit:
        """The motion from a point of the section over some periods of the cycle."""
        return self.map.evaluate(
            x, releases=periods * self.cycle.releases, tangent=False, coarse=coarse
        )

    def _excess_rate(self, distance: Array) -> float:
        """Relative excess of the growth rate over the leading multiplier's; infinite unless the
        motion departs along its eigenspace at both times of the test: after the later one alone
        another motion can come by it. Its phase, which drifts with the amplitude long before the
        growth rate does and matters only near borders, is ignored."""
        later = distance
        durations = []
        for later, _, duration in self._motion(distance, TEST_TIMES[-1]):
            durations.append(duration)
            if not self._share_outside(later) <= LARGEST_OUTSIDE:
                return math.inf
        if len(durations) < 2:
            return math.inf
        grown = math.log(abs(self.leading @ later) / abs(self.leading @ distance))
        return float(grown / sum(durations) / self.cycle.growth_rate - 1)

    def _share_outside(self, distance: Array) -> float:
        """Share of a distance from the cycle that lies outside the leading multiplier's
        eigenspace."""
        within = (self.leading @ distance) * self.right
        if self.cycle.multipliers[0].imag:
            within = 2 * within  # with that of the conjugate
        outside = np.linalg.norm(distance - within.real)
        return float(outside / np.linalg.norm(distance))

    def _motion(
        self, distance: Array, times: Sequence[float]
    ) -> Iterator[tuple[Array, Array, float]]:
        """The motion from a distance on, at about these times (s), as long as it returns: its distance,
        that of the linear motion, and the time since the last."""
        # the errors of coarse orbits would matter at a smaller distance
        coarse = bool(np.linalg.norm(distance) > SAME_POINT * self.map.deflection)
        x = self.x + distance
        expected = distance
        done = 0
        for i, time in enumerate(times, 1):
            count = max(i, round(time / self.cycle.period)) - done
            orbit = self.advance(x, count, coarse=coarse)
            if not orbit.returned:
                return
            x = orbit.end
            expected = np.linalg.matrix_power(self.jacobian, count) @ expected
            yield x - self.x, expected, count * self.cycle.period
            done += count


def _leading(matrix: Array, size: Callable[[ComplexArray], Array]) -> ComplexArray:
    """The right eigenvector of the eigenvalue of the largest size."""
    values, vectors = np.linalg.eig(matrix)
    return np.asarray(vectors[:, np.argmax(size(values))], dtype=complex)


def _is_as_expected(
    motion: Iterable[tuple[Array, Array, float]], leading: ComplexArray, rate: float, least: float
) -> bool:
    """Whether a motion is the linear one at two times, but for `LARGEST_ERROR` of it or for a distance
    `least`, and the leading part grows at a rate (1/s) between them, or has fallen to `least`.

    motion : distance, that of the linear motion, and time since the last (s)
    """
    parts = list[tuple[float, float]]()
    for apart, expected, duration in motion:
        largest = max(LARGEST_ERROR * float(np.linalg.norm(expected)), least)
        if not np.linalg.norm(apart - expected) <= largest:
            return False
        parts.append((float(abs(leading @ apart)), duration))
    if len(parts) < 2:
        return False
    (before, _), (after, duration) = parts
    if after <= least or before == 0:
        return after <= least
    return abs(math.log(after / before) / duration - rate) <= LARGEST_RATE_ERROR * abs(rate)


def cycle_of_static_start(p: Parameters) -> NearCycle | FloquetResult:
    """The cycle near the static start, and whether the start follows it; without a cycle, the
    result of the search."""
    if not may_stick_and_slip(p):
        return find_cycle(p)
    map_ = ReturnMap(p)
    cycle = cycle_from_rest(map_)
    if cycle.status is not CycleStatus.OK:
        return cycle
    return _relate(map_, cycle, map_.first_release, WAITS)


def find_cycle_near(
    map_: ReturnMap, release: Passage, change: float, releases: int, unstable: Sequence[float] = ()
) -> NearCycle | None:
    """The cycle near a motion that changes by so little over some releases, and whether the motion
    follows it. If the cycle is unstable, tests for that begin at the times `unstable`, s after the
    release."""
    if not change <= NEAR / 2:
        return None
    orbit = newton(map_, release.x, releases=releases)
    if orbit is None or map_.apart(orbit.start, release.x) > NEAR:
        return None
    cycle = cycle_of(map_, run_through_once(map_, orbit))
    return _relate(map_, cycle, release, WAITS if cycle.stable else unstable)


def close_return(map_: ReturnMap, x: Array, most: int = LARGEST_PERIOD) -> tuple[float, int]:
    """The first of the next returns of a motion from a release at `x`, at most `most`, that changes
    about least: change over the static deflection, and number of releases; nan and 0 if the motion
    does not return to the section at all."""
    later = map_.returns(x, most, coarse=True)
    changes = [map_.apart(point, x) for point in later]
    for i, change in enumerate(changes, 1):
        if change <= 2 * min(changes):
            return change, i
    return math.nan, 0


def _relate(
    map_: ReturnMap, cycle: FloquetResult, release: Passage, waits: Sequence[float]
) -> NearCycle:
    """The motion at one of its releases in relation to a cycle; tests whether it follows the cycle
    begin at the times `waits`, s after the release."""
    assert cycle.state is not None
    x = map_.point(cycle.state)
    orbit = map_.evaluate(x, releases=cycle.releases)
    near = NearCycle(cycle, False, map_, x, release.x - x, orbit.jacobian, release.time)
    moving = near
    for wait in waits if release.reached else ():
        periods = round((wait - (moving.time - release.time)) / cycle.period)
        if periods > 0:
            later = moving.advance(x + moving.distance, periods, coarse=False)
            if not later.returned:
                break
            time = moving.time + later.period
            moving = replace(moving, distance=later.end - x, time=time)
        if near.follows_multipliers(x + moving.distance):
            return replace(moving, follows_cycle=True)
    return near


_sliding = lru_cache(maxsize=1)(steady_sliding)  # needed at the end of each leg of a motion


def find_equilibrium(p: Parameters, leg: Result) -> Outcome | None:
    """At rest if the slider sticks for good, steady sliding if it is stable and the motion
    approaches it; None if neither is shown."""
    if stick_share(leg) == 1 and never_pulls(p):
        return Outcome.AT_REST
    if _sliding(p).stable and follows_sliding(p, leg.final_state):
        return Outcome.STEADY_SLIDING
    return None


def follows_sliding(p: Parameters, state: State) -> bool:
    """Whether a slipping motion approaches stable steady sliding, or departs from unstable steady
    sliding for some seconds or until it has grown by a factor of e, as the eigenvalues there predict.

    It is followed with `TEST_TOL`, because errors of coarser simulations keep it away: at 1e-10, by
    7e-7 of the static deflection on a disc whose modes of 2 kHz decay at 0.4/s.
    """
    sliding = _sliding(p)
    if state.phase != "slip" or not (sliding.stable or sliding.growing.size):
        return False
    modes = mode_arrays(p)
    scale = np.sqrt(energy_weights(p))  # by it the norm of rows is that of the energy
    jacobian = scale[:, None] * sliding.jacobian / scale
    static = p.N * float(np.linalg.norm(modes.psi / modes.omega))
    if static == 0:  # a rigid disc: the spring in the plane, bent up to the limit of friction
        static = p.mu_s * p.N / math.sqrt(p.k_p)
    times = TEST_TIMES[-1]
    arrived = ARRIVED * static
    farthest = NEAR * static
    if not sliding.stable:
        shorter = min(1.0, 1 / sliding.growth_rate / times[-1])
        times = (shorter * times[0], shorter * times[-1])
        arrived = 0.0
        farthest = math.inf

    def away(at: State) -> Array:
        return np.asarray(scale * (rows_of_state(p, at) - sliding.rows), dtype=float)

    def motion() -> Iterator[tuple[Array, Array, float]]:
        expected = away(state)
        before = 0.0
        for time in times:
            end = state.time + time
            run = simulate(p, end, tol=TEST_TOL, initial_state=state, events=False)
            if not run.status.complete or run.final_state.phase != "slip":
                return
            expected = expm(jacobian * (time - before)) @ expected
            yield away(run.final_state), expected, time - before
            before = time

    if not np.linalg.norm(away(state)) <= farthest:
        return False
    leading = _leading(jacobian.T, np.real)
    return _is_as_expected(motion(), leading, sliding.growth_rate, arrived)


# ---- The search for an outcome


@dataclass(frozen=True, eq=False)
class Attractor:
    """Outcome of motions on an attractor, and a segment of one; of a periodic one also period (s),
    releases in it, and points on the section over the static deflection, shape (releases, n)."""

    kind: Outcome
    segment: Segment
    period: float = np.nan
    releases: int = 0
    points: Array | None = None


@dataclass(eq=False)
class OutcomeResult:
    """The outcome of a motion; while it is sought, what is known so far.

    outcome : None if the simulation failed
    simulated, time : s, simulated time, 0 if multipliers decide; time at which the outcome was known
    near : the stable cycle that the motion approaches, or else the first unstable cycle from which it departs
    failed : the simulation that ended early
    changes : changes from one period to the next, over the static deflection
    extrapolated : whether the linear map has replaced the simulation of a slow departure; the first
        separation is then known within `BORDER` only
    """

    outcome: Outcome | None = None
    simulated: float = 0.0
    near: NearCycle | None = None
    attractor: Attractor | None = None
    first_separation: float = np.nan
    time: float = 0.0
    state: State | None = None
    failed: Result | None = None
    changes: list[float] = field(default_factory=list)
    extrapolated: bool = False
    segment: Segment | None = None

    @property
    def word(self) -> str:
        """The outcome as a word of datasets."""
        return self.outcome or "failed"

    @property
    def separates(self) -> bool:
        """Whether the motion loses contact again and again."""
        return self.attractor is not None and self.attractor.segment.separation_rate > 0

    @property
    def timed_separation(self) -> float:
        """Time of the first separation (s) where the whole motion was simulated; nan elsewhere."""
        if self.extrapolated:
            return np.nan
        return self.first_separation

    @property
    def status(self) -> Status:
        """How the last simulation ended."""
        if self.failed is None:
            return Status.OK
        return self.failed.status

    @property
    def message(self) -> str:
        """Why the simulation failed; empty if it did not."""
        if self.failed is None:
            return ""
        return self.failed.message


OPEN = (None, Outcome.SEPARATION, Outcome.GROWING, Outcome.UNDECIDED)
"""Outcomes of motions that have not come to a cycle or an equilibrium."""


def find_outcome(
    p: Parameters,
    horizon: float,
    *,
    tol: float = 1e-10,
    near: NearCycle | FloquetResult | None = None,
    start: State | None = None,
    early: bool = True,
    late: float = 0.0,
    compared_with: Sequence[float] = (),
) -> OutcomeResult:
    """Find the outcome of a motion within a horizon (s), or its separation if that comes first.

    near : result of `cycle_of_static_start`, if it is known
    start : initial state; None is the static start
    early : whether the search ends once the outcome is shown; otherwise the motion is followed to the horizon
    late : s, length of the segment before the horizon that is described
    compared_with : s, times with which the first separation is only to be compared

    Multipliers alone prove that a motion approaches a stable cycle. Any other motion is simulated
    from its start, in the same legs whatever the horizon, so that searches with the same `tol` find
    the same first separation.

    Where the first separation is only compared with some times, slow departures from unstable
    cycles are extrapolated instead. A motion whose separation comes near to one of those times, or
    that settles, is simulated from its start all the same: a small error decides to which attractor
    an irregular motion comes.
    """
    if near is None and early and start is None:
        near = cycle_of_static_start(p)
    followed = None
    map_ = None  # which takes as long as a return to the section ten times over
    if isinstance(near, NearCycle):
        map_ = near.map
        followed = near if near.follows_cycle else None
    elif may_stick_and_slip(p):
        map_ = ReturnMap(p)
    search = _Search(p, horizon, tol, early, late, map_)
    rough = search.run(start, followed, extrapolate=bool(compared_with))
    separation = rough.first_separation
    is_near = any(abs(separation - other) <= BORDER * other for other in compared_with)
    if not rough.extrapolated or (rough.outcome in OPEN and not is_near):
        return rough
    result = search.run(start, followed, extrapolate=False)
    result.simulated += rough.simulated
    return result


@dataclass(frozen=True, eq=False)
class _Search:
    """A search for the outcome of a motion; arguments as in `find_outcome`, and the return map of the
    case, None if it has no stick-slip."""

    p: Parameters
    horizon: float
    tol: float
    early: bool
    late: float
    map: ReturnMap | None

    def run(
        self, start: State | None, cycle: NearCycle | None, *, extrapolate: bool
    ) -> OutcomeResult:
        """Follow the motion, which may follow a cycle from its first release on, until it settles or
        loses contact, or to the horizon."""
        result = OutcomeResult(state=start)
        departs = False  # from something unstable
        leg = FIRST_LEG
        end = self.horizon
        while True:
            if cycle is not None:
                if cycle.cycle.stable:  # on which it is for good
                    return replace(result, near=cycle, outcome=cycle.kind, time=cycle.time)
                result.near = result.near or cycle
                departs = True
                if extrapolate and self._extrapolate(result, cycle):
                    # nothing is to be seen before the departure has grown by a factor of e
                    leg = min(max(leg, 1 / cycle.cycle.growth_rate), LONGEST_LEG)
                    end = (1 + BORDER) * self.horizon
            if result.time >= end:
                grows = departs or growing(result.changes)
                result.outcome = Outcome.GROWING if grows else Outcome.UNDECIDED
                return result

            run = self._simulate(result, leg, end)
            examined = self.early or result.time >= end
            if self._ends_with(result, run, examined):
                return result
            if examined and not departs and slips_on(run):
                departs = follows_sliding(self.p, run.final_state)
            # a cycle that it follows from here on
            cycle = self._cycle_at(result, run.final_state, examined)
            leg = min(2 * leg, LONGEST_LEG)

    def _ends_with(self, result: OutcomeResult, run: Result, examined: bool) -> bool:
        """Whether the search ends with a leg: by separation, failure, rest or steady sliding."""
        if run.status is Status.STOPPED:
            result.outcome = Outcome.SEPARATION
            result.first_separation = run.first_separation
            return True
        if not run.status.complete:
            result.failed = run
            return True
        if examined and (calm := find_equilibrium(self.p, run)):
            result.outcome = calm
            result.near = None
            return True
        return False

    def _extrapolate(self, result: OutcomeResult, near: NearCycle) -> bool:
        """Go on from where a slow departure ceases to be linear; whether that is later."""
        departure = near.extrapolate(self.horizon)
        if departure is None or departure[1] <= result.time:
            return False
        x, result.time = departure
        result.state = near.map.state(x).replace(time=result.time)
        result.extrapolated = True
        result.changes.append(close_return(near.map, x)[0])
        return True

    def _simulate(self, result: OutcomeResult, leg: float, end: float) -> Result:
        """Simulate a leg to its end or the first separation; the segment to be described is a leg
        of its own."""
        mark = end
        if result.time < end - self.late:
            mark = end - self.late
        stop = min(result.time + leg, mark)
        described = bool(self.late) and stop == end
        run = simulate(
            self.p,
            stop,
            late_window(result.time, stop) if described else {},
            tol=self.tol,
            initial_state=result.state,
            stop_at="first_separation",
        )
        if described and run.status.complete:
            result.segment = segment_of(run)
        result.simulated += run.final_state.time - result.time
        result.state = run.final_state
        result.time = run.final_state.time
        return run

    def _cycle_at(self, result: OutcomeResult, state: State, examined: bool) -> NearCycle | None:
        """The cycle that the motion follows from its next release on; None if there is none, or
        while it departs from another one."""
        if self.map is None:
            return None
        release = self.map.next_release(state)
        if not release.reached:
            return None
        change, releases = close_return(self.map, release.x)
        result.changes.append(change)
        known = [each for each in result.changes if not math.isnan(each)]
        # a motion that comes to a cycle changes less and less, down to errors of the simulation
        least = max(ARRIVED, ERROR_OF_TOL * self.tol, *known[-2:][:1])
        departs = result.near is not None and bool(known) and known[-1] > least
        if departs or not examined:
            return None
        waits = WAITS if result.near is None else WAITS[:1]
        near = find_cycle_near(self.map, release, change, releases, unstable=waits)
        if near is not None and near.follows_cycle:
            return near
        return None


def slips_on(leg: Result) -> bool:
    """Whether a leg has only slip in its later half. Slip between two sticks, where a motion is
    linear as well, is shorter than any leg."""
    later = leg.final_state.time - duration_of(leg) / 2
    return leg.final_state.phase == "slip" and not np.any(leg.event_rows[:, TIME] > later)


def growing(changes: Sequence[float]) -> bool:
    """Whether two successive changes have risen above an earlier one: an instability, even if it is
    bounded later."""
    if len(changes) < 3:
        return False
    least = np.fmin.accumulate(changes[:-2])
    later = np.fmin(changes[1:-1], changes[2:])
    return bool(np.any((later > ARRIVED) & (later > RISE * least)))
