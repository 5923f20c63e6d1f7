"""Pictures of sweeps and of grid studies: lines along one dimension, colours over two."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal
from weakref import ref

import numpy as np
import xarray as xr

from disc_model.errors import require
from disc_model.figures.basins import draw_shares, entries_of, outcomes_in, shares_of
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.colour_maps import draw_maps
from disc_model.figures.colour_wishes import ColourWishes, are_limits, is_colormap
from disc_model.figures.covered import twins_of
from disc_model.figures.curve_scales import number_whole
from disc_model.figures.drawing import COLUMN
from disc_model.figures.durations import horizon_text
from disc_model.figures.gap_rows import name_rows
from disc_model.figures.named_axes import Quantities, refuse_beside_areas
from disc_model.figures.outside_limits import note_outside, remove_note, words_of_note
from disc_model.figures.rate_scale import set_limits
from disc_model.figures.selected import selected_of
from disc_model.figures.separating_share import (
    draw_interval,
    entries_of_interval,
    interval_of,
    share_of_starts,
)
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
from disc_model.figures.types import Artist, Axes
from disc_model.figures.words import are_counts, label_in, label_of, measured

OUTCOMES = "Outcome of starts"  # what the colours of bars show
ALONE = "must be left out beside lines, or the colours of a map"
MOST_CLASSES = 20  # different words that the colours and patterns of a map tell apart
UNEVEN = 3.0  # ratio of steps between bars beyond which they stand equally far apart
MOST_ENERGIES = 5  # of kicks that an axis names each


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
    variables: list[Any] = [variable]
    if isinstance(variable, list | tuple) and variable:
        variables = [*variable]
    names = all(isinstance(each, str | None) for each in variables)
    beside = lines is False or (isinstance(lines, str) and lines != "") or cmap is not None
    is_named = lines is False or isinstance(lines, str | None)
    require(
        (isinstance(study, xr.Dataset), "study", study, "must be an xarray.Dataset"),
        (names, "variable", variable, "must be a name, or a list of names"),
        (isinstance(x, str | None), "x", x, "must be a name"),
        (is_named, "lines", lines, "must be a name, or False for a map"),
        (isinstance(points, bool), "points", points, "must be True or False"),
        (points is not True or not beside, "points", points, ALONE),
        (isinstance(log, bool | None), "log", log, "must be True or False"),
        (is_colormap(cmap), "cmap", cmap, "must be a colour map of matplotlib, or its name"),
        (are_limits(limits), "limits", limits, "must be two ascending numbers"),
    )
    if parts := parts_beside(study, variable, x, lines):  # type: ignore[arg-type]  # checked
        looks = {"log": log, "limits": limits, "legend": legend, "labels": labels, "title": title}
        return _plot_parts(parts, variable, x, ax, cmap=cmap, **looks)
    asked = lines or ""
    as_map = lines is False or (cmap is not None and not lines)  # lines have no map of colours
    varying, drawn = choose_drawn(study, variables, x, None if as_map else asked, points=points)  # type: ignore[arg-type]  # checked
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
        page.explain(_draw_bars(page.ax, study, drawn), beside="below")
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
    page.ax.set_ylabel(quantities.y)
    lines.parts = [(part, ref(line)) for part, line in found]
    name_rows(page.ax, join_lines(page, lines))


def _say_what_is_outside(page: Page, limits: tuple[float, float]) -> None:
    """Let the legend say which lines lie outside the limits of their axis, in place of their names."""
    note_outside([page.ax], limits)
    page.replaced = [*page.replaced, *words_of_note(page.ax)]  # a legend is written more than once
    axes = [*filter(lines_on, twins_of(page.ax)), page.ax]
    page.explain([each for ax in axes for each in ax.get_legend_handles_labels()[0]])


def _energies_of(study: xr.Dataset, drawn: Drawn) -> str:
    """With what energies all starts of a share were kicked, in words; "" if the bars tell it."""
    if "energy" not in study.coords or drawn.across == "energy":
        return ""
    energies = [f"{energy:g}" for energy in np.atleast_1d(study["energy"].values)]
    if len(energies) > MOST_ENERGIES:
        energies = [energies[0], "...", energies[-1]]
    return f",\nkicked with {', '.join(energies)} J"


def are_apart(values: Any, across: str) -> bool:
    """Whether bars stand equally far apart, as those of energies, of which one may be 0, of words, and of
    numbers at which true distances would make bars hairlines."""
    if across == "energy" or values.dtype.kind in "UO":
        return True
    steps = np.diff(values)
    return bool(steps.max(initial=0.0) > UNEVEN * steps.min(initial=np.inf))


def _draw_bars(ax: Axes, study: xr.Dataset, drawn: Drawn) -> list[Artist]:
    """Draw the shares of starts as bars; returns entries of a legend."""
    shares = shares_of(study, drawn.variable)
    classes = outcomes_in(shares)
    across = measured(study[drawn.across])
    places = across.values
    if are_apart(places, drawn.across):
        places = np.arange(places.size)
    draw_shares(ax, shares, classes, places)
    draw_interval(ax, interval_of(study, drawn.variable), classes, places)
    if places is not across.values:
        texts = [each if isinstance(each, str) else f"{each:g}" for each in across.values]
        ax.set_xticks(places, texts)
    ax.set_xlabel(across.label)
    ax.set_ylabel(share_of_starts(study, drawn.variable) + _energies_of(study, drawn))
    ax.set_xmargin(0.04)
    within = horizon_text(study) or "the horizon"
    handles = entries_of(classes, f"undecided within {within}: raise horizon")
    return handles + entries_of_interval(study, drawn.variable, classes)
