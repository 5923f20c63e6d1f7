"""What several figures draw: colours, sizes, panels, labels and marks.

Widths of lines, sizes of text and of marks follow the settings of matplotlib in force: those of the
common style, or of a reader who brings own axes.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, repeat
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axis import Axis
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import (
    FuncFormatter,
    Locator,
    LogFormatterSciNotation,
    LogLocator,
    MaxNLocator,
    NullFormatter,
)

from disc_model.figures.sizes import COLUMN as COLUMN  # sizes are a part of the style
from disc_model.figures.sizes import PAGE as PAGE
from disc_model.figures.types import Array, Artist, Axes, Figure
from disc_model.figures.words import measured

# ---- Colours, of Okabe and Ito: one per quantity in the whole set

BLACK = "#000000"
GREY = "#8a8a8a"
BLUE = "#0072B2"
SKY = "#56B4E9"
VERMILION = "#D55E00"
ORANGE = "#E69F00"
BROWN = "#7A4B12"
GREEN = "#009E73"
PURPLE = "#CC79A7"
INDIGO = "#332288"  # of Tol, as the next two: for many lines
OLIVE = "#999933"
ROSE = "#CC6677"

DISC = BLUE
SLIDER = ORANGE
FORCE = "#4d4d4d"
SEPARATED = VERMILION  # loss of contact, always
PHASE_COLOURS = {"stick": GREEN, "slip": PURPLE, "separation": SEPARATED}
PAPER = "#F0E442"  # the paper's results, always with a black edge: no other mark and no map has it

BORDERS: dict[str, dict[str, Any]] = {
    "neutral": {
        "color": BLACK,
        "linewidth": 1.0,
        "linestyle": "-",
        "label": "cycle loses stability",
    },
    "fold": {
        "color": BLACK,
        "linewidth": 1.0,
        "linestyle": (0, (1.2, 0.8)),  # corners of cells stay visible in short dashes
        "label": "stable cycle ends (fold)",
    },
}
"""Lines of all stability charts, for a line width of 1 point."""
DECADES = np.outer(10.0 ** np.arange(-9, 13), (1, 2, 5)).ravel()
"""Ticks of a logarithmic axis."""

OPEN_STEP = Path([(-1, -0.25), (-0.2, -0.25), (0.2, 0.25), (1, 0.25)], [1, 2, 1, 2])
"""Two pieces of a line, moved to and drawn, at two heights: the sample of one that is open there."""

_RING = Path.circle(radius=0.35)
OPEN_RING = Path.make_compound_path(
    Path([(-1, -0.25), (-0.5, -0.25)]), Path([(0.5, 0.25), (1, 0.25)]), _RING
)
"""A ring between two such pieces: the sample of a point that the line leaves alone."""

# ---- Sizes that follow the settings in force

STYLE_TEXT = 8.0  # points, font.size of the common style
USUAL_MARK = 6.0  # points, lines.markersize of matplotlib, which the style keeps


def wide(points: float) -> float:
    """Width of a line that has so many points where lines.linewidth is 1."""
    return float(points * mpl.rcParams["lines.linewidth"])


def large(points: float) -> float:
    """Size of text that has so many points where font.size is that of the style."""
    return float(points * mpl.rcParams["font.size"] / STYLE_TEXT)


def mark(points: float) -> float:
    """Size of a mark that has so many points where lines.markersize is as usual."""
    return float(points * mpl.rcParams["lines.markersize"] / USUAL_MARK)


# ---- Figures


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of a size in inches, outside pyplot's state."""
    return Figure(figsize=(width, height), layout="constrained")


Panels = tuple[Figure, list[Axes]]


def panels(width: float, height: float, rows: int = 1, columns: int = 1, **shared: Any) -> Panels:
    """A figure of a size in inches with panels, row by row; `shared` as `Figure.subplots` has
    it."""
    figure = new_figure(width, height)
    return figure, list(figure.subplots(rows, columns, squeeze=False, **shared).flat)


