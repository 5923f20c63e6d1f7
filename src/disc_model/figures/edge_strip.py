"""A strip along the lower edge of a panel, for marks of points that have no value on its axis."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, NullLocator

from disc_model.figures.drawing import GREY, mark
from disc_model.figures.gap_rows import STRIP
from disc_model.figures.types import Array, Axes

SHARE = 0.8  # of a strip, whose lower edge is the axis, at which no value may lie


def draw_strip(ax: Axes, share: float, rows: Sequence[tuple[Array, dict[str, Any]]]) -> float:
    """Mark places on a strip below all values, in rows each as high as a share of a panel, from the lowest
    on; nothing without a place. Returns the share of the panel that the strip covers.

    rows : places along the horizontal axis, and the look of their marks, with what a legend calls them
    """
    shown = [each for each in rows if each[0].size]
    if not shown:
        return 0.0
    height = share * len(shown)
    _make_room(ax, height)
    edge: dict[str, Any] = {"transform": ax.transAxes, "color": STRIP, "linewidth": 0}
    ax.add_patch(Rectangle((0, 0), 1, SHARE * height, zorder=0, **edge))
    transform = ax.get_xaxis_transform()
    for number, (places, look) in enumerate(shown):
        heights = np.full(places.size, (number + 0.5) * SHARE * share)
        whole: dict[str, Any] = {"color": GREY, "linestyle": "", "markersize": mark(4), **look}
        ax.plot(places, heights, transform=transform, clip_on=False, **whole)
    return SHARE * height


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
