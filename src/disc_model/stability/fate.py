"""What becomes of the published start within a horizon: decided by multipliers where they prove it, else simulated.

The published start is a point of the section of `disc_model.stability.return_map`, and usually lies near the cycle that
Newton's method finds from it.  There the map is linear, and the distance d from the cycle after n periods is J^n d.
This is tested, not assumed: the motion is followed over some seconds and compared with J^n d, in its size and in the
rate at which the leading multiplier's part grows.  What follows from it, and what is simulated, is said in
docs/studies.md, Regions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.linalg import expm

from disc_model.errors import Status
from disc_model.flexibility import contact_give
from disc_model.parameters import Parameters
from disc_model.plate import Modes, mode_arrays
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.simulation.result import Result, State
from disc_model.stability.cycle import CycleStatus, FloquetResult, cycle_of, find_cycle
from disc_model.stability.return_map import OUTCOMES, RETURNED, Array, ComplexArray, ReturnMap, newton
from disc_model.stability.settling import LARGEST_PERIOD, NOISE, growing
from disc_model.stability.sliding import SteadySliding, steady_sliding

CYCLE_TOL = 1e-12
"""Tolerance of cycles and their multipliers."""
TESTS = ((0.3, 1.2), (1.5, 6.0))
"""Times over which a motion is compared with the linear one, s; the rate of growth is taken between them. The longer
test is made where the shorter one does not pass: it tells slower rates."""
AGREES = 0.1
"""Largest difference between the two motions, relative to the linear one."""
RATE_AGREES = 0.5
"""Largest difference between their rates of growth, as a share of the linear one's."""
WAITS = (0.0, 1.5, 6.0, 15.0)
"""Times after which the test is begun, s. Near a resonance the start lies further from the cycle than the linear map
reaches, and comes within its reach as the modes die out that are damped best."""
AMPLITUDES = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
"""Distances from the cycle, over the static deflection, up to which a departure may be followed by multipliers."""
DEPARTURE_TIMES = (1.5, 6.0)
"""Times at which a departing motion is looked at, s."""
DEPARTS = 0.25
"""Largest share of a departing motion, on its section, that is not the leading multiplier's part; and largest
difference between the rate at which that part grows and the multiplier's, as a share of it."""
FIRST_LEG = 5.0
"""s, simulated before the motion is looked at again; each leg is twice as long as the one before."""
NEARLY_PERIODIC = 0.05
"""Change over a period, relative to the static deflection, from which a cycle is looked for."""
NEAR = 0.1
"""Distance from a cycle, relative to the static deflection, within which a motion may be near it."""
SLIDING_TIMES = (1.0, 4.0)
"""Times over which the approach to steady sliding is compared with its eigenvalues, s."""
_NOTHING = Record(events=False)


@dataclass(frozen=True, eq=False)
class Near:
    """A motion near a cycle.

    Attributes
    ----------
    own : whether it follows the linear map there, for good if the cycle is stable
    x, distance, jacobian : the cycle, the motion's distance from it, and the map's Jacobian, on the section of `map`
    waited : s, until the motion has come to where it follows the linear map: the distance is that then
    """

    cycle: FloquetResult
    own: bool
    map: ReturnMap
    x: Array
    distance: Array
    jacobian: Array
    waited: float = 0.0


@dataclass(frozen=True, eq=False)
class Fate:
    """What becomes of the published start.

    Attributes
    ----------
    outcome : "stable", it comes to a stable cycle near its start or to steady sliding; "unstable", it departs from an
        unstable cycle, or grows, without separation; "separation"; "undecided", none of these could be shown;
        "unknown", the simulation failed
    simulated : s, 0 if multipliers decide
    cycle : the stable one to which the motion has come, or else the unstable one from which it departs; None if neither
    departed : the unstable cycle from which its multipliers have led the motion away, None if all was simulated
    sliding : whether it has come to steady sliding
    first_separation : s, nan if there is none
    state : where the simulation ended; None if there was none
    status, message : of the simulation
    """

    outcome: str
    simulated: float
    cycle: FloquetResult | None
    departed: FloquetResult | None = None
    sliding: bool = False
    first_separation: float = math.nan
    state: State | None = None
    status: str = "ok"
    message: str = ""


def published_start_near(p: Parameters) -> Near | FloquetResult:
    """The cycle near the published start, and whether it is the start's own; without one, what was found instead."""
    cycle = find_cycle(p, CYCLE_TOL)
    if cycle.status is not CycleStatus.OK:
        return cycle
    map_ = ReturnMap(p, CYCLE_TOL)
    return _near(map_, cycle, map_.static)