def row_of_panels(width: float, count: int, height: float, stacked: float, **shared: Any) -> Panels:
    """A figure with panels beside each other on a page, or below each other in one column.

    width : of the figure, inch
    count : number of panels
    height : of a row of panels, inch
    stacked : of each of several panels below each other, inch
    shared : as `Figure.subplots` has it
    """
    if width == PAGE or count == 1:
        return panels(width, height, 1, count, **shared)
    return panels(width, stacked * count, count, 1, **shared)


# ---- Panels beside each other


def leave_to_first(column: Sequence[Axes], first: Sequence[Axes]) -> None:
    """Leave names and numbers of the vertical axes to the first column, if it stands beside this
    one."""
    for ax, left in zip(column, first, strict=True):
        places = [each.get_position(original=True) for each in (left, ax)]
        if math.isclose(places[0].y0, places[1].y0) and places[0].x1 < places[1].x0:
            ax.set_ylabel("")
            ax.tick_params(labelleft=False)


def leave_to_last(column: Sequence[Axes]) -> None:
    """Leave the name and the numbers of the time to the last of the axes above each other."""
    for ax in column:
        if _stands_above(ax, column[-1]):
            ax.set_xlabel("")
            ax.tick_params(labelbottom=False)


def _stands_above(ax: Axes, other: Axes) -> bool:
    """Whether axes stand above others, whose numbers then are those of both."""
    place = ax.get_position(original=True)
    below = other.get_position(original=True)
    return math.isclose(place.x0, below.x0) and place.y0 >= below.y1


# ---- Ticks

FEW_DECADES = 2.0  # up to which 2 and 5 are ticks of a logarithmic axis too
FEW_TICKS = 3  # numbers that an axis has at least, if not more even steps than
STEPS = (5, 8)  # would be needed
FAR = 0.2  # of a vertical axis, the longest part at its end without a number,
AT_END = 0.08  # and the part in which one is then
ROUNDING = 1e-9  # relative, of limits that are edges of cells


class PlainDecades(Locator):
    """Ticks of a logarithmic axis: powers of ten; 1, 2 and 5 over few decades; even steps where these
    would be fewer than three. All are labelled, and a horizontal axis has no more of them than find room."""

    def __init__(self, least: float = 0.0) -> None:
        """Have no ticks below `least`."""
        self.least = least

    def __call__(self) -> Any:
        """The ticks between the limits of the axis."""
        axis: Any = self.axis
        low, high = sorted(axis.get_view_interval())
        ticks = self.tick_values(low, high)
        ticks = ticks[ticks >= self.least]
        if axis.axis_name == "x":
            inside = (ticks >= low * (1 - ROUNDING)) & (ticks <= high * (1 + ROUNDING))
            return _fewer(ticks[inside], axis.get_tick_space())
        if self.least < 1 and high < 10 * low:
            return _with_ends(ticks, low, high)
        return ticks

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """The ticks between two positive values."""
        decades = math.log10(vmax / vmin)
        if decades > FEW_DECADES:
            return LogLocator().tick_values(vmin, vmax)
        ticks = _between(np.asarray(DECADES), vmin, vmax)
        whole = self.least >= 1
        for most in STEPS:
            if ticks.size >= FEW_TICKS:
                break
            steps = MaxNLocator(most, steps=[1, 2, 5, 10], integer=whole, min_n_ticks=1)
            ticks = _between(np.asarray(steps.tick_values(vmin, vmax)), vmin, vmax)
        return ticks


def _between(ticks: Array, low: float, high: float) -> Array:
    """The ticks from one value to another."""
    return ticks[(ticks >= low) & (ticks <= high)]


def _with_ends(ticks: Array, low: float, high: float) -> Array:
    """Ticks of a logarithmic axis that spans less than a factor of ten, and a round number at each end from
    which they are far."""
    far = (high / low) ** FAR
    near = (high / low) ** AT_END
    shown = _between(ticks, low, high)
    ends = []
    if not (shown < low * far).any():
        ends.append(_roundest(low, low * near))
    if not (shown > high / far).any():
        ends.append(_roundest(high / near, high))
    return np.sort([*ticks, *ends])


