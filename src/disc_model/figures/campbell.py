"""Campbell diagrams: frequencies and growth rates against the speed."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_bands import draw_bands, entries_of_bands
from disc_model.figures.campbell_crossings import entries_of_unresolved
from disc_model.figures.cut import (
    entries_of_left_out,
    entry_of_cut,
    mark_cut,
    modes_above,
    modes_cut,
)
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    halo,
    large,
    letters,
    mark,
    open_line,
    panels,
    sample,
    say_beside,
    whole_marks,
    wide,
)
from disc_model.figures.growth import ROUNDING
from disc_model.figures.kinds.motions import Campbell
from disc_model.figures.legends import figure_legend
from disc_model.figures.names import Names, named_modes
from disc_model.figures.rate_scale import LINEAR, scale_rates
from disc_model.figures.selection import (
    NORM,
    broken,
    doubts,
    normalizations,
    parts_along,
    stretches,
    titles_of,
)
from disc_model.figures.types import Array, Artist, Axes, Figure, Mask
from disc_model.figures.words import SPEED

MOST = 5  # number of peaks that are named at most
NEAR = 0.01  # share of the speeds shown within which peaks are one, and crossings belong to a peak
ROOM = 1.06  # highest frequency of the axis over that of the modes
BESIDE_MEETING = tuple(
    (across, up) for up in (4, 9, 14) for across, up in ((6, -up), (-6, up), (6, up), (-6, -up))
)
"""Offsets in points of names beside crossings, best first."""
LED_TO_MEETING = tuple((across, up) for up in (22, 32, 44, 56) for across in (-14, 14, -28, 28, 0))
"""Further offsets, at which a line leads to the crossing."""
BETWEEN = 20  # points of each step of a line, which no name covers
UPRIGHT = 200  # points along the line at the speed of a peak
BESIDE_PEAK = ((2, 3), (-2, 3), (2, 10), (-2, 10), (2, 17), (-2, 17))  # and beside peaks
SYMBOLS = ("$f_s$", "$f_Ω$")
"""Of the frequencies whose multiples modes meet: of stick-slip, and of the drive."""
GROWS = 2.4  # points, width of the line of a mode that grows
NAMES_APART = 0.045  # of the axis, least distance of the names of modes
FREQUENCY = "Frequency in the slider's frame (Hz)"
RATE = "Largest growth rate\nof the cycle (1/s)"
PEAK = "peak of growth"
NOT_CROSSED = "no crossing found at it"
ALONE = "by itself: another cycle, or too wide a step"
"""What a point may be that differs from both neighbours."""
EDGE = 1.0  # height of a mark at this edge, as a share of the panel


class Peak(NamedTuple):
    """A peak of the cycle's growth rate: the place of its speed, the crossing at it, if any, and whether
    it is a point by itself, which the steps do not resolve."""

    place: int
    crossing: xr.Dataset | None
    alone: bool = False


class Column(NamedTuple):
    """A study of one model, which has a column of panels, and the peaks of its growth rate."""

    study: xr.Dataset
    peaks: Sequence[Peak]


def draw(plot: Campbell, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw frequencies above growth rates, a column for each value of the compared dimension."""
    if NORM in study.dims and (plot.normalization is not None or plot.by != NORM):
        chosen = plot.normalization or normalizations(study)[0]
        study = study.sel({NORM: chosen})
    parts = parts_along(study, plot.by, plot.names)
    width = plot.inches
    figure, axes = panels(
        width, 5.4, 2, len(parts), height_ratios=[3, 2], sharex=True, sharey="row"
    )
    above = axes[: len(parts)]
    below = axes[len(parts) :]
    columns = [column_of(part.data.transpose("Omega", ...)) for part in parts]
    highest = plot.highest or highest_of(columns)
    draw_panels(above, below, columns, highest)
    letters(axes, titles_of(parts))
    for top, bottom, column in zip(above, below, columns, strict=True):
        name_peaks(top, bottom, column, highest)
    _legend(figure, columns, highest)
    return figure


