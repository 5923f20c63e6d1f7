"""Labels of axes that share one, as those of ``subplots(2, sharex=True)``: numbers stand beside the last panel
alone, and so does their label."""

from collections.abc import Sequence
from typing import Any

from disc_model.figures.labels import words_of
from disc_model.figures.named_axes import own_label
from disc_model.figures.types import Axes

SIDES = {"x": ("bottom", "top"), "y": ("left", "right")}
"""Where numbers along an axis may stand."""


def clear_repeated(axes: Sequence[Axes]) -> None:
    """Take labels away that pictures have written where no numbers stand, if axes that share theirs have
    them beside the numbers."""
    for ax in axes:
        _clear("x", ax.get_shared_x_axes().get_siblings(ax))
        _clear("y", ax.get_shared_y_axes().get_siblings(ax))


def _clear(along: str, sharing: Sequence[Axes]) -> None:
    """Take repeated labels along an axis away from axes that share it, but those of their reader."""
    beside_numbers = {_label_of(each, along) for each in sharing if _has_numbers(each, along)}
    for each in sharing:
        repeats = _label_of(each, along) in beside_numbers
        if repeats and not _has_numbers(each, along) and not own_label(each, along):
            each.set(**{f"{along}label": ""})


def _label_of(ax: Axes, along: str) -> str:
    """The words of the label along an axis."""
    return words_of(_axis_of(ax, along).label)


def _has_numbers(ax: Axes, along: str) -> bool:
    """Whether numbers may stand along an axis."""
    look = _axis_of(ax, along).get_tick_params()
    return any(look.get(f"label{side}", False) for side in SIDES[along])


def _axis_of(ax: Axes, along: str) -> Any:
    return ax.xaxis if along == "x" else ax.yaxis
