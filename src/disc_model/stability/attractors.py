"""What motions come to: proof of one motion's arrival, sweeps through a parameter, and the
attractors of a case.

docs/study_method.md, Settled motions, describes the legs and tests. Maps do without these and
without exponents.
"""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from typing import Any, NamedTuple

import numpy as np

from disc_model.analysis.classify import (
    FEWEST,
    Motion,
    Settled,
    Settling,
    closure,
    settling,
    shortest_period,
)
from disc_model.data.variables import Outcome
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State, perturb, static_start
from disc_model.stability import thresholds
from disc_model.stability.cycle import may_stick_and_slip
from disc_model.stability.linear_motion import (
    NearCycle,
    cycle_of_static_start,
    find_cycle_near,
    find_near_return,
)
from disc_model.stability.lyapunov import CLEAR, CONVERGED, lyapunov_exponents
from disc_model.stability.outcome import (
    Attractor,
    OutcomeResult,
    Segment,
    final_segment,
    find_calm,
    segment_of,
    switch_angles,
)
from disc_model.stability.return_map import Array, ReturnMap


class Arrival(NamedTuple):
    """Whether a motion has settled, with the rest or sliding, or the stable cycle by its
    multipliers, as proof."""

    settling: Settling
    calm: Outcome | None = None
    near: NearCycle | None = None

    @property
    def settled(self) -> bool:
        return self.settling.answer is Settled.SETTLED


def arrival(p: Parameters, legs: Sequence[Result], most: int = sys.maxsize) -> Arrival:
    """What a motion has come to at the end of its legs: what rest, eigenvalues of steady sliding or
    multipliers of a cycle of up to `most` releases prove; otherwise what the record of angles at
    releases and separations shows."""
    leg = legs[-1]
    if (calm := find_calm(p, leg)) is not None:
        return Arrival(Settling(Settled.SETTLED, least=0.0, since=leg.final_state.time), calm)
    near = cycle_reached(p, leg, most)
    if near is not None and near.follows_cycle:  # of stable cycles only
        return Arrival(
            Settling(Settled.SETTLED, near.cycle.growth_rate, 0.0, leg.final_state.time), near=near
        )
    if near is not None and near.lingers:
        return Arrival(Settling(Settled.CHANGING, near.cycle.growth_rate, 0.0))
    return Arrival(settling(*np.hstack([switch_angles(leg) for leg in legs])))


