"""Five ways to draw on axes: classes and numbers over two dimensions, lines, points, and stacked
shares; and the figures around them.

What they draw is `shown`. Each artist has its name as its label, and a legend is what has a label.
"""

import logging
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path as File
from textwrap import fill
from typing import Any

import matplotlib as mpl
import matplotlib.style
import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.cbook import normalize_kwargs
from matplotlib.colors import AsinhNorm, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import LogLocator
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from disc_model.figures.looks import BLACK, GREY, LOOKS, UNRESOLVED, Look, looks_of
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


def panels_of(figure: Figure) -> list[Axes]:
    """The panels of a figure, without bars of colours."""
    return [ax for ax in figure.axes if ax.get_label() != BAR]


def finish(figure: Figure, title: str = "") -> Figure:
    """Letter the panels of a figure, and explain below them whatever has a label."""
    axes = panels_of(figure)
    for ax, letter in zip(axes, "abcdefghijklmnopqrstuvwxyz", strict=False):
        text = ax.get_title(loc="left").replace(" = ", "\u00a0=\u00a0")
        if len(axes) > 1:
            text = f"({letter}) {text}".strip()
        width, height = _size_of(ax, figure)
        ax.set_title(fill(text, max(12, int(LETTERS_PER_INCH * 0.85 * width))))
        break_label(ax, height)
    explain(figure, axes)
    if title:
        figure.suptitle(fill(title, int(LETTERS_PER_INCH * figure.get_figwidth())))
    figure.align_ylabels()
    return figure


def _size_of(ax: Axes, figure: Figure) -> tuple[float, float]:
    """Width and height of the part of a grid that a panel has, inch."""
    spec = ax.get_subplotspec()
    width, height = figure.get_size_inches()
    if spec is None:
        return float(width), float(height)
    grid = spec.get_gridspec()
    columns, rows = np.ones(grid.ncols), np.ones(grid.nrows)
    columns[:], rows[:] = grid.get_width_ratios(), grid.get_height_ratios()
    across = columns[spec.colspan.start : spec.colspan.stop].sum() / columns.sum()
    up = rows[spec.rowspan.start : spec.rowspan.stop].sum() / rows.sum()
    return float(width * across), float(height * up)


def break_label(ax: Axes, height: float) -> None:
    """Break the label of a vertical axis that is longer than its panel, but not within its unit."""
    name, has_unit, unit = ax.get_ylabel().partition(" (")
    kept = f" ({unit.replace(' ', chr(0xA0))}" if has_unit else ""
    ax.set_ylabel(fill(name + kept, max(12, int(13 * height))))


