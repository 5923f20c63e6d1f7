"""Curves: any variable against one dimension."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.ticker import AutoLocator, NullLocator, ScalarFormatter

from disc_model.data.variables import EXCLUDED
from disc_model.figures.branch_lines import THIN, Look
from disc_model.figures.class_axis import join_classes, name_classes, words_along
from disc_model.figures.curve_marks import (
    choose_marks,
    fill_doubtful,
    looks_of,
    mark_gaps,
    mark_open_steps,
    measured_along,
    open_look,
    point_down,
    reason_of_open_steps,
    set_margins,
)
from disc_model.figures.drawing import (
    BLACK,
    is_in_data,
    letters,
    mark,
    plain_decades,
    row_of_panels,
)
from disc_model.figures.error_bars import draw_errors, names_errors
from disc_model.figures.heat_map import as_classes, scale
from disc_model.figures.kinds.base import key_of
from disc_model.figures.kinds.general import CurvePlot
from disc_model.figures.line_names import name_lines
from disc_model.figures.outside_limits import note_outside
from disc_model.figures.rate_scale import (
    RATE,
    are_of_cycles,
    are_rates,
    opens,
    scale_heights,
    without_rounding,
)
from disc_model.figures.selection import (
    Part,
    at_lower_bound,
    border_alone,
    not_near,
    opened,
    parts_along,
    picked,
    remaining,
    statuses_like,
    titles_of,
)
from disc_model.figures.separating_share import draw_intervals_of_lines
from disc_model.figures.types import Array, Axes, Figure, Mask
from disc_model.figures.words import CHARACTER, as_numbers, label_in, measured, named

PLAIN = Look(BLACK)
"""Look of a single line."""
LINE = 1.1  # height of a line of text over its size
CROWDED = 30  # points of a line beyond which a mark for each would be a band of rings
DOT = 1.5  # points, size of a mark of one of them
MARKED = 12  # points of such a line that have a mark, about


def draw(plot: CurvePlot, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a line, or one for each value of a second dimension, in one panel or several."""
    panels = panels_of(plot, picked(study, plot.at))
    width = plot.inches_of(len(panels))
    figure, axes = row_of_panels(width, len(panels), 2.9, 2.2, sharey=True)
    marks: dict[str, str] = {}
    for part in panels:
        choose_marks(marks, _lines_of(part.data, plot.variable, plot.x))
    for ax, part in zip(axes, panels, strict=True):
        draw_lines(ax, part.data, plot.variable, plot.x, plot.log, marks)
        ax.label_outer()
    in_legend = any(map(names_errors, axes)) or plot.legend
    if plot.limits is not None:
        axes[0].set_ylim(plot.limits)
        in_legend = note_outside(axes, plot.limits) or in_legend
    letters(axes, titles_of(panels))
    name_lines(figure, axes, several=bool(plot.panels), in_legend=in_legend)
    return figure


def panels_of(plot: CurvePlot, study: xr.Dataset) -> list[Part[xr.Dataset]]:
    """The part of a study in each panel."""
    if plot.panels == "each":
        return parts_along(study, plot.by, plot.names)
    if plot.by not in study.dims:  # it has one value
        return [Part("", "", study)]
    chosen = [study.sel({plot.by: [*values]}) for values in plot.panels] or [study]
    if plot.names:
        words = [str(value) for value in study[plot.by].values]
        renamed = {word: plot.names.get(key_of(word), word) for word in words}
        chosen = [
            part.assign_coords({plot.by: [renamed[str(x)] for x in part[plot.by].values]})
            for part in chosen
        ]
    return [Part("", "", part) for part in chosen]


