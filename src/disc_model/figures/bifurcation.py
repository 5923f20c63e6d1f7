"""Bifurcation diagrams: samples once a turn or at events, periods, and exponents."""

from collections.abc import Mapping
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.ticker import NullLocator

from disc_model.data.variables import axis_of, flag_names
from disc_model.figures.classes import UNSETTLED, name_of
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    BROWN,
    GREY,
    PHASE_COLOURS,
    letters,
    mark,
    mark_cases,
    mark_failed,
    open_line,
    panels,
    plain_decades,
    wide,
)
from disc_model.figures.edge_strip import draw_strip
from disc_model.figures.kinds.motions import Bifurcation
from disc_model.figures.legends import legend_above
from disc_model.figures.sections import names_of_events, with_section
from disc_model.figures.selection import failed, opened
from disc_model.figures.settled_motions import CALM, kinds_of
from disc_model.figures.types import Array, Axes, Figure, Mask, Words

MARKS: dict[str, dict[str, Any]] = {
    "stick": {"marker": "x", "markersize": 2.0, "mew": 0.4},
    "slip": {"marker": ".", "markersize": 1.5},
    "separation": {"marker": "^", "markersize": 1.6, "mew": 0},
}
"""Marks of phases, whose colours are alike in grey print."""
UNDECIDED: dict[str, Any] = {
    "color": GREY,
    "marker": "o",
    "markersize": 3.0,
    "mfc": "none",
    "mew": 0.5,
}
UNDECIDED_NAME = "not settled, or undecided"
RINGS = {"stick": "o", "separation": "^"}
"""Shapes of such marks by the phases of events at which samples are taken."""
RINGS_APART = 0.025  # of the range of all samples, least distance of such marks at one point
IN_LEGEND = 6.0  # size of the marks there: those of the diagram are too small for it
SHAPES = {"steady_sliding": "_", "at_rest": "1"}
"""Marks of motions without events."""
EXPONENTS = (BLACK, BLUE, BROWN, GREY)
"""Colours of exponents, the largest first; none is the colour of a phase."""
ERRORS = 4  # half-width of the band about an exponent, in standard errors
ANOTHER = 0.05  # 1/s, step of an exponent beyond which another motion begins
SAME_PLACE = 1e-6  # of a step of the parameter, within which points of two studies are one
LONE_BAND = 3.0  # points, width of the band about a point that is joined to none
NARROW = 21  # characters of a line beside the samples, which also a low panel has room for
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

    _draw_samples(axes[0], study, along)
    _draw_periods(axes[1], study, along)
    if "lyapunov" in overlays:
        _draw_exponents(axes[2], overlays["lyapunov"], study, plot.x)

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


def phases_of(study: xr.Dataset) -> Words:
    """The phase of each sample, "none" where it was not reached, or the point failed."""
    phase = flag_names(study["phase"])
    return np.where(failed(study).values[:, None], "none", phase)


def _draw_samples(ax: Axes, study: xr.Dataset, along: Array) -> None:
    """Draw the angle of each sample, in mrad, over the parameter."""
    values = 1e3 * study["psi"].values  # some hundredths of a radian
    position = np.broadcast_to(along[:, None], values.shape)
    phase = phases_of(study)
    settled = (flag_names(study["settled"]) == "settled")[:, None]
    names = names_of_events(study)
    dots = rings_of(values, ~settled & (phase != "none"), phase, names)
    for name, colour in PHASE_COLOURS.items():
        look = {**MARKS[name], "color": colour}
        dots.append((names.get(name, name), settled & (phase == name), look))
    for name, mask, look in dots:
        if mask.any():
            sized = {**look, "markersize": mark(look["markersize"])}
            ax.plot(position[mask], values[mask], linestyle="", label=name, **sized)
    mark_failed(ax, along[failed(study).values])
    label, _ = axis_of("psi")
    words, unit = label.replace("rad", "mrad").rsplit(" ", 1)
    said = with_section(study, "psi", words)
    ax.set_ylabel(fill(f"{said} {unit}", NARROW))


