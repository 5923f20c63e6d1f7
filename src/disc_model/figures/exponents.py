"""Lyapunov exponents with their errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.display import counted
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import BLUE, COLUMN, GREY, mark, wide
from disc_model.figures.named_axes import Quantities
from disc_model.figures.runs import stated
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.lyapunov import Lyapunov


def plot_exponents(
    lyapunov: Lyapunov,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw the exponents with their errors, those that have converged filled; what has vanished is
    left out."""
    number = np.arange(1, len(lyapunov.exponents) + 1)
    finite = np.isfinite(lyapunov.exponents)
    case = "" if lyapunov.parameters is None else stated(lyapunov.parameters)
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.6, title=case) as page:
        page.show(Quantities("Number", "Lyapunov exponent (1/s)"))
        axes = page.ax
        for mask, face, name in (
            (lyapunov.converged & finite, BLUE, "converged"),
            (~lyapunov.converged & finite, "white", "not converged"),
        ):
            if not mask.any():
                continue
            axes.errorbar(
                number[mask],
                lyapunov.exponents[mask],
                lyapunov.errors[mask],
                fmt="o",
                color=BLUE,
                markersize=mark(4),
                markerfacecolor=face,
                capsize=mark(3),
                linewidth=wide(0.8),
                label=name,
            )
        axes.axhline(0, color=GREY, linewidth=wide(0.6), zorder=0)
        axes.set_xlabel("Number")
        axes.set_ylabel("Lyapunov exponent (1/s)")
        axes.set_xticks(number)
        axes.set_xlim((0.5, number[-1] + 0.5))
        lost = counted(lyapunov.separations, "separation")
        page.note = f"over {lyapunov.duration:g} s, {lost}"
        page.explain(axes.get_legend_handles_labels()[0])
    return page.ax
