"""Cells of maps: where their edges lie, and how classes and marks are painted into them."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.colors import to_rgba
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from disc_model.data.variables import EXCLUDED, Outcome, flag_names
from disc_model.figures import selection
from disc_model.figures.classes import LOOKS, UNRESOLVED, WEIGHTS, Look, looks_of
from disc_model.figures.drawing import DECADES, GREY, wide
from disc_model.figures.types import Array, Artist, Axes, Mask, Words
from disc_model.figures.words import measured

Colours = Array  # red, green, blue and opacity along the last dimension

DECADES_FROM = 15
"""Ratio of the largest to the least positive value from which a scale may be logarithmic."""
DECADE = 10.0
"""Ratio of the largest to the least of values with equal ratios from which their scale is logarithmic."""
SAME_RATIO = 1e-6
"""Relative difference of ratios of neighbours that count as equal."""
MARKED = {**LOOKS, UNRESOLVED.label: UNRESOLVED}
"""Looks of classes, and of the mark of unresolved ones."""


class Edges(NamedTuple):
    """Edges of the cells of a map, in the units of its axes: across, shape (columns + 1,), and up,
    shape (rows + 1,)."""

    across: Array
    up: Array


# ---- Scales and edges


def scale_of(name: str, values: Array) -> str:
    """Scale of the axis of a parameter: "log" for values over a decade or more with equal ratios,
    and for others over decades, most at the lower end; "symlog" if these begin at 0; or "linear"."""
    if is_geometric(values):
        return "log"
    positive = values[values > 0]
    if name in ("N", "Omega") or positive.size < 2:
        return "linear"
    over_decades = positive[-1] / positive[0] > DECADES_FROM
    mostly_low = np.median(values) - values[0] <= 0.25 * (values[-1] - values[0])
    if not (over_decades and mostly_low):
        return "linear"
    return "log" if values[0] > 0 else "symlog"


def is_geometric(values: Array) -> bool:
    """Whether three or more positive values, over a decade or more, have equal ratios, as those of
    `numpy.geomspace`."""
    if values.size < 3 or not (values > 0).all():
        return False
    ratios = values[1:] / values[:-1]
    equal = ratios.max() <= (1 + SAME_RATIO) * ratios.min()
    span = values.max() / values.min()
    return bool(equal and span >= DECADE * (1 - SAME_RATIO))


def edges_of(plane: xr.DataArray) -> Edges:
    """Edges of the cells around the points of a plane of dimensions (up, across), halfway between
    neighbours."""
    up, across = (_edges_along(plane[str(name)]) for name in plane.dims)
    return Edges(across, up)


def _edges_along(coordinate: xr.DataArray) -> Array:
    values = measured(coordinate).values
    if scale_of(str(coordinate.name), values) == "log":
        return np.exp(selection.edges(np.log(values)))
    return selection.edges(values)


def decades_between(values: Array) -> list[float]:
    """Ticks of a logarithmic axis from the least positive to the greatest value."""
    least = values[values > 0][0]
    return [tick for tick in DECADES if 0.999 * least <= tick <= 1.001 * values[-1]]


# ---- Painting


def are_ordered(values: xr.DataArray) -> bool:
    """Whether cells beside each other on a map have neighbouring values along both dimensions:
    numbers that do not merely count samples, events or modes."""
    return all(map(_is_ordered, (values.coords.get(dim) for dim in values.dims)))


def _is_ordered(values: xr.DataArray | None) -> bool:
    if values is None or values.dtype.kind not in "fiu":
        return False
    return not str(values.attrs.get("long_name", "")).startswith("number of the ")


def unresolved(words: Words) -> Mask:
    """Cells between two that have one other word: single ones, and strips that are one cell
    wide; not those that are left out, or beside such."""
    around = np.pad(_without_excluded(words), 1, constant_values="")  # "0" by default
    vertical = (around[:-2, 1:-1], around[2:, 1:-1])
    horizontal = (around[1:-1, :-2], around[1:-1, 2:])
    found = np.zeros(words.shape, dtype=bool)
    for before, after in (vertical, horizontal):
        found |= (before == after) & (before != words) & (before != "")
    return found & (words != EXCLUDED)


def alone(words: Words) -> Mask:
    """Cells whose word none of the eight cells around them has; those at an edge, or beside cells
    that are left out, may go on there."""
    words = _without_excluded(words)
    around = np.pad(words, 1, constant_values="")
    neighbours = np.lib.stride_tricks.sliding_window_view(around, (3, 3))
    like = (neighbours == words[..., None, None]).sum((2, 3))  # a cell is like itself
    return np.asarray((like == 1) & (neighbours != "").all((2, 3)))


def _without_excluded(words: Words) -> Words:
    """Words of cells, "" where a cell is left out."""
    return np.where(words == EXCLUDED, "", words)


def unresolved_motions(words: Words) -> Mask:
    """Unresolved cells of a map of what becomes of motions, whose classes are right but narrower than
    the grid can show; none if the words say anything else. Where a motion is undecided, or there is
    none, nothing is right."""
    if not {*words.flat} & {*Outcome}:
        return np.zeros(words.shape, dtype=bool)
    known = ~np.isin(words, ["", EXCLUDED, Outcome.UNDECIDED, "failed"])
    return known & (unresolved(words) | alone(words))


def paint(ax: Axes, edges: Edges, words: Words, looks: Mapping[str, Look]) -> Colours:
    """Paint each cell in the look of its word, if it has one; returns the colours."""
    colours = np.zeros((*words.shape, 4))
    for word, look in looks.items():
        colours[words == word] = to_rgba(look.face)
    if colours.any():
        ax.pcolormesh(*edges, colours, rasterized=True)
    for word, look in looks.items():
        if look.hatch:
            _hatch(ax, edges, words == word, look.hatch, look.ink)
    return colours


def lay_over(ax: Axes, edges: Edges, cells: Mask, mark: Look, below: Colours) -> None:
    """Hatch some cells with a mark, in black or white, whichever is seen on the colours `below`."""
    lightness = below[..., :3] @ np.array(WEIGHTS)
    light = (lightness >= 0.5) | (below[..., 3] == 0)  # nothing is painted on the white page
    _hatch(ax, edges, cells & light, mark.hatch, "#000000")
    _hatch(ax, edges, cells & ~light, mark.hatch, "#ffffff")


def _hatch(ax: Axes, edges: Edges, cells: Mask, hatch: str, ink: str) -> None:
    """Hatch cells, all as one path, since a path for each takes a hundred times as long."""
    row, column = np.nonzero(cells)
    if not row.size:
        return
    x = edges.across[column[:, None] + np.array([0, 1, 1, 0])]
    y = edges.up[row[:, None] + np.array([0, 0, 1, 1])]
    outline = Path.make_compound_path_from_polys(np.stack([x, y], axis=-1))
    ax.add_patch(PathPatch(outline, fill=False, hatch=hatch, ec=ink, lw=0, zorder=1.1))


def class_cells(ax: Axes, plane: xr.DataArray, looks: Mapping[str, Look]) -> set[str]:
    """Paint cells in the look of their class. Those of motions are hatched, too, where they are
    unresolved; returns the classes and marks that occur."""
    words = flag_names(plane)
    edges = edges_of(plane)
    colours = paint(ax, edges, words, looks)
    used = set(words.flat)
    single = unresolved_motions(words)
    if are_ordered(plane) and single.any():
        lay_over(ax, edges, single, UNRESOLVED, colours)
        used.add(UNRESOLVED.label)
    return used


# ---- Legends


def looks_in(flag: xr.DataArray) -> dict[str, Look]:
    """Looks of all words that a flag can have; of those that occur if it holds words, those of
    `LOOKS` first and in their order."""
    meanings = flag.attrs.get("flag_meanings", "").split()
    if not meanings:
        places = {word: place for place, word in enumerate(LOOKS)}
        words = np.unique(flag_names(flag)).tolist()
        meanings = sorted(words, key=lambda word: places.get(word, len(places)))
    return looks_of(meanings)


def patch_of(look: Look) -> Artist:
    """The legend entry of a class or mark."""
    edge = look.ink if look.hatch else GREY
    return Patch(
        facecolor=look.face, hatch=look.hatch, edgecolor=edge, linewidth=wide(0.4), label=look.label
    )


def patches(looks: Iterable[Look]) -> list[Artist]:
    """Legend entries of classes and marks."""
    return [patch_of(look) for look in looks]


def entries(used: Iterable[str], looks: Mapping[str, Look] = LOOKS) -> list[Artist]:
    """Legend entries of the looks among used words, in the order of the looks."""
    words = set(used)
    return patches(look for word, look in looks.items() if word in words)


# ---- Colours of a reader


def scale_along(coordinate: xr.DataArray) -> str:
    """Scale of an axis, as in maps of regions, but linear from 0 on and along words."""
    if coordinate.dtype.kind in "UO":
        return "linear"
    known = scale_of(str(coordinate.name), coordinate.values)
    return "linear" if known == "symlog" else known
