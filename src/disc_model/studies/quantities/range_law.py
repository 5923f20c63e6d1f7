"""The range of motions that separate, beside the one at which their vibration loses contact."""

import math
from typing import Any, ClassVar

import numpy as np

from disc_model.data.variables import OF_QUANTITIES, PHASES
from disc_model.simulation.case import Window
from disc_model.studies.quantity import Coordinate, Point, Quantity, Result
from disc_model.units import Positive, Seconds, Tolerance

BEGINS = ("static", "displaced")
RATE = 8000.0
"""Samples per second: an extreme between two of them is missed by less than 0.2 % of the range up to
300 Hz, and by far less in a window of many periods."""
SEPARATION = PHASES.index("separation")


class RangeLaw(Quantity):
    """Range of the slider's height where contact is lost again and again, from the static start and
    from a displaced one, and the range `disc_model.pinned_range` at the frequency of its
    vibration."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    displacement: Positive = 2.0
    """downward displacement of the second start, of slider and disc, in static deflections: large
    enough that contact is lost at once"""
    horizon: Seconds = 80.0
    """time simulated from the static start"""
    displaced_horizon: Seconds = 40.0
    """time simulated from the displaced start"""
    evaluation_time: Seconds = 2.0
    """length of the last stretch of each, over which all is measured"""

    _rules = (
        (
            lambda o: o.evaluation_time < min(o.horizon, o.displaced_horizon),
            "evaluation_time={0.evaluation_time:g} must be < horizon={0.horizon:g} and < "
            "displaced_horizon={0.displaced_horizon:g}",
        ),
    )
    points_per_job: ClassVar = 350
    COLUMNS: ClassVar = OF_QUANTITIES["range_law"]["columns"]
    COORDINATES: ClassVar = {"begin": Coordinate(lambda options: BEGINS)}

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        columns: dict[str, list[float]] = {name: [] for name in self.COLUMNS if name != "status"}
        for begin in BEGINS:
            run = self._late(point, begin)
            if not run.status.complete:
                return {"status": run.status.value}, f"{begin} start: {run.message}"
            measured = _measure(run)
            for name, values in columns.items():
                values.append(measured.get(name, math.nan))
        return {"status": "ok", **columns}, ""

    def _late(self, point: Point, begin: str) -> Result:
        """The last stretch of a motion, with its samples; or the run that ended early."""
        from disc_model.simulation.api import simulate
        from disc_model.simulation.states import perturb, static_start

        p = point.parameters
        state = static_start(p)
        end = self.horizon
        if begin == "displaced":
            state = perturb(p, state, u=self.displacement * state.u)
            end = self.displaced_horizon
        start = end - self.evaluation_time
        run = simulate(p, start, tol=self.tol, initial_state=state, events=False)
        if not run.status.complete:
            return run
        windows = {"late": Window(start=start, stop=end, rate=RATE)}
        return simulate(p, end, windows, tol=self.tol, initial_state=run.final_state, events=False)


def _measure(run: Result) -> dict[str, float]:
    """Columns of a stretch of motion; none if contact is not lost."""
    from disc_model.analysis.classify import separation_location
    from disc_model.analysis.contact_loss import excess_of_flights, pinned_range
    from disc_model.analysis.spectra import main_vibration, vibration_at

    count = run.statistics["n_separations"]
    if not count:
        return {}
    samples = run["late"]
    time = samples["time"].values
    height = samples["u"].values
    duration = float(time[-1] - time[0])
    vibration = main_vibration(time, height)
    pinned = pinned_range(run.parameters, vibration.frequency)
    apart = run.statistics["time_separation"] / duration

    # samples at which separations begin; shorter ones lie between two samples
    is_apart = samples["phase"].values == SEPARATION
    starts = np.flatnonzero(np.diff(is_apart.astype(int)) == 1) + 1
    position = math.nan
    if starts.size:
        position = separation_location(height, starts)

    extent = float(np.ptp(height))
    return {
        "range": extent,
        "pinned_range": pinned,
        "deviation": extent / pinned - 1,
        "flight_excess": excess_of_flights(apart),
        "vibration_frequency": vibration.frequency,
        "vibration_share": vibration.share,
        "force_share": vibration_at(time, samples["P"].values, vibration.frequency).share,
        "separation_rate": count / duration,
        "separation_fraction": apart,
        "stick_fraction": run.statistics["time_stick"] / duration,
        "loss_position": position,
    }
