"""Figure 2 of the paper: the contact force grows until the slider leaves the disc again and again."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data import inputs
from disc_model.figures import parts
from disc_model.figures.style import FORCE, PAGE, new_figure, styled


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """(a) range of the contact force over the run, (b) the contact force in the window `zoom`."""
    case = cases["F02"]
    figure = new_figure(PAGE, 2.3)
    whole, zoom = figure.subplots(1, 2)
    with parts.or_say_why(whole):
        _whole(whole, case)
    with parts.or_say_why(zoom):
        _zoom(zoom, case)
    return figure


def _whole(ax: Axes, case: xr.DataTree) -> None:
    parts.letter(ax, "a")
    parts.envelope(ax, parts.history(case), "P", color=FORCE)
    _show_zero(ax, case)
    parts.mark_first_separation(ax, float(case["first_separation"]))
    ax.set(xlabel="Time (s)", ylabel="Contact force (N)")


def _show_zero(ax: Axes, case: xr.DataTree) -> None:
    """Where contact is lost, zero is shown; a force that hardly changes is shown close up."""
    if np.isfinite(float(case["first_separation"])):
        ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])


def _zoom(ax: Axes, case: xr.DataTree) -> None:
    window = inputs.samples(case, "zoom")
    parts.letter(ax, "b")
    time = window["time"].values
    start = float(time[0])
    spans = [((a - start) * 1e3, (b - start) * 1e3) for a, b in parts.separations(window)]
    parts.shade(ax, spans, "separation")
    ax.plot((time - start) * 1e3, window["P"].values, color=FORCE)
    _show_zero(ax, case)
    ax.set(xlabel=f"Time after {start:.3f} s (ms)", ylabel="Contact force (N)")
    if spans:
        parts.legend_above(ax)
