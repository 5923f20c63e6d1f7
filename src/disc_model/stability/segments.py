"""Segments of motions: stretches that are simulated, and described by ranges and shares of time."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.engine.record import EVENT_ROW, LOSS_OF_CONTACT, STICK_TO_SLIP
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability import thresholds

# columns of `Result.event_rows`: tables of pandas take longer than short legs
TIME = EVENT_ROW.index("time")
KIND = EVENT_ROW.index("kind")
ANGLE = EVENT_ROW.index("psi")
RANGE_TOL = 1e-10  # of the simulation of a cycle whose range is measured
# of a period of that cycle: a parabola through three of them errs by 1e-7 of the range, if its
# highest harmonic that matters is the hundredth
SAMPLES_OF_CYCLE = 4000


@dataclass(frozen=True)
class Segment:
    """Ranges of contact force (N) and height over static equilibrium (m); shares of time;
    separations per s; and the largest speed of the disc's surface over that of the drive, 0 where
    the surface does not move."""

    P_min: float
    P_max: float
    u_min: float
    u_max: float
    stick_fraction: float
    slip_fraction: float
    separation_fraction: float
    separation_rate: float
    surface_speed: float = 0.0

    @property
    def range(self) -> float:
        """Range of the height, m."""
        return self.u_max - self.u_min


def simulate_leg(
    p: Parameters, stop: float, start: State | None, tol: float, described_from: float | None = None
) -> Result:
    """Simulate from a state (None: the static start) to a time (s) or the first separation, if that
    comes first.

    described_from : s, begin of the segment that `segment_of` is to describe; None for none
    """
    windows = {}
    if described_from is not None:
        windows = {"late": Window(start=described_from, stop=stop, rate=thresholds.SAMPLING_RATE)}
    return simulate(p, stop, windows, tol=tol, initial_state=start, stop_at="first_separation")


def final_segment(
    p: Parameters, state: State | None, duration: float, late: float, tol: float
) -> tuple[Result, Segment | None]:
    """Simulate from a state (None: the static start) for a duration (s); its last segment, if it is
    complete."""
    begin = 0.0
    if state is not None:
        begin = state.time
    stop = begin + duration
    if stop - late > begin:
        result = simulate(p, stop - late, tol=tol, initial_state=state, events=False)
        if not result.status.complete:
            return result, None
        state = result.final_state
    window = Window(start=stop - late, stop=stop, rate=thresholds.SAMPLING_RATE)
    result = simulate(p, stop, {"late": window}, tol=tol, initial_state=state)
    if not result.status.complete:
        return result, None
    return result, segment_of(result)


class Extremes(NamedTuple):
    """Least and greatest height of the slider over static equilibrium, m."""

    u_min: float
    u_max: float

    @property
    def range(self) -> float:
        """Range of the height, m."""
        return self.u_max - self.u_min


def extremes_of_cycle(p: Parameters, state: State, period: float) -> Extremes:
    """Extremes of the slider's height over a period (s) from a state of a cycle; nan if it cannot be
    simulated."""
    window = Window(start=state.time, rate=SAMPLES_OF_CYCLE / period)
    result = simulate(p, state.time + period, {"cycle": window}, tol=RANGE_TOL, initial_state=state)
    if not result.status.complete:
        return Extremes(float("nan"), float("nan"))
    height = result.samples["cycle"]["u"] - result.u_0
    return Extremes(-_peak(-height), _peak(height))


def _peak(samples: Array) -> float:
    """The largest value of a periodic quantity from samples of a period: that of the parabola
    through the largest sample and its neighbours."""
    i = int(np.argmax(samples))
    before, largest, after = np.take(samples, (i - 1, i, i + 1), mode="wrap").tolist()
    curvature = 2 * largest - before - after
    if curvature <= 0:  # a constant height
        return float(largest)
    return float(largest + (after - before) ** 2 / (8 * curvature))


def segment_of(result: Result) -> Segment:
    """The segment of a result: ranges over its window "late", and shares of its whole time."""
    P = result.samples["late"]["P"]
    u = result.samples["late"]["u"] - result.u_0
    share = shares(result)
    return Segment(
        P_min=float(P.min()),
        P_max=float(P.max()),
        u_min=float(u.min()),
        u_max=float(u.max()),
        stick_fraction=share.stick,
        slip_fraction=share.slip,
        separation_fraction=share.separation,
        separation_rate=share.separation_rate,
        surface_speed=result.statistics.get("surface_speed", 0.0),
    )


class Shares(NamedTuple):
    """Shares of a motion's time in stick, slip and separation, and separations per second."""

    stick: float
    slip: float
    separation: float
    separation_rate: float


def shares(result: Result) -> Shares:
    """Shares of a result's time."""
    statistics = result.statistics
    total = _duration_of(result)
    stick = statistics["time_stick"] / total
    slip = statistics["time_slip"] / total
    separation = statistics["time_separation"] / total
    return Shares(stick, slip, separation, statistics["n_separations"] / total)


def _duration_of(result: Result) -> float:
    """The whole time of a result, s."""
    statistics = result.statistics
    return statistics["time_stick"] + statistics["time_slip"] + statistics["time_separation"]


def slips_on(leg: Result) -> bool:
    """Whether a leg has only slip in its later half. Slip between two sticks, where a motion is
    linear as well, is shorter than any leg."""
    later = leg.final_state.time - _duration_of(leg) / 2
    return leg.final_state.phase == "slip" and not np.any(leg.event_rows[:, TIME] > later)


def switch_angles(leg: Result) -> Array:
    """Times of releases and losses of contact of a leg, s, and the slider's angles, rad: shape (2,
    n)."""
    rows = leg.event_rows
    kinds = rows[:, KIND]
    switches = rows[(kinds == STICK_TO_SLIP) | (kinds == LOSS_OF_CONTACT)]
    return switches[:, [TIME, ANGLE]].T


def event_times(leg: Result, kind: int) -> Array:
    """Times of the events of a kind of `engine.record`, s."""
    rows = leg.event_rows
    return rows[rows[:, KIND] == kind, TIME]
