"""Figures of cases and of grid studies from their inputs, and what stands above them."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.figures.drawing import COLUMN, panels
from disc_model.figures.drawings import drawing_of
from disc_model.figures.heads import values_of_case, values_of_study
from disc_model.figures.kinds import NORM, Compared, General, Kind
from disc_model.figures.reader_units import key_by_label, with_limits_of_label
from disc_model.figures.selection import normalizations, of
from disc_model.figures.types import Figure
from disc_model.figures.value_texts import in_lines


class Drawn(NamedTuple):
    """A figure, and what stands above it: a title unless the file gives one, and values; and what has the
    unit of an axis, by labels that do not say it."""

    figure: Figure
    title: str
    values: str
    key_by_label: Mapping[str, str] = MappingProxyType({})


def drawn_of_cases(plot: Kind, inputs: Mapping[str, xr.DataTree]) -> Drawn:
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


def drawn_of_grid(plot: Any, inputs: Mapping[str, xr.DataTree]) -> Drawn:
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
