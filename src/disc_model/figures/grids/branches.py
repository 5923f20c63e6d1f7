"""Continuation diagrams: the range of motion on all cycles against one parameter, and where a sweep jumps."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.kinds import Branches
from disc_model.figures.parts import BLACK, GREY, PAGE, SEPARATED, new_figure

JUMP = 10.0
"""Factor by which the range changes between two values of a sweep at a jump."""
STEP = 2.5
"""Factor between two points of a branch that no line joins: the branch may bend between them."""
LOWEST = 1e-3
"""Least range that is distinguished from rest, mm."""
THIN = 0.7
"""Width of lines of unstable motions; dashes of two branches that nearly meet would look like a whole line."""
MARK: dict[str, Any] = {"markersize": 2.5, "markerfacecolor": "white", "markeredgewidth": 0.5}
"""Look of the marks of a sweep."""


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: Branches) -> Figure:
    """Draw one point: a line for each branch, thick where it is stable, and triangles for the sweep up and down."""
    study = study.squeeze()
    name = str(json.loads(study.attrs["options"])["parameter"])
    label, factor = parts.axis_of(name)
    figure = new_figure(PAGE, 3.6)
    ax = figure.subplots()
    ax.set_yscale("log")
    for i in range(int(study["n_branches"])):
        one = study.isel(branch=i)
        _branch(ax, one["value"].values * factor, 1e3 * one["range"].values, one["growth_rate"].values < 0,
                SEPARATED if one["separations"] > 0 else BLACK)  # fmt: skip
    along = study["sweep_value"].values * factor
    for way, mark in enumerate("^v"):
        _sweep(ax, along, 1e3 * study["sweep_range"].values[way], study["sweep_separation_rate"].values[way] > 0, mark)
    unstable = study["sliding_growth_rate"].values > 0
    phrase = "unstable" if unstable.all() else "stable" if not unstable.any() else "stable where the line is thick"
    _branch(ax, along, np.full(along.size, LOWEST), ~unstable, GREY)
    parts.say(ax, f"steady sliding: {phrase}", (along[-1], LOWEST), (-4, 3), fontsize=7, color=GREY)
    for case, value in plot.paper_cases.items():
        ax.axvline(value * factor, color=BLACK, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
        side = -1 if value == min(plot.paper_cases.values()) else 1
        parts.say(ax, case, (value * factor, 0.06), (3 * side, 0), xycoords=("data", "axes fraction"), fontsize=7)
    ax.set(
        xlabel=label, ylabel="Range of the slider's height (mm)", xlim=(along[0], along[-1]), ylim=(LOWEST * 0.8, None)
    )
    for color, text in ((BLACK, "in contact"), (SEPARATED, "separating")):
        ax.plot([], [], color=color, linewidth=2, label=f"stable cycle, {text}")
    ax.plot([], [], color=BLACK, linewidth=THIN, label="unstable cycle")
    for mark, color, text in (("^", BLACK, "rising"), ("v", BLACK, "falling"), ("^", SEPARATED, "separating")):
        ax.plot([], [], mark, color=color, label=f"simulated, {text}", **MARK)
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def _branch(ax: Axes, x: np.ndarray, y: np.ndarray, stable: np.ndarray, color: str) -> None:
    there = np.isfinite(x)
    x, y, stable = x[there], y[there], stable[there]
    along, height = parts.broken(x, np.log(y), np.log(STEP))
    ax.plot(along, np.exp(height), color=color, linewidth=THIN)
    # a segment is stable where both its ends are
    for first, last in parts.stretches(stable[:-1] & stable[1:]):
        ax.plot(x[first : last + 1], y[first : last + 1], color=color, linewidth=2.0, solid_capstyle="butt")


def _sweep(ax: Axes, x: np.ndarray, y: np.ndarray, separates: np.ndarray, mark: str) -> None:
    """Draw the marks of a sweep, and an arrow at each jump."""
    shown = np.maximum(y, LOWEST)
    for at, color in ((~separates, BLACK), (separates, SEPARATED)):
        ax.plot(x[at], shown[at], mark, color=color, clip_on=False, **MARK)
    order = slice(None) if mark == "^" else slice(None, None, -1)
    x, y = x[order], shown[order]
    for i in np.flatnonzero(np.abs(np.log(y[1:] / y[:-1])) > np.log(JUMP)):
        ax.annotate("", (x[i + 1], y[i + 1]), (x[i], y[i]), arrowprops={"arrowstyle": "->", "color": GREY, "lw": 1.0})
