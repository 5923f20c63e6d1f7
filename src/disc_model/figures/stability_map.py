"""Stability maps: outcome of the static start over two parameters, and the growth rate of the stick-slip cycle.

Studies of the quantity `outcome` are drawn as marks over the growth rate, those of `regions` as cells beside it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures import cells, drawing
from disc_model.figures.cells import CYCLE_LOOKS, OUTCOME_LOOKS, growth_panels, patches
from disc_model.figures.drawing import BLACK, BORDERS, MODES, PAGE, PAPER, panels
from disc_model.figures.growth_map import curves_of, draw_curves, parted, span
from disc_model.figures.kinds import Mark, RegionMap, StabilityMap

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
EDGE = [withStroke(linewidth=2.4, foreground=BLACK)]
"""Black edges of the paper's marks."""


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: StabilityMap) -> Figure:
    """Draw one panel per normalization and one mark per point, over the further study ``growth`` if it is given."""
    norms = drawing.normalizations(study)
    figure, axes = panels(PAGE, 3.3, 1, len(norms), sharex=True, sharey=True)
    drawing.letters(axes, [MODES[norm] for norm in norms])
    marks: dict[str, Artist] = {}
    for ax, one in zip(axes, _planes(study, norms, plot), strict=True):
        x, y = np.meshgrid(*(one[name].values * drawing.axis_of(name)[1] for name in (plot.x, plot.y)))
        outcome = flag_names(one["outcome"])
        for name, look in MARKS.items():
            if (there := outcome == name).any():
                marks[name] = ax.scatter(x[there], y[there], zorder=3, clip_on=False, lw=0.5, edgecolor=BLACK, **look)
                marks[name].set_label(OUTCOME_LOOKS[name].label)
    handles = finish(axes, study, plot)
    if "growth" in overlays:
        growth = _planes(overlays["growth"], norms, plot)
        gaps = growth_panels(figure, axes, growth)
        for ax, one in zip(axes, growth, strict=True):
            x, y = (one[name].values * drawing.axis_of(name)[1] for name in (plot.x, plot.y))
            rate = one["growth_rate"].values
            # the line on which the growth rate changes its sign
            if min(rate.shape) > 1 and np.isfinite(rate).any() and np.nanmin(rate) < 0 < np.nanmax(rate):
                ax.contour(x, y, np.ma.masked_invalid(rate), levels=[0.0], colors=BLACK, linewidths=1.0)
        handles = [Line2D([], [], **BORDERS["neutral"]), *patches(CYCLE_LOOKS, gaps), *handles]
    _legend_above(figure, [*(marks[name] for name in MARKS if name in marks), *handles])
    return figure


def draw_regions(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: RegionMap) -> Figure:
    """Draw two panels for each normalization, outcomes and growth rates; the paper's cases are marked.

    Lines come from the further study ``curves``, if it is given, and else lie between cells.
    """
    norms = drawing.normalizations(study)
    shown = _planes(study, norms, plot)
    figure, axes = panels(PAGE, 5.6, 2, len(norms), sharex=True, sharey=True)
    above, below = axes[: len(norms)], axes[len(norms) :]
    drawing.letters(axes, [MODES[norm] for norm in norms])
    gaps = growth_panels(figure, below, shown) - {"alone"}
    # branches are continued along the study's first dimension, which may be either axis
    upward = [name for name in study["outcome"].dims if name in (plot.x, plot.y)] == [plot.y, plot.x]
    outcomes: set[str] = set()
    lines: list[Artist] = []
    for upper, lower, one in zip(above, below, shown, strict=True):
        outcomes |= cells.outcome_cells(upper, one["outcome"])
        for ax in (upper, lower):
            lines += _curves(ax, one, overlays["curves"]) if "curves" in overlays else _borders(ax, one, upward)
    named = {line.get_label(): line for line in lines}.values()
    _legend_above(figure, [*patches(cells.CELL_LOOKS, outcomes), *named, *finish(axes, study, plot)])
    said = Line2D([], [], linestyle="", label="\n".join(_captions(study, plot)))
    handles = [*patches(CYCLE_LOOKS, gaps), said]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def _curves(ax: Axes, data: xr.Dataset, curves: xr.Dataset) -> list[Line2D]:
    """Draw continued curves of the map's cycle, within its points; growth maps show their numbers."""
    found = []
    for curve in parted(curves_of(drawing.of(curves, drawing.normalizations(data)[0])), data)[0]:
        along = {"Omega": curve.Omega, "N": curve.N}
        inside = [values == np.clip(values, *span(data[name].values)) for name, values in along.items()]
        found.append(replace(curve, N=np.where(np.all(inside, axis=0), curve.N, np.nan), label=""))
    return draw_curves([ax], [found], [])


def _borders(ax: Axes, data: xr.Dataset, upward: bool) -> list[Line2D]:
    """Draw borders between cells: where the same cycle changes its stability, and where a stable one ends.

    A cycle ends where the next cell has no cycle and the motion does not stay quiet there. A start that follows no
    cycle, or another one, does not prove an end. Nothing is drawn around unresolved cells.

    upward : whether the study's first dimension is the vertical one
    """
    x, y = cells.edges_of(data["outcome"])
    state = cells.stability_of(data)
    state[cells.unresolved(state)] = "unresolved"
    stable, unstable = state == "stable", state == "unstable"
    gone = (flag_names(data["cycle"]) == "no_cycle") & (flag_names(data["outcome"]) != "quiet")
    names = ("branch_continues_first", "branch_continues_second")
    up, right = names if upward else names[::-1]
    found: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    for joined, ahead, here, ends in (
        (up, np.s_[1:, :], np.s_[:-1, :], lambda i, j: [(x[j], y[i + 1]), (x[j + 1], y[i + 1])]),
        (right, np.s_[:, 1:], np.s_[:, :-1], lambda i, j: [(x[j + 1], y[i]), (x[j + 1], y[i + 1])]),
    ):
        same = flag_names(data[joined])[here] == "yes"
        changes = (stable[here] & unstable[ahead]) | (unstable[here] & stable[ahead])
        stops = (stable[here] & gone[ahead]) | (gone[here] & stable[ahead])
        found["neutral"] += [ends(i, j) for i, j in np.argwhere(changes & same)]
        found["fold"] += [ends(i, j) for i, j in np.argwhere(stops)]
    for kind, lines in found.items():
        ax.add_collection(LineCollection(lines, capstyle="projecting" if kind == "neutral" else None, **BORDERS[kind]))
    return [Line2D([], [], **BORDERS[kind]) for kind, lines in found.items() if lines]


