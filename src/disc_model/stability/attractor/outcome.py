"""The outcome of one motion within a horizon: from multipliers if they prove it, otherwise by simulation.

The static start is a point of the section of `disc_model.stability.return_map`, and usually lies near the cycle that
Newton's method finds from it.  docs/algorithms.md, Regions, describes the conclusions and the simulations.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np

from disc_model.data.variables import Outcome
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record, Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability.attractor.neighbourhood import (
    AMPLITUDES,
    ARRIVED,
    NEAR,
    SAME_POINT,
    WAITS,
    NearCycle,
    cycle_near,
    cycle_of_static_start,
    departure,
    first_release,
    follows,
    nears_sliding,
    recurrence,
)
from disc_model.stability.attractor.torus import TorusTest
from disc_model.stability.cycle import FloquetResult, may_stick_and_slip, never_pulls
from disc_model.stability.return_map import RETURNED, Array, ReturnMap, case_faults

FIRST_LEG = 5.0
"""s, first simulated time before a motion is examined: dozens of cycles, and some turns of the disc at paper speeds."""
LONGEST_LEG = 160.0
"""s, of later legs. A test of a steady motion for a torus after each costs as much as 50 to 400 s of simulation."""
CERTAIN = 0.02
"""Distance from a cycle, over the static deflection, from which a departure that came to a stable cycle is simulated:
farther away, its phase may decide between that cycle and separation."""
RATE = 4000.0
"""Sampling rate of segments, Hz: above twice the highest modal frequency."""


@dataclass(frozen=True)
class Segment:
    """Description of a segment of a motion.

    P_min, P_max : N, range of the contact force
    u_min, u_max : m, range of the slider's height over static equilibrium
    stick_fraction, slip_fraction, separation_fraction : shares of the time
    separation_rate : 1/s, separations per time
    """

    P_min: float
    P_max: float
    u_min: float
    u_max: float
    stick_fraction: float
    slip_fraction: float
    separation_fraction: float
    separation_rate: float

    @property
    def range(self) -> float:
        """Range of the slider's height, m."""
        return self.u_max - self.u_min


@dataclass(frozen=True, eq=False)
class Attractor:
    """An attractor.

    Attributes
    ----------
    kind : outcome of motions on it
    segment : segment of a motion on it
    period, releases, growth_rate : s, 1 and 1/s, of a periodic attractor; nan, 0 and nan otherwise
    points : shape (releases, n), its points on the section; None if none are known
    """

    kind: Outcome
    segment: Segment
    period: float = math.nan
    releases: int = 0
    growth_rate: float = math.nan
    points: Array | None = None


@dataclass(eq=False)
class OutcomeResult:
    """The outcome of a motion; while it is sought, what is known so far.

    Attributes
    ----------
    outcome : None if the simulation failed
    simulated : s, simulated time; 0 if multipliers decide
    attractor : one of the attractors of `disc_model.stability.attractor.classification.Basins`, or None
    near : the stable cycle that the motion approaches, or else the first unstable cycle from which it departs, or None
    departed : the unstable cycle of slowest growth from which a departure was computed by multipliers; None if all was
        simulated
    first_separation : s, nan if there was none
    time : s, at which the outcome was known
    state : last state of the simulation; None if there was none
    failed : the simulation that ended early
    changes : changes from one period to the next, over the static deflection, at the end of each leg
    times : times of these ends, s
    distance : distance from the cycle, over the static deflection, at the end of the search
    segment : the last segment before the horizon, if it was requested and reached
    """

    outcome: Outcome | None = None
    simulated: float = 0.0
    near: NearCycle | None = None
    attractor: Attractor | None = None
    departed: NearCycle | None = None
    first_separation: float = math.nan
    time: float = 0.0
    state: State | None = None
    failed: Result | None = None
    changes: list[float] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    distance: float = math.nan
    segment: Segment | None = None

    @property
    def word(self) -> str:
        """The outcome as a word of datasets."""
        return self.outcome or "failed"

    @property
    def separates(self) -> bool:
        """Whether the motion loses contact again and again."""
        return self.attractor is not None and self.attractor.segment.separation_rate > 0

    def after(self, before: Self) -> Self:
        """The same result of a search that repeats another one: what both simulated counts."""
        return replace(self, simulated=before.simulated + self.simulated)

    @property
    def status(self) -> Status:
        """Status of the simulation."""
        return Status.OK if self.failed is None else self.failed.status

    @property
    def message(self) -> str:
        """Reason for which the simulation ended early, or ""."""
        return "" if self.failed is None else self.failed.message


