"""Drawing a figure as a study file describes it, below its head."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.figures.drawing import COLUMN, panels
from disc_model.figures.drawings import drawing_of
from disc_model.figures.heads import values_of_case, values_of_study
from disc_model.figures.kinds import NORM, CasePlot, Compared, General, Kind
from disc_model.figures.labels import COLOUR_BAR, break_labels
from disc_model.figures.least_span import keep_least_span
from disc_model.figures.legends import LEAST_CURVE, LEAST_MAP, keep_height
from disc_model.figures.reader_units import key_by_label, with_limits_of_label
from disc_model.figures.restated_axes import restate_axes
from disc_model.figures.selection import normalizations, of
from disc_model.figures.style import styled
from disc_model.figures.types import Figure
from disc_model.figures.words import UNITS, factors_of, head_text, in_lines

MOST_LINES = 2  # of values above a figure; the caption has all


class Drawn(NamedTuple):
    """A figure, and what stands above it: a title unless the file gives one, and values; and what has the
    unit of an axis, by labels that do not say it."""

    figure: Figure
    title: str
    values: str
    key_by_label: Mapping[str, str] = MappingProxyType({})


def render(plot: Kind, inputs: Mapping[str, xr.DataTree]) -> Figure:
    """Draw a figure from its inputs by name, in the common style and its readers' units, below a
    title unless a caption says the same.

    A figure of cases that lack what it shows says so instead.
    """
    token = UNITS.set(factors_of(plot.units))
    try:
        with styled():
            drawn = (
                _of_cases(plot, inputs) if isinstance(plot, CasePlot) else _of_grid(plot, inputs)
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
            return drawn.figure
    finally:
        UNITS.reset(token)


def _write_title(plot: Kind, figure: Figure, text: str) -> None:
    """Write a title where it covers nothing."""
    if plot.titled_by_legend and figure.legends:
        figure.legends[0].set_title(text)
    else:
        figure.suptitle(text, fontsize=8)


# ---- Figures of cases


def _of_cases(plot: Kind, inputs: Mapping[str, xr.DataTree]) -> Drawn:
    """Draw cases by their names; the reason instead, if one lacks what is needed."""
    cases = [*inputs.values()]
    try:
        figure = drawing_of(plot.kind)(plot, *cases)
    except Missing as reason:
        figure, [ax] = panels(COLUMN, 2)
        ax.set_axis_off()
        text = in_lines(f"not shown: the case {reason}")
        ax.text(0.5, 0.5, text, ha="center", va="center", in_layout=False)
    title = cases[0].attrs.get("title", "") if len(cases) == 1 else ""
    return Drawn(figure, title, values_of_case(cases[0]))


# ---- Figures of grid studies


def _of_grid(plot: Any, inputs: Mapping[str, xr.DataTree]) -> Drawn:
    """Draw a study, the first input, and further ones by their roles."""
    study, *others = (tree.to_dataset() for tree in inputs.values())
    compares_others = isinstance(plot, Compared) and plot.by != NORM
    if NORM not in plot.dims and (compares_others or not plot.several):
        norm = normalizations(study)[0]
        study, *others = (of(dataset, norm) for dataset in (study, *others))
    overlays = dict(zip([*inputs][1:], others, strict=True))
    if isinstance(plot, General):
        plot = with_limits_of_label(plot, study)
    figure = drawing_of(plot.kind)(plot, study, overlays)
    title = study.attrs.get("title", "")
    return Drawn(figure, title, values_of_study(plot, study), key_by_label(plot, study))
