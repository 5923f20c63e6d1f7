"""Modes over a parameter: those of steady sliding, and Campbell diagrams."""

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import find_peaks

from disc_model.figures.draw import (
    LINEAR_RATE,
    PAGE,
    lines,
    mark_points,
    panels,
    rate_axis,
    strip,
    threshold,
)
from disc_model.figures.looks import BLACK, GREY, RED
from disc_model.figures.schema import grid_figure
from disc_model.figures.shown import label
from disc_model.units import Positive, Unit

# ---- Modes of steady sliding

ROUNDING = 1e-9  # growth rate up to which a mode does not grow, 1/s
IN_PLANE, AT_ZERO = -1, -2  # in place of nodal diameters: the slider, and growth at 0 Hz
NAMES_APART = 0.05  # share of a panel's height within which modes share a name
ROOM = 1.06  # end of an axis over the highest frequency
LINEAR_GROWTH = 0.5  # growth rate up to which the axis of modes is linear at least, 1/s
Frequency = Annotated[Positive | None, Unit("Hz")]


@grid_figure("sliding")
def sliding_modes(study: xr.Dataset, highest: Frequency = None) -> Figure:
    """Frequencies and growth rates of the modes of steady sliding along a parameter.

    highest : upper end of the axis of frequencies, Hz
    """
    figure, axes = panels([["frequency"], ["rate"]], PAGE, 2.6, sharex=True)
    draw_sliding_modes([*axes.values()], study, highest)
    return figure


def draw_sliding_modes(
    axes: Sequence[Axes], data: xr.Dataset, highest: float | None = None
) -> None:
    """Draw frequencies above growth rates, on two axes, from a study at one point."""
    above, below = axes
    modes = data[["frequency", "mode_growth_rate", "diameters"]]
    modes = modes.rename(mode_growth_rate="rate")
    largest = data["largest_growth_rate"]
    if data["n_modes"] <= data.sizes["mode"]:  # else it may be that of a mode without room
        rest = largest.where(largest > modes["rate"].max("mode").clip(0) + ROUNDING)
        at_zero = xr.Dataset({"frequency": 0 * rest, "rate": rest, "diameters": AT_ZERO})
        modes = xr.concat([modes, at_zero.assign_coords(mode=0)], "mode")
    _frequencies(above, modes, highest)
    _lines_of_modes(below, modes, "rate")
    rate_axis(below, max(LINEAR_GROWTH, float(largest.max())))
    _name_ends(below, modes.where(abs(modes["rate"]) > ROUNDING), "rate")
    below.set(xlabel=label(data["value"]), ylabel=label(data["mode_growth_rate"]))


def _frequencies(ax: Axes, modes: xr.Dataset, highest: float | None) -> None:
    """Frequencies of modes up to the highest shown, with their names, and how many have higher
    ones."""
    _lines_of_modes(ax, modes, "frequency")
    end = highest or ROOM * float(modes["frequency"].max().fillna(1.0))
    ax.set_ylim(0, end)
    _name_ends(ax, modes, "frequency")
    above = (modes["frequency"] > end).groupby("mode").any(...).sum().item()
    if above:
        ax.set_title(f"{above} modes have parts above {end:g} Hz")


def _lines_of_modes(ax: Axes, modes: xr.Dataset, name: str) -> None:
    """Lines of modes, as long as their nodal diameters stay, and thick where they grow.

    modes : `frequency`, `rate` and `diameters` of each, shape (x, mode)
    """
    y = modes[name].transpose(..., "mode")
    along = y[str(y.dims[0])]
    text = "mode of steady sliding"
    for number in np.unique(modes["diameters"]):
        part = y.where(modes["diameters"] == number)
        grows = part.where(modes["rate"] > ROUNDING)
        ax.plot(along, part, ".-", color=BLACK, lw=0.8, ms=0.8, mew=0, label=text)
        if grows.notnull().any():
            ax.plot(along, grows, ".-", color=RED, lw=2.4, ms=2.4, mew=0, label="growing mode")
    ax.set(xlim=along.values[[0, -1]], ylabel=label(y))


def _name_ends(ax: Axes, modes: xr.Dataset, name: str) -> None:
    """Names of modes at the right end of a panel whose limits are set; one for those near each
    other."""
    last = modes.transpose(..., "mode").isel({str(modes[name].dims[0]): -1})
    places = np.column_stack([np.full(last.sizes["mode"], ax.get_xlim()[1]), last[name]])
    heights = (ax.transData + ax.transAxes.inverted()).transform(places)[:, 1]
    inside = [i for i in np.argsort(heights) if 0 <= heights[i] <= 1]
    steps = np.flatnonzero(np.diff(heights[inside]) > NAMES_APART) + 1
    for group in np.split(inside, steps) if inside else ():
        place = (1.01, heights[group].mean())
        said = name_of(last["diameters"].values[group])
        ax.annotate(said, place, xycoords="axes fraction", va="center", fontsize=7)


