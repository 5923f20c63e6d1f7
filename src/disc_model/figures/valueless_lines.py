"""Lines without any value, which the legend names in place of a row of marks for each."""

from collections.abc import Mapping
from typing import Any
from weakref import WeakKeyDictionary

import xarray as xr

from disc_model.figures.selection import parts_along

_REASONS: WeakKeyDictionary[Any, str] = WeakKeyDictionary()
"""Why lines that were drawn have no value."""
UNSEEN = {"marker": "", "linestyle": ""}
"""Look of their entries in the legend, as of the lines on the panel: only words."""


def valueless_lines(reasons: Mapping[str, xr.DataArray], by: str | None) -> dict[str, str]:
    """The names of lines whose points all lack a value for one reason, and this reason; none if no line
    has a value, as marks are then all that there is to see.

    reasons : the points without a value, by their reasons
    by : the dimension along which lines follow each other
    """
    found = {}
    count = 0
    for reason, gone in reasons.items():
        parts = parts_along(gone, by)
        count = len(parts)
        for part in parts:
            if part.data.values.all():
                found[part.name] = reason
    return found if len(found) < count else {}


def say_valueless(line: Any, reason: str) -> None:
    """Say behind the name of a line why it has no value."""
    _REASONS[line] = reason
    name_line(line, str(line.get_label()))


def name_line(line: Any, name: str) -> None:
    """Name a line in the legend, and say there if it has no value."""
    reason = _REASONS.get(line, "")
    line.set_label(f"{name}: {reason}" if reason else name)
