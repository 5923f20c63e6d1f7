"""Marks that lie over cells of maps, and never stand in their place, as in the figures: for each pair
of dimensions that a map may have as axes."""

from collections.abc import Mapping
from itertools import combinations
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.cells import MARKED, are_ordered, unresolved_motions
from disc_model.figures.classes import UNRESOLVED, Look
from disc_model.figures.colours import is_growth
from disc_model.figures.growth import MAP_LOOKS, NEGATIVE, marks_of
from disc_model.figures.selection import shown_words, statuses
from disc_model.figures.types import Mask


class MarkedCells(NamedTuple):
    """A mark of a variable on maps over two dimensions, or along its only one: its word, its look,
    and the points that have it, in the shape of the variable."""

    word: str
    look: Look
    axes: tuple[str, ...]
    cells: Mask


def marked_cells(study: xr.Dataset, name: str) -> list[MarkedCells]:
    """All marks of a variable, those that occur, of each pair of its dimensions; along a single one,
    only what a rate's sign decides, since neighbours across are missing."""
    variable = study[name]
    flag = "flag_meanings" in variable.attrs
    if not flag and not is_growth(name):
        return []
    looks = MARKED if flag else MAP_LOOKS
    found = []
    if len(variable.dims) == 1 and not flag:
        decaying = marks_of(study[[name]].expand_dims("alone"), name)[NEGATIVE][0]
        if decaying.any():
            [dim] = variable.dims
            found.append(MarkedCells(NEGATIVE, looks[NEGATIVE], (str(dim),), decaying))
    for axes in combinations([str(dim) for dim in variable.dims], 2):
        for word, cells in _marks_over(study, name, axes).items():
            if cells.any():
                found.append(MarkedCells(word, looks[word], axes, cells))
    return sorted(found, key=lambda mark: [*looks].index(mark.word))


def _marks_over(study: xr.Dataset, name: str, axes: tuple[str, str]) -> Mapping[str, Mask]:
    """The marks on all maps over two dimensions, each in the shape of the variable."""
    variable = study[name]
    part = _beside(study, variable)
    others = [dim for dim in variable.dims if dim not in axes]
    first = variable.isel(dict.fromkeys(others, 0))
    if is_growth(name) and not are_ordered(first):  # each rate decides by itself
        return marks_of(part, name)
    order = [*others, *axes]
    shape = tuple(variable.sizes[dim] for dim in order)
    masks: dict[str, Mask] = {}
    for place in np.ndindex(shape[:-2]):
        plane = part.isel(dict(zip(others, place, strict=True))).transpose(*axes, ...)
        for word, cells in _marks_on(plane, name).items():
            if word not in masks:
                masks[word] = np.zeros(shape, dtype=bool)
            masks[word][place] = cells
    back = [order.index(dim) for dim in variable.dims]
    return {word: mask.transpose(back) for word, mask in masks.items()}


def _beside(study: xr.Dataset, variable: xr.DataArray) -> xr.Dataset:
    """A variable with what is said of the cycle of its points, if that has its dimensions."""
    names = [str(variable.name)]
    if "cycle" in study and {*study["cycle"].dims} == {*variable.dims}:
        names.append("cycle")
    return study[names].assign(status_words=statuses(study))


def _marks_on(plane: xr.Dataset, name: str) -> Mapping[str, Mask]:
    """The marks on one map."""
    variable = plane[name]
    if is_growth(name):
        return marks_of(plane, name)
    if not are_ordered(variable):
        return {}
    status = plane["status_words"]
    words = variable
    if {*status.dims} <= {*variable.dims}:
        words = shown_words(variable, status)
    return {UNRESOLVED.label: unresolved_motions(flag_names(words))}
