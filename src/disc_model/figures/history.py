"""Histories: variables against time, over stick and separation."""

import math
from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.patches import Patch

from disc_model.data import dataset
from disc_model.data.variables import PHASES, SHOWN
from disc_model.errors import require
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import COLUMN, GREY, PAGE, PHASE_COLOURS, letters, panels, wide
from disc_model.figures.kinds.cases import History
from disc_model.figures.legends import figure_legend
from disc_model.figures.runs import Course, ramps_of, show, spans_in, stated, window_of
from disc_model.figures.types import Artist, Axes, Figure

MOST_SHADED = 60
"""Largest number of stretches of one phase that are shaded; more would be as dense as a fill."""
SHADES: dict[str, dict[str, Any]] = {
    "stick": {"color": PHASE_COLOURS["stick"], "alpha": 0.22},
    "separation": {"color": PHASE_COLOURS["separation"], "alpha": 0.5},
}
"""Behind a history, told apart by darkness in grey print; slip is left white."""
RAMPS: tuple[dict[str, Any], ...] = (
    {"facecolor": GREY, "alpha": 0.18, "linewidth": 0, "zorder": -1},
    {"facecolor": "none", "edgecolor": GREY, "hatch": 5 * "/", "linewidth": 0, "zorder": -1},
    {"facecolor": "none", "edgecolor": GREY, "hatch": 3 * ".", "linewidth": 0, "zorder": -1},
)
"""Behind a history, while a ramp goes on: of each parameter in the order of their ramps."""
MOST_RAMPS = 4
"""Largest number of ramps with an entry for each in the legend."""


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
    figure_legend(figure, draw_history(axes, case, shown, plot.variables))
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
        entries: dict[str, Artist] = {}
        grid: Any = np.array(page.axes, dtype=object).reshape(rows, columns)
        for column, window in zip(grid.T, shown, strict=True):
            handles = draw_history(column, case, window, variables)
            _leave_to_first(column, grid[:, 0])
            handles += _draw_ramps(column, case)
            entries |= {str(handle.get_label()): handle for handle in handles}
        page.explain([*entries.values()])
        if page.own:
            page.figure.align_ylabels()
        else:
            _share_heights(grid)
    return grid.squeeze()[()]


def _leave_to_first(column: Sequence[Axes], first: Sequence[Axes]) -> None:
    """Leave names and numbers of the vertical axes to the first column, if it stands beside this
    one."""
    for ax, left in zip(column, first, strict=True):
        places = [each.get_position(original=True) for each in (left, ax)]
        if math.isclose(places[0].y0, places[1].y0) and places[0].x1 < places[1].x0:
            ax.set_ylabel("")
            ax.tick_params(labelleft=False)


def _stands_above(ax: Axes, other: Axes) -> bool:
    """Whether axes stand above others, whose numbers then are those of both."""
    place = ax.get_position(original=True)
    below = other.get_position(original=True)
    return math.isclose(place.x0, below.x0) and place.y0 >= below.y1


def _draw_ramps(axes: Sequence[Axes], case: xr.DataTree) -> list[Artist]:
    """Shade the time of each ramp that is seen, between lines where it begins and ends; returns
    entries of a legend, which state its values, or one for many ramps of a parameter."""
    low, high = axes[0].get_xlim()
    ramps = ramps_of(case)
    ramped = dict.fromkeys(ramp.parameter for ramp in ramps)
    looks = dict(zip(ramped, cycle(RAMPS), strict=False))
    seen = [ramp for ramp in ramps if ramp.start < high and ramp.end > low]
    for ramp in seen:
        for ax in axes:
            ax.axvspan(ramp.start, ramp.end, **looks[ramp.parameter])
            for time in (ramp.start, ramp.end):
                ax.axvline(time, color=GREY, linewidth=wide(0.6), linestyle=":")
    for ax in axes:
        ax.set_xlim(low, high)
    if len(seen) > MOST_RAMPS:
        names = dict.fromkeys(ramp.parameter for ramp in seen)
        return [Patch(label=f"ramps of {SHOWN[name].symbol}", **looks[name]) for name in names]
    return [Patch(label=_ramp_text(ramp), **looks[ramp.parameter]) for ramp in seen]


def _ramp_text(ramp: Course) -> str:
    """What a legend says of a ramp."""
    shown = SHOWN[ramp.parameter]
    ends = [f"{shown.factor * value:.4g}" for value in (ramp.before, ramp.after)]
    times = f"{ramp.start:g} to {ramp.end:g} s"
    return f"{shown.symbol} from {ends[0]} to {ends[1]} {shown.unit}, {times}"


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

    spans = spans_in(case, window)
    if not 0 < max(len(spans[name]) for name in SHADES) <= MOST_SHADED:
        return []
    for name, look in SHADES.items():
        bars = [(start, stop - start) for start, stop in spans[name]]
        for ax in axes:
            whole = ax.get_xaxis_transform()
            ax.broken_barh(bars, (0, 1), transform=whole, linewidth=0, zorder=0, **look)
    return [_shade(name) for name in PHASES if spans[name]]


def _shade(phase: str) -> Artist:
    """The legend entry of a phase."""
    if phase in SHADES:
        return Patch(label=phase, **SHADES[phase])
    return Patch(label=phase, facecolor="white", edgecolor=GREY, linewidth=0.5)
