"""Motions near a cycle, or near steady sliding: whether they depart or approach as its multipliers predict.

Near a cycle the return map is linear, and the distance d from the cycle after n periods is J^n d.  This is tested, not
assumed: the motion is followed over some seconds and compared with J^n d. The comparison covers the size and the
growth rate of the leading multiplier's part.  Near repetition alone proves nothing, because a torus shows it as well.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from disc_model.data.variables import Outcome
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.simulation.states import State, engine_case
from disc_model.stability.cycle import (
    CycleStatus,
    FloquetResult,
    cycle_from_rest,
    cycle_of,
    find_cycle,
    may_stick_and_slip,
    run_through_once,
)
from disc_model.stability.return_map import Array, ComplexArray, Flight, ReturnMap, newton
from disc_model.stability.sliding import SteadySliding, join_rows, steady_sliding

TESTS = ((0.3, 1.2), (1.5, 6.0))
"""Times at which a motion is compared with the linear one, s; its growth rate is taken between them. The longer test
follows if the shorter one fails, because it resolves slower rates."""
AGREES = 0.1
"""Largest difference between the two motions, relative to the linear one. The error of the linear map is of second
order in the distance, which is at most a tenth of the static deflection."""
RATE_AGREES = 0.5
"""Largest difference between their growth rates, relative to the linear one: it decides the sign of the rate."""
ARRIVED = 1e-8
"""A motion as near to a stable cycle, over the static deflection, is on it: the limit is 10,000 times the rounding."""
WAITS = (0.0, 1.5, 6.0, 15.0)
"""Times at which the test begins, s. Near a resonance the start lies outside the range of the linear map, and enters it
when the strongly damped modes have decayed."""
AMPLITUDES = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
"""Distances from the cycle, over the static deflection, up to which multipliers may represent a departure."""
DEPARTS = 0.25
"""Largest share of a departing motion, on its section, outside the leading eigenspace. It also bounds the relative
difference between the growth rate and the multiplier's, for which the departure is corrected."""
NEAR = AMPLITUDES[0]
"""Distance from a cycle, over the static deflection, within which a motion counts as near it: none is linear beyond."""
SAME_POINT = 1e-4
"""Fixed points nearer than this, over the static deflection, are the same. Distinct known cycles differ a thousand
times as much, and residuals are a million times smaller."""
LINGERS = 1e-3
"""Largest change over a period of a motion that stays near an unstable cycle, over the static deflection."""
LARGEST_PERIOD = 8
"""Largest number of releases in a period of cycles that are sought from the section alone, to limit the time."""


@dataclass(frozen=True, eq=False)
class NearCycle:
    """A motion near a cycle.

    Attributes
    ----------
    follows_cycle : whether the motion follows the linear map, and so stays on the cycle if that is stable
    x, distance, jacobian : the cycle, the motion's distance from it, and the map's Jacobian, on the section of `map`
    waited : s, until the motion follows the linear map; `distance` is taken at that time
    """

    cycle: FloquetResult
    follows_cycle: bool
    map: ReturnMap
    x: Array
    distance: Array
    jacobian: Array
    waited: float = 0.0

    @cached_property
    def leading(self) -> ComplexArray:
        """See `_left_vector`."""
        return _left_vector(self.jacobian)

    @property
    def kind(self) -> Outcome:
        """Outcome of a motion on the cycle: quiet if the cycle is that of the static start, or near it."""
        if self.cycle.separations:
            return Outcome.SEPARATING
        if np.linalg.norm(self.x - self.map.static) <= NEAR * self.map.deflection:
            return Outcome.QUIET
        own = find_cycle(self.cycle.parameters)
        same = own.releases == self.cycle.releases and math.isclose(own.period, self.cycle.period, rel_tol=ARRIVED)
        return Outcome.QUIET if same else Outcome.OTHER_CYCLE

    @property
    def lingers(self) -> bool:
        """Whether the motion stays near an unstable cycle: over a period it hardly moves; on a torus it would."""
        still = LINGERS * self.map.deflection
        return not self.cycle.stable and self.moved(self.x + self.distance, 1).residual <= still

    def moved(self, at: Array, periods: int, *, coarse: bool = True) -> Flight:
        """The motion from a point of the section over some periods of the cycle."""
        n, separates = periods * self.cycle.releases, self.cycle.separations > 0
        return self.map.evaluate(at, releases=n, tangent=False, may_separate=separates, coarse=coarse)


