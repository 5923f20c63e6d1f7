"""How probable instability and separation are at uncertain parameters, and which of these decide it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data.variables import SAMPLE
from disc_model.figures import parts
from disc_model.figures.grids.kinds import Sensitivity
from disc_model.figures.parts import BLACK, BLUE, PAGE, SEPARATED, SKY, new_figure, styled

OUTPUTS = {"instability": "Instability, index", "growth_rate": "Growth rate, index"}
PROBABILITIES = {
    "probability_unstable": ("unstable", BLUE, "o"),
    "probability_separation": ("separation", SEPARATED, "s"),
}


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Sensitivity) -> Figure:
    """(a) probabilities with 95 % intervals; beside it indices with theirs, a column a point and a row an output."""
    cells = list(cells_of(study))
    figure = new_figure(PAGE, 4.6)
    grid = figure.add_gridspec(len(OUTPUTS), 1 + len(cells), width_ratios=[0.8, *[1] * len(cells)])
    first = figure.add_subplot(grid[:, 0])
    _probabilities(first, cells)
    for column, (title, cell) in enumerate(cells):
        for row, output in enumerate(OUTPUTS):
            ax = figure.add_subplot(grid[row, 1 + column])
            _bars(ax, cell.sel(output=output), labelled=column == 0)
            ax.set_title(f"({chr(ord('b') + column)}) {title}" if row == 0 else "", loc="left")
            ax.set_xlabel(_said(cell, output))
    handles = [*first.get_legend_handles_labels()[0], *ax.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    if plot.title:
        figure.suptitle(plot.title, fontsize=8)
    return figure


def cells_of(study: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Each point of the grid beside the samples: what it is called, and its values."""
    dims = [str(dim) for dim in study["status"].dims if dim != SAMPLE]
    for place in product(*(range(study.sizes[dim]) for dim in dims)):
        cell = study.isel(dict(zip(dims, place, strict=True)))
        names = [str(name) for name in study.coords if study[name].dims and set(study[name].dims) <= set(dims)]
        yield "\n".join(parts.value_said(cell[name], name) for name in names), cell


def _said(cell: xr.Dataset, output: str) -> str:
    """The axis of the indices, and what they leave out."""
    left_out = float(cell["left_out"].sel(output=output))
    return OUTPUTS[output] + (f"\n({left_out:.0%} of the samples: no cycle)" if left_out > 0 else "")


def _probabilities(ax: Axes, cells: list[tuple[str, xr.Dataset]]) -> None:
    for i, (name, (label, color, marker)) in enumerate(PROBABILITIES.items()):
        value, low, high = (
            np.array([float(cell[f"{name}{end}"]) for _, cell in cells]) for end in ("", "_low", "_high")
        )
        known = np.isfinite(value)
        place = np.arange(len(cells))[known] + 0.2 * (i - 0.5)
        spans = np.maximum([(value - low)[known], (high - value)[known]], 0)  # an end may be the value, to rounding
        style: dict[str, Any] = {"color": color, "marker": marker, "markersize": 4, "linestyle": "", "capsize": 2}
        ax.errorbar(place, value[known], spans, label=label, linewidth=1, **style)
    letters = [f"({chr(ord('b') + i)})" for i in range(len(cells))]
    ax.set_xticks(range(len(cells)), labels=letters)
    ax.minorticks_off()
    ax.set(ylabel="Probability", ylim=(-0.03, 1.03), xlim=(-0.5, len(cells) - 0.5))
    ax.set_title("(a)", loc="left")


def _bars(ax: Axes, cell: xr.Dataset, labelled: bool) -> None:
    """First-order and total indices, a pair of bars for each parameter."""
    names = [str(name) for name in cell["parameter"].values]
    place = np.arange(len(names))
    for i, (kind, color, label) in enumerate((("first", SKY, "first-order index"), ("total", BLUE, "total index"))):
        value, low, high = (cell[f"{kind}_index{end}"].values for end in ("", "_low", "_high"))
        at = place + 0.36 * (i - 0.5)
        ax.barh(at, np.nan_to_num(value), 0.34, color=color, label=label)
        ax.hlines(at, low, high, color=BLACK, linewidth=0.7)
    ax.axvline(0, color=BLACK, linewidth=0.5)
    ax.set_yticks(place, labels=[symbol(name) for name in names] if labelled else [""] * len(names))
    ax.minorticks_off()
    ax.set(ylim=(len(names) - 0.4, -0.6), xlim=(-0.25, 1.3))


def symbol(name: str) -> str:
    """A parameter's symbol."""
    return parts.SYMBOLS[name][0].split()[-1] if name in parts.SYMBOLS else name.replace("_", " ")
