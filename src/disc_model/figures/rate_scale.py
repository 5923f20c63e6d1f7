"""The scale of growth rates, which have both signs and peaks of tens beside hundredths, and those of
other heights.
"""

import numpy as np
import xarray as xr

from disc_model.errors import require
from disc_model.figures.colours import (
    ROUNDING,
    decades_through_zero,
    is_growth,
    linear_to,
    needs_zero,
)
from disc_model.figures.drawing import GREY, is_in_data, plain_decades, wide
from disc_model.figures.selection import OF_CYCLES
from disc_model.figures.types import Array, Axes, Mask

LINEAR = 0.1
"""Growth rate up to which its scale is linear, 1/s; a greater step from there finds another cycle."""
SMALL = 3 * LINEAR
"""Greatest rate of a panel whose scale is linear, 1/s: beyond the linear part, too little is left for numbers."""
STEP = np.arcsinh(1.0)
"""Step on such a scale, asinh(rate / LINEAR), beyond which the line is broken: a factor of 2.4 between
large rates."""
EVEN = 1.5
"""Ratio of neighbouring steps up to which a curve of rates goes on evenly, as one through zero may do in
wide steps."""
ALIKE = 2.0
"""Ratio of rates of one sign up to which zero is not drawn: most of the panel would be empty."""
ANOTHER_CYCLE = "another cycle, or too wide a step"
OPEN = f"line open: {ANOTHER_CYCLE}"
"""What such a break may be: finer steps show which, as the rate of one cycle is steep beside its end."""
ANOTHER_BORDER = "line open: another border"
"""Said of steps between critical values that lie on different borders of stability."""
ANOTHER_RANGE = "line open: another range of separation"
"""Said of steps between critical speeds at which different ranges of separation begin."""
RATE = "growth_rate"
"""Growth rate of a motion, with narrow peaks of tens beside hundredths."""


def are_rates(array: xr.DataArray, log: bool) -> bool:
    """Whether a variable is drawn on the scale of growth rates, which has both signs."""
    return array.name == RATE and (not log or needs_zero(array.values))


def without_rounding(array: xr.DataArray) -> xr.DataArray:
    """A variable with zero for growth rates that are zero but for rounding, as maps show them."""
    if not is_growth(array.name):
        return array
    return array.where(~(np.abs(array) <= ROUNDING), 0.0)


def are_of_cycles(array: xr.DataArray, rates: xr.DataArray) -> bool:
    """Whether a variable is that of cycles, of which the next point may have another, and these are
    their growth rates; steady sliding is one equilibrium."""
    alike = rates.name == RATE and rates.dims == array.dims
    return alike and array.name in OF_CYCLES and "sliding" not in rates.attrs.get("long_name", "")


def scale_heights(ax: Axes, array: xr.DataArray, log: bool) -> None:
    """Scale the vertical axis: as growth rates have it, or logarithmic, through zero if some values
    of the lines on the axes are not positive."""
    heights = _heights_on(ax)
    if are_rates(array, log):
        scale_rates(ax)
    elif log and needs_zero(heights):
        linear = linear_to(heights)
        ax.set_yscale("symlog", linthresh=linear, subs=range(2, 10))
        # numbers below the linear part's end would cover that of zero
        ends = (float(np.nanmin(heights)), float(np.nanmax(heights)))
        ticks = decades_through_zero(linear, *ends)
        if len(ticks) < 3:
            ticks = _steps_through_zero(linear, *ends) or ticks
        ax.set_yticks(ticks)
        ax.yaxis.set_major_formatter("{x:g}")
        if (heights > 0).any():
            ax.axhline(0, color=GREY, linewidth=wide(0.6), zorder=0)
    elif log:
        ax.set_yscale("log")
        plain_decades(ax.yaxis)


def _steps_through_zero(linear: float, low: float, high: float) -> list[float]:
    """Ticks between two numbers of one decade, zero among them: beyond where the scale is linear, one,
    two and five times powers of ten."""
    powers = 10.0 ** np.arange(np.floor(np.log10(linear)), np.log10(max(-low, high, linear)) + 1)
    sizes = np.outer(powers, [1, 2, 5]).ravel()
    sizes = sizes[sizes >= linear]
    ticks = [*(-sizes[::-1]), 0.0, *sizes]
    shown = [float(tick) for tick in ticks if low <= tick <= high]
    return shown if len(shown) > 1 else []


