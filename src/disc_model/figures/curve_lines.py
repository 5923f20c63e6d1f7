"""Lines of a variable along one dimension, and what is marked on them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.branch_lines import Look
from disc_model.figures.class_axis import join_classes
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_looks import CROWDED, PLAIN, dashes_of, draw_dots, few_marks, looks_of
from disc_model.figures.curve_marks import (
    fill_doubtful,
    mark_gaps,
    mark_open_steps,
    measured_along,
    open_look,
    point_down,
    reason_of_open_steps,
    reasons_of_gaps,
)
from disc_model.figures.curve_scales import set_scales
from disc_model.figures.error_bars import draw_errors
from disc_model.figures.rate_scale import RATE, are_of_cycles, are_rates, opens
from disc_model.figures.selection import (
    at_lower_bound,
    border_alone,
    not_near,
    opened,
    parts_along,
    remaining,
    titles_of_shown,
)
from disc_model.figures.separating_share import draw_intervals_of_lines
from disc_model.figures.types import Array, Axes, Mask
from disc_model.figures.valueless_lines import UNSEEN, say_valueless, valueless_lines


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
    names_valueless: bool = False,
) -> list[tuple[str, Any]]:
    """Draw a line, or one for each value of a second dimension, or points that are not `joined`;
    marks above the panel stand for missing values. Returns each line with its name.

    Panels of a figure share `marks`, by the names of lines, so that a line has the same mark and
    colour in all of them.

    single : colour of a single line, and dashes of all
    sweep : number of the sweep on its axes, if others may have lines of the same colours
    names_valueless : whether the legend names lines without any value in place of marks for them
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
    line = dashes_of(single) if joined and not names else ""
    looks = looks_of(parts, marks, single)._replace(sweep=sweep, dashes=line)
    gapless = joined and not (names or rates or array.isnull().any())
    steps = open_steps(study, array, by, log) if joined else {}
    bounds = _at_bound_by_part(study, array, by)
    titles = titles_of_shown(study, array, by)
    reasons = reasons_of_gaps(study, array)
    valueless = valueless_lines(reasons, by) if names_valueless else {}
    drawn = []
    for part in parts:
        title = titles.get(part.name)
        look = {**open_look(), **looks.of(part.name), "label": title or None, "linestyle": line}
        heights = _draw_at_bound(ax, along, part.data.values, bounds[part.name], look)
        pieces = [along, heights]
        if steps:
            pieces = opened(along, heights, steps[part.name])
        if heights.size > CROWDED:
            look |= few_marks(pieces[1], joined=bool(line), alone=len(marks) == 1)
            if not gapless:
                draw_dots(ax, along, heights, looks.colours[part.name])
        if part.name in valueless:
            look |= UNSEEN
        [first, *_] = ax.plot(*pieces, **look)
        if part.name in valueless:
            say_valueless(first, valueless[part.name])
        if title is not None:
            drawn.append((title, first))

    draw_errors(ax, study, array, x, looks.colours)
    set_scales(ax, study, names, array, x, log)

    # what is no value, or none that was found
    point_down(ax, parts, along, bounds, looks)
    fill_doubtful(ax, study, array, x, looks)
    draw_intervals_of_lines(ax, study, array, x, looks.colours)
    mark_gaps(ax, reasons, array, x, looks, valueless)
    mark_open_steps(ax, steps, along, looks, reason_of_open_steps(variable))
    return drawn


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
