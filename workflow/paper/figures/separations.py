"""Separations in windows of samples, and displacements around them."""

from collections.abc import Sequence

import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.drawing import DISC, SEPARATED, SLIDER
from disc_model.figures.selection import stretches
from disc_model.figures.types import Axes

Span = tuple[float, float]


def after(window: xr.Dataset, start: float) -> xr.Dataset:
    """A window with times in ms after one in s."""
    return window.assign_coords(time=(window["time"] - start) * 1e3)


def separations(window: xr.Dataset) -> list[Span]:
    """Separations in a window of samples, in its times, including those that the window cuts
    off."""
    time = window["time"].values.tolist()
    apart = flag_names(window["phase"]) == "separation"
    return [(time[first], time[after - 1]) for first, after in stretches(apart)]


def first_complete(window: xr.Dataset) -> Span | None:
    """The first separation that begins and ends inside the window."""
    first, last = window["time"].values[[0, -1]]
    complete = [span for span in separations(window) if span[0] > first and span[1] < last]
    return next(iter(complete), None)


def shade(ax: Axes, spans: Sequence[Span]) -> None:
    """Shade separations, with one entry of a legend."""
    label = "separation"
    for span in spans:
        ax.axvspan(*span, color=SEPARATED, alpha=0.25, label=label)
        label = "_nolegend_"


def displacements(ax: Axes, part: xr.Dataset, rest: float) -> None:
    """Draw displacements of disc and slider relative to `rest`, m."""
    time = part["time"]
    dashes = (0, (4, 1.5))
    ax.plot(time, (part["w"] - rest) * 1e3, color=DISC, label="disc")
    ax.plot(time, (part["u"] - rest) * 1e3, color=SLIDER, linestyle=dashes, label="slider")
    ax.set_ylabel("Displacement (mm)")
