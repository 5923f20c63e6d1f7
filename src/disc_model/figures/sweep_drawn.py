"""Lines of sweeps, beside those that axes have already."""

from typing import Any

import xarray as xr

from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_lines import draw_lines
from disc_model.figures.curve_looks import MARKS
from disc_model.figures.curve_points import draw_points
from disc_model.figures.curve_samples import MOST_NAMED, draw_samples
from disc_model.figures.family import LOOKS
from disc_model.figures.kind_rows import SAMPLES, has_kinds
from disc_model.figures.selection import parts_along, remaining
from disc_model.figures.sweep_choice import Drawn
from disc_model.figures.types import Axes


def draw_each(
    ax: Axes, study: xr.Dataset, drawn: Drawn, log: bool, number: int, taken: int
) -> list[tuple[str, Any]]:
    """Draw a line, or one for each value of a second dimension; many samples have one name, and
    values that are only counted are points.

    number : of sweeps and variables that were drawn there before
    taken : of the marks of all their lines
    """
    across = drawn.across
    look = LOOKS[number % len(LOOKS)]
    mark = MARKS[number % len(MARKS)]
    if drawn.counted:
        shape = _shape_of_points(study, across, number)
        return draw_points(ax, study, drawn.variable, across, log, look, shape, number)
    if drawn.sampled and study.sizes[drawn.second] > MOST_NAMED:
        return draw_samples(ax, study, drawn.variable, across, log, look, mark)
    options: dict[str, Any] = {"joined": drawn.joined, "single": look}
    if drawn.second is None:
        return draw_lines(ax, study, drawn.variable, across, log, {"": mark}, **options)
    marks = {} if _has_dashes(study, drawn) else _further_marks(study, drawn, taken)
    options |= {"sweep": number, "names_valueless": True}
    return draw_lines(ax, study, drawn.variable, across, log, marks, **options)


def _shape_of_points(study: xr.Dataset, across: str, number: int) -> str:
    """The mark of values that are only counted: dots of the first sweep, and of others a shape that the
    kinds of motion above the panel do not have."""
    if number == 0:
        return "."
    if has_kinds(study, across):
        return SAMPLES[(number - 1) % len(SAMPLES)]
    return MARKS[number % len(MARKS)]


def _has_dashes(study: xr.Dataset, drawn: Drawn) -> bool:
    """Whether lines join the points, whose dashes tell sweeps and variables apart."""
    words, _ = heights_of(study, drawn.variable)
    along_words = study[drawn.across].dtype.kind in "UO"
    return drawn.joined and not words and not along_words


def _further_marks(study: xr.Dataset, drawn: Drawn, taken: int) -> dict[str, str]:
    """The marks of points that no line joins, by their names: others than those before them have."""
    array = study[drawn.variable]
    parts = parts_along(array, remaining(array, [drawn.across]))
    return {part.name: MARKS[(taken + i) % len(MARKS)] for i, part in enumerate(parts)}
