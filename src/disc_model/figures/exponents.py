"""Lyapunov exponents with their errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.display import counted
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.case_lines import Lines, Style, limits_of
from disc_model.figures.classes import FILLED_MARK
from disc_model.figures.drawing import BLUE, COLUMN, GREY, mark, sample, wide
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import case_of_result, draw_case, name_of_case
from disc_model.figures.types import Artist, Axes

if TYPE_CHECKING:
    from disc_model.stability.lyapunov import Lyapunov

EXPONENT = "Lyapunov exponent (1/s)"
APART = 0.1  # distance between marks of several cases, in numbers of exponents


def plot_exponents(
    lyapunov: Lyapunov,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw the exponents with their errors, those that have not converged filled, as in sweeps; what has
    vanished is left out."""
    name, labels = name_of_case(labels)
    lost = counted(lyapunov.separations, "separation")
    note = f"over {lyapunov.duration:g} s, {lost}"
    overlaid = case_of_result("exponents", name, lyapunov.parameters, notes=(note,))
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.6, title=overlaid.title) as page:
        page.show(Quantities("Number", EXPONENT))
        look: dict[str, Any] = {"marker": "o", "linestyle": "", "markersize": mark(4)}
        filled = sample(label="filled: not converged; ± standard error", color=GREY, **look)
        alone = draw_case(
            page, overlaid, [_marks(lyapunov)], lambda: _draw_alone(page, lyapunov), [filled]
        )
        page.ax.set_xticks(np.arange(1, page.ax.get_xlim()[1]))
        if alone:
            page.note = note
    return page.ax


def _draw_alone(page: Page, lyapunov: Lyapunov) -> None:
    """Draw the exponents by whether they have converged."""
    axes = page.ax
    number = np.arange(1, len(lyapunov.exponents) + 1)
    finite = np.isfinite(lyapunov.exponents)
    for mask, face, word in (
        (lyapunov.converged & finite, "white", "converged, ± standard error"),
        (~lyapunov.converged & finite, BLUE, FILLED_MARK.format("not converged, ± standard error")),
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
            label=word,
        )
    axes.axhline(0, color=GREY, linewidth=wide(0.6), zorder=0)
    axes.set_xlabel("Number")
    axes.set_ylabel(EXPONENT)
    axes.set_xlim((0.5, number[-1] + 0.5))
    page.explain(axes.get_legend_handles_labels()[0])


def _marks(lyapunov: Lyapunov) -> Lines:
    """How exponents are drawn beside others: with their errors, those that have not converged filled."""
    finite = np.isfinite(lyapunov.exponents)
    number = np.arange(1, len(finite) + 1)[finite]
    exponents = lyapunov.exponents[finite]
    errors = lyapunov.errors[finite]
    moving = ~lyapunov.converged[finite]

    def draw(ax: Axes, style: Style) -> Artist:
        look = style.marks(4)
        places = number + APART * style.place
        bars: dict[str, Any] = {"fmt": "none", "ecolor": style.look.colour, "capsize": mark(3)}
        ax.errorbar(places, exponents, errors, linewidth=wide(0.8), **bars)
        ax.plot(places, exponents, **look)
        filled = {**look, "markerfacecolor": style.look.colour}
        ax.plot(places[moving], exponents[moving], **filled)
        ax.axhline(0, color=GREY, linewidth=wide(0.6), zorder=0)
        ax.set_xlabel("Number")
        ax.set_ylabel(EXPONENT)
        return sample(**look)

    ends = np.concatenate([exponents - errors, exponents + errors, [0.0]])
    return Lines(draw, ((0.5, len(finite) + 0.5), limits_of(ends, 0.05)))
