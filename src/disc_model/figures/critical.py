"""Growth of the cycle along a parameter, and where the motion is unstable."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.figures.branch_lines import Look, above_floor, draw_at_floor, set_margins
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.critical_beside import (
    APART,
    TOP,
    case_of,
    entries_of_all,
    has_bars,
    lines_of,
)
from disc_model.figures.critical_curve import Curve, draw_missing
from disc_model.figures.drawing import BLACK, COLUMN, INDIGO, SEPARATED, mark, wide
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import draw_case, name_of_case
from disc_model.figures.rate_scale import scale_rates
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical


IN_SLIDING = "steady sliding, where no cycle exists"


def plot_critical(
    critical: Critical,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw the growth rate of the motion over the parameter; shaded: it is unstable. Several on the same
    axes have a line and a bar of unstable values each. Returns the axes."""
    curve = Curve.of(critical)
    name, labels = name_of_case(labels)
    overlaid = case_of(critical, name, _note_of(critical, curve))
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.8, title=overlaid.title) as page:
        page.show(Quantities(curve.label, curve.rate_label))
        common = entries_of_all(page.ax, curve)
        draw_case(page, overlaid, [lines_of(curve)], lambda: _draw_alone(page, curve), common)
        if not name and not has_bars(page.ax):
            page.note = overlaid.notes[0]
    return page.ax


def _draw_alone(page: Page, curve: Curve) -> None:
    """Draw the growth rate of one case, over shaded stretches of instability."""
    axes = page.ax
    words = curve.words
    entry = words.shaded
    for ends in curve.unstable:
        axes.axvspan(*ends, zorder=0, label=entry, color=SEPARATED, alpha=0.3, linewidth=wide(0.8))
        entry = "_nolegend_"
    axes.plot(
        curve.x,
        above_floor(curve.rates),
        ".-",
        color=BLACK,
        label=words.computed,
        markersize=mark(3),
        linewidth=wide(0.7),
    )
    if curve.has_sliding:
        axes.plot(
            curve.x,
            curve.sliding,
            "s--",
            color=INDIGO,
            label=IN_SLIDING,
            markersize=mark(3),
            markerfacecolor="none",
            markevery=APART,
            linewidth=wide(0.7),
        )
    scale_rates(axes)
    lowest = draw_at_floor(axes, curve.x, Look(BLACK), np.isneginf(curve.rates))
    if lowest:
        set_margins(axes)
    if curve.gone.size:
        draw_missing(axes, curve, TOP, BLACK, label=words.missing)
    axes.set_xlabel(curve.label)
    axes.set_ylabel(curve.rate_label)
    axes.set_xlim((curve.x[0], curve.x[-1]))
    page.explain([*axes.get_legend_handles_labels()[0], *lowest])


def _note_of(critical: Critical, curve: Curve) -> str:
    """From where on the motion is unstable, and what may be missed."""
    factor = curve.factor
    unit = curve.unit
    step = f"{critical.resolution * factor:.2g} {unit}".strip()
    missed = f"tongues narrower than {step} may be missed"
    if np.isnan(critical.value):
        return missed
    first = f"unstable from {critical.value * factor:.5g} {unit}".strip()
    if critical.at_lower_bound:
        first = "already unstable at the lower bound"
    return f"{first}\n{missed}"
