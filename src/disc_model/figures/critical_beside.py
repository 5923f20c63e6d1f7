"""Critical values of several cases on the same axes: a line and a bar of unstable values for each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.figures.branch_lines import above_floor, draw_at_floor
from disc_model.figures.case_lines import Lines, Style, limits_of
from disc_model.figures.critical_curve import MISSING, WORDS, Curve, draw_missing
from disc_model.figures.drawing import GREY, mark, sample, wide
from disc_model.figures.family import Member
from disc_model.figures.overlay import Case
from disc_model.figures.rate_scale import scale_rates
from disc_model.figures.stated_case import stated, stated_values
from disc_model.figures.types import Artist, Axes
from disc_model.figures.words import BELOW_ANY

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical

TOP = 0.96  # height of the marks of values without a cycle, as a share of the panel
ROW = 0.07  # and how much lower each further case has its own,
BELOW_BAR = 0.03  # and those marks below its bar
ABOVE = 0.3  # share of the growth rates that is free above them for bars of several cases
ROOM = 0.05  # and share that is free on both sides of them
LINE = 0.8  # points, width of the line of one of several cases,
SAMPLE = 1.2  # of that in the legend,
BAR = 2.5  # and of its bar
SMALL = 3.0  # points, size of marks
APART = 0.06  # least distance of marks along a line, over the panel's diagonal
UNSTABLE = "disc_model_unstable"
"""Group ids of marks of values without a motion, and of bars of unstable ones."""


def case_of(critical: Critical, name: str, note: str) -> Case:
    """The case of critical values, which are told apart by the kind of motion too."""
    values = {"motion": WORDS[critical.kind].motion}
    values |= stated_values(critical.parameters, critical.name)
    said = stated(critical.parameters, critical.name)
    return Case("critical", Member(name, values), said, (note,))


def lines_of(curve: Curve) -> Lines:
    """How critical values are drawn beside others: as a line with marks of their own, and a bar of the
    same look where the motion is unstable, in a row of bars at the top."""

    def draw(ax: Axes, style: Style) -> Artist:
        look = {**style.look.line(LINE), **_mark_of(style)}
        height = TOP - ROW * style.place
        for rates in (curve.rates, curve.sliding):
            if np.isfinite(rates).any():  # matplotlib finds no distances of marks otherwise
                ax.plot(curve.x, above_floor(rates), markevery=APART, **look)
        scale_rates(ax)
        draw_at_floor(ax, curve.x, style.look, np.isneginf(curve.rates))
        across = ax.get_xaxis_transform()
        for ends in curve.unstable:
            bar = {**look, "linewidth": wide(BAR), "linestyle": "-", "solid_capstyle": "butt"}
            ax.plot(ends, [height, height], transform=across, gid=UNSTABLE, **bar)
        if curve.gone.size:
            draw_missing(ax, curve, height - BELOW_BAR, style.look.colour)
        ax.set_xlabel(curve.label)
        ax.set_ylabel(curve.rate_label)
        return sample(**{**look, "linewidth": wide(SAMPLE)})

    return Lines(draw, ((curve.x[0], curve.x[-1]), _upward_limits(curve)))


def _mark_of(style: Style) -> dict[str, Any]:
    """Options of the open mark of a case."""
    marks = style.marks(SMALL)
    return {name: marks[name] for name in ("marker", "markerfacecolor", "markersize")}


def _upward_limits(curve: Curve) -> tuple[float, float]:
    """Limits of growth rates, with room above them for bars."""
    rates = np.concatenate([curve.rates, curve.sliding])
    known = rates[np.isfinite(rates)]
    low, high = limits_of(known if known.size else np.zeros(1), ROOM)
    return low, high + ABOVE * (high - low)


def has_bars(ax: Axes) -> bool:
    """Whether bars show where motions of several cases are unstable."""
    return any(line.get_gid() == UNSTABLE for line in ax.lines)


def entries_of_all(ax: Axes, curve: Curve) -> list[Artist]:
    """Entries of the legend that serve all cases beside each other: the bars, and what else is there in
    one of them."""
    drawn = {line.get_gid() for line in ax.lines}
    entries = [sample(color=GREY, linewidth=wide(BAR), label=f"bar: {curve.words.shaded}")]
    options = {"color": GREY, "linestyle": ""}
    if curve.gone.size or MISSING in drawn:
        entries.append(sample(marker="x", markersize=mark(3), label=curve.words.missing, **options))
    if np.isneginf(curve.rates).any() or BELOW_ANY in drawn:
        entries.append(sample(marker="v", markersize=mark(4), label=BELOW_ANY, **options))
    return entries