def _heights_on(ax: Axes) -> Array:
    """Heights of all points of lines on axes."""
    found = [np.zeros(0)]
    for line in ax.lines:
        if is_in_data(ax, line):
            found.append(np.asarray(line.get_ydata(), dtype=float))
    return np.concatenate(found)


def on_scale(rates: Array) -> Array:
    """Heights of growth rates on their scale."""
    return np.arcsinh(rates / LINEAR)


def opens(rates: Array) -> Mask:
    """Where a line of growth rates of cycles is open, one fewer than the rates: at steps beyond `STEP`,
    unless those beside them are alike, and at such as go back further than the rate has come on
    either side, as between two cycles of small rates."""
    steps = np.diff(on_scale(rates))
    found = (np.abs(steps) > STEP) & ~_goes_on_evenly(rates)
    before = steps[:-2]
    step = steps[1:-1]
    after = steps[2:]
    goes_back = (step * before < 0) & (step * after < 0)
    found[1:-1] |= goes_back & (np.abs(step) > np.maximum(np.abs(before), np.abs(after)))
    return found


def _goes_on_evenly(rates: Array) -> Mask:
    """Steps of rates that both neighbouring ones are like, in size and direction; the only one, at an end
    of a line."""
    steps = np.diff(rates)
    beside = np.concatenate([[np.nan], steps, [np.nan]])
    before = beside[:-2]
    after = beside[2:]
    known = np.isfinite(before) | np.isfinite(after)
    return known & _is_like(steps, before) & _is_like(steps, after)


def _is_like(steps: Array, others: Array) -> Mask:
    """Whether steps and others have one direction and nearly one size, or there is no other."""
    sizes = np.abs([steps, others])
    alike = (steps * others > 0) & (sizes.max(axis=0) <= EVEN * sizes.min(axis=0))
    return alike | np.isnan(others)


def set_limits(ax: Axes, limits: tuple[float, float]) -> None:
    """End a vertical axis where a reader wants it to; that of growth rates is linear within a decade,
    where its usual scale may have no number."""
    above = "must lie above 0 on a logarithmic axis"
    require((ax.get_yscale() != "log" or limits[0] > 0, "limits", limits, above))
    low, high = sorted(map(abs, limits))
    within = limits[0] * limits[1] > 0 and high < 10 * low
    if ax.get_yscale() == "symlog" and (within or high <= SMALL):
        ax.set_yscale("linear")
    ax.set_ylim(limits)


def scale_rates(ax: Axes) -> None:
    """Scale an axis of growth rates, as peaks of tens occur beside hundredths, and mark zero. Where
    all rates drawn are small, the scale is linear; also where they are of one sign and within a factor
    of `ALIKE`, and zero is not drawn."""

    def between(rate: float, _: float) -> str:
        """The outermost ticks, and within about a decade labels of some between them, so that nobody reads
        the scale as linear."""
        leading = f"{rate:e}".lstrip("-")[0]
        near = max(map(abs, ax.get_ylim())) < 20 * LINEAR
        is_said = (leading in "25" and near) or _is_outermost(rate, ax.get_ylim())
        return f"{rate:g}".replace("-", "−") if is_said else ""

    if not np.isfinite(ax.dataLim.intervaly).all():  # no rate drawn is finite
        ax.update_datalim([(0, -LINEAR), (0, LINEAR)], updatex=False)
    low, high = ax.dataLim.intervaly
    least, greatest = sorted((abs(low), abs(high)))
    if low * high > 0 and least < greatest < ALIKE * least:
        return
    if greatest > SMALL:
        ax.set_yscale("symlog", linthresh=LINEAR, subs=range(2, 10))
        ax.yaxis.set_major_formatter("{x:g}")
        ax.yaxis.set_minor_formatter(between)
    ax.axhline(0, color=GREY, linewidth=wide(0.6), zorder=0)


def _is_outermost(rate: float, limits: tuple[float, float]) -> bool:
    """Whether no tick of the sign of a rate, which is a tick, lies between it and the limits of its scale."""
    end = max(limits) if rate > 0 else -min(limits)
    size = abs(rate)
    step = 10.0 ** np.floor(np.log10(size * (1 + ROUNDING)))
    return size <= end < size + step * (1 - ROUNDING)
