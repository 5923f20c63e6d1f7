"""Stability maps: outcome of the published start over two parameters, with the cycle's growth rate behind it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter
from numpy.typing import NDArray

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.cells import OUTCOMES, cycle_patches, cycles_of, growth_bar, growth_cells, scale_of
from disc_model.figures.kinds import StabilityMap
from disc_model.figures.parts import BLACK, PAGE, PAPER, new_figure

MARKS = {
    "quiet": ("o", "white", 9),
    "sliding": ("o", "#c9b8dc", 9),
    "resting": ("o", "#b9dcc6", 9),
    "other_cycle": ("v", "white", 13),
    "growing": ("^", "#9a9a9a", 13),
    "undecided": ("D", "white", 9),
    "separation": ("s", BLACK, 10),
    "failed": ("x", BLACK, 12),
}
"""Shape, face and area of the mark of each outcome."""
LARGE = 55.0
"""Area of the marks of the paper."""


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: StabilityMap) -> Figure:
    """One panel for each normalization; the paper's cases are marked in that of the published modes."""
    norms = parts.normalizations(study)
    figure = new_figure(PAGE, 3.3)
    axes = figure.subplots(1, len(norms), sharex=True, sharey=True, squeeze=False)[0]
    mesh: QuadMesh | None = None
    gaps: set[str] | None = None
    parts.letters(axes, [parts.MODES[norm] for norm in norms])
    for ax, norm in zip(axes, norms, strict=True):
        if "growth" in others:
            growth = parts.of(others["growth"], norm)
            mesh = _background(ax, growth, plot)
            gaps = {*(gaps or ()), *cycles_of(growth, plot.x, plot.y).flat}
        _points(ax, parts.of(study, norm), plot)
        if norm == "as_published":
            _marks(ax, study, plot)
    set_scales(axes[None, :], study, plot)
    if mesh is not None:
        growth_bar(figure, mesh, list(axes))
    _legend(figure, study, plot, gaps)
    return figure


def _background(ax: Axes, growth: xr.Dataset, plot: StabilityMap) -> QuadMesh:
    """Growth rate in colour, its sign's change as a line."""
    mesh = growth_cells(ax, growth, plot.x, plot.y)
    x, y = (growth[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y))
    rate = growth["growth_rate"].transpose(plot.y, plot.x).values
    if min(rate.shape) > 1 and np.isfinite(rate).any() and np.nanmin(rate) < 0 < np.nanmax(rate):
        ax.contour(x, y, np.ma.masked_invalid(rate), levels=[0.0], colors=BLACK, linewidths=1.0)
    return mesh


def _points(ax: Axes, study: xr.Dataset, plot: StabilityMap) -> None:
    x, y = np.meshgrid(*(study[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y)))
    outcome = flag_names(study["outcome"].transpose(plot.y, plot.x))
    for name, (marker, face, size) in MARKS.items():
        there = outcome == name
        edge = BLACK if marker != "x" else None
        look: dict[str, Any] = {"marker": marker, "facecolor": face, "edgecolor": edge, "linewidth": 0.5}
        ax.scatter(x[there], y[there], size, zorder=3, clip_on=False, **look)


