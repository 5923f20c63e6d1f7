"""A warning of panels on a reader's figure that labels, legends and strips leave no room."""

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, WeakSet

from disc_model.figures.places import has_collapsed
from disc_model.figures.sizes import INCH
from disc_model.figures.types import Axes

LEAST_READABLE = 12.0  # mm, of a side of a panel
LEAST_KEPT = 2 / 3  # of the shorter side of a panel that its reader has made small
REASON = "what stands around it, such as its legend and strips, leaves no room"
ADVICE = "make the figure larger, draw fewer lines, or set legend=False"


class Sides(NamedTuple):
    """Width and height of a panel, in mm."""

    wide: float
    high: float


_GIVEN: WeakKeyDictionary[Axes, Sides] = WeakKeyDictionary()
_WARNED: WeakSet[Any] = WeakSet()
"""Figures of which a reader has been told."""


def remember_sides(panels: Sequence[Axes]) -> None:
    """Note the sides that panels have before the first picture is drawn on them."""
    for ax in panels:
        _GIVEN.setdefault(ax, _sides(ax))


def warn_of_small_panels(figure: Any) -> None:
    """Warn, once for a figure, if what stands around a panel has left it too small to be read."""
    if figure in _WARNED:
        return
    shortages = ["0 mm high or wide"]
    if not has_collapsed(figure):
        shortages = [_shortage(ax) for ax in figure.axes]
    shortage = next(filter(None, shortages), "")
    if shortage:
        _WARNED.add(figure)
        warnings.warn(f"the panel is {shortage}: {REASON}; {ADVICE}", stacklevel=2)


def _shortage(ax: Axes) -> str:
    """Which side of a panel is too short, in words; none if none is."""
    given = _GIVEN.get(ax)
    if given is None:
        return ""
    least = min(LEAST_READABLE, LEAST_KEPT * min(given))
    for name, side in _sides(ax)._asdict().items():
        if side < least:
            return f"{side:.0f} mm {name}"
    return ""


def _sides(ax: Axes) -> Sides:
    page: Any = ax.get_figure(root=True)
    millimetre = page.dpi / INCH
    return Sides(ax.bbox.width / millimetre, ax.bbox.height / millimetre)
