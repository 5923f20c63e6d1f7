"""Classes along a vertical axis that pictures share, such as those of two sweeps: each has its place there
for all of them."""

from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from disc_model.figures.drawing import is_in_data
from disc_model.figures.types import Array, Axes
from disc_model.figures.value_texts import in_lines
from disc_model.figures.words import in_order

_NAMES: WeakKeyDictionary[Any, list[str]] = WeakKeyDictionary()
"""The names of classes along axes, by the locators of their ticks."""
_WORDS: WeakKeyDictionary[Any, list[str]] = WeakKeyDictionary()
"""The words along horizontal axes in the order of their places, by the units that matplotlib gives them."""


def join_classes(
    ax: Axes, names: Sequence[str], array: xr.DataArray
) -> tuple[list[str], xr.DataArray]:
    """The names of the classes of a variable with those that axes have already, and the variable with its
    places among all; points that are drawn move to the places that their classes have now.

    names, array : as `disc_model.figures.words.as_numbers` gives them
    """
    former = _names_on(ax)
    if not names or not former:
        return [*names], array
    common = _in_one_order(former, names)
    for line in _lines_on(ax):
        line.set_ydata(_moved(np.asarray(line.get_ydata(), dtype=float), former, common))
    for each in _sharing(ax):
        each.relim()
    return common, array.copy(data=_moved(array.values.astype(float), names, common))


def name_classes(ax: Axes, names: Sequence[str]) -> None:
    """Write the names of classes along the vertical axis."""
    ax.set_yticks(range(len(names)), labels=[in_lines(name) for name in names])
    _NAMES[ax.yaxis.get_major_locator()] = [*names]


def words_along(ax: Axes, words: Sequence[str]) -> list[str]:
    """All words along a horizontal axis in the order of their places, with those that were drawn
    last."""
    units = ax.xaxis.get_units()
    if units is None:
        return [*map(str, words)]
    known = _WORDS.get(units, [])
    _WORDS[units] = [*dict.fromkeys([*known, *map(str, words)])]
    return _WORDS[units]


def _names_on(ax: Axes) -> list[str]:
    """The names of classes along an axis; none if all that was drawn there was removed."""
    return _NAMES.get(ax.yaxis.get_major_locator(), []) if _lines_on(ax) else []


def _lines_on(ax: Axes) -> list[Line2D]:
    """The lines and points that axes have, or others that share the vertical axis."""
    return [line for each in _sharing(ax) for line in each.lines if is_in_data(each, line)]


def _sharing(ax: Axes) -> list[Axes]:
    """The axes, and those that share the vertical axis with them."""
    return ax.get_shared_y_axes().get_siblings(ax)


def _in_one_order(former: Sequence[str], names: Sequence[str]) -> list[str]:
    """All classes in the order of those that have most of them, or else the further ones behind those there
    were."""
    if {*names} <= {*former}:
        return [*former]
    if {*former} <= {*names}:
        return [*names]
    return in_order([*former, *names])


def _moved(heights: Array, names: Sequence[str], common: Sequence[str]) -> Array:
    """Heights at the places that classes have among others; nan of what is no class."""
    places = {float(number): common.index(name) for number, name in enumerate(names)}
    moved = [places.get(height, np.nan) for height in heights.ravel()]
    return np.reshape(np.array(moved, dtype=float), heights.shape)
