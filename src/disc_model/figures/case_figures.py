"""Figures of single cases as a study file describes them: histories, portraits and spectra."""

import math

import xarray as xr

from disc_model.data import dataset
from disc_model.figures.amplitudes import amplitudes
from disc_model.figures.drawing import letters, panels
from disc_model.figures.history import draw_history
from disc_model.figures.kinds.cases import History, Portrait, Spectrum
from disc_model.figures.legends import figure_legend
from disc_model.figures.portrait import draw_portrait
from disc_model.figures.shades import shade_ramps
from disc_model.figures.spectrum_lines import draw_spectrum
from disc_model.figures.stated_case import ramps_of
from disc_model.figures.types import Figure


def history(plot: History, case: xr.DataTree) -> Figure:
    """Draw variables of a case in a window, one above the other."""
    rows = len(plot.variables)
    width = plot.inches
    figure, axes = panels(width, 0.8 + 1.3 * rows, rows, sharex=True)
    end = math.inf if plot.until is None else plot.until
    shown = dataset.group(case, plot.window).sel(time=slice(None, end))
    if shown.sizes["time"] < 2:  # the run ended before it
        raise dataset.Missing(
            f"has {shown.sizes['time']} samples in {plot.window}, at least 2 are needed"
        )
    letters(axes)
    handles = draw_history(axes, case, shown, plot.variables)
    figure_legend(figure, [*handles, *shade_ramps(axes, ramps_of(case))])
    figure.align_ylabels()
    return figure


def portrait(plot: Portrait, case: xr.DataTree) -> Figure:
    """Draw a portrait of the samples in a window."""
    figure, [ax] = panels(plot.inches, 2.7)
    samples = dataset.samples(case, plot.window)
    figure_legend(figure, draw_portrait(ax, case, samples, plot.x, plot.y))
    return figure


def spectrum(plot: Spectrum, case: xr.DataTree) -> Figure:
    """Draw the spectrum of a variable in the whole of a window."""
    figure, [ax] = panels(plot.inches, 2.4)
    samples = dataset.samples(case, plot.window)
    draw_spectrum(ax, samples, plot.variable, amplitudes(samples, plot.variable, plot.highest))
    return figure
