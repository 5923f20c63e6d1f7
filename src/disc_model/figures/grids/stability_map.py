"""Stability maps: outcome of the published start over two parameters, with the cycle's growth rate behind it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import AsinhNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, FuncFormatter

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import StabilityMap
from disc_model.figures.parts import BLACK, GREY, PAGE, axis_of, new_figure, styled

# ----------------------------------------------------------------------------------------------------
# The one scale of colours for growth rates of the stick-slip cycle

GREATEST = 0.3
"""Growth rate at which the colours end, 1/s."""
LINEAR = 0.01
"""Growth rate up to which the colours are about linear, 1/s."""
TICKS = (-0.1, -0.01, 0, 0.01, 0.1)
HATCH = "//////"
"""How it looks where there is no cycle."""


def growth_norm() -> AsinhNorm:
    """About linear near 0, about logarithmic beyond."""
    return AsinhNorm(linear_width=LINEAR, vmin=-GREATEST, vmax=GREATEST)


def growth_mesh(ax: Axes, growth: xr.Dataset, x: str, y: str) -> QuadMesh:
    """`growth_rate` (1/s, nan without a cycle) over two parameters in colour; hatched where there is no cycle."""
    across, up = (growth[name].values * axis_of(name)[1] for name in (x, y))
    rate = np.ma.masked_invalid(growth["growth_rate"].transpose(y, x).values)
    ax.patch.set(facecolor="white", hatch=HATCH, edgecolor=GREY, linewidth=0)
    return ax.pcolormesh(across, up, rate, cmap=cm.vik, norm=growth_norm(), shading="nearest", rasterized=True)


def growth_bar(figure: Figure, mesh: QuadMesh, axes: list[Axes]) -> None:
    """The scale beside the panels."""
    bar = figure.colorbar(mesh, ax=axes, extend="both", pad=0.01, aspect=30)
    bar.set_label("Growth rate of the stick-slip cycle (1/s)")
    bar.set_ticks(TICKS, labels=[f"{x:g}".replace("-", "−") for x in TICKS])
    bar.minorticks_off()


def no_cycle_patch() -> Patch:
    """For legends."""
    return Patch(facecolor="white", hatch=HATCH, edgecolor=GREY, label="no cycle found")


# ----------------------------------------------------------------------------------------------------
# Maps


class Look(NamedTuple):
    """How an outcome is drawn."""

    label: str
    marker: str
    face: str
    size: float


OUTCOMES = {
    "stable": Look("stays quiet", "o", "white", 9),
    "unstable": Look("grows, no separation", "^", "#9a9a9a", 13),
    "separation": Look("separation", "s", BLACK, 10),
    "unknown": Look("failed", "x", BLACK, 12),
}
PAPER = "#F0E442"
"""Colour of the paper's cases: none of the map's."""
LARGE = 55.0
"""Size of their marks."""


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: StabilityMap) -> Figure:
    """One panel for each normalization; the paper's cases are marked in that of the published modes.

    Parameters
    ----------
    study : of the quantity `outcome`
    others : ``growth`` of the quantity `floquet`, over the same parameters, if it is to be shown
    """
    norms = parts.normalizations(study)
    figure = new_figure(PAGE, 3.3)
    axes = figure.subplots(1, len(norms), sharex=True, sharey=True, squeeze=False)[0]
    mesh = None
    for ax, norm, letter in zip(axes, norms, "abcd", strict=False):
        if "growth" in others:
            mesh = _background(ax, parts.of(others["growth"], norm), plot) or mesh
        _points(ax, parts.of(study, norm), plot)
        panel = f"({letter}) " if len(norms) > 1 else ""
        ax.set_title(f"{panel}{parts.MODES[norm]}", loc="left")
        if norm == "as_published":
            _marks(ax, study, plot)
    set_scales(axes[None, :], study, plot)
    if mesh is not None:
        growth_bar(figure, mesh, list(axes))
    _legend(figure, study, bool(plot.marks) and "as_published" in norms, mesh is not None)
    return figure


def _background(ax: Axes, growth: xr.Dataset, plot: StabilityMap) -> QuadMesh:
    """Growth rate in colour, its sign's change as a line; hatched where there is no cycle."""
    mesh = growth_mesh(ax, growth, plot.x, plot.y)
    x, y = (growth[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y))
    rate = growth["growth_rate"].transpose(plot.y, plot.x).values
    if min(rate.shape) > 1 and np.isfinite(rate).any() and np.nanmin(rate) < 0 < np.nanmax(rate):
        ax.contour(x, y, np.ma.masked_invalid(rate), levels=[0.0], colors=BLACK, linewidths=0.8)
    return mesh


