"""The range of motions that separate, beside the one at which their vibration loses contact."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated

import numpy as np
from xarray import Dataset

from disc_model.parameters import Parameters
from disc_model.simulation.case import Window
from disc_model.studies.quantity import Row, found, listed, quantity
from disc_model.units import Finite, Seconds, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.simulation.result import Result

LATE = 2.0
"""The last stretch, over which all is measured, s."""
EARLIER = 0.75
"""Share of a run at which the earlier stretch ends, whose range says whether the motion has settled."""
RATE = 8000.0
"""Samples per second: an extreme between two of them is missed by less than 0.2 % of the range up to
300 Hz, and by far less in a window of many periods."""


@quantity(
    points_per_job=350,
    rules=(
        (lambda o: o.horizon > LATE, "horizon={0.horizon:g} must be > 2"),
        (
            lambda o: o.displaced_horizon > LATE,
            "displaced_horizon={0.displaced_horizon:g} must be > 2",
        ),
    ),
)
def range_law(
    case: Parameters,
    *,
    horizon: Seconds = 80.0,
    displaced_horizon: Seconds = 40.0,
    blow: Annotated[Finite, Unit("m/s")] = 0.0,
    in_contact: bool = False,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Range of the slider's height where contact is lost again and again, from the static start and from a
    displaced one, and the range `disc_model.pinned_range` at the frequency of its vibration.

    The second start is displaced downward, slider and disc, by two static deflections: contact is lost at once. All is
    measured over the last two seconds.

    Parameters
    ----------
    horizon : time simulated from the static start
    displaced_horizon : time simulated from the displaced start
    blow : upward velocity of the second start, slider and disc, in place of its displacement, unless 0
    in_contact : whether motions that keep contact are measured as well
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> found = dm.range_law(case, horizon=3, displaced_horizon=6)
    >>> print(f"{found['pinned_range'].sel(begin='displaced').item():.3f} m")
    0.034 m
    """
    from disc_model.simulation.api import simulate
    from disc_model.simulation.states import perturb, static_start

    static = static_start(case)
    kick = {"u": 2 * static.u}
    if blow:
        kick = {"u_velocity": blow}
    starts = (static, horizon), (perturb(case, static, **kick), displaced_horizon)
    rows = []
    for state, end in starts:
        on = partial(simulate, case, tol=tol, events=False)
        start = max(0.0, EARLIER * end - LATE)
        stop = min(start + LATE, end - LATE)
        earlier = {"earlier": Window(start=start, stop=stop, rate=RATE)}
        before = on(end - LATE, windows=earlier, initial_state=state).raise_for_status()
        late = {"late": Window(start=end - LATE, stop=end, rate=RATE)}
        run = on(end, windows=late, initial_state=before.final_state).raise_for_status()
        row = {"first_separation": np.fmin(before.first_separation, run.first_separation)}
        if in_contact or run.statistics["n_separations"]:
            row |= _measure(run)
            row["earlier_range"] = np.ptp(before["earlier"]["u"].values)
        rows.append(row)
    return found("range_law", listed(rows), begin=("static", "displaced"))


def _measure(run: Result) -> Row:
    """Columns of a stretch of motion."""
    from disc_model.analysis.contact_loss import pinned_range
    from disc_model.analysis.spectra import main_frequency, share_at

    count = run.statistics["n_separations"]
    samples = run["late"]
    time = samples["time"].values
    height = samples["u"].values
    duration = float(time[-1] - time[0])
    frequency = main_frequency(time, height)
    pinned = pinned_range(run.parameters, frequency)
    extent = float(np.ptp(height))
    return {
        "range": extent,
        "pinned_range": pinned,
        "deviation": extent / pinned - 1,
        "lowest_force": float(samples["P"].min()),
        "vibration_frequency": frequency,
        "vibration_share": share_at(time, height, frequency),
        "force_share": share_at(time, samples["P"].values, frequency),
        "separation_rate": count / duration,
        "separation_fraction": run.statistics["time_separation"] / duration,
        "stick_fraction": run.statistics["time_stick"] / duration,
    }
