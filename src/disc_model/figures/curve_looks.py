"""Looks of the marks of lines: their shapes, colours and sizes."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from cmcrameri import cm

from disc_model.figures.branch_lines import THIN, Look
from disc_model.figures.drawing import BLACK, is_in_data, mark
from disc_model.figures.selection import Part
from disc_model.figures.types import Array, Axes

MARKS = "os^Dv<>"
"""Marks of the lines; they are open, so that lines on top of each other show."""
MARK = 3.0  # points, size of the marks of lines,
WIDER = 2.5  # by so much larger for each line that others cover,
WIDEST = 8.0  # but not beyond this


class Looks(NamedTuple):
    """Looks of the marks of lines, by the names of these: their shapes, colours, and sizes; the
    number of their sweep, if other sweeps have the same colours; and the dashes of all lines, "" where
    none joins points."""

    marks: Mapping[str, str]
    colours: Mapping[str, Any]
    sizes: Mapping[str, float]
    sweep: int | None = None
    dashes: Any = ""

    def of(self, name: str) -> dict[str, Any]:
        """The look of the marks of a line."""
        shape = {"marker": self.marks[name], "markersize": self.sizes[name]}
        return {**shape, "color": self.colours[name]}


def looks_of(parts: Sequence[Part[xr.DataArray]], marks: dict[str, str], single: Look) -> Looks:
    """Looks of lines, whose marks are added to those of all panels."""
    choose_marks(marks, parts)
    names = [part.name for part in parts]
    colours = dict(zip(names, _colours(parts, marks, single), strict=True))
    return Looks(marks, colours, _sizes(parts))


def _sizes(parts: Sequence[Part[xr.DataArray]]) -> dict[str, float]:
    """Sizes of the marks of lines: larger ones where others that are drawn later have the same values,
    and would hide them."""
    sizes = {}
    covering = 0
    for i, part in reversed([*enumerate(parts)]):
        later = [other.data.values for other in parts[i + 1 :]]
        if any(_coincide(part.data.values, values) for values in later):
            covering += 1
        sizes[part.name] = mark(min(MARK + WIDER * covering, WIDEST))
    return sizes


def _coincide(heights: Array, others: Array) -> bool:
    """Whether two lines have equal values at a point."""
    return bool(np.isclose(heights.astype(float), others.astype(float), rtol=1e-6).any())


def around_former(
    ax: Axes, parts: Sequence[Part[xr.DataArray]], along: Array, looks: Looks
) -> Looks:
    """Looks whose open marks are larger where lines that a panel has already have equal points, so that
    their marks show inside; words are no points."""
    kinds = [along.dtype.kind, *(part.data.dtype.kind for part in parts)]
    if not {"U", "O"}.isdisjoint(kinds):
        return looks
    sizes = {}
    for part in parts:
        points = set(_rounded(along, part.data.values))
        marks_inside = set()
        for line in ax.lines:
            if is_in_data(ax, line) and points & set(_rounded(*line.get_data())):
                marks_inside.add(line.get_marker())
        marks_inside -= {"None", "", ".", looks.marks[part.name]}
        wider = mark(WIDER * len(marks_inside))
        sizes[part.name] = min(looks.sizes[part.name] + wider, mark(WIDEST))
    return looks._replace(sizes=sizes)


def _rounded(along: Any, heights: Any) -> list[tuple[str, str]]:
    """Points in so many digits that equal ones are the same."""
    across = (f"{x:.6g}" for x in np.asarray(along, dtype=float))
    up = (f"{y:.6g}" for y in np.asarray(heights, dtype=float))
    return [point for point in zip(across, up, strict=True) if "nan" not in point]


def choose_marks(marks: dict[str, str], parts: Sequence[Part[Any]]) -> None:
    """Give lines that have none a mark."""
    for part in parts:
        marks.setdefault(part.name, MARKS[len(marks) % len(MARKS)])


def _colours(parts: Sequence[Part[Any]], marks: Mapping[str, str], single: Look) -> list[Any]:
    """Colours of lines by the order of all that have marks; a single one has its own."""
    if len(parts) == 1:
        return [single.colour]
    order = [*marks]
    return [cm.batlow(order.index(part.name) / len(order)) for part in parts]


PLAIN = Look(BLACK)
"""Look of a single line."""
MOST_WHOLE = 6  # lines of one sweep that their colours tell apart
LONG_DASHES = (0, (9, 2.5))
"""Dashes of every other one of more lines, which those of sweeps do not have."""
CROWDED = 30  # points of a line beyond which a mark for each would be a band of rings
DOT = 1.5  # points, size of a mark of one of them
MARKED = 12  # points of such a line that have a mark, about


def dashes_of(look: Look) -> Any:
    """The dashes of a look; a line without gaps if it has none."""
    return look.line(THIN).get("linestyle", "-")


def dashes_among(parts: Sequence[Part[Any]], name: str, dashes: Any) -> Any:
    """The dashes of one of several whole lines: of many, every other one has long dashes, as their
    colours are nearly those of the ones before and after."""
    place = [part.name for part in parts].index(name)
    if dashes == "-" and len(parts) > MOST_WHOLE and place % 2:
        return LONG_DASHES
    return dashes


def few_marks(heights: np.ndarray, *, joined: bool, alone: bool) -> dict[str, Any]:
    """The look of the marks of many points: a line has some, and that of its greatest value; one that
    is alone has none."""
    if alone:
        return {"marker": ""}
    if not joined:
        return {"markersize": mark(DOT)}
    every = heights.size // MARKED
    greatest = int(np.argmax(np.where(np.isfinite(heights), heights, -np.inf)))
    return {"markevery": sorted({*range(0, heights.size, every), greatest})}


def draw_dots(ax: Axes, along: np.ndarray, heights: np.ndarray, colour: Any) -> None:
    """Draw each of many points as a dot, so that those by themselves stay visible."""
    ax.plot(along, heights, ".", color=colour, markersize=mark(DOT))
