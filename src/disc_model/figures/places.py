"""Places of axes on their page, without a picture of all that is on it, which takes longer."""

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
        with ticks_once(page):
            engine.execute(page)
    _COLLAPSED.discard(page)
    for each in caught:
        if "collapsed to zero" in str(each.message):
            _COLLAPSED.add(page)
        warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)


def has_collapsed(figure: Any) -> bool:
    """Whether the layout gave up when places were set last, since nothing would be left of a panel."""
    return figure.get_figure(root=True) in _COLLAPSED


@contextmanager
def ticks_once(figure: Any) -> Iterator[None]:
    """Set ticks once for each size and range of an axis, while no locator or formatter is replaced.

    A layout asks each axis for its ticks some ten times: for its numbers, for its title, and for each
    of the four lines around it. Places of legends are tried with as many measures of these.
    """
    page = figure.get_figure(root=True)
    every_axis = [axis for ax in page.axes for axis in (ax.xaxis, ax.yaxis)]
    all_of_them = [axis for axis in every_axis if "_update_ticks" not in vars(axis)]
    for axis in all_of_them:
        axis._update_ticks = _kept_ticks(axis)
    try:
        yield
    finally:
        for axis in all_of_them:
            del axis._update_ticks


def _kept_ticks(axis: Any) -> Callable[[], list[Any]]:
    """What sets the ticks of an axis and returns those that are drawn, unless its size and range are
    those of the last time."""
    update = axis._update_ticks
    shown: dict[tuple[float, ...], list[Any]] = {}

    def kept() -> list[Any]:
        size = (*axis.axes.bbox.size, *axis.get_view_interval())
        if size not in shown:
            shown.clear()
            shown[size] = update()
        return shown[size]

    return kept
