"""Floquet multipliers of a cycle in the complex plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import BLUE, COLUMN, GREY, SEPARATED, mark, wide
from disc_model.figures.named_axes import Quantities
from disc_model.figures.runs import stated
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.cycle import FloquetResult


def plot_multipliers(
    cycle: FloquetResult,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw multipliers and the unit circle; raises `CycleError` without a cycle."""
    values = cycle.raise_for_status().multipliers
    angle = np.linspace(0, 2 * np.pi, 200)
    outside = np.abs(values) > 1
    wishes = Wishes(ax, legend, labels, title)
    with page_for(wishes, COLUMN, 3.2, title=stated(cycle.parameters)) as page:
        page.show(Quantities("Re κ", "Im κ"))
        axes = page.ax
        axes.plot(np.cos(angle), np.sin(angle), color=GREY, linewidth=wide(0.8))
        axes.axhline(0, color=GREY, linewidth=wide(0.4), zorder=0)
        axes.axvline(0, color=GREY, linewidth=wide(0.4), zorder=0)
        for mask, shape, colour, name in (
            (~outside, "o", BLUE, "decays"),
            (outside, "D", SEPARATED, "grows"),
        ):
            if mask.any():
                shown = values[mask]
                axes.plot(
                    shown.real, shown.imag, shape, color=colour, markersize=mark(4), label=name
                )
        axes.set_xlabel("Re κ")
        axes.set_ylabel("Im κ")
        axes.set_aspect("equal")
        axes.margins(0.12)
        page.note = f"{_stability(cycle)}, period {period_text(cycle.period)}"
        # not in the panel, where multipliers may lie anywhere
        largest = f"largest |κ| = {abs(values[0]):.5g}"
        page.explain(axes.get_legend_handles_labels()[0], title=largest)
    return page.ax


def _stability(cycle: FloquetResult) -> str:
    word = "stable" if cycle.stable else "unstable"
    return f"{word}, growth rate {cycle.growth_rate:.3g}/s"


def period_text(period: float) -> str:
    """A period in s, with its unit."""
    return f"{period:.4g} s" if period > 1 else f"{1e3 * period:.4g} ms"
