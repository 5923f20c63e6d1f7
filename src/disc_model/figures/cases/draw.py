"""Figures of one named case: history, Poincare sections, spectrogram, phase portrait."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from disc_model.data import dataset
from disc_model.figures import parts
from disc_model.figures.cases.kinds import CASE_PLOTS, History, Portrait, Spectrogram
from disc_model.figures.paper.sections import orbit, sections
from disc_model.figures.paper.spectra import colour_bar, mark_time, spectrogram, spectrum_in_time
from disc_model.figures.parts import COLUMN, DISC, FORCE, PAGE, SLIDER, new_figure, styled

AXES = {
    "P": ("Contact force P (N)", 1.0),
    "u": ("Slider u (mm)", 1e3),
    "u_velocity": ("Slider du/dt (m/s)", 1.0),
    "w": ("Disc under the slider w (mm)", 1e3),
    "psi": ("ψ (rad)", 1.0),
    "psi_velocity": ("dψ/dt (rad/s)", 1.0),
}
"""Label and factor from SI; those of the disc's fixed point also say where it is."""
COLOURS = {"P": FORCE, "w": DISC, "w_point": DISC, "w_point_velocity": DISC}


@styled()
def draw(cases: Mapping[str, xr.DataTree], **said: Any) -> Figure:
    """One figure of one case.

    Parameters
    ----------
    cases : the one that it shows, as `disc_model.data.dataset.load` reads it
    said : what the study file says of it, see `disc_model.figures.cases.kinds`
    """
    plot = CASE_PLOTS[said["kind"]].model_validate(said)
    figure = DRAWN[said["kind"]](cases[plot.case], plot)
    if plot.title:
        figure.suptitle(plot.title, fontsize=8)
    return figure


def _history(case: xr.DataTree, plot: History) -> Figure:
    figure = new_figure(COLUMN, 0.9 + 1.3 * len(plot.variables))
    axes = figure.subplots(len(plot.variables), 1, sharex=True, squeeze=False)[:, 0]
    with parts.or_say_why(*axes):
        window = dataset.group(case, plot.window)
        time = window["time"].values
        if time.size < 2:  # the run ended before it
            raise dataset.Missing(f"has {time.size} samples in {plot.window}, at least 2 are needed")
        for ax, name in zip(axes, plot.variables, strict=True):
            label, factor = _axis(name, window)
            colour = COLOURS.get(name, SLIDER)
            if f"{name}_min" in window:
                low, high = (window[f"{name}_{bound}"].values * factor for bound in ("min", "max"))
                ax.fill_between(time, low, high, facecolor=colour, edgecolor=colour, linewidth=0.5)
            else:
                ax.plot(time, window[name].values * factor, color=colour, linewidth=0.6)
            ax.set(ylabel=label, xlim=(time[0], time[-1]))
            parts.mark_first_separation(ax, float(case["first_separation"]))
        axes[-1].set_xlabel("Time (s)")
    figure.align_ylabels()
    return figure


def _spectrogram(case: xr.DataTree, plot: Spectrogram) -> Figure:
    figure = new_figure(PAGE / 2, 2.7)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        found = spectrum_in_time(case, plot.window, plot.variable)
        mesh = spectrogram(ax, found, float(found.power.max()), plot.highest)
        mark_time(ax, float(case["first_separation"]))
        label = _axis(plot.variable, dataset.group(case, plot.window))[0].partition(" (")[0]
        ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)", title=label)
        colour_bar(figure, mesh, ax)
    return figure


def _portrait(case: xr.DataTree, plot: Portrait) -> Figure:
    figure = new_figure(COLUMN, 2.7)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        window = dataset.samples(case, plot.window)
        (across, in_x), (up, in_y) = (_axis(name, window) for name in (plot.x, plot.y))
        orbit(ax, window, window[plot.x].values * in_x, window[plot.y].values * in_y)
        ax.set(xlabel=across, ylabel=up)
    return figure


def _axis(name: str, window: xr.Dataset) -> tuple[str, float]:
    """Label of a variable's axis, and the factor from SI to its unit."""
    if name == "w_point":
        return parts.disc_label(window), 1e3
    if name == "w_point_velocity":
        return parts.disc_velocity_label(window), 1.0
    return AXES[name]


DRAWN: dict[str, Callable[[xr.DataTree, Any], Figure]] = {
    "history": _history,
    "poincare": lambda case, plot: sections({plot.case: case}),
    "spectrogram": _spectrogram,
    "portrait": _portrait,
}
