"""Bifurcation diagrams: samples once a turn or at events, periods, and exponents."""

from collections.abc import Mapping
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.ticker import NullLocator

from disc_model.data.variables import axis_of
from disc_model.figures.bifurcation_exponents import draw_exponents
from disc_model.figures.bifurcation_samples import UNDECIDED, draw_samples, phases_of
from disc_model.figures.classes import name_of
from disc_model.figures.drawing import (
    BLACK,
    letters,
    mark,
    mark_cases,
    panels,
    plain_decades,
    whole_marks,
)
from disc_model.figures.edge_strip import draw_strip
from disc_model.figures.kind_rows import SHAPES, looks_of_kinds, words_of_kinds
from disc_model.figures.kinds.motions import Bifurcation
from disc_model.figures.legends import LEAST_CURVE, legend_above
from disc_model.figures.places import set_places
from disc_model.figures.selection import failed
from disc_model.figures.settled_motions import CALM, kinds_of
from disc_model.figures.types import Array, Axes, Figure, Mask

CHARACTERS = 12  # of the title of a legend in an inch of the page
Row = tuple[Array, dict[str, Any]]
"""Places along the horizontal axis, and the look of their marks."""
IN_LEGEND = 6.0  # size of the marks there: those of the diagram are too small for it
STRIPS = (0.05, 0.13)
"""Heights of rows for kinds of motion, and for those without a period, as shares of their panels."""


def draw(plot: Bifurcation, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw samples by phase, hollow where the motion is not shown to have settled, with crosses
    at failed points, with a strip of kinds of motion; below periods, and exponents with
    crosses where the largest is missing."""
    study = study.transpose(plot.x, "sample", ...)
    label, factor = axis_of(plot.x)
    along = study[plot.x].values * factor

    # panels
    heights = [2.4, 1.0]  # inch
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
    kinds = [(at, {**look, "color": BLACK}) for at, look in looks_of_kinds(study, along)]
    covered = draw_strip(axes[0], STRIPS[0], [*kinds, _without_samples(study, along)])
    draw_strip(axes[1], STRIPS[1], [_without_period(study, along), *_calm(study, along)])
    whole_marks(axes[1])
    places = {case: value * factor for case, value in plot.paper_cases.items()}
    mark_cases(axes, places, covered)
    legend_above(axes[1])
    title = f"on the grey strip: {words_of_kinds(study)}"
    legend = legend_above(axes[0], title=fill(title, round(width * CHARACTERS)))
    for line in legend.get_lines() if legend else ():
        line.set_markersize(mark(IN_LEGEND))
    _keep_height(figure, axes[0], sum(heights) / heights[0])
    return figure


def _keep_height(figure: Figure, samples: Axes, rows: float) -> None:
    """Make a figure so high that legends above its panels leave that of the samples a height.

    rows : heights of all panels over that of the samples
    """
    set_places(figure)
    missing = LEAST_CURVE - samples.bbox.height / figure.dpi
    if missing > 0:
        figure.set_figheight(figure.get_figheight() + rows * missing)


def _without_samples(study: xr.Dataset, along: Array) -> Row:
    """Places of motions that have events, but none while they were sampled."""
    idle = ~_has_events(study) & ~failed(study).values
    here = idle & ~np.isin(kinds_of(study), CALM)
    return along[here], {"marker": "|", "label": "no event while sampled"}


def _calm(study: xr.Dataset, along: Array) -> list[Row]:
    """Places of motions that have no period because they have no events."""
    known = ~failed(study).values
    kinds = kinds_of(study)
    return [
        (along[known & (kinds == word)], {"marker": SHAPES[word], "label": name_of(word)})
        for word in CALM
    ]


def _without_period(study: xr.Dataset, along: Array) -> Row:
    """Places of motions that have events, and are not shown to repeat."""
    doubtful = _has_events(study) & ~_repeats(study) & ~np.isin(kinds_of(study), CALM)
    size = mark(UNDECIDED["markersize"])
    return along[doubtful], {**UNDECIDED, "markersize": size, "label": "not shown to repeat"}


def _has_events(study: xr.Dataset) -> Mask:
    """Points at which events were sampled."""
    return np.asarray((phases_of(study) != "none").any(axis=1))


def _repeats(study: xr.Dataset) -> Mask:
    """Points of motions that are shown to repeat after some events."""
    return _has_events(study) & (study["period_events"].values > 0)


def _draw_periods(ax: Axes, study: xr.Dataset, along: Array) -> None:
    """Draw after how many events motions repeat."""
    period = study["period_events"].values
    repeats = _repeats(study)
    ax.plot(along[repeats], period[repeats], ".", color=BLACK, markersize=mark(3))
    ax.set_yscale("log")
    ax.set_ylabel("Events in\na period")
    ax.set_ylim(0.7, None)  # room below period 1, which is no end of the scale
    plain_decades(ax.yaxis, least=1)  # there is no half of an event
    ax.yaxis.set_minor_locator(NullLocator())
