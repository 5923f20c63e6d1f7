"""Root loci: eigenvalues of steady sliding, coloured along a parameter."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm

from disc_model.figures.drawing import (
    BLACK,
    GREY,
    halo,
    large,
    letters,
    mark,
    row_of_panels,
    sample,
    wide,
)
from disc_model.figures.kinds.motions import RootLocus
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.names import Names, named_modes
from disc_model.figures.selection import without_single
from disc_model.figures.types import Axes, Figure
from disc_model.figures.words import measured

MOST_RIMS = 40  # marks of a mode up to which each has a rim; those of more would hide their colours
RING: dict[str, Any] = {"marker": "o", "linestyle": "", "color": BLACK, "markerfacecolor": "white"}
"""Look of marks where modes begin."""
HEIGHTS = (0, 2, -2, 5, -5)  # points, of names above or below their rings, best first
NAMES_APART = 0.01  # of the highest frequency, least distance of names
CHARACTER = 0.0136  # of the extent of growth rates, width of a character of a name


def draw(plot: RootLocus, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw the plane of growth rate and frequency, for each value of the compared dimension."""
    parts = parts_shown(study, plot.by, plot.names)
    width = plot.inches
    figure, axes = row_of_panels(width, len(parts), 4.8, 3.4, sharex=True, sharey=True)
    for ax, part in zip(axes, parts, strict=True):
        points = _draw_panel(ax, without_single(part.data, "value", "mode"))
        ax.label_outer()
    letters(axes, titles_of_panels(parts, study, plot.by))
    shown = measured(parts[0].data["value"])
    figure.colorbar(points, ax=axes, label=shown.label, pad=0.01, aspect=30)
    figure_legend(figure, [sample(label=f"at {shown.values[0]:g}, the first value", **RING)])
    return figure


def _draw_panel(ax: Axes, study: xr.Dataset) -> Any:
    """Draw points, with a ring where a mode begins, and its name, rather on the side from which it
    leads away."""
    along = measured(study["value"]).values
    rim = wide(0.3) if len(along) <= MOST_RIMS else 0.0
    for _, mode in study.groupby("mode"):
        rate = mode["mode_growth_rate"].values
        frequency = mode["frequency"].values
        points = ax.scatter(
            rate,
            frequency,
            c=along,
            s=mark(14),
            linewidth=rim,
            edgecolor=GREY,
            clip_on=False,
            zorder=2,
            cmap=cm.batlow,
            vmin=along[0],
            vmax=along[-1],
        )

    first = study.isel(value=0)
    rates = first["mode_growth_rate"].values
    heights = first["frequency"].values
    ax.plot(rates, heights, markersize=mark(4), **RING)
    _name_modes(ax, study)
    ax.axvline(0, color=BLACK, linewidth=wide(0.6))
    ax.margins(x=0.04)
    ax.set_xlabel("Growth rate (1/s)")
    ax.set_ylabel("Frequency in the slider's frame (Hz)")
    return points


def _name_modes(ax: Axes, study: xr.Dataset) -> None:
    """Write the names of modes where they cover no mark: beside their rings, or else their ends."""
    first = study.isel(value=0)
    heights = first["frequency"].values
    apart = NAMES_APART * float(study["frequency"].max())
    every = study["mode_growth_rate"]
    marks = [every.values.ravel(), study["frequency"].transpose(*every.dims).values.ravel()]
    names = Names(ax, lines=np.column_stack(marks))
    for part in named_modes(first["diameters"].values, heights, apart):
        side, rate = _side_of_name(study, part.modes, len(part.name))
        ring = (rate, float(heights[part.modes].mean()))
        places = [ring, *_ends(study.isel(mode=part.modes))]
        offsets = [(4 * across, up) for up in HEIGHTS for across in (side, -side)]
        offsets += [(0, 5), (0, -5)]
        names.add_along(part.name, places, offsets, fontsize=large(7), path_effects=halo())


def _ends(modes: xr.Dataset) -> list[tuple[float, float]]:
    """The points of some modes of the least and the greatest growth rate."""
    rates = modes["mode_growth_rate"].values.ravel()
    heights = modes["frequency"].transpose(*modes["mode_growth_rate"].dims).values.ravel()
    found = [np.nanargmin(rates), np.nanargmax(rates)]
    return [(float(rates[i]), float(heights[i])) for i in found]


def _side_of_name(study: xr.Dataset, modes: np.ndarray, length: int) -> tuple[int, float]:
    """The side of the rings of some modes on which their name stands, -1 for the left, and the
    growth rate beside which it does."""
    every = study["mode_growth_rate"]
    rates = every.isel(value=0).values
    ahead = every.isel(value=slice(2)).isel(value=-1).values - rates
    if ahead[modes].mean() > 0:
        return -1, float(rates[modes].min())
    ring = float(rates[modes].max())
    width = CHARACTER * float(every.max() - every.min()) * length
    if -width < ring < 0:  # the name would cross the line of zero growth
        return -1, float(every.isel(mode=modes).min())
    return 1, ring
