"""Maps of a variable in colour: of classes, of growth rates, and of other numbers."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import EXCLUDED
from disc_model.figures.cells import (
    MARKED,
    class_cells,
    edges_of,
    entries,
    lay_over,
    looks_in,
    paint,
    scale_along,
)
from disc_model.figures.classes import AT_BOUND, DOUBTS, LOOKS, UNRESOLVED
from disc_model.figures.colour_wishes import USUAL, ColourWishes
from disc_model.figures.colours import colours_of, draw_bar, is_growth
from disc_model.figures.drawing import plain_decades, set_label
from disc_model.figures.growth import growth_panels
from disc_model.figures.legends import Key
from disc_model.figures.selection import (
    at_lower_bound,
    classes_of_gaps,
    doubts,
    has_values,
    shown_words,
    statuses,
)
from disc_model.figures.truths import are_of_classes, as_classes
from disc_model.figures.types import Artist, Axes, FigureBase
from disc_model.figures.words import NO_VALUE, label_in, label_of, measured, missing_text


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
    if are_of_classes(first):
        wishes.refuse_of_classes()
        handles = class_panels(axes, arrays, [statuses(plane) for plane in planes])
        has_bar = False
    else:
        draw_numbers = growth_panels if is_growth(variable) else number_panels
        handles = draw_numbers(figure, axes, planes, variable, wishes)
        has_bar = has_values(planes, variable)
    title = "" if has_bar else label_in(planes[0], variable)
    up, across = (first[str(name)] for name in first.dims)
    axes[0].set_xscale(scale_along(across))
    axes[0].set_yscale(scale_along(up))
    for axis in (axes[0].xaxis, axes[0].yaxis):
        if axis.get_scale() == "log":
            plain_decades(axis)
    for ax in axes:
        set_label(ax, "x", across)
        set_label(ax, "y", up)
        _tick_alone(ax.xaxis, across)
        _tick_alone(ax.yaxis, up)
    return Key(handles, title)


def _tick_alone(axis: Any, coordinate: xr.DataArray) -> None:
    """Let an axis have one tick if it has one value: a cell has a width, but no value elsewhere."""
    if coordinate.size == 1 and coordinate.dtype.kind in "fi":
        value = float(measured(coordinate).values[0])
        axis.set_ticks([value], labels=[f"{value:g}"])


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
    looks |= {look.label: look for look in (AT_BOUND, *DOUBTS)}
    if not has_values(planes, variable):
        return entries(used, looks)
    draw_bar(figure, axes, mesh, colours, label_in(planes[0], variable))
    return entries(used, looks)
