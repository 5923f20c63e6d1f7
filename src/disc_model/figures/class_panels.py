"""Panels of a map of classes, in their colours and patterns."""

from collections.abc import Sequence

import xarray as xr

from disc_model.data.variables import EXCLUDED
from disc_model.figures.cells import class_cells, entries, looks_in
from disc_model.figures.classes import LOOKS, UNRESOLVED
from disc_model.figures.selection import shown_words
from disc_model.figures.types import Artist, Axes


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
