"""Curves: any variable against one dimension."""

from collections.abc import Mapping

import xarray as xr

from disc_model.figures.curve_lines import draw_lines
from disc_model.figures.curve_looks import choose_marks
from disc_model.figures.drawing import letters, row_of_panels
from disc_model.figures.error_bars import names_errors
from disc_model.figures.kinds.base import key_of
from disc_model.figures.kinds.general import CurvePlot
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.line_names import name_lines
from disc_model.figures.outside_limits import note_outside
from disc_model.figures.selection import Part, parts_along, picked, remaining
from disc_model.figures.settled_motions import without_zeros
from disc_model.figures.truths import as_classes
from disc_model.figures.types import Figure


def draw(plot: CurvePlot, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a line, or one for each value of a second dimension, in one panel or several."""
    panels = panels_of(plot, picked(without_zeros(study), plot.at, plot.x))
    width = plot.inches_of(len(panels))
    figure, axes = row_of_panels(width, len(panels), 2.9, 2.2, sharey=True)
    marks: dict[str, str] = {}
    for part in panels:
        choose_marks(marks, _lines_of(part.data, plot.variable, plot.x))
    alone = len(panels) == 1  # else a line may have values in another panel
    for ax, part in zip(axes, panels, strict=True):
        variable, x = plot.variable, plot.x
        draw_lines(ax, part.data, variable, x, plot.log, marks, names_valueless=alone)
        ax.label_outer()
    in_legend = any(map(names_errors, axes)) or plot.legend
    if plot.limits is not None:
        axes[0].set_ylim(plot.limits)
        in_legend = note_outside(axes, plot.limits) or in_legend
    letters(axes, titles_of_panels(panels, study, plot.by if plot.panels == "each" else None))
    name_lines(figure, axes, several=bool(plot.panels), in_legend=in_legend)
    return figure


def panels_of(plot: CurvePlot, study: xr.Dataset) -> list[Part[xr.Dataset]]:
    """The part of a study in each panel."""
    if plot.panels == "each":
        return parts_shown(study, plot.by, plot.names)
    if plot.by not in study.dims:  # it has one value
        return [Part("", "", study)]
    chosen = [study.sel({plot.by: [*values]}) for values in plot.panels] or [study]
    if plot.names:
        words = [str(value) for value in study[plot.by].values]
        renamed = {word: plot.names.get(key_of(word), word) for word in words}
        chosen = [
            part.assign_coords({plot.by: [renamed[str(x)] for x in part[plot.by].values]})
            for part in chosen
        ]
    return [Part("", "", part) for part in chosen]


def _lines_of(study: xr.Dataset, variable: str, x: str) -> list[Part[xr.DataArray]]:
    """The lines of a variable in a panel."""
    array = as_classes(study, variable)
    return parts_along(array, remaining(array, [x]))
