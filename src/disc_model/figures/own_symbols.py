"""Symbols in upright letters, on figures of this package and in its pictures on those of readers."""

from typing import Any
from weakref import WeakSet

from matplotlib.text import Text

from disc_model.figures.case_titles import case_above
from disc_model.figures.colours import bars_of
from disc_model.figures.named_axes import own_labels, shown_on
from disc_model.figures.pages import OWN
from disc_model.figures.symbols import set_upright
from disc_model.figures.types import Axes

DRAWN_ON: WeakSet[Axes] = WeakSet()
"""Axes of readers that have a picture of this package."""


def set_symbols(figure: Any) -> None:
    """Set the symbols of a figure of this package, or of its pictures on a reader's, in upright letters."""
    if figure.get_gid() == OWN:
        set_upright(figure.findobj(Text))
    else:
        _set_own_upright(figure)


def _set_own_upright(figure: Any) -> None:
    """Set the symbols of all pictures on a reader's figure in upright letters; labels that the reader
    has written stay."""
    for ax in figure.axes:
        if ax not in DRAWN_ON:
            continue
        own = own_labels(ax)
        labels = {"x": ax.xaxis.label, "y": ax.yaxis.label}
        set_upright(label for along, label in labels.items() if along not in own)
        set_upright(case_above(ax))
        for artist in filter(None, (*shown_on(ax).drawn, ax.get_legend())):
            set_upright(artist.findobj(Text))
        for bar in bars_of(ax):
            set_upright(bar.findobj(Text))
