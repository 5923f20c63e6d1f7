"""Motions near a cycle, or near steady sliding: whether they leave or near it as its multipliers say.

Near a cycle the return map is linear, and the distance d from the cycle after n periods is J^n d.  This is tested, not
assumed: the motion is followed over some seconds and compared with J^n d, in its size and in the rate at which the
leading multiplier's part grows.  That a motion nearly repeats proves nothing, since one on a torus does as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import expm

from disc_model.data.variables import Outcome
from disc_model.flexibility import contact_give
from disc_model.parameters import Parameters
from disc_model.plate import Modes, mode_arrays
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.simulation.result import State, engine_case
from disc_model.stability.cycle import CycleStatus, FloquetResult, cycle_of, find_cycle, run_through_once
from disc_model.stability.return_map import RETURNED, Array, ComplexArray, ReturnMap, newton
from disc_model.stability.sliding import SteadySliding, steady_sliding

CYCLE_TOL = 1e-12
"""Tolerance of cycles and their multipliers: roundings leave as much."""
TESTS = ((0.3, 1.2), (1.5, 6.0))
"""Times over which a motion is compared with the linear one, s; the rate of growth is taken between them. The longer
test is made where the shorter one does not pass: it tells slower rates."""
AGREES = 0.1
"""Largest difference between the two motions, relative to the linear one: it errs by the square of the distance, which
is a tenth of the static deflection at most."""
RATE_AGREES = 0.5
"""Largest difference between their rates of growth, as a share of the linear one's: the sign of the rate is told."""
ARRIVED = 1e-8
"""A motion so near to a stable cycle, over the static deflection, is on it: ten thousand times what roundings leave."""
WAITS = (0.0, 1.5, 6.0, 15.0)
"""Times after which the test is begun, s. Near a resonance the start lies further from the cycle than the linear map
reaches, and comes within its reach as the modes die out that are damped best."""
AMPLITUDES = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
"""Distances from the cycle, over the static deflection, up to which a departure may be followed by multipliers."""
DEPARTS = 0.25
"""Largest share of a departing motion, on its section, that is not the leading multiplier's part; and largest
difference between the rate at which that part grows and the multiplier's, as a share of it. It is corrected for."""
NEAR = AMPLITUDES[0]
"""Distance from a cycle, over the static deflection, within which a motion may be near it: none is linear beyond."""
SAME_POINT = 1e-4
"""Fixed points nearer than this, over the static deflection, are one: a thousand times nearer than those of the cycles
known beside each other, and a million times further apart than their residuals."""
NEARLY_PERIODIC = NEAR / 2
"""Change over a period, over the static deflection, from which a cycle is looked for."""
LARGEST_PERIOD = 8
"""Releases in a period, at most, of cycles that are looked for from the section alone, where time counts."""


@dataclass(frozen=True, eq=False)
class NearCycle:
    """A motion near a cycle.

    Attributes
    ----------
    follows_cycle : whether it follows the linear map there, for good if the cycle is stable
    x, distance, jacobian : the cycle, the motion's distance from it, and the map's Jacobian, on the section of `map`
    waited : s, until the motion has come to where it follows the linear map: the distance is that then
    """

    cycle: FloquetResult
    follows_cycle: bool
    map: ReturnMap
    x: Array
    distance: Array
    jacobian: Array
    waited: float = 0.0

    @property
    def size(self) -> float:
        """Norm of the static deflection."""
        return float(np.linalg.norm(self.map.static))

    @property
    def kind(self) -> Outcome:
        """What a motion on the cycle is: quiet if it is that of the static start, or near it."""
        if self.cycle.separations:
            return Outcome.SEPARATING
        if np.linalg.norm(self.x - self.map.static) <= NEAR * self.size:
            return Outcome.QUIET
        own = find_cycle(self.cycle.parameters, CYCLE_TOL)
        same = own.releases == self.cycle.releases and math.isclose(own.period, self.cycle.period, rel_tol=ARRIVED)
        return Outcome.QUIET if same else Outcome.OTHER_CYCLE

    def moved(self, at: Array, periods: int, *, coarse: bool = True) -> tuple[Array, float]:
        """Where a motion on the section is so many periods later, and the time that takes, s; nan if it does not."""
        flight, end, _, _ = self.map.evaluate(
            at,
            releases=periods * self.cycle.releases,
            tangent=False,
            may_separate=self.cycle.separations > 0,
            coarse=coarse,
        )
        return end, flight.period if flight.outcome == RETURNED else math.nan