def find_outcome(
    p: Parameters,
    horizon: float,
    *,
    tol: float = 1e-10,
    near: NearCycle | FloquetResult | None = None,
    furthest: float = AMPLITUDES[0],
    start: State | None = None,
    early: bool = True,
    late: float = 0.0,
) -> OutcomeResult:
    """Find the outcome of a motion within a horizon (s), or its separation if that comes first.

    Parameters
    ----------
    tol : tolerance of simulations, as in `simulate`
    near : result of `cycle_of_static_start`, if it is known
    furthest : distance from a cycle, over the static deflection, up to which multipliers may represent a departure. A
        shorter one makes the time of the first separation more accurate; with 0 all of the departure is simulated.
        A departure that comes to a stable cycle is simulated from `CERTAIN` in any case
    start : initial state, at time 0; None is the static start
    early : whether the search ends once the outcome is shown; otherwise the motion is followed to the horizon
    late : s, length of the segment before the horizon that is described
    """
    found = OutcomeResult(state=start)
    course, first = _OutcomeSearch(p, horizon, tol, furthest, early, late, found), None
    if isinstance(near, NearCycle):
        course.map = near.map  # a new one takes as long as a return to the section ten times over
    if early and start is None and course.map is not None:
        near = cycle_of_static_start(p) if near is None else near
        if isinstance(near, NearCycle):
            if near.follows_cycle:
                first = near
            else:
                course.near_start = near
    found.outcome = course.run(first)
    if furthest <= CERTAIN or found.departed is None or found.near is None or not found.near.cycle.stable:
        return found
    again = find_outcome(p, horizon, tol=tol, near=near, furthest=CERTAIN, start=start, early=early, late=late)
    return again.after(found)


@dataclass
class _OutcomeSearch:
    """A search for the outcome of a motion.

    found : its results so far, with the present state of the motion
    left : the last unstable cycle from which the motion has departed
    near_start : the cycle near the static start, while the motion does not follow it
    at : point of the section at the end of the last leg
    """

    p: Parameters
    horizon: float
    tol: float
    furthest: float
    early: bool
    late: float
    found: OutcomeResult
    left: NearCycle | None = None
    near_start: NearCycle | None = None
    at: Array | None = None

    @cached_property
    def map(self) -> ReturnMap | None:
        has_section = not case_faults(self.p, "the return map") and may_stick_and_slip(self.p)
        return ReturnMap(self.p) if has_section else None

    @cached_property
    def torus(self) -> TorusTest:
        assert self.map is not None
        return TorusTest(self.map)

    def run(self, near: NearCycle | None) -> Outcome | None:
        """The outcome, None if a simulation failed; ``near`` is the cycle that the motion follows from its start."""
        found, leg = self.found, FIRST_LEG
        if near is not None:
            found.time = first_release(self.p)
        while True:
            over = found.time >= self.horizon
            if near is not None:
                found.near = found.near or near
                if near.cycle.stable:
                    found.near = near
                    found.time += near.waited
                    found.distance = float(np.linalg.norm(near.distance)) / near.map.deflection
                    return near.kind
                if over or self._depart(near) >= self.horizon:
                    return Outcome.GROWING
            elif over:
                return Outcome.GROWING if self._grows else Outcome.UNDECIDED
            result = self._simulated(leg)
            leg = min(2 * leg, LONGEST_LEG)
            if result.status is Status.STOPPED:
                found.first_separation = result.first_separation
                return Outcome.SEPARATION
            if not result.status.complete:
                found.failed = result
                return None
            if self.early or found.time >= self.horizon:
                calm = at_rest(self.p, result, self.tol)
                if calm is not None:
                    found.near = None
                    return calm
            near = self._look(result.final_state)
            if near is None and self._stays_in_contact():
                return Outcome.GROWING

    def _simulated(self, leg: float) -> Result:
        """Simulate for a time (s), or to the first separation; the segment to be described is a leg of its own."""
        marks = (self.horizon - self.late, self.horizon)
        stop = next(min(self.found.time + leg, mark) for mark in marks if self.found.time < mark)
        record = Record(events=False)
        if self.late and stop == self.horizon:
            record = Record(windows=(Window(start=self.found.time, stop=stop, rate=RATE),), events=False)
        result = simulate(
            self.p, stop, tol=self.tol, initial_state=self.found.state, record=record, stop_at="first_separation"
        )
        if record.windows and result.status.complete:
            self.found.segment = segment_of(result)
        self.found.simulated += result.final_state.time - self.found.time
        self.found.state, self.found.time = result.final_state, result.final_state.time
        return result

    @property
    def _grows(self) -> bool:
        return self.left is not None or growing(self.found.changes)

    def _stays_in_contact(self) -> bool:
        """Whether the motion has come to an attracting torus in contact; tested while that may save much."""
        # not before 70 s are simulated, as a test costs as much as 50 to 400 s of simulation
        tested = self.early and self.found.simulated >= 70.0 and self.horizon - self.found.time >= LONGEST_LEG
        if not tested or not self._grows or self.at is None or not self.torus.shows_torus(self.at):
            return False
        # it may pass an unstable one, or a border of its phases that no derivative shows: it is watched for 40 s
        result, segment = final_segment(self.p, self.found.state, 40.0, 40.0, self.tol)
        self.found.simulated += result.final_state.time - self.found.time
        if segment is None or segment.P_min < 0.05 * self.p.N:  # too near to a loss of contact to exclude one
            return False
        code, x = self.torus.map.next_release(result.final_state)
        return code == RETURNED and self.torus.shows_no_change(x)

    def _depart(self, near: NearCycle) -> float:
        """Follow the linear map away from an unstable cycle, as far as it is valid; returns the time at its end, s."""
        begun = self.found.time + near.waited
        room = max(0, math.ceil((self.horizon - begun) / near.cycle.period))
        time, distance = departure(near, room, self.furthest)
        self.left = near
        slowest = self.found.departed
        if time and (slowest is None or near.cycle.growth_rate < slowest.cycle.growth_rate):
            self.found.departed = near
        if time or self.found.state is None:
            self.found.time = begun + time
            self.found.state = near.map.state(near.x + distance).replace(time=self.found.time)
        return self.found.time

    def _look(self, state: State) -> NearCycle | None:
        """The cycle that the motion follows linearly: the one near its start, if it comes back to that, or another."""
        code, x = self.map.next_release(state) if self.map is not None else (None, None)
        self.at = x if code == RETURNED else None
        if self.map is None or self.at is None:
            return None
        x = self.at
        again = recurrence(self.map, x)
        self.found.times.append(self.found.time)
        self.found.changes.append(again[0])
        if not self.early and self.found.time < self.horizon:
            return None
        near = self._back(x)
        # after a departure, a motion that comes near a cycle changes less and less, down to errors of the simulation:
        # 12 times the tolerance were seen on a cycle that attracts at 0.008/s
        least = max(self.found.changes[-2:][0], ARRIVED, 100 * self.tol)
        if near is None and (self.left is None or not again[0] > least):
            near = cycle_near(self.map, x, again, unstable=WAITS if self.left is None else WAITS[:1])
        return near if near is not None and near.follows_cycle else None

    def _back(self, x: Array) -> NearCycle | None:
        """The unstable cycle near the start, if the motion follows it after it has passed another unstable one."""
        near, left = self.near_start, self.left
        if near is None or left is None or near.cycle.stable:
            return None
        size, apart = near.map.deflection, np.linalg.norm(x - near.x)
        if not apart <= NEAR * size or np.linalg.norm(left.x - near.x) <= SAME_POINT * size or not follows(near, x):
            return None
        self.near_start = self.found.near = None
        return replace(near, follows_cycle=True, distance=x - near.x)


