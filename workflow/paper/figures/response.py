"""A vibration over a run, closer looks at it, and its spectrum in time."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.analysis.spectra import TimeFrequency
from disc_model.data import dataset
from disc_model.disc.modes import plate_modes
from disc_model.figures.drawing import BLACK, PAGE, SKY, letter, mark_printed, new_figure, say, wide
from disc_model.figures.kinds.base import HIGHEST
from disc_model.figures.runs import sampled, show, show_thickness
from disc_model.figures.selection import history
from disc_model.figures.spectrogram import draw_power, draw_scale, span_of, spectrum_of
from disc_model.figures.stated_case import parameters_of
from disc_model.figures.types import Axes, Figure
from workflow.paper.figures.kinds import LOOK, Response

NARROW = 0.02  # part of the run from which the window of the spectrum is marked by a line
TITLES = (("b", "with separation"), ("e", "separation ignored"))


def draw(plot: Response, *cases: xr.DataTree) -> Figure:
    """Draw the run beside a spectrum, and closer looks beside another one; or all in one column.

    Letters run along the rows, and (a) and (b) are those of the paper.
    """
    width = plot.inches
    letters = "cd"[: len(plot.zooms)]
    extra = 1.3 * (len(cases) - 1)
    if width == PAGE:
        figure = new_figure(width, 2.7 + extra)
        left, right = np.asarray(figure.subfigures(1, 2, width_ratios=(1, 1.08)))
        rows = ["a" * max(len(letters), 1), letters]
        axes = left.subplot_mosaic(";".join(filter(None, rows)))
        shown = np.atleast_1d(right.subplots(len(cases), 1, sharex=True))
    else:
        figure = new_figure(width, 5.0 + extra)
        right = figure
        rows = ["aa", "bb", letters]
        rows += [2 * text for text, _ in TITLES[1 : len(cases)]]
        axes = figure.subplot_mosaic(";".join(filter(None, rows)))
        shown = np.array([axes[text] for text, _ in TITLES[: len(cases)]])
    spectra = [spectrum_of(case, plot.window, plot.variable) for case in cases]

    _draw_spectra(right, shown, cases, spectra)
    if width == PAGE:
        for ax in shown:
            ax.label_outer()
    if plot.highest:
        _mark_highest(shown[0], cases[0])
    _draw_run(axes["a"], plot, cases[0], spectra[0])
    for panel, (name, start) in zip(letters, plot.zooms, strict=True):
        _draw_look(axes[panel], cases[0], name, start, plot.variable)
        letter(axes[panel], panel)
    if "d" in letters:
        ends = np.array([axes["c"].get_ylim(), axes["d"].get_ylim()])
        axes["d"].sharey(axes["c"])
        axes["c"].set_ylim(ends.min(), ends.max())
        axes["d"].tick_params(labelleft=False)
        axes["d"].set_ylabel("")
    return figure


def _draw_spectra(
    figure: Any, axes: np.ndarray, cases: Sequence[xr.DataTree], spectra: Sequence[TimeFrequency]
) -> None:
    """Draw the spectra of the cases, below each other on one scale."""
    titles = TITLES if len(cases) > 1 else (("b", ""),)
    for ax, case, spectrum, title in zip(axes, cases, spectra, titles, strict=True):
        mesh = draw_power(ax, case, spectrum, float(spectra[0].power.max()), HIGHEST)
        letter(ax, *title)
        ax.set_xlabel("Time (s)")
        ax.set_ylabel("Frequency (Hz)")
    draw_scale(figure, mesh, list(axes))


def _mark_highest(ax: Axes, case: xr.DataTree) -> None:
    """Mark and name the disc's highest natural frequency."""
    p = parameters_of(case)
    natural = float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
    ax.axhline(natural, color="white", linewidth=wide(0.9), linestyle=(0, (1, 2)))
    words = f"highest natural frequency, {natural:.0f} Hz"
    say(ax, words, (0.02, natural), (1, 2), xycoords=("axes fraction", "data"), color="white")


def _draw_run(ax: Axes, plot: Response, case: xr.DataTree, spectrum: TimeFrequency) -> None:
    """Draw the range of the variable over the run, and mark the time of the spectrum."""
    show(ax, case, history(case, plot.history, plot.until), plot.variable)
    if plot.printed is not None:
        mark_printed(ax, plot.printed)
    if plot.variable == "w_point":
        show_thickness(ax, case, "y")
    start, stop = span_of(spectrum)
    ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0, zorder=0)
    if stop - start < NARROW * ax.get_xlim()[1]:
        middle = (start + stop) / 2
        ax.axvline(middle, color=BLACK, linewidth=wide(0.8), zorder=0)
        say(ax, "(b)", (middle, 1), (0, 2), xycoords=("data", "axes fraction"))
    letter(ax, "a")


def _draw_look(ax: Axes, case: xr.DataTree, name: str, start: float, variable: str) -> None:
    """Draw a closer look at the variable in a window; raises `Missing` without samples there."""
    window = dataset.samples(case, name)
    part = window.sel(time=slice(start, start + LOOK))
    if part.sizes["time"] < 2:
        raise dataset.Missing(f"has no samples from {start:g} to {start + LOOK:g} s")
    label, factor, colour = sampled(variable, window)
    milliseconds = (part["time"].values - start) * 1e3
    ax.plot(milliseconds, part[variable].values * factor, color=colour, linewidth=wide(0.6))
    ax.set_xlabel(f"Time after {start:g} s (ms)")
    ax.set_ylabel(label)
    ax.set_xlim((0, LOOK * 1e3))
