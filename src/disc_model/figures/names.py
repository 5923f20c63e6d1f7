"""Names in a panel: of points, written where there is room, and of modes by their nodal diameters."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from matplotlib.text import Annotation, Text
from matplotlib.transforms import Bbox

from disc_model.figures.drawing import GREY, say, side_of, wide
from disc_model.figures.types import Array, Artist, Axes, Indices

GAP = 1  # points around a name that no other one covers
LEADER = {"arrowstyle": "-", "relpos": (0.5, 0), "shrinkA": 0, "shrinkB": 1, "color": GREY}
"""Look of the line from a name to its point: from the middle of its lower side."""
LEADER_APART = 3  # points, least distance of this line from a higher upright one


class Place(NamedTuple):
    """Where a name may stand: the point beside which it does, the offset from it in points, and
    whether a line leads from the name to the point."""

    point: tuple[float, float]
    offset: tuple[float, float]
    led: bool = False


class Names(Artist):
    """Names of points, each beside its own: inside the panel, where it covers no other name and is
    nearer to no other point.

    Those that are added first come first; those that find no room are left out. Places are chosen
    whenever the figure is drawn, since axes change their size until then.

    Parameters
    ----------
    ax : the panel
    lines : points of lines that no name may cover, in units of the axes, shape (n, 2)
    stems : tops of upright lines, named or not, in units of the axes: none may stand
        between a point and its name, and a name is nearer to none of the others
    first_needed : whether none is shown if the first finds no room
    beside : least distance of two names in a row, points: nearer ones read as one
    """

    def __init__(
        self,
        ax: Axes,
        lines: Array | None = None,
        *,
        stems: Sequence[tuple[float, float]] | None = None,
        first_needed: bool = False,
        beside: float = 0.0,
    ) -> None:
        super().__init__()
        self._first_needed = first_needed
        self._beside = beside
        self._stems = None if stems is None else np.reshape(stems, (-1, 2))
        self._lines = np.empty((0, 2)) if lines is None else lines
        self._names: list[Annotation] = []
        self._places: list[list[Place]] = []
        self._rivals: list[Array] = []
        self._over_lines = set[int]()  # of these names
        self.set_zorder(-1)  # chosen before they are drawn
        self.set_in_layout(False)
        ax.add_artist(self)

    def add(
        self,
        text: str,
        point: tuple[float, float],
        offsets: Iterable[tuple[float, float]],
        led: Iterable[tuple[float, float]] = (),
        rivals: Array | None = None,
        **look: Any,
    ) -> None:
        """Add the name of a point, by the offsets in points at which it may stand, best first, and
        those further ones at which a line leads to the point; it stands nearer to this than to points
        of rival lines where there is room."""
        places = [Place(point, offset) for offset in offsets]
        places += [Place(point, offset, led=True) for offset in led]
        self._add(text, places, rivals, **look)

    def add_along(
        self,
        text: str,
        points: Sequence[tuple[float, float]],
        offsets: Iterable[tuple[float, float]],
        rivals: Array | None = None,
        *,
        over_lines: bool = False,
        **look: Any,
    ) -> None:
        """Add the name of a line, by the points of it beside which it may stand, and the offsets
        from these, best first; it stands nearer to these than to points of rival lines where there is room.
        One that may stand over lines does so rather than nearer to rivals."""
        if over_lines:
            self._over_lines.add(len(self._names))
        self._add(text, [Place(*place) for place in product(points, offsets)], rivals, **look)

    def _add(
        self, text: str, places: list[Place], rivals: Array | None = None, **look: Any
    ) -> None:
        """Add a name with its places, and the points of lines for whose name it must not pass."""
        ax: Any = self.axes
        if any(place.led for place in places):
            look["arrowprops"] = {**LEADER, "linewidth": wide(0.5)}
        name = say(ax, text, places[0].point, places[0].offset, **look)
        name.set_in_layout(False)
        self._names.append(name)
        self._places.append(places)
        self._rivals.append(np.empty((0, 2)) if rivals is None else rivals)

    def draw(self, renderer: Any) -> None:
        """Choose the places of all names, which are drawn after it."""
        taken: list[Any] = []
        for i, name in enumerate(self._names):
            wanted = i == 0 or bool(taken) or not self._first_needed
            name.set_visible(wanted and self._find_place(i, taken, renderer))
        self.stale = False

    def _find_place(self, i: int, taken: list[Any], renderer: Any) -> bool:
        """Move a name to a place with room: far from rival lines if there is one, else to any. Whether
        there is one."""
        others = self._others(i)
        apart = np.vstack([others, self._rivals[i]])
        if self._place(i, apart, taken, renderer):
            return True
        if i in self._over_lines:
            return self._place(i, apart, taken, renderer, lines=np.empty((0, 2)))
        return len(apart) > len(others) and self._place(i, others, taken, renderer)

    def _place(
        self, i: int, points: Array, taken: list[Any], renderer: Any, lines: Array | None = None
    ) -> bool:
        """Move a name to the first of its places with room, nearer to its point than to other ones, and
        on none of the lines, usually all; its box, in pixels, is added to those taken. Whether there is
        such a place."""
        panel: Any = self.axes
        frame = panel.get_window_extent(renderer)
        covered = panel.transData.transform(self._lines if lines is None else lines)
        others = panel.transData.transform(points)
        name = self._names[i]
        name.set_visible(True)  # an invisible one has no extent
        for place in self._places[i]:
            _move(name, place, renderer)
            box = Text.get_window_extent(name, renderer).padded(GAP)  # without its leader
            nearness = Nearness(panel.transData.transform(place.point), others)
            inside = frame.count_contains(box.corners()) == len(box.corners())
            covers = box.count_contains(covered) or box.count_overlaps(taken)
            if inside and not covers and self._is_plain(place, nearness, box, taken):
                figure: Any = self.get_figure(root=True)
                apart = self._beside * figure.dpi / 72
                taken.append(Bbox.from_extents(box.x0 - apart, box.y0, box.x1 + apart, box.y1))
                return True
        return False

    def _is_plain(self, place: Place, nearness: "Nearness", box: Bbox, taken: list[Any]) -> bool:
        """Whether nobody takes a name in a box for that of another point."""
        if place.led:
            figure: Any = self.get_figure(root=True)
            apart = LEADER_APART * figure.dpi / 72
            free = nearness.has_free_way(box, apart)
            return free and not nearness.way_to(box).count_overlaps(taken)
        if self._stems is not None and nearness.is_beyond_a_stem(box):
            return False
        return nearness.is_clear(box)

    def _others(self, i: int) -> Array:
        """The points of other names than the i-th, and other stems, in units of the axes."""
        points = np.reshape([places[0].point for places in self._places], (-1, 2))
        others = np.delete(points, i, axis=0)
        if self._stems is None:
            return others
        return np.vstack([others, self._stems[(self._stems != points[i]).any(axis=1)]])


def _move(name: Annotation, place: Place, renderer: Any) -> None:
    """Move a name to a place, on the side to which its offset leads."""
    name.xy = place.point
    name.set_position(place.offset)
    across, up = side_of(place.offset)
    name.set_horizontalalignment(across)
    name.set_verticalalignment(up)
    if name.arrow_patch is not None:
        name.arrow_patch.set_visible(place.led)
    name.update_positions(renderer)


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
        return self.has_a_stem(Bbox.union([box, Bbox([self.own, self.own])]))

    def has_free_way(self, box: Bbox, apart: float) -> bool:
        """Whether no upright line is in a box above the point, and no higher one up to so far beside
        the point."""
        around = Bbox([self.own, self.own]).padded(apart)
        around.y0 = self.own[1]
        return not (self.has_a_stem(box) or self.has_a_stem(around))

    def way_to(self, box: Bbox) -> Bbox:
        """The box of a line from the middle of the lower side of a box to the point."""
        middle = (box.x0 + box.x1) / 2
        return Bbox(np.array([self.own, (middle, box.y0)]))

    def has_a_stem(self, box: Bbox) -> bool:
        """Whether an upright line up to another point is in a box, or ends above it."""
        across, up = self.others.T
        between = (box.x0 <= across) & (across <= box.x1)
        return bool((between & (up >= box.y0)).any())


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
    one, and within twice that, those that would have the same."""
    known = np.argsort(heights)[: int(np.isfinite(heights).sum())]
    steps = np.flatnonzero(np.diff(heights[known]) > apart) + 1
    parts: list[Named] = []
    for modes in np.split(known, steps):
        if not modes.size:
            continue
        name = name_of(*diameters[modes].astype(int).tolist())
        if parts and parts[-1].name == name:
            lower = parts[-1].modes
            if heights[modes[0]] - heights[lower[-1]] <= 2 * apart:
                modes = np.concatenate([lower, modes])
                parts.pop()
        parts.append(Named(modes, name))
    yield from parts
