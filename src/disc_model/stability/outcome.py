"""The outcome of one motion within a horizon: from multipliers if they prove it, otherwise by
simulation.

The search is a machine whose `Stage` says what is known of the motion; docs/study_method.md,
Regions, describes it. The static start is a point of the section of the return map, and usually
lies near the cycle that Newton's method finds.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from disc_model.data.variables import Outcome
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability import thresholds
from disc_model.stability.cycle import FloquetResult, may_stick_and_slip, never_pulls
from disc_model.stability.linear_motion import (
    CloseReturn,
    NearCycle,
    cycle_of_static_start,
    find_close_return,
    find_cycle_near,
)
from disc_model.stability.return_map import Array, Passage, ReturnMap
from disc_model.stability.segments import Segment, segment_of, shares, simulate_leg, slips_on
from disc_model.stability.sliding_motion import approaches_sliding, departs_from_sliding


@dataclass(frozen=True, eq=False)
class Attractor:
    """Outcome of motions on an attractor, and a segment of one; of a periodic one also period (s),
    releases in it, growth rate (1/s) and points on the section, shape (releases, n)."""

    kind: Outcome
    segment: Segment
    period: float = np.nan
    releases: int = 0
    growth_rate: float = np.nan
    points: Array | None = None


class Stage(Enum):
    """Stage of a search for the outcome of a motion: what is known of it. From `SETTLED` on, the
    search has ended."""

    START = "at its initial state"
    NEAR_CYCLE = "follows the linear map near a cycle"
    ON_ITS_WAY = "follows no cycle as far as is known"
    SETTLED = "approaches a stable cycle or steady sliding, or is at rest"
    SEPARATED = "has lost contact"
    HORIZON = "has come to the horizon"
    FAILED = "its simulation failed"


@dataclass(eq=False)
class OutcomeResult:
    """The outcome of a motion; while it is sought, what is known so far.

    outcome : None if the simulation failed
    simulated, time : s, simulated time, 0 if multipliers decide; time at which the outcome was known
    near : the stable cycle that the motion approaches, or else the first unstable cycle from which it departs
    failed : the simulation that ended early
    changes, times : changes from one period to the next, over the static deflection, and times of these (s)
    distance : from the cycle, over the static deflection, at the end of the search
    extrapolated : whether the linear map has replaced the simulation of a slow departure; the first
        separation is then known within `thresholds.BORDER` only
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
    times: list[float] = field(default_factory=list)
    distance: float = np.nan
    extrapolated: bool = False
    segment: Segment | None = None
    stage: Stage | None = None

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
        return np.nan if self.extrapolated else self.first_separation

    @property
    def status(self) -> Status:
        """How the last simulation ended."""
        return Status.OK if self.failed is None else self.failed.status

    @property
    def message(self) -> str:
        """Why the simulation failed; empty if it did not."""
        return "" if self.failed is None else self.failed.message


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
    cycles are extrapolated instead, see `NearCycle.extrapolate`. A motion whose separation comes
    near to one of those times, or that settles, is simulated from its start all the same: a small
    error decides to which attractor an irregular motion comes.
    """
    start_cycle: NearCycle | None = None
    map_: ReturnMap | None = None
    if isinstance(near, NearCycle):
        map_ = near.map  # a new one takes as long as a return to the section ten times over
    elif may_stick_and_slip(p):
        map_ = ReturnMap(p)
    if early and start is None and map_ is not None:
        if near is None:
            near = cycle_of_static_start(p)
        if isinstance(near, NearCycle):
            start_cycle = near
    options = SearchOptions(horizon, tol, start, early, late, bool(compared_with))
    rough = _OutcomeSearch(p, options, map_, start_cycle).run()
    if not rough.extrapolated:
        return rough
    settled = rough.stage is Stage.SETTLED
    if not settled and not _is_near_any(rough.first_separation, compared_with):
        return rough
    options = replace(options, extrapolate=False)
    simulated = _OutcomeSearch(p, options, map_, start_cycle).run()
    simulated.simulated += rough.simulated
    return simulated


def _is_near_any(time: float, others: Sequence[float]) -> bool:
    """Whether a time is nearer to one of some others than the error of an extrapolation; nan is
    not."""
    return any(abs(time - other) <= thresholds.BORDER * other for other in others)


@dataclass(frozen=True)
class SearchOptions:
    """How a motion is followed in a search; see `find_outcome`.

    extrapolate : whether slow departures from cycles are
    """

    horizon: float
    tol: float
    start: State | None
    early: bool
    late: float
    extrapolate: bool


class _OutcomeSearch:
    """A search for the outcome of a motion, with one method for each stage, which returns the next
    stage.

    map : the return map of the case; None if it has no stick-slip
    start_cycle : the cycle near the static start; None if the motion starts elsewhere, or must be
        followed to the horizon
    result : what is known of the motion
    leg : s, length of the next simulated leg
    cycle : the cycle that the motion follows in the stage `NEAR_CYCLE`
    departed_from : the last unstable cycle that the motion has followed
    leaves_sliding : whether the motion has been seen to depart from unstable steady sliding
    expected_cycle : an unstable cycle near the static start, until the motion follows it
    horizon : s, at which the search ends; beyond that of the options after an extrapolation, as far
        as its error may reach
    """

    def __init__(
        self,
        p: Parameters,
        options: SearchOptions,
        map_: ReturnMap | None,
        start_cycle: NearCycle | None,
    ) -> None:
        self.p = p
        self.options = options
        self.map = map_
        self.start_cycle = start_cycle
        self.result = OutcomeResult(state=options.start)
        self.leg = thresholds.FIRST_LEG
        self.cycle: NearCycle | None = None
        self.departed_from: NearCycle | None = None
        self.leaves_sliding = False
        self.expected_cycle: NearCycle | None = None
        self.horizon = options.horizon

    def run(self) -> OutcomeResult:
        """Go from stage to stage until one ends the search."""
        stages = {
            Stage.START: self._relate_start,
            Stage.NEAR_CYCLE: self._judge_cycle,
            Stage.ON_ITS_WAY: self._simulate_on,
        }
        stage = Stage.START
        while stage in stages:
            stage = stages[stage]()
        self.result.stage = stage
        return self.result

    def _relate_start(self) -> Stage:
        """Stage START: relate the static start to the cycle near it."""
        near = self.start_cycle
        # nothing is known of the start: only a simulation can tell
        if near is None:
            return Stage.ON_ITS_WAY
        # the start follows the cycle, whose multipliers decide
        if near.follows_cycle:
            self.cycle = near
            return Stage.NEAR_CYCLE
        # the start does not follow the cycle, but the motion may come to it later
        if not near.cycle.stable:
            self.expected_cycle = near
        return Stage.ON_ITS_WAY

    def _judge_cycle(self) -> Stage:
        """Stage NEAR_CYCLE: settle on a stable cycle, or go on from an unstable one."""
        near = self.cycle
        assert near is not None
        result = self.result
        # an unstable cycle: the motion departs, and is followed until it comes to something else
        if not near.cycle.stable:
            result.near = result.near or near
            self.departed_from = near
            if self.options.extrapolate:
                self._extrapolate_departure(near)
            return Stage.ON_ITS_WAY
        # a stable cycle: the motion is on it for good
        result.near = near
        result.outcome = near.kind
        result.time = near.time
        result.distance = float(np.linalg.norm(near.distance)) / near.map.deflection
        return Stage.SETTLED

    def _extrapolate_departure(self, near: NearCycle) -> None:
        """Go on from where a slow departure ceases to be linear."""
        departure = near.extrapolate(self.options.horizon)
        if departure is None or departure.time <= self.result.time:
            return
        state = near.map.state(departure.x)
        self.result.state = state.replace(time=departure.time)
        self.result.time = departure.time
        self.result.extrapolated = True
        self._note_close_return(near.map, departure.x)
        # nothing is to be seen before the departure has grown by a factor of e
        self.leg = min(max(self.leg, 1 / near.cycle.growth_rate), thresholds.LONGEST_LEG)
        self.horizon = (1 + thresholds.BORDER) * self.options.horizon

    def _simulate_on(self) -> Stage:
        """Stage ON_ITS_WAY: simulate a leg, and examine the motion at its end."""
        result = self.result

        # the horizon: nothing was proven within it
        if result.time >= self.horizon:
            result.outcome = Outcome.GROWING if self._grows() else Outcome.UNDECIDED
            return Stage.HORIZON

        # a leg that does not come to its end
        leg = self._simulate_leg()
        if leg.status is Status.STOPPED:
            result.outcome = Outcome.SEPARATION
            result.first_separation = leg.first_separation
            return Stage.SEPARATED
        if not leg.status.complete:
            result.failed = leg
            return Stage.FAILED
        return self._examine(leg)

    def _grows(self) -> bool:
        """Whether the motion has departed from something unstable, or changes more and more."""
        departs = self.departed_from is not None or self.leaves_sliding
        return departs or growing(self.result.changes)

    def _examine(self, leg: Result) -> Stage:
        """Examine what the motion has come to at the end of a leg in contact."""
        result = self.result

        # rest, or stable steady sliding
        examined = self.options.early or result.time >= self.horizon
        equilibrium = None
        if examined:
            equilibrium = find_equilibrium(self.p, leg)
        if equilibrium is not None:
            result.outcome = equilibrium
            result.near = None
            return Stage.SETTLED

        # unstable steady sliding: the motion departs, and is followed until it comes elsewhere
        if examined and not self.leaves_sliding:
            self.leaves_sliding = slips_on(leg) and departs_from_sliding(self.p, leg.final_state)

        # the section, if the motion comes to it again in contact: how nearly it repeats there
        if self.map is None:
            return Stage.ON_ITS_WAY
        release = self.map.next_release(leg.final_state)
        if not release.reached:
            return Stage.ON_ITS_WAY
        close_return = self._note_close_return(self.map, release.x)

        # a cycle that the motion follows from there on
        if examined:
            self.cycle = self._find_followed_cycle(self.map, release, close_return)
            if self.cycle is not None:
                return Stage.NEAR_CYCLE
        return Stage.ON_ITS_WAY

    def _note_close_return(self, map_: ReturnMap, x: Array) -> CloseReturn | None:
        """Note how nearly the motion repeats from a point of the section on."""
        close_return = find_close_return(map_, x)
        self.result.times.append(self.result.time)
        self.result.changes.append(np.nan if close_return is None else close_return.change)
        return close_return

    def _simulate_leg(self) -> Result:
        """Simulate a leg to its end or the first separation; the segment to be described is a leg
        of its own."""
        result = self.result
        horizon = self.horizon
        late = self.options.late
        mark = horizon
        if result.time < horizon - late:
            mark = horizon - late
        stop = min(result.time + self.leg, mark)
        self.leg = min(2 * self.leg, thresholds.LONGEST_LEG)
        described_from = None
        if late and stop == horizon:
            described_from = result.time
        leg = simulate_leg(self.p, stop, result.state, self.options.tol, described_from)
        if described_from is not None and leg.status.complete:
            result.segment = segment_of(leg)
        result.simulated += leg.final_state.time - result.time
        result.state = leg.final_state
        result.time = leg.final_state.time
        return leg

    def _find_followed_cycle(
        self, map_: ReturnMap, release: Passage, close_return: CloseReturn | None
    ) -> NearCycle | None:
        """The cycle that the motion follows linearly from a release on: the expected one, if it
        comes to that, or another."""
        waits: Sequence[float] = thresholds.WAITS
        if self.departed_from is not None:
            expected = self._reached_expected_cycle(map_, release, self.departed_from)
            if expected is not None:
                return expected
            if self._departs():
                return None
            waits = thresholds.WAITS[:1]
        near = find_cycle_near(map_, release, close_return, unstable=waits)
        if near is None or not near.follows_cycle:
            return None
        return near

    def _reached_expected_cycle(
        self, map_: ReturnMap, release: Passage, departed_from: NearCycle
    ) -> NearCycle | None:
        """The unstable cycle near the static start, if the motion has come back to it from another
        one, and follows it from a release on."""
        near = self.expected_cycle
        if near is None:
            return None
        distance = release.x - near.x
        is_near = np.linalg.norm(distance) <= thresholds.NEAR * map_.deflection
        apart = float(np.linalg.norm(departed_from.x - near.x))
        is_another = apart > thresholds.SAME_POINT * map_.deflection
        if not (is_near and is_another and near.follows_multipliers(release.x)):
            return None
        self.expected_cycle = None
        self.result.near = None
        return replace(near, follows_cycle=True, distance=distance, time=release.time)

    def _departs(self) -> bool:
        """Whether the last change of a period exceeds the one before. A motion that comes to a cycle
        changes less and less, down to errors of the simulation."""
        known = [change for change in self.result.changes if not np.isnan(change)]
        if not known:
            return False
        before = known[-2:][0]
        errors = thresholds.ERROR_OF_TOL * self.options.tol
        return known[-1] > max(before, thresholds.ARRIVED, errors)


def find_equilibrium(p: Parameters, leg: Result) -> Outcome | None:
    """At rest if the slider sticks for good, steady sliding if the motion approaches it; None if
    neither is shown."""
    if shares(leg).stick == 1 and never_pulls(p):
        return Outcome.AT_REST
    if approaches_sliding(p, leg.final_state):
        return Outcome.STEADY_SLIDING
    return None


def growing(changes: Sequence[float]) -> bool:
    """Whether two successive changes have risen above an earlier one: an instability, even if it is
    bounded later."""
    if len(changes) < 3:
        return False
    least = np.fmin.accumulate(changes[:-2])
    later = np.fmin(changes[1:-1], changes[2:])
    risen = (later > thresholds.ARRIVED) & (later > thresholds.RISE * least)
    return bool(np.any(risen))