def cycle_of_static_start(p: Parameters) -> NearCycle | FloquetResult:
    """The cycle near the static start, and whether it is the start's own; without one, what was found instead."""
    cycle = find_cycle(p, CYCLE_TOL)
    if cycle.status is not CycleStatus.OK:
        return cycle
    map_ = ReturnMap(p, CYCLE_TOL)
    return _near(map_, cycle, map_.static)


def cycle_near(
    map_: ReturnMap, x: Array, again: tuple[float, int], *, may_separate: bool = False, stable: bool = True
) -> NearCycle | None:
    """The cycle near which a motion at a point of the section is, and whether it follows its multipliers; None if none.

    Parameters
    ----------
    again : as `recurrence` gives it
    may_separate : whether it may lose contact
    stable : whether only a stable one can be the motion's own
    """
    change, releases = again
    if not change <= NEARLY_PERIODIC:
        return None
    found = newton(map_, x, tol=CYCLE_TOL, releases=releases, may_separate=may_separate)
    if found is None or np.linalg.norm(found.x - x) > NEAR * np.linalg.norm(map_.static):
        return None
    cycle = cycle_of(map_, CYCLE_TOL, run_through_once(map_, CYCLE_TOL, found))
    return _near(map_, cycle, x, WAITS if cycle.stable or not stable else ())


def recurrence(
    map_: ReturnMap, x: Array, most: int = LARGEST_PERIOD, *, may_separate: bool = False
) -> tuple[float, int]:
    """Least change from a release to a later one, relative to the static deflection, and how many lie between."""
    size = float(np.linalg.norm(map_.static))
    later = map_.returns(x, most, may_separate=may_separate, coarse=True)
    changes = [float(np.linalg.norm(now - x) / size) for now in later]
    if not changes:
        return math.nan, 0
    # of those that are about as good the shortest
    releases = next(i for i, change in enumerate(changes, 1) if change <= 2 * min(changes))
    return changes[releases - 1], releases


def follows(near: NearCycle, at: Array) -> bool:
    """Whether the motion at a point of the section departs from a cycle, or nears it, as its multipliers say."""
    return any(_linear(near, at - near.x, times) for times in TESTS)


def departs_after(near: NearCycle, horizon: float) -> bool:
    """Whether the static start, near an unstable cycle, follows the linear map until the horizon (s)."""
    begun = first_release(near.cycle.parameters) + near.waited
    room = max(0, math.ceil((horizon - begun) / near.cycle.period))
    # the leading part alone: most do not, and this says so at once
    leading = _left_vector(near.jacobian)
    right = _left_vector(near.jacobian.T)
    part = float(abs(leading @ near.distance)) / float(abs(leading @ right))
    grown = math.log(max(part / near.size, 1e-300)) + room * math.log(abs(near.cycle.multipliers[0]))
    return grown <= math.log(2 * AMPLITUDES[0]) and departure(near, room)[0] >= (room - 1) * near.cycle.period


def first_release(p: Parameters) -> float:
    """Time at which the static start first slips, s: then it is on the section."""
    return max((p.mu_s * p.N / p.r_0 - p.c_p * p.Omega) / (p.k_p * p.Omega), 0.0)


