"""Short histories of the motion at a few points of a grid, for the explorer page. They begin at
`Quantity.state_at`."""

import math
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from disc_model.data.described import described
from disc_model.data.variables import OF_QUANTITIES
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.studies.quantity import Coordinate, Point, Quantity
from disc_model.studies.run import run_batch

SAMPLES = 256  # of a history: nearly four per oscillation of the fastest mode of the paper's disc in the longest one
CYCLES_SHOWN = 2  # number of stick-slip cycles in a history
LONGEST = (
    0.05  # greatest length of a cycle, s, where stick is very long or nothing pulls the slider back
)
SHOWN = ("P", "u", "psi")


class Motions:
    """A quantity for `run_batch` that computes histories instead of the study's own quantity."""

    COLUMNS: ClassVar = OF_QUANTITIES["motions"]["columns"]
    COORDINATES: ClassVar = {"sample": Coordinate(lambda o: range(SAMPLES))}

    def __init__(self, quantity: Quantity) -> None:
        self.quantity = quantity

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        p = point.parameters
        start = self.quantity.state_at(point).replace(time=0.0, time_low=0.0)
        # of a cycle: the mean time between releases, at least the free period, which stands for it
        # without releases
        cycle = LONGEST
        if p.k_p > 0:
            cycle = 2 * math.pi * math.sqrt(p.m / p.k_p)
        events = simulate(p, 0.5, initial_state=start).events
        released = events["time"][events["kind"] == "stick_to_slip"].to_numpy()
        if len(released) > 1:
            cycle = max(float(np.ptp(released)) / (len(released) - 1), cycle)
        length = CYCLES_SHOWN * min(cycle, LONGEST)
        window = Window(start=0.0, stop=length, rate=(SAMPLES - 1) / length)
        result = simulate(
            p, length, {"history": window}, events=False, initial_state=start
        ).raise_for_status()
        samples = result.samples["history"]
        histories = {name: samples[name] for name in SHOWN}
        phase = samples["phase"] + 1
        return {"status": "ok", "length": length, "phase": phase, **histories}, ""


def run_motions(text: str) -> xr.Dataset:
    """Histories along `point` and `sample`, for a text from
    `disc_model.studies.grid.GridStudy.motions`."""
    histories = run_batch(text, Motions)
    histories = histories.assign({name: histories[name].astype(np.float32) for name in SHOWN})
    return described(histories, "motions")
