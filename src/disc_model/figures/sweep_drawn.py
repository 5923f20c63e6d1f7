"""Lines of sweeps, beside those that axes have already."""

from typing import Any

import xarray as xr

from disc_model.figures.curve_lines import draw_lines
from disc_model.figures.curve_marks import MARKS
from disc_model.figures.curve_points import draw_points
from disc_model.figures.curve_samples import MOST_NAMED, draw_samples
from disc_model.figures.family import LOOKS
from disc_model.figures.sweep_choice import Drawn
from disc_model.figures.types import Axes


def draw_each(
    ax: Axes, study: xr.Dataset, drawn: Drawn, log: bool, number: int
) -> list[tuple[str, Any]]:
    """Draw a line, or one for each value of a second dimension; many samples have one name, and
    values that are only counted are points.

    number : of lines that were drawn there before
    """
    across = drawn.across
    look = LOOKS[number % len(LOOKS)]
    mark = MARKS[number % len(MARKS)]
    if drawn.counted:
        shape = mark if number else "."
        return draw_points(ax, study, drawn.variable, across, log, look, shape)
    if drawn.sampled and study.sizes[drawn.second] > MOST_NAMED:
        return draw_samples(ax, study, drawn.variable, across, log, look, mark)
    options: dict[str, Any] = {"joined": drawn.joined, "single": look}
    if drawn.second is None:
        return draw_lines(ax, study, drawn.variable, across, log, {"": mark}, **options)
    return draw_lines(ax, study, drawn.variable, across, log, sweep=number, **options)
