"""Growth maps: the growth rate of the stick-slip cycle over speed and preload, its neutral curves and folds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.grids.curves import DASHED, LOAD, SPEED, Curve, curves_of, draw_curve, span
from disc_model.figures.grids.kinds import GrowthMap
from disc_model.figures.grids.stability_map import growth_bar, growth_mesh, no_cycle_patch
from disc_model.figures.parts import BLACK, COLUMN, PAGE, new_figure, styled


@styled
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: GrowthMap) -> Figure:
    """A panel for each normalization.

    Parameters
    ----------
    study : of the quantity `floquet` over N and Omega
    others : ``curves`` of the quantity `stability_curves` over Omega and N, if they are to be shown
    """
    norms = parts.normalizations(study)
    figure = new_figure(PAGE if len(norms) > 1 else COLUMN, 2.9)
    axes = list(figure.subplots(1, len(norms), sharey=True, squeeze=False)[0])
    shown: list[Curve] = []
    for ax, norm, letter in zip(axes, norms, "abcdef", strict=False):
        grid = parts.of(study, norm)
        mesh = growth_mesh(ax, grid, "Omega", "N")
        curves = curves_of(parts.of(others["curves"], norm)) if "curves" in others else []
        for curve in curves:
            draw_curve(ax, curve)
        shown += curves
        ax.set(xlabel=SPEED, xlim=span(grid["Omega"].values), ylim=span(grid["N"].values))
        ax.set_title(parts.MODES[norm], loc="right")
        if len(norms) > 1:
            parts.letter(ax, letter)
    axes[0].set_ylabel(LOAD)
    _legend(figure, shown, bool(study["growth_rate"].isnull().any()))
    growth_bar(figure, mesh, axes)
    return figure


def _legend(figure: Figure, curves: Sequence[Curve], gaps: bool) -> None:
    ax = figure.axes[-1]
    kinds = {curve.kind for curve in curves}
    handles: list[object] = []
    if "neutral" in kinds:
        handles += ax.plot([], [], color=BLACK, linewidth=1.0, label="a multiplier crosses the unit circle")
    if "fold" in kinds:
        handles += ax.plot([], [], color=BLACK, linewidth=1.0, linestyle=DASHED, label="fold")
    if gaps:
        handles.append(no_cycle_patch())
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=3)  # type: ignore[arg-type]