def explain(figure: Any, axes: Sequence[Axes], letters: float = LETTERS_PER_INCH) -> None:
    """A legend below the panels, with an entry for each label, and room for it.

    letters : of the legend in an inch
    """
    handles: dict[str, Any] = {}
    for ax in axes:
        for handle, text in zip(*ax.get_legend_handles_labels(), strict=True):
            handles.setdefault(fill(text, 42), handle)
    if not handles:
        return
    lines = [line for text in handles for line in text.split("\n")]
    room = letters * figure.get_figwidth()
    columns = max(1, min(4, len(handles), int(room // (6 + max(map(len, lines))))))
    rows = -(-len(lines) // columns)
    figure.set_figheight(figure.get_figheight() + LINE_HEIGHT * rows)
    texts = [*handles]
    legend = figure.legend([*handles.values()], texts, loc="outside lower center", ncols=columns)
    for sample in legend.legend_handles:
        if isinstance(sample, Patch) and not sample.get_hatch():
            sample.set(edgecolor=GREY, linewidth=0.4)  # or white areas would not be seen


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
    sides = {"right": -2, "left": 2}
    for i, (name, x) in enumerate(places.items()):
        side = [*sides][i % 2]
        for panel in (ax, *others):
            panel.axvline(x, color=BLACK, lw=0.6, ls=":", zorder=0)
        at: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
        ax.annotate(name, (x, 0.02), (sides[side], 0), ha=side, fontsize=7, **at)


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


def is_geometric(values: NDArray[Any]) -> bool:
    """Whether three or more positive values, over a decade or more, have equal ratios, but for a few
    extra ones."""
    if values.size < 3 or values.min() <= 0 or values.max() < 9.99 * values.min():
        return False
    steps = np.diff(np.log(values))
    return bool(np.isclose(steps, np.median(steps), rtol=1e-6).mean() > 0.75)


def edges(x: xr.DataArray) -> NDArray[np.float64]:
    """Edges of cells halfway between values, in their ratio where these are equal."""
    values = np.atleast_1d(x.values.astype(float))
    if is_geometric(values):
        return np.exp(_between(np.log(values)))
    return _between(values)


def _between(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Middles between values, and ends as far outside as these are inside."""
    if values.size == 1:
        margin = 0.05 * abs(values[0]) or 1.0
        return np.array([values[0] - margin, values[0] + margin])
    middles = (values[1:] + values[:-1]) / 2
    first, last = 2 * values[0] - middles[0], 2 * values[-1] - middles[-1]
    return np.concatenate([[first], middles, [last]])


def cells(ax: Axes, plane: xr.DataArray, mask: NDArray[np.bool_], look: Look) -> None:
    """Paint the cells of a mask of the shape of a plane, of dimensions (up, across)."""
    if not mask.any():
        return
    up, across = (edges(plane[str(dim)]) for dim in plane.dims)
    row, column = np.nonzero(mask)
    corners = np.stack(
        [across[column[:, None] + [0, 1, 1, 0]], up[row[:, None] + [0, 0, 1, 1]]], axis=-1
    )
    outline = Path.make_compound_path_from_polys(corners)
    paint = {"fc": look.face, "hatch": look.hatch, "ec": look.ink if look.hatch else "none"}
    plain = {"antialiased": False, "rasterized": not look.hatch}
    ax.add_patch(PathPatch(outline, label=look.label, lw=0, **paint, **plain))


def class_map(ax: Axes, flag: xr.DataArray, looks: Mapping[str, Look] | None = None) -> None:
    """Paint each cell in the look of its word, and none where that is "".

    flag : words, shape (up, across)
    looks : of words, beside those of `LOOKS`
    """
    said = words(flag)
    for word, look in looks_of(np.unique(said[said != ""]).tolist()).items():
        cells(ax, flag, said == word, {word: look, **(looks or {})}[word])
    frame(ax, flag)


def strip(ax: Axes, flag: xr.DataArray, low: float = 0.0) -> None:
    """Paint words along the horizontal axis in a strip up to the top of a panel, and nothing where
    they are "".

    flag : words, shape (x,)
    low : lower edge of the strip, share of the panel
    """
    said, sides = words(flag), edges(flag[str(flag.dims[0])])
    for word, look in looks_of(np.unique(said[said != ""]).tolist()).items():
        ax.fill_between(
            np.repeat(sides, 2)[1:-1],
            low,
            1,
            np.repeat(said == word, 2),
            transform=ax.get_xaxis_transform(),
            fc=look.face,
            hatch=look.hatch,
            ec=look.ink if look.hatch else "none",
            label=look.label,
            zorder=0,
        )


def number_map(
    ax: Axes,
    x: xr.DataArray,
    missing: xr.DataArray | None = None,
    looks: Mapping[str, Look] | None = None,
    **colours: Any,
) -> Any:
    """Paint numbers in colours, and points without one in the look of their class.

    x : numbers, shape (up, across)
    missing : words of the points without a number; "no_value" if there are none
    colours : `growth_colours` or `usual_colours`

    Returns the mesh, for a bar.
    """
    across, up = edges(x[str(x.dims[1])]), edges(x[str(x.dims[0])])
    finite = np.isfinite(x.values.astype(float))
    mesh = ax.pcolormesh(across, up, x.where(finite), rasterized=True, **colours)
    if not finite.all():
        why = np.full(x.shape, "no_value", dtype=object) if missing is None else missing
        no_value = LOOKS["no_value"]._replace(label=missing_text(x))
        gaps = x.copy(data=np.where(finite, "", why))
        class_map(ax, gaps, {"no_value": no_value, **(looks or {})})
    frame(ax, x)
    return mesh


def missing_text(x: xr.DataArray) -> str:
    """What a legend says of points without a value."""
    why = x.attrs.get("missing", "")
    return f"no value: {why}" if why else "no value"


def lone_cells(flag: xr.DataArray) -> NDArray[np.bool_]:
    """Single cells of a class between two of another one, along or across: it is narrower than the
    cells."""
    said = words(flag)
    alone = np.zeros(said.shape, dtype=bool)
    for axis in (0, 1):
        turned, marked = np.moveaxis(said, axis, 0), np.moveaxis(alone, axis, 0)
        before, here, after = turned[:-2], turned[1:-1], turned[2:]
        marked[1:-1] |= (before == after) & (here != before)
    return alone & (said != "") & (said != "excluded")


def unresolved(ax: Axes, flag: xr.DataArray) -> None:
    """Hatch cells of classes that are narrower than cells."""
    cells(ax, flag, lone_cells(flag), UNRESOLVED)


def growth_colours(*rates: xr.DataArray) -> dict[str, Any]:
    """Colours of growth rates: neutral at zero, and nearly logarithmic beyond a thirtieth of the
    end of the scale."""
    sizes = np.abs(np.concatenate([each.values.ravel() for each in rates]))
    sizes = sizes[np.isfinite(sizes)]
    end = LARGEST_RATE
    if sizes.size and np.median(sizes) > LARGEST_RATE:
        end = float(np.quantile(sizes, COMMON))
    return {"cmap": cm.vik, "norm": AsinhNorm(end / 30, -end, end)}


def usual_colours(*arrays: xr.DataArray, log: bool = False) -> dict[str, Any]:
    """Colours of other numbers, around zero if they have both signs."""
    values = np.concatenate([np.asarray(each, dtype=float).ravel() for each in arrays])
    values = values[np.isfinite(values)]
    if log:
        values = values[values > 0]
    low, high = (values.min(), values.max()) if values.size else (0.1, 1.0)
    if log:
        return {"cmap": cm.batlow, "norm": LogNorm(low, high)}
    if low < 0 < high:
        end = max(-low, high)
        return {"cmap": cm.vik, "norm": Normalize(-end, end)}
    return {"cmap": cm.batlow, "norm": Normalize(low, high)}


def colours_of(x: xr.DataArray, *, log: bool = False) -> dict[str, Any]:
    """Colours of any numbers."""
    return growth_colours(x) if is_rate(x) and not log else usual_colours(x, log=log)


def is_rate(x: xr.DataArray) -> bool:
    """Whether these are growth rates."""
    return str(x.name).endswith("growth_rate")


def bar_of(figure: Any, axes: Any, mesh: Any, x: xr.DataArray) -> None:
    """The bar of colours beside panels; its ends are open where numbers lie beyond them."""
    low, high = bool((x < mesh.norm.vmin).any()), bool((x > mesh.norm.vmax).any())
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[low, high]
    bar = figure.colorbar(mesh, ax=axes, label=fill(label(x), 38), extend=extend, pad=0.01)
    if isinstance(mesh.norm, AsinhNorm):  # its own ticks meet at zero
        end = float(mesh.norm.vmax or 1)
        ticks = [sign * end / part for sign in (-1, 1) for part in (1, 3, 10)] + [0]
        texts = [f"{float(f'{tick:.1g}'):g}".replace("-", "−") for tick in ticks]
        bar.set_ticks(ticks, labels=texts)
        bar.minorticks_off()


def sign_changes(ax: Axes, rate: xr.DataArray, name: str) -> None:
    """The line at which a rate changes its sign between cells, of dimensions (up, across)."""
    if min(rate.shape) > 1 and bool((rate > 0).any()) and bool((rate < 0).any()):
        up, across = (rate[str(dim)] for dim in rate.dims)
        ax.contour(across, up, rate, [0], colors=BLACK, linewidths=0.8)
        ax.plot([], [], color=BLACK, lw=0.8, label=name)


def frame(ax: Axes, plane: xr.DataArray) -> None:
    """Labels, scales and limits of a map of dimensions (up, across)."""
    for letter, dim in zip("yx", plane.dims, strict=True):
        along = plane[str(dim)]
        ends = edges(along)[[0, -1]]
        ax.set(**{f"{letter}label": label(along), f"{letter}lim": tuple(ends)})
        if is_geometric(along.values):
            ax.set(**{f"{letter}scale": "log"})
            plain_numbers(getattr(ax, f"{letter}axis"))
    if len(ax.get_shared_y_axes().get_siblings(ax)) > 1:
        ax.label_outer()


def plain_numbers(axis: Any) -> None:
    """Plain numbers along a logarithmic axis."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter("")


# ---- Lines and points


def once(ax: Axes, text: str) -> str:
    """A label, or none if something on the axes has it already."""
    return "_nolegend_" if text in ax.get_legend_handles_labels()[1] else text


def wished(look: Mapping[str, Any], **usual: Any) -> dict[str, Any]:
    """Options of a line: usual ones, and in their place a reader's, by any name that matplotlib has
    for them."""
    return {**usual, **normalize_kwargs(dict(look), Line2D)}


def is_words(x: xr.DataArray) -> bool:
    """Whether an array has words, or other objects, in place of numbers."""
    return x.dtype.kind in "OUST"


def places(axis: Any, x: xr.DataArray) -> NDArray[np.float64]:
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
    y: xr.DataArray,
    x: str,
    *,
    doubtful: xr.DataArray | None = None,
    doubt: str = "not settled",
    missing: str | None = None,
    jump: float = np.inf,
    **look: Any,
) -> None:
    """A line along a dimension, for each value of the other one if there is one: hollow marks where
    a value is in doubt, and along the lower edge crosses where there is none, and triangles where it
    is below any number. Words are marks at places of their own, which no line joins.

    doubtful : of the dimensions of `y`
    missing : what the legend says of crosses; "" for no crosses
    jump : step of asinh(y / 0.1) beyond which the line is open, as where a cycle may be another one
    look : options of matplotlib
    """
    by = next((str(dim) for dim in y.dims if dim != x), "")
    none = xr.zeros_like(y, dtype=bool)
    hollow = each_value(none if doubtful is None else doubtful.transpose(*y.dims), by)
    markers = ["o", "s", "^", "D", "v", "<", ">", "p", "h"] * 9
    why = missing_text(y) if missing is None else missing
    drawn = []
    for (name, part), (_, unsure), marker in zip(each_value(y, by), hollow, markers, strict=False):
        along, values = places(ax.xaxis, part[x]), places(ax.yaxis, part)
        finite = np.where(np.isfinite(values), values, np.nan)
        breaks = np.flatnonzero(np.abs(np.diff(np.arcsinh(finite / 0.1))) > jump) + 1
        own = wished(look, marker=marker, label=name)
        if is_words(y) or is_words(y[x]):
            own["linestyle"] = ""
        [line] = ax.plot(np.insert(along, breaks, np.nan), np.insert(finite, breaks, np.nan), **own)
        drawn.append((line, along, values, unsure.values))
    for line, along, values, unsure in drawn:
        same = {"color": line.get_color(), "marker": line.get_marker()}
        mark_points(ax, along[unsure], values[unsure], f"hollow: {doubt}", **same)
        lowest = np.isneginf(values)
        mark_missing(ax, along[lowest], BELOW_ANY, line.get_color(), marker="v")
        if why:
            mark_missing(ax, along[~np.isfinite(values) & ~lowest], why, line.get_color())
    ax.set(xlabel=label(y[x]), ylabel=label(y))
    if not is_words(y[x]) and is_geometric(y[x].values):
        ax.set_xscale("log")
        plain_numbers(ax.xaxis)


def mark_points(ax: Axes, x: Any, y: Any, name: str, **look: Any) -> None:
    """Hollow marks at points, which no line joins; nothing without a point."""
    if np.isfinite(np.asarray(y, dtype=float)).any():
        own = {"label": once(ax, name), "linestyle": "", "markerfacecolor": "white", "zorder": 3}
        ax.plot(x, y, **wished(look, **own))


def mark_missing(
    ax: Axes, x: Any, why: str, colour: Any = BLACK, along: str = "x", marker: str = "x"
) -> None:
    """Crosses along the lower, or the left, edge of a panel at points without a value."""
    if not np.size(x):
        return
    places = [np.asarray(x, dtype=float), np.full(np.shape(x), 0.015)]
    to_page = ax.get_xaxis_transform() if along == "x" else ax.get_yaxis_transform()
    if along == "y":
        places.reverse()
    look = {"ls": "", "marker": marker, "ms": 3.5, "mew": 0.7, "color": colour, "clip_on": False}
    ax.plot(*places, transform=to_page, label=once(ax, why), **look)


def rate_axis(ax: Axes, linear: float = LINEAR_RATE) -> None:
    """The scale of growth rates, with a line at zero: linear up to some rate, and logarithmic beyond
    if some are three times as large.

    linear : 1/s
    """
    if np.abs(ax.dataLim.intervaly).max() > LARGEST_RATE / LINEAR_RATE * linear:
        ax.set_yscale("symlog", linthresh=linear, subs=range(2, 10))
        ax.yaxis.set_major_formatter("{x:g}")
    ax.axhline(0, color=GREY, lw=0.5, zorder=0)


# ---- Shares


def shares(ax: Axes, x: xr.DataArray, fractions: xr.DataArray, classes: str) -> None:
    """Stacked shares of classes in their order, a bar at each value along a dimension.

    fractions : shape (x, classes)
    classes : the dimension of words
    """
    sides, bottom = edges(x), np.zeros(x.size)
    names = [str(word) for word in fractions[classes].values]
    looks = looks_of(names)
    for word in names:
        look = looks[word]
        share = fractions.sel({classes: word}).values
        if not (share > 0).any():
            continue
        ink = look.ink if look.hatch else GREY
        paint: dict[str, Any] = {"fc": look.face, "hatch": look.hatch, "ec": ink}
        wide = np.diff(sides)
        ax.bar(sides[:-1], share, wide, bottom, align="edge", label=look.label, lw=0.4, **paint)
        bottom = bottom + share
    ax.set(xlabel=label(x), ylim=(0, 1), xlim=(sides[0], sides[-1]))


def wilson(hits: Any, n: Any, z: float = 1.96) -> tuple[Any, Any]:
    """Middle and half width of Wilson's interval of a share, of 95 %."""
    share = hits / n
    spread = np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
    return (share + z**2 / (2 * n)) / (1 + z**2 / n), z * spread / (1 + z**2 / n)