def column_of(study: xr.Dataset) -> Column:
    """The column of a study, whose peaks are found here for all that is drawn and said of them."""
    return Column(study, [*peaks(study)])


def highest_of(columns: Sequence[Column]) -> float:
    """The upper end of an axis that shows all frequencies, Hz."""
    return ROOM * max(float(column.study["sliding_frequency"].max()) for column in columns)


def draw_panels(
    above: Sequence[Axes], below: Sequence[Axes], columns: Sequence[Column], highest: float
) -> None:
    """Draw frequencies up to the highest shown (Hz), and growth rates below them, on one scale."""
    for top, bottom, column in zip(above, below, columns, strict=True):
        _draw_column(top, bottom, column, highest)
    rates = [column.study["growth_rate"].values for column in columns]
    low = min(float(np.fmin.reduce(rate, initial=0.0)) for rate in rates)
    high = max(float(np.fmax.reduce(rate, initial=0.0)) for rate in rates)
    above[0].set_ylim(0, highest)
    below[0].set_ylim(min(3 * low, -LINEAR), max(3 * high, LINEAR))
    above[0].set_ylabel(FREQUENCY)
    below[0].set_ylabel(RATE)
    for ax in (*above, *below):
        whole_marks(ax)


def _legend(figure: Figure, columns: Sequence[Column], highest: float = np.inf) -> None:
    """Name lines, marks and bands that are drawn."""
    figure_legend(figure, entries_of(columns, highest), columns=3)


def entries_of(columns: Sequence[Column], highest: float) -> list[Artist]:
    """Entries of a legend for the lines, marks and bands that are drawn, and for what lies above the
    highest frequency shown (Hz)."""
    handles: list[Artist] = [
        sample(color=BLACK, linewidth=wide(0.9), label="mode of steady sliding")
    ]
    studies = [column.study for column in columns]
    if any(growing_modes(study).any() for study in studies):
        handles.append(sample(label="mode of steady sliding that grows", **_growing_look()))
    above = max(modes_cut(study, "sliding_frequency", highest) for study in studies)
    if above:
        handles.append(entry_of_cut(above, highest))
    handles += entries_of_left_out(studies)
    handles += entries_of_unresolved(studies)
    found = [peak for column in columns for peak in column.peaks]
    handles += _entries_of_peaks(found, highest)
    return handles + _entries_of_rates(studies)


def _entries_of_rates(studies: Sequence[xr.Dataset]) -> list[Artist]:
    """Entries of a legend for points by themselves, of other cycles, open steps, and gaps."""
    handles: list[Artist] = []
    followed = [followed_rates(study) for study in studies]
    if any(unjoined(rate).any() for rate in followed):
        handles.append(sample(label=ALONE, **_dot(alone=True)))
    for name in {look.label for study in studies for look in doubts(study, "growth_rate")}:
        handles.append(sample(label=name, **_elsewhere_look()))
    if any((np.abs(np.diff(rate)) > LINEAR).any() for rate in followed):
        wide_step = f"line open: a step of over {LINEAR:g}/s"
        handles.append(open_line(wide_step, BLACK, wide(0.8)))
    return handles + entries_of_bands(studies)


def _entries_of_peaks(found: Sequence[Peak], highest: float) -> list[Artist]:
    """Entries of a legend for peaks, and for their crossings below and above the highest frequency
    shown (Hz)."""
    if not found:
        return []
    handles: list[Artist] = []
    crossings = [peak.crossing for peak in found if peak.crossing is not None]
    shown = [crossing for crossing in crossings if _meeting(crossing)[1] <= highest]
    crossed = {_symbol(crossing) for crossing in shown}
    if crossed:
        symbols = " or ".join(sorted(crossed, key=SYMBOLS.index))
        handles.append(sample(label=f"multiple of {symbols}", **_multiple_look()))
    names = {True: f"{PEAK}, crossing at it" if shown else PEAK, False: f"{PEAK}, {NOT_CROSSED}"}
    unnamed = []
    for is_crossed, name in names.items():
        alike = [peak for peak in found if (peak.crossing is not None) == is_crossed]
        resolved = any(not peak.alone for peak in alike)
        if resolved:
            handles.append(sample(label=name, **_dot(alone=False, crossed=is_crossed)))
        elif alike:
            unnamed.append(name)  # marks of points by themselves say that they are not resolved
    at_line = " or ".join(unnamed) or "peak"
    handles.append(sample(label=f"speed of a {at_line}", **_speed_look()))
    if len(shown) < len(crossings):
        label = f"crossing above {highest:g} Hz"
        handles.append(sample(label=label, **_beyond_look()))
    return handles


