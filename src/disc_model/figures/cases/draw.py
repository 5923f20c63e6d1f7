"""Figures of one named case: history, Poincare sections, spectrogram, phase portrait."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from disc_model.data import dataset
from disc_model.figures import parts
from disc_model.figures.cases.kinds import CASE_PLOTS, History, Spectrogram
from disc_model.figures.paper.sections import portrait, sections
from disc_model.figures.paper.spectra import spectrum, spectrum_in_time
from disc_model.figures.parts import COLUMN, PAGE, new_figure, styled


@styled()
def draw(cases: Mapping[str, xr.DataTree], **said: Any) -> Figure:
    """One figure of one case, from what the study file says of it, see `disc_model.figures.cases.kinds`."""
    plot = CASE_PLOTS[said["kind"]].model_validate(said)
    case = cases[plot.case]
    figure = DRAWN[said["kind"]](case, plot)
    parts.entitle(figure, plot.title, parts.what_case(json.loads(case.attrs.get("parameters", "{}"))))
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
            label, factor, colour = parts.sampled(name, window)
            if f"{name}_min" in window:
                parts.envelope(ax, window, name, scale=factor, color=colour)
            else:
                ax.plot(time, window[name].values * factor, color=colour, linewidth=0.6)
            ax.set(ylabel=label, xlim=(time[0], time[-1]))
            parts.mark_first_separation(ax, float(case["first_separation"]))
        axes[-1].set_xlabel("Time (s)")
        axes[-1].locator_params(axis="x", nbins=5)
    figure.align_ylabels()
    return figure


def _spectrogram(case: xr.DataTree, plot: Spectrogram) -> Figure:
    figure = new_figure(PAGE / 2, 2.7)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        found = spectrum_in_time(case, plot.window, plot.variable)
        spectrum(figure, ax, case, found, plot.highest)
        ax.set_title(parts.sampled(plot.variable, dataset.group(case, plot.window))[0].partition(" (")[0])
    return figure


DRAWN: dict[str, Callable[[xr.DataTree, Any], Figure]] = {
    "history": _history,
    "poincare": lambda case, plot: sections({plot.case: case}),
    "spectrogram": _spectrogram,
    "portrait": lambda case, plot: portrait({plot.case: case}, window=plot.window, x=plot.x, y=plot.y),
}
