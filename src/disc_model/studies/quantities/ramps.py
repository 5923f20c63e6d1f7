"""Speed ramps up and down as on a test rig: speeds at which separation begins and ends, against the
ramp's rate."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

from xarray import Dataset

from disc_model.parameters import Parameters
from disc_model.simulation.case import Ramp
from disc_model.studies.quantity import Row, Values, found, listed, quantity
from disc_model.units import Seconds, Speed, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.simulation.result import Result


@quantity(
    points_per_job=3,
    own=("Omega",),
    rules=(
        (lambda o: o.bounds[0] < o.bounds[1], "bounds={0.bounds} must ascend"),
        (lambda o: min(o.rates) > 0, "rates={0.rates} must be > 0"),
    ),
)
def ramps(
    case: Parameters,
    *,
    bounds: Annotated[tuple[Speed, Speed], Unit("rad/s")],
    rates: Annotated[Values, Unit("rad/s^2")],
    dwell: Seconds = 60.0,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Slow ramps of the speed, up from the static start and down again, once for each rate.

    Parameters
    ----------
    bounds : speed at which the ramps begin and end, and that up to which they rise
    rates : rates of the ramps, a run each
    dwell : time at the highest speed, and at the lowest one in the end
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> found = dm.ramps(dm.Parameters(N=385, Omega=15), bounds=(15, 18), rates=[1.0], dwell=1)
    >>> found["top_separation_rate"].values
    array([0.])
    """
    runs = [_run(case.replace(Omega=bounds[0]), bounds, rate, dwell, tol) for rate in rates]
    return found("ramps", listed(runs), rate=rates)


def _run(
    case: Parameters, bounds: tuple[float, float], rate: float, dwell: float, tol: float
) -> Row:
    """Columns of one run, with a dwell at both speeds; raises `SimulationError`."""
    from disc_model.engine.record import LOSS_OF_CONTACT
    from disc_model.simulation.api import simulate
    from disc_model.stability.segments import event_times

    low, high = bounds
    top = (high - low) / rate
    down = top + dwell
    bottom = down + top
    up = Ramp(parameter="Omega", to=high, start=0.0, end=top)
    ramps = (up, Ramp(parameter="Omega", to=low, start=down, end=bottom))

    def on(until: float, run: Result | None = None, **how: Any) -> Result:
        state = run.final_state if run else None
        reached = simulate(case, until, ramps=ramps, tol=tol, initial_state=state, **how)
        return reached.raise_for_status()

    run = on(top, events=False, stop_at="first_separation")
    onset = low + rate * run.first_separation
    if run.status.value == "stopped":
        run = on(top, run, events=False)
    run = on(down, run, events=False)
    stay = run.statistics["n_separations"] / dwell
    last = math.nan
    while run.final_state.time < bottom + dwell:
        # events of all of the way would fill hundreds of MB
        run = on(min(run.final_state.time + 100.0, bottom + dwell), run, events=True)
        lost = event_times(run, LOSS_OF_CONTACT)
        if lost.size:
            last = float(lost[-1])
    values = {"rate_status": "ok", "onset_speed": onset, "top_separation_rate": stay}
    if last < bottom:
        values["offset_speed"] = high - rate * (last - down)
    return values