def _draw_column(top: Axes, bottom: Axes, column: Column, highest: float) -> None:
    """Draw the frequencies of one model up to the highest shown (Hz), and its growth rates
    below."""
    study = column.study
    speeds = study["Omega"].values
    rate = study["growth_rate"].values
    elsewhere = _elsewhere(study)
    _draw_modes(top, study, highest)
    _draw_rates(bottom, speeds, followed_rates(study))
    bottom.plot(speeds[elsewhere], rate[elsewhere], **_elsewhere_look())
    scale_rates(bottom)
    for peak in column.peaks:
        _draw_peak(top, bottom, study, peak, highest)
    if modes_above(study["sliding_frequency"], highest):
        mark_cut(top, highest)
    draw_bands(top, bottom, study)
    top.set_xlim(speeds[0], speeds[-1])
    bottom.set_xlabel(SPEED)


def _draw_modes(ax: Axes, study: xr.Dataset, highest: float) -> None:
    """Draw the frequencies of steady sliding's modes, thick where they grow, with names at the right
    ends of those that are shown."""
    frequency = study["sliding_frequency"]
    ax.plot(study["Omega"], frequency, color=BLACK, linewidth=wide(0.9))
    grows = growing_modes(study)
    for mode in np.flatnonzero(grows.any("Omega")):
        thick = frequency.where(grows).isel(mode=mode)
        ax.plot(study["Omega"], thick, **_growing_look())
    ends = study.isel(Omega=-1)
    of_disc = np.where(flag_names(ends["mode_kind"]) == "disc", ends["diameters"].values, -1)
    heights = ends["sliding_frequency"].where(ends["sliding_frequency"] <= highest).values
    for part in named_modes(of_disc, heights, NAMES_APART * highest):
        height = float(heights[part.modes].mean())
        say_beside(ax, height, part.name, 3, fontsize=large(7))


def _growing_look() -> dict[str, Any]:
    """Look of a mode that grows; dots within the line show it at single speeds."""
    width = wide(GROWS)
    dot = {"marker": "o", "markersize": 0.8 * width, "markeredgewidth": 0}
    return {"color": BLACK, "linewidth": width, **dot}


def _dot(alone: bool, crossed: bool = True) -> dict[str, Any]:
    """Look of a dot; hollow for a point that is joined to none beside it, and a diamond at a peak
    without a crossing."""
    look: dict[str, Any] = {"color": BLACK, "linestyle": "", "markersize": mark(3.5)}
    look["marker"] = "o" if crossed else "D"
    if alone:
        look["markerfacecolor"] = "white"
        look["markeredgewidth"] = wide(0.7)
    return look


def _elsewhere_look() -> dict[str, Any]:
    """Look of a point of a cycle that the motion is not near."""
    return {
        "color": BLACK,
        "linestyle": "",
        "marker": "x",
        "markersize": mark(3.5),
        "markeredgewidth": wide(0.7),
    }


def _draw_rates(ax: Axes, speeds: Array, rate: Array) -> None:
    """Draw growth rates: a line where neighbours belong together, and hollow dots elsewhere."""
    alone = unjoined(rate)
    ax.plot(*broken(speeds, rate, LINEAR), "-", color=BLACK, linewidth=wide(0.8))
    joined = _dot(alone=False)
    joined["markersize"] = mark(1.0)
    ax.plot(speeds[~alone], rate[~alone], **joined)
    ax.plot(speeds[alone], rate[alone], **_dot(alone=True))


