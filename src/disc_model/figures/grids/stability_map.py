"""Stability maps: outcome of the static start over two parameters, and the growth rate of the stick-slip cycle.

Studies of the quantity `outcome` are drawn as marks over the growth rate; for `regions` see `region_map`.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.cells import CYCLE_LOOKS, OUTCOME_LOOKS, growth_panels, patches, scale_of
from disc_model.figures.kinds import StabilityMap
from disc_model.figures.parts import BLACK, PAGE, PAPER, new_figure

MARKS: dict[str, dict[str, Any]] = {
    "quiet": {"marker": "o", "facecolor": "white", "s": 9},
    "steady_sliding": {"marker": "o", "facecolor": "#c9b8dc", "s": 9},
    "at_rest": {"marker": "o", "facecolor": "#b9dcc6", "s": 9},
    "other_cycle": {"marker": "v", "facecolor": "white", "s": 13},
    "growing": {"marker": "^", "facecolor": "#9a9a9a", "s": 13},
    "undecided": {"marker": "D", "facecolor": "white", "s": 9},
    "separation": {"marker": "s", "facecolor": BLACK, "s": 10},
    "failed": {"marker": "X", "facecolor": BLACK, "s": 12},
}
"""The mark of each outcome."""
LARGE = 55.0
"""Area of the marks of the paper."""


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: StabilityMap) -> Figure:
    """Draw one panel per normalization and one mark per point, over the further study ``growth`` if it is given."""
    norms = parts.normalizations(study)
    figure = new_figure(PAGE, 3.3)
    axes = figure.subplots(1, len(norms), sharex=True, sharey=True, squeeze=False)
    parts.letters(axes[0], [parts.MODES[norm] for norm in norms])
    for ax, norm in zip(axes[0], norms, strict=True):
        _points(ax, parts.of(study, norm), plot)
    handles = finish(axes, study, plot)
    if "growth" in overlays:
        growth = [parts.of(overlays["growth"], norm) for norm in norms]
        gaps = growth_panels(figure, axes[0], growth, plot.x, plot.y)
        for ax, one in zip(axes[0], growth, strict=True):
            _neutral_line(ax, one, plot)
        handles = [Line2D([], [], **parts.border("neutral")), *patches(CYCLE_LOOKS, gaps), *handles]
    present = set(flag_names(study["outcome"]).flat)
    look: dict[str, Any] = {"linewidth": 0.5, "edgecolor": BLACK}
    marks = [name for name in MARKS if name in present]
    empty = [axes[0, 0].scatter([], [], label=OUTCOME_LOOKS[name].label, **look, **MARKS[name]) for name in marks]
    legend_above(figure, [*empty, *handles])
    return figure


def _neutral_line(ax: Axes, growth: xr.Dataset, plot: StabilityMap) -> None:
    """Draw the line on which the growth rate changes its sign."""
    x, y = (growth[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y))
    rate = growth["growth_rate"].transpose(plot.y, plot.x).values
    if min(rate.shape) > 1 and np.isfinite(rate).any() and np.nanmin(rate) < 0 < np.nanmax(rate):
        ax.contour(x, y, np.ma.masked_invalid(rate), levels=[0.0], colors=BLACK, linewidths=1.0)


def _points(ax: Axes, study: xr.Dataset, plot: StabilityMap) -> None:
    x, y = np.meshgrid(*(study[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y)))
    outcome = flag_names(study["outcome"].transpose(plot.y, plot.x))
    for name, look in MARKS.items():
        there = outcome == name
        ax.scatter(x[there], y[there], linewidth=0.5, edgecolor=BLACK, zorder=3, clip_on=False, **look)


# ----------------------------------------------------------------------------------------------------
# Common parts of all maps of outcomes


def finish(axes: np.ndarray, study: xr.Dataset, plot: StabilityMap) -> list[Artist]:
    """Scale and label the axes, and mark the paper's cases in the first panel, if it has the published modes.

    axes : shape (rows, columns), all over the same two parameters
    """
    set_scales(axes, study, plot)
    if parts.normalizations(study)[0] != "as_published":
        return []
    for name in plot.marks:
        _paper_mark(axes[0, 0], plot, name)
    return _paper_handles(plot)


def _paper_mark(ax: Axes, plot: StabilityMap, name: str) -> None:
    """Draw a large open mark whose shape is the paper's outcome, and beside it the case's name, towards the middle."""
    mark = plot.marks[name]
    at = (mark.x * parts.axis_of(plot.x)[1], mark.y * parts.axis_of(plot.y)[1])
    ring: dict[str, Any] = {
        "marker": MARKS[mark.paper_outcome]["marker"],
        "facecolor": "none",
        "zorder": 4,
        "clip_on": False,
    }
    for color, width in ((BLACK, 2.4), (PAPER, 1.4)):
        ax.scatter(*at, LARGE, edgecolor=color, linewidth=width, **ring)
    across, up = (ax.transData + ax.transAxes.inverted()).transform(at)
    offset = (-6 if across > 0.85 else 6, -5 if up > 0.85 else 5)
    parts.say(ax, name, at, offset, fontsize=7, zorder=5, annotation_clip=False, path_effects=parts.halo(2.0))


def _paper_handles(plot: StabilityMap) -> list[Artist]:
    """Legend entries, one for each shape among the marks."""
    outcomes = {mark.paper_outcome for mark in plot.marks.values()}
    ring: dict[str, Any] = {"linestyle": "", "markerfacecolor": "none", "markersize": 6, "markeredgewidth": 1.4}
    ring |= {"markeredgecolor": PAPER, "path_effects": [withStroke(linewidth=2.4, foreground=BLACK)]}
    return [
        Line2D([], [], marker=look["marker"], label=f"paper: {OUTCOME_LOOKS[name].label}", **ring)
        for name, look in MARKS.items()
        if name in outcomes
    ]


def set_scales(axes: np.ndarray, study: xr.Dataset, plot: StabilityMap) -> None:
    """Set limits, labels and scales; a logarithmic scale with a 0 is linear up to the second value.

    axes : shape (rows, columns)
    """
    for name, which in ((plot.x, "x"), (plot.y, "y")):
        label, factor = parts.axis_of(name)
        values = study[name].values * factor
        scale = scale_of(name, values)
        for ax in axes.flat:
            axis = getattr(ax, f"{which}axis")
            if scale != "linear":
                start = {"linthresh": values[1], "linscale": 0.4} if scale == "symlog" else {}
                getattr(ax, f"set_{which}scale")(scale, **start)
                axis.set_major_locator(FixedLocator(_round_values(values)))
                axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
                axis.set_minor_formatter(NullFormatter())
            to_axis = axis.get_transform()
            low, high = to_axis.transform(values[[0, -1]])
            margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
            getattr(ax, f"set_{which}lim")(to_axis.inverted().transform([low - margin, high + margin]))
        for ax in axes[-1] if which == "x" else axes[:, 0]:
            ax.set(**{f"{which}label": label})


def _round_values(values: np.ndarray) -> list[float]:
    """The values 1, 2 and 5 of each decade within the range, and its ends."""
    positive = values[values > 0]
    decades = 10.0 ** np.arange(np.floor(np.log10(positive[0])), np.ceil(np.log10(positive[-1])) + 1)
    steps = np.outer(decades, [1.0, 2.0, 5.0]).ravel()
    inside = steps[(steps >= 0.999 * positive[0]) & (steps <= 1.001 * positive[-1])]
    return [*([0.0] if values[0] == 0 else []), *inside.tolist()]


def legend_above(figure: Figure, handles: Iterable[Artist]) -> None:
    """Draw a legend over all panels; `parts.head` is its title."""
    shown = list(handles)
    figure.legend(handles=shown, loc="outside upper center", ncols=min(len(shown), 4), title_fontsize=8)
