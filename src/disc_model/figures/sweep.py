"""Pictures of sweeps and of grid studies: lines along one dimension, colours over two."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal
from weakref import ref

import numpy as np
import xarray as xr

from disc_model.errors import require
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.colour_maps import draw_maps
from disc_model.figures.colour_wishes import ColourWishes, are_limits, is_colormap
from disc_model.figures.covered import twins_of
from disc_model.figures.curve_scales import number_whole
from disc_model.figures.drawing import COLUMN
from disc_model.figures.drawn_units import in_readers_units
from disc_model.figures.gap_rows import tell_rows_apart
from disc_model.figures.named_axes import Quantities, refuse_beside_areas
from disc_model.figures.outside_limits import note_outside, remove_note, words_of_note
from disc_model.figures.rate_scale import set_limits
from disc_model.figures.selected import selected_of
from disc_model.figures.sweep_bars import draw_bars
from disc_model.figures.sweep_choice import SHARES, Drawn, choose_drawn
from disc_model.figures.sweep_drawn import draw_each
from disc_model.figures.sweep_family import join_lines
from disc_model.figures.sweep_lines import (
    Lines,
    lines_beside,
    lines_of,
    lines_on,
    names_asked,
    quantities_of,
)
from disc_model.figures.sweep_options import options_of, set_options
from disc_model.figures.sweep_parts import parts_beside
from disc_model.figures.sweep_titles import said_of, title_of, values_of
from disc_model.figures.truths import are_of_classes, as_classes
from disc_model.figures.types import Axes
from disc_model.figures.without_place import say_without_place
from disc_model.figures.words import are_counts, label_in, label_of

OUTCOMES = "Outcome of starts"  # what the colours of bars show
ALONE = "must be left out beside lines, or the colours of a map"
MOST_CLASSES = 20  # different words that the colours and patterns of a map tell apart


@in_readers_units
def plot_sweep(  # noqa: PLR0913
    study: xr.Dataset | xr.DataTree,
    variable: str | Sequence[str] = "",
    x: str = "",
    *,
    lines: str | Literal[False] = "",
    points: bool = False,
    log: bool | None = None,
    cmap: Any = None,
    limits: Any = None,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw a sweep or a grid study, as `disc_model.plot_sweep` describes."""
    variables = _listed(variable)
    is_named = lines is False or _are_names([lines])
    require(
        (isinstance(study, xr.Dataset), "study", study, "must be an xarray.Dataset"),
        (_are_names(variables), "variable", variable, "must be a name, or a list of names"),
        (_are_names([x]), "x", x, "must be a name"),
        (is_named, "lines", lines, "must be a name, or False for a map"),
        (isinstance(points, bool), "points", points, "must be True or False"),
        (points is not True or not _asks_for_lines_or_map(lines, cmap), "points", points, ALONE),
        (isinstance(log, bool | None), "log", log, "must be True or False"),
        (is_colormap(cmap), "cmap", cmap, "must be a colour map of matplotlib, or its name"),
        (are_limits(limits), "limits", limits, "must be two ascending numbers"),
    )
    if parts := parts_beside(study, variable, x, lines):  # type: ignore[arg-type]  # checked
        looks = {"log": log, "limits": limits, "legend": legend, "labels": labels, "title": title}
        return _plot_parts(parts, variable, x, ax, cmap=cmap, **looks)
    asked = None if _asks_for_map(lines, cmap) else lines or ""
    varying, drawn = choose_drawn(study, variables, x, asked, points=points)  # type: ignore[arg-type]  # checked
    for each in drawn:
        require((lines is not False or each.mapped, "lines", lines, _rule_of_maps(each)))
    called, labels = names_asked(labels, [each.variable for each in drawn])
    wishes = Wishes(ax, legend, labels, title)
    colours = ColourWishes(bool(log), cmap, limits, linear=log is False)
    selected = selected_of(study, varying, drawn[0].variable)
    with page_for(wishes, COLUMN, 2.9, title=title_of(varying, drawn[0], selected)) as page:
        for each in drawn:
            _draw(page, varying, each, colours, called.get(each.variable, ""), selected)
            page.remember()  # the next variable joins this one
    return page.ax


def _listed(variable: Any) -> list[Any]:
    """The variables that are asked for, one or several, as a list."""
    if isinstance(variable, list | tuple) and variable:
        return [*variable]
    return [variable]


def _are_names(values: Sequence[Any]) -> bool:
    """Whether all of these are names, or None for the usual ones."""
    return all(isinstance(value, str | None) for value in values)


def _asks_for_map(lines: Any, cmap: Any) -> bool:
    """Whether a map is asked for: lines have no map of colours."""
    return lines is False or (cmap is not None and not lines)


def _asks_for_lines_or_map(lines: Any, cmap: Any) -> bool:
    """Whether a dimension of lines is asked for, or a map."""
    by_name = isinstance(lines, str) and lines != ""
    return by_name or lines is False or cmap is not None


