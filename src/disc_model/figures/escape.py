"""Share of starts that have separated, against time."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.transforms import ScaledTranslation

from disc_model.analysis.classify import share
from disc_model.data.variables import stated_in
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    VERMILION,
    large,
    mark,
    panels,
    sample,
    say_beside,
    wide,
)
from disc_model.figures.kinds.motions import EscapeShares
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import failed
from disc_model.figures.types import Array, Artist, Axes, Figure
from disc_model.figures.value_texts import named_value

APART = 4.0  # points, distance of the middles of intervals
COLOURS = (VERMILION, BLUE, BLACK, GREEN, PURPLE)
STYLES: tuple[Any, ...] = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)))
"""Of lines in their order, as some of their colours are alike in grey print."""


def draw(plot: EscapeShares, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a line for each value, and the Wilson interval of its share at the horizon."""
    study = study.squeeze([dim for dim in study.dims if dim not in plot.dims])
    horizon = float(stated_in(study, "options")["horizon"])
    figure, [ax] = panels(plot.inches, 3.0)
    handles: list[Artist] = []
    for place, value in enumerate(study[plot.by].values):
        row = study.sel({plot.by: value})
        times = row["first_separation"].values[~failed(row).values]
        line = _draw_share(ax, times, horizon, COLOURS[place % len(COLOURS)], place)
        line.set_linestyle(STYLES[place % len(STYLES)])
        line.set_label(named_value(row, plot.by))
        handles.append(line)
    ax.set_xlabel("Time (s)")
    ax.set_ylabel("Share of starts that have separated")
    ax.set_xlim(0, horizon)
    ax.set_ylim(-0.03, 1.03)
    handles.append(sample(label="95 % interval of the share", **_interval_look(GREY)))
    figure_legend(figure, handles, loc="outside lower center", columns=2)
    return figure


def _draw_share(ax: Axes, times: Array, horizon: float, colour: str, place: int) -> Line2D:
    """Draw how the share of starts that have separated grows, and their number and its confidence
    at the horizon.

    Parameters
    ----------
    ax : the panel
    times : of first separations, s; nan where a start has none
    horizon : s
    colour : of the line
    place : of the line among all, from 0 on: intervals stand beside each other
    """
    separated = np.sort(times[np.isfinite(times)])
    shares = np.arange(separated.size + 1) / times.size
    steps = [0.0, *separated, horizon]
    (line,) = ax.step(steps, [*shares, shares[-1]], where="post", color=colour, linewidth=wide(1.2))
    _, low, high = share(separated.size, times.size)
    figure: Any = ax.get_figure(root=True)
    aside = ScaledTranslation(-place * mark(APART) / 72, 0, figure.dpi_scale_trans)
    look = _interval_look(colour)
    ax.plot([horizon] * 2, [low, high], clip_on=False, transform=ax.transData + aside, **look)
    counted = f"{separated.size} of {times.size}"
    say_beside(ax, float(shares[-1]), counted, 4, color=colour, fontsize=large(7))
    return line


def _interval_look(colour: str) -> dict[str, Any]:
    """Look of the interval of a share, which ends at its ends."""
    return {"color": colour, "linewidth": wide(3), "alpha": 0.5, "solid_capstyle": "butt"}
