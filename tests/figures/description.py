"""Figures in words: what each panel shows, in which colours, marks and widths, and where.

Descriptions of examples are kept in folders ``descriptions``, a file for each. Whoever changes a
figure writes them anew, by ``python -m tests.figures.described`` or ``python -m
tests.paper.described``, and reads what differs.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import (
    Collection,
    LineCollection,
    PathCollection,
    PolyCollection,
    QuadMesh,
)
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.path import Path as Outline
from matplotlib.spines import Spine
from matplotlib.text import Annotation, Text

MANY = 40
"""Points of which all are listed; of more, their extent and mean."""
NUMBER = re.compile(r"(?<![#\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")
AGREE = 2e-3
"""Relative difference of numbers that count as equal: they are written with four digits, and what
is simulated differs between processors by less than the last of them."""
ZERO = 1e-9
"""Numbers below it are rounding: none that is drawn is so small, but for zeros."""


def describe(figure: Figure) -> list[str]:
    """Return a figure in lines of text."""
    figure.draw_without_rendering()
    found = []
    if figure.get_suptitle():
        found.append(f"title: {quoted(figure.get_suptitle())}")
    for i, ax in enumerate(figure.axes):
        found += [f"panel {i}: {line}" for line in of_panel(ax)]
    for legend in [*figure.legends, *[one for part in figure.subfigs for one in part.legends]]:
        found += [f"legend: {line}" for line in of_legend(legend)]
    return found


def of_panel(ax: Axes) -> Iterator[str]:
    """Yield the axes of a panel, its titles, and what is drawn in it."""
    for name, axis in (("x", ax.xaxis), ("y", ax.yaxis)):
        low, high = axis.get_view_interval()
        label = quoted(axis.get_label_text())
        yield f"{name} {label} {axis.get_scale()} {number(low)} to {number(high)}"
    for loc in ("left", "center", "right"):
        if ax.get_title(loc=loc):
            yield f"{loc} title {quoted(ax.get_title(loc=loc))}"
    titles = [ax.title, ax._left_title, ax._right_title]
    for artist in ax.get_children():
        frame = artist is ax.patch or isinstance(artist, Spine) or artist in titles
        if artist.get_visible() and not frame:
            yield from of_artist(artist)
    if ax.get_legend():
        for line in of_legend(ax.get_legend()):
            yield f"legend: {line}"


def of_artist(artist: Artist) -> Iterator[str]:
    """Yield the description of what is drawn, if it is one of the kinds that figures use."""
    for kind, describe_one in KINDS.items():
        if isinstance(artist, kind):
            yield from describe_one(artist)
            return


def of_text(text: Text) -> Iterator[str]:
    if isinstance(text, Annotation) and text.arrow_patch and text.arrow_patch.get_visible():
        yield f"arrow from {points([text.xyann])} to {points([text.xy])}"
    if not text.get_text().strip():
        return
    place = text.get_position()
    if isinstance(text, Annotation):
        place = text.xy
    yield f"text {quoted(text.get_text())} {colour(text.get_color())} at {points([place])}"


def of_line(line: Line2D) -> Iterator[str]:
    data = np.asarray(line.get_xydata(), dtype=float)
    if data.size:
        yield f"line {look_of_line(line)}{named(line)}: {points(data)}"


def look_of_line(line: Line2D) -> str:
    """Return colour, width and style of a line, and its marks."""
    parts = [colour(line.get_color())]
    if line.get_linestyle() not in ("None", ""):
        parts.append(f"{line.get_linestyle()} of {number(line.get_linewidth())}")
    if line.get_marker() not in ("None", "", None):
        face = colour(line.get_markerfacecolor())
        edge = colour(line.get_markeredgecolor())
        size = number(line.get_markersize())
        shape = line.get_marker()
        if isinstance(shape, Outline):
            shape = "path"
        parts.append(f"marks {shape} of {size} {face} edge {edge}")
    return ", ".join(parts)


def of_marks(marks: PathCollection) -> Iterator[str]:
    places = np.ma.filled(np.ma.asarray(marks.get_offsets(), dtype=float), np.nan)
    if places.size:
        sizes = numbers(np.unique(marks.get_sizes()))
        corners = len(marks.get_paths()[0].vertices)
        look = f"{colours(marks)}, {corners} corners, areas {sizes}"
        yield f"marks {look}{named(marks)}: {points(places)}{values_of(marks)}"


def of_mesh(mesh: QuadMesh) -> Iterator[str]:
    corners = mesh.get_coordinates()
    extent = points([corners[0, 0], corners[-1, -1]])
    shades = np.asarray(mesh.get_facecolor())
    cells = [to_hex(shade, keep_alpha=True) for shade in shades]
    if len(cells) <= MANY:
        words = " ".join(cells)
    else:
        words = f"of {len(cells)} cells"
    yield f"cells over {extent}{values_of(mesh)}, colours {words}"


def of_outlines(shape: Collection) -> Iterator[str]:
    """Yield lines and areas by all of their corners."""
    if not shape.get_paths():
        return
    corners = np.concatenate([path.vertices for path in shape.get_paths()])
    kind = "areas"
    if isinstance(shape, LineCollection):
        kind = "lines"
    width = numbers(np.unique(shape.get_linewidth()))
    yield f"{kind} {colours(shape)} of {width}{named(shape)}: {points(corners)}{values_of(shape)}"


def of_patch(patch: Patch) -> Iterator[str]:
    if isinstance(patch, Rectangle):
        x, y = patch.get_xy()
        corners = np.array([[x, y], [x + patch.get_width(), y + patch.get_height()]])
    else:
        corners = patch.get_path().vertices
    yield f"patch {look_of_patch(patch)}{named(patch)}: {points(corners)}"


def look_of_patch(patch: Patch) -> str:
    """Return the colours of an area, and its pattern."""
    face = colour(patch.get_facecolor())
    return f"{face} edge {colour(patch.get_edgecolor())} {patch.get_hatch() or ''}".rstrip()


def of_legend(legend: Legend) -> Iterator[str]:
    """Yield the title of a legend, and its entries."""
    if legend.get_title().get_text():
        yield quoted(legend.get_title().get_text())
    for text, handle in zip(legend.get_texts(), legend.legend_handles, strict=True):
        look = ""
        if isinstance(handle, Line2D):
            look = look_of_line(handle)
        elif isinstance(handle, Patch):
            look = look_of_patch(handle)
        elif isinstance(handle, Collection):
            look = colours(handle)
        yield f"{quoted(text.get_text())} {look}".rstrip()


KINDS: dict[type, Callable[[Any], Iterator[str]]] = {
    Text: of_text,
    Line2D: of_line,
    PathCollection: of_marks,
    QuadMesh: of_mesh,
    LineCollection: of_outlines,
    PolyCollection: of_outlines,
    Patch: of_patch,
}


# ---- Parts


def quoted(text: str) -> str:
    return "'" + text.replace("\n", " / ") + "'"


def named(artist: Artist) -> str:
    """Return what a legend would call something, if it has a name."""
    label = str(artist.get_label())
    if label.startswith("_") or not label:
        return ""
    return f" {quoted(label)}"


def colour(value: Any) -> str:
    if isinstance(value, str) and value == "none":
        return "none"
    if len(value) == 4:
        return to_hex(value, keep_alpha=True).removesuffix("ff")
    return to_hex(value)


def colours(shape: Collection) -> str:
    """Return the colours of areas, or else of edges, each once."""
    faces = shape.get_facecolor()
    if not len(faces):
        faces = shape.get_edgecolor()
    return " ".join(sorted({to_hex(face, keep_alpha=True) for face in np.atleast_2d(faces)}))


def values_of(shape: Collection) -> str:
    """Return the numbers that colours stand for."""
    array = shape.get_array()
    if array is None or np.ndim(array) > 2:
        return ""
    return f", values {numbers(np.ma.filled(np.ma.asarray(array, dtype=float), np.nan).ravel())}"


def points(places: Any) -> str:
    """Return points in the units of their axes."""
    rows = np.atleast_2d(np.asarray(places, dtype=float))
    if len(rows) <= MANY:
        return "; ".join(f"{number(x)} {number(y)}" for x, y in rows)
    known = rows[np.isfinite(rows).all(axis=1)]
    places = [known.min(axis=0), known.max(axis=0), known.mean(axis=0), known[0], known[-1]]
    low, high, mean, first, last = (points([place]) for place in places)
    return f"{len(rows)} from {low} to {high}, in the mean {mean}, first {first}, last {last}"


def numbers(values: Any) -> str:
    """Return numbers, or of many their extent and mean."""
    flat = np.ravel(np.asarray(values, dtype=float))
    if len(flat) <= MANY:
        return " ".join(map(number, flat))
    known = flat[np.isfinite(flat)]
    ends = f"{number(known.min())} to {number(known.max())}"
    return f"{len(flat)} from {ends}, in the mean {number(known.mean())}"


def number(value: float) -> str:
    if abs(value) < ZERO:
        return "0"
    return f"{float(value):.4g}"


# ---- Comparison with what is kept


def kept(folder: Path, name: str) -> list[str]:
    """Return the description of an example that is kept."""
    return (folder / f"{name}.txt").read_text(encoding="utf-8").splitlines()


def write_all(folder: Path, figures: Mapping[str, Callable[[], Figure]]) -> None:
    """Write the descriptions of all examples anew."""
    mpl.use("agg")
    folder.mkdir(exist_ok=True)
    for name, drawn in figures.items():
        text = "\n".join(describe(drawn())) + "\n"
        (folder / f"{name}.txt").write_text(text, encoding="utf-8")


def differences(found: list[str], expected: list[str]) -> list[str]:
    """Return lines that differ, by words or by numbers that do not agree."""
    apart = []
    for i in range(max(len(found), len(expected))):
        ours = "(nothing)"
        if i < len(found):
            ours = found[i]
        theirs = "(nothing)"
        if i < len(expected):
            theirs = expected[i]
        if not agree(ours, theirs):
            apart.append(f"drawn: {ours}\nkept:  {theirs}")
    return apart


def agree(one: str, other: str) -> bool:
    """Return whether two lines have the same words, and numbers that agree."""
    if NUMBER.sub("#", one) != NUMBER.sub("#", other):
        return False
    pairs = zip(NUMBER.findall(one), NUMBER.findall(other), strict=True)
    return all(math.isclose(float(a), float(b), rel_tol=AGREE, abs_tol=ZERO) for a, b in pairs)