def name_of(numbers: Any) -> str:
    """Name of modes by their nodal diameters, or `IN_PLANE`."""
    of_disc = ", ".join(f"{number:g}" for number in np.unique(numbers) if number >= 0)
    names = ["in plane"] * (IN_PLANE in numbers) + [f"l = {of_disc}"] * bool(of_disc)
    return ", ".join(names)


# ---- Campbell diagrams

NEAR = 0.01  # share of the speeds shown within which a crossing belongs to a peak
PROMINENT = 0.2  # least fall from a peak on both sides, of asinh(10 growth rate)
JOINED = 0.75  # greatest step of asinh(10 growth rate) along one cycle


@grid_figure("campbell", needs=["Omega"])
def campbell(
    study: xr.Dataset, highest: Frequency = None, multiples: tuple[Positive, ...] = ()
) -> Figure:
    """Frequencies of steady sliding and growth rates of the stick-slip cycle against the speed, and
    the multiples of the stick-slip frequency that meet modes at peaks of growth.

    highest : upper end of the axis of frequencies, Hz
    multiples : of the stick-slip frequency, that are drawn over all speeds
    """
    rows = [["frequency"], ["rate"]]
    figure, axes = panels(rows, PAGE, 2.4, sharex=True, height_ratios=[3, 2])
    draw_campbell([*axes.values()], study, highest, multiples)
    return figure


def draw_campbell(
    axes: Sequence[Axes],
    data: xr.Dataset,
    highest: float | None = None,
    multiples: Sequence[float] = (),
) -> None:
    """Draw frequencies above growth rates, on two axes, from a study along the speed alone."""
    above, below = axes
    numbers = data["diameters"].where(data["mode_kind"] == "disc", IN_PLANE)
    modes = data.rename(sliding_frequency="frequency", sliding_growth_rate="rate")
    modes = modes[["frequency", "rate"]].assign(diameters=numbers)
    _frequencies(above, modes, highest)
    rate = data["growth_rate"]
    far = rate.notnull() & (data.get("near_motion", 1) == 0)
    _growth(below, rate.where(~far), rate.where(far))
    strip(below, data["status"].where(rate.isnull(), ""))
    slips = data["stick_slip_frequency"].where(~far)
    for multiple in multiples:
        _multiple(above, slips, multiple, f"{multiple:g} $f_s$")
    places = {}
    for i in _peaks(rate.where(~far)):
        at = _crossing_at(data, i)
        if at is None:
            continue
        where = at["crossing_Omega"], at["crossing_frequency"]
        mark_points(above, *where, "crossing at a peak of growth", color=BLACK, marker="D")
        multiple = at["crossing_multiple"].item()
        _multiple(above, slips, multiple)
        mode = numbers[i].sel(mode=at["crossing_mode"]).item()
        places[f"{multiple:g} $f_s$: {name_of([mode])}"] = data["Omega"][i].item()
    threshold(above, places, [below])


def _growth(ax: Axes, near: xr.DataArray, far: xr.DataArray) -> None:
    """Growth rates of the cycle, hollow where its line joins a point to none, and crosses where the
    motion is far from it."""
    steps = np.abs(np.diff(np.arcsinh(near / LINEAR_RATE))) <= JOINED
    alone = near.notnull() & ~(np.append(False, steps) | np.append(steps, False))
    lines(
        ax,
        near,
        "Omega",
        doubtful=alone,
        doubt="another cycle, or too wide a step",
        missing="",
        jump=JOINED,
        color=BLACK,
        marker="o",
        ms=1.2,
        lw=0.8,
    )
    if far.notnull().any():
        name = "the motion is not near this cycle"
        ax.plot(far["Omega"], far, "x", color=BLACK, ms=3.5, mew=0.7, label=name)
    rate_axis(ax)


def _multiple(ax: Axes, slips: xr.DataArray, multiple: float, name: str = "") -> None:
    """A multiple of the stick-slip frequency over the speed, with its name at the left end."""
    line = multiple * slips
    dashes = (0, (4, 2))
    ax.plot(line["Omega"], line, ls=dashes, color=GREY, lw=0.8, label="multiple of $f_s$")
    start = line.dropna("Omega")[:1]
    box = {"fc": "white", "lw": 0, "pad": 0.3}
    for place in zip(start["Omega"], start, strict=True):
        ax.annotate(name, place, (2, 0), textcoords="offset points", va="center", bbox=box)


def _peaks(rate: xr.DataArray) -> list[int]:
    """Places of the peaks of a growth rate above 0.1/s, which falls on both sides of each; there is
    none beside a speed without a rate."""
    heights = np.arcsinh(rate.fillna(np.inf).clip(max=1e9) / LINEAR_RATE)
    places, _ = find_peaks(heights, height=np.arcsinh(1), prominence=PROMINENT)
    return [int(i) for i in places if np.isfinite(rate[i])]


def _crossing_at(data: xr.Dataset, place: int) -> xr.Dataset | None:
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
