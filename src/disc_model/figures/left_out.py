"""Panels of studies with a rule that leaves points out: none for a value at which it leaves out all of
them. Nothing here draws."""

from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from disc_model.data.variables import EXCLUDED
from disc_model.figures.selection import Part, parts_along, statuses, titles_of


def parts_shown(
    study: xr.Dataset, by: str | None, words: Mapping[str, str] | None = None
) -> list[Part[xr.Dataset]]:
    """The parts of a study along a dimension, in order, without those that are left out as a whole; all
    of them if nothing else remains."""
    parts = parts_along(study, by, words)
    shown = [part for part in parts if not _is_left_out(part.data)]
    return shown or parts


def _is_left_out(part: xr.Dataset) -> bool:
    """Whether a rule leaves out all points of a part."""
    return bool((statuses(part) == EXCLUDED).all())


def titles_of_panels(
    parts: Sequence[Part[Any]], study: xr.Dataset, by: str | None = None
) -> list[str]:
    """Titles of the panels of parts, also of a single one if the rest of a study is left out.

    by : the dimension of the parts
    """
    if len(parts) == 1 and study.sizes.get(by, 1) > 1:
        return [parts[0].name]
    return titles_of(parts)
