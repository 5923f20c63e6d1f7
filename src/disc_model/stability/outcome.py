"""The outcome of one motion within a horizon: from multipliers if they prove it, otherwise by
simulation.

The search is a machine whose `Stage` says what is known of the motion; docs/study_method.md,
Regions, describes it. The static start is a point of the section of the return map, and usually
lies near the cycle that Newton's method finds.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from disc_model.data.variables import Outcome
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability import thresholds
from disc_model.stability.cycle import FloquetResult, may_stick_and_slip, never_pulls
from disc_model.stability.linear_motion import (
    NearCycle,
    approaches_sliding,
    cycle_of_static_start,
    find_cycle_near,
    find_near_return,
)
from disc_model.stability.return_map import Array, Passage, ReturnMap


@dataclass(frozen=True)
class Segment:
    """Ranges of contact force (N) and height over static equilibrium (m); shares of time;
    separations per s."""

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
        return self.u_max - self.u_min


@dataclass(frozen=True, eq=False)
class Attractor:
    """Outcome of motions on an attractor, and a segment of one; of a periodic one also period (s),
    releases in it, growth rate (1/s) and points on the section, shape (releases, n)."""

    kind: Outcome
    segment: Segment
    period: float = math.nan
    releases: int = 0
    growth_rate: float = math.nan
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
    """

    outcome: Outcome | None = None
    simulated: float = 0.0
    near: NearCycle | None = None
    attractor: Attractor | None = None
    first_separation: float = math.nan
    time: float = 0.0
    state: State | None = None
    failed: Result | None = None
    changes: list[float] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    distance: float = math.nan
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
    def status(self) -> Status:
        return Status.OK if self.failed is None else self.failed.status

    @property
    def message(self) -> str:
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
) -> OutcomeResult:
    """Find the outcome of a motion within a horizon (s), or its separation if that comes first.

    near : result of `cycle_of_static_start`, if it is known
    start : initial state; None is the static start
    early : whether the search ends once the outcome is shown; otherwise the motion is followed to the horizon
    late : s, length of the segment before the horizon that is described

    Multipliers alone prove that a motion approaches a stable cycle. Any other motion is simulated
    from its start, in the same legs whatever the horizon, so that searches with the same `tol` find
    the same first separation.
    """
    if isinstance(near, NearCycle):
        map_: ReturnMap | None = (
            near.map
        )  # a new one takes as long as a return to the section ten times over
    else:
        map_ = ReturnMap(p) if p.n_diameters >= 0 and may_stick_and_slip(p) else None
    if not early or start is not None or map_ is None:
        near = None
    elif near is None:
        near = cycle_of_static_start(p)
    start_cycle = near if isinstance(near, NearCycle) else None
    return _OutcomeSearch(p, horizon, tol, start, early, late, map_, start_cycle).run()


