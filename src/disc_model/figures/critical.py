"""Growth of the cycle along a parameter, and where the motion is unstable."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from disc_model.data.variables import axis_of, presentation_of
from disc_model.figures.branch_lines import Look, above_floor, draw_at_floor, set_margins
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import BLACK, COLUMN, SEPARATED, mark, wide
from disc_model.figures.named_axes import Quantities
from disc_model.figures.rate_scale import scale_rates
from disc_model.figures.runs import stated
from disc_model.figures.types import Axes

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical


class Words(NamedTuple):
    """What a picture says of a kind of motion: on its axis, and in its legend."""

    rate: str
    shaded: str
    computed: str
    missing: str


WORDS = {
    "stick_slip": Words(
        "Growth rate of the cycle (1/s)",
        "unstable near the static start",
        "cycles computed",
        "no cycle found",
    ),
    "sliding": Words(
        "Growth rate of steady sliding (1/s)",
        "unstable steady sliding",
        "values computed",
        "no steady sliding",
    ),
}
TOP = 0.96  # height of the marks of values without a cycle, as a share of the panel


def plot_critical(
    critical: Critical,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw the growth rate of the motion over the parameter; shaded: it is unstable. Returns the
    axes."""
    words = WORDS[critical.kind]
    label, factor = axis_of(critical.name)
    unit = presentation_of(critical.name).unit
    x = critical.values * factor
    case = stated(critical.parameters, critical.name)
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.8, title=case) as page:
        page.show(Quantities(label, words.rate))
        axes = page.ax
        entry = words.shaded
        for ends in critical.unstable * factor:
            axes.axvspan(
                *ends, zorder=0, label=entry, color=SEPARATED, alpha=0.3, linewidth=wide(0.8)
            )
            entry = "_nolegend_"
        axes.plot(
            x,
            above_floor(critical.growth_rate),
            ".-",
            color=BLACK,
            label=words.computed,
            markersize=mark(3),
            linewidth=wide(0.7),
        )
        scale_rates(axes)
        lowest = draw_at_floor(axes, x, Look(BLACK), np.isneginf(critical.growth_rate))
        if lowest:
            set_margins(axes)
        gone = x[np.isnan(critical.growth_rate)]
        if gone.size:
            axes.plot(
                gone,
                np.full(gone.size, TOP),
                "x",
                color=BLACK,
                label=words.missing,
                markersize=mark(3),
                markeredgewidth=wide(0.6),
                transform=axes.get_xaxis_transform(),
            )
        page.note = _note_of(critical, factor, unit)
        axes.set_xlabel(label)
        axes.set_ylabel(words.rate)
        axes.set_xlim((x[0], x[-1]))
        page.explain([*axes.get_legend_handles_labels()[0], *lowest])
    return page.ax


def _note_of(critical: Critical, factor: float, unit: str) -> str:
    """From where on the motion is unstable, and what may have been overlooked."""
    step = f"{critical.resolution * factor:.2g} {unit}".strip()
    overlooked = f"tongues below {step} may be missed"
    if np.isnan(critical.value):
        return overlooked
    first = f"unstable from {critical.value * factor:.5g} {unit}".strip()
    if critical.at_lower_bound:
        first = "already unstable at the lower bound"
    lines = [first, _place_of_motion(critical), overlooked]
    return "\n".join(filter(None, lines))


def _place_of_motion(critical: Critical) -> str:
    """Where the motion is at the critical value, if it is not near the unstable cycle; else ""."""
    if critical.near_motion is not False:
        return ""
    if np.isnan(critical.other_growth_rate):
        return "there the motion is not near this cycle"
    return "there the motion is near another cycle"
