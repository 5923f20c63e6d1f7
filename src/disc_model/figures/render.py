"""Drawing a figure as a study file describes it, below its head."""

from collections.abc import Mapping

import xarray as xr

from disc_model.figures.axis_numbers import UNEVEN, spare_heights, spare_numbers
from disc_model.figures.drawn_inputs import drawn_of_cases, drawn_of_grid
from disc_model.figures.head_texts import head_text
from disc_model.figures.kinds import CasePlot, General, Kind
from disc_model.figures.labels import COLOUR_BAR, break_labels
from disc_model.figures.least_span import keep_least_span
from disc_model.figures.legends import LEAST_CURVE, LEAST_MAP, keep_height
from disc_model.figures.places import set_places
from disc_model.figures.restated_axes import restate_axes
from disc_model.figures.style import styled
from disc_model.figures.types import Figure
from disc_model.figures.words import UNITS, factors_of

MOST_LINES = 2  # of values above a figure; the caption has all


def render(plot: Kind, inputs: Mapping[str, xr.DataTree]) -> Figure:
    """Draw a figure from its inputs by name, in the common style and its readers' units, below a
    title unless a caption says the same.

    A figure of cases that lack what it shows says so instead.
    """
    token = UNITS.set(factors_of(plot.units))
    try:
        with styled():
            drawn = (
                drawn_of_cases(plot, inputs)
                if isinstance(plot, CasePlot)
                else drawn_of_grid(plot, inputs)
            )
            restate_axes(drawn.figure, drawn.key_by_label)
            keep_least_span(drawn.figure.axes)
            width = drawn.figure.get_figwidth()
            text = head_text(width, plot.title or drawn.title, drawn.values, MOST_LINES)
            if text and not plot.caption:
                _write_title(plot, drawn.figure, text)
            break_labels(drawn.figure)  # below the title, which leaves them less room
            least = LEAST_MAP if plot.is_map else LEAST_CURVE
            if plot.is_map or isinstance(plot, General):
                shown = [ax for ax in drawn.figure.axes if ax.get_label() != COLOUR_BAR]
                keep_height(drawn.figure, shown, least)
            _spare_numbers(drawn.figure)
            return drawn.figure
    finally:
        UNITS.reset(token)


def _spare_numbers(figure: Figure) -> None:
    """Hide numbers beside uneven scales where they would meet."""
    uneven = [ax for ax in figure.axes if ax.get_yscale() in UNEVEN]
    if not uneven:
        return
    set_places(figure)
    for ax in uneven:
        if ax.get_label() == COLOUR_BAR:
            spare_numbers(ax)
        else:
            spare_heights(ax)


def _write_title(plot: Kind, figure: Figure, text: str) -> None:
    """Write a title where it covers nothing."""
    if plot.titled_by_legend and figure.legends:
        figure.legends[0].set_title(text)
    else:
        figure.suptitle(text, fontsize=8)
