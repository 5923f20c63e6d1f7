"""Which of the paper's separations survive its own Eq. (17), by what the ledger is judged by, as no
other figure."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.variables import flag_names, stated_in
from disc_model.disc.modes import plate_modes
from disc_model.figures.cells import edges_of, paint, patches
from disc_model.figures.classes import Look
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    GREY,
    PAGE,
    SEPARATED,
    halo,
    large,
    letters,
    mark,
    panels,
    say,
)
from disc_model.figures.legends import figure_legend
from disc_model.figures.types import Axes, Figure, Words
from disc_model.figures.words import LOAD, SPEED
from workflow.paper import section2
from workflow.paper.figures.kinds import Scales

SCALES = ("as_published", "orthonormal")
LOOKS: tuple[dict[str, Any], ...] = (
    {"label": "as published", "marker": "o", "color": SEPARATED, "linestyle": "none"},
    {
        "label": "by Eq. (17)",
        "marker": "o",
        "markerfacecolor": "white",
        "color": BLUE,
        "linestyle": "none",
    },
)
CELLS = {
    "neither": Look("with neither", "#ffffff"),
    "published": Look("only as published", "#f2b69c"),
    "orthonormal": Look("only by Eq. (17)", "#d5e5f3", 4 * "\\"),
    "both": Look("with both", "#8a8a8a"),
}
"""With which normalization the static start separates. They differ in grey print."""
RIGHT_OF = ("Fig. 2", "Fig. 7")
"""Marks whose names stand on their right."""


def draw(plot: Scales, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw amplitudes, regions and times."""
    width = plot.inches
    if width == PAGE:
        figure, axes = panels(width, 2.9, 1, 3, width_ratios=(0.8, 1.25, 1.2))
    else:
        figure, axes = panels(width, 8.0, 3)
    amplitudes, regions, times = axes
    points = section2.separating_points({"map_N": study, **overlays})
    on_map = {name: point for name, point in points.items() if _map_of(name) == "map_N"}
    _draw_amplitudes(amplitudes)
    _draw_regions(regions, study, on_map)
    _draw_times(times, points, section2.first_separations(points))
    letters(axes)
    title = "(b) The static start separates"
    handles = patches(CELLS.values())
    figure_legend(figure, handles, loc="outside lower center", title=title)
    return figure


def _map_of(figure: str) -> str:
    """The map that has the case of a figure of the paper."""
    return section2.SEPARATING[figure][0]


def _draw_amplitudes(ax: Axes) -> None:
    """Draw the squared amplitudes of the modes with both normalizations."""
    squares = []
    for scale in SCALES:
        modes = plate_modes(section2.BASE.replace(normalization=scale))
        squares.append(modes["psi"].to_numpy() ** 2)
    for values, look in zip(squares, LOOKS, strict=True):
        ax.plot(range(len(values)), values, markersize=mark(5), **look)
    published, orthonormal = (float(values[1]) for values in squares)
    arrow = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.0, "shrinkA": 4, "shrinkB": 4}
    ax.annotate("", (1, published), (1, orthonormal), arrowprops=arrow)
    middle = float(np.sqrt(published * orthonormal))
    say(ax, f"× {published / orthonormal:.0f}", (1, middle), (5, 0))
    label = r"Amplitude under the slider $\Psi_l^2$ (1/kg)"
    ax.set_yscale("log")
    ax.set_xlabel("Nodal diameters l")
    ax.set_ylabel(label)
    ax.set_xticks(range(5))
    ax.set_ylim((0.7, 110))
    ax.margins(x=0.12)
    ax.legend(loc="upper right", bbox_to_anchor=(1.04, 0.88))


def _draw_regions(ax: Axes, study: xr.Dataset, points: Mapping[str, xr.Dataset]) -> None:
    """Draw with which normalization the static start separates, and the paper's cases, each in the
    colour of its own outcome."""
    outcome = study["outcome"].sel(normalization=[*SCALES]).transpose("normalization", "N", "Omega")
    paint(ax, edges_of(outcome[0]), _separate_with(outcome), CELLS)
    for name, point in points.items():
        place = (float(point["Omega"]), float(point["N"]))
        word = str(_separate_with(point["outcome"].sel(normalization=[*SCALES])))
        ax.plot(
            *place,
            "o",
            markerfacecolor=CELLS[word].face,
            color=BLACK,
            markersize=mark(5),
            clip_on=False,
        )
        side = (5 if name in RIGHT_OF else -5, 0)
        say(ax, name, place, side, fontsize=large(7), path_effects=halo())
    ax.set_xlabel(SPEED)
    ax.set_ylabel(LOAD)


def _separate_with(outcome: xr.DataArray) -> Words:
    """The class, see `CELLS`, of each point of outcomes whose first dimension is `SCALES`."""
    published, orthonormal = flag_names(outcome) == "separation"
    words = np.where(published, "published", "neither")
    words = np.where(orthonormal, "orthonormal", words)
    return np.where(published & orthonormal, "both", words)


def _draw_times(ax: Axes, points: Mapping[str, xr.Dataset], firsts: pd.DataFrame) -> None:
    """Draw the first separation with both normalizations, a row for each figure of the paper; an
    arrow up to the horizon where there is none by Eq. (17)."""
    horizons = {
        name: float(stated_in(point, "options")["horizon"]) for name, point in points.items()
    }
    times = firsts.sort_values("as_published", ascending=False)
    line = {"color": GREY, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
    for height, (name, row) in enumerate(times.iterrows()):
        was, now = (float(row[scale]) for scale in SCALES)
        style = "-"
        end = now
        if np.isnan(now):
            style = "-|>"
            end = max(horizons[str(name)], 1.3 * was)
        arrow = {"arrowstyle": style, **line}
        ax.annotate("", (end, height), (was, height), arrowprops=arrow)
        for time, look in zip((was, now), LOOKS, strict=True):
            ax.plot([time], [height], markersize=mark(5), **look)
        say(
            ax,
            str(name),
            (0, height),
            (-3, 0),
            xycoords=("axes fraction", "data"),
            fontsize=large(7),
        )
    ax.set_xscale("log")
    ax.set_xlabel("First separation (s)")
    ax.set_xlim((25, 1.6 * max(horizons.values())))
    ax.set_yticks([])
    ax.set_ylim((-0.6, len(times) - 0.4))
    ax.set_ylabel(" ")
    lost = int(times["orthonormal"].isna().sum())
    if lost:
        ax.annotate(
            f"arrows: no separation\nby Eq. (17), {lost} of {len(times)}",
            (0.03, 0.04),
            xycoords="axes fraction",
            fontsize=large(7),
        )