def draw_lines(  # noqa: PLR0913
    ax: Axes,
    study: xr.Dataset,
    variable: str,
    x: str,
    log: bool = False,
    marks: dict[str, str] | None = None,
    *,
    joined: bool = True,
    single: Look = PLAIN,
    sweep: int | None = None,
) -> list[tuple[str, Any]]:
    """Draw a line, or one for each value of a second dimension, or points that are not `joined`;
    marks above the panel stand for missing values. Returns each line with its name.

    Panels of a figure share `marks`, by the names of lines, so that a line has the same mark and
    colour in all of them.

    single : colour of a single line, and dashes of all
    sweep : number of the sweep on its axes, if each has rows of its own above the panel
    """
    if marks is None:
        marks = {}
    names, array = join_classes(ax, *heights_of(study, variable))
    by = remaining(array, [x])
    along = measured_along(array[x]).values
    joined = joined and along.dtype.kind != "U"
    rates = are_rates(array, log)

    # lines, in the colours of their order
    parts = parts_along(array, by)
    looks = looks_of(parts, marks, single)._replace(sweep=sweep)
    gapless = joined and not (names or rates or array.isnull().any())
    steps = open_steps(study, array, by, log) if joined else {}
    line = dashes_of(single) if joined and not names else ""
    bounds = _at_bound_by_part(study, array, by)
    titles = _titles_of_shown(study, array, by)
    drawn = []
    for part in parts:
        title = titles.get(part.name)
        look = {**open_look(), **looks.of(part.name), "label": title or None, "linestyle": line}
        heights = _draw_at_bound(ax, along, part.data.values, bounds[part.name], look)
        pieces = [along, heights]
        if steps:
            pieces = opened(along, heights, steps[part.name])
        if heights.size > CROWDED:
            look |= _few_marks(pieces[1], joined=bool(line), alone=len(marks) == 1)
            if not gapless:
                draw_dots(ax, along, heights, looks.colours[part.name])
        [first, *_] = ax.plot(*pieces, **look)
        if title is not None:
            drawn.append((title, first))

    draw_errors(ax, study, array, x, looks.colours)
    set_scales(ax, study, names, array, x, log)

    # what is no value, or none that was found
    point_down(ax, parts, along, bounds, looks)
    fill_doubtful(ax, study, array, x, looks)
    draw_intervals_of_lines(ax, study, array, x, looks.colours)
    mark_gaps(ax, study, array, x, looks)
    mark_open_steps(ax, steps, along, looks, reason_of_open_steps(variable))
    return drawn


def _titles_of_shown(study: xr.Dataset, array: xr.DataArray, by: str | None) -> dict[str, str]:
    """What the legend calls each line, by the names of lines; without those of which all points are left
    out."""
    included = array.copy(data=statuses_like(study, array) != EXCLUDED)
    parts = parts_along(included, by)
    shown = [part for part in parts if part.data.any()]
    if len(parts) > 1 and len(shown) == 1:
        return {part.name: part.name for part in shown}
    names = [part.name for part in shown]
    return dict(zip(names, titles_of(shown), strict=True))


def heights_of(study: xr.Dataset, variable: str) -> tuple[list[str], xr.DataArray]:
    """Names of the classes of a variable, if it has any, and its heights above the axis: without those
    of -inf, which are marked above the panel."""
    names, array = as_numbers(as_classes(study, variable))
    array = array.copy(data=measured(array).values)
    array = without_rounding(array)
    return names, array.where(~np.isneginf(array))


def set_scales(
    ax: Axes, study: xr.Dataset, names: Sequence[str], array: xr.DataArray, x: str, log: bool
) -> None:
    """Set the scales, ticks and labels of axes with lines of a variable.

    names, array : of its classes, and its heights, as `heights_of` gives them
    """
    variable = str(array.name)
    label, along = measured_along(array[x])
    _forget_empty(ax)
    shows = _shows_numbers(ax)
    scale_heights(ax, array, log)
    _scale_across(ax, array[x], along)
    ax.set_xlabel(label)
    ax.set_ylabel(label_in(study, variable))
    _set_ticks(ax, names, shows, whole=_are_counts(study[variable]))
    set_margins(ax)


def dashes_of(look: Look) -> Any:
    """The dashes of a look; a line without gaps if it has none."""
    return look.line(THIN).get("linestyle", "-")


def _at_bound_by_part(study: xr.Dataset, array: xr.DataArray, by: str | None) -> dict[str, Mask]:
    """Points of each line whose value is the lower bound of its search."""
    bound = at_lower_bound(study, str(array.name))
    if bound is None:
        bound = array.copy(data=np.zeros(array.shape, dtype=bool))
    return {part.name: part.data.values for part in parts_along(bound, by)}


def _draw_at_bound(
    ax: Axes, along: Array, heights: Array, at_bound: Mask, look: Mapping[str, Any]
) -> Array:
    """Draw the points of a line that are at the bound of a search, and return the heights of the others:
    the value may lie anywhere below, so that no line leads there."""
    if at_bound.any():
        alone = {**look, "linestyle": "", "label": "_nolegend_"}
        ax.plot(along[at_bound], heights[at_bound], **alone)
    return np.where(at_bound, np.nan, heights)


