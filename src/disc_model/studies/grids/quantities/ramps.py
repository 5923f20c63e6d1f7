"""Speed ramps up and down as on a test rig: speeds at which separation begins and ends, against the ramp's rate."""

import math
from typing import Any

from disc_model.data.variables import Variable
from disc_model.engine.event_loop import EVENT_ROW, LOSS_OF_CONTACT
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.simulation.ramps import Ramp
from disc_model.simulation.result import Result, State
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
        found, failed = _Run(point.parameters, rate, options).found()
        rows.append({"rate_status": failed.status.value if failed else "ok", **found})
        if failed:
            status, message = failed.status.value, f"rate={rate:g}: {failed.message}"
    return listed(rows) | {"status": status}, message


class _Run:
    """One run: up from the lowest speed, a dwell at the highest, down again, and a dwell at the lowest."""

    def __init__(self, p: Parameters, rate: float, options: RampsOptions) -> None:
        self.p, self.rate, self.options = p.replace(Omega=options.low), rate, options
        self.top = (options.high - options.low) / rate
        self.down = self.top + options.dwell
        self.bottom = self.down + self.top
        self.ramps = (
            Ramp(parameter="Omega", to=options.high, start=0.0, end=self.top),
            Ramp(parameter="Omega", to=options.low, start=self.down, end=self.bottom),
        )

    def found(self) -> tuple[dict[str, float], Result | None]:
        """Values of the columns, as far as they are known, and the run that failed, if any."""
        first = self._on(None, self.top, stop_at="first_separation")
        values = {"onset_speed": self.options.low + self.rate * first.first_separation}
        there = self._on(first.final_state, self.top) if first.status.value == "stopped" else first
        if not there.status.complete:
            return values, there
        stay = self._on(there.final_state, self.down)
        if not stay.status.complete:
            return values, stay
        values["top_separation_rate"] = stay.statistics["separations"] / self.options.dwell
        last, failed = self._last_separation(stay.final_state)
        if not failed and last < self.bottom:
            values["offset_speed"] = self.options.high - self.rate * (last - self.down)
        return values, failed

    def _last_separation(self, state: State) -> tuple[float, Result | None]:
        """Time of the last loss of contact after the way down began, s; nan if there is none."""
        last, end = math.nan, self.bottom + self.options.dwell
        while state.time < end:
            # events of all of the way would fill hundreds of MB
            run = self._on(state, min(state.time + 100.0, end), events=True)
            lost = run.event_rows[run.event_rows[:, _KIND] == LOSS_OF_CONTACT, _TIME]
            last = float(lost[-1]) if lost.size else last
            if not run.status.complete:
                return last, run
            state = run.final_state
        return last, None

    def _on(self, state: State | None, until: float, stop_at: str | None = None, events: bool = False) -> Result:
        """Continue the motion to a later time."""
        record = Record(events=events)
        return simulate(
            self.p, until, tol=self.options.tol, initial_state=state, record=record, stop_at=stop_at, ramps=self.ramps
        )
