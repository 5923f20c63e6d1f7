"""Maps of a variable in colour: of classes, of growth rates, and of other numbers."""

from collections.abc import Sequence
from typing import Any

import xarray as xr

from disc_model.figures.cells import scale_along
from disc_model.figures.class_panels import class_panels
from disc_model.figures.colour_wishes import USUAL, ColourWishes
from disc_model.figures.colours import is_growth
from disc_model.figures.drawing import plain_decades, set_label
from disc_model.figures.growth import growth_panels
from disc_model.figures.legends import Key
from disc_model.figures.number_panels import number_panels
from disc_model.figures.selection import has_values, statuses
from disc_model.figures.truths import are_of_classes, as_classes
from disc_model.figures.types import Axes, FigureBase
from disc_model.figures.words import label_in, measured


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
