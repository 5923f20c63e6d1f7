"""Figure 24 of the paper: the disc's vibration, with the four stretches that Figure 25 analyses."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from disc_model.analysis.spectra import time_frequency
from disc_model.figures import parts
from disc_model.figures.paper.spectrograms import stretch
from disc_model.figures.style import BLUE, PAGE, SKY, new_figure, styled

WINDOWS = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Range of the disc's displacement at r_0 and a fixed angle."""
    case = cases["F13"]
    figure = new_figure(PAGE, 2.2)
    ax = figure.subplots()
    for name in WINDOWS:
        window = case[name].to_dataset()
        start, stop = stretch(time_frequency(window["time"].values, window["w_point"].values, hop=0.5))
        ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
        ax.text(start + 0.4, 0.97, f"({name[-1]})", transform=ax.get_xaxis_transform(), ha="left", va="top")
    history = case["history"].to_dataset()
    parts.envelope(ax, history, "w_point", scale=1e3, color=BLUE)
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.15 * (high - low))
    parts.mark_first_separation(ax, float(case["first_separation"]))
    ax.set(xlabel="Time (s)", ylabel=parts.disc_label(history))
    return figure