def _plot_parts(parts: Sequence[xr.Dataset], variable: Any, x: str, ax: Any, **looks: Any) -> Axes:
    """Draw parts of a study beside each other, as several sweeps on the same axes."""
    for part in parts:
        ax = plot_sweep(part, variable, x, ax=ax, **looks)
    return ax


def _rule_of_maps(drawn: Drawn) -> str:
    """What a reader has to know who asks for a map of what is none."""
    if drawn.variable in SHARES:
        return f"must be left out, because {drawn.variable} is drawn as bars"
    return f"must be left out: a map needs two dimensions of numbers, and {drawn.variable} has one"


def _draw(
    page: Page,
    study: xr.Dataset,
    drawn: Drawn,
    wishes: ColourWishes,
    name: str,
    selected: Mapping[str, str],
) -> None:
    """Draw bars of shares, lines, which have a name if the reader gives one, or a map."""
    label = label_in(study, drawn.variable)
    across = label_of(study[drawn.across])[0]
    if drawn.variable in SHARES and not wishes.log:
        wishes.refuse()
        page.show(Quantities(across, label_of(study[drawn.variable])[0], OUTCOMES))
        refuse_beside_areas(page.axes, "bars")
        page.explain(draw_bars(page.ax, study, drawn), beside="below")
    elif not drawn.mapped:
        if are_of_classes(as_classes(study, drawn.variable)):
            wishes.refuse_of_classes()
        wishes.refuse(of_lines=True)
        lines = _new_lines(study, drawn, name, selected)
        _draw_lines(page, study, drawn, wishes.log, lines)
        if wishes.linear and page.ax.get_yscale() == "symlog":
            page.ax.set_yscale("linear")
        if wishes.limits is not None:
            set_limits(page.ax, wishes.limits)
            _say_what_is_outside(page, wishes.limits)
    else:
        _refuse_many_words(study, drawn.variable)
        page.show(Quantities(across, label_of(study[drawn.second])[0], label))
        refuse_beside_areas(page.axes, "a map")
        plane = study.transpose(drawn.second, drawn.across, ...)
        key = draw_maps(page.figure, [page.ax], [plane], drawn.variable, wishes)
        page.explain(key.handles, beside="below", title=key.title)
        page.is_map = True
        for axis, dim in ((page.ax.xaxis, drawn.across), (page.ax.yaxis, drawn.second)):
            if are_counts(study[dim]):
                number_whole(axis)


def _refuse_many_words(study: xr.Dataset, variable: str) -> None:
    """Raise `ParameterError` for a map of more words than its legend could explain."""
    if study[variable].dtype.kind not in "UO":
        return
    count = np.unique(study[variable].values.astype(str)).size
    rule = f"has {count} different words, and a map tells {MOST_CLASSES} apart: draw a shorter one"
    require((count <= MOST_CLASSES, "variable", variable, rule))


def _new_lines(study: xr.Dataset, drawn: Drawn, name: str, selected: Mapping[str, str]) -> Lines:
    """Lines that are not drawn yet, with all that may tell them from others."""
    labels = (label_of(study[drawn.across])[0], label_in(study, drawn.variable))
    options = options_of(study)
    lines = lines_of(study, drawn.variable, labels, name, {**options, **values_of(study)})
    lines.shown.said = {**options, **said_of(study), **selected}
    lines.shown.selected = selected
    lines.options = {*options} | set_options(study)
    return lines


def _draw_lines(page: Page, study: xr.Dataset, drawn: Drawn, log: bool, lines: Lines) -> None:
    """Draw lines beside those of other variables of the same unit, and of other cases."""
    page.replaced = [*page.replaced, *words_of_note(page.ax)]
    remove_note(page.ax)
    others = lines_on(page.ax)
    quantities = quantities_of(lines, others)
    page.show(quantities)
    before = lines_beside(page.ax)
    lines.number = len(before)
    taken = sum(len(each.parts) for each in before)
    found = draw_each(page.ax, study, drawn, log, lines.number, taken)
    # a legend is written more than once
    page.replaced = [*page.replaced, *say_without_place(page.ax, study[drawn.across])]
    page.ax.set_ylabel(quantities.y)
    lines.parts = [(part, ref(line)) for part, line in found]
    tell_rows_apart(page.ax, join_lines(page, lines))


def _say_what_is_outside(page: Page, limits: tuple[float, float]) -> None:
    """Let the legend say which lines lie outside the limits of their axis, in place of their names."""
    note_outside([page.ax], limits)
    page.replaced = [*page.replaced, *words_of_note(page.ax)]  # a legend is written more than once
    axes = [*filter(lines_on, twins_of(page.ax)), page.ax]
    page.explain([each for ax in axes for each in ax.get_legend_handles_labels()[0]])
