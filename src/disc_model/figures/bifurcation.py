"""Bifurcation diagrams: samples once a turn or at events, periods, and exponents."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.ticker import NullLocator

from disc_model.data.variables import axis_of
from disc_model.figures.bifurcation_exponents import draw_exponents
from disc_model.figures.bifurcation_samples import draw_samples, phases_of
from disc_model.figures.classes import name_of
from disc_model.figures.drawing import (
    BLACK,
    letters,
    mark,
    mark_cases,
    mark_failed,
    panels,
    plain_decades,
)
from disc_model.figures.edge_strip import draw_strip
from disc_model.figures.kinds.motions import Bifurcation
from disc_model.figures.legends import legend_above
from disc_model.figures.selection import failed
from disc_model.figures.settled_motions import CALM, kinds_of
from disc_model.figures.types import Array, Axes, Figure

IN_LEGEND = 6.0  # size of the marks there: those of the diagram are too small for it
SHAPES = {"steady_sliding": "_", "at_rest": "1"}
"""Marks of motions without events."""
STRIPS = (0.06, 0.16)
"""Heights of the strips for motions without samples and without a period, as shares of their panels."""


def draw(plot: Bifurcation, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw samples by phase, hollow where the motion is not shown to have settled, with crosses
    at failed points, a strip of motions without samples; below periods, and exponents with
    crosses where the largest is missing."""
    study = study.transpose(plot.x, "sample", ...)
    label, factor = axis_of(plot.x)
    along = study[plot.x].values * factor

    # panels
    heights = [2.4, 0.9]  # inch
    if "lyapunov" in overlays:
        heights.append(1.4)
    width = plot.inches
    rows = len(heights)
    figure, axes = panels(width, sum(heights) + 0.7, rows, sharex=True, height_ratios=heights)
    axes[-1].set_xlabel(label)

    draw_samples(axes[0], study, along)
    _draw_periods(axes[1], study, along)
    if "lyapunov" in overlays:
        draw_exponents(axes[2], overlays["lyapunov"], study, plot.x)

    letters(axes)
    for panel in axes:
        panel.margins(x=0.02)  # no dot is cut at the edge
    places = {case: value * factor for case, value in plot.paper_cases.items()}
    mark_cases(axes, places)
    draw_strip(axes[0], STRIPS[0], _without_samples(study, along))
    draw_strip(axes[1], STRIPS[1], _calm(study, along))
    legend_above(axes[1])
    legend = legend_above(axes[0])
    for line in legend.get_lines() if legend else ():
        line.set_markersize(mark(IN_LEGEND))
    return figure


def _without_samples(study: xr.Dataset, along: Array) -> dict[str, tuple[str, Array]]:
    """Places of motions without samples: steady sliding, permanent stick, and others without an event."""
    idle = ~(phases_of(study) != "none").any(axis=1) & ~failed(study).values
    kinds = kinds_of(study)
    found = {name_of(word): (SHAPES[word], along[idle & (kinds == word)]) for word in CALM}
    found["no event while sampled"] = ("|", along[idle & ~np.isin(kinds, CALM)])
    return found


def _calm(study: xr.Dataset, along: Array) -> dict[str, tuple[str, Array]]:
    """Places of motions that have no period because they have no events."""
    known = ~failed(study).values
    kinds = kinds_of(study)
    return {name_of(word): (SHAPES[word], along[known & (kinds == word)]) for word in CALM}


def _draw_periods(ax: Axes, study: xr.Dataset, along: Array) -> None:
    """Draw after how many events motions repeat, and mark those that have events and are not shown to."""
    moving = (phases_of(study) != "none").any(axis=1)
    period = study["period_events"].values
    repeats = moving & (period > 0)
    doubtful = moving & ~repeats & ~np.isin(kinds_of(study), CALM)
    ax.plot(along[repeats], period[repeats], ".", color=BLACK, markersize=mark(3))
    ax.set_yscale("log")
    ax.set_ylabel("Events in\na period")
    ax.set_ylim(0.4, None)  # room for crosses below period 1
    plain_decades(ax.yaxis, least=1)  # there is no half of an event
    ax.yaxis.set_minor_locator(NullLocator())
    mark_failed(ax, along[doubtful], name="not shown to repeat")
