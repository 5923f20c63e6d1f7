"""A strip along the lower edge of a panel, for marks of points that have no value on its axis."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, NullLocator

from disc_model.figures.drawing import GREY, mark
from disc_model.figures.gap_rows import STRIP
from disc_model.figures.types import Array, Axes

SHARE = 0.8  # of a strip, whose lower edge is the axis, at which no value may lie


def draw_strip(ax: Axes, share: float, marks: Mapping[str, tuple[str, Array]]) -> None:
    """Mark places on a strip as high as a share of a panel, below all values; nothing without a place.

    marks : shape of the mark, and places along the horizontal axis, by what a legend calls them
    """
    shown = {name: each for name, each in marks.items() if each[1].size}
    if not shown:
        return
    _make_room(ax, share)
    edge: dict[str, Any] = {"transform": ax.transAxes, "color": STRIP, "linewidth": 0}
    ax.add_patch(Rectangle((0, 0), 1, SHARE * share, zorder=0, **edge))
    look: dict[str, Any] = {"color": GREY, "linestyle": "", "markersize": mark(4)}
    for name, (shape, places) in shown.items():
        heights = np.full(places.size, 0.5 * SHARE * share)
        transform = ax.get_xaxis_transform()
        ax.plot(places, heights, marker=shape, label=name, transform=transform, **look)


def _make_room(ax: Axes, share: float) -> None:
    """Lower the end of a vertical axis by a share of the panel, where it has neither ticks nor a line."""
    if not ax.has_data():
        ax.set_yticks([])
        return
    low, high = ax.get_ylim()
    more = share / (1 - share)
    lower = low - more * (high - low)
    if ax.get_yscale() == "log":
        lower = low * (low / high) ** more
    ticks = [tick for tick in ax.get_yticks() if low <= tick <= high]
    ax.set_ylim(lower, high)
    ax.spines["left"].set_bounds(low, high)
    ax.yaxis.set_major_locator(FixedLocator(ticks))
    ax.yaxis.set_minor_locator(NullLocator())
