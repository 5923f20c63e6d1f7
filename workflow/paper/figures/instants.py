"""The whole disc at four instants, made from windows at nine angles."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.disc import Motion, draw_circle, draw_disc, scale_of
from disc_model.figures.drawing import BLACK, PAGE, SEPARATED, SLIDER, new_figure, sample
from disc_model.figures.legends import figure_legend
from disc_model.figures.runs import show_thickness
from disc_model.figures.selection import stretches
from disc_model.figures.types import Axes, Figure
from workflow.paper.figures.kinds import Instants
from workflow.paper.figures.motion_around import motion_of

LEVELS = (-0.75, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 0.75)
"""Of contour lines, over the largest deflection."""
STYLES = ("-", "--", "-.", ":")


def draw(plot: Instants, case: xr.DataTree) -> Figure:
    """Draw the disc from above, and along the slider's circle."""
    motion = motion_of(case)
    width = plot.inches
    figure = new_figure(width, 4.2 if width == PAGE else 6.4)
    above, around = np.asarray(figure.subfigures(2, 1, height_ratios=(1.15, 1)))
    discs = list(np.ravel(above.subplots(1, 4) if width == PAGE else above.subplots(2, 2)))
    circle = around.subplots()
    mesh = _draw_instants(discs, circle, motion)
    bar = above.colorbar(
        mesh, ax=discs, pad=0.01, aspect=20, fraction=0.04, label="Deflection (mm)"
    )
    bar.outline.set_visible(False)
    look: dict[str, Any] = {"marker": "s", "ls": "", "ms": 5, "mec": BLACK, "mew": 0.6}
    circle.margins(y=0.08)
    show_thickness(circle, case, "y")
    p = motion.parameters
    circle.set_title(f"(e) at {p.N:g} N, {p.Omega:g} rad/s", loc="left", x=-0.06)
    handles = [*circle.get_legend_handles_labels()[0]]
    handles.append(sample(mfc=SLIDER, label="slider", **look))
    handles.append(sample(mfc=SEPARATED, label="slider, separated", **look))
    figure_legend(around, handles, loc="outside upper right", handlelength=1.8)
    return figure


def _draw_instants(discs: list[Axes], circle: Axes, motion: Motion) -> object:
    """Draw four instants from the first loss of contact to the next, or over the whole stretch;
    returns what has the colours."""
    apart = motion.phase == "separation"
    losses = [first for first, _ in stretches(apart) if first > 0]
    first, last = losses[:2] if len(losses) > 1 else (0, motion.time.size - 1)
    scale = scale_of(motion)
    levels = [share * (scale.vmax or 0.0) for share in LEVELS]
    mesh = None
    for j, (ax, style) in enumerate(zip(discs, STYLES, strict=True)):
        i = first + j * (last - first) // len(discs)
        mesh = draw_disc(ax, motion, i, scale, levels)
        time = f"{1e3 * (motion.time[i] - motion.time[first]):.1f} ms"
        ax.set_title(f"({'abcd'[j]}) {time}, {motion.phase[i]}")
        draw_circle(circle, motion, i, 5, linestyle=style, label=f"disc, {time}")
    return mesh