def at_rest(p: Parameters, leg: Result, tol: float) -> Outcome | None:
    """At rest if the slider sticks for good, steady sliding if the motion approaches it; None if neither is shown."""
    if shares(leg)[0] == 1 and never_pulls(p):
        return Outcome.AT_REST
    return Outcome.STEADY_SLIDING if nears_sliding(p, leg.final_state, tol) else None


def growing(changes: Sequence[float]) -> bool:
    """Whether two successive changes have risen above an earlier one: an instability, even if it is bounded later."""
    d = np.array(changes)
    if len(d) < 3:
        return False
    least = np.fmin.accumulate(d[:-2])
    later = np.fmin(d[1:-1], d[2:])
    # rounding and beats with decaying modes cause less
    return bool(np.any((later > ARRIVED) & (later > 1.5 * least)))


# ----------------------------------------------------------------------------------------------------
# Description of segments


def final_segment(
    p: Parameters, state: State | None, duration: float, late: float, tol: float
) -> tuple[Result, Segment | None]:
    """Simulate from a state (None: the static start) for a duration (s), and describe the last segment of it.

    The segment is None if the simulation ended early.
    """
    begin = 0.0 if state is None else state.time
    stop = begin + duration
    if stop - late > begin:
        result = simulate(p, stop - late, tol=tol, initial_state=state, record=Record(events=False))
        if not result.status.complete:
            return result, None
        state = result.final_state
    window = Window(start=stop - late, stop=stop, rate=RATE)
    result = simulate(p, stop, tol=tol, initial_state=state, record=window)
    return result, segment_of(result) if result.status.complete else None


def segment_of(result: Result) -> Segment:
    """The segment of a result: ranges over its single window of samples, and shares of its whole time."""
    P, u = result.samples[0]["P"], result.samples[0]["u"] - result.u_0
    return Segment(float(P.min()), float(P.max()), float(u.min()), float(u.max()), *shares(result))


def shares(result: Result) -> tuple[float, float, float, float]:
    """Shares of a result's time in stick, slip and separation, and separations per second."""
    statistics = result.statistics
    stick, slip, separation = (statistics[f"time_{phase}"] for phase in ("stick", "slip", "separation"))
    total = stick + slip + separation
    return stick / total, slip / total, separation / total, statistics["separations"] / total