def follows(near: Near, at: Array) -> bool:
    """Whether the motion at a point of the section departs from a cycle, or nears it, as its multipliers say."""
    return any(_linear(near, at - near.x, times) for times in TESTS)


def fate(
    p: Parameters,
    horizon: float,
    *,
    tol: float = 1e-10,
    start: Near | FloquetResult | None = None,
    furthest: float = AMPLITUDES[0],
) -> Fate:
    """What becomes of the published start within a horizon (s).

    Parameters
    ----------
    tol : of what is simulated, as in `simulate`
    start : what `published_start_near` says, if it is known
    furthest : distance from a cycle, over the static deflection, up to which multipliers may tell of a departure: the
        shorter, the better is the time of the first separation known
    """
    start = published_start_near(p) if start is None else start
    return _Course(p, horizon, tol, furthest).run(start if isinstance(start, Near) and start.own else None)


def departs_after(near: Near, horizon: float) -> bool:
    """Whether the published start, near an unstable cycle, follows the linear map until the horizon (s)."""
    begun = first_release(near.cycle.parameters) + near.waited
    room = max(0, math.ceil((horizon - begun) / near.cycle.period))
    size = float(np.linalg.norm(near.map.static))
    # the leading part alone: most do not, and this says so at once
    leading = _left_vector(near.jacobian)
    right = _left_vector(near.jacobian.T)
    part = float(abs(leading @ near.distance)) / float(abs(leading @ right))
    grown = math.log(max(part / size, 1e-300)) + room * math.log(abs(near.cycle.multipliers[0]))
    return grown <= math.log(2 * AMPLITUDES[0]) and _departure(near, room)[0] >= (room - 1) * near.cycle.period


class _Course:
    """A motion on its way: where it is, and what was seen so far.

    shown : the cycle that it follows linearly: the first, or the stable one to which it has come
    left : the unstable cycle that it has departed from
    changes : from one period to the next, relative, at the end of each leg
    """

    def __init__(self, p: Parameters, horizon: float, tol: float, furthest: float) -> None:
        self.p, self.horizon, self.tol, self.furthest = p, horizon, tol, furthest
        self.map = ReturnMap(p, CYCLE_TOL)
        self.state: State | None = None
        self.time, self.simulated = 0.0, 0.0
        self.shown: FloquetResult | None = None
        self.left: Near | None = None
        self.changes: list[float] = []

    def run(self, near: Near | None) -> Fate:
        if near is not None:
            self.time = first_release(self.p)
        leg = FIRST_LEG
        while True:
            if near is not None:
                self.shown = self.shown or near.cycle
                if near.cycle.stable:
                    self.shown = near.cycle
                    # a motion between the start and a cycle so near to it counts as quiet
                    apart, size = (np.linalg.norm(x) for x in (near.x - self.map.static, self.map.static))
                    return self._ended("stable" if self.left is None or apart <= NEAR * size else "unstable")
                if self._depart(near) >= self.horizon:
                    return self._ended("unstable")
            elif self.time >= self.horizon:
                return self._ended("unstable" if self.left or growing(self.changes) else "undecided")
            result = self._simulated(leg)
            leg *= 2
            if result.status is Status.STOPPED:
                return self._ended("separation", first_separation=result.first_separation)
            if not result.status.complete:
                return self._ended("unknown", status=result.status.value, message=result.message)
            near = None
            code, x = self.map.next_release(result.final_state)
            if code == RETURNED:
                near = self._look(x)
            elif OUTCOMES[code] == "time_over" and _nears_sliding(self.p, result.final_state, self.tol):
                self.shown = None
                return self._ended("stable", sliding=True)

    def _simulated(self, leg: float) -> Result:
        """Go on for a time (s), or to the first separation."""
        result = simulate(
            self.p,
            min(self.time + leg, self.horizon),
            tol=self.tol,
            initial_state=self.state,
            record=_NOTHING,
            stop_at="first_separation",
        )
        self.simulated += result.final_state.time - self.time
        self.state, self.time = result.final_state, result.final_state.time
        return result

    def _ended(self, outcome: str, **more: Any) -> Fate:
        departed = None if self.left is None else self.left.cycle
        return Fate(outcome, self.simulated, self.shown, departed, state=self.state, **more)

    def _depart(self, near: Near) -> float:
        """Follow the linear map away from an unstable cycle, as far as it may be; the time then, s."""
        begun = self.time + near.waited
        room = max(0, math.ceil((self.horizon - begun) / near.cycle.period))
        time, distance = _departure(near, room, self.furthest)
        self.time = begun + time
        self.state = near.map.state(near.x + distance).replace(time=self.time)
        self.left = near
        return self.time

    def _look(self, x: Array) -> Near | None:
        """The cycle that the motion, now at `x`, follows linearly; once it departs from one, only a stable one."""
        size = float(np.linalg.norm(self.map.static))
        change, releases = _period(self.map, x)
        self.changes.append(change)
        if not change <= NEARLY_PERIODIC:
            return None
        found = newton(self.map, x, tol=CYCLE_TOL, releases=releases)
        if found is None or np.linalg.norm(found.x - x) > NEAR * size:
            return None
        cycle = cycle_of(self.map, CYCLE_TOL, found)
        if self.left is not None and not cycle.stable:
            return None
        near = _near(self.map, cycle, x)
        return near if near.own else None


