"""Looks of the lines and marks of a Campbell diagram."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from disc_model.figures.classes import LOOKS
from disc_model.figures.drawing import BLACK, GREY, mark, wide

GROWS = 2.4  # points, width of the line of a mode that grows
UNSTABLE = LOOKS["unstable"].face  # a thick black line may be two thin ones side by side


def growing_look() -> dict[str, Any]:
    """Look of a mode that grows; dots within the line show it at single speeds."""
    width = wide(GROWS)
    dot = {"marker": "o", "markersize": 0.8 * width, "markeredgewidth": 0}
    return {"color": UNSTABLE, "linewidth": width, **dot}


def dot_look(alone: bool, crossed: bool = True) -> dict[str, Any]:
    """Look of a dot; hollow for a point that is joined to none beside it, and a diamond at a peak
    without a crossing."""
    look: dict[str, Any] = {"color": BLACK, "linestyle": "", "markersize": mark(3.5)}
    look["marker"] = "o" if crossed else "D"
    if alone:
        look["markerfacecolor"] = "white"
        look["markeredgewidth"] = wide(0.7)
    return look


NOT_NEAR = "the motion is not near this cycle"


def elsewhere_look() -> dict[str, Any]:
    """Look of a point of a cycle that the motion is not near."""
    return {
        "color": BLACK,
        "linestyle": "",
        "marker": "x",
        "markersize": mark(3.5),
        "markeredgewidth": wide(0.7),
    }


def speed_look() -> dict[str, Any]:
    """Look of the line at the speed of a peak, which is no narrow band without a growth rate."""
    return {"color": BLACK, "linewidth": wide(0.6), "linestyle": (0, (1, 2))}


def beyond_look() -> dict[str, Any]:
    """Look of the mark of a crossing above the frequencies shown."""
    return {
        "color": BLACK,
        "linestyle": "",
        "marker": "^",
        "markersize": mark(4),
        "markerfacecolor": "white",
        "markeredgewidth": wide(0.7),
        "zorder": 4,  # on the edge
    }


class Crossing(NamedTuple):
    """Crossings that have one mark: their effects, what the legend says of them, the mark, and its colour."""

    effects: Sequence[str]
    meaning: str
    marker: str
    face: str


CROSSINGS = (
    Crossing(("mode_rises", "rises", "destabilises"), "a rate rises", "s", BLACK),
    Crossing(("no_rise",), "no rate rises", "s", "white"),
    Crossing(("no_cycle", "unresolved", "not_near", "beyond_scan"), "not known", "v", "white"),
)
"""Marks of crossings by what growth rates do there: the table of the study has more words for it."""


def crossing_look(crossing: Crossing) -> dict[str, Any]:
    """Look of the mark of a crossing."""
    return {
        "color": BLACK,
        "linestyle": "",
        "marker": crossing.marker,
        "markersize": mark(4.5),
        "markerfacecolor": crossing.face,
        "markeredgewidth": wide(0.7),
        "zorder": 4,  # on thick lines
    }


def multiple_look() -> dict[str, Any]:
    """Look of the line of a multiple of a frequency."""
    return {"color": GREY, "linewidth": wide(0.8), "linestyle": (0, (4, 2))}
