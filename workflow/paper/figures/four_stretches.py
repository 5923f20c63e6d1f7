"""Range of the disc over a run, and its power over time and frequency in four stretches."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.ticker import MaxNLocator

from disc_model.analysis.spectra import TimeFrequency
from disc_model.figures.drawing import BLACK, SKY, headroom, large, letters, new_figure
from disc_model.figures.kinds.base import HIGHEST
from disc_model.figures.runs import show, show_thickness
from disc_model.figures.selection import history
from disc_model.figures.spectrogram import draw_power, draw_scale, span_of, spectrum_of
from disc_model.figures.types import Axes, Figure
from workflow.paper.figures.kinds import WINDOWS, FourStretches

CLOSE = 300.0  # highest frequency of the closer view, Hz
TABLE_2 = {
    r"$f_\Omega$": (2.4,),
    "$f_{h1}$, $f_{h2}$:\n$f_s ∓ f_\\Omega$": (65.5, 70.0),
    "$f_1$, $f_2$:\n$2f_s ∓ f_\\Omega$": (133.0, 138.0),
    "$f_3$, $f_4$:\n$3f_s ∓ f_\\Omega$": (200.0, 206.0),
    "$f_5$, $f_6$:\n$4f_s ∓ f_\\Omega$": (269.0, 273.0),
}
"""Lines of the paper, Hz, by their components; pairs are too close for separate names."""
ROWS = ((0, CLOSE, HIGHEST), (0, 0.0, CLOSE), (1, 0.0, CLOSE))
"""Of each row: the case, and the ends of its frequencies, Hz."""
Grid = Any  # of axes, three rows and a column for each window


def draw(plot: FourStretches, *cases: xr.DataTree) -> Figure:
    """Draw the whole run above its stretches."""
    width = plot.inches
    figure = new_figure(width, 6.2)
    top, below = np.asarray(figure.subfigures(2, 1, height_ratios=(1.1, 3)))
    whole = top.subplots()
    axes: Grid = below.subplots(
        3, len(WINDOWS), sharex="col", sharey="row", squeeze=False, height_ratios=(1, 1.6, 1.6)
    )
    # before any separation both cases are alike: the second has no first window
    spectra = {
        (i, name): spectrum_of(case, name, "w_point")
        for i, case in enumerate(cases)
        for name in WINDOWS[i:]
    }
    mesh = _draw_stretches(axes, cases, spectra)
    _say_what_is_where(axes)
    _name_lines(axes[1, -1])
    draw_scale(below, mesh, list(axes.flat))

    # letters as in the paper's Fig. 25; the whole run is its Fig. 24
    for name, text in zip(WINDOWS, "abcd", strict=True):
        start, stop = span_of(spectra[0, name])
        whole.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
        whole.text(
            start + 0.4,
            0.97,
            f"({text})",
            ha="left",
            va="top",
            transform=whole.get_xaxis_transform(),
        )
    show(whole, cases[0], history(cases[0], plot.history, plot.until), "w_point")
    headroom(whole, 0.15)
    show_thickness(whole, cases[0], "y")
    letters([*axes[0], *axes[2, 1:]])
    return figure


def _draw_stretches(
    axes: Grid, cases: Sequence[xr.DataTree], spectra: dict[tuple[int, str], TimeFrequency]
) -> Any:
    """Draw the power of each stretch on one scale; returns what has the colours."""
    reference = max(float(spectrum.power.max()) for spectrum in spectra.values())
    mesh = None
    for row, (i, low, high) in zip(axes, ROWS, strict=True):
        for ax, name in zip(row[i:], WINDOWS[i:], strict=True):
            mesh = draw_power(ax, cases[i], spectra[i, name], reference, high)
            ax.set_ylim(low, high)
        row[0].set_ylabel("Frequency (Hz)")
    for ax in axes[-1]:
        ax.set_xlabel("Time (s)")
        ax.xaxis.set_major_locator(MaxNLocator(3))
    return mesh


def _say_what_is_where(axes: Grid) -> None:
    """Name the rows, and say why a panel is empty."""
    place: dict[str, Any] = {"xycoords": "axes fraction", "ha": "right", "va": "center"}
    for row, text in zip(axes[1:], ("with separation", "separation ignored"), strict=True):
        row[-1].annotate(text, (0.97, 0.58), fontsize=large(6), color="white", **place)
    empty = axes[2, 0]
    empty.set_facecolor("white")
    reason = "as above:\nno separation yet"
    empty.annotate(reason, (0.9, 0.55), fontsize=large(7), color=BLACK, **place)


def _name_lines(ax: Axes) -> None:
    """Name the lines of Table 2 beside a panel; names keep clear of the ticks of single lines."""
    names = ax.secondary_yaxis("right")
    names.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
    names.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
    names.tick_params(length=0, pad=7)
    names.tick_params(which="minor", length=3, width=0.6)
    names.spines["right"].set_visible(False)
