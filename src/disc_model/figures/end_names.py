"""Names at the right ends of lines, beside a panel: moved up or down until none is on another."""

from typing import Any

import numpy as np
from matplotlib.text import Annotation

from disc_model.figures.drawing import GREY, wide
from disc_model.figures.types import Array, Artist, Axes

BESIDE = 7  # points from the panel to a name, in which a line leads to it
LEADER = {"arrowstyle": "-", "relpos": (0, 0.5), "shrinkA": 0, "shrinkB": 0, "color": GREY}
"""Look of the line from a name to the end of its own."""
LINE_HEIGHT = 1.15  # least distance of names, over the size of their letters
LEAST_MOVE = 0.5  # point, from which a line leads to a name
KEPT = 0.7  # share of the height of a panel that a legend below it leaves at least


class EndNames(Artist):
    """Names of lines at the heights at which these end, or as near as there is room. They are moved
    whenever the figure is drawn, since axes change their height until then.

    Parameters
    ----------
    ax : the panel
    size : of the letters, points
    """

    def __init__(self, ax: Axes, size: float) -> None:
        super().__init__()
        self._size = size
        self._names: list[Annotation] = []
        self._heights: list[float] = []
        self.set_zorder(-1)  # moves names before they are drawn
        self.set_in_layout(False)
        ax.add_artist(self)

    def add(self, text: str, height: float) -> None:
        """Add the name of a line that ends at a height, in units of the axes."""
        ax: Any = self.axes
        name = ax.annotate(
            text,
            (1, height),
            (BESIDE, 0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            va="center",
            fontsize=self._size,
            arrowprops={**LEADER, "linewidth": wide(0.5)},
        )
        self._names.append(name)
        self._heights.append(height)

    def draw(self, renderer: Any) -> None:
        """Move the names apart, which are drawn after it."""
        ax: Any = self.axes
        point = ax.get_figure(root=True).dpi / 72
        points = [(0.0, height) for height in self._heights]
        ends = ax.transData.transform(np.reshape(points, (-1, 2)))[:, 1]
        moves = spread(ends, LINE_HEIGHT * self._size * point) - ends
        for name, move in zip(self._names, moves / point, strict=True):
            name.set_position((BESIDE, float(move)))
            leader: Any = name.arrow_patch
            leader.set_visible(abs(move) > LEAST_MOVE)
            name.update_positions(renderer)
        self.stale = False


def most_names(ax: Axes, size: float) -> int:
    """The number of names of a size in points that have room beside a panel, also if a legend makes it
    lower."""
    page: Any = ax.get_figure(root=True)
    height = 72 * ax.bbox.height / page.dpi
    return max(int(KEPT * height / (LINE_HEIGHT * size)), 1)


def spread(wanted: Array, apart: float) -> Array:
    """Places at least so far apart, in the order of those wanted, and as near to them as can be."""
    order = np.argsort(wanted, kind="stable")
    offsets = apart * np.arange(wanted.size)
    groups: list[list[float]] = []
    for each in wanted[order] - offsets:
        groups.append([float(each)])
        while len(groups) > 1 and np.mean(groups[-2]) > np.mean(groups[-1]):
            last = groups.pop()
            groups[-1] += last
    level = [float(np.mean(group)) for group in groups for _ in group]
    places = np.empty(wanted.size)
    places[order] = np.array(level) + offsets
    return places