def _marks(ax: Axes, study: xr.Dataset, plot: StabilityMap) -> None:
    """The paper's cases, their names towards the middle of the panel."""
    box = {"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.85, "linewidth": 0}
    for name, mark in plot.marks.items():
        leftward, downward = _far(study[plot.x].values, mark.x), _far(study[plot.y].values, mark.y)
        paper_ring(ax, plot, name, (-6 if leftward else 6, -5 if downward else 5), bbox=box)


def paper_ring(ax: Axes, plot: StabilityMap, name: str, offset: tuple[float, float], **look: Any) -> None:
    """A case of the paper: a large open mark in the shape of what the paper says, and beside it its name."""
    mark = plot.marks[name]
    at = (mark.x * parts.axis_of(plot.x)[1], mark.y * parts.axis_of(plot.y)[1])
    ring: dict[str, Any] = {"marker": MARKS[mark.paper][0], "facecolor": "none", "zorder": 4, "clip_on": False}
    for color, width in ((BLACK, 2.4), (PAPER, 1.4)):
        ax.scatter(*at, LARGE, edgecolor=color, linewidth=width, **ring)
    parts.say(ax, name, at, offset, fontsize=7, zorder=5, annotation_clip=False, **look)


def paper_rings(plot: StabilityMap) -> list[Line2D]:
    """For legends: one for each shape among the marks."""
    said = {mark.paper for mark in plot.marks.values()}
    edge = [withStroke(linewidth=2.4, foreground=BLACK)]
    ring: dict[str, Any] = {"linestyle": "", "markerfacecolor": "none", "markersize": 6, "path_effects": edge}
    ring |= {"markeredgewidth": 1.4, "markeredgecolor": PAPER}
    return [
        Line2D([], [], marker=marker, label=f"the paper: {OUTCOMES[name].label}", **ring)
        for name, (marker, *_) in MARKS.items()
        if name in said
    ]


def _far(values: np.ndarray, value: float) -> bool:
    """Whether a value lies in the last eighth of an axis."""
    return bool(np.searchsorted(values, value) >= 7 * (len(values) - 1) / 8)


def set_scales(axes: np.ndarray, study: xr.Dataset, plot: StabilityMap) -> None:
    """Limits, labels and scales of the axes; with a linear stretch up to the second value if a logarithmic one has a 0.

    axes : shape (rows, columns), all over the same two parameters
    """
    for name, which in ((plot.x, "x"), (plot.y, "y")):
        label, factor = parts.axis_of(name)
        values = study[name].values * factor
        scale = scale_of(name, values)
        for ax in axes.flat:
            axis = ax.xaxis if which == "x" else ax.yaxis
            if scale != "linear":
                start = {"linthresh": values[1], "linscale": 0.4} if scale == "symlog" else {}
                getattr(ax, f"set_{which}scale")(scale, **start)
                axis.set_major_locator(FixedLocator(_round_values(values)))
                axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
                axis.set_minor_formatter(NullFormatter())
            to_axis = axis.get_transform()
            low, high = to_axis.transform(values[[0, -1]])
            margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
            ax.set(**{f"{which}lim": tuple(to_axis.inverted().transform([low - margin, high + margin]))})
        for ax in axes[-1] if which == "x" else axes[:, 0]:
            ax.set(**{f"{which}label": label})


def _round_values(values: NDArray[np.float64]) -> list[float]:
    """1, 2 and 5 in each decade within the values, and their ends."""
    positive = values[values > 0]
    decades = 10.0 ** np.arange(np.floor(np.log10(positive[0])), np.ceil(np.log10(positive[-1])) + 1)
    steps = np.outer(decades, [1.0, 2.0, 5.0]).ravel()
    inside = steps[(steps >= 0.999 * positive[0]) & (steps <= 1.001 * positive[-1])]
    return [*([0.0] if values[0] == 0 else []), *inside.tolist()]


def _legend(figure: Figure, study: xr.Dataset, plot: StabilityMap, gaps: Collection[str] | None) -> None:
    """gaps : what there is where no cycle is, if growth is shown"""
    present = set(np.unique(flag_names(study["outcome"])))
    handles: list[Artist] = [
        Line2D([], [], linestyle="", marker=marker, markerfacecolor=face, markeredgecolor=BLACK,
               markeredgewidth=0.5, markersize=size**0.5, label=OUTCOMES[name].label)
        for name, (marker, face, size) in MARKS.items()
        if name in present
    ]  # fmt: skip
    if gaps is not None:
        handles.append(Line2D([], [], **parts.border("neutral")))
        handles += cycle_patches(gaps)
    if "as_published" in parts.normalizations(study):
        handles += paper_rings(plot)
    legend_below_head(figure, study, plot, handles)


def legend_below_head(figure: Figure, study: xr.Dataset, plot: StabilityMap, handles: list[Artist]) -> None:
    """A legend over all panels, under what `head` says: a title of the figure itself would lie over it."""
    said = parts.headline(figure, plot.title or study.attrs.get("title", ""), parts.fixed(study, modes_said=True))
    figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 4), title=said, title_fontsize=8)
