"""Names in a panel: of points, written where there is room, and of modes by their nodal diameters."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from disc_model.figures.drawing import say
from disc_model.figures.types import Array, Artist, Axes, Indices

GAP = 1  # points around a name that no other one covers


class Names(Artist):
    """Names of points, each beside its own: inside the panel, where it covers no other name and is
    nearer to no other point.

    Those that are added first come first; those that find no room are left out. Places are chosen
    whenever the figure is drawn, since axes change their size until then.

    Parameters
    ----------
    ax : the panel
    most : greatest number of names
    lines : points of lines that no name may cover, in units of the axes, shape (n, 2)
    on_stems : whether the points are tops of upright lines, none of which may stand between another
        point and its name
    """

    def __init__(
        self,
        ax: Axes,
        most: int | None = None,
        lines: Array | None = None,
        *,
        on_stems: bool = False,
    ) -> None:
        super().__init__()
        self._most = most
        self._on_stems = on_stems
        self._lines = np.empty((0, 2)) if lines is None else lines
        self._candidates: list[list[Annotation]] = []
        self._points: list[tuple[float, float]] = []
        self.set_zorder(-1)  # chosen before they are drawn
        self.set_in_layout(False)
        ax.add_artist(self)

    def add(
        self,
        text: str,
        point: tuple[float, float],
        offsets: Iterable[tuple[float, float]],
        **look: Any,
    ) -> None:
        """Add the name of a point, by the offsets in points at which it may stand, best first."""
        self.add_along(text, [point], offsets, **look)

    def add_along(
        self,
        text: str,
        points: Sequence[tuple[float, float]],
        offsets: Iterable[tuple[float, float]],
        **look: Any,
    ) -> None:
        """Add the name of a line, by the points of it beside which it may stand, and the offsets
        from these, best first."""
        ax: Any = self.axes
        names = [say(ax, text, *place, **look) for place in product(points, offsets)]
        for name in names:
            name.set_in_layout(False)
        self._candidates.append(names)
        self._points.append(points[0])

    def draw(self, renderer: Any) -> None:
        """Choose the places of all names, which are drawn after it."""
        taken: list[Any] = []
        panel: Any = self.axes
        points = panel.transData.transform(np.reshape(self._points, (-1, 2)))
        for i, names in enumerate(self._candidates):
            for name in names:
                name.set_visible(False)
            if self._most is None or len(taken) < self._most:
                self._place(names, np.delete(points, i, axis=0), taken, renderer)
        self.stale = False

    def _place(
        self, names: Sequence[Annotation], others: Array, taken: list[Any], renderer: Any
    ) -> None:
        """Show the first of a point's names that finds room, nearer to it than to other ones, in
        pixels; its box is added to those taken."""
        panel: Any = self.axes
        frame = panel.get_window_extent(renderer)
        lines = panel.transData.transform(self._lines)
        for name in names:
            name.set_visible(True)  # an invisible one has no extent
            box = name.get_window_extent(renderer).padded(GAP)
            inside = frame.count_contains(box.corners()) == len(box.corners())
            covers = box.count_contains(lines) or box.count_overlaps(taken)
            nearness = Nearness(panel.transData.transform(name.xy), others)
            beyond = self._on_stems and nearness.is_beyond_a_stem(box)
            if inside and not covers and not beyond and nearness.is_clear(box):
                taken.append(box)
                return
            name.set_visible(False)


class Nearness(NamedTuple):
    """A point that is named, and all others, in pixels."""

    own: Array
    others: Array

    def is_clear(self, box: Bbox) -> bool:
        """Whether a box is nearer to the point itself than to any other, so that nobody takes it
        for the name of that one."""
        places = np.vstack([self.own, self.others])
        within = np.clip(places, box.min, box.max)
        own, *others = np.hypot(*(places - within).T)
        return all(own < other for other in others)

    def is_beyond_a_stem(self, box: Bbox) -> bool:
        """Whether an upright line up to another point lies between a box and the point itself, or
        under the box."""
        reach = Bbox.union([box, Bbox([self.own, self.own])])
        across, up = self.others.T
        between = (reach.x0 <= across) & (across <= reach.x1)
        return bool((between & (up >= reach.y0)).any())


# ---- Modes


class Named(NamedTuple):
    """Modes that share a name, since they are too near each other: their indices, and the name."""

    modes: Indices
    name: str


def name_of(*diameters: int) -> str:
    """Name of modes by their nodal diameters; -1: in the plane."""
    names = ["in-plane"] if min(diameters) < 0 else []
    numbers = [str(number) for number in sorted({*diameters}) if number >= 0]
    if numbers:
        names.append(f"l = {', '.join(numbers)}")
    return ", ".join(names)


def named_modes(diameters: Array, heights: Array, apart: float) -> Iterator[Named]:
    """Modes, ascending by height, and their names; those nearer than `apart` to the one below share
    one."""
    known = np.argsort(heights)[: int(np.isfinite(heights).sum())]
    steps = np.flatnonzero(np.diff(heights[known]) > apart) + 1
    for part in np.split(known, steps):
        if part.size:
            yield Named(part, name_of(*diameters[part].astype(int).tolist()))
