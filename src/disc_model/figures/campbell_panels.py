"""The two panels of a Campbell diagram: frequencies above growth rates."""

from collections.abc import Sequence

import numpy as np

from disc_model.figures.campbell_bands import draw_bands
from disc_model.figures.campbell_looks import dot_look, elsewhere_look
from disc_model.figures.campbell_meetings import draw_peak
from disc_model.figures.campbell_modes import draw_modes
from disc_model.figures.campbell_multiples import draw_multiples
from disc_model.figures.campbell_peaks import Column, elsewhere_of, followed_rates, unjoined
from disc_model.figures.cut import mark_cut, modes_above
from disc_model.figures.drawing import BLACK, mark, whole_marks, wide
from disc_model.figures.rate_scale import LINEAR, opens, scale_rates
from disc_model.figures.selection import opened
from disc_model.figures.types import Array, Axes
from disc_model.figures.words import label_of

FREQUENCY = "Frequency in the slider's frame (Hz)"
RATE = "Largest growth rate\nof the cycle (1/s)"
HEIGHT = 5.4  # inch, of a figure whose pairs of panels stand beside each other, with its legend
ROOM = 3.0  # ends of the axis of growth rates over the largest ones, for names of peaks
ROOM_LINEAR = 1.3  # and on a linear scale


def draw_panels(
    above: Sequence[Axes],
    below: Sequence[Axes],
    columns: Sequence[Column],
    highest: float,
    multiples: Sequence[float] = (),
) -> None:
    """Draw frequencies up to the highest shown (Hz), with multiples of the stick-slip frequency that
    are asked for, and growth rates below them, on one scale."""
    for top, bottom, column in zip(above, below, columns, strict=True):
        _draw_column(top, bottom, column, highest)
        draw_multiples(top, column, multiples, highest)
    _scale_alike(below)
    rates = [column.study["growth_rate"].values for column in columns]
    low = min(float(np.fmin.reduce(rate, initial=0.0)) for rate in rates)
    high = max(float(np.fmax.reduce(rate, initial=0.0)) for rate in rates)
    for ax in above:
        ax.set_ylim(0, highest)
    for ax in below:
        _limit_rates(ax, low, high)
    _label_rows(above, FREQUENCY)
    _label_rows(below, RATE)
    for ax in (*above, *below):
        whole_marks(ax)


def _label_rows(axes: Sequence[Axes], label: str) -> None:
    """Label the vertical axes of panels, but those beside a labelled one that they share."""
    for ax in axes:
        alike = ax.get_shared_y_axes().get_siblings(ax)
        if not any(other.get_ylabel() and _are_beside(ax, other) for other in alike):
            ax.set_ylabel(label)


def _are_beside(ax: Axes, other: Axes) -> bool:
    """Whether axes stand at one height of a figure."""
    height = ax.get_position(original=True).y0
    return bool(np.isclose(height, other.get_position(original=True).y0))


def _scale_alike(axes: Sequence[Axes]) -> None:
    """Give panels of growth rates one scale, as the rates of all of them need it."""
    ends = np.concatenate([ax.dataLim.intervaly for ax in axes])
    ends = ends[np.isfinite(ends)]
    for ax in axes:
        if ends.size:
            ax.update_datalim([(0, ends.min()), (0, ends.max())], updatex=False)
        scale_rates(ax)


def _limit_rates(ax: Axes, low: float, high: float) -> None:
    """End the axis of growth rates beyond the lowest and highest, by as much as its scale needs."""
    room = ROOM_LINEAR if ax.get_yscale() == "linear" else ROOM
    ax.set_ylim(min(room * low, -LINEAR), max(room * high, LINEAR))


def _draw_column(top: Axes, bottom: Axes, column: Column, highest: float) -> None:
    """Draw the frequencies of one model up to the highest shown (Hz), and its growth rates
    below."""
    study = column.study
    speeds = study["Omega"].values
    rate = study["growth_rate"].values
    elsewhere = elsewhere_of(study)
    draw_modes(top, study, highest)
    _draw_rates(bottom, speeds, followed_rates(study))
    bottom.plot(speeds[elsewhere], rate[elsewhere], **elsewhere_look())
    for peak in column.peaks:
        draw_peak(top, bottom, study, peak, highest)
    if modes_above(study["sliding_frequency"], highest):
        mark_cut(top, highest)
    draw_bands(top, bottom, study)
    for ax in (top, bottom):
        ax.set_xlim(speeds[0], speeds[-1])
    bottom.set_xlabel(label_of(study["Omega"])[0])
    bottom.tick_params(labelbottom=True)  # which a shared axis leaves to the lowest row


def _draw_rates(ax: Axes, speeds: Array, rate: Array) -> None:
    """Draw growth rates: a line where neighbours belong together, and hollow dots elsewhere."""
    alone = unjoined(rate)
    ax.plot(*opened(speeds, rate, opens(rate)), "-", color=BLACK, linewidth=wide(0.8))
    joined = dot_look(alone=False)
    joined["markersize"] = mark(1.0)
    ax.plot(speeds[~alone], rate[~alone], **joined)
    ax.plot(speeds[alone], rate[alone], **dot_look(alone=True))
