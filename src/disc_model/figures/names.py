"""Names of points in a panel: written where there is room, whatever size the figure gets."""

from collections.abc import Iterable
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from disc_model.figures.drawing import say

GAP = 1  # points around a name that no other one covers


class Names(Artist):
    """Names of points, each beside its own: inside the panel, and where it covers no other.

    Those that are added first come first; those that find no room are left out. Places are chosen
    whenever the figure is drawn, since axes change their size until then.
    """

    def __init__(self, ax: Axes, most: int | None = None) -> None:
        super().__init__()
        self._most = most
        self._candidates: list[list[Annotation]] = []
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
        ax: Any = self.axes
        names = [say(ax, text, point, offset, **look) for offset in offsets]
        for name in names:
            name.set_in_layout(False)
        self._candidates.append(names)

    def draw(self, renderer: Any) -> None:
        """Choose the places of all names, which are drawn after it."""
        panel: Any = self.axes
        frame = panel.get_window_extent(renderer)
        taken: list[Any] = []
        for names in self._candidates:
            for name in names:
                name.set_visible(False)
            if self._most is not None and len(taken) == self._most:
                continue
            for name in names:
                name.set_visible(True)
                box = name.get_window_extent(renderer).padded(GAP)
                inside = (
                    frame.x0 <= box.x0
                    and box.x1 <= frame.x1
                    and frame.y0 <= box.y0
                    and box.y1 <= frame.y1
                )
                if inside and not any(box.overlaps(other) for other in taken):
                    taken.append(box)
                    break
                name.set_visible(False)
        self.stale = False
