"""Assignment of many motions of a case to attractors: the quiet cycle, a known attractor, or a new one.

A motion is followed in legs of some seconds, as docs/algorithms.md, Identifying the outcome, describes.  A motion that
stays near an unstable cycle has not settled. A new attractor that is not periodic must persist to the horizon, because
the motion might only be passing an unstable one.
"""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from disc_model.analysis.classify import CLOSES, FEWEST, SETTLED, closure, shortest_period
from disc_model.analysis.settling import Settled, Settling, settling
from disc_model.data.variables import Outcome
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State, perturb, static_start
from disc_model.stability.attractor.neighbourhood import (
    LARGEST_PERIOD,
    NEAR,
    SAME_POINT,
    NearCycle,
    cycle_near,
    cycle_of_static_start,
    follows,
    recurrence,
)
from disc_model.stability.attractor.outcome import (
    FIRST_LEG,
    RATE,
    Attractor,
    OutcomeResult,
    Segment,
    at_rest,
    final_segment,
    segment_of,
)
from disc_model.stability.cycle import may_stick_and_slip
from disc_model.stability.lyapunov import CLEAR, CONVERGED, lyapunov_exponents
from disc_model.stability.return_map import RETURNED, ReturnMap, case_faults

NEARING, SETTLING = 4, 8
"""Legs over which a motion must approach a known attractor, and over which it must be steady on another one."""
STEADY = 1e-3
"""Largest relative change of the range over those legs without a drift: that of a periodic motion is a tenth of it."""
SAME = 0.05
"""Segments that differ by less belong to one attractor; the extrapolated rest of a drift may reach half of it."""
SMALLEST = 1e-3
"""Range, over the static deflection, below which ranges count as equal: the slider's height is constant."""
OWN_STARTS = (0.0, 0.25, 0.5, 1.0, 2.0)
"""Downward perturbations of the static start from which attractors are sought, over the static deflection."""


