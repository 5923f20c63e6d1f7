"""Short histories of the motion at a few points of a grid, for the explorer page. They begin where
`Motion.state` of the quantity says."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.studies.quantity import found

SAMPLES = 256  # of a history: nearly four per oscillation of the fastest mode of the paper's disc in the longest one
CYCLES_SHOWN = 2  # number of stick-slip cycles in a history
LONGEST = (
    0.05  # greatest length of a cycle, s, where stick is very long or nothing pulls the slider back
)
SHOWN = ("P", "u", "psi")


def history_from(state: Callable[..., State], case: Parameters, **options: Any) -> xr.Dataset:
    """A history that begins at a state of a quantity, along `sample`."""
    start = state(case, **options).replace(time=0.0)
    # of a cycle: the mean time between releases, at least the free period, which stands for it
    # without releases
    cycle = math.tau * math.sqrt(case.m / case.k_p) if case.k_p > 0 else LONGEST
    events = simulate(case, 0.5, initial_state=start).events
    released = events["time"][events["kind"] == "stick_to_slip"].to_numpy()
    if len(released) > 1:
        cycle = max(float(np.ptp(released)) / (len(released) - 1), cycle)
    length = CYCLES_SHOWN * min(cycle, LONGEST)
    window = Window(start=0.0, stop=length, rate=(SAMPLES - 1) / length)
    result = simulate(case, length, {"history": window}, events=False, initial_state=start)
    samples = result.raise_for_status().samples["history"]
    values: dict[str, Any] = {name: samples[name] for name in SHOWN}
    values |= {"status": "ok", "length": length, "phase": samples["phase"] + 1}
    return found("motions", values, sample=range(SAMPLES))
