"""What motions come to: proof of one motion's arrival, sweeps through a parameter, and the
attractors of a case.

docs/method.md, Settled motions, describes the legs and tests. Maps do without these and
without exponents.
"""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from disc_model.analysis.classify import (
    CLOSES,
    FEWEST,
    Motion,
    Settled,
    closure,
    settling,
    shortest_period,
)
from disc_model.data.variables import Outcome
from disc_model.disc.plate import mode_arrays, tangential_amplitudes
from disc_model.engine.record import LOSS_OF_CONTACT, STICK_TO_SLIP
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.result import Result
from disc_model.simulation.states import State, perturb, slip_rate, static_start
from disc_model.stability.cycle import may_stick_and_slip
from disc_model.stability.follower import (
    FIRST_LEG,
    LARGEST_PERIOD,
    NEAR,
    SAME_POINT,
    Attractor,
    NearCycle,
    OutcomeResult,
    close_return,
    cycle_of_static_start,
    find_cycle_near,
    find_equilibrium,
)
from disc_model.stability.lyapunov import CLEAR, CONVERGED, lyapunov_exponents
from disc_model.stability.return_map import ReturnMap
from disc_model.stability.segments import (
    ANGLE,
    KIND,
    TIME,
    Segment,
    event_times,
    final_segment,
    late_window,
    segment_of,
)
from disc_model.stability.sliding import height_of_slider, steady_sliding

# legs over which a motion approaches a known attractor, and is steady on another one
NEARING, SETTLING = 4, 8
# largest relative change of ranges, rates and shares over 40 s of a settled motion: aperiodic ones
# vary by half of it
VARIATION = 0.01
# s over which intervals of a motion that never sticks must repeat to `CLOSES`: at 100 Hz that shows
# rates of `SLOWEST`, as a record of 200 s does that is known to 1 %
REPETITION = 40.0
SAME = 0.05  # segments that differ by less are of one attractor; the rest of a drift may reach half of it
APPROACHED = 0.1  # relative difference in range from an attractor that a motion approaches
SMALLEST = 1e-3  # range, over the static deflection, below which ranges count as equal
# downward, over the static deflection, from which attractors are sought
OWN_STARTS = (0.0, 0.25, 0.5, 1.0, 2.0)
EQUILIBRIA = {Outcome.AT_REST, Outcome.STEADY_SLIDING}
"""Kinds of which a case has one attractor."""


class Arrival(NamedTuple):
    """Whether a motion has settled, with what proves it; without proof, a record decides.

    answer : whether it has settled
    calm : rest or steady sliding that is reached; None if neither is proven
    near : stable cycle that the motion follows by its multipliers; None if that is not proven
    stay : s, for which the motion was followed
    """

    answer: Settled = Settled.UNDECIDED
    calm: Outcome | None = None
    near: NearCycle | None = None
    stay: float = math.nan

    def end(self, run: Result) -> State:
        """The state after the last run: on the attractor, if that is known exactly."""
        if self.near is not None and self.near.cycle.state is not None:
            return self.near.cycle.state
        return run.final_state


def arrival(p: Parameters, legs: Sequence[Result]) -> Arrival:
    """What a motion has come to at the end of its legs: what rest, eigenvalues of steady sliding or
    multipliers of a cycle prove; otherwise what the record of its events shows."""
    return proof(p, legs[-1]) or Arrival(settling_of(legs))


def proof(p: Parameters, leg: Result, most: int = sys.maxsize) -> Arrival | None:
    """What rest, eigenvalues of steady sliding or multipliers of a cycle of up to `most` releases prove
    at the end of a leg, also that the motion lingers near an unstable cycle."""
    calm = find_equilibrium(p, leg)
    if calm is not None:
        return Arrival(Settled.SETTLED, calm=calm)
    near = _cycle_reached(p, leg, most)
    if near is not None and near.follows_cycle:  # of stable cycles only
        return Arrival(Settled.SETTLED, near=near)
    if near is not None and near.lingers:
        return Arrival(Settled.CHANGING)
    return None


