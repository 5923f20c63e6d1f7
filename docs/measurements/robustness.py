"""How far the verdicts on slips (A1, A2) depend on the least fall that counts as a slip, and on the
scatter of the slips. This was not planned."""

from typing import NamedTuple

import numpy as np
import pandas as pd
from docs.measurements import stick_slip
from docs.measurements.comparison import Comparison
from docs.measurements.signals import LEAST_FALLS, RATE
from docs.measurements.stick_slip import CALIBRATION, MEDIANS, QUANTITIES

DRAWS = 2000
"""Samples of the bootstrap."""
BLOCK = 10
"""Slips that follow one another and are drawn together, because friction drifts."""
LEVEL = 95.0
"""Per cent of the draws within an interval."""


class Ratio(NamedTuple):
    """A predicted median over the measured one.

    Parameters
    ----------
    what : quantity and run
    value : of the medians
    low, high : ends of its interval
    """

    what: str
    value: float
    low: float
    high: float

    @property
    def verdict(self) -> str:
        """Whether the interval lies within the tolerance, "yes", outside of it, "no", or across one
        of its ends, "undecided"."""
        if self.low >= 1 - MEDIANS and self.high <= 1 + MEDIANS:
            return "yes"
        if self.high < 1 - MEDIANS or self.low > 1 + MEDIANS:
            return "no"
        return "undecided"


def ratios() -> dict[float, list[Ratio]]:
    """Return A1 and A2 with intervals, for each least fall."""
    found: dict[float, list[Ratio]] = {}
    for least_fall in LEAST_FALLS:
        compared = stick_slip.medians(least_fall)
        found[least_fall] = []
        for quantity in QUANTITIES:
            by_run = {each.what: each for each in compared[quantity]}
            for run in stick_slip.runs():
                if stick_slip.name(run) in by_run:
                    comparison = by_run[stick_slip.name(run)]
                    found[least_fall].append(interval(quantity, run, comparison, least_fall))
    return found


def interval(
    quantity: str, run: tuple[int, int], comparison: Comparison, least_fall: float
) -> Ratio:
    """Return the ratio of a comparison with its interval, by bootstrap.

    Slips of the run and of the calibrating run are drawn with replacement, in blocks. The predicted
    value follows friction as in the closed form. Times are rounded to samples and measured forces to
    steps, at both ends of a difference, which gives a triangular error.
    """
    generator = np.random.default_rng(0)
    middle = measured_medians(quantity, run, least_fall, generator)
    model = comparison.predicted * scales(quantity, run, least_fall, generator)
    if quantity != "fall":
        model += rounding(1 / RATE, generator)
    low, high = ends(model / middle)
    what = f"{quantity}, {comparison.what}"
    return Ratio(what, comparison.ratio, low, high)


def least(quantity: str, run: tuple[int, int], least_fall: float) -> Ratio:
    """Return the least period or fall that a block with the stated mass and stiffness can have,
    whatever its constants of friction, over the measured median, with the interval of the latter."""
    generator = np.random.default_rng(0)
    middle = measured_medians(quantity, run, least_fall, generator)
    swing = stick_slip.swing(run, 0.0)
    model = float(swing.fall if quantity == "fall" else swing.period)
    seen = values(quantity, stick_slip.measured(run, least_fall))
    value = model / float(np.median(seen))
    low, high = ends(model / middle)
    return Ratio(f"{quantity}, {stick_slip.name(run)}", value, low, high)


def measured_medians(
    quantity: str, run: tuple[int, int], least_fall: float, generator: np.random.Generator
) -> np.ndarray:
    """Return medians of drawn slips of a run, with the rounding of times and forces."""
    seen = stick_slip.measured(run, least_fall)
    step = stick_slip.record(run)["quantum"] if quantity == "fall" else 1 / RATE
    return medians_of_draws(values(quantity, seen), generator) + rounding(step, generator)


def ends(draws: np.ndarray) -> tuple[float, float]:
    """Return the ends of the interval that holds the middle part, `LEVEL`, of draws."""
    tail = (100 - LEVEL) / 2
    low, high = np.percentile(draws, [tail, 100 - tail])
    return float(low), float(high)


def values(quantity: str, table: pd.DataFrame) -> np.ndarray:
    """Return a quantity of each slip."""
    if quantity == "period":
        return np.diff(table["start_s"])
    if quantity == "fall":
        return (table["before"] - table["after"]).to_numpy()
    return table["duration_s"].to_numpy()


def scales(
    quantity: str, run: tuple[int, int], least_fall: float, generator: np.random.Generator
) -> np.ndarray:
    """Return what drawn friction makes of a predicted value, over what the medians make of it."""
    if quantity == "duration":
        return np.ones(DRAWS)
    calibration = stick_slip.measured(CALIBRATION, least_fall)
    halves = values("fall", calibration) / 2
    quantum = stick_slip.record(CALIBRATION)["quantum"]
    drawn = medians_of_draws(halves, generator) + rounding(quantum / 2, generator)
    central = stick_slip.swing(run, np.median(halves))
    varied = stick_slip.swing(run, drawn)
    if quantity == "period":
        return varied.period / central.period
    return varied.fall / central.fall


def medians_of_draws(sample: np.ndarray, generator: np.random.Generator) -> np.ndarray:
    """Return medians of samples drawn in blocks of neighbours; the last is next to the first."""
    count = -(-sample.size // BLOCK)
    starts = generator.integers(sample.size, size=(DRAWS, count, 1))
    places = (starts + np.arange(BLOCK)).reshape(DRAWS, -1)[:, : sample.size]
    return np.median(sample[places % sample.size], axis=1)


def rounding(step: float, generator: np.random.Generator) -> np.ndarray:
    """Return errors of a difference of two numbers that are rounded to a step."""
    return generator.triangular(-step, 0.0, step, size=DRAWS)