def first_release(p: Parameters) -> float:
    """Time at which the published start first slips, s: then it is on the section."""
    return max((p.mu_s * p.N / p.r_0 - p.c_p * p.Omega) / (p.k_p * p.Omega), 0.0)


def _near(map_: ReturnMap, cycle: FloquetResult, at: Array) -> Near:
    """A motion at a point of the section, seen from a cycle."""
    assert cycle.state is not None
    x = map_.point(cycle.state)
    _, _, jacobian, _ = map_.evaluate(x, releases=cycle.releases)
    near = Near(cycle, False, map_, x, at - x, jacobian)
    waited, moved = 0.0, at
    for wait in WAITS:
        if wait > waited:
            count = max(1, round((wait - waited) / cycle.period)) * cycle.releases
            flight, moved, _, _ = map_.evaluate(moved, releases=count, tangent=False)
            if flight.outcome != RETURNED:
                break
            waited += flight.period
        if follows(near, moved):
            return replace(near, own=True, distance=moved - x, waited=waited)
    return near


def _linear(near: Near, distance: Array, times: tuple[float, float]) -> bool:
    """Whether the motion at that distance departs from the cycle, or nears it, as its multipliers say."""
    cycle, jacobian, x = near.cycle, near.jacobian, near.x
    leading = _left_vector(jacobian)
    expected, moved, parts = distance, x + distance, list[float]()
    done = 0
    counts = [max(i, round(time / cycle.period)) for i, time in enumerate(times, 1)]
    for count in counts:
        ahead = (count - done) * cycle.releases
        flight, moved, _, _ = near.map.evaluate(moved, releases=ahead, tangent=False, coarse=True)
        if flight.outcome != RETURNED:
            return False
        expected = np.linalg.matrix_power(jacobian, count - done) @ expected
        if not np.linalg.norm(moved - x - expected) <= AGREES * np.linalg.norm(expected):
            return False
        parts.append(float(abs(leading @ (moved - x))))
        done = count
    if not min(parts) > 0:
        return False
    rate = math.log(parts[1] / parts[0]) / ((counts[1] - counts[0]) * cycle.period)
    return abs(rate - cycle.growth_rate) <= RATE_AGREES * abs(cycle.growth_rate)


def _left_vector(jacobian: Array, size: Callable[[ComplexArray], Array] = np.abs) -> ComplexArray:
    """Left eigenvector of the leading eigenvalue: its product with a distance is that eigenvalue's part of it.

    size : what leads, the modulus of a map's eigenvalues or the real part of those of equations
    """
    values, vectors = np.linalg.eig(jacobian.T)
    return np.asarray(vectors[:, np.argmax(size(values))], dtype=complex)


def _departure(near: Near, room: int, furthest: float = AMPLITUDES[0]) -> tuple[float, Array]:
    """How long the leading multiplier tells of a motion's departure, at most `room` periods, and its distance then.

    Returns
    -------
    time : s, 0 if it does not tell
    distance : on the section
    """
    size, period = float(np.linalg.norm(near.map.static)), near.cycle.period
    powers = [near.jacobian]
    most = math.log(1e100) / max(math.log(abs(near.cycle.multipliers[0])), 1e-300)
    while 2 ** len(powers) <= min(room, most):  # no departure is followed as far as numbers go
        powers.append(powers[-1] @ powers[-1])
    for amplitude in (a for a in AMPLITUDES if a <= furthest):
        n, distance = 0, near.distance
        for i in reversed(range(len(powers))):
            ahead = powers[i] @ distance
            if n + 2**i <= room and np.linalg.norm(ahead) <= amplitude * size:
                n, distance = n + 2**i, ahead
        if n == 0:
            break
        faster = _faster(near, distance)
        if abs(faster) <= DEPARTS:
            # the rate changes with the square of the amplitude: a' = rate a (1 + faster a^2 / amplitude^2)
            sooner = math.log1p(faster) / (2 * near.cycle.growth_rate)
            return max(n * period - sooner, period), distance
    return 0.0, near.distance


