"""Heat maps: any variable in colour over two dimensions."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from disc_model.data.variables import EXCLUDED, TRUTH
from disc_model.figures.cells import (
    MARKED,
    class_cells,
    edges_of,
    entries,
    lay_over,
    looks_in,
    paint,
    scale_of,
)
from disc_model.figures.classes import (
    AT_BOUND,
    LOOKS,
    NOT_CONVERGED,
    NOT_NEAR,
    UNRESOLVED,
    UNSETTLED,
)
from disc_model.figures.colours import USUAL, ColourWishes, colours_of, draw_bar, is_growth
from disc_model.figures.drawing import COLUMN, letter, panels, plain_decades, set_label
from disc_model.figures.growth import growth_panels
from disc_model.figures.kinds.general import General, HeatMap
from disc_model.figures.legends import Key, figure_legend
from disc_model.figures.selection import (
    WITHOUT_CYCLE,
    Part,
    at_lower_bound,
    classes_of_gaps,
    doubts,
    has_values,
    parts_along,
    picked,
    remaining,
    shown_words,
    statuses,
    statuses_like,
    titles_of,
)
from disc_model.figures.types import Artist, Axes, Figure, FigureBase
from disc_model.figures.words import NO_VALUE, label_in, label_of, measured, missing_text

IN_A_ROW = 4  # panels on a page
OF_CYCLES = "stable"  # False, and no answer, where there is no cycle


def draw(plot: HeatMap, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a panel for each value of a third dimension, on one scale of colours."""
    parts = parts_of(plot, study)
    width = plot.inches_of(len(parts))
    columns = 1
    if width != COLUMN:
        lines = math.ceil(len(parts) / IN_A_ROW)
        columns = math.ceil(len(parts) / lines)
    rows = math.ceil(len(parts) / columns)
    figure, axes = panels(width, 2.9 * rows, rows, columns, sharex=True, sharey=True)
    for ax in axes[len(parts) :]:
        ax.remove()
    axes = axes[: len(parts)]
    planes = [part.data.transpose(plot.y, plot.x, ...) for part in parts]
    wishes = ColourWishes(log=plot.log, limits=plot.limits)
    key = draw_maps(figure, axes, planes, plot.variable, wishes)

    titles = titles_of(parts)
    if len(axes) > 1:
        for ax, name, title in zip(axes, "abcdef", titles, strict=False):
            unbroken = title.replace(" = ", "\u00a0=\u00a0")  # a value stays beside its name
            letter(ax, name, unbroken)
    for ax in axes:
        ax.label_outer()
    for ax in axes[-columns:]:  # below some of them there is none
        ax.set_xlabel(axes[-1].get_xlabel())
        ax.tick_params(labelbottom=True)
    figure_legend(figure, key.handles, title=key.title)
    return figure


def parts_of(plot: General, study: xr.Dataset) -> list[Part[xr.Dataset]]:
    """The parts of a study in the panels of a general figure."""
    chosen = picked(study, plot.at)
    by = remaining(chosen[plot.variable], [*plot.axes.values()])
    return parts_along(chosen, by, plot.names)


# ---- A variable in colour


def draw_maps(
    figure: FigureBase,
    axes: Sequence[Axes],
    planes: Sequence[xr.Dataset],
    variable: str,
    wishes: ColourWishes = USUAL,
) -> Key:
    """Draw a variable of each plane, of dimensions (up, across), in colour on a panel; returns what
    a legend says, which names the variable if no bar does. Classes have colours of their own, so
    that `ParameterError` is raised where others are asked for."""
    arrays = [as_classes(plane, variable) for plane in planes]
    first = arrays[0]
    if first.dtype.kind in "UO" or "flag_meanings" in first.attrs:
        wishes.refuse()
        handles = class_panels(axes, arrays, [statuses(plane) for plane in planes])
        has_bar = False
    else:
        draw_numbers = growth_panels if is_growth(variable) else number_panels
        handles = draw_numbers(figure, axes, planes, variable, wishes)
        has_bar = has_values(planes, variable)
    title = "" if has_bar else label_in(planes[0], variable)
    up, across = (first[str(name)] for name in first.dims)
    axes[0].set_xscale(scale(across))
    axes[0].set_yscale(scale(up))
    for axis in (axes[0].xaxis, axes[0].yaxis):
        if axis.get_scale() == "log":
            plain_decades(axis)
    for ax in axes:
        set_label(ax, "x", across)
        set_label(ax, "y", up)
    return Key(handles, title)