@dataclass
class _OutcomeSearch:
    """A search with one method a stage, which returns the next one; `start_cycle` may decide about
    the static start."""

    p: Parameters
    horizon: float
    tol: float
    start: State | None
    early: bool
    late: float
    map: ReturnMap | None
    start_cycle: NearCycle | None

    def run(self) -> OutcomeResult:
        stages = {
            Stage.START: self._begin,
            Stage.NEAR_CYCLE: self._judge_cycle,
            Stage.ON_ITS_WAY: self._simulate_on,
        }
        stage = Stage.START
        while stage in stages:
            stage = stages[stage]()
        self.result.stage = stage
        return self.result

    def _begin(self) -> Stage:
        self.result = OutcomeResult(state=self.start)
        self.leg = thresholds.FIRST_LEG
        self.departed_from: NearCycle | None = None  # the last unstable cycle that it followed
        self.cycle_to_come: NearCycle | None = (
            None  # an unstable one near the start, until the motion follows it
        )
        if self.start_cycle is None:
            return Stage.ON_ITS_WAY
        if not self.start_cycle.follows_cycle:
            self.cycle_to_come = None if self.start_cycle.cycle.stable else self.start_cycle
            return Stage.ON_ITS_WAY
        self.cycle = self.start_cycle
        return Stage.NEAR_CYCLE

    def _judge_cycle(self) -> Stage:
        """Settle on a stable cycle, or go on from an unstable one."""
        near = self.cycle
        result = self.result
        result.near = result.near or near
        if not near.cycle.stable:
            self.departed_from = near
            return Stage.ON_ITS_WAY
        result.near, result.outcome = near, near.kind
        result.time = near.time
        result.distance = float(np.linalg.norm(near.distance)) / near.map.deflection
        return Stage.SETTLED

    def _simulate_on(self) -> Stage:
        """Simulate a leg, and examine the motion at its end."""
        result = self.result
        if result.time >= self.horizon:
            result.outcome = Outcome.GROWING if self._grows else Outcome.UNDECIDED
            return Stage.HORIZON
        leg = self._simulate_leg()
        if leg.status is Status.STOPPED:
            result.outcome, result.first_separation = Outcome.SEPARATION, leg.first_separation
            return Stage.SEPARATED
        if not leg.status.complete:
            result.failed = leg
            return Stage.FAILED
        examined = self.early or result.time >= self.horizon
        if examined and (calm := find_calm(self.p, leg)) is not None:
            result.outcome, result.near = calm, None
            return Stage.SETTLED
        release = self._next_release(leg.final_state)
        if release is not None and examined:
            near = self._find_followed_cycle(release)
            if near is not None:
                self.cycle = near
                return Stage.NEAR_CYCLE
        return Stage.ON_ITS_WAY

    def _simulate_leg(self) -> Result:
        """Simulate a leg to its end or the first separation; the segment to be described is a leg
        of its own."""
        result = self.result
        marks = (self.horizon - self.late, self.horizon)
        stop = next(min(result.time + self.leg, mark) for mark in marks if result.time < mark)
        self.leg = min(2 * self.leg, thresholds.LONGEST_LEG)
        windows = {}
        if self.late and stop == self.horizon:
            windows = {"late": Window(start=result.time, stop=stop, rate=thresholds.SAMPLING_RATE)}
        leg = simulate(
            self.p,
            stop,
            windows,
            tol=self.tol,
            initial_state=result.state,
            stop_at="first_separation",
        )
        if windows and leg.status.complete:
            result.segment = segment_of(leg)
        result.simulated += leg.final_state.time - result.time
        result.state, result.time = leg.final_state, leg.final_state.time
        return leg

    def _next_release(self, state: State) -> Passage | None:
        """The next release of the motion, if it comes to the section again in contact; its nearest
        return to there is then measured."""
        if self.map is None:
            return None
        release = self.map.next_release(state)
        if not release.reached:
            return None
        self.near_return = find_near_return(self.map, release.x)
        self.result.times.append(self.result.time)
        self.result.changes.append(math.nan if self.near_return is None else self.near_return[0])
        return release

    def _find_followed_cycle(self, release: Passage) -> NearCycle | None:
        """The cycle that the motion follows linearly from a release on: the one near its start, if
        it comes back to that, or another."""
        near = self.cycle_to_come
        x = release.x
        assert self.map is not None
        if self.departed_from is not None:
            size = self.map.deflection
            if (
                near is not None
                and np.linalg.norm(x - near.x) <= thresholds.NEAR * size
                and np.linalg.norm(self.departed_from.x - near.x) > thresholds.SAME_POINT * size
                and near.follows_multipliers(x)
            ):
                self.cycle_to_come = self.result.near = None
                return replace(near, follows_cycle=True, distance=x - near.x, time=release.time)
            # a motion that comes near a cycle then changes less and less, down to errors of the
            # simulation
            known = [change for change in self.result.changes if not math.isnan(change)]
            if known and known[-1] > max(
                known[-2:][0], thresholds.ARRIVED, thresholds.ERROR_OF_TOL * self.tol
            ):
                return None
        waits = thresholds.WAITS if self.departed_from is None else thresholds.WAITS[:1]
        near = find_cycle_near(self.map, release, self.near_return, unstable=waits)
        return near if near is not None and near.follows_cycle else None

    @property
    def _grows(self) -> bool:
        return self.departed_from is not None or growing(self.result.changes)


def find_calm(p: Parameters, leg: Result) -> Outcome | None:
    """At rest if the slider sticks for good, steady sliding if the motion approaches it; None if
    neither is shown."""
    if shares(leg)[0] == 1 and never_pulls(p):
        return Outcome.AT_REST
    return Outcome.STEADY_SLIDING if approaches_sliding(p, leg.final_state) else None


def growing(changes: Sequence[float]) -> bool:
    """Whether two successive changes have risen above an earlier one: an instability, even if it is
    bounded later."""
    d = np.array(changes)
    if len(d) < 3:
        return False
    least = np.fmin.accumulate(d[:-2])
    later = np.fmin(d[1:-1], d[2:])
    return bool(np.any((later > thresholds.ARRIVED) & (later > thresholds.RISE * least)))


def final_segment(
    p: Parameters, state: State | None, duration: float, late: float, tol: float
) -> tuple[Result, Segment | None]:
    """Simulate from a state (None: the static start) for a duration (s); its last segment, if it is
    complete."""
    begin = 0.0 if state is None else state.time
    stop = begin + duration
    if stop - late > begin:
        result = simulate(p, stop - late, tol=tol, initial_state=state, events=False)
        if not result.status.complete:
            return result, None
        state = result.final_state
    window = Window(start=stop - late, stop=stop, rate=thresholds.SAMPLING_RATE)
    result = simulate(p, stop, {"late": window}, tol=tol, initial_state=state)
    return result, segment_of(result) if result.status.complete else None


def segment_of(result: Result) -> Segment:
    """The segment of a result: ranges over its window "late", and shares of its whole time."""
    P = result.samples["late"]["P"]
    u = result.samples["late"]["u"] - result.u_0
    return Segment(float(P.min()), float(P.max()), float(u.min()), float(u.max()), *shares(result))


def shares(result: Result) -> tuple[float, float, float, float]:
    """Shares of a result's time in stick, slip and separation, and separations per second."""
    statistics = result.statistics
    stick, slip, separation = (
        statistics[f"time_{phase}"] for phase in ("stick", "slip", "separation")
    )
    total = stick + slip + separation
    return stick / total, slip / total, separation / total, statistics["separations"] / total


def switch_angles(leg: Result) -> Array:
    """Times of releases and losses of contact of a leg, s, and the slider's angles, rad: shape (2,
    n)."""
    events = leg.events
    return (
        events.loc[events["kind"].isin(["stick_to_slip", "separation"]), ["time", "psi"]]
        .to_numpy(dtype=float)
        .T
    )
