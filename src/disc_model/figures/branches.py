"""Continuation diagrams: the range of motion on all cycles against one parameter, and where a sweep jumps."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, GREY, PAGE, SEPARATED, Axes, Figure, panels
from disc_model.figures.kind import Plot
from disc_model.units import Finite

LOWEST = 1e-3
"""Least range that is distinguished from rest, mm."""
THIN = 0.7
"""Width of lines of unstable motions; dashes of two branches that nearly meet would look like a whole line."""
BENDS = 2.5
"""Factor between the heights of neighbouring points beyond which a branch may bend between them."""
MARK: dict[str, Any] = {"markersize": 2.5, "markerfacecolor": "white", "markeredgewidth": 0.5}
"""Look of the marks of a sweep."""
UNSETTLED = "#aaaaaa"
"""Colour of its marks where it is not shown that the motion has settled."""


class Branches(Plot):
    """Range of motion of all cycles found against one parameter, stable and unstable, and where a sweep jumps.

    paper_cases : cases of the paper by name, each with its value of the parameter
    """

    quantities = ("branches",)

    kind: Literal["branches"] = "branches"
    paper_cases: dict[str, Finite] = Field({})

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one point: a line for each branch, thick where it is stable, and triangles for the sweep up and down."""
        from matplotlib.legend_handler import HandlerTuple

        study = study.squeeze()
        name = str(stated_in(study, "options")["parameter"])
        label, factor = drawing.axis_of(name)
        figure, [ax] = panels(PAGE, 3.6)
        ax.set_yscale("log")
        for i in range(int(study["n_branches"])):
            branch_data = study.isel(branch=i)
            height, color = 1e3 * branch_data["range"].values, SEPARATED if branch_data["separations"] > 0 else BLACK
            draw_branch(
                ax, branch_data["value"].values * factor, height, branch_data["growth_rate"].values < 0, color, BENDS
            )
        along = study["sweep_value"].values * factor
        for way, mark in enumerate("^v"):
            heights, separates = 1e3 * study["sweep_range"].values[way], study["sweep_separation_rate"].values[way] > 0
            settled = flag_names(study["sweep_settled"])[way] == "settled"
            _swept(ax, along, heights, separates, settled, mark)
        unstable = study["sliding_growth_rate"].values > 0
        phrase = "unstable" if unstable.all() else "stable" if not unstable.any() else "stable where the line is thick"
        draw_branch(ax, along, np.full(along.size, LOWEST), ~unstable, GREY)
        drawing.say(ax, f"steady sliding: {phrase}", (along[-1], LOWEST), (-4, 3), fontsize=7, color=GREY)
        drawing.mark_cases([ax], {case: value * factor for case, value in self.paper_cases.items()}, 0.05)
        ax.set(
            xlabel=label,
            ylabel="Range of the slider's height (mm)",
            xlim=(along[0], along[-1]),
            ylim=(LOWEST * 0.8, None),
        )
        for color, text in ((BLACK, "in contact"), (SEPARATED, "separating")):
            ax.plot([], [], color=color, linewidth=2, label=f"stable cycle, {text}")
        ax.plot([], [], color=BLACK, linewidth=THIN, label="unstable cycle")
        handles, labels = ax.get_legend_handles_labels()
        (rising, falling), both, pale = (
            [drawing.sample(linestyle="", marker=way, color=color, **MARK) for way in "^v"]
            for color in (BLACK, SEPARATED, UNSETTLED)
        )
        simulated: dict[str, Any] = {"rising": rising, "falling": falling, "separating": tuple(both)}
        swept = np.isfinite(study["sweep_range"].values)
        if (flag_names(study["sweep_settled"])[swept] != "settled").any():
            simulated["not settled, or undecided"] = tuple(pale)
        handles += simulated.values()
        labels += [f"simulated, {text}" for text in simulated]
        figure.legend(handles, labels, loc="outside lower center", ncols=3, handler_map={tuple: HandlerTuple(None)})
        return figure


def draw_branch(ax: Axes, x: np.ndarray, y: np.ndarray, stable: np.ndarray, color: str, factor: float = np.inf) -> None:
    """Draw a line along a branch, thick where it is stable, with gaps where its height jumps by more than a factor."""
    known = np.isfinite(x)
    x, y, stable = x[known], y[known], stable[known]
    along, height = (x, y) if factor == np.inf else drawing.broken(x, np.log(y), np.log(factor))
    ax.plot(along, height if factor == np.inf else np.exp(height), color=color, linewidth=THIN)
    # a segment is stable where both its ends are
    for first, last in drawing.stretches(stable[:-1] & stable[1:]):
        ax.plot(x[first : last + 1], y[first : last + 1], color=color, linewidth=2.0, solid_capstyle="butt")


def _swept(ax: Axes, x: np.ndarray, y: np.ndarray, separates: np.ndarray, settled: np.ndarray, mark: str) -> None:
    """Draw the marks of a sweep, and an arrow at each jump, by a factor of more than 10."""
    shown = np.maximum(y, LOWEST)
    for mask, color in ((settled & ~separates, BLACK), (settled & separates, SEPARATED), (~settled, UNSETTLED)):
        ax.plot(x[mask], shown[mask], mark, color=color, clip_on=False, **MARK)
    order = slice(None) if mark == "^" else slice(None, None, -1)
    x, y = x[order], shown[order]
    for i in np.flatnonzero(np.abs(np.log(y[1:] / y[:-1])) > np.log(10)):
        ax.annotate("", (x[i + 1], y[i + 1]), (x[i], y[i]), arrowprops={"arrowstyle": "->", "color": GREY, "lw": 1.0})
