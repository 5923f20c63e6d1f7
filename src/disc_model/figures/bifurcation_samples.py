"""Samples of bifurcation diagrams: marks of phases, and rings where motions are not shown to settle."""

from collections.abc import Mapping
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import axis_of, flag_names
from disc_model.figures.classes import UNSETTLED
from disc_model.figures.drawing import GREY, PHASE_COLOURS, mark, mark_failed
from disc_model.figures.sections import names_of_events, with_section
from disc_model.figures.selection import failed
from disc_model.figures.types import Array, Axes, Mask, Words

MARKS: dict[str, dict[str, Any]] = {
    "stick": {"marker": "4", "markersize": 4.0, "mew": 0.6},
    "slip": {"marker": ".", "markersize": 1.5},
    "separation": {"marker": "^", "markersize": 2.2, "mew": 0},
}
"""Marks of phases, whose colours are alike in grey print, and crosses are those of failed points; forks are larger
than triangles, or small ones of both would pass for dots."""
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
NARROW = 21  # characters of a line beside the samples, which also a low panel has room for


def phases_of(study: xr.Dataset) -> Words:
    """The phase of each sample, "none" where it was not reached, or the point failed."""
    phase = flag_names(study["phase"])
    return np.where(failed(study).values[:, None], "none", phase)


def draw_samples(ax: Axes, study: xr.Dataset, along: Array) -> None:
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
