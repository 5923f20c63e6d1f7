"""Five ways to draw on axes: classes and numbers over two dimensions, lines, points, and stacked
shares; and the figures around them.

What they draw is `shown`. Each artist has its name as its label, and a legend is what has a label.
"""

import logging
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from itertools import cycle
from pathlib import Path as File
from string import ascii_lowercase
from textwrap import fill
from typing import Any

import matplotlib as mpl
import matplotlib.style
import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.cbook import normalize_kwargs
from matplotlib.colors import AsinhNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.ticker import LogLocator
from matplotlib.transforms import Bbox
from numpy.lib.stride_tricks import sliding_window_view
from xarray import DataArray, Dataset

from disc_model.arrays import Array
from disc_model.figures.looks import BLACK, GREY, LOOKS, UNRESOLVED, Look, Options, looks_of
from disc_model.figures.shown import label, value_text, words

COLUMN = 3.307  # width of a figure of one column, inch
PAGE = 6.85  # of a page
# the reports of fontTools on fonts would fill the logs of figures
logging.getLogger("fontTools").setLevel(logging.WARNING)
STYLE = File(__file__).with_name("style.mplstyle")
BAR = "<colorbar>"  # what matplotlib calls the axes of a bar of colours
LETTERS_PER_INCH = 17.0  # of a legend
LINE_HEIGHT = 0.15  # of a legend, inch
LARGEST_RATE = 0.3  # growth rate at which colours end, 1/s, unless most are larger
COMMON = 0.98  # share of rates within the colours then: a few large ones would pale the others
SMALL = 0.2  # share of common axes below which a panel keeps its own
LINEAR_RATE = 0.1  # up to which an axis of growth rates is linear, 1/s
TICKS_OF_RATES = np.array([-1, -1 / 3, -0.1, 0, 0.1, 1 / 3, 1])  # over the end of the scale
MOST_MARKS = 12  # on one line of several
NO_LOOKS: dict[str, Look] = {}
Place = tuple[float, float, float, float]
SIDES = ("right", "left")  # of lines, for their names
NOTE: Options = {"textcoords": "offset points", "fontsize": 7}
# places of crosses, share of a panel
LOWER = 0.015
UPPER = 0.985
BELOW_ANY = "−∞, below any number"


def styled() -> AbstractContextManager[None]:
    """The style of all figures of studies, in place of a reader's settings, as a context."""
    return mpl.style.context(STYLE, after_reset=True)


# ---- Figures


def panels(
    layout: Any, width: float = PAGE, height: float = 2.4, **options: Any
) -> tuple[Figure, dict[str, Axes]]:
    """A figure outside pyplot, and its panels by name, as `Figure.subplot_mosaic` lays them out.

    width : of the figure, inch
    height : of a row of panels, inch
    options : of `Figure.subplot_mosaic`, such as ``sharex``
    """
    rows = len(options.get("height_ratios", layout))
    figure = Figure(figsize=(width, height * rows), layout="constrained")
    return figure, figure.subplot_mosaic(layout, **options)


def finish(figure: Figure, title: str = "") -> Figure:
    """Letter the panels of a figure, and explain below them whatever has a label."""
    axes = [ax for ax in figure.axes if ax.get_label() != BAR]
    for ax, letter in zip(axes, ascii_lowercase, strict=False):
        text = ax.get_title(loc="left").replace(" = ", "\u00a0=\u00a0")
        if len(axes) > 1:
            text = f"({letter}) {text}".strip()
        width, height = ax.get_position().size * figure.get_size_inches()
        ax.set_title(fill(text, int(LETTERS_PER_INCH * 1.1 * width)))
        break_label(ax, 1.3 * height)  # before layout, panels have much room between them
    explain(figure, axes)
    if title:
        figure.suptitle(fill(title, int(LETTERS_PER_INCH * figure.get_figwidth())))
    return figure


def break_label(ax: Axes, height: float) -> None:
    """Break the label of a vertical axis that is longer than its panel."""
    ax.set_ylabel(fill(ax.get_ylabel(), int(13 * height)))


