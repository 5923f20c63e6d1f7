"""Stages of a run, of which the points of its sections tell: before and after separation or settling.
Nothing here draws.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from disc_model.analysis.classify import FEWEST, first_settled, settling, stages
from disc_model.figures.stated_case import parameters_of
from disc_model.figures.types import Array, Mask

STAGES = ("early", "later", "separated")
ON_THE_WAY = {"later": "later on the way", "separated": "separated on the way"}
"""Stages of points between the first separation and the motion on which the run ends."""
BY_SEPARATION = ("in contact, before the first separation", "in contact, after it", "separated")
SEPARATED_BEFORE = (BY_SEPARATION[0], "in contact, after the first separation", "separated")
BY_SETTLING = ("not shown to have settled", "settled", "separated")
BY_HALVES = ("up to {:g} s", "after {:g} s, undecided whether settled", "separated")
"""Names of the stages, by what divides early from later; halves have the time between them."""
SECTIONS = ("psi", "w_point")


@dataclass(frozen=True)
class Stages:
    """The stages of a run: masks of its samples, their names, what the motion does, and since when
    it is on the set on which the run ends, s; nan if no point shows the way there."""

    masks: Mapping[str, Mask]
    names: Sequence[str]
    fate: str
    final_since: float = math.nan


def stages_of(case: xr.DataTree, samples: xr.Dataset) -> Stages:
    """Divide the points of a section by the first separation; without one, by when the motion has
    settled; otherwise into halves of the time that the points cover."""
    time = samples["time"].values
    first = float(case["first_separation"])
    since = settled_since(case, samples)
    settled = math.isfinite(since)
    middle = round(float(time[0] + time[-1]) / 2, 1)
    divided = stages(time, samples["phase"].values, first, since if settled else middle)
    masks = dict(zip(STAGES, divided, strict=True))
    if math.isfinite(first):
        names = BY_SEPARATION if masks["early"].any() else SEPARATED_BEFORE
        final = _final_since(samples, first)
        for stage, of_the_way in ON_THE_WAY.items():
            masks[of_the_way] = masks[stage] & (time < final)
            masks[stage] = masks[stage] & ~(time < final)
        return Stages(masks, names, f"first separation at {first:.2f} s", final)
    p = parameters_of(case)
    fate = "separation ignored" if p.contact == "bilateral" else "no separation"
    by_halves = [name.format(middle) for name in BY_HALVES]
    return Stages(masks, BY_SETTLING if settled else by_halves, fate)


def settled_since(case: xr.DataTree, samples: xr.Dataset) -> float:
    """Time from which all points of a motion's section lie on its end, s; by a window's ranges
    where it shows none."""
    held = [node.to_dataset() for node in case.children.values()]
    window = next((each for each in held if "w_point_min" in each), None)
    latest = max(_since(samples, window, name) for name in SECTIONS)
    if not math.isfinite(latest):
        return math.nan
    time = samples["time"].values
    start = min(int(np.searchsorted(time, latest)), len(time) - 1)
    return float(time[first_settled(_points(samples), start)])


def _final_since(samples: xr.Dataset, first_separation: float) -> float:
    """Time from which all points of a section lie on the set of the later half of those after the
    first separation, s.

    It is nan if the first of them does, if there are few, or if the last quarter does not cover the
    set of the later half: then a point beside it may be one of the final motion.
    """
    time = samples["time"].values
    after = time >= first_separation
    if after.sum() < FEWEST:
        return math.nan
    points = _points(samples)[after]
    half = len(points) // 2
    is_covered = first_settled(points, half) == half
    index = first_settled(points)
    if not index or not is_covered:
        return math.nan
    return float(time[after][index])


def _points(samples: xr.Dataset) -> Array:
    """Points of both sections together, shape (samples, 4)."""
    columns = [samples[f"{name}{of}"].values for name in SECTIONS for of in ("", "_velocity")]
    return np.column_stack(columns)


def _since(samples: xr.Dataset, window: xr.Dataset | None, name: str) -> float:
    """Time from which a variable has settled, s; infinite if this is not shown."""
    answer = settling(samples["time"], samples[name])
    if math.isnan(answer.since) and window is not None and f"{name}_min" in window:
        bins = window.isel(time=slice(None, -1))  # the last one is cut
        widths = bins[f"{name}_max"] - bins[f"{name}_min"]
        answer = settling(bins["time"], widths, still=1.0)
    return math.inf if math.isnan(answer.since) else float(answer.since)
