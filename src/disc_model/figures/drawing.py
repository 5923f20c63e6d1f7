"""Style of all figures and what several of them draw: colours, sizes, panels, labels and marks.

Widths of lines, sizes of text and of marks follow the settings of matplotlib in force: those of the
common style, or of a reader who brings own axes.
"""

import json
import logging
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from itertools import chain, repeat
from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import matplotlib.figure
import matplotlib.style
import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

from disc_model.data.variables import SHOWN, axis_of, typeset
from disc_model.figures.sizes import PAGE
from disc_model.figures.words import UNITS, measured

# the reports of fontTools on fonts would fill the logs of figures
logging.getLogger("fontTools").setLevel(logging.WARNING)

STYLE = Path(__file__).with_name("drawing.mplstyle")

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


def styled() -> AbstractContextManager[None]:
    """The common style instead of the user's settings, as a context."""
    return mpl.style.context(STYLE, after_reset=True)


def readers_style() -> AbstractContextManager[None]:
    """The common style where the reader's settings are those of matplotlib, as a context: what the
    reader has set stays."""
    style = mpl.rc_params_from_file(STYLE, use_default_template=False)
    free = {
        name: value
        for name, value in style.items()
        if mpl.rcParams[name] == mpl.rcParamsDefault[name]
    }
    return mpl.rc_context(free)


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


def save(figure: Figure, path: str | Path, title: str = "") -> None:
    """Write a figure with its title; equal figures give equal bytes. Further files have the layout
    of the first."""
    stamps = {".pdf": "CreationDate"}
    metadata: dict[str, Any] = {stamps.get(Path(path).suffix, "Software"): None}
    if title:
        metadata["Title"] = title
    with styled():
        figure.savefig(path, metadata=metadata)
        figure.set_layout_engine(None)  # not "none", with which all is drawn twice


def restate_axes(figure: Figure) -> None:
    """Give axes in the units of the reader: their labels and ticks; what is drawn stays."""
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            for name, (unit, factor) in UNITS.get().items():
                shown = SHOWN[name]
                text = axis.get_label_text()
                known = typeset(f"{shown.name} {shown.symbol}".strip())
                if text.startswith(known) and text.endswith(f"({shown.unit})"):
                    axis.set_label_text(text.removesuffix(f"({shown.unit})") + f"({unit})")
                    _set_ticks(axis, factor / shown.factor)