def cycle_reached(p: Parameters, leg: Result, most: int) -> NearCycle | None:
    """The cycle near the end of a simulated motion, recorded with its events; the cycle may lose
    contact. Periods of up to half the releases of the last `FIRST_LEG` are tried, and of up to
    `most` releases."""
    last = leg.events[leg.events["time"] > leg.final_state.time - thresholds.FIRST_LEG]
    releases = int((last["kind"] == "stick_to_slip").sum())
    if not releases or not may_stick_and_slip(p) or p.n_diameters < 0:
        return None
    map_ = ReturnMap(p, patient=True)
    release = map_.next_release(leg.final_state)
    if not release.reached:
        return None
    longest_period = max(1, min(most, releases // 2))
    return find_cycle_near(map_, release, find_near_return(map_, release.x, longest_period))


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
    for step in [(0, i) for i in range(lowest, len(values))] + [
        (1, i) for i in reversed(range(len(values)))
    ]:
        case = p.replace(**{name: values[step[1]]})
        begin = 0.0 if state is None else state.time
        stay = dwell
        legs = list[Result]()
        while True:
            result = simulate(case, begin + stay, tol=tol, initial_state=state)
            legs.append(result)
            if not result.status.complete:
                yield step, result, None, Arrival(Settling())
                return
            state = result.final_state
            reached = arrival(case, legs)
            if reached.settled or 2 * stay > longest:
                break
            stay *= 2
        if reached.near is not None:
            state = reached.near.cycle.state
        result, segment = final_segment(case, state, late, late, tol)
        yield step, result, segment, reached
        state = result.final_state


def regularity(p: Parameters, state: State, tol: float) -> Motion:
    """Regularity of the motion from a state, by its separations, or else its releases, and by its
    largest exponent but that along the motion: zero on a torus, positive in chaos, negative on a
    cycle, however long its period."""
    run = simulate(
        p, state.time + thresholds.SETTLING * thresholds.FIRST_LEG, tol=tol, initial_state=state
    )
    times = run.events["time"].to_numpy(dtype=float)
    kinds = run.events["kind"].to_numpy()
    separates = bool((kinds == "separation").any())
    intervals = np.diff(times[kinds == ("separation" if separates else "stick_to_slip")])
    if not run.status.complete or len(intervals) < FEWEST:
        return Motion(Outcome.UNDECIDED)
    periodic = Outcome.SEPARATING if separates else Outcome.OTHER_CYCLE
    if n := shortest_period(intervals):
        return Motion(periodic, n, closure(intervals, n))
    # exponents below -90/s are not resolved by this interval; such a motion repeats
    how: Any = {
        "count": 1,
        "interval": 0.25,
        "leave_out_trivial": True,
        "initial_state": state,
        "tol": tol,
    }
    largest = lyapunov_exponents(p, thresholds.SETTLING * thresholds.FIRST_LEG / 2, **how)
    rate = float(largest.exponents[0])
    error = float(largest.errors[0])
    if not (math.isfinite(rate) and math.isfinite(error)):
        return Motion(Outcome.UNDECIDED)
    if abs(rate) <= max(CLEAR * error, CONVERGED[1]):
        return Motion(Outcome.QUASI_PERIODIC)
    return Motion(Outcome.IRREGULAR if rate > 0 else periodic)


class Basins:
    """The attractors of a case, `known` in the order in which they were found: the quiet cycle, and
    those reached from `OWN_STARTS` and from later starts.

    Motions are followed to the horizon (s). One that approaches an attractor counts as being on it
    within a relative difference `near` in range; never with 0.
    """

    def __init__(
        self, p: Parameters, horizon: float, *, near: float = 0.1, tol: float = 1e-10
    ) -> None:
        self.p, self.horizon, self.near, self.tol = p, horizon, near, tol
        modes = mode_arrays(p)
        self.static = p.N * float(np.sum(modes.psi**2 / modes.omega**2))
        self.smallest = max(thresholds.SMALLEST * self.static, sys.float_info.min)
        self.map = ReturnMap(p, patient=True)
        cycle = cycle_of_static_start(p)
        self.cycle = cycle if isinstance(cycle, NearCycle) and cycle.cycle.stable else None
        self.known: list[Attractor] = []
        if self.cycle is not None:
            assert self.cycle.cycle.state is not None
            leg = self._leg(self.cycle.cycle.state, thresholds.FIRST_LEG)
            self.known.append(self._periodic(self.cycle, segment_of(leg)))
        for kick in thresholds.OWN_STARTS:
            start = static_start(p)
            self.follow(perturb(p, start, u=-kick * self.static) if kick else start)

    def follow(self, state: State) -> OutcomeResult:
        """Outcome of the motion from a state at time 0; a new attractor is added to `known`."""
        legs = list[Result]()
        segments = list[Segment]()
        first_separation = math.nan
        least_tested = math.inf
        steady = False
        while True:
            leg = self._leg(state, min(state.time + thresholds.FIRST_LEG, self.horizon))
            state = leg.final_state
            first_separation = (
                leg.first_separation if math.isnan(first_separation) else first_separation
            )
            if not leg.status.complete:
                return OutcomeResult(
                    None, state.time, first_separation=first_separation, failed=leg
                )
            legs.append(leg)
            segments.append(segment_of(leg))
            over = state.time >= self.horizon
            attractor = None
            if self.near:
                # tested only nearer to the quiet cycle than ever before
                x, distance = self._near_quiet_cycle(segments, state)
                if (
                    self.cycle is not None
                    and distance < least_tested
                    and self.cycle.follows_multipliers(x)
                ):
                    attractor = self.known[0]
                else:
                    attractor = self._approached(
                        [segment.range for segment in segments[-thresholds.NEARING :]]
                    )
                least_tested = min(distance, least_tested)
            was_steady = steady
            steady = self._is_steady(segments)
            if attractor is None and (over or (self.near and steady and not was_steady)):
                attractor = self._settled_on(legs, segments[-1], steady, over)
            if attractor is not None or over:
                kind = Outcome.UNDECIDED if attractor is None else attractor.kind
                return OutcomeResult(
                    kind, state.time, attractor=attractor, first_separation=first_separation
                )

    def _leg(self, state: State, end: float) -> Result:
        # the range is taken over thirty oscillations or more
        window = Window(start=max(end - 0.5, state.time), stop=end, rate=thresholds.SAMPLING_RATE)
        return simulate(self.p, end, {"late": window}, tol=self.tol, initial_state=state)

    def _difference(self, first: Segment, second: Segment) -> float:
        """Largest difference of ranges, rates and shares, relative to the larger one or to a
        floor."""
        ranges = [max(segment.range, self.smallest) for segment in (first, second)]
        compared = [
            (*ranges, self.smallest),
            (first.separation_rate, second.separation_rate, 2 / thresholds.FIRST_LEG),
            (first.stick_fraction, second.stick_fraction, thresholds.SAME),
            (first.separation_fraction, second.separation_fraction, thresholds.SAME),
        ]
        return max(abs(a - b) / max(a, b, floor) for a, b, floor in compared)

    def _near_quiet_cycle(self, segments: Sequence[Segment], state: State) -> tuple[Array, float]:
        """A point of a motion on the section, and its distance from the quiet cycle; infinite
        unless it is near."""
        last = segments[-1]
        near = self.cycle
        if near is not None and last.separation_rate == 0 and last.range <= segments[0].range:
            release = self.map.next_release(state)
            if release.reached:
                others = self.map.returns(release.x, near.cycle.releases - 1)
                for point in chain([release.x], others):
                    distance = float(np.linalg.norm(point - near.x))
                    if distance <= thresholds.NEAR * self.map.deflection:
                        return point, distance
        return self.map.static, math.inf

    def _approached(self, ranges: Sequence[float]) -> Attractor | None:
        """The known attractor that the motion approaches before it has settled; None if there is
        none."""
        others = [attractor for attractor in self.known if attractor.kind is not Outcome.QUIET]
        if len(ranges) < thresholds.NEARING or not others:
            return None
        ends = [attractor.segment.range for attractor in others]
        apart = [
            [abs(value - end) / max(value, end, sys.float_info.min) for value in ranges]
            for end in ends
        ]
        nearest = min(range(len(others)), key=lambda i: apart[i][-1])
        if any(distances[-1] <= 2 * self.near for i, distances in enumerate(apart) if i != nearest):
            return None
        last = apart[nearest][-1]
        nearing = all(
            later < earlier or later <= thresholds.VARIATION
            for earlier, later in pairwise(apart[nearest])
        )
        slows = _rest_of_drift(ranges) <= (2 * last + thresholds.VARIATION) * ranges[-1]
        return others[nearest] if last <= self.near and nearing and slows else None

    def _is_steady(self, segments: Sequence[Segment]) -> bool:
        last = segments[-thresholds.SETTLING :]
        varies = any(self._difference(part, last[-1]) > thresholds.VARIATION for part in last[:-1])
        if len(last) < thresholds.SETTLING or varies:
            return False
        ranges = [max(segment.range, self.smallest) for segment in last]
        stays = abs(ranges[-1] - ranges[0]) <= thresholds.STEADY * ranges[-1]
        return stays or _rest_of_drift(ranges) <= thresholds.SAME / 2 * ranges[-1]

    def _settled_on(
        self, legs: Sequence[Result], segment: Segment, steady: bool, over: bool
    ) -> Attractor | None:
        """The attractor on which a motion is, if that is proven, the whole record has settled, or
        the last legs are as steady as those on a known attractor; None near an unstable cycle."""
        reached = arrival(self.p, legs, thresholds.LARGEST_PERIOD)
        if not reached.settled and reached.settling.least == 0:  # by multipliers
            return None
        attractor = Attractor(reached.calm or Outcome.UNDECIDED, segment)
        if reached.near is not None:
            attractor = self._periodic(reached.near, segment)
        proven = attractor.kind is not Outcome.UNDECIDED
        same = next((known for known in self.known if self._same(attractor, known)), None)
        if not (proven or (over and reached.settled) or (steady and same)):
            return None
        if same is None:
            if not proven:
                attractor = replace(
                    attractor, kind=regularity(self.p, legs[-1].final_state, self.tol).kind
                )
            self.known.append(attractor)
        return same or attractor

    def _same(self, first: Attractor, second: Attractor) -> bool:
        """Whether two attractors are the same: periodic ones by their fixed points, others by their
        segments."""
        if first.points is not None and second.points is not None:
            apart = min(float(np.linalg.norm(first.points[0] - point)) for point in second.points)
            return apart <= thresholds.SAME_POINT * self.map.deflection
        return self._difference(first.segment, second.segment) <= thresholds.SAME

    def _periodic(self, near: NearCycle, segment: Segment) -> Attractor:
        cycle = near.cycle
        points = [near.x, *near.map.returns(near.x, cycle.releases - 1, may_separate=True)]
        return Attractor(
            near.kind, segment, cycle.period, cycle.releases, cycle.growth_rate, np.array(points)
        )


def random_perturbation(p: Parameters, state: State, energy: float, key: Sequence[int]) -> State:
    """A state after a perturbation of given energy (J), of modes, mass m and spring k, in a random
    direction, by whole numbers, its `key`: uniform in the energy norm of the modes. The slider
    moves with the disc; f and psi stay."""
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
    energy_drawn = 0.5 * (float(np.sum(draw**2)) + p.k * u**2 + p.m * velocity**2)
    size = math.sqrt(energy / energy_drawn)
    velocity_of_u = velocity + state.f * float(np.sum(modes.diameters * modes.psi * b))
    changes = {"a": a, "b": b, "alpha": alpha, "beta": beta, "u": u, "u_velocity": velocity_of_u}
    return state.replace(
        **{name: getattr(state, name) + size * change for name, change in changes.items()}
    )


def _rest_of_drift(values: Sequence[float]) -> float:
    """Extrapolated rest of a drift of the values, by a geometric series; infinite if the changes do
    not decrease."""
    changes = np.diff(values[-4:])
    before = abs(changes[-2])
    last = abs(changes[-1])
    if not (np.all(changes > 0) or np.all(changes < 0)):
        return 0.0
    return float(last**2 / (before - last)) if last < before else math.inf
