"""Ranges over a whole run: the contact force and the disc's vibration; figures 10, 11 and 13 of the paper."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.parts import COLUMN, DISC, FORCE, GREY, new_figure, styled


@styled()
def force_and_disc(cases: Mapping[str, xr.DataTree], *, until: float = np.inf) -> Figure:
    """(a) contact force, (b) disc at r_0 and a fixed angle, as ranges until a time in s; first separation marked."""
    (case,) = cases.values()
    figure = new_figure(COLUMN, 3.4)
    force, disc = figure.subplots(2, 1, sharex=True)
    with parts.or_say_why(force, disc):
        history = parts.history(case, until)
        parts.envelope(force, history, "P", color=FORCE)
        parts.envelope(disc, history, "w_point", scale=1e3, color=DISC)
        force.set(ylabel="Contact force (N)")
        disc.set(xlabel="Time (s)", ylabel=parts.disc_label(history))
        for ax, letter in ((force, "a"), (disc, "b")):
            parts.mark_first_separation(ax, float(case["first_separation"]))
            parts.letter(ax, letter)
    figure.align_ylabels()
    return figure


@styled()
def with_and_without(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Range of the disc's displacement at r_0 and a fixed angle over the run: contact enforced, and separable."""
    figure = new_figure(COLUMN, 2.4)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        ignored, separating = (parts.history(cases[name]) for name in ("F04", "F02"))
        for history, color, label in ((ignored, GREY, "separation ignored"), (separating, DISC, "with separation")):
            parts.envelope(ax, history, "w_point", scale=1e3, color=color, label=label)
        ax.set(xlabel="Time (s)", ylabel=parts.disc_label(ignored, separating))
        low, high = ax.get_ylim()
        ax.set_ylim(low, high + 0.25 * (high - low))
        ax.legend(loc="upper left")
    return figure
