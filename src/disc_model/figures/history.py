"""Histories: variables against time, over stick and separation."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.errors import require
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import COLUMN, PAGE, leave_to_first, letters, panels
from disc_model.figures.kinds.cases import History
from disc_model.figures.legends import figure_legend
from disc_model.figures.named_axes import Quantities
from disc_model.figures.runs import TIME, ramps_of, sampled, show, spans_in, stated, window_of
from disc_model.figures.shades import shade_phases, shade_ramps
from disc_model.figures.types import Artist, Axes, Figure


def draw(plot: History, case: xr.DataTree) -> Figure:
    """Draw variables of a case in a window, one above the other."""
    rows = len(plot.variables)
    width = plot.inches
    figure, axes = panels(width, 0.8 + 1.3 * rows, rows, sharex=True)
    end = math.inf if plot.until is None else plot.until
    shown = dataset.group(case, plot.window).sel(time=slice(None, end))
    if shown.sizes["time"] < 2:  # the run ended before it
        raise dataset.Missing(
            f"has {shown.sizes['time']} samples in {plot.window}, at least 2 are needed"
        )
    letters(axes)
    handles = draw_history(axes, case, shown, plot.variables)
    figure_legend(figure, [*handles, *shade_ramps(axes, ramps_of(case))])
    figure.align_ylabels()
    return figure


def plot_run(
    case: xr.DataTree,
    windows: Sequence[str],
    variables: Sequence[str],
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Any:
    """Draw variables of a run, a row each, in windows, a column each; returns the axes, squeezed
    as by `pyplot.subplots`."""
    several = isinstance(variables, list | tuple) and len(variables) > 0
    rule = "must be a list of one or more"
    require((several, "variables", variables, rule), (len(windows) > 0, "windows", windows, rule))
    named = [("variables", variable) for variable in variables]
    shown = [window_of(case, name, *named, which="windows") for name in windows]

    rows = len(variables)
    columns = len(windows)
    width = PAGE if columns > 1 else COLUMN
    wishes = Wishes(ax, legend, labels, title)
    height = 0.7 + 1.25 * rows
    with page_for(
        wishes,
        width,
        height,
        rows,
        columns,
        title=stated(case),
        sharex="col",
        sharey="row" if columns > 1 else False,
    ) as page:
        page.show(*_quantities(shown, variables))
        entries: dict[str, Artist] = {}
        grid: Any = np.array(page.axes, dtype=object).reshape(rows, columns)
        for column, window in zip(grid.T, shown, strict=True):
            handles = draw_history(column, case, window, variables)
            leave_to_first(column, grid[:, 0])
            handles += shade_ramps(column, ramps_of(case))
            entries |= {str(handle.get_label()): handle for handle in handles}
        page.explain([*entries.values()])
        if page.own:
            page.figure.align_ylabels()
        else:
            _share_heights(grid)
    return grid.squeeze()[()]


def _quantities(windows: Sequence[xr.Dataset], variables: Sequence[str]) -> list[Quantities]:
    """What the panels show, row by row: a variable each, in all windows."""
    found = []
    for name in variables:
        found += [Quantities(TIME, sampled(name, window)[0]) for window in windows]
    return found


def _stands_above(ax: Axes, other: Axes) -> bool:
    """Whether axes stand above others, whose numbers then are those of both."""
    place = ax.get_position(original=True)
    below = other.get_position(original=True)
    return math.isclose(place.x0, below.x0) and place.y0 >= below.y1


def _share_heights(grid: Any) -> None:
    """Give the axes of each row one range of heights: numbers stand beside the first of them
    only."""
    for row in grid:
        limits = np.array([ax.get_ylim() for ax in row])
        for ax in row:
            ax.set_ylim(limits[:, 0].min(), limits[:, 1].max())


def draw_history(
    axes: Sequence[Axes], case: xr.DataTree, window: xr.Dataset, variables: Sequence[str]
) -> list[Artist]:
    """Draw variables against time, over shaded phases unless these are too dense; returns entries
    of a legend."""
    for ax, name in zip(axes, variables, strict=True):
        show(ax, case, window, name, named=ax is axes[0])
        if _stands_above(ax, axes[-1]):
            ax.set_xlabel("")
            ax.tick_params(labelbottom=False)
    axes[-1].locator_params(axis="x", nbins=6)
    axes[-1].ticklabel_format(axis="x", useOffset=False)

    return shade_phases(axes, spans_in(case, window))
