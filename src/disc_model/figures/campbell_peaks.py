"""Peaks of growth rates in a Campbell diagram, and the crossings at them."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.frequency_jumps import frequency_jumps
from disc_model.figures.campbell_crossings import meeting_of, places_of
from disc_model.figures.growth import ROUNDING
from disc_model.figures.rate_scale import LINEAR, on_scale, opens
from disc_model.figures.selection import stretches
from disc_model.figures.types import Array, Mask

MOST = 5  # number of peaks that are named at most
NEAR = 0.01  # share of the speeds shown within which peaks are one, and crossings belong to a peak
PROMINENT = 0.02  # of the height of the panel of rates, from which a peak stands out from ripples


class Peak(NamedTuple):
    """A peak of the cycle's growth rate: the place of its speed, the crossing at it, if any, and whether
    the line of growth rates is open beside it, so that the steps do not resolve it."""

    place: int
    crossing: xr.Dataset | None
    is_open: bool = False


class Column(NamedTuple):
    """A study of one model, which has a column of panels, and the peaks of its growth rate."""

    study: xr.Dataset
    peaks: Sequence[Peak]


def marked_at_peaks(column: Column) -> Mask:
    """Crossings of a column's study at which a peak lies."""
    places = places_of(column.study)
    marked = np.zeros(len(places), dtype=bool)
    for peak in column.peaks:
        if peak.crossing is not None:
            marked |= np.all(places == meeting_of(peak.crossing), axis=1)
    return marked


def growing_modes(study: xr.Dataset) -> xr.DataArray:
    """Modes of steady sliding that grow, at each speed; none where a study does not know it."""
    frequency = study["sliding_frequency"]
    if "sliding_growth_rate" not in study:
        return xr.zeros_like(frequency, dtype=bool)
    return (study["sliding_growth_rate"] > ROUNDING).transpose(*frequency.dims)


def followed_rates(study: xr.Dataset) -> Array:
    """Growth rates over the speed, nan also where the motion is not near the cycle."""
    return np.where(elsewhere_of(study), np.nan, study["growth_rate"].values)


def elsewhere_of(study: xr.Dataset) -> Mask:
    """Speeds at which the motion is not near the cycle."""
    if "near_motion" not in study:
        return np.zeros(study["growth_rate"].shape, dtype=bool)
    return np.asarray(study["near_motion"] == 0)


def followed_frequency(study: xr.Dataset) -> xr.DataArray:
    """The stick-slip frequency as crossings have it, nan at speeds without a cycle near the motion, Hz."""
    near = ~elsewhere_of(study)
    return study["stick_slip_frequency"].where(near)


def jumps_of(study: xr.Dataset) -> Mask:
    """The steps of the speed over which this frequency jumps."""
    return frequency_jumps(study["Omega"].values, followed_frequency(study).values)


def peaks(study: xr.Dataset) -> Iterator[Peak]:
    """The `MOST` highest peaks of the cycle's growth rate from `LINEAR` on, with the nearest
    crossing, of the leading mode if possible: also rises that end beside speeds without a cycle. Ripples
    are none, nor ends of the scan, beyond which the rate may rise, nor points by themselves beside gaps,
    which are of another cycle."""
    speeds = study["Omega"].values
    followed = followed_rates(study)
    is_open = beside_open_step(followed)
    rate = _without_lone_points(followed)
    extent = np.ptp(speeds)
    beside = np.abs(speeds - speeds[:, None]) <= NEAR * extent
    highest = np.where(beside, rate, -np.inf).max(axis=1)
    largest = (rate >= LINEAR) & (rate == highest)
    tops = np.flatnonzero(largest & (_above_neighbours(followed) | _beside_gaps(study)))
    stand_out = [i for i in tops.tolist() if _stands_out(rate, i)]
    for i in sorted(stand_out, key=lambda i: -rate[i])[:MOST]:
        leading = int(np.nanargmax(study["cycle_growth_rate"].values[i]))
        apart = np.abs(study["crossing_Omega"].values - speeds[i])
        # crossings of other modes come after those of the leading one
        other = np.where(study["crossing_mode"] == study["mode"][leading], 0.0, extent)
        distance = np.where(apart <= NEAR * extent, apart + other, np.inf)
        crossing = None
        if np.isfinite(distance).any():
            crossing = study.isel(crossing=int(distance.argmin()))
        yield Peak(int(i), crossing, bool(is_open[i]))


def _above_neighbours(rate: Array) -> Mask:
    """Points whose growth rate is higher than those of both neighbours; none beside a gap or at an end
    of the range."""
    extended = np.concatenate([[np.nan], rate, [np.nan]])
    before = extended[:-2]
    after = extended[2:]
    return (rate > before) & (rate > after)


def _beside_gaps(study: xr.Dataset) -> Mask:
    """Points whose growth rate is higher than that of a neighbour, while there is no cycle at the other:
    a cycle that the motion is not near is one."""
    rate = study["growth_rate"].values
    extended = np.concatenate([[np.inf], rate, [np.inf]])
    before = extended[:-2]
    after = extended[2:]
    return (np.isnan(before) & (rate > after)) | (np.isnan(after) & (rate > before))


def _stands_out(rate: Array, place: int) -> bool:
    """Whether the rate falls from a peak on both sides, before it is higher again, by more than ripples
    do: by a share of the heights shown. Minus infinity is a gap, over which it goes on."""
    heights = on_scale(rate)
    known = np.isfinite(heights)
    top = heights[place]
    shown = heights.max(initial=0.0) - heights[known].min(initial=0.0)
    before = heights[:place][known[:place]][::-1]
    after = heights[place + 1 :][known[place + 1 :]]
    return all(_fall(top, side) >= PROMINENT * shown for side in (before, after))


def _fall(top: float, side: Array) -> float:
    """By how much heights fall from a top, before they are higher again; zero without any."""
    higher = np.flatnonzero(side > top)
    if higher.size:
        side = side[: higher[0]]
    return float(top - side.min(initial=top))


def _without_lone_points(rate: Array) -> Array:
    """Growth rates, minus infinity where there is none and at lone points beside gaps."""
    rate = rate.copy()
    for first, after in stretches(unjoined(rate)):
        around = [max(first - 1, 0), min(after, rate.size - 1)]
        if np.isnan(rate[around]).any():
            rate[first:after] = np.nan
    return np.nan_to_num(rate, nan=-np.inf)


def unjoined(rate: Array) -> Mask:
    """Points that the line of growth rates joins to neither neighbour."""
    between = np.isfinite(rate[:-1]) & np.isfinite(rate[1:])
    joined = np.concatenate([[False], between & ~opens(rate), [False]])
    return np.isfinite(rate) & ~(joined[:-1] | joined[1:])


def beside_open_step(rate: Array) -> Mask:
    """Points beside which the line of growth rates is open, on one side or on both."""
    between = np.concatenate([[False], opens(rate), [False]])
    return between[:-1] | between[1:]