def as_classes(study: xr.Dataset, variable: str) -> xr.DataArray:
    """The variable, with the words "no" and "yes" for False and True, and "" where there is
    neither, or no cycle that could be stable."""
    array = study[variable]
    of_truth = array.attrs.get("comment") == TRUTH["comment"]
    if array.dtype.kind != "b" and not of_truth:
        return array
    words = np.where(array.values == 1, "yes", "no")
    words = np.where(array.isnull(), "", words)
    if variable == OF_CYCLES:
        words = np.where(np.isin(statuses_like(study, array), WITHOUT_CYCLE), "", words)
    return array.copy(data=words)


def scale(coordinate: xr.DataArray) -> str:
    """Scale of an axis, as in maps of regions, but linear from 0 on and along words."""
    if coordinate.dtype.kind in "UO":
        return "linear"
    known = scale_of(str(coordinate.name), coordinate.values)
    return "linear" if known == "symlog" else known


def class_panels(
    axes: Sequence[Axes], panels: Sequence[xr.DataArray], conditions: Sequence[xr.DataArray]
) -> list[Artist]:
    """Draw a flag in the colours and patterns of its classes, but what a study's rule leaves out;
    returns entries of a legend."""
    shown = []
    for panel, status in zip(panels, conditions, strict=True):
        shown.append(shown_words(panel, status))
    looks = {**looks_in(panels[0]), EXCLUDED: LOOKS[EXCLUDED]}
    if panels[0].dtype.kind in "UO":
        looks = {**looks_in(shown[0]), **looks}
        looks.pop("", None)
    used: set[str] = set()
    for ax, panel in zip(axes, shown, strict=True):
        used |= class_cells(ax, panel, looks)
    return entries(used, {**looks, UNRESOLVED.label: UNRESOLVED})


def number_panels(
    figure: FigureBase,
    axes: Sequence[Axes],
    planes: Sequence[xr.Dataset],
    variable: str,
    wishes: ColourWishes = USUAL,
) -> list[Artist]:
    """Draw numbers on one scale of colours, a panel for each plane, and classes where there is
    none; returns entries of a legend."""
    _, factor = label_of(planes[0][variable])
    arrays = [plane[variable] for plane in planes]
    numbers = factor * np.concatenate([array.values.ravel() for array in arrays])
    colours = colours_of(numbers, arrays[0], wishes)
    used: set[str] = set()
    for ax, plane, array in zip(axes, planes, arrays, strict=True):
        edges = edges_of(array)
        values = measured(array).values.astype(float)
        mesh = ax.pcolormesh(*edges, values, cmap=colours.cmap, norm=colours.norm, rasterized=True)
        missing = classes_of_gaps(plane, array)
        paint(ax, edges, missing, LOOKS)
        used |= set(missing.flat)
        marked = {AT_BOUND: at_lower_bound(plane, variable), **doubts(plane, variable)}
        for look, mask in marked.items():
            if mask is not None and mask.any():
                cells = mask.transpose(*array.dims).values
                lay_over(ax, edges, cells, look, mesh.to_rgba(values))
                used.add(look.label)

    unvalued = MARKED[NO_VALUE]._replace(label=missing_text(planes[0], variable))
    looks = {**MARKED, NO_VALUE: unvalued}
    looks |= {look.label: look for look in (AT_BOUND, UNSETTLED, NOT_NEAR, NOT_CONVERGED)}
    if not has_values(planes, variable):
        return entries(used, looks)
    draw_bar(figure, axes, mesh, colours, label_in(planes[0], variable))
    return entries(used, looks)