class Basins:
    """The attractors of a case: the quiet cycle, and those reached from `OWN_STARTS` and from later starts.

    Parameters
    ----------
    horizon : s, longest simulated time of a motion
    near : relative difference in range from an attractor within which an approaching motion counts as being on it;
        with 0 all motions are followed to the horizon

    Attributes
    ----------
    known : attractors in the order in which they were found
    """

    def __init__(self, p: Parameters, horizon: float, *, near: float = 0.1, tol: float = 1e-10) -> None:
        self.p, self.horizon, self.near, self.tol = p, horizon, near, tol
        modes = mode_arrays(p)
        self.static = p.N * float(np.sum(modes.psi**2 / modes.omega**2))
        self.smallest = max(SMALLEST * self.static, sys.float_info.min)
        self.map = ReturnMap(p, patient=True)
        found = cycle_of_static_start(p)
        self.cycle = found if isinstance(found, NearCycle) and found.cycle.stable else None
        self.known: list[Attractor] = []
        if self.cycle is not None:
            assert self.cycle.cycle.state is not None
            self.known.append(self._periodic(self.cycle, segment_of(self._leg(self.cycle.cycle.state, FIRST_LEG))))
        for kick in OWN_STARTS:
            start = static_start(p)
            self.reached(perturb(p, start, u=-kick * self.static) if kick else start)

    def reached(self, state: State) -> OutcomeResult:
        """Outcome of the motion from a state at time 0; a new attractor is added to `known`."""
        stretches: list[Segment] = []
        first, since, least = math.nan, -1, math.inf
        while True:
            result = self._leg(state, min(state.time + FIRST_LEG, self.horizon))
            state = result.final_state
            first = result.first_separation if math.isnan(first) else first
            if not result.status.complete:
                return OutcomeResult(None, state.time, first_separation=first, failed=result)
            stretches.append(segment_of(result))
            over, found = state.time >= self.horizon, None
            if self.near:
                nears, least = self._nears(stretches, state, least)
                found = self.known[0] if nears else self._found([stretch.range for stretch in stretches[-NEARING:]])
            if not self._settled(stretches):
                since = -1
            elif found is None and (over or (self.near and since < 0)):
                stays = over and self._difference(stretches[since], stretches[-1]) <= SETTLED
                found = self._settled_on(result, stays)
                since = len(stretches) - 1 if since < 0 else since
            if found is not None:
                return OutcomeResult(found.kind, state.time, attractor=found, first_separation=first)
            if over:
                return OutcomeResult(Outcome.UNDECIDED, state.time, first_separation=first)

    def _leg(self, state: State, end: float) -> Result:
        # the range is taken over thirty oscillations or more
        window = Window(start=max(end - 0.5, state.time), stop=end, rate=RATE)
        return simulate(self.p, end, tol=self.tol, initial_state=state, record=window)

    def _difference(self, one: Segment, other: Segment) -> float:
        """Largest relative difference of ranges, shares of the phases and separations per second.

        Differences of shares below `SAME`, and of less than two separations in a leg, are relative to these limits.
        """
        ranges = [max(stretch.range, self.smallest) for stretch in (one, other)]
        compared = [(*ranges, self.smallest), (one.separation_rate, other.separation_rate, 2 / FIRST_LEG)]
        compared += [
            (getattr(one, name), getattr(other, name), SAME) for name in ("stick_fraction", "separation_fraction")
        ]
        return max(abs(a - b) / max(a, b, floor) for a, b, floor in compared)

    def _nears(self, stretches: Sequence[Segment], state: State, least: float) -> tuple[bool, float]:
        """Whether the motion approaches the quiet cycle as its multipliers predict, and the new `least`.

        least : smallest distance tested so far; a test is made only at a smaller one
        """
        last, near = stretches[-1], self.cycle
        if near is None or last.separation_rate > 0 or last.range > stretches[0].range:
            return False, least
        code, x = self.map.next_release(state)
        if code == RETURNED:
            for at in chain([x], self.map.returns(x, near.cycle.releases - 1)):
                distance = float(np.linalg.norm(at - near.x))
                if distance <= NEAR * self.map.deflection:
                    return distance < least and follows(near, at), min(distance, least)
        return False, least

    def _found(self, ranges: Sequence[float]) -> Attractor | None:
        """The known attractor that the motion approaches before it has settled; None if there is none."""
        others = [attractor for attractor in self.known if attractor.kind is not Outcome.QUIET]
        if len(ranges) < NEARING or not others:
            return None
        ends = [attractor.segment.range for attractor in others]
        apart = [[abs(one - end) / max(one, end, sys.float_info.min) for one in ranges] for end in ends]
        nearest = min(range(len(others)), key=lambda i: apart[i][-1])
        if any(distances[-1] <= 2 * self.near for i, distances in enumerate(apart) if i != nearest):
            return None
        last = apart[nearest][-1]
        nearing = all(later < earlier or later <= SETTLED for earlier, later in pairwise(apart[nearest]))
        slows = _left(ranges) <= (2 * last + SETTLED) * ranges[-1]
        return others[nearest] if last <= self.near and nearing and slows else None

    def _settled(self, stretches: Sequence[Segment]) -> bool:
        last = stretches[-SETTLING:]
        if len(last) < SETTLING or any(self._difference(one, last[-1]) > SETTLED for one in last[:-1]):
            return False
        ranges = [max(stretch.range, self.smallest) for stretch in last]
        return abs(ranges[-1] - ranges[0]) <= STEADY * ranges[-1] or _left(ranges) <= SAME / 2 * ranges[-1]

    def _settled_on(self, leg: Result, stays: bool) -> Attractor | None:
        """The attractor of a motion that has settled; None as long as it is uncertain.

        stays : whether the motion has been steady until the horizon
        """
        found = self._described(leg)
        if found is None:
            return None
        same = next((attractor for attractor in self.known if self._same(found, attractor)), None)
        if same is None and (stays or found.points is not None):
            if found.kind is Outcome.UNDECIDED:
                found = replace(found, kind=regularity(self.p, leg.final_state, self.tol).kind)
            self.known.append(found)
            return found
        return same

    def _described(self, leg: Result) -> Attractor | None:
        """The attractor of a motion, undecided if it is neither a cycle nor rest; None near an unstable cycle."""
        stretch = segment_of(leg)
        calm = at_rest(self.p, leg, self.tol)
        if calm is not None:
            return Attractor(calm, stretch)
        near = cycle_reached(self.p, leg, LARGEST_PERIOD)
        if near is not None and near.follows_cycle:  # of stable cycles only
            return self._periodic(near, stretch)
        if near is not None and near.lingers:
            return None
        return Attractor(Outcome.UNDECIDED, stretch)

    def _same(self, one: Attractor, other: Attractor) -> bool:
        """Whether two attractors are the same: periodic ones by their fixed points, others by their segments."""
        if one.points is not None and other.points is not None:
            apart = min(float(np.linalg.norm(one.points[0] - point)) for point in other.points)
            return apart <= SAME_POINT * self.map.deflection
        return self._difference(one.segment, other.segment) <= SAME

    def _periodic(self, near: NearCycle, stretch: Segment) -> Attractor:
        cycle = near.cycle
        points = [near.x, *near.map.returns(near.x, cycle.releases - 1, may_separate=True)]
        return Attractor(near.kind, stretch, cycle.period, cycle.releases, cycle.growth_rate, np.array(points))