def _draw_peak(top: Axes, bottom: Axes, study: xr.Dataset, peak: Peak, highest: float) -> None:
    """Mark a peak of the growth rate, and the crossing of a mode with a multiple of a frequency, or at
    the upper edge that it lies above the highest frequency shown (Hz)."""
    speed = study["Omega"].values[peak.place]
    rate = study["growth_rate"].values[peak.place]
    for ax in (top, bottom):
        ax.axvline(speed, zorder=0, **_speed_look())
    bottom.plot(speed, rate, **_dot(peak.alone, crossed=peak.crossing is not None))
    if peak.crossing is None:
        return
    place = _meeting(peak.crossing)
    if place[1] > highest:
        edge = top.get_xaxis_transform()
        top.plot(place[0], EDGE, transform=edge, clip_on=False, **_beyond_look())
        return

    by_slips = flag_names(peak.crossing["crossing_line"]) == "stick_slip"
    line = study["stick_slip_frequency" if by_slips else "rotation_frequency"]
    multiple = float(peak.crossing["crossing_multiple"])
    top.plot(study["Omega"], multiple * line, zorder=0, **_multiple_look())
    top.plot(*place, **_dot(peak.alone))


def _speed_look() -> dict[str, Any]:
    """Look of the line at the speed of a peak, which is no narrow band without a growth rate."""
    return {"color": BLACK, "linewidth": wide(0.6), "linestyle": (0, (1, 2))}


def _beyond_look() -> dict[str, Any]:
    """Look of the mark of a crossing above the frequencies shown."""
    return {
        "color": BLACK,
        "linestyle": "",
        "marker": "^",
        "markersize": mark(4),
        "markerfacecolor": "white",
        "markeredgewidth": wide(0.7),
        "zorder": 4,  # on the edge
    }


def _multiple_look() -> dict[str, Any]:
    """Look of the line of a multiple of a frequency."""
    return {"color": GREY, "linewidth": wide(0.8), "linestyle": (0, (4, 2))}


def _meeting(crossing: xr.Dataset) -> tuple[float, float]:
    """Speed and frequency at which a mode meets a multiple, rad/s and Hz."""
    return float(crossing["crossing_Omega"]), float(crossing["crossing_frequency"])


def name_peaks(top: Axes, bottom: Axes, column: Column, highest: float = np.inf) -> None:
    """Write the multiples at peaks, and at crossings up to the highest frequency shown (Hz), where there
    is room."""
    study = column.study
    speeds = study["Omega"].values
    rate = study["growth_rate"].values
    modes = study["sliding_frequency"].transpose(..., "Omega").values
    above = Names(top, lines=_along_lines([(speeds, mode) for mode in modes]))
    of_rates = _along_lines([broken(speeds, followed_rates(study), LINEAR)])
    below = Names(bottom, lines=np.vstack([of_rates, np.column_stack([speeds, rate])]))
    outline = halo()
    for peak in column.peaks:
        if peak.crossing is None:
            continue
        name = _multiple(peak.crossing)
        meeting = _meeting(peak.crossing)
        if meeting[1] <= highest:
            others = [speeds[each.place] for each in column.peaks if each.place != peak.place]
            above.add(
                name,
                meeting,
                BESIDE_MEETING,
                LED_TO_MEETING,
                rivals=_upright_lines(top, others),
                fontsize=large(6),
                path_effects=outline,
            )
        place = (study["Omega"].values[peak.place], study["growth_rate"].values[peak.place])
        below.add(name, place, BESIDE_PEAK, fontsize=large(7), path_effects=outline)


def _upright_lines(ax: Axes, speeds: Sequence[float]) -> Array:
    """Points along the lines at the speeds of peaks, over the height of a panel."""
    heights = np.linspace(*ax.get_ylim(), UPRIGHT)
    across, up = np.meshgrid(speeds, heights)
    return np.column_stack([across.ravel(), up.ravel()])


