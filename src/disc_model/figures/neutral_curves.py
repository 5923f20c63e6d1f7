"""Neutral curves and folds of a cycle over two parameters."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.data.variables import axis_of
from disc_model.errors import require
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.case_lines import Lines
from disc_model.figures.drawing import COLUMN
from disc_model.figures.named_axes import Quantities
from disc_model.figures.neutral_curve_lines import draw_alone, draw_beside, kinds_beside
from disc_model.figures.overlay import case_of_result, draw_case, name_of_case
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.curves import NeutralCurves


def plot_neutral_curves(
    curves: NeutralCurves,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw the curves within their bounds, thick where a stable cycle adjoins, with the resonances
    to which they belong; returns the axes. Raises `ParameterError` without a curve."""
    found = len(curves) > 0
    require((found, "curves", 0, "there is nothing to draw: no curve was found, try other lines"))
    (across, in_x), (up, in_y) = (axis_of(name) for name in curves.bounds)
    factors = np.array([in_x, in_y])
    low, high = np.transpose([*curves.bounds.values()]) * factors
    name, labels = name_of_case(labels)
    overlaid = case_of_result("neutral curves", name, curves.parameters, *curves.bounds)
    lines = [curve.values * factors for curve in curves]
    limits = ((low[0], high[0]), (low[1], high[1]))
    panels = [Lines(partial(draw_beside, curves.curves, lines), limits)]
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 3.0, title=overlaid.title) as page:
        page.show(Quantities(across, up))
        page.ax.set_xlabel(across)
        page.ax.set_ylabel(up)
        draw_case(
            page,
            overlaid,
            panels,
            lambda: draw_alone(page, curves.curves, lines, limits),
            kinds_beside(),
        )
    return page.ax
