"""Eigenvalues of steady sliding: frequency over growth rate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.errors import Fault, ParameterError
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.case_lines import Lines, Style, limits_of
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    COLUMN,
    GREY,
    SEPARATED,
    large,
    mark,
    sample,
    wide,
)
from disc_model.figures.head_texts import head_text
from disc_model.figures.named_axes import Quantities
from disc_model.figures.names import Names
from disc_model.figures.overlay import case_of_result, draw_case, name_of_case
from disc_model.figures.types import Array, Artist, Axes, ComplexArray, Mask

if TYPE_CHECKING:
    from disc_model.stability.sliding import SteadySliding

RATE = "Growth rate (1/s)"
FREQUENCY = "Frequency (Hz)"
BESIDE = ((4, 0), (4, 5), (4, -5), (-4, 0))  # points, of the names beside their marks
ROOM = 1.25  # end of the axis of growth rates over the greatest


def plot_eigenvalues(
    sliding: SteadySliding,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw frequency over growth rate of the eigenvalues of steady sliding; unstable ones with
    their frequency."""
    if not sliding.eigenvalues.size:
        rule = f"there are no eigenvalues: {sliding.message}"
        raise ParameterError(Fault(("status",), sliding.status.value, rule))
    values = sliding.eigenvalues[sliding.eigenvalues.imag >= 0]
    name, labels = name_of_case(labels)
    note = head_text(COLUMN, "", sliding.message)
    overlaid = case_of_result("eigenvalues", name, sliding.parameters, notes=(note,))
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 3.0, title=overlaid.title) as page:
        page.show(Quantities(RATE, FREQUENCY))
        grows = np.isin(values, sliding.growing)
        rests = np.isin(values, sliding.neutral)
        alone = draw_case(
            page, overlaid, [_marks(values)], lambda: _draw_alone(page, values, grows, rests)
        )
        if alone:
            page.note = note
    return page.ax


def _draw_alone(page: Page, values: ComplexArray, grows: Mask, rests: Mask) -> None:
    """Draw eigenvalues by whether they decay or grow, those that grow with their frequencies."""
    axes = page.ax
    rate, frequency = _rate_and_frequency(values)
    axes.axvline(0, color=BLACK, linewidth=wide(0.6))
    for mask, shape, colour, name in (
        (~grows & ~rests, "o", BLUE, "decays"),
        (rests, "s", GREY, "neutral"),
        (grows, "D", SEPARATED, "grows"),
    ):
        if mask.any():
            axes.plot(
                rate[mask], frequency[mask], shape, color=colour, markersize=mark(4), label=name
            )
    names = Names(axes)
    for x, y in sorted(zip(rate[grows], frequency[grows], strict=True), reverse=True):
        names.add(f"{y:.0f} Hz", (x, y), BESIDE, fontsize=large(7), color=SEPARATED)
    span = max(map(abs, axes.get_xlim())) * ROOM
    axes.set_xlabel(RATE)
    axes.set_ylabel(FREQUENCY)
    axes.set_xlim((-span, span))
    axes.set_ylim(bottom=0)
    axes.margins(y=0.08)
    page.explain(axes.get_legend_handles_labels()[0])


def _rate_and_frequency(values: ComplexArray) -> tuple[Array, Array]:
    """Growth rates, 1/s, and frequencies, Hz, of eigenvalues."""
    return values.real, values.imag / (2 * np.pi)


def _marks(values: ComplexArray) -> Lines:
    """How eigenvalues are drawn beside others: in marks of one kind, whether they decay or grow,
    which the axis tells."""
    rate, frequency = _rate_and_frequency(values)

    def draw(ax: Axes, style: Style) -> Artist:
        ax.axvline(0, color=BLACK, linewidth=wide(0.6))
        ax.plot(rate, frequency, **style.marks(4))
        ax.set_xlabel(RATE)
        ax.set_ylabel(FREQUENCY)
        return sample(**style.marks(4))

    span = ROOM * float(np.abs(rate).max())
    return Lines(draw, ((-span, span), (0.0, limits_of(frequency, 0.08)[1])))
