"""Segments of motions: stretches that are simulated, and described by ranges and shares of time."""

import math
from dataclasses import dataclass

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
    begin = 0.0
    if state is not None:
        begin = state.time
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
    statistics = result.statistics
    total = duration_of(result)
    return Segment(
        P_min=float(P.min()),
        P_max=float(P.max()),
        u_min=float(u.min()),
        u_max=float(u.max()),
        stick_fraction=statistics["time_stick"] / total,
        slip_fraction=statistics["time_slip"] / total,
        separation_fraction=statistics["time_separation"] / total,
        separation_rate=statistics["n_separations"] / total,
        surface_speed=statistics.get("surface_speed", 0.0),
    )


def duration_of(result: Result) -> float:
    """The simulated time of a result, s."""
    return sum(result.statistics[name] for name in ("time_stick", "time_slip", "time_separation"))


def stick_share(result: Result) -> float:
    """The share of stick in a result's time."""
    return result.statistics["time_stick"] / duration_of(result)


def event_times(leg: Result, kind: int) -> Array:
    """Times of the events of a kind of `engine.record`, s."""
    rows = leg.event_rows
    return rows[rows[:, KIND] == kind, TIME]


def extremes_of_cycle(p: Parameters, state: State, period: float) -> tuple[float, float]:
    """Least and greatest height of the slider over static equilibrium (m) in a period (s) from a state
    of a cycle; nan if it cannot be simulated."""
    window = Window(start=state.time, rate=SAMPLES_OF_CYCLE / period)
    result = simulate(p, state.time + period, {"cycle": window}, initial_state=state)
    if not result.status.complete:
        return math.nan, math.nan
    height = result.samples["cycle"]["u"] - result.u_0
    return -_peak(-height), _peak(height)


def _peak(samples: Array) -> float:
    """The largest value of a periodic quantity from samples of a period: that of the parabola
    through the largest sample and its neighbours."""
    i = int(np.argmax(samples))
    before, largest, after = np.take(samples, (i - 1, i, i + 1), mode="wrap").tolist()
    curvature = 2 * largest - before - after
    if curvature <= 0:  # a constant height
        return float(largest)
    return float(largest + (after - before) ** 2 / (8 * curvature))
