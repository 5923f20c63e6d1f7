"""Contact force and disc vibration of one case, one above the other; figures 11 and 13 are made of it."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.style import COLUMN, DISC, FORCE, new_figure


def force_and_disc(case: xr.DataTree, until: float = np.inf) -> Figure:
    """(a) contact force, (b) disc at r_0 and a fixed angle, as ranges until a time in s; first separation marked."""
    figure = new_figure(COLUMN, 3.4)
    force, disc = figure.subplots(2, 1, sharex=True)
    with parts.or_say_why(force, disc):
        _ranges(force, disc, case, until)
    figure.align_ylabels()
    return figure


def _ranges(force: Axes, disc: Axes, case: xr.DataTree, until: float) -> None:
    history = parts.history(case, until)
    first = float(case["first_separation"])
    parts.envelope(force, history, "P", color=FORCE)
    parts.envelope(disc, history, "w_point", scale=1e3, color=DISC)
    parts.mark_first_separation(force, first)
    parts.mark_first_separation(disc, first)
    force.set(ylabel="Contact force (N)")
    disc.set(xlabel="Time (s)", ylabel=parts.disc_label(history))
    parts.letter(force, "a")
    parts.letter(disc, "b")
