"""Places of axes on their page, without a picture of all that is on it, which takes longer."""

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from weakref import WeakSet

import numpy as np

_COLLAPSED: WeakSet[Any] = WeakSet()
"""Pages whose layout gave up when places were set last."""
_SETTLED: WeakSet[Any] = WeakSet()
"""Pages on which another layout would have changed nothing then."""
ROUNDING = 1e-6  # pixel, by which sizes of axes may differ that are called equal


def set_places(figure: Any) -> None:
    """Set the places of axes and of bars of colours, as drawing the page would."""
    page = figure.get_figure(root=True)
    engine = page.get_layout_engine()
    with ticks_once(page):
        if engine is not None:
            _lay_out(page, engine)
        for ax in page.axes:
            locate = ax.get_axes_locator()
            ax.apply_aspect(locate(ax, None) if locate else None)
        _SETTLED.discard(page)
        if engine is None or all(_has_its_size(ax) for ax in page.axes):
            _SETTLED.add(page)


def has_settled(figure: Any) -> bool:
    """Whether places that are set again stay where they are, if nothing else has changed since."""
    return figure.get_figure(root=True) in _SETTLED


def _has_its_size(ax: Any) -> bool:
    """Whether axes have the size at which a layout has measured what stands around them last."""
    measured = [vars(axis)["_update_ticks"].size for axis in (ax.xaxis, ax.yaxis)]
    known = [size for size in measured if size]
    return bool(known) and np.allclose(known, ax.bbox.size, rtol=0, atol=ROUNDING)


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
        axis._update_ticks = KeptTicks(axis)
    try:
        yield
    finally:
        for axis in all_of_them:
            del axis._update_ticks


class KeptTicks:
    """Sets the ticks of an axis and returns those that are drawn, unless its size and range are those
    of the last time.

    size : of its axes then, in pixels
    """

    def __init__(self, axis: Any) -> None:
        self.axis = axis
        self.update: Callable[[], list[Any]] = axis._update_ticks
        self.size: tuple[float, ...] = ()
        self.view: tuple[float, ...] = ()
        self.shown: list[Any] = []

    def __call__(self) -> list[Any]:
        size = (*self.axis.axes.bbox.size,)
        view = (*self.axis.get_view_interval(),)
        if (size, view) != (self.size, self.view):
            self.shown = self.update()
            self.size = size
            self.view = view
        return self.shown
