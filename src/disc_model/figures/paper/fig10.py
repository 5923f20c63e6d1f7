"""Figure 10 of the paper: separation keeps the disc's vibration in a much smaller range."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.style import COLUMN, DISC, GREY, new_figure, styled


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Range of the disc's displacement at r_0 and a fixed angle over the run: contact enforced, and separable."""
    figure = new_figure(COLUMN, 2.4)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        _both(ax, cases)
    return figure


def _both(ax: Axes, cases: Mapping[str, xr.DataTree]) -> None:
    histories = {name: parts.history(cases[name]) for name in ("F04", "F02")}
    for name, color, label in (("F04", GREY, "separation ignored"), ("F02", DISC, "with separation")):
        parts.envelope(ax, histories[name], "w_point", scale=1e3, color=color, label=label)
    ax.set(xlabel="Time (s)", ylabel=parts.disc_label(*histories.values()))
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.25 * (high - low))
    ax.legend(loc="upper left")
