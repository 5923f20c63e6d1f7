"""Bars of sweeps: the shares of starts by what they come to."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.basin_shares import draw_shares, entries_of, outcomes_in, shares_of
from disc_model.figures.durations import horizon_text
from disc_model.figures.separating_share import (
    draw_interval,
    entries_of_interval,
    interval_of,
    share_of_starts,
)
from disc_model.figures.sweep_choice import Drawn
from disc_model.figures.types import Artist, Axes
from disc_model.figures.words import measured

UNEVEN = 3.0  # ratio of steps between bars beyond which they stand equally far apart
MOST_ENERGIES = 5  # of kicks that an axis names each


def _energies_of(study: xr.Dataset, drawn: Drawn) -> str:
    """With what energies all starts of a share were kicked, in words; "" if the bars tell it."""
    if "energy" not in study.coords or drawn.across == "energy":
        return ""
    energies = [f"{energy:g}" for energy in np.atleast_1d(study["energy"].values)]
    if len(energies) > MOST_ENERGIES:
        energies = [energies[0], "...", energies[-1]]
    return f",\nkicked with {', '.join(energies)} J"


def are_apart(values: Any, across: str) -> bool:
    """Whether bars stand equally far apart, as those of energies, of which one may be 0, of words, and of
    numbers at which true distances would make bars hairlines."""
    if across == "energy" or values.dtype.kind in "UO":
        return True
    steps = np.diff(values)
    return bool(steps.max(initial=0.0) > UNEVEN * steps.min(initial=np.inf))


def draw_bars(ax: Axes, study: xr.Dataset, drawn: Drawn) -> list[Artist]:
    """Draw the shares of starts as bars; returns entries of a legend."""
    shares = shares_of(study, drawn.variable)
    classes = outcomes_in(shares)
    across = measured(study[drawn.across])
    places = across.values
    if are_apart(places, drawn.across):
        places = np.arange(places.size)
    draw_shares(ax, shares, classes, places)
    draw_interval(ax, interval_of(study, drawn.variable), places)
    if places is not across.values:
        texts = [each if isinstance(each, str) else f"{each:g}" for each in across.values]
        ax.set_xticks(places, texts)
    ax.set_xlabel(across.label)
    ax.set_ylabel(share_of_starts(study, drawn.variable) + _energies_of(study, drawn))
    ax.set_xmargin(0.04)
    within = horizon_text(study) or "the horizon"
    handles = entries_of(classes, f"undecided within {within}: raise horizon")
    return handles + entries_of_interval(study, drawn.variable)
