"""Histories: variables against time, over stick and separation."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.errors import require
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.case_lines import Lines, Style, limits_of_motion
from disc_model.figures.drawing import COLUMN, PAGE, leave_to_first, leave_to_last, sample
from disc_model.figures.growing_runs import growth_entries, growth_note
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import Case, draw_case, is_beside, name_of_case
from disc_model.figures.runs import TIME, end_of_ranges, sampled, show, spans_in, window_of
from disc_model.figures.shades import shade_phases, shade_ramps
from disc_model.figures.stated_case import ramps_of, size_of, stated, told_apart
from disc_model.figures.types import Artist, Axes

LINE = 0.8  # points, width of the lines of several runs,
SAMPLE = 1.2  # and of those in the legend
BAND = 0.2  # opacity of their ranges
BEFORE_END = "Time before the end of each run (s)"
"""Name of the time where runs of several lengths are seen at their ends."""
ROOM = 0.05  # free share of the values above and below them


def plot_run(
    case: xr.DataTree,
    windows: Sequence[str],
    variables: Sequence[str],
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
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
    name, labels = name_of_case(labels)
    wishes = Wishes(ax, legend, labels, title)
    height = 0.7 + 1.25 * rows
    stacked = 0.0
    if rows == 1:
        stacked = height
    with page_for(
        wishes,
        width,
        height,
        rows,
        columns,
        title=stated(case),
        stacked=stacked,
        sharex="col",
        sharey="row" if columns > 1 else False,
    ) as page:
        page.show(*_quantities(shown, variables))
        apart = told_apart(case, name, window=f"window {windows[0]}")
        overlaid = Case("run", apart, stated(case), ending=growth_note(case, shown))
        panels = [_lines(case, window, variable) for variable in variables for window in shown]
        grid: Any = np.array(page.axes, dtype=object).reshape(rows, columns)
        alone = draw_case(
            page, overlaid, panels, lambda: _draw_alone(page, grid, case, shown, variables)
        )
        for column in grid.T:
            leave_to_first(column, grid[:, 0])
            if not alone:
                leave_to_last(column)
    return grid.squeeze()[()]


def _draw_alone(
    page: Page,
    grid: Any,
    case: xr.DataTree,
    windows: Sequence[xr.Dataset],
    variables: Sequence[str],
) -> None:
    """Draw variables of one run, with its phases and ramps, on a grid of axes."""
    entries: dict[str, Artist] = {}
    for column, window in zip(grid.T, windows, strict=True):
        twin = is_beside(column[0], "run")
        handles = draw_history(column, case, window, variables, marked=not twin)
        handles += shade_ramps([] if twin else column, ramps_of(case))
        entries.update({str(handle.get_label()): handle for handle in handles})
    page.explain([*entries.values(), *growth_entries(case, windows)])
    if page.own:
        page.figure.align_ylabels()
    else:
        _share_heights(grid)


def _quantities(windows: Sequence[xr.Dataset], variables: Sequence[str]) -> list[Quantities]:
    """What the panels show, row by row: a variable each, in all windows."""
    found = []
    for name in variables:
        found += [Quantities(TIME, sampled(name, window)[0]) for window in windows]
    return found


def _number_times(ax: Axes) -> None:
    """Have few and whole numbers along the time."""
    ax.locator_params(axis="x", nbins=6)
    ax.ticklabel_format(axis="x", useOffset=False)


def _share_heights(grid: Any) -> None:
    """Give the axes of each row one range of heights: numbers stand beside the first of them
    only."""
    for row in grid:
        limits = np.array([ax.get_ylim() for ax in row])
        for ax in row:
            ax.set_ylim(limits[:, 0].min(), limits[:, 1].max())


def _lines(case: xr.DataTree, window: xr.Dataset, name: str) -> Lines:
    """How a variable in a window is drawn beside those of other runs: as a line, or as a band that
    these show through, with edges in the look of the run."""
    label, factor, _ = sampled(name, window)
    time = window["time"].values
    ranges = f"{name}_min" in window
    ends = [f"{name}_min", f"{name}_max"] if ranges else [name, name]
    low, high = (window[end].values * factor for end in ends)

    def draw(ax: Axes, style: Style) -> Artist:
        line = style.look.line(LINE)
        shown = time - time[-1] if style.from_end else time
        if ranges:
            ax.fill_between(shown, low, high, color=style.look.colour, alpha=BAND, linewidth=0)
            ax.plot(shown, low, **line)
        ax.plot(shown, high, **line)
        ax.set_xlabel(BEFORE_END if style.from_end else TIME)
        ax.set_ylabel(label)
        _number_times(ax)
        return sample(**style.look.line(SAMPLE))

    stretch = (float(time[0]), float(time[-1]))
    across = (0.0, end_of_ranges(time)) if ranges else stretch
    size = size_of(name, case) * factor
    upward = limits_of_motion(np.concatenate([low, high]), ROOM, size)
    lines = Lines(draw, (across, upward), label.rpartition(" (")[0])
    return lines if ranges else lines._replace(stretch=stretch)


def draw_history(
    axes: Sequence[Axes],
    case: xr.DataTree,
    window: xr.Dataset,
    variables: Sequence[str],
    *,
    marked: bool = True,
) -> list[Artist]:
    """Draw variables against time, over shaded phases unless these are too dense; returns entries
    of a legend.

    marked : whether phases are shaded and the first separation is named here, and not on other axes
        on the same place
    """
    for ax, name in zip(axes, variables, strict=True):
        show(ax, case, window, name, named=marked and ax is axes[0])
        _number_times(ax)
    leave_to_last(axes)

    return shade_phases(axes if marked else [], spans_in(case, window))
