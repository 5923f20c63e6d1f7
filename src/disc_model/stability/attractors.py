"""What motions come to: proof of one motion's arrival, sweeps through a parameter, and the
attractors of a case.

docs/method.md, Settled motions, describes the legs and tests. Maps do without these and
without exponents.
"""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from disc_model.analysis.classify import (
    CLOSES,
    FEWEST,
    STILL,
    Motion,
    Settled,
    Settling,
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
    SAME_POINT,
    Attractor,
    NearCycle,
    OutcomeResult,
    close_return,
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

# s over which intervals of a motion that never sticks must repeat to `CLOSES`: at 100 Hz that shows
# rates of `SLOWEST`, as a record of 200 s does that is known to 1 %
REPETITION = 40.0
SAME = 0.05  # segments that differ by less are of one attractor
RECORD = 40.0  # s, of a settled motion by which its regularity is found
SMALLEST = 1e-3  # range, over the static deflection, below which ranges count as equal
# downward, over the static deflection, from which attractors are sought, too
OWN_STARTS = (0.25, 0.5, 1.0, 2.0)
EQUILIBRIA = {Outcome.AT_REST, Outcome.STEADY_SLIDING}
"""Kinds of which a case has one attractor."""


class Arrival(NamedTuple):
    """Whether a motion has settled, with what proves it; without proof, a record decides.

    settling : the answer, with rates
    calm : rest or steady sliding that is reached; None if neither is proven
    near : stable cycle that the motion follows by its multipliers; None if that is not proven
    stay : s, for which the motion was followed
    """

    settling: Settling
    calm: Outcome | None = None
    near: NearCycle | None = None
    stay: float = math.nan

    @property
    def settled(self) -> bool:
        return self.settling.answer is Settled.SETTLED

    def end(self, run: Result) -> State:
        """The state after the last run: on the attractor, if that is known exactly."""
        state = run.final_state
        if self.near is not None and self.near.cycle.state is not None:
            state = self.near.cycle.state
        return state


def arrival(p: Parameters, legs: Sequence[Result], most: int = sys.maxsize) -> Arrival:
    """What a motion has come to at the end of its legs: what rest, eigenvalues of steady sliding or
    multipliers of a cycle of up to `most` releases prove, also that it lingers near an unstable cycle;
    otherwise what the record of its events shows."""
    leg = legs[-1]
    now = leg.final_state.time
    equilibrium = find_equilibrium(p, leg)
    if equilibrium is not None:
        return Arrival(Settling(Settled.SETTLED, least=0.0, since=now), equilibrium)
    near = _cycle_reached(p, leg, most)
    if near is not None and near.follows_cycle:  # of stable cycles only
        return Arrival(Settling(Settled.SETTLED, near.cycle.growth_rate, 0.0, now), near=near)
    if near is not None and near.lingers:
        return Arrival(Settling(Settled.CHANGING, near.cycle.growth_rate, 0.0))
    return Arrival(settling_of(legs))


def settling_of(legs: Sequence[Result]) -> Settling:
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
        period = 0
        if goes_on:
            period = shortest_period(late)
        if period and max(float(np.ptp(late[i::period])) for i in range(period)) <= CLOSES:
            visible = CLOSES / (STILL * float(late.mean()))  # relative, as for other records
            return Settling(Settled.SETTLED, least=visible / REPETITION, since=since)
    switches = np.isin(kind, (STICK_TO_SLIP, LOSS_OF_CONTACT))
    return settling(time[switches], rows[switches, ANGLE])


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
    begin = 0.0
    if state is not None:
        begin = state.time
    legs = list[Result]()
    while True:
        leg = simulate(p, begin + stay, tol=tol, initial_state=state)
        legs.append(leg)
        if not leg.status.complete:
            return legs, Arrival(Settling())
        reached = arrival(p, legs)
        if reached.settled or 2 * stay > longest:
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
    run = simulate(p, state.time + RECORD, tol=tol, initial_state=state)
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
        p, RECORD / 2, count=1, interval=0.25, initial_state=state, tol=tol, leave_out_trivial=True
    )
    rate = float(largest.exponents[0])
    error = float(largest.errors[0])
    if not (math.isfinite(rate) and math.isfinite(error)):
        return Motion(Outcome.UNDECIDED)
    if abs(rate) <= max(CLEAR * error, CONVERGED[1]):
        return Motion(Outcome.QUASI_PERIODIC)
    return Motion(Outcome.IRREGULAR if rate > 0 else periodic)


