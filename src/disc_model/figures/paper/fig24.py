"""Figure 24 of the paper: the disc's vibration, with the four stretches that Figure 25 analyses."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.paper.spectrograms import stretch
from disc_model.figures.style import DISC, PAGE, SKY, new_figure, styled

WINDOWS = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")


@styled
def draw(cases: Mapping[str, xr.DataTree], *, until: float = np.inf) -> Figure:
    """Range of the disc's displacement at r_0 and a fixed angle."""
    figure = new_figure(PAGE, 2.2)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        _range(ax, cases["F13"], until)
    return figure


def _range(ax: Axes, case: xr.DataTree, until: float) -> None:
    for name in WINDOWS:
        start, stop = stretch(parts.spectrum_in_time(case, name, "w_point", hop=0.5))
        ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
        ax.text(start + 0.4, 0.97, f"({name[-1]})", transform=ax.get_xaxis_transform(), ha="left", va="top")
    history = parts.history(case, until)
    parts.envelope(ax, history, "w_point", scale=1e3, color=DISC)
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.15 * (high - low))
    parts.mark_first_separation(ax, float(case["first_separation"]))
    ax.set(xlabel="Time (s)", ylabel=parts.disc_label(history))