def _roundest(low: float, high: float) -> float:
    """The number between two positive ones that has the fewest digits."""
    power = 10.0 ** math.floor(math.log10(high))
    while True:
        for step in (power, power / 2, power / 5):
            number = step * math.ceil(low / step)
            if number <= high:
                return number
        power /= 10


def _fewer(ticks: Array, room: int) -> Array:
    """Ticks that find room: all, or every so many powers of ten among them, or the ends without two
    of these."""
    if ticks.size <= max(room, 2):
        return ticks
    exponents = np.log10(ticks)
    powers = ticks[np.isclose(exponents, np.round(exponents))]
    if powers.size < 2:
        return ticks[[0, -1]]
    return powers[:: math.ceil(powers.size / max(room, 2))]


def plain_decades(axis: Axis, least: float = 0.0) -> None:
    """Label a logarithmic axis by plain numbers from `least` on, far enough apart; over more than two
    decades, by powers of ten."""
    powers = LogFormatterSciNotation()
    powers.set_axis(axis)

    def text(value: float, _: float) -> str:
        low, high = sorted(axis.get_view_interval())
        if math.log10(high / low) > FEW_DECADES:
            return str(powers(value))
        return f"{value:.6g}"

    axis.set_major_locator(PlainDecades(least))
    axis.set_major_formatter(FuncFormatter(text))
    axis.set_minor_formatter(NullFormatter())


# ---- Samples of a legend, and outlines


def sample(**look: Any) -> Artist:
    """A line or mark for a legend."""
    return Line2D([], [], **look)


def open_line(label: str, color: Any, width: float) -> Line2D:
    """A line for a legend that is open at a step, as in its panel; width in points."""
    look: dict[str, Any] = {"color": color, "markersize": mark(10), "markeredgewidth": width}
    return Line2D([], [], label=label, linestyle="", marker=OPEN_STEP, **look)


def open_ring(label: str, color: Any, width: float) -> Line2D:
    """A line for a legend that is open at a step, and a point by itself; width in points."""
    line = open_line(label, color, width)
    line.set_marker(OPEN_RING)
    line.set_markerfacecolor("white")
    return line


def is_in_data(ax: Axes, drawn: Artist) -> bool:
    """Whether something is drawn in the units of both axes."""
    across, up = drawn.get_transform().contains_branch_seperately(ax.transData)
    return bool(across and up)


def halo(width: float = 1.5, colour: str = "white") -> list[Any]:
    """An outline of text, lines or marks; width in points, that of what it surrounds included."""
    return [withStroke(linewidth=width, foreground=colour)]


def border(kind: str) -> dict[str, Any]:
    """Look of the line of a stability chart, of "neutral" or "fold"."""
    look = dict(BORDERS[kind])
    look["linewidth"] = wide(look["linewidth"])
    return look


# ---- Marks


def headroom(ax: Axes, share: float) -> None:
    """Leave room above the data, a fraction of their height."""
    low, high = ax.get_ylim()
    ax.set_ylim(top=high + share * (high - low))


def whole_marks(ax: Axes) -> None:
    """Let marks on the edge of a panel, whose limits are set, stand whole; those of lines without a
    stroke."""
    (left, right), (bottom, top) = (sorted(each) for each in (ax.get_xlim(), ax.get_ylim()))
    for line in ax.lines:
        if line.get_linestyle() != "None" or line.get_transform() != ax.transData:
            continue
        x, y = np.asarray(line.get_xydata(), dtype=float).T
        inside = (x >= left) & (x <= right) & (y >= bottom) & (y <= top)
        if inside.any():  # without a point, an unclipped line has an extent at the page's corner
            line.set_data(x, np.where(inside, y, np.nan))
            line.set_clip_on(False)


