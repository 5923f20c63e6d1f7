"""Following a motion until it separates, has settled, or its time is up.

Whether a motion settles is read from the return map at stick release: short probes, more and more apart, compare the
states at successive releases. It is their difference that is looked at and not the motion's range, so that a slow
growth is not taken for rest. Near a periodic orbit it is a sum of modes of the orbit that decay or grow exponentially,
each excited by the start at much the same size (1e-5 to 1e-4 relative in the published cases). A motion has settled if

- it is near the stick-slip cycle that `disc_model.stability.cycle` finds, this is stable, and the difference
  keeps falling at the rate that the cycle's multipliers demand; or
- near no such cycle, the difference has kept falling until it is below 1e-9: a mode that grows would be a thousand
  times larger by then, however slow. If the cycle at hand is known to be unstable, never.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record, Window
from disc_model.simulation.result import Result, State, engine_case
from disc_model.stability.cycle import CycleStatus, FloquetResult, floquet
from disc_model.stability.return_map import Array, case_faults

FIRST_PROBE = 5.0
"""Time of the first probe, s."""
SPACING = 1.35
"""Ratio of the times of successive probes."""
PROBE = 0.5
"""Length of a probe, s: some dozens of stick-slip cycles, and a turn of the disc at the published speeds."""
RATE = 4000.0
"""Sampling rate of the contact force in a probe, Hz: above twice the disc's highest frequency kept."""
FEWEST = 4
"""Probes without which nothing has settled."""
LARGEST_PERIOD = 8
"""Releases in one period of the motion, at most, that are recognised."""
FALL = 100.0
"""How much the difference must have fallen since its largest value, away from a known cycle."""
NOISE = 1e-8
"""Relative differences below this are not taken for growth."""
GROWTH = 1.5
"""How much the difference must rise above its least value before to be called growth."""
RATES = (0.6, 1.6)
"""Ratio of the observed rate of decay to the cycle's: between these they agree."""
SAME = 1e-6
"""Distance to a cycle, relative, within which a motion cannot be on another one."""
_NOTHING = Record(events=False)


@dataclass(frozen=True)
class Late:
    """What a stretch of motion was like.

    P_min, P_max : N, range of the contact force
    u_min, u_max : m, of the slider's height over static equilibrium
    share_stick, share_slip, share_separation : of the time
    separation_rate : 1/s
    """

    P_min: float
    P_max: float
    u_min: float
    u_max: float
    share_stick: float
    share_slip: float
    share_separation: float
    separation_rate: float


@dataclass
class Settling:
    """Differences between successive cycles, relative, at the times of the probes (s)."""

    parameters: Parameters
    times: list[float] = field(default_factory=list)
    differences: list[float] = field(default_factory=list)
    releases: Array = field(default_factory=lambda: np.zeros((0, 4)))

    def add(self, result: Result) -> None:
        """Take in a probe with its events."""
        self.times.append(result.final_state.time)
        self.releases = releases(result)
        self.differences.append(return_difference(result, self.releases))

    def settled(self, tolerance: float, near: float) -> bool:
        """Whether the motion has settled on a periodic orbit; `near`: distance from a stable cycle that will do."""
        d = self.differences
        if len(d) < FEWEST or not d[-1] <= max(tolerance, near):
            return False
        if not (d[-1] <= d[-2] <= d[-3] or max(d[-1], d[-2]) <= tolerance):
            return False
        fallen = d[-1] <= tolerance and d[-1] * FALL <= np.nanmax(d)
        if self.cycle is None:
            return fallen
        distance = self.distance
        if distance <= near and self.cycle.stable and RATES[0] <= self.rate / self.cycle.growth_rate <= RATES[1]:
            return True
        return fallen and (self.cycle.stable or distance > SAME)

    @cached_property
    def cycle(self) -> FloquetResult | None:
        """The stick-slip cycle near the published start, if there is one and it can be found."""
        if case_faults(self.parameters, "floquet"):
            return None
        found = floquet(self.parameters)
        return found if found.status is CycleStatus.OK else None

    @property
    def distance(self) -> float:
        """Largest distance of the last probe's releases from that of the cycle, relative; infinite without both."""
        if self.cycle is None or self.cycle.state is None or not len(self.releases):
            return math.inf
        state, n = self.cycle.state, max(self.cycle.releases, 1)
        there = _scaled(self.parameters, np.array([[state.psi, state.u, state.u_velocity]]))
        apart = np.sqrt(np.mean((self.releases[:, :3] - there) ** 2, axis=1))
        return min(float(apart[i::n].max()) for i in range(min(n, len(apart))))

    def orbit(self, near: float) -> State | None:
        """A state on the stable cycle if the motion is near to it."""
        return self.cycle.state if self.cycle is not None and self.cycle.stable and self.distance <= near else None

    @property
    def growing(self) -> bool:
        """As of the differences."""
        return growing(self.differences)

    @property
    def rate(self) -> float:
        """Growth rate of the difference over the last probes, 1/s; nan if there are too few."""
        t, d = np.array(self.times[-FEWEST:]), np.array(self.differences[-FEWEST:])
        if len(t) < FEWEST or not np.all(d > 0):
            return math.nan
        return float(np.polyfit(t, np.log(d), 1)[0])