def rings_of(
    values: Array, chosen: Mask, phase: Words, events: Mapping[str, str]
) -> list[tuple[str, Mask, dict[str, Any]]]:
    """The names, samples and looks of rings of chosen samples, (points, samples): those of each event
    by the phase there, and all others.

    events : names of events by their phases
    """
    rings = []
    for event, name in events.items():
        mask = apart(values, chosen & (phase == event))
        rings.append((f"{name}, {UNSETTLED.label}", mask, {**UNDECIDED, "marker": RINGS[event]}))
    others = chosen & ~np.isin(phase, [*events])
    rings.append((UNDECIDED_NAME, apart(values, others), UNDECIDED))
    return rings


def apart(values: Array, chosen: Mask) -> Mask:
    """Those of the chosen samples, (points, samples), that are drawn as rings: at each point the
    lowest, and from there on each that does not merge with the last one."""
    shown = np.zeros(chosen.shape, dtype=bool)
    known = values[np.isfinite(values)]
    least = RINGS_APART * (np.ptp(known) if known.size else 0.0)
    for point in np.flatnonzero(chosen.any(axis=1)):
        last = -np.inf
        for sample in np.argsort(values[point], kind="stable"):
            height = values[point, sample]
            if chosen[point, sample] and height >= last + least:
                shown[point, sample] = True
                last = height
    return shown


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


def _draw_exponents(ax: Axes, lyapunov: xr.Dataset, study: xr.Dataset, name: str) -> None:
    """Draw the largest exponents with their errors, joined along one motion; rings of their colours
    where they have not converged."""
    lyapunov = lyapunov.transpose("exponent_number", name, ...)
    known = ~failed(lyapunov)
    exponent = lyapunov["exponent"].where(known).values
    error = lyapunov["exponent_error"].where(known).values
    moving = flag_names(lyapunov["converged"])[: len(EXPONENTS)] == "no"
    factor = axis_of(name)[1]
    along = lyapunov[name].values * factor
    changes = motion_changes(study, study[name].values * factor, along)
    changes |= (np.abs(np.diff(exponent, axis=1)) > ANOTHER).any(axis=0)
    alone = np.concatenate([[True], changes]) & np.concatenate([changes, [True]])

    ax.axhline(0, color=GREY, linewidth=wide(0.8))
    ring: dict[str, Any] = {
        "markerfacecolor": "none",
        "markersize": mark(4),
        "markeredgewidth": wide(0.6),
    }
    for i, colour in zip(range(len(exponent)), EXPONENTS, strict=False):
        label = f"exponent {i + 1}" if i else "largest exponent"
        x, y = opened(along, exponent[i], changes)
        ax.plot(x, y, ".-", color=colour, markersize=mark(3), linewidth=wide(0.8), label=label)
        band = ERRORS * np.interp(x, along, error[i])
        ax.fill_between(x, y - band, y + band, color=colour, alpha=0.15, linewidth=0)
        # a band of one point has no width
        low, high = exponent[i] + ERRORS * np.array([[-1], [1]]) * error[i]
        bar: dict[str, Any] = {"color": colour, "alpha": 0.15, "linewidth": wide(LONE_BAND)}
        ax.vlines(along[alone], low[alone], high[alone], **bar)
        late = moving[i]
        ax.plot(along[late], exponent[i][late], "o", label="_nolegend_", color=colour, **ring)
    # samples for the legend
    errors = f"± {ERRORS} standard errors"
    ax.fill_between([], [], [], color=GREY, alpha=0.3, linewidth=0, label=errors)
    if moving.any():
        ax.plot([], [], "o", label="not converged", color=GREY, **ring)
    if changes.any():
        ax.add_line(open_line("line open: another motion", BLACK, wide(0.8)))
    mark_failed(ax, along[np.isnan(exponent[0])])
    ax.set_ylabel("Lyapunov\nexponents,\nwithout the\ntrivial one (1/s)")
    legend_above(ax)


def motion_changes(study: xr.Dataset, along: Array, places: Array) -> Mask:
    """Whether the motion has another class or another number of events between each of some places
    and the next one, (n - 1,).

    along : (m,), ascending, the points of the study
    places : (n,), ascending
    """
    kind = flag_names(study["kind"])
    events = study["period_events"].values
    changed = (kind[1:] != kind[:-1]) | (events[1:] != events[:-1])
    so_far = np.concatenate([[0], np.cumsum(changed)])
    # a place between two points may have the motion of either
    position = np.interp(places, along, np.arange(along.size))
    before = np.floor(position + SAME_PLACE).astype(int)
    after = np.ceil(position - SAME_PLACE).astype(int)
    return so_far[after[1:]] > so_far[before[:-1]]