def _near(map_: ReturnMap, cycle: FloquetResult, at: Array, waits: Sequence[float] = WAITS) -> NearCycle:
    """A motion at a point of the section, seen from a cycle."""
    assert cycle.state is not None
    x = map_.point(cycle.state)
    _, _, jacobian, _ = map_.evaluate(x, releases=cycle.releases, may_separate=cycle.separations > 0)
    near = NearCycle(cycle, False, map_, x, at - x, jacobian)
    waited, moved = 0.0, at
    for wait in waits:
        if wait > waited:
            moved, took = near.moved(moved, max(1, round((wait - waited) / cycle.period)), coarse=False)
            if math.isnan(took):
                break
            waited += took
        if follows(near, moved):
            return replace(near, follows_cycle=True, distance=moved - x, waited=waited)
    return near


def _linear(near: NearCycle, distance: Array, times: tuple[float, float]) -> bool:
    """Whether the motion at that distance departs from the cycle, or nears it, as its multipliers say."""
    cycle, jacobian, x = near.cycle, near.jacobian, near.x
    leading = _left_vector(jacobian)
    least = ARRIVED * near.size if cycle.stable else 0.0
    expected, moved, parts = distance, x + distance, list[float]()
    done = 0
    counts = [max(i, round(time / cycle.period)) for i, time in enumerate(times, 1)]
    for count in counts:
        # what coarse flights leave out would show beside so small a distance
        moved, took = near.moved(moved, count - done, coarse=bool(np.linalg.norm(distance) > SAME_POINT * near.size))
        expected = np.linalg.matrix_power(jacobian, count - done) @ expected
        error = float(np.linalg.norm(moved - x - expected))
        if math.isnan(took) or not error <= max(AGREES * float(np.linalg.norm(expected)), least):
            return False
        parts.append(float(abs(leading @ (moved - x))))
        done = count
    return _at_rate(parts, (counts[1] - counts[0]) * cycle.period, cycle.growth_rate, least)


def _at_rate(parts: Sequence[float], time: float, rate: float, least: float) -> bool:
    """Whether the leading part grows by a rate (1/s) from one time to another, or has become as small as it can."""
    if not min(parts) > 0 or parts[1] <= least:
        return parts[1] <= least
    return abs(math.log(parts[1] / parts[0]) / time - rate) <= RATE_AGREES * abs(rate)


def _left_vector(jacobian: Array, size: Callable[[ComplexArray], Array] = np.abs) -> ComplexArray:
    """Left eigenvector of the leading eigenvalue: its product with a distance is that eigenvalue's part of it.

    size : what leads, the modulus of a map's eigenvalues or the real part of those of equations
    """
    values, vectors = np.linalg.eig(jacobian.T)
    return np.asarray(vectors[:, np.argmax(size(values))], dtype=complex)


def departure(near: NearCycle, room: int, furthest: float = AMPLITUDES[0]) -> tuple[float, Array]:
    """How long the leading multiplier tells of a motion's departure, at most `room` periods, and its distance then.

    Returns
    -------
    time : s, 0 if it does not tell
    distance : on the section
    """
    period = near.cycle.period
    powers = [near.jacobian]
    most = math.log(1e100) / max(math.log(abs(near.cycle.multipliers[0])), 1e-300)
    while 2 ** len(powers) <= min(room, most):  # no departure is followed as far as numbers go
        powers.append(powers[-1] @ powers[-1])
    for amplitude in (a for a in AMPLITUDES if a <= furthest):
        n, distance = 0, near.distance
        for i in reversed(range(len(powers))):
            ahead = powers[i] @ distance
            if n + 2**i <= room and np.linalg.norm(ahead) <= amplitude * near.size:
                n, distance = n + 2**i, ahead
        if n == 0:
            break
        faster = _faster(near, distance)
        if abs(faster) <= DEPARTS:
            # the rate changes with the square of the amplitude: a' = rate a (1 + faster a^2 / amplitude^2)
            sooner = math.log1p(faster) / (2 * near.cycle.growth_rate)
            return max(n * period - sooner, period), distance
    return 0.0, near.distance


