"""Speed against accuracy, and how cost grows."""

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter, NullLocator

from benchmarks.figures.looks import LINES, TEXTS, Look, letter, panels, row_panels, say
from disc_model.figures.draw import PAGE
from disc_model.figures.looks import GREY

# ---- Speed against accuracy

WRONG_AT = 25.0
"""Place of points with wrong events on the axis of errors, s."""
EDGE = 3.0
"""Border between errors and wrong events, s."""
RIGHT_EVENTS = (0, 1)
"""Verdicts on runs whose events are right."""
WRONG_EVENTS = 2


def overview(dataset: xr.Dataset) -> Figure:
    """Draw cost against event-time error, a panel for each scene.

    The legend names the methods with a point in any. Dotted: without the time in Python; hollow at
    the right edge: wrong events.
    """
    scenes = dataset["scene"].values.tolist()
    figure, axes = row_panels(
        len(scenes), "Time per simulated second (s)", columns=2, row=2.3, sharey=True
    )
    handles: dict[str, list[Line2D]] = {}
    for ax, scene, text in zip(axes, scenes, "abcd", strict=False):
        ax.set(xscale="log", yscale="log")
        for method in map(str, dataset["solver"].values):
            entries = _draw_method(ax, method, dataset.sel(scene=scene, solver=method))
            if entries:
                handles[method] = entries
        ax.set(xlim=(1e-18, 300.0), xticks=10.0 ** np.arange(-15, 1, 3))
        ax.xaxis.set_minor_locator(NullLocator())
        ax.axvline(EDGE, color=GREY, linewidth=0.5)
        if (dataset["verdict"].sel(scene=scene) == WRONG_EVENTS).any():
            _name_wrong_events(ax)
        letter(ax, text, TEXTS["titles"][scene])
    for ax in figure.axes[-2:]:  # the lower row
        ax.set_xlabel("Event-time error (s)")
    shown = [handle for method in LINES for handle in handles.get(method, ())]
    figure.legend(handles=shown, loc="outside right center")
    return figure


def _draw_method(ax: Axes, method: str, line: xr.Dataset) -> list[Line2D]:
    """Draw the points of a method on a scene.

    Parameters
    ----------
    ax : the panel
    method : its name
    line : its points

    Returns
    -------
    list of matplotlib.lines.Line2D
        Entries of the legend, none if nothing is drawn.
    """
    look: Look = {**LINES[method], "markersize": 3.5}
    if look["marker"] == "*":
        look["markersize"] = 4.5
    error = line["event_error"].values
    cost = line["cost"].values
    verdict = line["verdict"].values
    right = np.isin(verdict, RIGHT_EVENTS)
    wrong = verdict == WRONG_EVENTS

    width: Look = {"linewidth": 0.9, "zorder": 2}
    if method == "series":
        width = {"linewidth": 1.6, "zorder": 3}
    ax.plot(error[right], cost[right], **width, **look)
    label = line["label"].item()
    entries = [Line2D([], [], **{**look, "markersize": 4, "label": label})]

    glue = line["glue"].values
    if np.isfinite(glue).any():
        without = (cost * (1.0 - glue))[right]
        dotted: Look = {"linewidth": 0.7, "linestyle": ":", "color": look["color"]}
        entries += ax.plot(error[right], without, label=f"{label}, without Python", **dotted)

    hollow = {**look, "linestyle": "", "markerfacecolor": "white", "markeredgewidth": 0.8}
    ax.plot(np.full(np.count_nonzero(wrong), WRONG_AT), cost[wrong], **hollow)
    return entries if (right | wrong).any() else []


def _name_wrong_events(ax: Axes) -> None:
    """Write what points at the right edge of a panel are."""
    ax.text(
        WRONG_AT,
        1.01,
        "wrong\nevents",
        transform=ax.get_xaxis_transform(),
        ha="center",
        va="bottom",
        fontsize=6,
        color=GREY,
        linespacing=0.9,
    )


# ---- How cost grows


def scaling(dataset: xr.Dataset) -> Figure:
    """Draw processor time of maps over their points, and of a point over modes and horizon."""
    rows = dataset.to_dataframe()
    rows["each"] = 1e3 * rows["seconds"] / rows["points"]
    figure, axes = panels(PAGE, 2.4, 1, 3)
    for ax, panel, text in zip(axes, TEXTS["scaling"], "abc", strict=True):
        varies, xlabel, shown, ylabel = panel
        for quantity, part in rows[rows["varies"] == varies].groupby("quantity"):
            name, offset = TEXTS["maps"][quantity]
            look = LINES[str(quantity)]
            x = part[varies]
            y = part[shown]
            ax.plot(x, y, markersize=3.5, **look)
            named = 2 * len(part) // 3
            say(ax, name, (x.iloc[named], y.iloc[named]), offset, color=look["color"])
        ax.margins(0.08)
        ax.set(xscale="log", yscale="log", xlabel=xlabel, ylabel=ylabel)
        low, _ = ax.get_ylim()
        ax.set_ylim(bottom=10.0 ** math.floor(math.log10(low)))
        ax.yaxis.set_minor_formatter(NullFormatter())
        letter(ax, text)
    return figure
