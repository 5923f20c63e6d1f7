"""Growth of the cycle along a parameter, and where the motion is unstable."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from disc_model.data.variables import axis_of, presentation_of
from disc_model.figures.branch_lines import Look, above_floor, draw_at_floor, set_margins
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.case_lines import Lines, Style
from disc_model.figures.drawing import BLACK, COLUMN, GREY, INDIGO, SEPARATED, mark, sample, wide
from disc_model.figures.family import Member
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import Case, draw_case, limits_of, name_of_case
from disc_model.figures.rate_scale import scale_rates
from disc_model.figures.stated_case import stated, stated_values
from disc_model.figures.types import Artist, Axes
from disc_model.figures.words import BELOW_ANY

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical


class Words(NamedTuple):
    """What a picture says of a kind of motion: its name, on its axis, and in its legend."""

    motion: str
    rate: str
    shaded: str
    computed: str
    missing: str


WORDS = {
    "stick_slip": Words(
        "motion near the static start",
        "Growth rate of the cycle (1/s)",
        "unstable near the static start",
        "cycles computed",
        "no cycle found",
    ),
    "sliding": Words(
        "steady sliding",
        "Growth rate of steady sliding (1/s)",
        "unstable steady sliding",
        "values computed",
        "no steady sliding",
    ),
}
IN_SLIDING = "steady sliding, where no cycle exists"
OF_BOTH = "Growth rate of the cycle, or of sliding (1/s)"
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
MISSING = "disc_model_no_motion"
UNSTABLE = "disc_model_unstable"
"""Group ids of marks of values without a motion, and of bars of unstable ones."""


class Curve(NamedTuple):
    """What is drawn of critical values, in the unit of the axis.

    x : values of the parameter, (m,)
    rates, sliding : growth rates, and those of steady sliding where there is no cycle, 1/s, (m,)
    unstable : (n, 2), ends of the stretches of instability
    label, unit, factor : of the parameter
    """

    x: np.ndarray
    rates: np.ndarray
    sliding: np.ndarray
    unstable: np.ndarray
    words: Words
    label: str
    unit: str
    factor: float

    @classmethod
    def of(cls, critical: Critical) -> Curve:
        """What is drawn of critical values."""
        label, factor = axis_of(critical.name)
        sliding = critical.sliding_growth_rate
        if critical.kind == "sliding":
            sliding = np.full(critical.values.shape, np.nan)
        return cls(
            critical.values * factor,
            critical.growth_rate,
            sliding,
            critical.unstable * factor,
            WORDS[critical.kind],
            label,
            presentation_of(critical.name).unit,
            factor,
        )

    @property
    def has_sliding(self) -> bool:
        """Whether steady sliding takes the place of a cycle somewhere."""
        return bool(np.isfinite(self.sliding).any())

    @property
    def rate_label(self) -> str:
        """The label of the growth rates."""
        return OF_BOTH if self.has_sliding else self.words.rate

    @property
    def gone(self) -> np.ndarray:
        """Values without a motion whose growth rate is known."""
        return self.x[np.isnan(self.rates) & np.isnan(self.sliding)]


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
    overlaid = _case_of(critical, name, _note_of(critical, curve))
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.8, title=overlaid.title) as page:
        page.show(Quantities(curve.label, curve.rate_label))
        common = _entries_of_all(page.ax, curve)
        draw_case(page, overlaid, [_lines(curve)], lambda: _draw_alone(page, curve), common)
        if not name and not _has_bars(page.ax):
            page.note = overlaid.notes[0]
    return page.ax


def _case_of(critical: Critical, name: str, note: str) -> Case:
    """The case of critical values, which are told apart by the kind of motion too."""
    values = {"motion": WORDS[critical.kind].motion}
    values |= stated_values(critical.parameters, critical.name)
    said = stated(critical.parameters, critical.name)
    return Case("critical", Member(name, values), said, (note,))


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
        _draw_missing(axes, curve, TOP, BLACK, label=words.missing)
    axes.set_xlabel(curve.label)
    axes.set_ylabel(curve.rate_label)
    axes.set_xlim((curve.x[0], curve.x[-1]))
    page.explain([*axes.get_legend_handles_labels()[0], *lowest])


def _lines(curve: Curve) -> Lines:
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
            _draw_missing(ax, curve, height - BELOW_BAR, style.look.colour)
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


def _draw_missing(ax: Axes, curve: Curve, height: float, colour: str, **options: Any) -> None:
    """Mark values without a motion at a height of the panel."""
    ax.plot(
        curve.gone,
        np.full(curve.gone.size, height),
        "x",
        color=colour,
        markersize=mark(3),
        markeredgewidth=wide(0.6),
        transform=ax.get_xaxis_transform(),
        gid=MISSING,
        **options,
    )


def _has_bars(ax: Axes) -> bool:
    """Whether bars show where motions of several cases are unstable."""
    return any(line.get_gid() == UNSTABLE for line in ax.lines)


def _entries_of_all(ax: Axes, curve: Curve) -> list[Artist]:
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


def _note_of(critical: Critical, curve: Curve) -> str:
    """From where on the motion is unstable, and what may have been overlooked."""
    factor = curve.factor
    unit = curve.unit
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
