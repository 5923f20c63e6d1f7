"""Segments of motions: stretches that are simulated, and described by ranges and shares of time."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.engine.record import EVENT_ROW
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State

# columns of `Result.event_rows`: tables of pandas take longer than short legs
TIME = EVENT_ROW.index("time")
KIND = EVENT_ROW.index("kind")
ANGLE = EVENT_ROW.index("psi")
SAMPLING_RATE = 4000.0  # Hz: above twice the highest modal frequency
# of the period of a cycle whose range is measured: a parabola through three of them errs by 1e-7 of the
# range, if its highest harmonic that matters is the hundredth
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
    result = simulate(p, stop, late_window(stop - late, stop), tol=tol, initial_state=state)
    return result, segment_of(result) if result.status.complete else None


def late_window(start: float, stop: float) -> dict[str, Window]:
    """The window that `segment_of` describes, from one time to another (s)."""
    return {"late": Window(start=start, stop=stop, rate=SAMPLING_RATE)}


def segment_of(result: Result) -> Segment:
    """The segment of a result: ranges over its window "late", and shares of its whole time."""
    P = result.samples["late"]["P"]
    u = result.samples["late"]["u"] - result.u_0
    stick, slip, separation, rate = shares(result)
    return Segment(
        P_min=float(P.min()),
        P_max=float(P.max()),
        u_min=float(u.min()),
        u_max=float(u.max()),
        stick_fraction=stick,
        slip_fraction=slip,
        separation_fraction=separation,
        separation_rate=rate,
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
    names = ("time_stick", "time_slip", "time_separation", "n_separations")
    total = _duration(result)
    return Shares(*(result.statistics[name] / total for name in names))


def _duration(result: Result) -> float:
    """The whole time of a result, s."""
    statistics = result.statistics
    return statistics["time_stick"] + statistics["time_slip"] + statistics["time_separation"]


def slips_on(leg: Result) -> bool:
    """Whether a leg has only slip in its later half. Slip between two sticks, where a motion is
    linear as well, is shorter than any leg."""
    later = leg.final_state.time - _duration(leg) / 2
    return leg.final_state.phase == "slip" and not np.any(leg.event_rows[:, TIME] > later)


def event_times(leg: Result, kind: int) -> Array:
    """Times of the events of a kind of `engine.record`, s."""
    rows = leg.event_rows
    return rows[rows[:, KIND] == kind, TIME]


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
    result = simulate(p, state.time + period, {"cycle": window}, initial_state=state)
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
