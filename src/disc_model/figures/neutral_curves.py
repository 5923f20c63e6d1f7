"""Neutral curves and folds of a cycle over two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.data.variables import axis_of, typeset
from disc_model.figures.branches import STABLE, draw_branch
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import BLACK, COLUMN, SEPARATED, halo, large, sample, say, wide
from disc_model.figures.runs import stated
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.curves import NeutralCurves

KINDS = {"neutral": (BLACK, "cycle loses stability"), "fold": (SEPARATED, "cycle ends in a fold")}
"""Colours and names of the curves."""
NAMED = (0.02, 0.75)  # part of the axes, across, in which names of curves may begin,
BELOW = 0.98  # and up
STEEP = 0.5  # run over rise, as shares of the axes, up to which a name stands beside a line
APART = (0.27, 0.06)  # least distance of two names, across and up


def plot_neutral_curves(
    curves: NeutralCurves,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw the curves within their bounds, thick where a stable cycle adjoins, with the resonances
    to which they belong; returns the axes."""
    (across, in_x), (up, in_y) = (axis_of(name) for name in curves.bounds)
    factors = np.array([in_x, in_y])
    low, high = np.transpose([*curves.bounds.values()]) * factors
    case = stated(curves.parameters, *curves.bounds)
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 3.0, title=case) as page:
        axes = page.ax
        axes.set_xlabel(across)
        axes.set_ylabel(up)
        axes.set_xlim((low[0], high[0]))
        axes.set_ylim((low[1], high[1]))
        names: list[np.ndarray] = []
        for curve in curves:
            points = curve.values * factors
            colour, _ = KINDS[curve.kind]
            draw_branch(axes, points[:, 0], points[:, 1], curve.adjoins_stable_cycle, colour)
            _name(axes, points, typeset(curve.resonance.label), colour, names)
        present = {curve.kind for curve in curves}
        handles = [
            sample(color=colour, linewidth=wide(STABLE), label=text)
            for kind, (colour, text) in KINDS.items()
            if kind in present
        ]
        page.explain(handles)
    return page.ax


def _name(ax: Axes, points: np.ndarray, text: str, colour: str, taken: list[np.ndarray]) -> None:
    """Write the name of a curve beside its middle, where there is room beside other names, whose
    places are `taken`."""
    share = ax.transAxes.inverted().transform(ax.transData.transform(points))
    left, right = NAMED
    inside = (share[:, 0] > left) & (share[:, 0] < right)
    inside &= (share[:, 1] > left) & (share[:, 1] < BELOW)
    for place in taken:
        inside &= np.any(np.abs(share - place) > APART, axis=1)
    free = np.flatnonzero(inside)
    if not free.size:
        return
    i = free[free.size // 2]
    taken.append(share[i])
    # above a line, on the side to which it falls; beside a steep one
    across, up = share[min(i + 1, len(share) - 1)] - share[max(i - 1, 0)]
    offset = (8, 0)
    if abs(across) > STEEP * abs(up):
        offset = (4, 4) if across * up <= 0 else (-4, 4)
    say(ax, text, points[i], offset, fontsize=large(6), color=colour, path_effects=halo())
