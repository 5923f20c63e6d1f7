"""Separations in windows of samples, and how figures of the paper show them."""

from collections.abc import Sequence

import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import DISC, SEPARATED, SLIDER, Axes


def after(window: xr.Dataset, start: float) -> xr.Dataset:
    """A window with times in ms after one in s."""
    return window.assign_coords(time=(window["time"] - start) * 1e3)


def separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations in a window of samples, in its times, including those that the window cuts off."""
    time = window["time"].values.tolist()
    return [(time[a], time[b - 1]) for a, b in drawing.stretches(flag_names(window["phase"]) == "separation")]


def complete_separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations that begin and end inside the window."""
    time = window["time"].values
    return [(a, b) for a, b in separations(window) if a > time[0] and b < time[-1]]


def shade(ax: Axes, spans: Sequence[tuple[float, float]]) -> None:
    """Shade separations, with one entry in the legend."""
    for i, span in enumerate(spans):
        ax.axvspan(*span, color=SEPARATED, alpha=0.25, label="_nolegend_" if i else "separation")


def displacements(ax: Axes, part: xr.Dataset, rest: float) -> None:
    """Draw displacements of disc and slider relative to `rest` in m, and a legend."""
    ax.plot(part["time"], (part["w"] - rest) * 1e3, color=DISC, label="disc")
    ax.plot(part["time"], (part["u"] - rest) * 1e3, color=SLIDER, linestyle=(0, (4, 1.5)), label="slider")
    ax.set_ylabel("Displacement (mm)")
