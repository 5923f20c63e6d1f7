"""What happens, at a glance: the model, the disc's vibration, and the contact force."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.figures.drawing import (
    BLACK,
    DISC,
    FORCE,
    PAGE,
    PHASE_COLOURS,
    SEPARATED,
    SLIDER,
    halo,
    large,
    letters,
    panels,
    say,
    wide,
)
from disc_model.figures.legends import legend_above
from disc_model.figures.runs import envelope, show_thickness, spans_between
from disc_model.figures.selection import history
from disc_model.figures.types import Axes, Figure
from workflow.paper.figures.kinds import STRETCH, Composite
from workflow.paper.figures.strokes import DARK, SPRING, arrow, join, slider, wall

PALE = "0.72"  # of ignored separation
PHASES: dict[str, dict[str, Any]] = {
    "stick": {"facecolor": "none", "edgecolor": PHASE_COLOURS["stick"], "hatch": "//////"},
    "separation": {"facecolor": PHASE_COLOURS["separation"], "alpha": 0.35},
}
"""Looks of phases, which differ in grey print as well; slip is white."""


def draw(plot: Composite, case: xr.DataTree, bilateral: xr.DataTree) -> Figure:
    """Draw the three panels."""
    width = plot.inches
    if width == PAGE:
        figure, axes = panels(width, 2.35, 1, 3, width_ratios=(1, 1.15, 1.3))
    else:
        figure, axes = panels(width, 6.6, 3)
    model, growth, force = axes
    _draw_model(model)
    _draw_growth(growth, plot, case, bilateral)
    _draw_force(force, plot, case)
    letters(axes)
    return figure


def _draw_growth(ax: Axes, plot: Composite, case: xr.DataTree, bilateral: xr.DataTree) -> None:
    """Draw the range of the disc with separation over that without."""
    followed = history(case, plot.history, plot.until)
    ignored = history(bilateral, plot.history, plot.until)
    envelope(ax, ignored, "w_point", color=PALE)
    envelope(ax, followed, "w_point")
    top = 1e3 * float(ignored["w_point_max"].max()) or 1.0
    right = 0.98 * ax.get_xlim()[1]
    bold: dict[str, Any] = {"ha": "right", "fontsize": large(7), "fontweight": "bold"}
    ax.text(right, 1.08 * top, "separation ignored", color="0.35", **bold)
    ax.text(right, -0.05 * top, "with separation", color="white", **bold)
    ax.set_xlabel("Time (s)")
    ax.set_ylabel("Displacement of the disc (mm)")
    ax.set_ylim(-1.25 * top, 1.25 * top)
    lost = float(case["first_separation"])
    if lost <= ax.get_xlim()[1]:
        look: dict[str, Any] = {"color": SEPARATED, "path_effects": halo(2.5)}
        ax.axvline(lost, ymax=0.88, linewidth=wide(0.9), linestyle=(0, (4, 2)), **look)
        place = (lost, -1.2 * top)
        say(ax, "contact\nis lost", place, (-3, 1), fontsize=large(7), **look)
    show_thickness(ax, case, "y")


def _draw_force(ax: Axes, plot: Composite, case: xr.DataTree) -> None:
    """Draw the contact force over stick and separation, whose borders are events."""
    name, start = plot.force
    part = dataset.samples(case, name).sel(time=slice(start, start + STRETCH))
    if part.sizes["time"] < 2:
        raise Missing(f"has no samples from {start:g} s on")
    spans = spans_between(case, start, start + STRETCH)
    for phase, look in PHASES.items():
        label = phase
        for begin, end in spans[phase]:
            left = 1e3 * (begin - start)
            right = 1e3 * (end - start)
            ax.axvspan(left, right, label=label, linewidth=0, **look)
            label = "_nolegend_"
    # zero, and not drawn, in separation, since no line leads to the force after an impact
    touches = flag_names(part["phase"]) != "separation"
    time = 1e3 * (part["time"].values - start)
    ax.plot(time, part["P"].where(touches), color=BLACK, linewidth=wide(1.1))
    ax.set_xlabel(f"Time after {start:g} s (ms)")
    ax.set_ylabel("Contact force (N)")
    ax.set_xlim((0, 1e3 * STRETCH))
    ax.set_ylim(bottom=0)
    if ax.patches:
        legend_above(ax)


def _draw_model(ax: Axes) -> None:
    """Draw the model from the side with the fewest words."""
    x = np.linspace(-2.0, 2.6, 200)
    wave = 0.2 * np.sin(1.6 * x + 0.5) - 0.1
    ax.plot(x, wave, color=DISC, lw=3)
    ax.text(-2.0, -0.75, "elastic disc", color=DISC, fontsize=7)
    slider(ax, (-0.55, 0.15), 1.1, 0.45, lw=1.2)
    ax.text(0, 0.375, "slider", ha="center", va="center", fontsize=7)
    wall(ax, (-0.6, 1.6), (0.6, 1.6), (0.12, 0.14))
    join(ax, SPRING, (0, 0.6), (0, 1.6))
    arrow(ax, (0, 2.35), (0, 1.8))
    ax.text(0.15, 2.1, "preload", fontsize=7)
    wall(ax, (1.8, 0.05), (1.8, 0.65), (0.13, 0.12))
    join(ax, SPRING, (0.55, 0.375), (1.8, 0.375))
    arrow(ax, (1.85, 0.95), (2.6, 0.95))
    ax.text(2.6, 1.08, "drive", ha="right", fontsize=7)
    arrow(ax, (-0.65, 0.22), (-1.45, 0.22), colour=FORCE)
    ax.text(-2.0, 0.38, "friction", color=FORCE, fontsize=7)
    arrow(ax, (-0.8, 0.8), (-0.8, 1.35), style="<|-|>", colour=SLIDER)
    ax.text(-0.95, 1.07, "bounces", ha="right", va="center", color=DARK, fontsize=7)
    arrow(ax, (0.4, 0.8), (1.2, 0.8), style="<|-|>", colour=SLIDER)
    ax.text(0.8, 0.95, "sticks,\nslips", ha="center", color=DARK, fontsize=7)
    ax.set_xlim((-2.1, 2.7))
    ax.set_ylim((-0.95, 2.5))
    ax.set_box_aspect(1.05)
    ax.axis("off")
