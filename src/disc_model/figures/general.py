"""Heat maps and curves: any variable of a grid study over any of its dimensions."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, LogNorm, Normalize, from_levels_and_colors
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from disc_model.data.variables import EXCLUDED
from disc_model.figures import drawing
from disc_model.figures.cells import CYCLE_LOOKS, edges_of, growth_panels, patches
from disc_model.figures.drawing import BLACK, BLUE, COLUMN, GREEN, GREY, ORANGE, PAGE, PURPLE, SKY, VERMILION, panels
from disc_model.figures.kinds import CurvePlot, General, HeatMap


def _other(found: xr.DataArray, plot: General) -> str | None:
    """The dimension that is on no axis, if there is one."""
    return next((str(name) for name in found.dims if name not in plot.axes.values()), None)


def _scale(name: str, values: np.ndarray) -> str:
    """Scale of an axis: that of the range of its values."""
    steps = np.diff(np.log(values)) if values[0] > 0 else values
    return "log" if len(values) > 2 and values[0] > 0 and np.allclose(steps, steps[0], rtol=1e-6) else "linear"


def _in_steps(colours: Sequence[Any]) -> dict[str, Any]:
    """Colour map and scale for matplotlib: a colour for each of the numbers 0, 1, ..."""
    cmap, norm = from_levels_and_colors((np.arange(len(colours) + 1) - 0.5).tolist(), colours)
    return {"cmap": cmap, "norm": norm}


def _bar(figure: Figure, axes: Sequence[Axes], colours: ScalarMappable, label: str, names: Sequence[str] = ()) -> None:
    """Draw a scale of colours beside panels, with the names of its steps."""
    bar = figure.colorbar(colours, ax=list(axes), pad=0.01, aspect=30, label=label)
    if names:
        bar.set_ticks(range(len(names)), labels=list(names))
        bar.minorticks_off()


# ----------------------------------------------------------------------------------------------------
# Heat maps

WORDS = (BLUE, ORANGE, GREEN, VERMILION, SKY, PURPLE, GREY)
"""Colours of the values of a flag."""
HATCH: dict[str, Any] = {"facecolor": "white", "hatch": "//////", "edgecolor": GREY}
"""Look of missing values."""


def draw_heat_map(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: HeatMap) -> Figure:
    """Draw panels with a common colour scale; missing values are hatched.

    Growth rates have the colours of all growth maps; variables of both signs are centred on 0.
    """
    study = drawing.picked(study, plot.at)
    ruled = EXCLUDED in study["status"].attrs["flag_meanings"]
    left_out = drawing.statuses(study) == EXCLUDED
    found = study[plot.variable].where(~left_out) if ruled else study[plot.variable]
    by = _other(found, plot)
    shown = drawing.slices(found, by)
    figure, axes = panels(PAGE if len(shown) > 1 else COLUMN * 1.2, 2.9, 1, len(shown), sharex=True, sharey=True)
    handles: list[Patch] = []
    if plot.variable == "growth_rate" and not plot.log:
        handles = _growth(figure, axes, study, plot, by)
    else:
        words, colours = drawing.flags_of(found), _colours(found, plot)
        for ax, (_, panel) in zip(axes, shown, strict=True):
            ax.patch.set(linewidth=0, **HATCH)
            mesh = _cells(ax, panel, plot, **colours)
        if ruled:
            for ax, (_, panel) in zip(axes, drawing.slices(left_out, by), strict=False):
                _cells(ax, panel.where(panel), plot, cmap=ListedColormap(["white"]))
            handles += patches(CYCLE_LOOKS, {EXCLUDED})
        _bar(figure, axes, mesh, drawing.label_of(found)[0], words)
        if not words and (gaps := drawing.gaps(study, found)):
            handles.append(Patch(label=", ".join(gaps), **HATCH))
    for axis, name in plot.axes.items():  # axes are shared
        axes[0].set(**{f"{axis}scale": _scale(name, study[name].values)})
    width = round(figure.get_figwidth() / len(axes) / 0.08)
    # a value stays on the line of its name
    names = [
        fill(f"({letter}) " + text.replace(" = ", "\u00a0=\u00a0"), width)
        for letter, (text, _) in zip("abcd", shown, strict=False)
    ]
    for ax, name in zip(axes, names, strict=True):
        ax.set_title(name if len(axes) > 1 else "", loc="left")
        ax.set(xlabel=drawing.label_of(found[plot.x])[0], ylabel=drawing.label_of(found[plot.y])[0])
        ax.label_outer()
    if handles:
        figure.legend(handles=handles, loc="outside lower right", ncols=len(handles))
    return figure


def _growth(figure: Figure, axes: Sequence[Axes], study: xr.Dataset, plot: HeatMap, by: str | None) -> list[Patch]:
    """Draw growth rates, or the status without a cycle, as in all growth maps."""
    names = [name for name in ("growth_rate", "cycle", "status", "sliding_growth_rate") if name in study]
    shown = [one.transpose(plot.y, plot.x) for _, one in drawing.slices(study[names], by)]
    return patches(CYCLE_LOOKS, growth_panels(figure, axes, shown))


def _cells(ax: Axes, panel: xr.DataArray, plot: HeatMap, **colours: Any) -> ScalarMappable:
    """Draw the values of a panel in colour, where there are any."""
    plane = panel.transpose(plot.y, plot.x)
    values = np.ma.masked_invalid(plane.values.astype(float))
    if isinstance(colours.get("norm"), LogNorm):
        values = np.ma.masked_where(values <= 0, values)
    return ax.pcolormesh(*edges_of(plane, _scale), values, rasterized=True, **colours)


def _colours(found: xr.DataArray, plot: HeatMap) -> dict[str, Any]:
    """Colour map and scale for matplotlib."""
    if words := drawing.flags_of(found):
        return _in_steps([WORDS[i % len(WORDS)] for i in range(len(words))])
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


# ----------------------------------------------------------------------------------------------------
# Curves

LINEAR = 0.1
"""Growth rate up to which its scale is linear, 1/s; a greater step leads to another cycle and breaks the line."""
MARKS = "os^Dv<>"
"""Marks of the lines; they are open, so that lines on top of each other show."""


def draw_curve(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: CurvePlot) -> Figure:
    """Draw a line, or one for each value of a second dimension; marks at the axis stand for missing values.

    A second dimension of numbers has a colour scale, one of words or pairs a legend.
    """
    study = drawing.picked(study, plot.at)
    found = study[plot.variable]
    by = _other(found, plot)
    lines = drawing.slices(found, by)
    numbers = found[by] if by in found.coords and found[by].dtype.kind in "fi" else None
    figure, [ax] = panels(COLUMN, 2.9)
    label, factor = drawing.label_of(found[plot.x])
    along = found[plot.x].values * factor
    words = drawing.flags_of(found)
    colours = [cm.batlow(i / len(lines)) for i in range(len(lines))] if by else [BLACK]
    jump = np.inf if plot.log or plot.variable != "growth_rate" else LINEAR
    for colour, (text, line), mark in zip(colours, lines, cycle(MARKS), strict=False):
        name = text if numbers is None else ""
        x, y = drawing.broken(along, line.values, jump)
        ax.plot(
            x, y, mark + "-" * (not words), color=colour, label=name or None,
            markersize=3, markerfacecolor="none", markeredgewidth=0.6, linewidth=0.7,
        )  # fmt: skip
    if plot.limits is not None:
        ax.set_ylim(plot.limits)
    if plot.log:
        ax.set_yscale("log")
    elif plot.variable == "growth_rate":  # peaks of tens occur beside hundredths
        ax.set_yscale("symlog", linthresh=LINEAR)
        ax.yaxis.set_major_formatter("{x:g}")
        ax.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    ax.set_xscale(_scale(plot.x, along))
    ax.margins(0.03)
    ax.set(xlabel=label, ylabel=fill(drawing.label_of(found)[0], 32))
    if words:
        ax.set_yticks(range(len(words)), labels=words)
    for (name, gone), mark in zip(drawing.gaps(study, found).items(), "x+|12", strict=False):
        there = gone.any([dim for dim in gone.dims if dim != plot.x]).values
        drawing.mark_failed(ax, along[there], name=name, mark=mark)
    if numbers is not None:
        label, factor = drawing.label_of(numbers)
        steps = ScalarMappable(**_in_steps(colours))
        _bar(figure, [ax], steps, label, [f"{value * factor:g}" for value in numbers.values])
    if ax.get_legend_handles_labels()[0]:
        # names of more letters do not fit there
        beside = by is not None and numbers is None and max(len(text) for text, _ in lines) < 25
        figure.legend(loc="outside right upper" if beside else "outside lower right", ncols=1 if beside or by else 2)
    return figure
