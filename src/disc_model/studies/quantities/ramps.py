"""Speed ramps up and down as on a test rig: speeds at which separation begins and ends, against the
ramp's rate."""

import math
from typing import Annotated, Any, ClassVar

from disc_model.data.variables import OF_QUANTITIES
from disc_model.parameters import Parameters
from disc_model.simulation.case import Ramp
from disc_model.studies.quantity import Coordinate, Point, Quantity, Range, Result, State, listed
from disc_model.units import Seconds, Speed, Tolerance, Unit


class Ramps(Quantity):
    """Slow ramps of the speed, up from the static start and down again, once for each rate."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    low: Speed
    """speed at which the ramps begin and end"""
    high: Speed
    """speed up to which they rise"""
    rates: Annotated[Range, Unit("rad/s^2")]
    """rates of the ramps, a run each"""
    dwell: Seconds = 60.0
    """time at the highest speed, and at the lowest one in the end"""

    _rules = (
        (lambda o: o.low < o.high, "low={0.low:g} must be < high={0.high:g}"),
        (lambda o: o.rates.start > 0, "rates must be > 0, but begin with {0.rates.start:g}"),
    )
    points_per_job: ClassVar = 3
    scans: ClassVar = ("Omega",)
    COLUMNS: ClassVar = OF_QUANTITIES["ramps"]["columns"]
    COORDINATES: ClassVar = {"rate": Coordinate(lambda o: o.rates.values)}

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        rows: list[dict[str, Any]] = []
        status = "ok"
        message = ""
        for rate in self.rates.values:
            run, failed = _run(point.parameters.replace(Omega=self.low), rate, self)
            row: dict[str, Any] = {"rate_status": "ok", **run}
            if failed is not None:
                status = failed.status.value
                message = f"rate = {rate:g} rad/s²: {failed.message}"
                row["rate_status"] = status
            rows.append(row)
        return {**listed(rows), "status": status}, message


def _run(p: Parameters, rate: float, options: Ramps) -> tuple[dict[str, float], Result | None]:
    """Columns, as far as they are known, of one run, with a dwell at both speeds, and its part that
    failed, if any."""
    from disc_model.engine.record import LOSS_OF_CONTACT
    from disc_model.simulation.api import simulate
    from disc_model.stability.segments import event_times

    top = (options.high - options.low) / rate
    down = top + options.dwell
    bottom = down + top
    ramps = (
        Ramp(parameter="Omega", to=options.high, start=0.0, end=top),
        Ramp(parameter="Omega", to=options.low, start=down, end=bottom),
    )

    def on(state: State | None, until: float, *, events: bool = False) -> Result:
        """Continue the motion to a later time."""
        return simulate(p, until, initial_state=state, ramps=ramps, events=events, tol=options.tol)

    run = simulate(p, top, ramps=ramps, events=False, tol=options.tol, stop_at="first_separation")
    values = {"onset_speed": options.low + rate * run.first_separation}
    if run.status.value == "stopped":
        run = on(run.final_state, top)
    if run.status.complete:
        run = on(run.final_state, down)
    if not run.status.complete:
        return values, run
    values["top_separation_rate"] = run.statistics["n_separations"] / options.dwell
    last = math.nan
    end = bottom + options.dwell
    while run.final_state.time < end:
        # events of all of the way would fill hundreds of MB
        run = on(run.final_state, min(run.final_state.time + 100.0, end), events=True)
        lost = event_times(run, LOSS_OF_CONTACT)
        if lost.size:
            last = float(lost[-1])
        if not run.status.complete:
            return values, run
    if last < bottom:
        values["offset_speed"] = options.high - rate * (last - down)
    return values, None
