"""The peaks of the growth rate in a Campbell diagram, and the crossings that they lie at."""

import xarray as xr

from disc_model.figures.campbell_crossings import is_of_slips, meeting_of
from disc_model.figures.campbell_looks import beyond_look, dot_look, multiple_look, speed_look
from disc_model.figures.campbell_multiples import draw_multiple
from disc_model.figures.campbell_peaks import Peak
from disc_model.figures.types import Axes

EDGE = 1.0  # height of a mark at this edge, as a share of the panel


def draw_peak(top: Axes, bottom: Axes, study: xr.Dataset, peak: Peak, highest: float) -> None:
    """Mark a peak of the growth rate, and the crossing of a mode with a multiple of a frequency, or at
    the upper edge that it lies above the highest frequency shown (Hz)."""
    speed = study["Omega"].values[peak.place]
    rate = study["growth_rate"].values[peak.place]
    for ax in (top, bottom):
        ax.axvline(speed, zorder=0, **speed_look())
    bottom.plot(speed, rate, **dot_look(peak.is_open, crossed=peak.crossing is not None))
    if peak.crossing is None:
        return
    place = meeting_of(peak.crossing)
    if place[1] > highest:
        edge = top.get_xaxis_transform()
        top.plot(place[0], EDGE, transform=edge, clip_on=False, **beyond_look())
        return

    multiple = float(peak.crossing["crossing_multiple"])
    if is_of_slips(peak.crossing):
        draw_multiple(top, study, multiple, zorder=0)
    else:
        turns = multiple * study["rotation_frequency"]
        top.plot(study["Omega"], turns, zorder=0, **multiple_look())
    top.plot(*place, **dot_look(peak.is_open))
