"""A branch of cycles over its parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes

from disc_model.data.variables import axis_of
from disc_model.errors import require
from disc_model.figures import drawing
from disc_model.figures.branches import STABLE, THIN, draw_branch
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.curve import scale_rates
from disc_model.figures.drawing import BLACK, SEPARATED, mark, wide
from disc_model.figures.runs import stated
from disc_model.figures.sizes import COLUMN

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch

LABELS = {
    "growth_rate": "Growth rate of the cycle (1/s)",
    "period": "Period (ms)",
    "stick_fraction": "Stick",
}
"""Variables of a branch that can be drawn, by the labels of their axes."""
MOST_FOLDS = 4  # whose values the legend has


def plot_branch(
    branch: Branch,
    y: str,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw a variable of the cycles along a branch over its parameter, or its second parameter over
    its first; returns the axes."""
    first, *second = branch.parameters
    across, factor = axis_of(first)
    x = branch.values[:, 0] * factor
    label, values = _heights(branch, y)
    case = stated(branch.case, *branch.parameters)
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.8, title=case) as page:
        axes = page.ax
        draw_branch(axes, x, values, branch.growth_rate < 0, BLACK)
        axes.plot(
            x, values, ".", color=BLACK, markersize=mark(3)
        )  # what lies between is not computed
        if y == "growth_rate" and not second:
            scale_rates(axes)
        handles = [
            drawing.sample(color=BLACK, linewidth=wide(width), label=text)
            for width, text in ((STABLE, "stable"), (THIN, "unstable"))
        ]
        handles += _draw_folds(axes, branch, x, values, factor)
        axes.margins(0.04)
        axes.set_xlabel(across)
        axes.set_ylabel(label)
        page.explain(handles)
    return page.ax


def _heights(branch: Branch, y: str) -> tuple[str, np.ndarray]:
    """The label of what is drawn upward, and its values in the label's unit."""
    if len(branch.parameters) > 1:
        label, factor = axis_of(branch.parameters[1])
        return label, branch.values[:, 1] * factor
    known = isinstance(y, str) and y in LABELS
    require((known, "y", y, f"must be one of {', '.join(LABELS)}"))
    values = getattr(branch, y)
    return LABELS[y], 1e3 * values if y == "period" else values


def _draw_folds(
    ax: Axes, branch: Branch, x: np.ndarray, values: np.ndarray, factor: float
) -> list[Any]:
    """Mark the folds of a branch; returns an entry of a legend for them."""
    folds = np.reshape(branch.folds, (-1, len(branch.parameters)))
    if not len(folds):
        return []
    nearest = [int(np.argmin(np.abs(branch.values - fold).sum(axis=1))) for fold in folds]
    places = [f"{fold:.5g}" for fold in folds[:, 0] * factor]
    text = f"fold at {', '.join(places)}"
    if len(folds) > MOST_FOLDS:
        text = f"{len(folds)} folds"
    return ax.plot(
        folds[:, 0] * factor, values[nearest], "s", color=SEPARATED, markersize=mark(4), label=text
    )
