"""Speed ramps up and down as on a test rig: speeds at which separation begins and ends, against the ramp's rate."""

import math
from typing import Any

from disc_model.data.variables import Variable
from disc_model.engine.event_loop import EVENT_ROW, LOSS_OF_CONTACT
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.simulation.ramps import Ramp
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.studies.document import RampsOptions
from disc_model.studies.grids.points import STATUS, Coordinate, Point, listed

_DIMS = ("rate",)
COLUMNS = {
    "status": STATUS,
    "rate_status": STATUS._replace(dims=_DIMS),
    "onset_speed": Variable("rad s-1", "speed at the first separation on the way up, nan if there is none", dims=_DIMS),
    "top_separation_rate": Variable("s-1", "separations per second over the stay at the highest speed", dims=_DIMS),
    "offset_speed": Variable(
        "rad s-1", "speed at the last separation on the way down, nan if there is none, or it continues", dims=_DIMS
    ),
}
COORDINATES = {"rate": Coordinate("rad s-2", "rate of the speed's ramps", lambda o: o.rates.values)}
_TIME, _KIND = EVENT_ROW.index("time"), EVENT_ROW.index("kind")


def compute_point(point: Point, options: RampsOptions) -> tuple[dict[str, Any], str]:
    """Simulate one run for each rate; the point's own Omega is not used."""
    rows: list[dict[str, Any]] = []
    status, message = "ok", ""
    for rate in options.rates.values:
        found, failed = _run(point.parameters.replace(Omega=options.low), rate, options)
        rows.append({"rate_status": failed.status.value if failed else "ok", **found})
        if failed:
            status, message = failed.status.value, f"rate={rate:g}: {failed.message}"
    return listed(rows) | {"status": status}, message


def _run(p: Parameters, rate: float, options: RampsOptions) -> tuple[dict[str, float], Result | None]:
    """One run: up from the lowest speed, a dwell at the highest, down again, and a dwell at the lowest.

    Returns values of the columns, as far as they are known, and the part of the run that failed, if any.
    """
    top = (options.high - options.low) / rate
    down = top + options.dwell
    bottom = down + top
    up_and_down = (
        Ramp(parameter="Omega", to=options.high, start=0.0, end=top),
        Ramp(parameter="Omega", to=options.low, start=down, end=bottom),
    )

    def on(state: State | None, until: float, stop_at: str | None = None, events: bool = False) -> Result:
        """Continue the motion to a later time."""
        record = Record(events=events)
        return simulate(
            p, until, tol=options.tol, initial_state=state, record=record, stop_at=stop_at, ramps=up_and_down
        )

    run = on(None, top, stop_at="first_separation")
    values = {"onset_speed": options.low + rate * run.first_separation}
    if run.status.value == "stopped":
        run = on(run.final_state, top)
    if run.status.complete:
        run = on(run.final_state, down)
    if not run.status.complete:
        return values, run
    values["top_separation_rate"] = run.statistics["separations"] / options.dwell
    last, end = math.nan, bottom + options.dwell
    while run.final_state.time < end:
        # events of all of the way would fill hundreds of MB
        run = on(run.final_state, min(run.final_state.time + 100.0, end), events=True)
        lost = run.event_rows[run.event_rows[:, _KIND] == LOSS_OF_CONTACT, _TIME]
        last = float(lost[-1]) if lost.size else last
        if not run.status.complete:
            return values, run
    if last < bottom:
        values["offset_speed"] = options.high - rate * (last - down)
    return values, None
