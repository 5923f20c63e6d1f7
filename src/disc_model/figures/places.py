"""Places of axes on their page, without a picture of all that is on it, which takes longer."""

import warnings
from typing import Any
from weakref import WeakSet

_COLLAPSED: WeakSet[Any] = WeakSet()
"""Pages whose layout gave up when places were set last."""


def set_places(figure: Any) -> None:
    """Set the places of axes and of bars of colours, as drawing the page would."""
    page = figure.get_figure(root=True)
    engine = page.get_layout_engine()
    if engine is not None:
        _lay_out(page, engine)
    for ax in page.axes:
        locate = ax.get_axes_locator()
        ax.apply_aspect(locate(ax, None) if locate else None)


def _lay_out(page: Any, engine: Any) -> None:
    """Let a layout place axes, and note whether it gives up."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        engine.execute(page)
    _COLLAPSED.discard(page)
    for each in caught:
        if "collapsed to zero" in str(each.message):
            _COLLAPSED.add(page)
        warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)


def has_collapsed(figure: Any) -> bool:
    """Whether the layout gave up when places were set last, since nothing would be left of a panel."""
    return figure.get_figure(root=True) in _COLLAPSED
