"""Modes of steady sliding along a parameter: frequencies and growth rates."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.figures.cut import (
    entries_of_left_out,
    entry_of_cut,
    mark_cut,
    modes_above,
    modes_cut,
    modes_left_out,
)
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    halo,
    large,
    letters,
    mark,
    panels,
    sample,
    say,
    say_beside,
    wide,
)
from disc_model.figures.growing_parts import growing_part
from disc_model.figures.growth import ROUNDING
from disc_model.figures.kinds.motions import SlidingModes
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.names import Names, name_of, named_modes
from disc_model.figures.selection import stretches, without_single
from disc_model.figures.types import Array, Axes, Figure, Indices
from disc_model.figures.words import measured

DECAYS = 0.8  # width of the line of a mode that decays, points,
GROWS = 2.4  # and of one that grows
ABOVE = 2.1  # zorder of such lines: a mode that decays may have the frequency of one that grows
FREE = 0.25  # of the largest growth rate, room above a line that is enough for its name
NAMES_APART = 0.04  # of the axis of frequencies, least distance of names
NAMES_IN_A_ROW = 4.0  # points, least distance of the names of two growing modes
RATES_APART = 0.1  # of that of growth rates
LINE = 0.13  # and height of a line of names beside it, both over the largest rate
EDGE = 0.05  # of the width of the panel, beside its ends, where names stand on the inner side
BESIDE = ((-4, 3), (4, 3), (-4, 0), (4, 0), (0, 10))
"""Offsets in points of the name of a growing mode where it has no room above its line,"""
BELOW = ((-4, -4), (4, -4), (-4, -12))
"""and of one that grows so fast that there may be room below."""
HEADROOM = 1.25  # upper end of that axis over the largest rate, whose name stands above it
LEAST = 0.1  # 1/s, upper end of the axis of growth rates at least
AT_EDGE = 0.03  # of the panel, height of the marks of modes below it
MARKS = 12  # marks of such a mode along the panel, about
MOST_NAMES = 4  # names of such modes in the legend


class Line(NamedTuple):
    """The line of a mode, as long as its nodal diameters stay: frequency in Hz and growth rate in
    1/s along the parameter, nan elsewhere."""

    name: str
    frequency: Array
    rate: Array


def draw(plot: SlidingModes, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw frequencies above growth rates, a column for each value of the compared dimension; lines
    are thick where a mode grows."""
    parts = parts_shown(study, plot.by, plot.names)
    count = len(parts)
    width = plot.inches
    figure, axes = panels(width, 5.6, 2, count, height_ratios=[5, 4], sharex=True, sharey="row")
    tops = axes[:count]
    bottoms = axes[count:]
    columns = [without_single(part.data, "value", "mode") for part in parts]
    limits = [_limits(column) for column in columns]
    greatest = max(high for _, high in limits)
    for top, bottom, column in zip(tops, bottoms, columns, strict=True):
        _draw_lines(top, bottom, column)
    highest = plot.highest or tops[0].get_ylim()[1]
    across = measured(columns[0]["value"])
    tops[0].set_ylabel("Frequency in the slider's frame (Hz)")
    tops[0].set_ylim((0, highest))
    if across.values.size > 1:
        tops[0].set_xlim(across.values[0], across.values[-1])
    bottoms[0].set_ylabel("Growth rate (1/s)")
    lowest = min(low for low, _ in limits)
    bottoms[0].set_ylim(lowest, HEADROOM * greatest)
    for top, bottom, column in zip(tops, bottoms, columns, strict=True):
        bottom.set_xlabel(across.label)
        _name_frequencies(top, column, highest)
        if modes_above(column["frequency"], highest):
            mark_cut(top, highest)
        _name_decays(bottom, column, greatest)
        _mark_below(bottom, column, lowest)
    letters(axes, titles_of_panels(parts, study, plot.by))
    _legend(figure, columns, lowest, highest)
    return figure


