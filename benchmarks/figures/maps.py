"""Maps of where methods fail, and where they find the first separation."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from benchmarks.figures.looks import SETTINGS, TEXTS, Look, letter, row_panels
from disc_model.figures.looks import BLACK, GREY


def failure_maps(*maps: xr.Dataset) -> Figure:
    """Draw the verdict over setting and number of modes, a panel for each method.

    Lines explain the borders.
    """
    return _map_panels(maps, TEXTS["verdicts"], TEXTS["borders"], row=1.45, more=0.75)


def answer_maps(*maps: xr.Dataset) -> Figure:
    """Draw whether methods find the first separation, over setting and number of modes."""
    return _map_panels(maps, TEXTS["answered"], {}, row=1.35, more=0.4)


def _map_panels(
    maps: Sequence[xr.Dataset],
    verdicts: Mapping[str, tuple[str, str]],
    borders: Mapping[str, str],
    **size: float,
) -> Figure:
    """Draw maps with a legend of what occurs in them.

    Parameters
    ----------
    maps : of the methods
    verdicts : word and shade of each, by name
    borders : what lines of a style mean
    size : heights of a row and of the legend, inches
    """
    figure, axes = row_panels(len(maps), "Real modes", columns=4, **size)
    shades = np.array([to_rgb(shade) for _, shade in verdicts.values()])
    for ax, dataset, text in zip(axes, maps, "abcdefghijklmnop", strict=False):
        _draw_map(ax, dataset.sortby("value"), shades, with_borders=bool(borders))
        title = dataset.attrs["label"]
        if dataset.attrs.get("scene") == "stick_slip":
            title = f"{title}, contact"
        letter(ax, text, title, fontsize=7)

    occurring = {int(number) for dataset in maps for number in np.unique(dataset["verdict"])}
    handles: list[Any] = []
    for number, (word, shade) in enumerate(verdicts.values()):
        if number in occurring:
            handles.append(Patch(facecolor=shade, edgecolor=GREY, label=word))
    for style, word in borders.items():
        look: Look = {"color": BLACK, "linewidth": 1.4, "linestyle": style}
        handles.append(Line2D([], [], label=word, **look))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _draw_map(ax: Axes, dataset: xr.Dataset, shades: np.ndarray, *, with_borders: bool) -> None:
    """Draw the map of a method, with fine settings on the right.

    Parameters
    ----------
    ax : the panel
    dataset : the map, by rising values of the setting
    shades : by the number of a verdict
    with_borders : whether to draw lines that explain where the method fails
    """
    # edges are halfway between values in the logarithm
    values = np.pad(np.log(dataset["value"].values), 1, "reflect", reflect_type="odd")
    edges = np.exp(0.5 * (values[1:] + values[:-1]))
    rows = np.arange(dataset.sizes["diameters"] + 1) - 0.5
    ax.pcolormesh(edges, rows, shades[dataset["verdict"].values])
    ax.set(xscale="log", xlim=(edges[-1], edges[0]))
    ax.set_yticks(rows[:-1] + 0.5, [f"{int(n)}" for n in dataset["modes"].values])
    ax.set_xlabel(SETTINGS[dataset.attrs["setting"]].axis, labelpad=1)
    if not with_borders:
        return
    heights = np.repeat(rows, 2)[1:-1]
    for style, border in _borders(dataset):
        stairs = np.repeat(np.clip(border, edges[0], edges[-1]), 2)
        ax.plot(stairs, heights, color="white", linestyle="-", linewidth=2.4)
        ax.plot(stairs, heights, color=BLACK, linestyle=style, linewidth=1.4)


def _borders(dataset: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """Yield lines that explain where a method fails: their style, and a setting for each row."""
    setting = dataset.attrs["setting"]
    if setting == "step":
        yield "-", dataset["step_limit"].values
        if dataset.attrs["scene"] == "separating":
            yield ":", dataset["shortest_phase"].values
    elif setting == "epsilon":
        yield "--", dataset["stiff_epsilon"].values
    elif np.isfinite(dataset["longest_step"].values).any():
        yield ":", _fine_enough(dataset)


def _fine_enough(dataset: xr.Dataset) -> np.ndarray:
    """Return for each row where steps become longer than the shortest phase.

    It is zero, beyond the axis, where they are longer at all settings.
    """
    values = dataset["value"].values
    borders = np.zeros(dataset.sizes["diameters"])
    shortest = dataset["shortest_phase"].values
    for row, steps in enumerate(dataset["longest_step"].values):
        fine = np.flatnonzero(steps <= shortest[row])
        if fine.size:
            coarsest = values[fine[-1]]
            next_value = values[fine[-1] : fine[-1] + 2][-1]
            borders[row] = math.sqrt(coarsest * next_value)
    return borders
