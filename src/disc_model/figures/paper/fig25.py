"""Figure 25 of the paper: how the disc's frequencies change, N = 385 N, Omega = 15.1 rad/s."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.analysis.spectra import TimeFrequency
from disc_model.figures import parts
from disc_model.figures.paper.catalogue import HIGHEST
from disc_model.figures.paper.fig24 import WINDOWS
from disc_model.figures.paper.spectrograms import colour_bar, mark_time, spectrogram
from disc_model.figures.style import PAGE, new_figure, styled

TABLE_2 = (2.4, 65.5, 70, 133, 138, 200, 206, 269, 273)
"""Frequencies that the paper lists, Hz."""


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Power of the disc's displacement at r_0 and a fixed angle over time and frequency, four stretches."""
    case = cases["F13"]
    figure = new_figure(PAGE, 4.6)
    axes = figure.subplots(2, 2, sharey=True)
    panels = dict(zip(WINDOWS, axes.flat, strict=True))
    found: dict[str, TimeFrequency] = {}
    for name, ax in panels.items():
        with parts.or_say_why(ax):
            found[name] = parts.spectrum_in_time(case, name, "w_point")
    reference = max((float(each.power.max()) for each in found.values()), default=1.0)
    for name, each in found.items():
        mesh = spectrogram(panels[name], each, reference, HIGHEST)
        mark_time(panels[name], float(case["first_separation"]))
        parts.letter(panels[name], name[-1])
    for ax in axes[:, 0]:
        ax.set_ylabel("Frequency (Hz)")
    for ax in axes[:, 1]:
        ax.set_label("shares the axis to its left")
    for ax in axes[1]:
        ax.set_xlabel("Time (s)")
    if WINDOWS[0] in found:
        _ticks_of_the_table(panels[WINDOWS[0]])
    if found:
        colour_bar(figure, mesh, list(axes.flat))
    return figure


def _ticks_of_the_table(ax: Axes) -> None:
    right = ax.secondary_yaxis("right")
    right.set_yticks(TABLE_2, labels=[])
    right.tick_params(length=5, width=0.8)
    right.spines["right"].set_visible(False)
    right.set_ylabel("")