def _faster(near: Near, distance: Array) -> float:
    """By what share a departing motion grows faster than the leading multiplier says; infinite if it is another one.

    Its phase is not asked for: it drifts with the amplitude long before the growth does, and decides nothing.
    """
    left, right = _left_vector(near.jacobian), _left_vector(near.jacobian.T)
    right = right / (left @ right)
    real = near.cycle.multipliers[0].imag == 0
    moved, done, before = near.x + distance, 0, float(abs(left @ distance))
    faster = math.inf
    for time in DEPARTURE_TIMES:
        count = max(done + 1, round(time / near.cycle.period))
        flight, moved, _, _ = near.map.evaluate(
            moved, releases=(count - done) * near.cycle.releases, tangent=False, coarse=True
        )
        if flight.outcome != RETURNED:
            return math.inf
        done, apart = count, moved - near.x
        part = left @ apart
        plane = np.real(part * right) * (1 if real else 2)
        if not np.linalg.norm(apart - plane) <= DEPARTS * np.linalg.norm(apart):
            return math.inf
        faster = math.log(abs(part) / before) / (count * near.cycle.period) / near.cycle.growth_rate - 1
    return faster


def _period(map_: ReturnMap, x: Array) -> tuple[float, int]:
    """Least change from a release to a later one, relative to the static deflection, and how many lie between."""
    size = float(np.linalg.norm(map_.static))
    changes = [float(np.linalg.norm(now - x) / size) for now in map_.returns(x, LARGEST_PERIOD, coarse=True)]
    if not changes:
        return math.nan, 0
    # of those that are about as good the shortest
    releases = next(i for i, change in enumerate(changes, 1) if change <= 2 * min(changes))
    return changes[releases - 1], releases


def _nears_sliding(p: Parameters, state: State, tol: float) -> bool:
    """Whether a motion that slides nears stable steady sliding as the eigenvalues there say."""
    sliding = steady_sliding(p)
    if not sliding.stable or contact_give(p):  # a compliant contact has coordinates of its own
        return False
    modes = mode_arrays(p)
    ones = np.ones_like(modes.omega)
    # with these factors the norm of rows is that of the energy
    scale = _rows(modes, (modes.omega, ones, modes.omega, ones), (p.r_0 * math.sqrt(p.k_p), p.r_0 * math.sqrt(p.m)))
    jacobian = scale[:, None] * sliding.jacobian / scale
    expected = scale * _from_sliding(p, sliding, state)
    static = p.N * float(np.linalg.norm(modes.psi / modes.omega))
    if not np.linalg.norm(expected) <= NEAR * static:
        return False
    leading, parts, before = _left_vector(jacobian, np.real), list[float](), 0.0
    for time in SLIDING_TIMES:
        result = simulate(p, state.time + time, tol=tol, initial_state=state, record=Record(events=False))
        if not result.status.complete or result.final_state.phase != "slip":
            return False
        apart = scale * _from_sliding(p, sliding, result.final_state)
        expected = expm(jacobian * (time - before)) @ expected
        size = float(np.linalg.norm(expected))
        if not np.linalg.norm(apart - expected) <= max(AGREES * size, NOISE * static):
            return False
        parts.append(float(abs(leading @ apart)))
        before = time
    if parts[1] <= NOISE * static:
        return True
    rate = math.log(parts[1] / parts[0]) / (SLIDING_TIMES[1] - SLIDING_TIMES[0])
    return abs(rate - sliding.growth_rate) <= RATE_AGREES * abs(sliding.growth_rate)


def _from_sliding(p: Parameters, sliding: SteadySliding, state: State) -> Array:
    """Distance from steady sliding, in the rows of its Jacobian."""
    disc = [getattr(state, name) - getattr(sliding, name) for name in ("a", "alpha", "b", "beta")]
    return _rows(mode_arrays(p), disc, (state.psi - sliding.psi, state.f - p.Omega))


def _rows(modes: Modes, disc: Sequence[Array], slider: Sequence[float]) -> Array:
    """Rows of steady sliding's Jacobian from a, alpha, b, beta of all modes and psi, f."""
    a, alpha, b, beta = disc
    pairs = modes.diameters > 0
    return np.concatenate([a, alpha, b[pairs], beta[pairs], slider])