@dataclass(frozen=True)
class Followed:
    """Where following a motion ended.

    result : of the last stretch; its status and message say whether anything went wrong
    settled : whether it was left early because it had settled
    orbit : a state on the stable cycle near which it was left
    late : None if it separated or failed
    simulated : s
    """

    result: Result
    settling: Settling
    settled: bool
    orbit: State | None
    late: Late | None
    first_separation: float
    simulated: float


def follow(
    p: Parameters,
    horizon: float,
    *,
    tol: float,
    settled: float,
    near: float,
    late: float = PROBE,
    initial_state: State | None = None,
) -> Followed:
    """Simulate from the published start until the first separation, a settled motion, or the horizon.

    Parameters
    ----------
    horizon : s
    settled : difference of successive cycles, relative, below which a motion has settled; 0: it never has
    near : distance from a stable cycle, relative, below which it has; 0: it never has
    late : s, length of the last stretch
    initial_state : where to start instead, at time 0
    """
    settling = Settling(p)
    state = initial_state
    for start, stop in _probes(horizon, late):
        result = _watched(p, state, start, stop, tol, "first_separation")
        if result.status is not Status.OK:
            break
        state = result.final_state
        settling.add(result)
        if stop >= horizon or settling.settled(settled, near):
            break
    end = result.final_state.time
    over = result.status is not Status.OK
    return Followed(
        result=result,
        settling=settling,
        settled=not over and end < horizon,
        orbit=settling.orbit(near) if not over and end < horizon else None,
        late=None if over else summary(result),
        first_separation=result.first_separation,
        simulated=end,
    )


def late_stretch(
    p: Parameters, state: State | None, duration: float, late: float, tol: float
) -> tuple[Result, Late | None]:
    """Go on from a state (None: the published start) for a duration (s) and summarise the last stretch of it.

    The summary is None if the simulation did not get there.
    """
    stop = (0.0 if state is None else state.time) + duration
    result = _watched(p, state, stop - late, stop, tol)
    return result, summary(result) if result.status is Status.OK else None


def summary(result: Result) -> Late:
    """Ranges and shares over a result with one window of samples that begins where it does."""
    P, u = result.samples[0]["P"], result.samples[0]["u"] - result.u_0
    return Late(float(P.min()), float(P.max()), float(u.min()), float(u.max()), *shares(result))


def shares(result: Result) -> tuple[float, float, float, float]:
    """Of the time of a result: spent in stick, slip and separation; and separations per second."""
    statistics = result.statistics
    stick, slip, separation = (statistics[f"time_{phase}"] for phase in ("stick", "slip", "separation"))
    total = stick + slip + separation
    return stick / total, slip / total, separation / total, statistics["separations"] / total


