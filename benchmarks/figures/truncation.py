"""The effect of the number of modes, with and without residual flexibility."""

import json
from collections.abc import Mapping
from itertools import cycle
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from benchmarks.figures.looks import TEXTS, Look, letter, panels
from disc_model.data.variables import values_text
from disc_model.figures.draw import PAGE
from disc_model.figures.looks import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE

_CASES: list[Look] = [
    {"color": BLUE, "marker": "o"},
    {"color": GREEN, "marker": "s"},
    {"color": ORANGE, "marker": "^"},
    {"color": PURPLE, "marker": "D"},
]
_CONTACTS: dict[str, Look] = {
    "residual": {"linestyle": "-"},
    "rigid": {"linestyle": "--", "markerfacecolor": "white"},
}
"""Filled or hollow."""
FAR = 25.0
"""Greatest difference of first separations to that of the largest model, per cent, that is shown
to scale."""


class _Line(NamedTuple):
    """A line of a case with a contact over the number of modes."""

    data: xr.Dataset
    look: Look


def contact_truncation(dataset: xr.Dataset) -> Figure:
    """Draw the effect of residual flexibility against the number of real modes.

    Filled: residual flexibility; hollow: rigid contact; one colour for each case. Arrows at the
    edge mark values far outside the panel, crosses at the foot models without a cycle.
    """
    lines = _truncation_lines(dataset)
    figure, shown = panels(PAGE, 3.9, 2, 4, sharex=True)
    axes = {}
    for ax, panel, text in zip(shown, TEXTS["contact_truncation"], "abcdefgh", strict=True):
        variable, label, logarithmic = panel
        axes[variable] = ax
        for line in lines:
            y = line.data[variable].values
            good = np.isfinite(y)
            if logarithmic:
                good = good & (y > 0)
            ax.plot(line.data["modes"].values[good], y[good], **line.look)
        ax.set(xscale="log", yscale="log" if logarithmic else "linear")
        ax.margins(x=0.06)
        letter(ax, text, label, fontsize=7)
        ax.set_xticks((1, 3, 10, 30, 100), ["1", "3", "10", "30", "100"])
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.yaxis.set_minor_formatter(NullFormatter())
    for ax in shown[4:]:
        ax.set_xlabel("Real modes")
    for ax in shown:
        ax.autoscale(False)
    axes["late"].set_ylim(-FAR, FAR)
    axes["late"].axhline(0, color=GREY, linewidth=0.6, linestyle=":", zorder=0)
    for line in lines:
        _mark_extremes(axes, line)

    handles = _truncation_legend(dataset)
    columns = 6 if len(handles) < 7 else 3
    figure.legend(handles=handles, loc="outside lower center", ncols=columns)
    return figure


def _truncation_lines(dataset: xr.Dataset) -> list[_Line]:
    """Return the lines of all cases and contacts, with the first separations compared.

    The variable ``late`` is how much later they come than that of the largest model, per cent.
    """
    first = dataset["first_separation"]
    converged = first.sel(contact="residual").isel(model=-1)
    compared = dataset.assign(u_range=1e3 * dataset["u_range"], late=100 * (first / converged - 1))
    common: Look = {"markersize": 3, "linewidth": 0.8, "markeredgewidth": 0.7}
    lines = []
    for i, of_case in zip(range(dataset.sizes["case"]), cycle(_CASES)):
        for contact, of_contact in _CONTACTS.items():
            data = compared.isel(case=i).sel(contact=contact)
            lines.append(_Line(data, {**of_case, **of_contact, **common}))
    return lines


def _mark_extremes(axes: Mapping[str, Axes], line: _Line) -> None:
    """Mark values far outside a panel, and models without a cycle.

    Parameters
    ----------
    axes : panels by variable
    line : whose values are marked
    """
    arrow: Look = {"markersize": 3, "alpha": 0.7}
    cross: Look = {"markersize": 3.5, "zorder": 4}
    late = line.data["late"].values
    no_cycle = ~np.isfinite(line.data["growth_rate"].values)
    for name, extreme, height, mark, look in (
        ("late", late > FAR, 0.98, "^", arrow),
        ("late", late < -FAR, 0.02, "v", arrow),
        ("growth_rate", no_cycle, 0, "x", cross),
    ):
        if extreme.any():
            ax = axes[name]
            x = line.data["modes"].values[extreme]
            edge: Look = {"transform": ax.get_xaxis_transform(), "clip_on": False}
            color = line.look["color"]
            ax.plot(x, np.full(x.size, height), mark, color=color, **edge, **look)


def _truncation_legend(dataset: xr.Dataset) -> list[Line2D]:
    """Return entries of the legend: cases, contacts, and models without a cycle."""
    cases = json.loads(dataset.attrs["cases"])
    looks = []
    for name, look in zip(dataset["case"].values, cycle(_CASES)):
        case = {"normalization": "as_published", **cases[name]}
        label = f"{case['normalization'].replace('_', ' ')}, {values_text(case)}"
        looks.append({**look, "linestyle": "-", "label": label})
    for contact, look in _CONTACTS.items():
        looks.append({**look, "color": BLACK, "marker": "o", "label": contact})
    looks.append({"linestyle": "", "color": BLACK, "marker": "x", "label": "no cycle found"})
    return [Line2D([], [], markersize=4, **look) for look in looks]