def _scale_across(ax: Axes, values: xr.DataArray, along: Array) -> None:
    """Scale the horizontal axis for the values along it, or turn the words there."""
    if along.dtype.kind == "U":
        _turn_words(ax, words_along(ax, along.astype(str).tolist()))
        return
    ax.set_xscale(scale(values))
    if values.dtype.kind == "i":
        _number_whole(ax.xaxis)
    if ax.get_xscale() == "log":
        plain_decades(ax.xaxis)


def _turn_words(ax: Axes, words: Sequence[str]) -> None:
    """Turn words along the horizontal axis if they have no room beside each other, and write only some
    of them if they have none then, either."""
    page: Any = ax.get_figure(root=True)
    room = page.get_figwidth() * ax.get_position().width
    if CHARACTER * sum(map(len, words)) <= room:
        return
    ax.tick_params(axis="x", labelrotation=90)
    label: Any = ax.xaxis.get_major_ticks()[0].label1
    line = LINE * label.get_fontsize() / 72
    every = int(np.ceil(line * len(words) / room))
    ax.set_xticks(range(0, len(words), every), labels=words[::every])


def open_steps(
    study: xr.Dataset, array: xr.DataArray, by: str | None, log: bool
) -> dict[str, Mask]:
    """The steps at which each line of a variable is open: of critical values, those to or from the main
    border of stability; of a variable of cycles, those at which the growth rate says that they may
    lead to another cycle, and those to or from a cycle that the motion is not near; none of other
    variables."""
    on_border = border_alone(study, str(array.name))
    if on_border is not None:
        parts = parts_along(on_border, by)
        return {part.name: np.abs(np.diff(part.data.values)) > 0 for part in parts}
    rates = array if array.name == RATE else study.get(RATE, array)
    if not are_of_cycles(array, rates) or (array.name == RATE and not are_rates(array, log)):
        return {}
    other = not_near(study, str(array.name))
    if other is None:
        other = array.copy(data=np.zeros(array.shape, dtype=bool))
    found = {}
    of_lines = zip(parts_along(rates, by), parts_along(other, by), strict=True)
    for part, apart in of_lines:
        found[part.name] = opens(part.data.values) | np.diff(apart.data.values)
    return found


def _few_marks(heights: np.ndarray, *, joined: bool, alone: bool) -> dict[str, Any]:
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


def _are_counts(variable: xr.DataArray) -> bool:
    """Whether a variable counts something, also where some points have no value."""
    return variable.dtype.kind in "iu" or named(variable).name.startswith("Number of ")


class NoNumbers(NullLocator):
    """No ticks of an axis along which nothing has a value yet."""


def _forget_empty(ax: Axes) -> None:
    """Let an axis have numbers again on which no line had a value."""
    if isinstance(ax.yaxis.get_major_locator(), NoNumbers):
        ax.set_yscale("linear")
        ax.relim()


def _shows_numbers(ax: Axes) -> bool:
    """Whether anything has a value along the vertical axis, also in other panels that share it."""
    for each in ax.get_shared_y_axes().get_siblings(ax):
        in_panel = [patch for patch in each.patches if patch.get_clip_on()]  # no strip above it
        if in_panel or each.collections:
            return True
        for line in each.lines:
            if is_in_data(each, line) and np.isfinite(line.get_ydata()).any():
                return True
    return False


def _set_ticks(ax: Axes, names: Sequence[str], shows: bool, whole: bool) -> None:
    """Write the names of classes along the vertical axis, if there are any; whole numbers beside
    counts; nothing where no point of any line has a value, as numbers would be made up."""
    axis: Any = ax.yaxis
    if names:
        name_classes(ax, names)
    elif not shows:
        axis.set_major_locator(NoNumbers())
        axis.set_minor_locator(NullLocator())
    elif whole:
        _number_whole(axis)
    if isinstance(axis.get_major_formatter(), ScalarFormatter):
        axis.get_major_formatter().set_useOffset(False)  # a sum beside the panel is overlooked


def _number_whole(axis: Any) -> None:
    """Write whole numbers only along an axis of counts."""
    if isinstance(axis.get_major_locator(), AutoLocator):
        axis.get_major_locator().set_params(integer=True, min_n_ticks=1)


def _lines_of(study: xr.Dataset, variable: str, x: str) -> list[Part[xr.DataArray]]:
    """The lines of a variable in a panel."""
    array = as_classes(study, variable)
    return parts_along(array, remaining(array, [x]))
