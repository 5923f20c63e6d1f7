"""Panels of a map of numbers, on one scale of colours."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from disc_model.figures.cells import MARKED, edges_of, entries, lay_over, paint
from disc_model.figures.classes import AT_BOUND, DOUBTS, LOOKS
from disc_model.figures.colour_wishes import USUAL, ColourWishes
from disc_model.figures.colours import colours_of, draw_bar
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.selection import at_lower_bound, classes_of_gaps, doubts, has_values
from disc_model.figures.types import Artist, Axes, FigureBase
from disc_model.figures.words import NO_VALUE, label_in, label_of, measured


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
