"""Heat maps and curves: any variable of a grid study over any of its dimensions."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from textwrap import fill
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data.variables import EXCLUDED, flag_names, stated_in
from disc_model.errors import Fault, as_text, suggestion
from disc_model.figures import drawing
from disc_model.figures.cells import class_cells, edges_of, entries, looks_in, paint, scale_of
from disc_model.figures.classes import LOOKS, UNRESOLVED
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    PAGE,
    Artist,
    Axes,
    Figure,
    FigureBase,
    cm,
    mpl,
    panels,
)
from disc_model.figures.growth import growth_panels, is_growth
from disc_model.figures.kind import NORM, Plot, Values
from disc_model.figures.legends import figure_legend
from disc_model.units import UNITS, Finite, Unit

LINEAR = 0.1  # growth rate up to which its scale is linear, 1/s; a greater step breaks the line, or finds another cycle
FEW = 12  # counts below which each has a colour of its own
MARKS = "os^Dv<>"  # marks of the lines; they are open, so that lines on top of each other show


class General(Plot):
    """Any variable of any quantity over dimensions of the study, those of the quantity's own
    included."""

    several = True
    room: ClassVar[int] = 6  # greatest number of values of `by`

    variable: str
    x: str
    at: Annotated[dict[str, Finite | str], Unit(UNITS)] = Field(
        {}
    )  # values along dimensions that are not shown
    by: str | None = (
        None  # a dimension with a panel, or a line, for each of its values; normalization if it varies
    )
    log: bool = False  # whether the scale of the variable is logarithmic
    names: dict[str, str] = Field({})  # words for values of `by`

    def named(self, study: xr.Dataset) -> xr.Dataset:
        """The study with the words that the file has for values of `by`."""
        words = (
            {self.by: [self.names.get(str(value), value) for value in study[self.by].values]}
            if self.names
            else {}
        )
        return study.assign_coords(words)

    def chosen(self, study: xr.Dataset) -> list[str]:
        shown = drawing.picked(study, self.at)[self.variable]
        alone = [
            str(name) for name, size in study.sizes.items() if size > 1 and name not in shown.dims
        ]
        return [drawing.coordinate_text(shown, name) for name in alone if name in shown.coords]

    def faults_among(self, dims: Values, variables: Mapping[str, Sequence[str]]) -> Iterator[Fault]:
        """Faults by the values along each dimension (tuples for a zip, none if it has faults), and
        each variable's."""
        yield from self._wrong_overlays()
        if self.variable not in variables:
            yield Fault.of(
                ("variable",),
                self.variable,
                f"unknown variable{suggestion(self.variable, variables)}",
            )
            return
        own = {name: dims[name] for name in variables[self.variable] if name in dims}
        shown = [*self.axes.values(), *([] if self.by is None else [self.by])]
        yield from self._wrong_axes(own, self.variable)
        for axis, name in self.axes.items():
            if len(own.get(name, ())) == 1:
                yield Fault.of((axis,), name, "must have two values or more")
        if self.by is not None and (self.by not in own or self.by in self.axes.values()):
            rule = f"must be another dimension of {self.variable}{suggestion(self.by, own)}"
            yield Fault.of(("by",), self.by, rule)
        elif (count := len(own.get(self.by or "", ()))) > self.room:
            yield Fault.of(
                ("by",), self.by, f"has {count} values, and there is room for {self.room}"
            )
        free = {name: values for name, values in own.items() if name not in shown}
        for name, value in self.at.items():
            if name not in free:
                yield Fault.of(
                    ("at", name), value, f"is no dimension that remains{suggestion(name, free)}"
                )
            elif free[name] and not any(_same(value, known) for known in free[name]):
                yield Fault.of(("at", name), value, f"must be one of {as_text([*free[name]])}")
        for name, values in free.items():
            panels = self.by is None and name == NORM and len(values) <= self.room
            if name not in self.at and len(values) > 1 and not panels:
                yield Fault(
                    ("at", name), "", f"is required, or by: {name}; one of {as_text([*values])}"
                )
        yield from unknown("names", self.names, "by", dims.get(self.by or "", ()))


def unknown(key: str, words: Iterable[Any], of: str, values: Sequence[Any]) -> Iterator[Fault]:
    """Faults of words of a figure's key that are none of the values along a dimension."""
    known = [str(value) for value in values]
    for word in words:
        if str(word) not in known:
            yield Fault.of((key,), word, f"is no value of {of}{suggestion(word, known)}")