def cycle_of_static_start(p: Parameters) -> NearCycle | FloquetResult:
    """The cycle near the static start, and whether the start follows it; without a cycle, the result of the search."""
    if not may_stick_and_slip(p):
        return find_cycle(p)
    map_ = ReturnMap(p)
    cycle = cycle_from_rest(map_)
    return _near(map_, cycle, map_.static) if cycle.status is CycleStatus.OK else cycle


def cycle_near(
    map_: ReturnMap, x: Array, again: tuple[float, int], *, may_separate: bool = False, unstable: Sequence[float] = ()
) -> NearCycle | None:
    """The cycle near a motion at a point of the section, and whether the motion follows it; None if there is none.

    Parameters
    ----------
    again : result of `recurrence`
    may_separate : whether the cycle may lose contact
    unstable : times at which the test begins on an unstable cycle, s; with none, no motion follows it
    """
    change, releases = again
    if not change <= NEAR / 2:
        return None
    found = newton(map_, x, releases=releases, may_separate=may_separate)
    if found is None or np.linalg.norm(found.start - x) > NEAR * map_.deflection:
        return None
    cycle = cycle_of(map_, run_through_once(map_, found))
    return _near(map_, cycle, x, WAITS if cycle.stable else unstable)


def recurrence(
    map_: ReturnMap, x: Array, most: int = LARGEST_PERIOD, *, may_separate: bool = False
) -> tuple[float, int]:
    """Least change from a release to a later one, relative to the static deflection, and the number of releases."""
    later = map_.returns(x, most, may_separate=may_separate, coarse=True)
    changes = [float(np.linalg.norm(now - x) / map_.deflection) for now in later]
    if not changes:
        return math.nan, 0
    # the shortest of those with about the least change
    releases = next(i for i, change in enumerate(changes, 1) if change <= 2 * min(changes))
    return changes[releases - 1], releases


def follows(near: NearCycle, at: Array) -> bool:
    """Whether the motion at a point of the section departs from a cycle or approaches it as its multipliers predict."""
    return any(_linear(near, at - near.x, times) for times in TESTS)


def departs_after(near: NearCycle, horizon: float) -> bool:
    """Whether the static start, near an unstable cycle, follows the linear map until the horizon (s)."""
    begun = first_release(near.cycle.parameters) + near.waited
    room = max(0, math.ceil((horizon - begun) / near.cycle.period))
    # the leading part alone excludes most motions at once
    right = _left_vector(near.jacobian.T)
    part = float(abs(near.leading @ near.distance)) / float(abs(near.leading @ right))
    grown = math.log(max(part / near.map.deflection, 1e-300)) + room * math.log(abs(near.cycle.multipliers[0]))
    return grown <= math.log(2 * AMPLITUDES[0]) and departure(near, room)[0] >= (room - 1) * near.cycle.period


def first_release(p: Parameters) -> float:
    """Time at which the motion from the static start first slips, s, and is then on the section."""
    return max((p.mu_s * p.N / p.r_0 - p.c_p * p.Omega) / (p.k_p * p.Omega), 0.0)