def _captions(study: xr.Dataset, plot: RegionMap) -> Iterator[str]:
    """Captions: the horizon, and disagreements between paper, start and cycle."""
    yield f"Within {stated_in(study, 'options')['horizon']:g} s of the static start."
    if "as_published" not in drawing.normalizations(study):
        return
    data = drawing.of(study, "as_published")
    for name, mark in plot.marks.items():
        here = data.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome, rate = str(flag_names(here["outcome"])), float(here["growth_rate"])
        found = OUTCOME_LOOKS[outcome].label
        if outcome != mark.paper_outcome:
            stated = OUTCOME_LOOKS[mark.paper_outcome].label
            yield f"{name}: paper: “{stated}”, static start: {found}."
        if (outcome == "quiet") != (rate < 0) and np.isfinite(rate):
            kind = "stable" if rate < 0 else "unstable"
            why = "another motion is reached" if rate < 0 else "its growth is not seen within the horizon"
            yield f"{name}: {found}, beside a cycle that is {kind} ({rate:.2g}/s): {why}."


# ----------------------------------------------------------------------------------------------------
# Common parts of both


def _planes(study: xr.Dataset, norms: Sequence[str], plot: StabilityMap) -> list[xr.Dataset]:
    """A study over the two parameters, the vertical one first, for each normalization."""
    return [drawing.of(study, norm).transpose(plot.y, plot.x, ...) for norm in norms]


def finish(axes: Sequence[Axes], study: xr.Dataset, plot: StabilityMap) -> list[Artist]:
    """Scale and label the shared axes, and mark the paper's cases in the first panel, if it has the published modes.

    Returns legend entries, one for each shape among the marks.
    """
    set_scales(axes, study, plot)
    if drawing.normalizations(study)[0] != "as_published":
        return []
    for name, mark in plot.marks.items():
        _paper_mark(axes[0], plot, name, mark)
    outcomes = {mark.paper_outcome for mark in plot.marks.values()}
    ring: dict[str, Any] = {"linestyle": "", "markerfacecolor": "none", "markersize": 6, "markeredgewidth": 1.4}
    ring |= {"markeredgecolor": PAPER, "path_effects": EDGE}
    return [
        Line2D([], [], marker=look["marker"], label=f"paper: {OUTCOME_LOOKS[name].label}", **ring)
        for name, look in MARKS.items()
        if name in outcomes
    ]


def _paper_mark(ax: Axes, plot: StabilityMap, name: str, mark: Mark) -> None:
    """Draw a large open mark whose shape is the paper's outcome, and beside it the case's name, towards the middle."""
    at = (mark.x * drawing.axis_of(plot.x)[1], mark.y * drawing.axis_of(plot.y)[1])
    edge: dict[str, Any] = {"edgecolor": PAPER, "linewidth": 1.4, "path_effects": EDGE}
    shape = MARKS[mark.paper_outcome]["marker"]
    ax.scatter(*at, 55.0, marker=shape, facecolor="none", zorder=4, clip_on=False, **edge)
    across, up = (ax.transData + ax.transAxes.inverted()).transform(at)
    offset = (-6 if across > 0.85 else 6, -5 if up > 0.85 else 5)
    drawing.say(ax, name, at, offset, fontsize=7, zorder=5, annotation_clip=False, path_effects=drawing.halo(2.0))


def set_scales(axes: Sequence[Axes], study: xr.Dataset, plot: StabilityMap) -> None:
    """Set limits, labels and scales of shared axes; a logarithmic scale with a 0 is linear up to the second value."""
    for which, name in plot.axes.items():
        label, factor = drawing.axis_of(name)
        values = study[name].values * factor
        axis = getattr(axes[0], f"{which}axis")
        if (scale := cells.scale_of(name, values)) != "linear":
            start = {"linthresh": values[1], "linscale": 0.4} if scale == "symlog" else {}
            getattr(axes[0], f"set_{which}scale")(scale, **start)
            ticks = np.outer(10.0 ** np.arange(-9, 13), (1, 2, 5)).ravel()
            ticks = ticks[(ticks >= 0.999 * values[values > 0][0]) & (ticks <= 1.001 * values[-1])]
            axis.set_major_locator(FixedLocator([*[0.0] * (scale == "symlog"), *ticks]))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
            if scale == "symlog":
                axis.set_minor_locator(NullLocator())
        to_axis = axis.get_transform()
        low, high = to_axis.transform(values[[0, -1]])
        margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
        axes[0].set(**{f"{which}lim": to_axis.inverted().transform([low - margin, high + margin])})
        for ax in axes:
            ax.set(**{f"{which}label": label})
            ax.label_outer()


def _legend_above(figure: Figure, handles: Sequence[Artist]) -> None:
    """Draw a legend over all panels; `drawing.head` is its title."""
    figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 4), title_fontsize=8)
