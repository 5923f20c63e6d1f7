"""Lines of branches: thick where cycles are stable, and at the lower edge where a value is -inf."""

from typing import Any, NamedTuple

import numpy as np

from disc_model.figures.branch_wishes import AS_USUAL, PartLooks
from disc_model.figures.drawing import BLACK, mark, sample, wide
from disc_model.figures.selection import broken, stretches
from disc_model.figures.types import Array, Artist, Axes, Mask
from disc_model.figures.words import BELOW_ANY

STABLE = 2.0  # width of lines of stable motions, points,
THIN = 0.7  # and of unstable ones; dashes of two branches that nearly meet would look like a whole line
DOT = 3.0  # points, size of the mark of a cycle computed
# least distance of such marks along the branch, over the panel's diagonal: nearer ones would make a
# thin line look like a thick one
APART = 0.025
MARGIN = 0.04  # share of the values beside them that stays free
FLOOR = 0.04  # height of values of -inf, as a share of the panel
ABOVE_FLOOR = 0.2  # margin where there are such values: a whole line of numbers lies above them


class Look(NamedTuple):
    """Colour of a branch, and lengths of its dashes and gaps in points, none for a whole line."""

    colour: str
    dashes: tuple[float, ...] = ()

    def line(self, width: float) -> dict[str, Any]:
        """Options of a line of a width in points: dashes are as long on a thin line as on a thick
        one."""
        options: dict[str, Any] = {"color": self.colour, "linewidth": wide(width)}
        if self.dashes:
            options["linestyle"] = (0, tuple(length / width for length in self.dashes))
            options["dash_capstyle"] = "butt"
        return options

    def dot(self) -> dict[str, Any]:
        """Options of the marks of cycles, which leave gaps between dashes free, and do not touch."""
        options: dict[str, Any] = {
            "color": self.colour,
            "markersize": mark(DOT),
            "markevery": APART,
        }
        if self.dashes:
            options["markeredgewidth"] = 0
        return options


def dot_in_legend(wished: PartLooks = AS_USUAL) -> dict[str, Any]:
    """Options of a line in a legend that has the mark of a cycle."""
    marks = {name: value for name, value in wished.cycles.items() if name.startswith("marker")}
    return {"marker": ".", "markersize": mark(DOT), **marks}


def draw_branch(
    ax: Axes,
    x: Array,
    y: Array,
    stable: Mask,
    look: Look,
    factor: float = np.inf,
    *,
    wished: PartLooks = AS_USUAL,
) -> None:
    """Draw a line along a branch, with gaps where its height jumps by more than a factor.

    x, y : (n,), points; those behind the last one are nan
    stable : (n - 1,), whether the branch is stable, and its line thick, between each point and the
        next one
    wished : what a reader wishes of both parts
    """
    known = np.isfinite(x)
    x = x[known]
    y = y[known]
    stable = stable[known[1:]]
    height = np.log(y) if factor < np.inf else None
    if look.dashes or wished != AS_USUAL:  # thin dashes would fill the gaps between thick ones
        _draw_stretches(ax, x, y, ~stable, unstable_line(look, wished))
    else:
        ax.plot(*broken(x, y, np.log(factor), height), **unstable_line(look))
    _draw_stretches(ax, x, y, stable, stable_line(look, wished))


def stable_line(look: Look, wished: PartLooks = AS_USUAL, width: float = STABLE) -> dict[str, Any]:
    """Options of the line of stable motions, of a width in points."""
    return {**look.line(width), "solid_capstyle": "butt", **wished.stable}


def unstable_line(look: Look, wished: PartLooks = AS_USUAL) -> dict[str, Any]:
    """Options of the line of unstable motions."""
    return {**look.line(THIN), **wished.unstable}


def draw_dots(ax: Axes, x: Array, y: Array, look: Look, wished: PartLooks = AS_USUAL) -> None:
    """Draw the cycles of a branch as dots, but for those whose height is nan."""
    known = np.isfinite(y)
    if known.any():  # without one matplotlib has no distances
        dots = {"marker": ".", "linestyle": "", **look.dot(), **wished.cycles}
        ax.plot(x[known], y[known], **dots)


def _draw_stretches(ax: Axes, x: Array, y: Array, chosen: Mask, line: dict[str, Any]) -> None:
    """Draw a line between points and the next ones, where it is chosen."""
    for first, last in stretches(chosen):
        part = slice(first, last + 1)
        ax.plot(x[part], y[part], **line)


def stable_segments(growth: Array) -> Mask:
    """Whether a branch is stable between each point and the next one, (n - 1,), from growth rates
    at n points, which are exactly 0 where stability changes."""
    stable = np.maximum(growth[:-1], growth[1:]) <= 0
    between_changes = (growth[:-1] == 0) & (growth[1:] == 0)
    for i in np.flatnonzero(between_changes):
        stable[i] = i > 0 and not stable[i - 1]
    return stable


def between(stable: Mask) -> Mask:
    """Whether both ends of each segment are stable, (n - 1,), from the stability of n points."""
    return stable[:-1] & stable[1:]


# ---- Values of -inf


def above_floor(values: Array) -> Array:
    """The values, nan for those of -inf, which stand at the lower edge."""
    return np.where(np.isneginf(values), np.nan, values)


def draw_at_floor(
    ax: Axes, x: Array, look: Look, place: Mask, wished: PartLooks = AS_USUAL
) -> list[Artist]:
    """Draw points of a branch whose value is -inf as triangles at the lower edge of a panel, joined
    by a thick line, since they are stable; returns the entry of the legend, if there are any.

    place : (n,), which of the points these are
    """
    if not place.any():
        return []
    edge = np.full(x.size, FLOOR)
    at_edge: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "gid": BELOW_ANY}
    _draw_stretches(ax, x, edge, between(place), {**stable_line(look, wished), **at_edge})
    triangles: dict[str, Any] = {"marker": "v", "linestyle": "", "markersize": mark(4)}
    ax.plot(x[place], edge[place], color=look.colour, **triangles, **at_edge)
    return [sample(color=BLACK, label=BELOW_ANY, **triangles)]


def set_margins(ax: Axes) -> None:
    """Leave room around the values of all branches, and below them for those of -inf."""
    below = any(line.get_gid() == BELOW_ANY for line in ax.lines)
    ax.margins(MARGIN, ABOVE_FLOOR if below else MARGIN)