def _near(map_: ReturnMap, cycle: FloquetResult, at: Array, waits: Sequence[float] = WAITS) -> NearCycle:
    """The motion at a point of the section in relation to a cycle."""
    assert cycle.state is not None
    x = map_.point(cycle.state)
    flight = map_.evaluate(x, releases=cycle.releases, may_separate=cycle.separations > 0)
    near = NearCycle(cycle, False, map_, x, at - x, flight.jacobian)
    waited, moved = 0.0, at
    for wait in waits:
        if wait > waited:
            flight = near.moved(moved, max(1, round((wait - waited) / cycle.period)), coarse=False)
            if not flight.returned:
                break
            moved, waited = flight.end, waited + flight.period
        if follows(near, moved):
            return replace(near, follows_cycle=True, distance=moved - x, waited=waited)
    return near


@np.errstate(over="ignore", invalid="ignore")  # powers of a strongly unstable cycle's Jacobian
def _linear(near: NearCycle, distance: Array, times: tuple[float, float]) -> bool:
    """Whether the motion at that distance departs from the cycle, or approaches it, as its multipliers predict."""
    cycle, jacobian, x = near.cycle, near.jacobian, near.x
    least = ARRIVED * near.map.deflection if cycle.stable else 0.0
    # the errors of coarse flights would matter at a smaller distance
    coarse = bool(np.linalg.norm(distance) > SAME_POINT * near.map.deflection)
    expected, at, parts, done = distance, x + distance, list[float](), 0
    counts = [max(i, round(time / cycle.period)) for i, time in enumerate(times, 1)]
    for count in counts:
        flight = near.moved(at, count - done, coarse=coarse)
        expected = np.linalg.matrix_power(jacobian, count - done) @ expected
        at, done = flight.end, count
        error = float(np.linalg.norm(at - x - expected))
        if not flight.returned or not error <= max(AGREES * float(np.linalg.norm(expected)), least):
            return False
        parts.append(float(abs(near.leading @ (at - x))))
    return _at_rate(parts, (counts[1] - counts[0]) * cycle.period, cycle.growth_rate, least)


def _at_rate(parts: Sequence[float], time: float, rate: float, least: float) -> bool:
    """Whether the leading part grows at a rate (1/s) between two times, or has fallen to `least`."""
    if not min(parts) > 0 or parts[1] <= least:
        return parts[1] <= least
    return abs(math.log(parts[1] / parts[0]) / time - rate) <= RATE_AGREES * abs(rate)


def _left_vector(jacobian: Array, size: Callable[[ComplexArray], Array] = np.abs) -> ComplexArray:
    """Left eigenvector of the leading eigenvalue: its product with a distance is that eigenvalue's part of it.

    size : function that ranks eigenvalues: the modulus for a map, the real part for differential equations
    """
    values, vectors = np.linalg.eig(jacobian.T)
    return np.asarray(vectors[:, np.argmax(size(values))], dtype=complex)


def departure(near: NearCycle, room: int, furthest: float = AMPLITUDES[0]) -> tuple[float, Array]:
    """Time over which multipliers represent a motion's departure, at most `room` periods, and the distance at its end.

    The time (s) is 0 if they do not represent it. The distance is that from the cycle, on the section.
    """
    period = near.cycle.period
    powers = [near.jacobian]
    most = math.log(1e100) / max(math.log(abs(near.cycle.multipliers[0])), 1e-300)
    while 2 ** len(powers) <= min(room, most):  # `most` keeps the powers from overflow
        powers.append(powers[-1] @ powers[-1])
    for amplitude in (a for a in AMPLITUDES if a <= furthest):
        n, distance = 0, near.distance
        for i in reversed(range(len(powers))):
            ahead = powers[i] @ distance
            if n + 2**i <= room and np.linalg.norm(ahead) <= amplitude * near.map.deflection:
                n, distance = n + 2**i, ahead
        if n == 0:
            break
        faster = _faster(near, distance)
        if abs(faster) <= DEPARTS:
            # the rate changes with the square of the amplitude: a' = rate a (1 + faster a^2 / amplitude^2)
            sooner = math.log1p(faster) / (2 * near.cycle.growth_rate)
            return max(n * period - sooner, period), distance
        if _linear(near, distance, TESTS[0]):
            return n * period, distance
    return 0.0, near.distance