def _legend(figure: Figure, columns: Sequence[xr.Dataset], lowest: float, highest: float) -> None:
    """Name the widths of the lines that are drawn, and the modes below the axis of growth rates and
    above that of frequencies."""
    rates = np.concatenate([column["mode_growth_rate"].values.ravel() for column in columns])
    largest = np.concatenate([column["largest_growth_rate"].values.ravel() for column in columns])
    handles = []
    if (rates <= ROUNDING).any():
        handles.append(sample(color=GREY, linewidth=wide(DECAYS), label="mode decays"))
    if (largest > ROUNDING).any():
        handles.append(sample(color=BLACK, linewidth=wide(GROWS), label="mode grows"))
    above = max(modes_cut(column, "frequency", highest) for column in columns)
    if above:
        handles.append(entry_of_cut(above, highest))
    handles += entries_of_left_out(columns)
    names = [*dict.fromkeys(line.name for column in columns for line in below(column, lowest))]
    if names:
        said = names[:MOST_NAMES]
        if len(names) > MOST_NAMES:
            said.append(f"{len(names) - MOST_NAMES} more")
        label = f"decays faster than {-lowest:.3g}/s: {', '.join(said)}"
        handles.append(sample(label=label, **_look_below()))
    figure_legend(figure, handles)


def _limits(study: xr.Dataset) -> tuple[float, float]:
    """Ends of the axis of growth rates, 1/s. The sign matters: decay of high modes may be much
    faster than growth."""
    low = float(study["mode_growth_rate"].min())
    high = max(float(study["largest_growth_rate"].max()), LEAST)
    return max(1.1 * low, -high), high


# ---- Selection


def lines_of(study: xr.Dataset) -> list[Line]:
    """The lines of all modes, cut where their nodal diameters change, and that of growth at 0 Hz,
    which is of no mode, where it is the largest. Where the study has no room for some modes, the largest
    may be that of one of these."""
    lines = []
    for _, mode in study.groupby("mode"):
        mode = mode.squeeze("mode")
        frequency = mode["frequency"].values
        rate = mode["mode_growth_rate"].values
        diameters = np.where(np.isfinite(frequency), mode["diameters"], np.nan)
        for number in np.unique(diameters[np.isfinite(diameters)]):
            here = diameters == number
            name = name_of(int(number))
            lines.append(
                Line(name, np.where(here, frequency, np.nan), np.where(here, rate, np.nan))
            )
    largest = study["largest_growth_rate"]
    of_modes = study["mode_growth_rate"].max("mode")
    diverging = (largest > of_modes + ROUNDING).values
    at_zero = np.where(diverging, 0.0, np.nan)
    name = "0 Hz"
    if modes_left_out(study):
        at_zero = np.full(at_zero.shape, np.nan)
        name = "not computed"
    lines.append(Line(name, at_zero, np.where(diverging, largest.values, np.nan)))
    return lines


def below(study: xr.Dataset, lowest: float) -> list[Line]:
    """The lines that are below the axis of growth rates, which begins at `lowest` (1/s), wherever
    they have one."""
    found = []
    for line in lines_of(study):
        rates = line.rate[np.isfinite(line.rate)]
        if rates.size and rates.max() < lowest:
            found.append(line)
    return found


# ---- Drawing


def _look_below() -> dict[str, Any]:
    """Look of modes below the axis of growth rates."""
    return {"color": GREY, "marker": "v", "linestyle": "", "markersize": mark(3)}


def _draw_lines(top: Axes, bottom: Axes, study: xr.Dataset) -> None:
    """Draw the lines of all modes, thick where they grow, with their names there."""
    along = measured(study["value"]).values
    lines = lines_of(study)
    largest = float(study["largest_growth_rate"].max())
    named: list[tuple[int, tuple[float, float], str, list[tuple[float, float]]]] = []
    thick = []
    for line in lines:
        grows = np.nan_to_num(line.rate) > ROUNDING
        for ax, values in ((top, line.frequency), (bottom, line.rate)):
            ax.plot(along, values, ".-", **_look(GREY, DECAYS))
            _draw_growing(ax, along, line.rate, values)
        thick.append(np.column_stack([along, line.rate])[grows])
        for start, after in stretches(grows[:-1] & grows[1:]):
            shown = slice(start, after + 1)
            i = start + _place_of_name(line.rate[shown], [x.rate[shown] for x in lines], largest)
            across = (along[i] - along[0]) / (along[-1] - along[0])
            side = 0
            if across < EDGE:
                side = 1
            elif across > 1 - EDGE:
                side = -1
            place = (float(along[i]), float(line.rate[i]))
            offsets: list[tuple[float, float]] = [(3 * side, 3), *BESIDE]
            if place[1] > FREE * largest:
                offsets += BELOW
            named.append((after - start, place, line.name, offsets))
    thick.append(np.column_stack([along, np.zeros(len(along))]))  # the line at zero
    names = Names(bottom, lines=np.concatenate(thick), beside=NAMES_IN_A_ROW)
    # narrow peaks have no room but above them, and come before those beside them
    for _, place, name, offsets in sorted(named, key=lambda each: (each[0], -each[1][1])):
        names.add(name, place, offsets, fontsize=large(7), path_effects=halo())
    bottom.axhline(0, color=BLACK, linewidth=wide(0.5))