class Basins:
    """The attractors of a case, `known` in the order in which they were found: those reached from the
    static start, from `OWN_STARTS` and from later starts, of motions followed to the horizon (s)."""

    def __init__(self, p: Parameters, horizon: float, *, tol: float = 1e-10) -> None:
        self.p = p
        self.horizon = horizon
        self.tol = tol
        self.known: list[Attractor] = []
        modes = mode_arrays(p)
        static = p.N * float(np.sum(modes.psi**2 / modes.omega**2))
        self.smallest = max(SMALLEST * static, sys.float_info.min)  # ranges below, in m, are equal
        start = static_start(p)
        self.follow(start)
        for kick in OWN_STARTS:
            self.follow(perturb(p, start, u=-kick * static))

    def follow(self, state: State) -> OutcomeResult:
        """Outcome of the motion from a state at time 0; a new attractor is added to `known`."""
        result = OutcomeResult(Outcome.UNDECIDED)
        legs = list[Result]()
        end = self.horizon / 2 ** max(0, int(math.log2(self.horizon / FIRST_LEG)))
        while result.attractor is None and end <= self.horizon:
            leg = self._simulate_leg(state, end)
            legs.append(leg)
            state = leg.final_state
            result.simulated = state.time
            if math.isnan(result.first_separation):
                result.first_separation = leg.first_separation
            if not leg.status.complete:
                return replace(result, outcome=None, failed=leg)
            result.attractor = self._attractor(legs)
            end *= 2
        if result.attractor is not None:
            result.outcome = result.attractor.kind
        return result

    def _simulate_leg(self, state: State, end: float) -> Result:
        # the range is taken over thirty oscillations or more
        window = late_window(max(end - 0.5, state.time), end)
        return simulate(self.p, end, window, tol=self.tol, initial_state=state)

    def _attractor(self, legs: Sequence[Result]) -> Attractor | None:
        """The attractor to which a motion has come, if that is proven or shown by its record, or if its
        last two legs are as on a known one that is not periodic."""
        reached = arrival(self.p, legs, LARGEST_PERIOD)
        last = [segment_of(leg) for leg in legs[-2:]]
        if not reached.settled:
            for known in self.known:
                alike = [self._difference(each, known.segment) <= SAME for each in last]
                if known.points is None and len(alike) == 2 and all(alike):
                    return known
            return None
        found = Attractor(reached.calm or Outcome.UNDECIDED, last[-1])
        if reached.near is not None:
            found = _periodic(reached.near, last[-1])
        for known in self.known:
            if self._same(found, known):
                return known
        self.known.append(self._described(found, legs[-1], reached))
        return self.known[-1]

    def _described(self, found: Attractor, leg: Result, reached: Arrival) -> Attractor:
        """An attractor with the segment on itself, without a transient, and with the kind that its
        motion shows if nothing is proven."""
        if reached.calm is Outcome.STEADY_SLIDING:
            return replace(found, segment=_segment_of_sliding(self.p))
        if reached.near is not None:
            state = reached.end(leg)
            segment = segment_of(self._simulate_leg(state, state.time + FIRST_LEG))
            return replace(found, segment=segment)
        if reached.calm is None:
            return replace(found, kind=regularity(self.p, leg.final_state, self.tol).kind)
        return found

    def _same(self, first: Attractor, second: Attractor) -> bool:
        """Whether two attractors are the same: equilibria by their kinds, periodic ones by their
        fixed points, others by their segments."""
        kinds = {first.kind, second.kind}
        if kinds & EQUILIBRIA and Outcome.UNDECIDED not in kinds:
            return len(kinds) == 1
        if first.points is not None and second.points is not None:
            apart = np.linalg.norm(second.points - first.points[0], axis=1)
            return bool(apart.min() <= SAME_POINT)
        return self._difference(first.segment, second.segment) <= SAME

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


def _periodic(near: NearCycle, segment: Segment) -> Attractor:
    """A cycle as an attractor, with a segment of a motion."""
    cycle = near.cycle
    others = near.map.returns(near.x, cycle.releases - 1, may_separate=True)
    points = np.array([near.x, *others]) / near.map.deflection
    return Attractor(near.kind, segment, cycle.period, cycle.releases, cycle.growth_rate, points)


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
    change = {"a": draw[0] / modes.omega, "b": draw[2] / modes.omega}
    change |= {"alpha": draw[1], "beta": draw[3]}
    surface = float(tangential_amplitudes(p) @ change["beta"])
    change |= {"u": float(modes.psi @ change["a"]), "f": surface / p.r_0}
    velocity = float(modes.psi @ change["alpha"])
    squares = p.k * change["u"] ** 2 + p.m * velocity**2 + p.m * surface**2
    energy_drawn = 0.5 * (float(np.sum(draw**2)) + squares)
    size = math.sqrt(energy / energy_drawn)
    slope = float(np.sum(modes.diameters * modes.psi * change["b"]))
    change["u_velocity"] = velocity + slip_rate(p, state) * slope
    moved = {name: getattr(state, name) + size * value for name, value in change.items()}
    return state.replace(**moved)
