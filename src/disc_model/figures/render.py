"""Drawing a figure as a study file describes it: the table of the kinds' drawings, and the head of
each figure."""

import json
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.figures import (
    basins,
    bifurcation,
    branches,
    campbell,
    case_figures,
    critical_speed,
    curve,
    escape,
    heat_map,
    late_range,
    locking,
    ramps,
    range_law,
    region_map,
    root_locus,
    sensitivity,
    sliding_modes,
    sliding_outcome,
    spectrogram,
)
from disc_model.figures.drawing import COLUMN, panels
from disc_model.figures.kinds import NORM, CasePlot, Compared, General, Kind, Plot, table_of
from disc_model.figures.labels import COLOUR_BAR, break_labels, restate_axes
from disc_model.figures.least_span import keep_least_span
from disc_model.figures.legends import LEAST_CURVE, LEAST_MAP, keep_height
from disc_model.figures.runs import with_ramps
from disc_model.figures.selection import normalizations, of, picked
from disc_model.figures.style import styled
from disc_model.figures.types import Figure
from disc_model.figures.words import (
    MODES,
    UNITS,
    factors_of,
    head_text,
    in_lines,
    named_value,
    what_case,
)

Drawings = Mapping[str, Callable[..., Figure]]
DRAWINGS: Drawings = {
    "basins": basins.draw,
    "bifurcation": bifurcation.draw,
    "branches": branches.draw,
    "campbell": campbell.draw,
    "critical_speed": critical_speed.draw,
    "curve": curve.draw,
    "escape": escape.draw,
    "heat_map": heat_map.draw,
    "history": case_figures.history,
    "late_range": late_range.draw,
    "phase_map": locking.draw_map,
    "poincare": case_figures.sections_of_cases,
    "portrait": case_figures.portrait,
    "ramps": ramps.draw,
    "range_law": range_law.draw,
    "region_map": region_map.draw,
    "root_locus": root_locus.draw,
    "sensitivity": sensitivity.draw,
    "sliding_modes": sliding_modes.draw,
    "sliding_outcome": sliding_outcome.draw,
    "spectrogram": spectrogram.draw,
    "spectrum": case_figures.spectrum,
    "staircase": locking.draw_staircase,
}
"""Functions that draw a kind: from the figure, its study and further ones by their roles, or from the
figure and its cases."""


MOST_LINES = 2  # of values above a figure; the caption has all


class Drawn(NamedTuple):
    """A figure, and what stands above it: a title unless the file gives one, and values."""

    figure: Figure
    title: str
    values: str


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
            restate_axes(drawn.figure)
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


def drawing_of(kind: str) -> Callable[..., Figure]:
    """The function that draws a kind, such as ``heat_map`` or ``paper.light_slider``."""
    part = kind.rpartition(".")[0]
    drawings: Drawings = table_of(part, "drawings", "DRAWINGS") if part else DRAWINGS
    return drawings[kind]


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
    values = json.loads(cases[0].attrs.get("parameters", "{}"))
    title = cases[0].attrs.get("title", "") if len(cases) == 1 else ""
    return Drawn(figure, title, with_ramps(what_case(values), values, cases[0]))


# ---- Figures of grid studies


def _of_grid(plot: Any, inputs: Mapping[str, xr.DataTree]) -> Drawn:
    """Draw a study, the first input, and further ones by their roles."""
    study, *others = (tree.to_dataset() for tree in inputs.values())
    compares_others = isinstance(plot, Compared) and plot.by != NORM
    if NORM not in plot.dims and (compares_others or not plot.several):
        norm = normalizations(study)[0]
        study, *others = (of(dataset, norm) for dataset in (study, *others))
    overlays = dict(zip([*inputs][1:], others, strict=True))
    figure = drawing_of(plot.kind)(plot, study, overlays)
    texts = [*_chosen(plot, study), _stated(study), *_single_modes(plot, study)]
    return Drawn(figure, study.attrs.get("title", ""), ", ".join(filter(None, texts)))


def _stated(study: xr.Dataset) -> str:
    """The values of a study's base that it does not vary."""
    base = json.loads(study.attrs.get("base", "{}"))
    # 0 stands for N or Omega if the quantity varies it by itself
    by_itself = [name for name in ("N", "Omega") if not base.get(name)]
    varied = {*map(str, study.coords), *by_itself}
    return what_case({name: value for name, value in base.items() if name not in varied})


def _single_modes(plot: Plot, study: xr.Dataset) -> list[str]:
    """The normalization of a study that has one, which no panel names."""
    modes = normalizations(study) if NORM in study.coords else []
    chosen = getattr(plot, NORM, None)
    if chosen is not None:
        modes = [chosen]
    return [MODES[modes[0]]] if len(modes) == 1 else []


def _chosen(plot: Plot, study: xr.Dataset) -> list[str]:
    """Values along dimensions of the study that a general figure takes at one place."""
    if not isinstance(plot, General):
        return []
    shown = picked(study, plot.at)[plot.variable]
    alone = [str(name) for name, size in study.sizes.items() if size > 1 and name not in shown.dims]
    return [named_value(shown, name) for name in alone if name in shown.coords]
