"""Lines of a variable along one dimension, and what is marked on them."""

from typing import Any

import xarray as xr

from disc_model.figures.branch_lines import Look
from disc_model.figures.class_axis import join_classes
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_looks import (
    CROWDED,
    PLAIN,
    around_former,
    dashes_among,
    dashes_of,
    draw_dots,
    few_marks,
    looks_of,
)
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
from disc_model.figures.curve_pieces import at_bound_by_line, draw_at_bound, open_steps, pieces_of
from disc_model.figures.curve_scales import set_scales
from disc_model.figures.error_bars import draw_errors
from disc_model.figures.rate_scale import are_rates
from disc_model.figures.selection import parts_along, remaining, titles_of_shown
from disc_model.figures.separating_share import draw_intervals_of_lines
from disc_model.figures.types import Axes
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
    marks = {} if marks is None else marks
    names, array = join_classes(ax, *heights_of(study, variable))
    by = remaining(array, [x])
    along = measured_along(array[x]).values
    joined = joined and along.dtype.kind != "U"
    rates = are_rates(array, log)

    # lines, in the colours of their order
    parts = parts_along(array, by)
    line = dashes_of(single) if joined and not names else ""
    looks = looks_of(parts, marks, single)._replace(sweep=sweep, dashes=line)
    looks = around_former(ax, parts, along, looks)
    gapless = joined and not (names or rates or array.isnull().any())
    steps = open_steps(study, array, by, log) if joined else {}
    bounds = at_bound_by_line(study, array, by)
    titles = titles_of_shown(study, array, by)
    reasons = reasons_of_gaps(study, array)
    valueless = valueless_lines(reasons, by) if names_valueless else {}
    drawn = []
    for part in parts:
        title = titles.get(part.name)
        dashes = dashes_among(parts, part.name, line)
        look = {**open_look(), **looks.of(part.name), "label": title or None, "linestyle": dashes}
        heights = draw_at_bound(ax, along, part.data.values, bounds[part.name], look)
        pieces = pieces_of(along, heights, steps.get(part.name))
        if heights.size > CROWDED:
            look |= few_marks(pieces[1], joined=bool(line), alone=len(marks) == 1)
            if not gapless:
                draw_dots(ax, along, heights, looks.colours[part.name])
        first = _draw_line(ax, pieces, look, valueless.get(part.name, ""))
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


def _draw_line(ax: Axes, pieces: list[Any], look: dict[str, Any], reason: str) -> Any:
    """Draw a line, and return its first piece; one without any value is words in the legend, with the
    reason."""
    if not reason:
        return ax.plot(*pieces, **look)[0]
    first = ax.plot(*pieces, **{**look, **UNSEEN})[0]
    say_valueless(first, reason)
    return first
