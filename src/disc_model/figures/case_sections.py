"""Figures of the Poincaré sections of cases as a study file describes them."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import values_text
from disc_model.figures.drawing import PAGE, letters, new_figure
from disc_model.figures.kinds.cases import PoincareSections
from disc_model.figures.legends import figure_legend
from disc_model.figures.poincare import STACKED, draw_sections
from disc_model.figures.types import Figure


def sections_of_cases(plot: PoincareSections, *cases: xr.DataTree) -> Figure:
    """Draw the sections of cases, a row each, on common axes."""
    width = plot.inches
    rows_of_case, height = (1, 2.75) if width == PAGE else (2, 2 * STACKED)
    figure = new_figure(width, height * len(cases))
    rows = np.atleast_1d(np.asarray(figure.subfigures(len(cases), 1)))
    sections = [dataset.samples(case, "poincare", at_least=1) for case in cases]
    for row, case, samples, heading in zip(rows, cases, sections, _headings(cases), strict=True):
        axes = list(np.ravel(row.subplots(rows_of_case, 2 // rows_of_case)))
        handles = draw_sections(axes, case, samples, sections, heading)
        figure_legend(row, handles, handletextpad=0.2)
    letters(figure.axes)
    return figure


def _headings(cases: Sequence[xr.DataTree]) -> list[str]:
    """What tells each case from the others: the parameters that they do not share, and the title of
    a case whose parameters are those of another one."""
    differing = _differing([json.loads(case.attrs["parameters"]) for case in cases])
    texts = [values_text(values) for values in differing]
    headings = []
    for case, text in zip(cases, texts, strict=True):
        title = ""
        if texts.count(text) > 1:
            title = case.attrs.get("title", "")
        headings.append(", ".join(filter(None, [title, text])))
    return headings


def _differing(parameters: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Of each case, the parameters that it does not share with all others."""
    first = parameters[0]
    names = [name for name in first if any(p[name] != first[name] for p in parameters)]
    return [{name: p[name] for name in names} for p in parameters]
