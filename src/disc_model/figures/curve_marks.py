"""Marks of curves: those of points whose value is in doubt or at a bound, of points without a
value, and of steps at which a line is open."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.arrows import draw_arrows, has_arrows
from disc_model.figures.classes import FILLED_MARK, UNSETTLED, name_of
from disc_model.figures.curve_looks import MARK, Looks
from disc_model.figures.drawing import GREY, is_in_data, mark, wide
from disc_model.figures.gap_rows import add_row
from disc_model.figures.missing_texts import missing_text, text_below_lowest, texts_without_border
from disc_model.figures.rate_scale import ANOTHER_BORDER, ANOTHER_RANGE, OPEN
from disc_model.figures.selection import (
    Part,
    beyond_lowest_speed,
    classes_of_infinite,
    doubts,
    gaps,
    parts_along,
    remaining,
    unsettled,
    unstable_everywhere,
)
from disc_model.figures.settled_motions import calm_points
from disc_model.figures.types import Array, Axes, Mask
from disc_model.figures.words import KINDS, NO_VALUE, WORDS, Measured, measured

ARROW = 7.0  # points, size of an arrow below a point, and its distance
MOST_ROWS = 6  # lines that have a row each for their gaps: more of them have one together
FILLED = 1.9  # order of filled marks, just below that of lines
MARGIN = 0.03  # share of the panel beside values
MARGIN_OF_LARGE = 0.06  # above and below marks of more than this size
LARGE = 5.0  # points
ROOM = 0.12  # share of the panel beside its values that has room for them


def measured_along(coordinate: xr.DataArray) -> Measured:
    """The label and the values of the horizontal axis; words by their names."""
    across = measured(coordinate)
    if coordinate.dtype.kind not in "UO":
        return across
    known = KINDS if coordinate.name == "kind" else WORDS
    names = [known.get(str(word), str(word)) for word in coordinate.values]
    return across._replace(values=np.array(names))


def open_look() -> dict[str, Any]:
    """Look of lines and of marks of missing values."""
    return {
        "markersize": mark(MARK),
        "markerfacecolor": "none",
        "markeredgewidth": wide(0.6),
        "linewidth": wide(0.7),
    }


def point_down(
    ax: Axes,
    parts: Sequence[Part[xr.DataArray]],
    along: Array,
    bounds: Mapping[str, Mask],
    looks: Looks,
) -> None:
    """Hang an arrow on each point whose value is the lower bound of its search, and may be less."""
    if not any(at_bound.any() for at_bound in bounds.values()):
        return
    for part in parts:
        here = bounds[part.name]
        if here.any():
            heights = part.data.values[here]
            draw_arrows(ax, along[here], heights, looks.colours[part.name], "down", ARROW)
    set_margins(ax)


def set_margins(ax: Axes) -> None:
    """Leave room around values, more above and below them for large marks, and most if arrows hang
    there."""
    sizes = [line.get_markersize() for line in ax.lines if is_in_data(ax, line)]
    upward = MARGIN_OF_LARGE if max(sizes, default=0.0) > mark(LARGE) else MARGIN
    ax.margins(MARGIN, ROOM if has_arrows(ax) else upward)


def fill_doubtful(ax: Axes, study: xr.Dataset, array: xr.DataArray, x: str, looks: Looks) -> None:
    """Fill the marks of points whose value may be another than that of a settled motion, below the open
    ones of other lines, so that both are seen; those of a panel have one entry in the legend."""
    by = remaining(array, [x])
    along = measured_along(array[x]).values
    for reason, doubtful in doubts(study, str(array.name)).items():
        if not (doubtful & array.notnull()).any():
            continue
        look: dict[str, Any] = {"linestyle": "", "markersize": mark(4)}
        words = FILLED_MARK.format(reason.label)
        if words not in ax.get_legend_handles_labels()[1]:
            ax.plot([], [], color=GREY, marker="o", label=words, **look)
        for part, chosen in zip(parts_along(array, by), parts_along(doubtful, by), strict=True):
            here = chosen.data.values & np.isfinite(part.data.values)
            if here.any():
                look |= {**looks.of(part.name), "label": "_nolegend_"}
                look["zorder"] = FILLED
                ax.plot(along[here], part.data.values[here], **look)


def mark_gaps(
    ax: Axes,
    reasons: Mapping[str, xr.DataArray],
    array: xr.DataArray,
    x: str,
    looks: Looks,
    named: Collection[str] = (),
) -> None:
    """Mark points without a value, by their reasons, above the panel: a row for each line and each
    reason, in the looks of the lines, but for lines that the legend names with their reason; many lines
    have one row together."""
    by = remaining(array, [x])
    across = measured_along(array[x]).values
    placed = array[x].notnull()
    for reason, gone in reasons.items():
        parts = parts_along(gone & placed, by)
        shown = [part for part in parts if part.data.values.any() and part.name not in named]
        if len(parts) > MOST_ROWS:
            masks = [part.data.values for part in shown]
            row = {"sweep": looks.sweep, "dashes": looks.dashes, "marker": "o", **open_look()}
            _mark_together(ax, reason, across, masks, len(parts), **row)
            continue
        for part in shown:
            mask = part.data.values
            look = {**looks.of(part.name), **open_look()}
            add_row(ax, reason, across[mask], looks.sweep, looks.dashes, **look)


def _mark_together(
    ax: Axes, reason: str, across: Array, masks: Sequence[Mask], count: int, **look: Any
) -> None:
    """Mark points at which any of many lines has a gap in one row above the panel, and say of how many
    of them."""
    if not masks:
        return
    lines_at = np.sum(masks, axis=0)
    here = lines_at > 0
    least, most = lines_at[here].min(), lines_at[here].max()
    number = f"{most}" if least == most else f"{least} to {most}"
    add_row(ax, f"{reason}: {number} of {count} lines", across[here], color=GREY, **look)


def reasons_of_gaps(study: xr.Dataset, array: xr.DataArray) -> dict[str, xr.DataArray]:
    """Points without a value, by the words that say why: also where longer stays may give one."""
    found = {}
    doubtful = unsettled(study, str(array.name))
    for name, gone in gaps(study, array).items():
        if name != name_of(NO_VALUE):
            found[name] = gone
            continue
        for reason, points in _without_value(study, str(array.name), gone).items():
            if doubtful is None:
                found[reason] = points
                continue
            found[reason] = points & ~doubtful
            found[f"{reason}, {UNSETTLED.label}"] = points & doubtful
    infinite = infinite_points(study, array)
    for reason in found:
        found[reason] = found[reason] & (infinite == "")
    for word in np.unique(infinite.values[infinite.values != ""]):
        found[name_of(str(word))] = infinite == word
    return found


def infinite_points(study: xr.Dataset, array: xr.DataArray) -> xr.DataArray:
    """The class of each point of a variable that has an infinite value, "" elsewhere."""
    variable = study[str(array.name)].transpose(*array.dims)
    if variable.dtype.kind != "f":
        return array.copy(data=np.full(array.shape, ""))
    return array.copy(data=classes_of_infinite(variable))


def _without_value(study: xr.Dataset, name: str, gone: xr.DataArray) -> dict[str, xr.DataArray]:
    """Points that were computed and have no value, by the words for them; a speed at which separation
    begins or ends may also lie below the lowest speed of a sweep, and a motion without a border of
    stability is unstable at all values, or stable at the upper bound."""
    everywhere = unstable_everywhere(study, name)
    if everywhere is not None:
        unstable, stable = texts_without_border(study)
        return {unstable: gone & everywhere, stable: gone & ~everywhere}
    calm = calm_points(study, name)
    if calm:
        no_events = {reason: gone & points for reason, points in calm.items()}
        others = gone
        for points in calm.values():
            others = others & ~points
        return {**no_events, missing_text(study, name): others}
    reason = missing_text(study, name)
    below = beyond_lowest_speed(study, name)
    if below is None:
        return {reason: gone}
    return {reason: gone & ~below, text_below_lowest(study): gone & below}


def reason_of_open_steps(variable: str) -> str:
    """The words that say why lines of a variable are open at some steps."""
    if variable == "critical_speed":
        return ANOTHER_RANGE
    return ANOTHER_BORDER if variable == "value" else OPEN


def mark_open_steps(
    ax: Axes, steps: Mapping[str, Mask], along: Array, looks: Looks, reason: str
) -> None:
    """Mark the steps at which lines are open above the panel by strokes halfway between their points,
    in the colours of the lines: no points lie there."""
    if not steps:  # as along words
        return
    middle = 0.5 * (along[:-1] + along[1:])
    if ax.get_xscale() == "log":
        middle = np.sqrt(along[:-1] * along[1:])
    shape: dict[str, Any] = {"marker": "|", "markersize": mark(5)}
    if len(steps) > MOST_ROWS:
        masks = [is_gap for is_gap in steps.values() if is_gap.any()]
        row = {"sweep": looks.sweep, "dashes": looks.dashes, **shape}
        _mark_together(ax, reason, middle, masks, len(steps), **row)
        return
    for name, is_gap in steps.items():
        if is_gap.any():
            look = {**shape, "color": looks.colours[name]}
            add_row(ax, reason, middle[is_gap], looks.sweep, looks.dashes, **look)
