"""Heat maps: any variable of a grid study in colour over any two of its dimensions."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from disc_model.figures import parts
from disc_model.figures.grids.kinds import HeatMap
from disc_model.figures.grids.stability_map import HATCH, growth_bar, growth_norm
from disc_model.figures.parts import BLUE, COLUMN, GREEN, GREY, ORANGE, PAGE, PURPLE, SKY, VERMILION, new_figure, styled

WORDS = (BLUE, ORANGE, GREEN, VERMILION, SKY, PURPLE, GREY)
"""Colours of the values of a flag."""


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: HeatMap) -> Figure:
    """Panels of one scale of colours; hatched where there is no value.

    Growth rates have the colours of all growth maps; what has both signs is centred on 0.
    """
    found = parts.picked(study, plot.variable, plot.at)
    by = next((str(name) for name in found.dims if name not in (plot.x, plot.y)), None)
    panels = parts.slices(found, by)
    figure = new_figure(PAGE if len(panels) > 1 else COLUMN * 1.2, 2.9)
    axes = list(figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0])
    colours = _colours(found, plot)
    width = round(figure.get_figwidth() / len(panels) / 0.08)
    for ax, (said, panel) in zip(axes, panels, strict=True):
        mesh = _panel(ax, panel, plot, colours)
        if by is not None:
            # a value stays with its name
            ax.set_title(fill(said.replace(" = ", "\u00a0=\u00a0"), width), loc="left")
    axes[0].set_ylabel(parts.label_of(found[plot.y])[0])
    _bar(figure, mesh, axes, found, plot)
    if "flag_meanings" not in found.attrs and bool(found.isnull().any()):
        said = "no such cycle" if plot.variable == "growth_rate" else "no value"
        gap = Patch(facecolor="white", hatch=HATCH, edgecolor=GREY, label=said)
        figure.legend(handles=[gap], loc="outside lower right")
    parts.head(figure, study, plot.title)
    return figure


def _panel(ax: Axes, panel: xr.DataArray, plot: HeatMap, colours: Mapping[str, Any]) -> QuadMesh:
    values = np.ma.masked_invalid(panel.transpose(plot.y, plot.x).values.astype(float))
    if isinstance(colours["norm"], LogNorm):
        values = np.ma.masked_where(values <= 0, values)
    sides = {}
    for axis, name in plot.axes.items():
        sides[axis] = panel[name].values * parts.label_of(panel[name])[1]
        if parts.spaced_by_factor(sides[axis]):  # cells at its ends may reach beyond 0
            ax.set(**{f"{axis}scale": "log", f"{axis}lim": (sides[axis][0], sides[axis][-1])})
    ax.patch.set(facecolor="white", hatch=HATCH, edgecolor=GREY, linewidth=0)
    mesh = ax.pcolormesh(sides["x"], sides["y"], values, shading="nearest", rasterized=True, **colours)
    ax.set_xlabel(parts.label_of(panel[plot.x])[0])
    return mesh


def _colours(found: xr.DataArray, plot: HeatMap) -> dict[str, Any]:
    """Colours and their scale."""
    if words := found.attrs.get("flag_meanings", "").split():
        many = [WORDS[i % len(WORDS)] for i in range(len(words))]
        return {"cmap": ListedColormap(many), "norm": BoundaryNorm(np.arange(len(words) + 1) - 0.5, len(words))}
    if plot.variable == "growth_rate" and not plot.log:
        return {"cmap": cm.vik, "norm": growth_norm()}
    values = found.values[np.isfinite(found.values)]
    if plot.log:
        above = values[values > 0]
        low, high = (above.min(), above.max()) if above.size else (1.0, 10.0)
        return {"cmap": cm.batlow, "norm": LogNorm(low, high if high > low else 10 * low)}
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low < 0 < high:
        most = max(-low, high)
        return {"cmap": cm.vik, "norm": Normalize(-most, most)}
    return {"cmap": cm.batlow, "norm": Normalize(low, high)}


def _bar(figure: Figure, mesh: QuadMesh, axes: list[Axes], found: xr.DataArray, plot: HeatMap) -> None:
    if plot.variable == "growth_rate" and not plot.log:
        growth_bar(figure, mesh, axes)
        return
    bar = figure.colorbar(mesh, ax=axes, pad=0.01, aspect=30)
    bar.set_label(parts.label_of(found)[0])
    if words := found.attrs.get("flag_meanings", "").split():
        bar.set_ticks(list(range(len(words))), labels=[word.replace("_", " ") for word in words])
        bar.minorticks_off()