def releases(result: Result) -> Array:
    """States of the slider at the stick releases of a result, shape (n, 4), relative to their size at rest.

    Angle, height from static equilibrium, velocity, contact force. All modes act on these, and a few dozen successive
    releases see them in all their phases.
    """
    events = result.events
    at = (events["kind"] == "stick_to_slip").to_numpy()
    p = result.parameters
    slider = np.stack([events[name].to_numpy()[at] for name in ("psi", "u", "u_velocity")], axis=1)
    return np.column_stack([_scaled(p, slider), events["P"].to_numpy()[at] / p.N])


def return_difference(result: Result, states: Array) -> float:
    """Root mean square of the change from one release to the next, relative.

    If a period of the motion has several releases, states that many releases apart are compared. If the slider never
    sticks, or will stick for ever, the range of the contact force relative to the preload stands in, which is 0 in
    steady sliding and at rest. nan if there are too few releases to compare, or none as yet.
    """
    p = result.parameters
    if p.N == 0:
        return 0.0
    if not len(states):
        if result.statistics["time_stick"] > 0 and p.k_p * p.Omega > 0:
            return math.nan  # the drive goes on to load the spring
        P = result.samples[0]["P"]
        return float(P.max() - P.min()) / p.N
    spans = range(1, min(LARGEST_PERIOD, len(states) // 2) + 1)
    changes = (states[n:] - states[:-n] for n in spans)
    return min((float(np.sqrt(np.mean(change**2))) for change in changes), default=math.nan)


def _scaled(p: Parameters, slider: Array) -> Array:
    """Angle, height from static equilibrium, velocity from psi (rad), u (m), u' (m/s), shape (n, 3) both."""
    modes = mode_arrays(p)
    rest = engine_case(p).model.u_0
    slowest = float(modes.omega.min(initial=math.inf))
    # psi when friction lets go under the preload
    release = p.mu_s * p.N / (p.k_p * p.r_0) if p.k_p > 0 and p.mu_s > 0 else 1.0
    sizes = [release, abs(rest) or 1.0, abs(rest) * slowest if 0 < abs(rest) * slowest < math.inf else 1.0]
    return (slider - np.array([0.0, rest, 0.0])) / np.array(sizes)


def growing(differences: Sequence[float]) -> bool:
    """Whether differences have risen, over two or more: an instability, even if it is bounded by now."""
    d = np.array(differences)
    if len(d) < 3:
        return False
    least = np.fmin.accumulate(d[:-2])
    later = np.fmin(d[1:-1], d[2:])
    return bool(np.any((later > NOISE) & (later > GROWTH * least)))


def _watched(
    p: Parameters, state: State | None, start: float, stop: float, tol: float, stop_at: str | None = None
) -> Result:
    """Go on to a time `stop` with samples from `start` on, s, or to where that ends."""
    if start > (0.0 if state is None else state.time):
        result = simulate(p, start, tol=tol, initial_state=state, record=_NOTHING, stop_at=stop_at)
        if result.status is not Status.OK:
            return result
        state = result.final_state
    return simulate(p, stop, tol=tol, initial_state=state, record=_watching(start, stop), stop_at=stop_at)


def _watching(start: float, stop: float) -> Record:
    return Record(windows=(Window(start=start, stop=stop, rate=RATE),))


def _probes(horizon: float, late: float) -> list[tuple[float, float]]:
    """Start and stop of the probes, s; the last ends at the horizon."""
    spans: list[tuple[float, float]] = []
    stop = FIRST_PROBE
    while stop * SPACING**0.5 < horizon - late:
        # a probe begins where the one before has ended, or later
        spans.append((max(stop - late, spans[-1][1] if spans else 0.0), stop))
        stop = max(stop * SPACING, stop + late)
    last = max(horizon - late, spans[-1][1] if spans else 0.0)
    return [*spans, (last, horizon)]