class Arrival(NamedTuple):
    """What a motion has come to.

    Attributes
    ----------
    settling : whether it has settled
    calm : `AT_REST` or `STEADY_SLIDING` if that is what it has come to, else None
    near : the stable cycle that it follows, by its multipliers, else None
    """

    settling: Settling
    calm: Outcome | None = None
    near: NearCycle | None = None

    @property
    def settled(self) -> bool:
        return self.settling.answer is Settled.SETTLED


def arrival(p: Parameters, leg: Result, tol: float) -> Arrival:
    """What a motion has come to at the end of a leg, recorded with its events.

    Rest, eigenvalues of steady sliding and multipliers of a stable cycle prove it. Otherwise the record decides,
    by the angles at releases and at losses of contact.
    """
    if (calm := at_rest(p, leg, tol)) is not None:
        return Arrival(Settling(Settled.SETTLED, least=0.0, since=leg.final_state.time), calm)
    near = cycle_reached(p, leg)
    if near is not None and near.follows_cycle:  # of stable cycles only
        rate, since = near.cycle.growth_rate, leg.final_state.time
        return Arrival(Settling(Settled.SETTLED, rate, 0.0, since), near=near)
    if near is not None and near.lingers:
        return Arrival(Settling(Settled.CHANGING, near.cycle.growth_rate, 0.0))
    events = leg.events[leg.events["kind"].isin(["stick_to_slip", "separation"])]
    return Arrival(settling(events["time"], events["psi"]))


