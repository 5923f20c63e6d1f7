"""Floquet multipliers of a cycle in the complex plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.case_lines import Lines, Style, limits_of
from disc_model.figures.drawing import BLUE, COLUMN, GREY, SEPARATED, mark, sample, wide
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import case_of_result, draw_case, name_of_case
from disc_model.figures.types import Artist, Axes, ComplexArray

if TYPE_CHECKING:
    from disc_model.stability.cycle import FloquetResult

ROOM = 0.12  # free share of the multipliers and the circle on both sides of them


def plot_multipliers(
    cycle: FloquetResult,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw multipliers and the unit circle; raises `CycleError` without a cycle."""
    values = cycle.raise_for_status().multipliers
    name, labels = name_of_case(labels)
    wishes = Wishes(ax, legend, labels, title)
    note = f"{_stability(cycle)}, period {period_text(cycle.period)}"
    overlaid = case_of_result("multipliers", name, cycle.parameters, notes=(note,))
    with page_for(wishes, COLUMN, 3.2, title=overlaid.title) as page:
        page.show(Quantities("Re κ", "Im κ"))
        if draw_case(page, overlaid, [_marks(values)], lambda: _draw_alone(page, values)):
            page.note = note
    return page.ax


def _draw_alone(page: Page, values: ComplexArray) -> None:
    """Draw multipliers by whether they decay or grow, with the magnitude of the largest."""
    axes = page.ax
    outside = np.abs(values) > 1
    _draw_plane(axes)
    for mask, shape, colour, name in (
        (~outside, "o", BLUE, "decays"),
        (outside, "D", SEPARATED, "grows"),
    ):
        if mask.any():
            shown = values[mask]
            axes.plot(shown.real, shown.imag, shape, color=colour, markersize=mark(4), label=name)
    axes.margins(ROOM)
    # not in the panel, where multipliers may lie anywhere
    largest = f"largest |κ| = {abs(values[0]):.5g}"
    page.explain(axes.get_legend_handles_labels()[0], title=largest)


def _draw_plane(axes: Axes) -> None:
    """Draw the unit circle and both axes of the complex plane, and name them."""
    angle = np.linspace(0, 2 * np.pi, 200)
    axes.plot(np.cos(angle), np.sin(angle), color=GREY, linewidth=wide(0.8))
    axes.axhline(0, color=GREY, linewidth=wide(0.4), zorder=0)
    axes.axvline(0, color=GREY, linewidth=wide(0.4), zorder=0)
    axes.set_xlabel("Re κ")
    axes.set_ylabel("Im κ")
    axes.set_aspect("equal")


def _marks(values: ComplexArray) -> Lines:
    """How multipliers are drawn beside others: in marks of one kind, whether they decay or grow,
    which the circle tells."""

    def draw(ax: Axes, style: Style) -> Artist:
        _draw_plane(ax)
        ax.plot(values.real, values.imag, **style.marks(4))
        return sample(**style.marks(4))

    across = limits_of(np.append(values.real, [-1, 1]), ROOM)
    upward = limits_of(np.append(values.imag, [-1, 1]), ROOM)
    return Lines(draw, (across, upward))


def _stability(cycle: FloquetResult) -> str:
    word = "stable" if cycle.stable else "unstable"
    return f"{word}, growth rate {cycle.growth_rate:.3g}/s"


def period_text(period: float) -> str:
    """A period in s, with its unit."""
    return f"{period:.4g} s" if period > 1 else f"{1e3 * period:.4g} ms"