def mark_cases(axes: Sequence[Axes], places: Mapping[str, float], height: float = 0.0) -> None:
    """Mark the paper's cases by lines, named in the first panel: left of the first line, right of
    the next."""
    side = -2
    for case, x in places.items():
        for ax in axes:
            ax.axvline(x, color=BLACK, linewidth=wide(0.6), linestyle=(0, (1, 2)), zorder=0)
        place = ("data", "axes fraction")
        say(axes[0], case, (x, height), (side, 2), xycoords=place, fontsize=large(7))
        side = -side


def mark_printed(ax: Axes, time: float) -> None:
    """Mark a time that the paper prints, at the lower edge of a panel that shows it, in room made
    for it."""
    low, high = ax.get_xlim()
    if not low <= time <= high:
        return
    bottom, top = ax.get_ylim()
    ax.set_ylim(bottom - 0.13 * (top - bottom), top)
    ax.plot(
        [time],
        [0],
        transform=ax.get_xaxis_transform(),
        clip_on=False,
        marker="^",
        c=PAPER,
        mec=BLACK,
        ms=6,
        zorder=6,
    )
    say(
        ax,
        f"paper: {time:g} s",
        (time, 0),
        (-6, 4),
        path_effects=halo(),
        xycoords=("data", "axes fraction"),
        fontsize=large(6),
    )


def mark_failed(
    ax: Axes, values: np.ndarray, on: Literal["x", "y"] = "x", name: str = "failed"
) -> None:
    """Mark failed points by crosses beside an axis; nothing if there are none."""
    if not values.size:
        return
    look: dict[str, Any] = {"color": BLACK, "markersize": mark(3.5), "clip_on": False}
    edge = np.full(values.shape, 0.02)
    if on == "x":
        ax.plot(values, edge, "x", transform=ax.get_xaxis_transform(), label=name, **look)
    else:
        ax.plot(edge, values, "x", transform=ax.get_yaxis_transform(), label=name, **look)


# ---- Words


def say(
    ax: Axes, text: str, point: tuple[float, float], offset: tuple[float, float], **look: Any
) -> Any:
    """Write a few words beside a point, on the side to which an offset in points leads; returns the
    text."""
    ha, va = side_of(offset)
    return ax.annotate(text, point, xytext=offset, textcoords="offset points", ha=ha, va=va, **look)


def side_of(offset: tuple[float, float]) -> tuple[Any, Any]:
    """The horizontal and vertical alignment of a text on the side of a point to which an offset
    leads."""
    across, up = np.sign(offset)
    ha = {-1: "right", 0: "center", 1: "left"}[across]
    va = {-1: "top", 0: "center", 1: "bottom"}[up]
    return ha, va


def say_beside(ax: Axes, height: float, text: str, gap: float = 2, **look: Any) -> None:
    """Write a line's name at its right end, outside the panel, after a gap in points."""
    say(ax, text, (1, height), (gap, 0), xycoords=("axes fraction", "data"), **look)


def letter(ax: Axes, text: str, title: str = "", **look: Any) -> None:
    """Write a panel's letter above its upper left corner, and its subject."""
    ax.set_title(f"({text}) {title}".strip(), loc="left", **look)


def letters(axes: Sequence[Axes] | np.ndarray, titles: Iterable[str] = (), **look: Any) -> None:
    """Write the letters of panels, and the subjects of the first ones; a single panel has no
    letter."""
    subjects = chain(titles, repeat(""))
    if len(axes) == 1:
        axes[0].set_title(next(subjects), loc="left", **look)
        return
    for ax, text, title in zip(axes, "abcdefghijkl", subjects, strict=False):
        letter(ax, text, title, **look)


def set_label(ax: Axes, along: Literal["x", "y"], variable: xr.DataArray) -> None:
    """Label an axis by the variable that is drawn along it."""
    getattr(ax, f"set_{along}label")(measured(variable).label)


def parents_of_bar(axes: Sequence[Axes]) -> Any:
    """The axes that make room for a bar of colours. Alone, they share their cell with it, so that
    `tight_layout` knows of both."""
    if len(axes) == 1:
        return axes[0]
    return list(axes)