def _set_ticks(axis: Any, ratio: float) -> None:
    """Set ticks at round numbers of another unit, `ratio` of which are one of the axis's."""
    ticks = np.asarray(DECADES)
    if axis.get_scale() == "linear":
        low, high = ratio * np.asarray(axis.get_view_interval())
        ticks = np.asarray(MaxNLocator(7, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    axis.set_major_locator(FixedLocator((ticks / ratio).tolist()))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value * ratio:.6g}"))


# ---- Samples of a legend, and outlines


def sample(**look: Any) -> Artist:
    """A line or mark for a legend."""
    return Line2D([], [], **look)


def halo(width: float = 1.5, colour: str = "white") -> list[Any]:
    """An outline of text, lines or marks; width in points, that of what it surrounds included."""
    return [withStroke(linewidth=width, foreground=colour)]


def border(kind: str) -> dict[str, Any]:
    """Look of the line of a stability chart, of "neutral" or "fold"."""
    look = dict(BORDERS[kind])
    look["linewidth"] = wide(look["linewidth"])
    return look


# ---- Sampled variables of a case

NO_BREAK = "\N{NO-BREAK SPACE}"


def sampled(name: str, *windows: xr.Dataset) -> tuple[str, float, str]:
    """Axis label of a sampled variable, with the angle of the disc's fixed point, factor to its
    unit, and colour."""
    where = ""
    if name.startswith("w_point"):
        angles = {float(window.attrs["theta"]) for window in windows if "theta" in window.attrs}
        shown = " and ".join(f"{angle:g}" for angle in sorted(angles))
        angle_text = rf"$\theta$ = {shown} rad".replace(" ", NO_BREAK)
        where = f", {angle_text}"
    label, factor = axis_of(name, where)
    colour = SLIDER
    if name == "P":
        colour = FORCE
    elif name.partition("_")[0] == "w":
        colour = DISC
    return label, factor, colour


def envelope(ax: Axes, ranges: xr.Dataset, name: str, color: str = "", label: str = "") -> None:
    """Draw the range of a variable against time, as a band that stays visible where it is thin."""
    time = ranges["time"].values
    _, factor, usual_colour = sampled(name)
    low, high = (ranges[f"{name}_{end}"].values * factor for end in ("min", "max"))
    ax.fill_between(time, low, high, color=color or usual_colour, linewidth=0.5, label=label)
    bin_width = time[-1] - time[-2]
    ax.set_xlim(0, round(time[-1] + bin_width / 2, 2))


def show(ax: Axes, case: xr.DataTree, window: xr.Dataset, name: str, *, named: bool = True) -> None:
    """Draw a variable against time, as a line or as ranges, and mark the first separation, with its
    time if `named`."""
    label, factor, colour = sampled(name, window)
    if f"{name}_min" in window:
        envelope(ax, window, name)
    else:
        values = window[name].values * factor
        ax.plot(window["time"], values, color=colour, linewidth=wide(0.6))
        ax.set_xlim(*window["time"].values[[0, -1]])
    ax.set_xlabel("Time (s)")
    ax.set_ylabel(label)
    mark_first_separation(ax, case, named=named)


# ---- Marks

ABOVE = 1.04  # height of a bar above a panel, as a share of it,
RIGHT = 1.02  # and place of one beside it


def headroom(ax: Axes, share: float) -> None:
    """Leave room above the data, a fraction of their height."""
    low, high = ax.get_ylim()
    ax.set_ylim(top=high + share * (high - low))


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


def show_thickness(ax: Axes, case: xr.DataTree, along: Literal["x", "y"]) -> None:
    """Draw a bar as long as the disc is thick, beside a panel whose axis is a displacement in mm,
    if it finds room."""
    thickness = json.loads(case.attrs.get("parameters", "{}")).get("h")
    if not thickness:
        return
    low, high = {"x": ax.get_xlim, "y": ax.get_ylim}[along]()
    share = 1e3 * thickness / (high - low)
    if share > 0.8:
        return
    start: tuple[float, float] = (RIGHT, 0)
    end: tuple[float, float] = (RIGHT, share)
    offset = (3, 1)
    rotation = 90
    if along == "x":
        start = (1 - share, ABOVE)
        end = (1, ABOVE)
        offset = (-3, 0)
        rotation = 0
    ax.plot(
        *zip(start, end, strict=True),
        color=BLACK,
        linewidth=2.5,
        solid_capstyle="butt",
        transform=ax.transAxes,
        clip_on=False,
    )
    say(
        ax,
        f"thickness {1e3 * thickness:g} mm",
        start,
        offset,
        xycoords="axes fraction",
        fontsize=large(6),
        rotation=rotation,
    )


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


def mark_first_separation(ax: Axes, case: xr.DataTree, *, named: bool = True, **look: Any) -> None:
    """Mark the first separation by a line with its time above it; nothing if the time shown has
    none."""
    time = float(case["first_separation"])
    low, high = ax.get_xlim()
    if not low <= time <= high:
        return
    usual: dict[str, Any] = {"color": SEPARATED, "linewidth": wide(0.8), "linestyle": (0, (4, 2))}
    usual.update(look)
    ax.axvline(time, **usual)
    if named:
        say(
            ax,
            f"first separation {time:.2f} s",
            (time, 1),
            (0, 2),
            color=SEPARATED,
            xycoords=("data", "axes fraction"),
            fontsize=large(7),
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
    across, up = np.sign(offset)
    ha = {-1: "right", 0: "center", 1: "left"}[across]
    va = {-1: "top", 0: "center", 1: "bottom"}[up]
    return ax.annotate(text, point, xytext=offset, textcoords="offset points", ha=ha, va=va, **look)


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
