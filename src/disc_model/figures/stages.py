"""Stages of a run, of which the points of its sections tell: before and after separation or settling.
Nothing here draws.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from disc_model.analysis.classify import first_settled, settling, stages
from disc_model.figures.runs import parameters_of
from disc_model.figures.types import Mask

STAGES = ("early", "later", "separated")
BY_SEPARATION = ("in contact, before the first separation", "in contact, after it", "separated")
SEPARATED_BEFORE = (BY_SEPARATION[0], "in contact, after the first separation", "separated")
BY_SETTLING = ("not shown to have settled", "settled", "separated")
BY_HALVES = ("first half of the run", "second half, not shown to have settled", "separated")
"""Names of the stages, by what divides early from later."""
SECTIONS = ("psi", "w_point")


@dataclass(frozen=True)
class Stages:
    """The stages of a run: masks of its samples, their names, and what the motion does."""

    masks: Mapping[str, Mask]
    names: Sequence[str]
    fate: str


def stages_of(case: xr.DataTree, samples: xr.Dataset) -> Stages:
    """Divide the points of a section by the first separation; without one, by when the motion has
    settled; otherwise into halves of the run."""
    time = samples["time"].values
    first = float(case["first_separation"])
    since = settled_since(case, samples)
    settled = math.isfinite(since)
    divided = stages(time, samples["phase"].values, first, since if settled else time.mean())
    masks = dict(zip(STAGES, divided, strict=True))
    if math.isfinite(first):
        names = BY_SEPARATION if masks["early"].any() else SEPARATED_BEFORE
        return Stages(masks, names, f"first separation at {first:.2f} s")
    p = parameters_of(case)
    fate = "separation ignored" if p.contact == "bilateral" else "no separation"
    return Stages(masks, BY_SETTLING if settled else BY_HALVES, fate)


def settled_since(case: xr.DataTree, samples: xr.Dataset) -> float:
    """Time from which all points of a motion's section lie on its end, s; by a window's ranges
    where it shows none."""
    held = [node.to_dataset() for node in case.children.values()]
    window = next((each for each in held if "w_point_min" in each), None)
    latest = max(_since(samples, window, name) for name in SECTIONS)
    if not math.isfinite(latest):
        return math.nan
    columns = [samples[f"{name}{of}"].values for name in SECTIONS for of in ("", "_velocity")]
    time = samples["time"].values
    start = min(int(np.searchsorted(time, latest)), len(time) - 1)
    return float(time[first_settled(np.column_stack(columns), start)])


def _since(samples: xr.Dataset, window: xr.Dataset | None, name: str) -> float:
    """Time from which a variable has settled, s; infinite if this is not shown."""
    answer = settling(samples["time"], samples[name])
    if math.isnan(answer.since) and window is not None and f"{name}_min" in window:
        bins = window.isel(time=slice(None, -1))  # the last one is cut
        widths = bins[f"{name}_max"] - bins[f"{name}_min"]
        answer = settling(bins["time"], widths, still=1.0)
    return math.inf if math.isnan(answer.since) else float(answer.since)
