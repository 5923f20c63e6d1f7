"""How probable instability and separation are at uncertain parameters, and which of these decide it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from disc_model.data.variables import SAMPLE, SHOWN, symbol_of, typeset
from disc_model.figures import parts
from disc_model.figures.kinds import Sensitivity
from disc_model.figures.parts import BLACK, BLUE, GREY, PAGE, SEPARATED, SKY, new_figure

OUTPUTS = {"instability": "Instability, index", "growth_rate": "Growth rate, index"}
PROBABILITIES = {
    "probability_unstable": ("unstable", BLUE, "o"),
    "probability_separation": ("separation", SEPARATED, "s"),
}
INDICES = {"first": ("first-order index", SKY, "#d5d5d5"), "total": ("total index", BLUE, GREY)}
"""By kind: what it is called, its colour, and that of one of which nothing is known."""
LETTERS = "bcdefghi"
"""Of the panels of indices; the probabilities are (a)."""
SPAN = (-0.25, 1.3)
"""Indices that are shown; true ones lie from 0 to 1."""
WIDEST = 1.0
"""Width of an interval beyond which nothing is known of an index."""


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Sensitivity) -> Figure:
    """(a) probabilities with 95 % intervals; beside it indices with theirs, a column a point and a row an output.

    Indices of which nothing is known are grey. Arrows show where an interval goes on beyond the panel, and numbers the
    indices that lie there.
    """
    cells = list(cells_of(study))
    figure = new_figure(PAGE, 5.1)
    grid = figure.add_gridspec(len(OUTPUTS), 1 + len(cells), width_ratios=[0.8, *[1] * len(cells)])
    first = figure.add_subplot(grid[:, 0])
    _probabilities(first, cells)
    for column, (title, cell) in enumerate(cells):
        for row, output in enumerate(OUTPUTS):
            ax = figure.add_subplot(grid[row, 1 + column])
            _bars(ax, cell.sel(output=output), labelled=column == 0)
            parts.letter(ax, LETTERS[row * len(cells) + column], "" if row else title)
            ax.set_xlabel(_said(cell, output))
    handles = first.get_legend_handles_labels()[0]
    handles += [Patch(color=color, label=label) for label, color, _ in INDICES.values()]
    handles.append(Patch(color=GREY, label=f"of either, interval wider than {WIDEST:g}"))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), columnspacing=1.4)
    title = plot.title or study.attrs.get("title", "")
    parts.head(figure, study, f"{title}: {spreads(json.loads(study.attrs['options'])['distributions'])}")
    return figure


def spreads(distributions: Mapping[str, Mapping[str, Any]]) -> str:
    """How parameters are distributed, those alike together."""
    alike: dict[str, list[str]] = {}
    for name, how in distributions.items():
        alike.setdefault(_spread(name, how), []).append(symbol(name))
    return "; ".join(f"{', '.join(names)} {said}" for said, names in alike.items())


def _spread(name: str, how: Mapping[str, Any]) -> str:
    """How one is, in words."""
    if how["distribution"] == "uniform" and how["relative"] and np.isclose(how["low"] + how["high"], 2):
        return f"± {50 * (how['high'] - how['low']):g} %"
    unit, factor = ("times its value", 1.0) if how["relative"] else SHOWN[name][2:]
    said = {part: f"{how[part] * factor:g}" for part in ("low", "high", "mean", "deviation") if part in how}
    texts = [f"{said['low']} to {said['high']} {unit}"] if "low" in said else []
    texts += [f"normal, {said['mean']} ± {said['deviation']} {unit}"] if "mean" in said else []
    return ", ".join(text.rstrip() for text in texts)


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
    return OUTPUTS[output] + (f"\n({left_out:.0%} of samples: no cycle)" if left_out > 0 else "")


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
    letters = [", ".join(LETTERS[row * len(cells) + i] for row in range(len(OUTPUTS))) for i in range(len(cells))]
    ax.set_xticks(range(len(cells)), labels=[f"({each})" for each in letters])
    ax.minorticks_off()
    ax.set(ylabel="Probability", ylim=(-0.03, 1.03), xlim=(-0.5, len(cells) - 0.5))
    parts.letter(ax, "a")


def _bars(ax: Axes, cell: xr.Dataset, labelled: bool) -> None:
    """First-order and total indices, a pair of bars for each parameter."""
    names = [str(name) for name in cell["parameter"].values]
    place = np.arange(len(names))
    for i, (kind, (_, color, unknown)) in enumerate(INDICES.items()):
        value, low, high = (cell[f"{kind}_index{end}"].values for end in ("", "_low", "_high"))
        at = place + 0.36 * (i - 0.5)
        ax.barh(at, np.nan_to_num(value), 0.34, color=np.where(high - low > WIDEST, unknown, color))
        ax.hlines(at, low, high, color=BLACK, linewidth=0.7)
        for marker, edge, beyond in (("<", SPAN[0], low < SPAN[0]), (">", SPAN[1], high > SPAN[1])):
            ax.scatter(np.full(beyond.sum(), edge), at[beyond], 6, BLACK, marker=marker, linewidth=0, clip_on=False)
        for where, index in zip(at, value, strict=True):
            if not SPAN[0] <= np.nan_to_num(index) <= SPAN[1]:
                edge, aside = (SPAN[1], 3) if index > 0 else (SPAN[0], -3)
                said = f"{index:.1f}".replace("-", "−")
                parts.say(ax, said, (edge, where), (aside, 0), fontsize=6, annotation_clip=False)
    ax.axvline(0, color=BLACK, linewidth=0.5)
    ax.set_yticks(place, labels=[symbol(name) for name in names] if labelled else [""] * len(names))
    ax.minorticks_off()
    ax.patch.set_visible(False)  # it would cover the numbers beside the panel to its left
    ax.set(ylim=(len(names) - 0.4, -0.6), xlim=SPAN)


def symbol(name: str) -> str:
    """A parameter's symbol."""
    return typeset(symbol_of(name)) if name in SHOWN else name.replace("_", " ")