def _faster(near: NearCycle, distance: Array) -> float:
    """Relative excess of a departing motion's growth rate over the leading multiplier's; infinite for another motion.

    The phase is ignored: it drifts with the amplitude long before the growth rate does, and matters only near borders.
    """
    left, right = near.leading, _left_vector(near.jacobian.T)
    right = right / (left @ right)
    real = near.cycle.multipliers[0].imag == 0
    at, done, before = near.x + distance, 0, float(abs(left @ distance))
    faster = math.inf
    for time in TESTS[-1]:
        count = max(done + 1, round(time / near.cycle.period))
        flight = near.moved(at, count - done)
        if not flight.returned:
            return math.inf
        at, done, apart = flight.end, count, flight.end - near.x
        part = left @ apart
        plane = np.real(part * right) * (1 if real else 2)
        if not np.linalg.norm(apart - plane) <= DEPARTS * np.linalg.norm(apart):
            return math.inf
        faster = math.log(abs(part) / before) / (count * near.cycle.period) / near.cycle.growth_rate - 1
    return faster


# ----------------------------------------------------------------------------------------------------
# Steady sliding


_sliding = lru_cache(maxsize=1)(steady_sliding)  # asked at the end of each leg of a motion


def nears_sliding(p: Parameters, state: State, tol: float) -> bool:
    """Whether a slipping motion approaches stable steady sliding as the eigenvalues there predict."""
    if state.phase != "slip" or p.n_diameters < 0 or not (sliding := _sliding(p)).stable:
        return False
    modes, give = mode_arrays(p), contact_compliance(p)
    ones = np.ones_like(modes.omega)
    # with these factors the norm of rows is that of the energy
    slider = [p.r_0 * math.sqrt(p.k_p), p.r_0 * math.sqrt(p.m)]
    height: Sequence[float] = [math.sqrt(1 / give + p.k), math.sqrt(p.m)] if give else []
    scale = join_rows(modes, (modes.omega, ones, modes.omega, ones), slider, height)
    jacobian = scale[:, None] * sliding.jacobian / scale
    expected = scale * _from_sliding(p, sliding, state)
    static = p.N * float(np.linalg.norm(modes.psi / modes.omega))
    least = max(ARRIVED, 100 * tol) * static  # the errors of a simulation are larger than its tolerance
    if not np.linalg.norm(expected) <= NEAR * static:
        return False
    from scipy.linalg import expm  # as in plate

    leading, parts, before = _left_vector(jacobian, np.real), list[float](), 0.0
    for time in TESTS[-1]:
        result = simulate(p, state.time + time, tol=tol, initial_state=state, record=Record(events=False))
        if not result.status.complete or result.final_state.phase != "slip":
            return False
        apart = scale * _from_sliding(p, sliding, result.final_state)
        expected = expm(jacobian * (time - before)) @ expected
        size = float(np.linalg.norm(expected))
        if not np.linalg.norm(apart - expected) <= max(AGREES * size, least):
            return False
        parts.append(float(abs(leading @ apart)))
        before = time
    return _at_rate(parts, TESTS[-1][1] - TESTS[-1][0], sliding.growth_rate, least)


def _from_sliding(p: Parameters, sliding: SteadySliding, state: State) -> Array:
    """Distance from steady sliding, in the rows of its Jacobian."""
    modes, give = mode_arrays(p), contact_compliance(p)
    disc = [getattr(state, name) - getattr(sliding, name) for name in ("a", "alpha", "b", "beta")]
    # the contact's force is that of the slider's spring: (w - u) / give = N + k (u - u_0)
    rest = (modes.psi @ sliding.a - give * (p.N - p.k * engine_case(p).model.u_0)) / (1 + p.k * give)
    height = [float(state.u - rest), float(state.u_velocity)] if give else []
    return join_rows(modes, disc, (state.psi - sliding.psi, state.f - p.Omega), height)