def _faster(near: NearCycle, distance: Array) -> float:
    """By what share a departing motion grows faster than the leading multiplier says; infinite if it is another one.

    Its phase is not asked for: it drifts with the amplitude long before the growth does, and decides nothing.
    """
    left, right = _left_vector(near.jacobian), _left_vector(near.jacobian.T)
    right = right / (left @ right)
    real = near.cycle.multipliers[0].imag == 0
    moved, done, before = near.x + distance, 0, float(abs(left @ distance))
    faster = math.inf
    for time in TESTS[-1]:
        count = max(done + 1, round(time / near.cycle.period))
        moved, took = near.moved(moved, count - done)
        if math.isnan(took):
            return math.inf
        done, apart = count, moved - near.x
        part = left @ apart
        plane = np.real(part * right) * (1 if real else 2)
        if not np.linalg.norm(apart - plane) <= DEPARTS * np.linalg.norm(apart):
            return math.inf
        faster = math.log(abs(part) / before) / (count * near.cycle.period) / near.cycle.growth_rate - 1
    return faster


# ----------------------------------------------------------------------------------------------------
# Steady sliding


def nears_sliding(p: Parameters, state: State, tol: float) -> bool:
    """Whether a motion that slides nears stable steady sliding as the eigenvalues there say."""
    sliding = steady_sliding(p)
    if not sliding.stable or state.phase != "slip":
        return False
    modes, give = mode_arrays(p), contact_give(p)
    ones = np.ones_like(modes.omega)
    # with these factors the norm of rows is that of the energy
    slider = [p.r_0 * math.sqrt(p.k_p), p.r_0 * math.sqrt(p.m)]
    height: Sequence[float] = [math.sqrt(1 / give + p.k), math.sqrt(p.m)] if give else []
    scale = _rows(modes, (modes.omega, ones, modes.omega, ones), slider, height)
    jacobian = scale[:, None] * sliding.jacobian / scale
    expected = scale * _from_sliding(p, sliding, state)
    static = p.N * float(np.linalg.norm(modes.psi / modes.omega))
    if not np.linalg.norm(expected) <= NEAR * static:
        return False
    leading, parts, before = _left_vector(jacobian, np.real), list[float](), 0.0
    for time in TESTS[-1]:
        result = simulate(p, state.time + time, tol=tol, initial_state=state, record=Record(events=False))
        if not result.status.complete or result.final_state.phase != "slip":
            return False
        apart = scale * _from_sliding(p, sliding, result.final_state)
        expected = expm(jacobian * (time - before)) @ expected
        size = float(np.linalg.norm(expected))
        if not np.linalg.norm(apart - expected) <= max(AGREES * size, ARRIVED * static):
            return False
        parts.append(float(abs(leading @ apart)))
        before = time
    return _at_rate(parts, TESTS[-1][1] - TESTS[-1][0], sliding.growth_rate, ARRIVED * static)


def _from_sliding(p: Parameters, sliding: SteadySliding, state: State) -> Array:
    """Distance from steady sliding, in the rows of its Jacobian."""
    modes, give = mode_arrays(p), contact_give(p)
    disc = [getattr(state, name) - getattr(sliding, name) for name in ("a", "alpha", "b", "beta")]
    # the contact's force is that of the slider's spring: (w - u) / give = N + k (u - u_0)
    rest = (modes.psi @ sliding.a - give * (p.N - p.k * engine_case(p).model.u_0)) / (1 + p.k * give)
    height = [float(state.u - rest), float(state.u_velocity)] if give else []
    return _rows(modes, disc, (state.psi - sliding.psi, state.f - p.Omega), height)


def _rows(modes: Modes, disc: Sequence[Array], slider: Sequence[float], height: Sequence[float]) -> Array:
    """Rows of steady sliding's Jacobian from a, alpha, b, beta of all modes, psi, f, and the contact's u, u'."""
    a, alpha, b, beta = disc
    pairs = modes.diameters > 0
    return np.concatenate([a, alpha, b[pairs], beta[pairs], slider, height])