def _same(value: Any, other: Any) -> bool:
    numbers = isinstance(value, float) and isinstance(other, float)
    return math.isclose(value, other, rel_tol=1e-12) if numbers else bool(value == other)


def remaining(array: xr.DataArray, axes: Sequence[str]) -> str | None:
    """The dimension that is on no axis, if there is one."""
    return next((str(name) for name in array.dims if name not in axes), None)


def scale(name: str, values: np.ndarray) -> str:
    """Scale of an axis, as in maps of regions, but linear from 0 on."""
    return scale_of(name, values).replace("symlog", "linear")


def in_steps(colours: Sequence[Any]) -> dict[str, Any]:
    """Colour map and scale for matplotlib: a colour for each of the numbers 0, 1, ..."""
    cmap, norm = mpl.colors.from_levels_and_colors(
        (np.arange(len(colours) + 1) - 0.5).tolist(), colours
    )
    return {"cmap": cmap, "norm": norm}


def draw_maps(
    figure: FigureBase,
    axes: Sequence[Axes],
    study: xr.Dataset,
    variable: str,
    x: str,
    y: str,
    log: bool = False,
) -> list[Artist]:
    """Draw a variable in colour, a panel for each value of a third dimension; returns entries of a
    legend."""
    array = as_classes(study[variable])
    by = remaining(array, (x, y))
    planes = [plane.transpose(y, x, ...) for _, plane in drawing.slices(study, by)]
    if is_growth(variable) and not log:
        handles = growth_panels(figure, axes, planes, variable)
    elif array.dtype.kind in "UO" or "flag_meanings" in array.attrs:
        panels = [plane.transpose(y, x) for _, plane in drawing.slices(array, by)]
        handles = class_panels(axes, panels, [drawing.statuses(plane) for plane in planes])
    else:
        handles = number_panels(figure, axes, planes, variable, log)
    axes[0].set(
        xscale=scale(x, study[x].values), yscale=scale(y, study[y].values)
    )  # axes are shared
    for ax in axes:
        ax.set(xlabel=drawing.label_of(array[x])[0], ylabel=drawing.label_of(array[y])[0])
    return handles


def as_classes(array: xr.DataArray) -> xr.DataArray:
    """The variable, with the words "no" and "yes" for False and True."""
    if array.dtype.kind != "b":
        return array
    return array.copy(data=np.where(array.values, "yes", "no"))


def class_panels(
    axes: Sequence[Axes], panels: Sequence[xr.DataArray], statuses: Sequence[xr.DataArray]
) -> list[Artist]:
    """Draw a flag in the colours and patterns of its classes, but what a study's rule leaves out;
    returns entries of a legend."""
    looks = {**looks_in(panels[0]), EXCLUDED: LOOKS[EXCLUDED]}
    used: set[str] = set()
    for ax, panel, status in zip(axes, panels, statuses, strict=True):
        words = panel.copy(data=flag_names(panel).astype(object))
        shown = words.where(status != EXCLUDED, EXCLUDED).astype(str).transpose(*panel.dims)
        used |= class_cells(ax, shown, looks)
    return entries(used, {**looks, UNRESOLVED.label: UNRESOLVED})


def number_panels(
    figure: FigureBase, axes: Sequence[Axes], planes: Sequence[xr.Dataset], variable: str, log: bool
) -> list[Artist]:
    """Draw numbers on one scale of colours, a panel for each plane, and classes where there is
    none; returns entries of a legend."""
    arrays = [plane[variable] for plane in planes]
    first = arrays[0]
    counts = first.dtype.kind == "i" and max(int(array.max()) for array in arrays) < FEW
    if counts:
        words = [str(count) for count in range(max(int(array.max()) for array in arrays) + 1)]
        colours = in_steps([cm.batlow(i / len(words)) for i in range(len(words))])
    else:
        colours = _colours(np.concatenate([array.values.ravel() for array in arrays]), first, log)
    used: set[str] = set()
    for ax, plane, array in zip(axes, planes, arrays, strict=True):
        mesh = _cells(ax, array, **colours)
        status = drawing.statuses(plane).broadcast_like(array).transpose(*array.dims)
        gaps = array.isnull() | (status == EXCLUDED)
        words_of_gaps = np.vectorize(drawing.class_of_gap, otypes=[str])(status.values)
        missing = np.where(gaps.values, words_of_gaps, "")
        paint(ax, edges_of(array), missing, LOOKS)
        used |= set(missing.flat)
    bar = figure.colorbar(mesh, ax=list(axes), pad=0.01, aspect=30)
    bar.set_label(fill(drawing.label_of(first)[0], 40))
    if log and colours["norm"].vmax < 10 * colours["norm"].vmin:
        bar.ax.yaxis.set_minor_formatter("{x:g}")
    if counts:
        bar.set_ticks(range(len(words)), labels=words)
        bar.minorticks_off()
    return entries(used)