def _along_lines(lines: Sequence[Sequence[Array]]) -> Array:
    """Points that no name covers, along lines of given points, and closer than these; shape
    (n, 2)."""
    share = np.linspace(0, 1, BETWEEN)[:, None]
    points = []
    for line in lines:
        given = np.column_stack(line)
        steps = given[:-1] + share[..., None] * np.diff(given, axis=0)
        points.append(steps.reshape(-1, 2))
    return np.concatenate(points)


def _multiple(crossing: xr.Dataset) -> str:
    """The multiple of a frequency that a mode meets."""
    return f"{float(crossing['crossing_multiple']):g} {_symbol(crossing)}"


def _symbol(crossing: xr.Dataset) -> str:
    """The symbol of the frequency of which a mode meets a multiple."""
    by_slips = flag_names(crossing["crossing_line"]) == "stick_slip"
    return SYMBOLS[0 if by_slips else 1]


# ---- Selection


def growing_modes(study: xr.Dataset) -> xr.DataArray:
    """Modes of steady sliding that grow, at each speed; none where a study does not know it."""
    frequency = study["sliding_frequency"]
    if "sliding_growth_rate" not in study:
        return xr.zeros_like(frequency, dtype=bool)
    return (study["sliding_growth_rate"] > ROUNDING).transpose(*frequency.dims)


def followed_rates(study: xr.Dataset) -> Array:
    """Growth rates over the speed, nan also where the motion is not near the cycle."""
    return np.where(_elsewhere(study), np.nan, study["growth_rate"].values)


def _elsewhere(study: xr.Dataset) -> Mask:
    """Speeds at which the motion is not near the cycle."""
    away = np.zeros(study["growth_rate"].shape, dtype=bool)
    for mask in doubts(study, "growth_rate").values():
        away |= mask.values
    return away


def peaks(study: xr.Dataset) -> Iterator[Peak]:
    """The `MOST` highest peaks of the cycle's growth rate from `LINEAR` on, with the nearest
    crossing, of the leading mode if possible; without ends of lines, beyond which the rate may rise, and
    points by themselves beside gaps, which are of another cycle."""
    speeds = study["Omega"].values
    followed = followed_rates(study)
    alone = unjoined(followed)
    rate = _without_lone_points(followed)
    extent = np.ptp(speeds)
    beside = np.abs(speeds - speeds[:, None]) <= NEAR * extent
    highest = np.where(beside, rate, -np.inf).max(axis=1)
    largest = (rate >= LINEAR) & (rate == highest)
    tops = np.flatnonzero(largest & _above_neighbours(followed))
    for i in sorted(tops, key=lambda i: -rate[i])[:MOST]:
        leading = int(np.nanargmax(study["cycle_growth_rate"].values[i]))
        apart = np.abs(study["crossing_Omega"].values - speeds[i])
        # crossings of other modes come after those of the leading one
        other = np.where(study["crossing_mode"] == study["mode"][leading], 0.0, extent)
        distance = np.where(apart <= NEAR * extent, apart + other, np.inf)
        crossing = None
        if np.isfinite(distance).any():
            crossing = study.isel(crossing=int(distance.argmin()))
        yield Peak(int(i), crossing, bool(alone[i]))


def _above_neighbours(rate: Array) -> Mask:
    """Points whose growth rate is higher than those of both neighbours; none beside a gap or at an end
    of the range."""
    extended = np.concatenate([[np.nan], rate, [np.nan]])
    before = extended[:-2]
    after = extended[2:]
    return (rate > before) & (rate > after)


def _without_lone_points(rate: Array) -> Array:
    """Growth rates, minus infinity where there is none and at lone points beside gaps."""
    rate = rate.copy()
    for first, after in stretches(unjoined(rate)):
        around = [max(first - 1, 0), min(after, rate.size - 1)]
        if np.isnan(rate[around]).any():
            rate[first:after] = np.nan
    return np.nan_to_num(rate, nan=-np.inf)


def unjoined(rate: Array) -> Mask:
    """Points whose growth rate differs by more than `LINEAR` from those of both neighbours."""
    joined = np.concatenate([[False], np.abs(np.diff(rate)) <= LINEAR, [False]])
    return np.isfinite(rate) & ~(joined[:-1] | joined[1:])