def entries(axes: Iterable[Axes]) -> Options:
    """What has a label on axes, by its label: the first of each."""
    found: Options = {}
    for ax in axes:
        insets = [each for each in ax.child_axes if isinstance(each, Axes)]
        for each in (ax, *insets):
            for handle, text in zip(*each.get_legend_handles_labels(), strict=True):
                found.setdefault(fill(text, 42), handle)
    return found


def explain(figure: Any, axes: Iterable[Axes], letters: float = LETTERS_PER_INCH) -> None:
    """A legend below the panels, with an entry for each label, and room for it.

    letters : of the legend in an inch
    """
    handles = entries(axes)
    if not handles:
        return
    texts = "\n".join(handles).split("\n")
    room = letters * figure.get_figwidth() / (6 + max(map(len, texts)))
    columns = int(np.clip(room, 1, min(4, len(handles))))
    figure.set_figheight(figure.get_figheight() + LINE_HEIGHT * -(-len(texts) // columns))
    below = "outside lower center"
    legend = figure.legend(handles.values(), handles.keys(), loc=below, ncols=columns)
    for sample in legend.get_patches():
        if not sample.get_hatch():  # white areas would not be seen
            sample.set(edgecolor=GREY, linewidth=0.4)


def each_value(data: Any, by: str) -> list[tuple[str, Any]]:
    """The parts of a dataset or array along a dimension, with what each is called; all of it if it
    does not vary along that."""
    if by not in data.dims:
        return [("", data)]
    return [(value_text(data[by][i]), data.isel({by: i})) for i in range(data.sizes[by])]


def threshold(ax: Axes, places: Mapping[str, float], others: Sequence[Axes] = ()) -> None:
    """Named lines at places across, such as cases of the paper.

    others : panels that have the same lines, without names
    """
    for (name, x), side in zip(places.items(), cycle(SIDES), strict=False):
        for panel in (ax, *others):
            panel.axvline(x, color=BLACK, lw=0.6, ls=":", zorder=0)
        ax.text(x, 0.02, f" {name} ", transform=ax.get_xaxis_transform(), ha=side, fontsize=7)


def compare(axes: Sequence[Axes]) -> None:
    """Give panels the same limits, but for those that would be small by them: these say how much
    they are enlarged."""
    whole = Bbox.union([ax.viewLim for ax in axes])
    for ax in axes:
        width = ax.viewLim.width / whole.width
        if max(width, ax.viewLim.height / whole.height) >= SMALL:
            ax.set(xlim=whole.intervalx, ylim=whole.intervaly)
        else:
            ax.set_title(f"enlarged {1 / width:.0f} times, {ax.get_title(loc='left')}")


# ---- Maps


def is_geometric(values: Array) -> bool:
    """Whether three or more positive values, over a decade or more, have equal ratios, but for a few
    extra ones."""
    if values.size < 3 or values.min() <= 0 or values.max() < 9.99 * values.min():
        return False
    steps = np.diff(np.log(values))
    return bool(np.isclose(steps, np.median(steps), rtol=1e-6).mean() > 0.75)


def edges(x: DataArray) -> Any:
    """Edges of cells halfway between values, in their ratio where these are equal."""
    values = np.atleast_1d(x.values.astype(float))
    if is_geometric(values):
        return np.exp(_between(np.log(values)))
    return _between(values)


def _between(values: Array) -> Any:
    """Middles between values, and ends as far outside as these are inside."""
    if values.size == 1:
        return values + (0.05 * np.abs(values) or 1.0) * np.array([-1, 1])
    around = np.pad(values, 1, mode="reflect", reflect_type="odd")
    return (around[1:] + around[:-1]) / 2


def cells(ax: Axes, plane: DataArray, mask: Any, look: Look) -> None:
    """Paint the cells of a mask of the shape of a plane, of dimensions (up, across)."""
    row, column = np.nonzero(np.asarray(mask))
    if not row.size:
        return
    up, across = (edges(plane[str(dim)]) for dim in plane.dims)
    corners = (across[column[:, None] + [0, 1, 1, 0]], up[row[:, None] + [0, 0, 1, 1]])
    outline = Path.make_compound_path_from_polys(np.stack(corners, axis=-1))
    paint = {**look.paint, "antialiased": False, "rasterized": not look.hatch}
    ax.add_artist(PathPatch(outline, lw=0, **paint))


def class_map(ax: Axes, flag: DataArray, looks: Mapping[str, Look] = NO_LOOKS) -> None:
    """A map of words, with its labels and limits, see `paint`."""
    paint(ax, flag, looks)
    frame(ax, flag)


def paint(ax: Axes, flag: DataArray, looks: Mapping[str, Look] = NO_LOOKS) -> None:
    """Paint each cell in the look of its word, and none where that is "".

    flag : words, shape (up, across)
    looks : of words, beside those of `LOOKS`
    """
    said = words(flag)
    for word, look in looks_of(said[said != ""]).items():
        cells(ax, flag, said == word, looks.get(word, look))


def strip(ax: Axes, flag: DataArray, place: Place = (0, 0, 1, 1)) -> None:
    """Paint words along the horizontal axis behind a panel, or over a part of it, and nothing where
    they are "".

    flag : words, shape (x,)
    place : left, lower end, width and height, shares of the panel
    """
    inside = ax.inset_axes(place, sharex=ax, zorder=0)
    paint(inside, flag.expand_dims(row=[0.0]))
    inside.set_ylim(-1, 1)
    inside.set_axis_off()


def number_map(ax: Axes, x: DataArray, missing: DataArray | None = None, **colours: Any) -> Any:
    """Paint numbers in colours, and points without one in the look of their class.

    x : numbers, shape (up, across)
    missing : words of the points without a number; "no_value" if there are none
    colours : `growth_colours` or `usual_colours`

    Returns the mesh, for a bar.
    """
    up, across = (edges(x[str(dim)]) for dim in x.dims)
    finite = np.isfinite(x)
    mesh = ax.pcolormesh(across, up, x.where(finite), rasterized=True, **colours)
    gaps = np.where(finite, "", "no_value" if missing is None else missing)
    no_value = LOOKS["no_value"]._replace(label=missing_text(x))
    class_map(ax, x.copy(data=gaps), {"no_value": no_value})
    return mesh


def missing_text(x: DataArray) -> str:
    """What a legend says of points without a value."""
    why = x.attrs.get("missing", "")
    return f"no value: {why}" if why else "no value"


def lone_cells(flag: DataArray) -> DataArray:
    """Single cells of a class between two of another one, along or across: it is narrower than the
    cells."""
    alone = xr.zeros_like(flag, dtype=bool)
    for dim in flag.dims:
        before = flag.shift({dim: 1})
        after = flag.shift({dim: -1})
        alone |= (before == after) & (flag != before)
    return alone & flag.notnull() & ~flag.isin(["", "excluded"])


def around(area: DataArray) -> DataArray:
    """An area of a map with the cells beside it, without parts that are one cell wide."""
    blocks = sliding_window_view(np.pad(area, 1, mode="edge"), (2, 2)).all((-2, -1))
    near = sliding_window_view(np.pad(blocks, 1), (4, 4)).any((-2, -1))
    return area.copy(data=near)


def unresolved(ax: Axes, flag: DataArray) -> None:
    """Hatch cells of classes that are narrower than cells."""
    cells(ax, flag, lone_cells(flag), UNRESOLVED)


def growth_colours(rate: DataArray) -> Options:
    """Colours of growth rates: neutral at zero, and nearly logarithmic beyond a thirtieth of the
    end of the scale."""
    sizes = np.abs(finite_of(rate))
    end = LARGEST_RATE
    if sizes.size and np.median(sizes) > LARGEST_RATE:
        end = float(np.quantile(sizes, COMMON))
    return {"cmap": cm.vik, "norm": AsinhNorm(end / 30, -end, end)}


def usual_colours(x: DataArray) -> Options:
    """Colours of other numbers, around zero if they have both signs."""
    values = finite_of(x)
    low = 0.1
    high = 1.0
    if values.size:
        low = values.min()
        high = values.max()
    if low < 0 < high:
        high = max(-low, high)
        return {"cmap": cm.vik, "norm": Normalize(-high, high)}
    return {"cmap": cm.batlow, "norm": Normalize(low, high)}


def finite_of(x: DataArray) -> Array:
    """The finite numbers of an array, shape (n,)."""
    values = x.values.astype(float)
    return values[np.isfinite(values)]


def colours_of(x: DataArray) -> Options:
    """Colours of any numbers; none of words."""
    if is_words(x):
        return {}
    if is_rate(x):
        return growth_colours(x)
    return usual_colours(x)


def is_rate(x: DataArray) -> bool:
    """Whether these are growth rates."""
    return str(x.name).endswith("growth_rate")


def bar_of(figure: Any, axes: Any, mesh: Any, x: DataArray) -> None:
    """The bar of colours beside panels; its ends are open where numbers lie beyond them."""
    norm = mesh.norm
    beyond = int((x < norm.vmin).any()) + 2 * int((x > norm.vmax).any())
    ends = ("neither", "min", "max", "both")[beyond]
    bar = figure.colorbar(mesh, ax=axes, label=fill(label(x), 38), extend=ends, pad=0.01)
    if isinstance(norm, AsinhNorm):  # its own ticks meet at zero
        bar.set_ticks(norm.vmax * TICKS_OF_RATES)
        bar.ax.yaxis.set_major_formatter("{x:.2g}")
        bar.minorticks_off()


def sign_changes(ax: Axes, rate: DataArray, name: str) -> None:
    """The line at which a rate changes its sign between cells, of dimensions (up, across)."""
    if min(rate.shape) > 1 and rate.min() < 0 < rate.max():
        up, across = (rate[str(dim)] for dim in rate.dims)
        ax.contour(across, up, rate, [0], colors=BLACK, linewidths=0.8)
        ax.plot([], [], color=BLACK, label=name)


def frame(ax: Axes, plane: DataArray) -> None:
    """Labels, scales and limits of a map of dimensions (up, across)."""
    up, across = (plane[str(dim)] for dim in plane.dims)
    scale(ax.yaxis, up)
    scale(ax.xaxis, across)
    ax.set(ylim=edges(up)[[0, -1]], xlim=edges(across)[[0, -1]])
    if len(ax.get_shared_y_axes().get_siblings(ax)) > 1:
        ax.label_outer()


def scale(axis: Any, x: DataArray) -> None:
    """Label an axis, and make it logarithmic, with plain numbers, if the ratios of values are equal."""
    axis.set_label_text(label(x))
    if not is_words(x) and is_geometric(x.values):
        axis.axes.set(**{f"{axis.axis_name}scale": "log"})
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("")


# ---- Lines and points


def wished(look: Mapping[str, Any], **usual: Any) -> Options:
    """Options of a line: usual ones, and in their place a reader's, by any name that matplotlib has
    for them."""
    return {**usual, **normalize_kwargs(dict(look), Line2D)}


def is_words(x: DataArray) -> bool:
    """Whether an array has words, or other objects, in place of numbers."""
    return x.dtype.kind in "OUST"


def places(axis: Any, x: DataArray) -> Array:
    """The places of numbers, or of words, along an axis; nan for ""."""
    if not is_words(x):
        return x.values.astype(float)
    said = words(x)
    found = np.full(said.shape, np.nan)
    axis.update_units(said[said != ""])
    found[said != ""] = axis.convert_units(said[said != ""])
    return found


def lines(
    ax: Axes,
    y: DataArray,
    x: str,
    *,
    doubtful: DataArray | None = None,
    doubt: str = "not settled",
    missing: str | None = None,
    edge: float = LOWER,
    jump: float = np.inf,
    **look: Any,
) -> None:
    """A line along a dimension, for each value of the other one if there is one: hollow marks where
    a value is in doubt, and along an edge crosses where there is none, and triangles where it is
    below any number. Words are marks at places of their own, which no line joins.

    doubtful : of the dimensions of `y`
    missing : what the legend says of crosses; "" for no crosses
    edge : `LOWER` or `UPPER`, where these are
    jump : step of asinh(y / 0.1) beyond which the line is open, as where a cycle may be another one
    look : options of matplotlib
    """
    by = next((str(dim) for dim in y.dims if dim != x), "")
    unsure = xr.zeros_like(y, dtype=bool) if doubtful is None else doubtful
    parts = each_value(Dataset({"drawn": y, "unsure": unsure}), by)
    why = missing_text(y) if missing is None else missing
    if is_words(y) or is_words(y[x]):
        look = wished(look) | {"linestyle": ""}
    drawn = []
    joined = by and wished(look).get("linestyle") != ""
    every = max(1, y.sizes[x] // MOST_MARKS) if joined else 1
    for (name, part), marker in zip(parts, cycle("os^Dv<>ph"), strict=False):
        points = places(ax.xaxis, part[x]), places(ax.yaxis, part["drawn"])
        own = wished(look, marker=marker, label=name, markersize=3, markevery=every)
        drawn.append((*ax.plot(*opened(*points, jump), **own), *points, part["unsure"].values))
    for line, across, up, hollow in drawn:  # after all lines in the legend
        same = {"color": line.get_color(), "marker": line.get_marker()}
        mark_points(ax, across[hollow], up[hollow], f"hollow: {doubt}", **same)
        below = np.isneginf(up)
        mark_missing(ax, across[below], BELOW_ANY, line.get_color(), marker="v")
        if why:
            gone = across[~np.isfinite(up) & ~below]
            mark_missing(ax, gone, why, line.get_color(), edge=edge)
    scale(ax.xaxis, y[x])
    ax.set_ylabel(label(y))


def opened(x: Any, y: Any, jump: float) -> Any:
    """A line of finite numbers that is open at each step of asinh(y / 0.1) beyond some size."""
    finite = np.where(np.isfinite(y), y, np.nan)
    steps = np.abs(np.diff(np.arcsinh(finite / LINEAR_RATE)))
    breaks = np.flatnonzero(steps > jump) + 1
    return np.insert(x, breaks, np.nan), np.insert(finite, breaks, np.nan)


def one_line(x: DataArray, y: DataArray) -> list[Array]:
    """Several lines as one that is open between them, which is drawn faster.

    x, y : shape (line, point); `x` may have the same dimensions in another order, or less
    """
    ends = ((0, 0), (0, 1))
    lines = (each.values for each in (x.broadcast_like(y).transpose(*y.dims), y))
    return [np.pad(each, ends, constant_values=np.nan).ravel() for each in lines]


def mark_points(ax: Axes, x: Any, y: Any, name: str, **look: Any) -> None:
    """Hollow marks at points, which no line joins; nothing without a point.

    x : of the first dimensions of `y`, or as these
    """
    across = np.asarray(x, dtype=float)
    heights = np.asarray(y, dtype=float)
    places = across.reshape(across.shape + (1,) * (heights.ndim - across.ndim))
    known = np.isfinite(heights)
    if known.any():
        own = wished(look, label=name, linestyle="", markerfacecolor="white", zorder=3)
        ax.plot(np.broadcast_to(places, heights.shape)[known], heights[known], **own)


def mark_missing(
    ax: Axes, x: Any, why: str, colour: Any = BLACK, marker: str = "x", edge: float = LOWER
) -> None:
    """Crosses along the lower edge of a panel at points without a value, or along the upper one."""
    look = {"marker": marker, "color": colour, "mfc": colour, "clip_on": False}
    heights = np.full(np.shape(x), edge)
    mark_points(ax, x, heights, why, transform=ax.get_xaxis_transform(), **look)


def rate_axis(ax: Axes, linear: float = LINEAR_RATE) -> None:
    """The scale of growth rates, with a line at zero: linear up to some rate, and logarithmic beyond
    if some are three times as large.

    linear : 1/s
    """
    if np.abs(ax.dataLim.intervaly).max() > LARGEST_RATE / LINEAR_RATE * linear:
        ax.set_yscale("symlog", linthresh=linear, subs=range(2, 10))
        ax.yaxis.set_major_formatter("{x:g}")
    ax.axhline(0, color=GREY, zorder=0)


# ---- Shares


def shares(ax: Axes, x: DataArray, fractions: DataArray, classes: str) -> None:
    """Stacked shares of classes in their order, a bar at each value along a dimension.

    fractions : shape (x, classes)
    classes : the dimension of words
    """
    sides = edges(x)
    bottom = np.zeros(x.size)
    looks = looks_of(fractions[classes].values)
    for word in fractions[classes].values:
        share = fractions.sel({classes: word}).values
        if share.any():
            ax.bar(sides[:-1], share, np.diff(sides), bottom, align="edge", **looks[word].paint)
            bottom = bottom + share
    ax.set(xlabel=label(x), ylim=(0, 1), xlim=sides[[0, -1]])