def _draw_growing(ax: Axes, along: Array, rate: Array, values: Array) -> None:
    """Draw the line of a mode where it grows, with dots at the computed values."""
    look = _look(BLACK, GROWS)
    ax.plot(*growing_part(along, rate, values), "-", zorder=ABOVE, **look)
    grows = np.nan_to_num(rate) > ROUNDING
    ax.plot(along, np.where(grows, values, np.nan), ".", zorder=ABOVE, **look)


def _look(colour: str, width: float) -> dict[str, Any]:
    """Look of a line whose dots, which show points by themselves, are no wider than itself."""
    return {
        "color": colour,
        "linewidth": wide(width),
        "markersize": mark(2 * width),
        "markeredgewidth": 0,
    }


def _place_of_name(rate: Array, others: Sequence[Array], largest: float) -> int:
    """Index in a stretch of a line at which its name stands: where there is room above, and else at
    the largest rate."""
    above = np.array(others) - rate
    room = np.where(above > 0, above, np.inf).min(axis=0, initial=FREE * largest)
    return int(np.lexsort((rate, room))[-1])


def _name_frequencies(ax: Axes, study: xr.Dataset, highest: float) -> None:
    """Write the names of modes at the left ends of their frequencies."""
    first = study.isel(value=0)
    left = measured(study["value"]).values[0]
    heights = first["frequency"].values
    white = {"fc": "white", "lw": 0, "pad": 1}
    for part in named_modes(first["diameters"].values, heights, NAMES_APART * highest):
        place = (left, float(heights[part.modes].mean()))
        if place[1] <= highest:
            say(ax, part.name, place, (3, 0), fontsize=large(7), bbox=white)


def _mark_below(ax: Axes, study: xr.Dataset, lowest: float) -> None:
    """Mark at the lower edge where modes decay so fast that their lines are below the panel."""
    along = measured(study["value"]).values
    transform = ax.get_xaxis_transform()
    for line in below(study, lowest):
        places = along[np.isfinite(line.rate)]
        places = places[:: max(1, places.size // MARKS)]
        ax.plot(places, np.full(places.size, AT_EDGE), transform=transform, **_look_below())


def _name_decays(ax: Axes, study: xr.Dataset, greatest: float) -> None:
    """Write the names of decaying modes beside the right ends of their growth rates."""
    last = study.isel(value=-1)
    rates = last["mode_growth_rate"].values
    shown = (rates < -ROUNDING) & (rates > -greatest)
    decay = np.where(shown, rates, np.nan)
    blocks: list[Indices] = []
    for part in named_modes(last["diameters"].values, decay, RATES_APART * greatest):
        modes = part.modes
        # below the former ones, unless the lines of both would meet
        while blocks and _meet(blocks[-1], modes, last["diameters"].values, decay, LINE * greatest):
            modes = np.concatenate([blocks.pop(), modes])
        blocks.append(modes)
    for modes in blocks:
        height = float(decay[modes].mean())
        text = "\n".join(_names_downwards(modes, last["diameters"].values, decay))
        say_beside(ax, height, text, 3, fontsize=large(7), color=GREY)


def _names_downwards(modes: Indices, diameters: Array, rates: Array) -> list[str]:
    """Names of modes below each other as their lines are, which one name for several would not
    tell."""
    descending = modes[np.argsort(-rates[modes])]
    return [*dict.fromkeys(name_of(int(number)) for number in diameters[descending])]


def _meet(lower: Indices, upper: Indices, diameters: Array, rates: Array, line: float) -> bool:
    """Whether names of modes, each set in the middle of its growth rates, would lie on each other.

    line : height of a line of names, 1/s
    """
    lines = sum(len(_names_downwards(modes, diameters, rates)) for modes in (lower, upper))
    return bool(rates[upper].mean() - rates[lower].mean() < 0.5 * lines * line)
