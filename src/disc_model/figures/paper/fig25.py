"""Figure 25 of the paper: how the disc's frequencies change, N = 385 N, Omega = 15.1 rad/s."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from disc_model.analysis.spectra import TimeFrequency
from disc_model.figures import parts
from disc_model.figures.paper.catalogue import HIGHEST
from disc_model.figures.paper.fig24 import WINDOWS
from disc_model.figures.paper.spectrograms import colour_bar, mark_time, spectrogram
from disc_model.figures.style import PAGE, new_figure, styled

CLOSE = 300.0
"""Highest frequency of the closer view, Hz."""
TABLE_2 = {
    r"$f_\Omega$": (2.4,),
    "$f_{h1}$, $f_{h2}$": (65.5, 70.0),
    "$f_1$, $f_2$": (133.0, 138.0),
    "$f_3$, $f_4$": (200.0, 206.0),
    "$f_5$, $f_6$": (269.0, 273.0),
}
"""Lines that the paper lists, Hz; pairs are too near to be named apart."""


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Power of the disc's displacement at r_0 and a fixed angle over time and frequency, four stretches.

    The lower row is the same up to `CLOSE` Hz, with the lines of Table 2 named.
    """
    case = cases["F13"]
    figure = new_figure(PAGE, 4.6)
    axes = figure.subplots(2, len(WINDOWS), sharex="col", sharey="row")
    found: dict[str, TimeFrequency] = {}
    for name, column in zip(WINDOWS, axes.T, strict=True):
        with parts.or_say_why(*column):
            found[name] = parts.spectrum_in_time(case, name, "w_point")
    reference = max((float(each.power.max()) for each in found.values()), default=1.0)
    for name, column in zip(WINDOWS, axes.T, strict=True):
        if name not in found:
            continue
        for ax, highest in zip(column, (HIGHEST, CLOSE), strict=True):
            mesh = spectrogram(ax, found[name], reference, highest)
            mark_time(ax, float(case["first_separation"]))
        parts.letter(column[0], name[-1])
        column[1].set_xlabel("Time (s)")
        column[1].xaxis.set_major_locator(MaxNLocator(3))
    for ax in axes[:, 0]:
        ax.set_ylabel("Frequency (Hz)")
    for ax in axes[:, 1:].flat:
        ax.set_label("shares the axis to its left")
    if found:
        _name_lines(axes[1, -1])
        colour_bar(figure, mesh, list(axes.flat))
    return figure


def _name_lines(ax: Axes) -> None:
    """Ticks at the frequencies of Table 2, with the paper's symbols."""
    right = ax.secondary_yaxis("right")
    right.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
    right.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
    right.tick_params(length=0)
    right.tick_params(which="minor", length=3, width=0.6)
    right.spines["right"].set_visible(False)
    right.set_label("shares the axis to its left")