class HeatMap(General):
    """A variable in colour over two dimensions; a panel for each value of a third, if wanted."""

    kind: Literal["heat_map"] = "heat_map"
    y: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        study = self.named(drawing.picked(study, self.at))
        array = study[self.variable]
        shown = drawing.slices(array, remaining(array, [*self.axes.values()]))
        rows = 1 + (len(shown) > 4)
        columns = math.ceil(len(shown) / rows)
        width = PAGE if len(shown) > 1 else drawing.COLUMN * 1.2
        figure, axes = panels(width, 2.9 * rows, rows, columns, sharex=True, sharey=True)
        for ax in axes[len(shown) :]:
            ax.remove()
        axes = axes[: len(shown)]
        handles = draw_maps(figure, axes, study, self.variable, self.x, self.y, self.log)
        for ax, letter, (text, _) in zip(axes, "abcdef", shown, strict=False):
            unbroken = text.replace(" = ", "\u00a0=\u00a0")  # a value stays on the line of its name
            title = fill(f"({letter}) {unbroken}", round(width / columns / 0.08))
            ax.set_title(title if len(axes) > 1 else "", loc="left")
            ax.label_outer()
        for ax in axes[-columns:]:  # below some of them there is none
            ax.set_xlabel(axes[-1].get_xlabel())
            ax.tick_params(labelbottom=True)
        figure_legend(figure, handles)
        return figure


def _cells(ax: Axes, plane: xr.DataArray, **colours: Any) -> Any:
    """Draw the values of a panel in colour, where there are any."""
    return ax.pcolormesh(*edges_of(plane), plane.values.astype(float), rasterized=True, **colours)


def _colours(numbers: np.ndarray, array: xr.DataArray, log: bool) -> dict[str, Any]:
    """Colour map and scale of numbers, for matplotlib: logarithmic, around zero, or between the
    least and the greatest."""
    values = numbers[np.isfinite(numbers)]
    if log:
        above = values[values > 0]
        low, high = (above.min(), above.max()) if above.size else (1.0, 10.0)
        growth = is_growth(array.name)  # which has the red half of the scale of maps
        cmap = mpl.colors.ListedColormap(cm.vik(np.linspace(0.55, 1, 256))) if growth else cm.batlow
        return {"cmap": cmap, "norm": mpl.colors.LogNorm(low, high if high > low else 10 * low)}
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low < 0 < high:
        most = max(-low, high)
        return {"cmap": cm.vik, "norm": mpl.colors.Normalize(-most, most)}
    return {"cmap": cm.batlow, "norm": mpl.colors.Normalize(low, high)}


def scale_rates(ax: Axes) -> None:
    """Scale an axis of growth rates, as peaks of tens occur beside hundredths, and mark zero."""

    def between(rate: float, _: float) -> str:
        """Within about a decade, labels of some ticks between its ends, so that nobody reads the
        scale as linear."""
        shown = f"{rate:e}".lstrip("-")[0] in "25" and max(map(abs, ax.get_ylim())) < 20 * LINEAR
        return f"{rate:g}" if shown else ""

    ax.set_yscale("symlog", linthresh=LINEAR, subs=range(2, 10))
    ax.yaxis.set_major_formatter("{x:g}")
    ax.yaxis.set_minor_formatter(between)
    ax.axhline(0, color=GREY, linewidth=0.6, zorder=0)