def cycle_reached(p: Parameters, stretch: Result, most: int = sys.maxsize) -> NearCycle | None:
    """The cycle near the end of a simulated motion, recorded with its events; the cycle may lose contact.

    Periods of up to half the releases of the last `FIRST_LEG` are tried, and of up to `most` releases.
    """
    last = stretch.events[stretch.events["time"] > stretch.final_state.time - FIRST_LEG]
    releases = int((last["kind"] == "stick_to_slip").sum())
    if not releases or not may_stick_and_slip(p) or case_faults(p, "a cycle"):
        return None
    map_ = ReturnMap(p, patient=True)
    code, x = map_.next_release(stretch.final_state)
    if code != RETURNED:
        return None
    again = recurrence(map_, x, max(1, min(most, releases // 2)), may_separate=True)
    return cycle_near(map_, x, again, may_separate=True)


def sweep(
    p: Parameters, name: str, values: Sequence[float], dwell: float, longest: float, late: float, tol: float
) -> Iterator[tuple[tuple[int, int], Result, Segment | None, Arrival]]:
    """Follow the motion through values of a parameter, up and down again.

    It stays ``dwell`` s at each value, and twice as long until it has settled, up to ``longest`` s; from a stable cycle
    that it follows it continues exactly. Yields the direction (0 up, 1 down) and the index of the value, the last run
    there, its last segment of ``late`` s, and what the motion has come to. If a run ends early, the segment is None and
    the sweep ends.
    """
    state: State | None = None
    for place in [(0, i) for i in range(len(values))] + [(1, i) for i in reversed(range(len(values)))]:
        case = p.replace(**{name: values[place[1]]})
        begin, stay = 0.0 if state is None else state.time, dwell
        while True:
            result = simulate(case, begin + stay, tol=tol, initial_state=state)
            if not result.status.complete:
                yield place, result, None, Arrival(Settling())
                return
            state, reached = result.final_state, arrival(case, result, tol)
            if reached.settled or 2 * stay > longest:
                break
            stay *= 2
        if reached.near is not None:
            state = reached.near.cycle.state
        result, segment = final_segment(case, state, late, late, tol)
        yield place, result, segment, reached
        state = result.final_state


class Regularity(NamedTuple):
    """Kind of a motion; number of events after which it repeats, 0 if that is not shown; closure, s."""

    kind: Outcome
    period: int = 0
    closure: float = math.nan


def regularity(p: Parameters, state: State, tol: float) -> Regularity:
    """Regularity of the motion from a state, by its separations, or else its releases, and by its largest exponent.

    The exponent along the motion is excluded. The largest one is zero on a torus and positive in chaos. If it is
    negative, all neighbouring motions converge to one cycle, even if its period is too long to be observed.
    """
    run = simulate(p, state.time + SETTLING * FIRST_LEG, tol=tol, initial_state=state)
    times, kinds = run.events["time"].to_numpy(dtype=float), run.events["kind"].to_numpy()
    separates = bool((kinds == "separation").any())
    intervals = np.diff(times[kinds == ("separation" if separates else "stick_to_slip")])
    if not run.status.complete or len(intervals) < FEWEST:
        return Regularity(Outcome.UNDECIDED)
    periodic = Outcome.SEPARATING if separates else Outcome.OTHER_CYCLE
    if n := shortest_period(intervals, CLOSES):
        return Regularity(periodic, n, closure(intervals, n))
    duration = SETTLING * FIRST_LEG / 2
    # exponents below -90/s are not resolved by this interval; such a motion repeats
    found = lyapunov_exponents(
        p, duration, count=1, interval=0.25, initial_state=state, tol=tol, leave_out_trivial=True
    )
    rate, error = float(found.exponents[0]), float(found.errors[0])
    if not (math.isfinite(rate) and math.isfinite(error)):
        return Regularity(Outcome.UNDECIDED)
    if abs(rate) <= max(CLEAR * error, CONVERGED[1]):
        return Regularity(Outcome.QUASI_PERIODIC)
    return Regularity(Outcome.IRREGULAR if rate > 0 else periodic)


def random_perturbation(p: Parameters, state: State, energy: float, key: Sequence[int]) -> State:
    """A state after a perturbation of given energy in a random direction.

    The direction is uniform in the energy norm of the disc's modes: omega a, omega b, alpha, beta of each.  The slider
    moves with the disc; f and psi are unchanged.  The energy (J) is that of the perturbation alone: of the modes, of
    the slider's mass m and of its spring k.

    Parameters
    ----------
    key : whole numbers that determine the direction
    """
    if energy == 0:
        return state
    modes = mode_arrays(p)
    draw = np.random.default_rng(list(key)).standard_normal((4, len(modes.omega)))
    draw[2:, modes.diameters == 0] = 0.0
    a, alpha, b, beta = draw[0] / modes.omega, draw[1], draw[2] / modes.omega, draw[3]
    u, velocity = float(modes.psi @ a), float(modes.psi @ alpha)
    own = 0.5 * (float(np.sum(draw**2)) + p.k * u**2 + p.m * velocity**2)
    size = math.sqrt(energy / own)
    slope = float(np.sum(modes.diameters * modes.psi * b))
    return state.replace(
        a=state.a + size * a,
        b=state.b + size * b,
        alpha=state.alpha + size * alpha,
        beta=state.beta + size * beta,
        u=state.u + size * u,
        u_velocity=state.u_velocity + size * (velocity + state.f * slope),
    )


def _left(values: Sequence[float]) -> float:
    """Extrapolated rest of a drift of the values, by a geometric series; infinite if the changes do not decrease."""
    changes = np.diff(values[-4:])
    before, last = abs(changes[-2]), abs(changes[-1])
    if not (np.all(changes > 0) or np.all(changes < 0)):
        return 0.0
    return float(last**2 / (before - last)) if last < before else math.inf