def _points(ax: Axes, study: xr.Dataset, plot: StabilityMap) -> None:
    x, y = np.meshgrid(*(study[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y)))
    outcome = flag_names(study["outcome"].transpose(plot.y, plot.x))
    for name, look in OUTCOMES.items():
        there = outcome == name
        ax.scatter(
            x[there],
            y[there],
            look.size,
            marker=look.marker,
            facecolor=look.face,
            edgecolor=BLACK if look.marker != "x" else None,
            linewidth=0.5,
            zorder=3,
            clip_on=False,
        )


def _marks(ax: Axes, study: xr.Dataset, plot: StabilityMap) -> None:
    """The paper's cases: their names, and large marks in the shape of what the paper says of them."""
    for name, mark in plot.marks.items():
        at = (mark.x * parts.axis_of(plot.x)[1], mark.y * parts.axis_of(plot.y)[1])
        for color, width in ((BLACK, 2.4), (PAPER, 1.4)):
            ax.scatter(
                *at,
                LARGE,
                marker=OUTCOMES[mark.paper].marker,
                facecolor="none",
                edgecolor=color,
                linewidth=width,
                zorder=4,
                clip_on=False,
            )
        leftward, downward = _far(study[plot.x].values, mark.x), _far(study[plot.y].values, mark.y)
        ax.annotate(
            name,
            at,
            xytext=(-6 if leftward else 6, -5 if downward else 5),
            textcoords="offset points",
            ha="right" if leftward else "left",
            va="top" if downward else "bottom",
            fontsize=7,
            zorder=5,
            bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.85, "linewidth": 0},
            annotation_clip=False,
        )


def paper_ring() -> Line2D:
    """For legends: the marks of the paper's cases."""
    ring = Line2D([], [], linestyle="", marker="o", markerfacecolor="none", markersize=6, markeredgewidth=1.4)
    ring.set(
        markeredgecolor=PAPER,
        label="the paper's answer; F2: in its Fig. 2",
        path_effects=[withStroke(linewidth=2.4, foreground=BLACK)],
    )
    return ring


def _far(values: np.ndarray, value: float) -> bool:
    """Whether a value lies in the last eighth of an axis."""
    return bool(np.searchsorted(values, value) >= 7 * (len(values) - 1) / 8)


def set_scales(axes: np.ndarray, study: xr.Dataset, plot: StabilityMap) -> None:
    """Logarithmic where values span decades, with a linear stretch up to the second value if the first is 0.

    axes : shape (rows, columns), all over the same two parameters
    """
    for name, which in ((plot.x, "x"), (plot.y, "y")):
        label, factor = parts.axis_of(name)
        values = study[name].values * factor
        positive = values[values > 0]
        decades = name not in ("N", "Omega") and positive.size > 1 and positive[-1] / positive[0] > 15
        for ax in axes.flat:
            axis = ax.xaxis if which == "x" else ax.yaxis
            if decades and values[0] > 0:
                ax.set(**{f"{which}scale": "log"})
            elif decades:
                getattr(ax, f"set_{which}scale")("symlog", linthresh=values[1], linscale=0.4)
                powers = 10.0 ** np.arange(np.ceil(np.log10(values[1])), np.floor(np.log10(values[-1])) + 1)
                axis.set_major_locator(FixedLocator([0.0, *powers]))
                axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            to_axis = axis.get_transform()
            low, high = to_axis.transform(values[[0, -1]])
            margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
            ax.set(**{f"{which}lim": tuple(to_axis.inverted().transform([low - margin, high + margin]))})
        for ax in axes[-1] if which == "x" else axes[:, 0]:
            ax.set(**{f"{which}label": label})


def _legend(figure: Figure, study: xr.Dataset, marked: bool, mapped: bool) -> None:
    present = set(np.unique(flag_names(study["outcome"])))
    handles: list[Artist] = [
        Line2D([], [], linestyle="", marker=look.marker, markerfacecolor=look.face, markeredgecolor=BLACK,
               markeredgewidth=0.5, markersize=look.size**0.5, label=look.label)
        for name, look in OUTCOMES.items()
        if name in present
    ]  # fmt: skip
    if mapped:
        handles.append(Line2D([], [], color=BLACK, linewidth=0.8, label="growth rate 0"))
        handles.append(no_cycle_patch())
    if marked:
        handles.append(paper_ring())
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