def settling_of(legs: Sequence[Result]) -> Settled:
    """Whether a motion has settled by the record of its angles at releases and separations. If it
    loses contact and never sticks, it does not come to the section of the return map, so that
    multipliers cannot tell: it has settled if its losses repeat over the last `REPETITION` s."""
    rows = np.vstack([leg.event_rows for leg in legs])
    end = legs[-1].final_state.time
    since = end - REPETITION
    kind, time = rows[:, KIND], rows[:, TIME]
    losses = time[kind == LOSS_OF_CONTACT]
    late = np.diff(losses[losses > since])
    if len(late) >= FEWEST and not np.any(time[kind == STICK_TO_SLIP] > since):
        # from before the record to its end, and not only from each to the next: drifts are slow
        goes_on = losses[0] <= since and end - losses[-1] <= 2 * late.max()
        period = shortest_period(late) if goes_on else 0
        if period and max(float(np.ptp(late[i::period])) for i in range(period)) <= CLOSES:
            return Settled.SETTLED
    switches = np.isin(kind, (STICK_TO_SLIP, LOSS_OF_CONTACT))
    return settling(time[switches], rows[switches, ANGLE]).answer


def _cycle_reached(p: Parameters, leg: Result, most: int) -> NearCycle | None:
    """The cycle near the end of a simulated motion, recorded with its events; the cycle may lose
    contact. Periods of up to half the releases of the last `FIRST_LEG` are tried, or of the whole
    leg if a slow motion has none there, and of up to `most` releases."""
    times = event_times(leg, STICK_TO_SLIP)
    releases = int(np.sum(times > leg.final_state.time - FIRST_LEG)) or len(times)
    if not releases or not may_stick_and_slip(p):
        return None
    map_ = ReturnMap(p, patient=True)
    release = map_.next_release(leg.final_state)
    if not release.reached:
        return None
    change, period = close_return(map_, release.x, max(1, min(most, releases // 2)))
    return find_cycle_near(map_, release, change, period)


def settle(
    p: Parameters, state: State | None, stay: float, longest: float, tol: float
) -> tuple[list[Result], Arrival]:
    """Legs of the motion from a state, over a stay (s) that is doubled until it has settled, `longest` s
    at most; and its arrival. The last leg may end early."""
    begin = 0.0 if state is None else state.time
    legs = list[Result]()
    while True:
        leg = simulate(p, begin + stay, tol=tol, initial_state=state)
        legs.append(leg)
        if not leg.status.complete:
            return legs, Arrival()
        reached = arrival(p, legs)
        if reached.answer is Settled.SETTLED or 2 * stay > longest:
            return legs, reached._replace(stay=stay)
        state = leg.final_state
        stay *= 2


def sweep(
    p: Parameters,
    name: str,
    values: Sequence[float],
    dwell: float,
    longest: float,
    late: float,
    tol: float,
    lowest: int = 0,
) -> Iterator[tuple[tuple[int, int], Result, Segment | None, Arrival]]:
    """Follow the motion through values of a parameter, up from that of index ``lowest`` and down
    again to the first.

    It stays ``dwell`` s at each value, then twice as long until it has settled, ``longest`` s at
    most; from a stable cycle it continues exactly. Yields direction (0 up, 1 down) and index of the
    value, the last run there, its last segment of ``late`` s, or None if a run ends early, and the
    arrival.
    """
    state: State | None = None
    up = [(0, i) for i in range(lowest, len(values))]
    down = [(1, i) for i in reversed(range(len(values)))]
    for step in up + down:
        case = p.replace(**{name: values[step[1]]})
        legs, reached = settle(case, state, dwell, longest, tol)
        if not legs[-1].status.complete:
            yield step, legs[-1], None, reached
            return
        result, segment = final_segment(case, reached.end(legs[-1]), late, late, tol)
        yield step, result, segment, reached
        state = result.final_state


def regularity(p: Parameters, state: State, tol: float) -> Motion:
    """Regularity of the motion from a state, by its separations, or else its releases, and by its
    largest exponent but that along the motion: zero on a torus, positive in chaos, negative on a
    cycle, however long its period."""
    duration = SETTLING * FIRST_LEG
    run = simulate(p, state.time + duration, tol=tol, initial_state=state)
    periodic = Outcome.SEPARATING
    times = event_times(run, LOSS_OF_CONTACT)
    if not times.size:
        periodic = Outcome.OTHER_CYCLE
        times = event_times(run, STICK_TO_SLIP)
    intervals = np.diff(times)
    if not run.status.complete or len(intervals) < FEWEST:
        return Motion(Outcome.UNDECIDED)

    # a short period shows in the record
    period = shortest_period(intervals)
    if period:
        return Motion(periodic, period, closure(intervals, period))

    # otherwise the largest exponent decides; below -90/s it is not resolved by this interval, but
    # such a motion repeats
    largest = lyapunov_exponents(
        p, duration / 2, count=1, interval=0.25, initial_state=state, tol=tol
    )
    rate = float(largest.exponents[0])
    error = float(largest.errors[0])
    if not (math.isfinite(rate) and math.isfinite(error)):
        return Motion(Outcome.UNDECIDED)
    if abs(rate) <= max(CLEAR * error, CONVERGED[1]):
        return Motion(Outcome.QUASI_PERIODIC)
    return Motion(Outcome.IRREGULAR if rate > 0 else periodic)


class Basins:
    """The attractors of a case, `known` in the order in which they were found: the stick-slip cycle, and
    those reached from `OWN_STARTS` and from later starts.

    Motions are followed to the horizon (s). One that approaches an attractor counts as being on it.

    static : static deflection under the preload, m
    smallest : range of the height below which ranges count as equal, m
    cycle : the stick-slip cycle, if it exists and is stable
    """

    def __init__(self, p: Parameters, horizon: float, *, tol: float = 1e-10) -> None:
        self.p = p
        self.horizon = horizon
        self.tol = tol
        modes = mode_arrays(p)
        self.static = p.N * float(np.sum(modes.psi**2 / modes.omega**2))
        self.smallest = max(SMALLEST * self.static, sys.float_info.min)
        self.map = ReturnMap(p, patient=True)
        self.cycle: NearCycle | None = None
        self.known: list[Attractor] = []
        near_start = cycle_of_static_start(p)
        if isinstance(near_start, NearCycle) and near_start.cycle.stable:
            self.cycle = near_start
            self.known.append(self._periodic(near_start, self._segment_of_cycle(near_start)))
        for kick in OWN_STARTS:
            start = static_start(p)
            self.follow(perturb(p, start, u=-kick * self.static) if kick else start)

    def follow(self, state: State) -> OutcomeResult:
        """Outcome of the motion from a state at time 0; a new attractor is added to `known`."""
        result = OutcomeResult(Outcome.UNDECIDED)
        legs = list[Result]()
        segments = list[Segment]()
        steady = False
        while result.attractor is None and state.time < self.horizon:
            # a leg; the first takes what the others, which are of one length, leave of the horizon
            later_legs = (self.horizon - state.time) // FIRST_LEG - 1
            leg = self._simulate_leg(state, self.horizon - max(later_legs, 0) * FIRST_LEG)
            legs.append(leg)
            state = leg.final_state
            result.simulated = state.time
            if math.isnan(result.first_separation):
                result.first_separation = leg.first_separation
            if not leg.status.complete:
                return replace(result, outcome=None, failed=leg)
            segments.append(segment_of(leg))

            # an attractor that the motion approaches, or one on which it is, when it becomes steady,
            # and at the horizon
            was_steady, steady = steady, self._is_steady(segments)
            over = state.time >= self.horizon
            result.attractor = self._approached(segments, state)
            if result.attractor is None and (over or (steady and not was_steady)):
                result.attractor = self._settled_on(legs, segments[-1], steady=steady, over=over)
        if result.attractor is not None:
            result.outcome = result.attractor.kind
        return result

    def _simulate_leg(self, state: State, end: float) -> Result:
        # the range is taken over thirty oscillations or more
        window = late_window(max(end - 0.5, state.time), end)
        return simulate(self.p, end, window, tol=self.tol, initial_state=state)

    def _segment_of_cycle(self, near: NearCycle) -> Segment:
        """A segment of a motion on a cycle."""
        state = near.cycle.state
        assert state is not None
        return segment_of(self._simulate_leg(state, state.time + FIRST_LEG))

    def _difference(self, first: Segment, second: Segment) -> float:
        """Largest difference of ranges, rates and shares, relative to the larger one or to a
        floor."""
        a, b = (
            (
                max(x.range, self.smallest),
                x.separation_rate,
                x.stick_fraction,
                x.separation_fraction,
            )
            for x in (first, second)
        )
        floors = (self.smallest, 2 / FIRST_LEG, SAME, SAME)
        apart = np.abs(np.subtract(a, b)) / np.max([a, b, floors], axis=0)
        return float(apart.max())

    def _approached(self, segments: Sequence[Segment], state: State) -> Attractor | None:
        """The attractor that a motion approaches: the stick-slip cycle, as its multipliers predict, or
        the one whose range of the height those of the last legs approach, ever more slowly."""
        if segments[-1].separation_rate == 0 and self._follows_cycle(state):
            return self.known[0]
        ranges = [segment.range for segment in segments[-NEARING:]]
        others = [each for each in self.known if each.kind is not Outcome.STICK_SLIP]
        # the height over a rigid disc never changes
        if self.static == 0 or len(ranges) < NEARING or not others:
            return None

        # it must be near, and no other one nearly as near
        last = [_relative_difference(ranges[-1], each.segment.range) for each in others]
        distance, *rivals = sorted(last)
        if distance > APPROACHED or (rivals and rivals[0] <= 2 * APPROACHED):
            return None

        # it must be approached from leg to leg
        nearest = others[last.index(distance)]
        distances = [_relative_difference(value, nearest.segment.range) for value in ranges]
        parts = any(b >= a and b > VARIATION for a, b in pairwise(distances))
        slows = _rest_of_drift(ranges) <= (2 * distance + VARIATION) * ranges[-1]
        return nearest if slows and not parts else None

    def _follows_cycle(self, state: State) -> bool:
        """Whether the motion from a state follows the stick-slip cycle."""
        if self.cycle is None:
            return False
        release = self.map.next_release(state)
        if not release.reached:
            return False
        points = [release.x, *self.map.returns(release.x, self.cycle.cycle.releases - 1)]
        close = [x for x in points if self.map.apart(x, self.cycle.x) <= NEAR]
        return bool(close) and self.cycle.follows_multipliers(close[0])

    def _is_steady(self, segments: Sequence[Segment]) -> bool:
        """Whether the last segments differ so little, and drift so slowly, that a motion may have
        settled."""
        last = segments[-SETTLING:]
        if len(last) < SETTLING:
            return False
        ranges = [max(segment.range, self.smallest) for segment in last]
        varies = max(self._difference(segment, last[-1]) for segment in last) > VARIATION
        return not varies and _rest_of_drift(ranges) <= SAME / 2 * ranges[-1]

    def _settled_on(
        self, legs: Sequence[Result], last: Segment, *, steady: bool, over: bool
    ) -> Attractor | None:
        """The attractor on which a motion is, if that is proven, the whole record has settled and
        is `over`, or the last legs are as steady as those on a known attractor; None near an
        unstable cycle."""
        reached = proof(self.p, legs[-1], LARGEST_PERIOD)
        settled = reached is not None or (over and settling_of(legs) is Settled.SETTLED)
        if reached is None:
            attractor = Attractor(Outcome.UNDECIDED, last)
        elif reached.near is not None:
            # segments of a motion that is not steady have a transient
            segment = last if steady else self._segment_of_cycle(reached.near)
            attractor = self._periodic(reached.near, segment)
        elif reached.calm is not None:
            slides = reached.calm is Outcome.STEADY_SLIDING
            attractor = Attractor(reached.calm, _segment_of_sliding(self.p) if slides else last)
        else:
            return None

        for known in self.known:
            if self._same(attractor, known):
                return known if settled or steady else None
        if not settled:
            return None
        if reached is None:
            kind = regularity(self.p, legs[-1].final_state, self.tol).kind
            attractor = replace(attractor, kind=kind)
        self.known.append(attractor)
        return attractor

    def _same(self, first: Attractor, second: Attractor) -> bool:
        """Whether two attractors are the same: equilibria by their kinds, periodic ones by their
        fixed points, others by their segments."""
        kinds = {first.kind, second.kind}
        if kinds & EQUILIBRIA and Outcome.UNDECIDED not in kinds:
            return len(kinds) == 1
        if first.points is not None and second.points is not None:
            return min(self.map.apart(x, first.points[0]) for x in second.points) <= SAME_POINT
        return self._difference(first.segment, second.segment) <= SAME

    def _periodic(self, near: NearCycle, segment: Segment) -> Attractor:
        """A cycle as an attractor, with a segment of a motion on it."""
        cycle = near.cycle
        others = near.map.returns(near.x, cycle.releases - 1)
        points = np.array([near.x, *others])
        return Attractor(near.kind, segment, cycle.period, cycle.releases, points)


def _segment_of_sliding(p: Parameters) -> Segment:
    """The segment of steady sliding itself, without the transient of a motion that approaches it."""
    sliding = steady_sliding(p)
    P = sliding.contact_force
    height = float(height_of_slider(p, sliding) - static_start(p).u)
    return Segment(P, P, height, height, 0.0, 1.0, 0.0, 0.0)


def random_perturbation(p: Parameters, state: State, energy: float, key: Sequence[int]) -> State:
    """A state after a perturbation of given energy (J), of modes, mass m and spring k, in a random
    direction, by whole numbers, its `key`: uniform in the energy norm of the modes. The slider
    moves with the disc and its surface; psi and the slip speed stay."""
    if energy == 0:
        return state
    modes = mode_arrays(p)
    draw = np.random.default_rng(list(key)).standard_normal((4, len(modes.omega)))
    draw[2:, modes.diameters == 0] = 0.0
    a = draw[0] / modes.omega
    alpha = draw[1]
    b = draw[2] / modes.omega
    beta = draw[3]
    u = float(modes.psi @ a)
    velocity = float(modes.psi @ alpha)
    surface = float(tangential_amplitudes(p) @ beta)
    squares = p.k * u**2 + p.m * velocity**2 + p.m * surface**2
    size = math.sqrt(energy / (0.5 * (float(np.sum(draw**2)) + squares)))
    slope = float(np.sum(modes.diameters * modes.psi * b))
    changes = {"a": a, "b": b, "alpha": alpha, "beta": beta, "u": u, "f": surface / p.r_0}
    changes["u_velocity"] = velocity + slip_rate(p, state) * slope
    return state.replace(
        **{name: getattr(state, name) + size * change for name, change in changes.items()}
    )


def _relative_difference(first: float, second: float) -> float:
    """Difference of two ranges over the larger one."""
    return abs(first - second) / max(first, second, sys.float_info.min)


def _rest_of_drift(values: Sequence[float]) -> float:
    """Extrapolated rest of a drift of the values, by a geometric series; infinite if the changes do
    not decrease."""
    changes = np.diff(values[-4:])
    before, last = np.abs(changes[-2:])
    if not (np.all(changes > 0) or np.all(changes < 0)):
        return 0.0
    return float(last**2 / (before - last)) if last < before else math.inf
