"""Heat maps: any variable of a grid study in colour over any two of its dimensions."""

from collections.abc import Mapping, Sequence
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

from disc_model.data.variables import EXCLUDED
from disc_model.figures import parts
from disc_model.figures.grids.cells import CYCLE_LOOKS, growth_panels, patch, patches, scale_of
from disc_model.figures.kinds import HeatMap
from disc_model.figures.parts import BLUE, COLUMN, GREEN, GREY, ORANGE, PAGE, PURPLE, SKY, VERMILION, new_figure

WORDS = (BLUE, ORANGE, GREEN, VERMILION, SKY, PURPLE, GREY)
"""Colours of the values of a flag."""
HATCH = "//////"
"""Hatch of missing values."""


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: HeatMap) -> Figure:
    """Draw panels with a common colour scale; missing values are hatched.

    Growth rates have the colours of all growth maps; variables of both signs are centred on 0.
    """
    found = parts.picked(study, plot.variable, plot.at)
    left_out = parts.excluded(study, plot.at)
    if left_out is not None:
        found = found.where(~left_out)
    by = next((str(name) for name in found.dims if name not in (plot.x, plot.y)), None)
    panels = parts.slices(found, by)
    figure = new_figure(PAGE if len(panels) > 1 else COLUMN * 1.2, 2.9)
    axes = list(figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0])
    handles: list[Patch] = []
    if plot.variable == "growth_rate" and not plot.log:
        handles = _growth(figure, axes, study, plot, by)
    else:
        colours = _colours(found, plot)
        for ax, (_, panel) in zip(axes, panels, strict=True):
            mesh = _panel(ax, panel, plot, colours)
        if left_out is not None:
            for ax, (_, panel) in zip(axes, parts.slices(left_out, by), strict=False):
                _empty(ax, panel, plot)
            handles.append(patch(CYCLE_LOOKS[EXCLUDED]))
        bar = figure.colorbar(mesh, ax=axes, pad=0.01, aspect=30)
        bar.set_label(parts.label_of(found)[0])
        if words := parts.flags_of(found):
            bar.set_ticks(list(range(len(words))), labels=words)
            bar.minorticks_off()
        elif gaps := parts.gaps(study, found, plot.at):
            handles = [*handles, Patch(facecolor="white", hatch=HATCH, edgecolor=GREY, label=", ".join(gaps))]
    _name(figure, axes, [text for text, _ in panels], found, plot)
    if handles:
        figure.legend(handles=handles, loc="outside lower right", ncols=len(handles))
    return figure


def _name(figure: Figure, axes: Sequence[Axes], values: Sequence[str], found: xr.DataArray, plot: HeatMap) -> None:
    """Label the panels with letters and values, and the axes."""
    width = round(figure.get_figwidth() / len(axes) / 0.08)
    for ax, text, letter in zip(axes, values, "abcd", strict=False):
        ax.set_xlabel(parts.label_of(found[plot.x])[0])
        if len(axes) > 1:
            # keep a value on the line of its name
            ax.set_title(fill(f"({letter}) " + text.replace(" = ", "\u00a0=\u00a0"), width), loc="left")
    axes[0].set_ylabel(parts.label_of(found[plot.y])[0])


def _growth(figure: Figure, axes: Sequence[Axes], study: xr.Dataset, plot: HeatMap, by: str | None) -> list[Patch]:
    """Draw growth rates, or the status without a cycle, as in all growth maps."""
    names = [name for name in ("growth_rate", "cycle", "status", "sliding_growth_rate") if name in study]
    picked = {name: parts.slices(parts.picked(study, name, plot.at), by) for name in names}
    panels = [xr.Dataset({name: found[i][1] for name, found in picked.items()}) for i in range(len(axes))]
    words = growth_panels(figure, axes, panels, plot.x, plot.y)
    for axis, name in plot.axes.items():  # axes are shared
        axes[0].set(**{f"{axis}scale": "log" if scale_of(name, study[name].values) == "log" else "linear"})
    return patches(CYCLE_LOOKS, words)


def _empty(ax: Axes, left_out: xr.DataArray, plot: HeatMap) -> None:
    """Draw the cells that the study's rule excludes."""
    x, y = (left_out[name].values * parts.label_of(left_out[name])[1] for name in (plot.x, plot.y))
    cells = left_out.transpose(plot.y, plot.x).values
    white = ListedColormap(["white"])
    ax.pcolormesh(x, y, np.ma.masked_where(~cells, cells), shading="nearest", rasterized=True, cmap=white)


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
    return ax.pcolormesh(sides["x"], sides["y"], values, shading="nearest", rasterized=True, **colours)


def _colours(found: xr.DataArray, plot: HeatMap) -> dict[str, Any]:
    """Colour map and scale for matplotlib."""
    if words := parts.flags_of(found):
        many = [WORDS[i % len(WORDS)] for i in range(len(words))]
        return {"cmap": ListedColormap(many), "norm": BoundaryNorm(np.arange(len(words) + 1) - 0.5, len(words))}
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
