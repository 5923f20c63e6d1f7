"""Short histories of the motion at a few points of a grid, for the explorer page. They begin where
`Motion.state` of the quantity says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from xarray import Dataset

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State
from disc_model.studies.quantity import Row, found

SAMPLES = 256  # of a history: nearly four per oscillation of the fastest mode of the paper's disc
LENGTH = 0.1  # of a history, s: some cycles of stick and slip
SHOWN = ("P", "u", "psi")


def history_from(state: Callable[..., State], case: Parameters, **options: Any) -> Dataset:
    """A history that begins at a state of a quantity, along `sample`."""
    start = state(case, **options).replace(time=0.0)
    window = Window(start=0.0, stop=LENGTH, rate=(SAMPLES - 1) / LENGTH)
    result = simulate(case, LENGTH, {"history": window}, events=False, initial_state=start)
    samples = result.raise_for_status().samples["history"]
    values: Row = {name: samples[name] for name in SHOWN}
    values |= {"status": "ok", "length": LENGTH, "phase": samples["phase"] + 1}
    return found("motions", values, sample=range(SAMPLES))
