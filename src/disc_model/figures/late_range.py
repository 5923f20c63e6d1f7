"""Late in the motion: range of the slider over the speed, with separation and with it ignored."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.patches import Patch

from disc_model.data.variables import flag_names
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    SKY,
    letters,
    mark,
    row_of_panels,
    sample,
    wide,
)
from disc_model.figures.kinds.motions import LateRange
from disc_model.figures.legends import figure_legend
from disc_model.figures.types import Axes, Figure
from disc_model.figures.words import SPEED

LOAD_COLOURS = (BLACK, BLUE, SKY, GREEN)
"""Of preloads in their order; the first three differ in grey print."""
SMALLEST = 1e-6
"""Thicknesses, least range drawn: a quiet cycle moves the slider by less than a millionth of a metre."""
LARGEST = 10.0  # thicknesses
BEYOND = "0.9"  # grey behind ranges of more than a thickness, for which plate theory is not linear
LINES = {"unilateral": "-", "bilateral": "--"}
OPEN_END = ("growing", "undecided")
"""Outcomes of which a longer time would change the range."""


def draw(plot: LateRange, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a panel for each disc, and in it a line for each preload and contact."""
    ranges = (study["u_max"] - study["u_min"]) / plot.thickness
    outcomes = study["outcome"].copy(data=flag_names(study["outcome"]))
    names = study[plot.by].values
    width = plot.inches
    figure, axes = row_of_panels(width, len(names), 3.0, 2.4, sharex=True, sharey=True)
    for ax, name in zip(axes, names, strict=True):
        chosen = {plot.by: name}
        _draw_panel(ax, ranges.sel(chosen), outcomes.sel(chosen))
        ax.margins(x=0.05)
        ax.set_yscale("log")
        ax.set_ylim((SMALLEST, LARGEST))
        ax.set_xlabel(SPEED)
        ax.set_ylabel("Slider, peak to peak (thicknesses)")
        ax.label_outer()
    letters(axes, [plot.names.get(str(name), str(name)) for name in names])
    _legend(figure, study["N"].values)
    return figure


def _marks() -> dict[str, dict[str, Any]]:
    """Marks of what has become of the motion."""
    plain: dict[str, Any] = {"linestyle": "", "marker": "o", "markersize": mark(3)}
    hollow = {"markerfacecolor": "white"}
    return {
        "separates": plain,
        "growing or undecided": {**plain, "marker": "^", "markersize": mark(5), **hollow},
        "settled in contact": {**plain, **hollow},
    }


def _draw_panel(ax: Axes, ranges: xr.DataArray, outcomes: xr.DataArray) -> None:
    """Draw lines over the speed for each preload and contact, with marks of their outcomes."""
    ax.axhspan(1, 1e3, color=BEYOND, zorder=0)
    speeds = ranges["Omega"].values
    for load, colour in zip(ranges["N"].values, LOAD_COLOURS, strict=False):
        for contact, line in LINES.items():
            chosen = {"N": load, "contact": contact}
            heights = ranges.sel(chosen).values
            words = outcomes.sel(chosen).values
            ax.plot(speeds, heights, line, color=colour, linewidth=wide(1.0))
            separates = words == "separation"
            open_end = np.isin(words, OPEN_END)
            masks = (separates, open_end, ~(separates | open_end))
            for mask, look in zip(masks, _marks().values(), strict=True):
                ax.plot(speeds, np.where(mask, heights, np.nan), color=colour, **look)


def _legend(figure: Figure, loads: np.ndarray) -> None:
    """Name preloads, contacts, marks and the grey band below the panels."""
    handles = [
        sample(color=colour, label=f"{1e-3 * load:g} kN")
        for load, colour in zip(loads, LOAD_COLOURS, strict=False)
    ]
    handles.append(sample(color=GREY, linestyle="-", label="with separation"))
    handles.append(sample(color=GREY, linestyle="--", label="separation ignored"))
    for name, look in _marks().items():
        handles.append(sample(color=GREY, label=name, **look))
    handles.append(Patch(color=BEYOND, label="beyond linear plate theory"))
    figure_legend(figure, handles, loc="outside lower center", columns=4, columnspacing=1.0)
