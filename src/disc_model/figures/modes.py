"""Modes over a parameter: those of steady sliding, and Campbell diagrams."""

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataArray, Dataset

from disc_model.figures.draw import (
    LINEAR_RATE,
    NOTE,
    PAGE,
    lines,
    mark_missing,
    mark_points,
    one_line,
    panels,
    rate_axis,
    strip,
    threshold,
)
from disc_model.figures.looks import BLACK, GREY, RED, Options
from disc_model.figures.schema import grid_figure
from disc_model.figures.shown import label
from disc_model.units import Positive, Unit

# ---- Modes of steady sliding

ROUNDING = 1e-9  # growth rate up to which a mode does not grow, 1/s
IN_PLANE = -1  # in place of nodal diameters: the slider
AT_ZERO = -2  # growth at 0 Hz
BESIDE = 0.05  # share of a panel's width within which a peak is near
NAMES_APART = 0.04  # share of a panel's height within which modes share a name
LINEAR_GROWTH = 0.5  # growth rate up to which the axis of modes is linear at least, 1/s
Frequency = Annotated[Positive | None, Unit("Hz")]


@grid_figure("sliding_modes")
def sliding_modes(study: Dataset, highest: Frequency = None) -> Figure:
    """Frequencies and growth rates of the modes of steady sliding along a parameter.

    highest : upper end of the axis of frequencies, Hz
    """
    figure, axes = panels([["frequency"], ["rate"]], PAGE, 2.6, sharex=True)
    modes = study[["frequency", "mode_growth_rate", "diameters"]]
    modes = modes.rename(mode_growth_rate="rate", value="x")
    largest = study["largest_growth_rate"].rename(value="x")
    if study["n_modes"] <= study.sizes["mode"]:  # else it may be that of a mode without room
        rest = largest.where(largest > modes["rate"].max("mode").clip(0) + ROUNDING)
        at_zero = Dataset({"frequency": 0 * rest, "rate": rest, "diameters": AT_ZERO})
        modes = xr.concat([modes, at_zero.assign_coords(mode=0)], "mode")
    _frequencies(axes["frequency"], modes, highest)
    below = axes["rate"]
    _modes(below, modes, "rate")
    fastest = float(largest.max())
    rate_axis(below, max(LINEAR_GROWTH, fastest))
    growing = modes.where(modes["rate"] > ROUNDING)
    if growing["rate"].notnull().any():
        end = 1.25 * fastest
        below.set_ylim(max(-end, below.get_ylim()[0]), end)
        faster = modes["x"][(modes["rate"] < -end).any("mode").values]
        mark_missing(below, faster[:: faster.size // 12 + 1], "modes that decay faster", GREY, "v")
        _name_humps(below, growing)
    _name_ends(below, modes.where(abs(modes["rate"]) > ROUNDING), "rate")
    below.set_xlabel(label(modes["x"]))
    return figure


def _frequencies(ax: Axes, modes: Dataset, highest: float | None) -> None:
    """Frequencies of modes up to the highest shown, with their names."""
    _modes(ax, modes, "frequency")
    ax.set_ylim(0, highest)
    _name_ends(ax, modes, "frequency")


def _modes(ax: Axes, modes: Dataset, name: str) -> None:
    """Lines of modes, as long as their nodal diameters stay, and thick where they grow.

    modes : `frequency`, `rate` and `diameters` of each, shape (x, mode)
    """
    y = modes[name].transpose("mode", "x")
    for number in np.unique(modes["diameters"]):
        part = y.where(modes["diameters"] == number)
        _joined(ax, part, "mode", color=BLACK, lw=0.8)
        _joined(ax, part.where(modes["rate"] > ROUNDING), "mode that grows", color=RED, lw=2.4)
    ax.margins(x=0.1)  # room for names
    ax.set_ylabel(label(y))


def _joined(ax: Axes, y: DataArray, name: str, lw: float, **look: Any) -> None:
    """Modes as one line, open between them, with dots at points that have none beside."""
    x, heights = one_line(y["x"], y)
    known = np.isfinite(heights)
    alone = np.flatnonzero(known & ~np.roll(known, 1) & ~np.roll(known, -1))
    if known.any():
        ax.plot(x, heights, ".-", lw=lw, ms=lw, mew=0, markevery=alone, label=name, **look)


def _name_ends(ax: Axes, modes: Dataset, name: str) -> None:
    """Names of modes at both ends of their lines, in a panel whose limits are set; one for those near
    each other."""
    to_panel = ax.transData + ax.transAxes.inverted()
    for i, side, shift in ((0, "right", -3), (-1, "left", 3)):
        end = modes.isel(x=i).dropna("mode", subset=[name]).sortby(name)
        x = end["x"].item()
        places = np.column_stack(np.broadcast_arrays(x, end[name]))
        heights = to_panel.transform(places)[:, 1]
        steps = np.flatnonzero(np.diff(heights) > NAMES_APART) + 1
        for group in filter(len, np.split(np.arange(heights.size), steps)):
            at: Options = {
                "xycoords": ("data", "axes fraction"),
                "annotation_clip": True,
                "va": "center",
            }
            text = name_of(end["diameters"].values[group])
            ax.annotate(text, (x, heights[group].mean()), (shift, 0), ha=side, **at, **NOTE)


def _name_humps(ax: Axes, growing: Dataset) -> None:
    """Names of growing modes at the peaks of parts of their lines that reach no end, on the left of a
    near peak; divergence is named by its frequency, 0 Hz."""
    numbers = growing["diameters"].where(growing["frequency"] > 0, AT_ZERO)
    peaks = {}
    for number in np.unique(numbers.where(growing["rate"].notnull()).dropna("mode", how="all")):
        rate = growing["rate"].where(numbers == number).max("mode").values
        for part in np.ma.clump_unmasked(np.ma.masked_invalid(rate)):
            if part.start > 0 and part.stop < rate.size:
                peaks[part.start + int(rate[part].argmax())] = name_of([number])
    for place, name in peaks.items():
        near = any(0 < other - place < BESIDE * growing.sizes["x"] for other in peaks)
        at = growing["x"][place], growing["rate"][place].max()
        ax.annotate(name, at, (0, 3), ha="right" if near else "center", **NOTE)


def name_of(numbers: Any) -> str:
    """Name of modes by their nodal diameters, `IN_PLANE` or `AT_ZERO`."""
    if AT_ZERO in numbers:
        return "0 Hz"
    of_disc = ", ".join(f"{number:g}" for number in np.unique(numbers) if number >= 0)
    names = ["in plane"] * (IN_PLANE in numbers) + [f"l = {of_disc}"] * bool(of_disc)
    return "\n".join(names)


# ---- Campbell diagrams

NEAR = 0.01  # share of the speeds shown within which a crossing belongs to a peak
PROMINENT = 0.2  # least fall from a peak on both sides, of asinh(10 growth rate)
JOINED = 0.75  # greatest step of asinh(10 growth rate) along one cycle


@grid_figure("campbell")
def campbell(
    study: Dataset, highest: Frequency = None, multiples: tuple[Positive, ...] = ()
) -> Figure:
    """Frequencies of steady sliding and growth rates of the stick-slip cycle against the speed, and
    the multiples of the stick-slip frequency that meet modes at peaks of growth.

    highest : upper end of the axis of frequencies, Hz
    multiples : of the stick-slip frequency, that are drawn over all speeds
    """
    figure, axes = panels([["frequency"], ["rate"]], PAGE, 2.4, sharex=True, height_ratios=[3, 2])
    if "Omega" not in study.dims:
        study = study.expand_dims("Omega")
    draw_campbell([*axes.values()], study, highest, multiples)
    return figure


def draw_campbell(
    axes: Sequence[Axes],
    data: Dataset,
    highest: float | None = None,
    multiples: Sequence[float] = (),
) -> None:
    """Draw frequencies above growth rates, on two axes, from a study along the speed alone."""
    above, below = axes
    numbers = data["diameters"].where(data["mode_kind"] == "disc", IN_PLANE)
    modes = data.rename(sliding_frequency="frequency", sliding_growth_rate="rate", Omega="x")
    modes = modes[["frequency", "rate"]].assign(diameters=numbers.rename(Omega="x"))
    _frequencies(above, modes, highest)
    speeds, rate = data["Omega"], data["growth_rate"]
    far = rate.notnull() & (data.get("near_motion", 1) == 0)
    why = "the motion is not near this cycle"
    look: Options = {"color": BLACK, "marker": "o", "ms": 1.8, "lw": 0.8, "missing": ""}
    lines(below, rate, "Omega", doubtful=far, doubt=why, jump=JOINED, **look)
    rate_axis(below)
    strip(below, data["status"].where(rate.isnull(), ""))
    slips = data["stick_slip_frequency"].where(~far)
    for multiple in multiples:
        above.plot(speeds, multiple * slips, "--", lw=0.8, label=f"{multiple:g} $f_s$")
    near = {i: _crossing_at(data, i) for i in _peaks(rate.where(~far))}
    meetings = {i: at for i, at in near.items() if at is not None}
    count = int((data["crossing_line"] == "stick_slip").sum())
    name = f"at a peak of growth: {len(meetings)} of {count} crossings"
    places = {}
    for i, at in meetings.items():
        drawn = at["crossing_Omega"], at["crossing_frequency"]
        mark_points(above, *drawn, name, color=BLACK, marker="D")
        multiple = at["crossing_multiple"].item()
        line = multiple * slips
        above.plot(speeds, line, "--", color=GREY, lw=0.8, label="multiple of $f_s$")
        mode = numbers[i].sel(mode=at["crossing_mode"]).item()
        places[f"{multiple:g} $f_s$: {name_of([mode])}"] = speeds[i].item()
    threshold(above, places, [below])


def _peaks(rate: DataArray) -> Any:
    """Places of the peaks of a growth rate above 0.1/s, which falls on both sides of each; there is
    none beside a speed without a rate."""
    from scipy.signal import find_peaks

    heights = np.arcsinh(rate / LINEAR_RATE)
    return find_peaks(heights, height=np.arcsinh(1), prominence=PROMINENT)[0]


def _crossing_at(data: Dataset, place: int) -> Dataset | None:
    """The crossing of a multiple of the stick-slip frequency that is nearest to a peak, of the
    leading mode if possible; None if none is near."""
    speeds = data["Omega"].values
    leading = data["mode"][int(data["cycle_growth_rate"][place].argmax("mode"))]
    apart = abs(data["crossing_Omega"] - speeds[place]) / np.ptp(speeds)
    order = apart + (data["crossing_mode"] != leading)
    order = order.where((apart <= NEAR) & (data["crossing_line"] == "stick_slip"))
    if order.isnull().all():
        return None
    return data.isel(crossing=int(order.argmin("crossing")))