def draw_lines(
    ax: Axes,
    study: xr.Dataset,
    variable: str,
    x: str,
    log: bool = False,
    marks: dict[str, str] | None = None,
) -> None:
    """Draw a line, or one for each value of a second dimension; its marks above the panel stand for
    missing values. Panels of a figure share `marks`, by the names of lines, so that a line has the
    same mark in all of them."""
    words, array = drawing.as_numbers(study[variable])
    by, (label, along) = remaining(array, [x]), drawing.along(array[x])
    lines = drawing.slices(array, by)
    colours = [cm.batlow(i / len(lines)) for i in range(len(lines))] if by else [BLACK]
    rates = is_growth(variable) and not log
    look: dict[str, Any] = {
        "markersize": 3,
        "markerfacecolor": "none",
        "markeredgewidth": 0.6,
        "linewidth": 0.7,
    }
    # of lines without gaps some points are marked
    every = 1 if words or rates or array.isnull().any() else max(1, along.size // 12)
    marks = {} if marks is None else marks
    for colour, (name, line) in zip(colours, lines, strict=True):
        mark = marks.setdefault(name, MARKS[len(marks) % len(MARKS)])
        shown = drawing.broken(along, line.values, LINEAR if rates else np.inf)
        style = mark + "-" * (not words)
        ax.plot(*shown, style, color=colour, label=name or None, markevery=every, **look)
    if log:
        ax.set_yscale("log")
    if rates:
        scale_rates(ax)
    ax.set_xscale(scale(x, along))
    ax.set(xlabel=label, ylabel=fill(drawing.label_of(array)[0], 32))
    if words:
        ax.set_yticks(range(len(words)), labels=words)
    ax.margins(0.03)
    top = 1.03  # of the next row, as a share of the panel
    look |= {"transform": ax.get_xaxis_transform(), "clip_on": False}
    for name, gone in drawing.gaps(study, array).items():
        for colour, (line_name, mask) in zip(colours, drawing.slices(gone, by), strict=True):
            if mask.any():
                mark = marks[line_name] if by else "x"
                ax.plot(
                    along[mask.values], np.full(int(mask.sum()), top), mark, color=colour, **look
                )
                top += 0.05
        if variable == "first_separation" and name == "no value":
            name = f"none within {stated_in(study, 'options')['horizon']:g} s"
        drawing.say(ax, name, (0, top - 0.02), (1, 1), xycoords="axes fraction", fontsize=7)
        top += 0.1


def name_ends(ax: Axes) -> bool:
    """Write the names of lines beside their right ends, if all end there and apart from each other;
    else do nothing."""
    low, high = ax.get_ylim()
    lines: list[Any] = ax.get_legend_handles_labels()[0]
    ends = np.array([line.get_ydata()[-1] for line in lines])
    apart = np.diff(np.sort(ends)) / (high - low)
    if len(lines) < 2 or not (apart > 0.05).all() or ax.get_yscale() != "linear":
        return False
    for line, end in zip(lines, ends, strict=True):
        line.set_color(BLACK)
        drawing.say_beside(ax, end, line.get_label(), fontsize=7)
    return True


class CurvePlot(General):
    """A variable against one dimension; a line for each value of a second, if wanted."""

    room = 12
    kind: Literal["curve"] = "curve"
    limits: tuple[Finite, Finite] | None = (
        None  # ends of the variable's axis, so that figures can be compared
    )
    panels: (
        Literal["each"] | tuple[tuple[Finite | str, ...], ...]
    ) = ()  # values of `by` in each panel

    def faults_among(self, dims: Values, variables: Mapping[str, Sequence[str]]) -> Iterator[Fault]:
        yield from super().faults_among(dims, variables)
        if self.panels != "each":
            yield from unknown("panels", chain(*self.panels), "by", dims.get(self.by or "", ()))

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        study = drawing.picked(study, self.at)
        if self.panels == "each":
            parts = drawing.slices(self.named(study), self.by)
        else:
            chosen = [study.sel({self.by: [*values]}) for values in self.panels] or [study]
            parts = [("", self.named(part)) for part in chosen]
        figure, axes = panels(
            PAGE if self.panels else drawing.COLUMN, 2.9, 1, len(parts), sharey=True
        )
        marks: dict[str, str] = {}
        for ax, (_, part) in zip(axes, parts, strict=True):
            draw_lines(ax, part, self.variable, self.x, self.log, marks)
            ax.label_outer()
        if self.limits is not None:
            axes[0].set_ylim(self.limits)
        drawing.letters(
            axes, [fill(name, 26) for name, _ in parts], pad=20 if self.panels == "each" else None
        )
        for ax in axes:
            handles, labels = ax.get_legend_handles_labels()
            if labels and not name_ends(ax):
                # longer names do not fit beside the panel
                beside = len(labels) > 4 and max(map(len, labels)) < 25 and not self.panels
                corner: Any = "outside right upper" if beside else "outside lower right"
                figure_legend(figure, handles, columns=1 if self.by else 2, loc=corner)
        return figure
