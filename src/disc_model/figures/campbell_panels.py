"""The two panels of a Campbell diagram: frequencies above growth rates."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_bands import draw_bands
from disc_model.figures.campbell_crossings import meeting_of
from disc_model.figures.campbell_looks import (
    beyond_look,
    dot_look,
    elsewhere_look,
    growing_look,
    multiple_look,
    speed_look,
)
from disc_model.figures.campbell_multiples import draw_multiples
from disc_model.figures.campbell_peaks import (
    Column,
    Peak,
    elsewhere_of,
    followed_rates,
    growing_modes,
    unjoined,
)
from disc_model.figures.cut import mark_cut, modes_above
from disc_model.figures.drawing import BLACK, large, mark, say_beside, whole_marks, wide
from disc_model.figures.names import named_modes
from disc_model.figures.rate_scale import LINEAR, scale_rates
from disc_model.figures.selection import broken
from disc_model.figures.types import Array, Axes
from disc_model.figures.words import SPEED

NAMES_APART = 0.045  # of the axis, least distance of the names of modes
FREQUENCY = "Frequency in the slider's frame (Hz)"
RATE = "Largest growth rate\nof the cycle (1/s)"
EDGE = 1.0  # height of a mark at this edge, as a share of the panel


def draw_panels(
    above: Sequence[Axes],
    below: Sequence[Axes],
    columns: Sequence[Column],
    highest: float,
    multiples: Sequence[int] = (),
) -> None:
    """Draw frequencies up to the highest shown (Hz), with multiples of the stick-slip frequency that
    are asked for, and growth rates below them, on one scale."""
    for top, bottom, column in zip(above, below, columns, strict=True):
        _draw_column(top, bottom, column, highest)
        draw_multiples(top, column.study, multiples, highest)
    rates = [column.study["growth_rate"].values for column in columns]
    low = min(float(np.fmin.reduce(rate, initial=0.0)) for rate in rates)
    high = max(float(np.fmax.reduce(rate, initial=0.0)) for rate in rates)
    above[0].set_ylim(0, highest)
    below[0].set_ylim(min(3 * low, -LINEAR), max(3 * high, LINEAR))
    above[0].set_ylabel(FREQUENCY)
    below[0].set_ylabel(RATE)
    for ax in (*above, *below):
        whole_marks(ax)


def _draw_column(top: Axes, bottom: Axes, column: Column, highest: float) -> None:
    """Draw the frequencies of one model up to the highest shown (Hz), and its growth rates
    below."""
    study = column.study
    speeds = study["Omega"].values
    rate = study["growth_rate"].values
    elsewhere = elsewhere_of(study)
    _draw_modes(top, study, highest)
    _draw_rates(bottom, speeds, followed_rates(study))
    bottom.plot(speeds[elsewhere], rate[elsewhere], **elsewhere_look())
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
        ax.plot(study["Omega"], thick, **growing_look())
    ends = study.isel(Omega=-1)
    of_disc = np.where(flag_names(ends["mode_kind"]) == "disc", ends["diameters"].values, -1)
    heights = ends["sliding_frequency"].where(ends["sliding_frequency"] <= highest).values
    for part in named_modes(of_disc, heights, NAMES_APART * highest):
        height = float(heights[part.modes].mean())
        say_beside(ax, height, part.name, 3, fontsize=large(7))


def _draw_rates(ax: Axes, speeds: Array, rate: Array) -> None:
    """Draw growth rates: a line where neighbours belong together, and hollow dots elsewhere."""
    alone = unjoined(rate)
    ax.plot(*broken(speeds, rate, LINEAR), "-", color=BLACK, linewidth=wide(0.8))
    joined = dot_look(alone=False)
    joined["markersize"] = mark(1.0)
    ax.plot(speeds[~alone], rate[~alone], **joined)
    ax.plot(speeds[alone], rate[alone], **dot_look(alone=True))


def _draw_peak(top: Axes, bottom: Axes, study: xr.Dataset, peak: Peak, highest: float) -> None:
    """Mark a peak of the growth rate, and the crossing of a mode with a multiple of a frequency, or at
    the upper edge that it lies above the highest frequency shown (Hz)."""
    speed = study["Omega"].values[peak.place]
    rate = study["growth_rate"].values[peak.place]
    for ax in (top, bottom):
        ax.axvline(speed, zorder=0, **speed_look())
    bottom.plot(speed, rate, **dot_look(peak.alone, crossed=peak.crossing is not None))
    if peak.crossing is None:
        return
    place = meeting_of(peak.crossing)
    if place[1] > highest:
        edge = top.get_xaxis_transform()
        top.plot(place[0], EDGE, transform=edge, clip_on=False, **beyond_look())
        return

    by_slips = flag_names(peak.crossing["crossing_line"]) == "stick_slip"
    line = study["stick_slip_frequency" if by_slips else "rotation_frequency"]
    multiple = float(peak.crossing["crossing_multiple"])
    top.plot(study["Omega"], multiple * line, zorder=0, **multiple_look())
    top.plot(*place, **dot_look(peak.alone))
