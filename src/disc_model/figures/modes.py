"""Modes over a parameter: those of steady sliding, and Campbell diagrams."""

from collections.abc import Sequence
from itertools import cycle
from typing import Annotated, Any

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataArray, Dataset

from disc_model.figures.draw import (
    LINEAR_RATE,
    PAGE,
    lines,
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
AT_ZERO = -2  # modes at 0 Hz
DASHES = ("-", "--", "-.", ":")
NAMES = {IN_PLANE: "in plane", AT_ZERO: "0 Hz"}
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
    above, below = axes.values()
    _modes(above, modes, "frequency")
    above.set_ylim(0, highest)
    _modes(below, modes, "rate")
    rate_axis(below, max(LINEAR_GROWTH, float(largest.max())))
    below.set_xlabel(label(modes["x"]))
    return figure


def _modes(ax: Axes, modes: Dataset, name: str) -> None:
    """Lines of modes in the colours of their nodal diameters, over broad lines where they grow.

    modes : `frequency`, `rate` and `diameters` of each, shape (x, mode)
    """
    y = modes[name].transpose("mode", "x")
    _joined(ax, y.where(modes["rate"] > ROUNDING), "mode that grows", RED, lw=4.0, alpha=0.3)
    numbers = modes["diameters"].where(modes["frequency"] != 0, AT_ZERO)
    known = np.unique(numbers.where(modes["rate"].notnull()).values)
    known = known[np.isfinite(known)]
    colours = cm.batlow(np.linspace(0, 0.7, known.size))
    for number, colour, dashes in zip(known, colours, cycle(DASHES), strict=False):
        _joined(ax, y.where(numbers == number), name_of(number), colour, lw=1.0, ls=dashes)
    ax.set_ylabel(label(y))


def _joined(ax: Axes, y: DataArray, name: str, colour: Any, lw: float, **look: Any) -> None:
    """Modes as one line, open between them, with dots at points that have none beside."""
    x, heights = one_line(y["x"], y)
    known = np.isfinite(heights)
    alone = np.flatnonzero(known & ~np.roll(known, 1) & ~np.roll(known, -1))
    if known.any():
        own = {"color": colour, "label": name, "markevery": alone, "mew": 0}
        ax.plot(x, heights, marker=".", lw=lw, ms=2 * lw, **own, **look)


def name_of(number: float) -> str:
    """The name of modes by their nodal diameters, `IN_PLANE` or `AT_ZERO`."""
    return NAMES.get(int(number), f"l = {number:g}")


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
    _modes(above, modes, "frequency")
    above.set_ylim(0, highest)
    speeds = data["Omega"]
    rate = data["growth_rate"]
    far = rate.notnull() & (data.get("near_motion", 1) == 0)
    why = "the motion is not near this cycle"
    look: Options = {"color": BLACK, "marker": "o", "ms": 1.8, "missing": ""}
    lines(below, rate, "Omega", doubtful=far, doubt=why, jump=JOINED, **look)
    rate_axis(below)
    strip(below, data["status"].where(rate.isnull(), ""))
    slips = data["stick_slip_frequency"].where(~far)
    for multiple in multiples:
        above.plot(speeds, multiple * slips, "--", label=f"{multiple:g} $f_s$")
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
        above.plot(speeds, line, "--", color=GREY, label="multiple of $f_s$")
        mode = numbers[i].sel(mode=at["crossing_mode"]).item()
        places[f"{multiple:g} $f_s$: {name_of(mode)}"] = speeds[i].item()
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
