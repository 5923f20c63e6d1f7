"""The whole disc at four instants, made from windows at nine angles."""

import json
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import flag_names
from disc_model.disc.plate import modes_at_point
from disc_model.figures.disc import Motion, draw_circle, draw_disc, scale_of
from disc_model.figures.drawing import BLACK, PAGE, SEPARATED, SLIDER, new_figure, sample
from disc_model.figures.legends import figure_legend
from disc_model.figures.runs import show_thickness
from disc_model.figures.selection import stretches
from disc_model.figures.stated_case import parameters_of
from disc_model.figures.types import Array, Axes, ComplexArray, Figure, Indices
from disc_model.paper.figures.kinds import Instants
from disc_model.simulation.case import Ramp, angle_of_drive, pieces

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


def motion_of(case: xr.DataTree) -> Motion:
    """The motion of disc and slider from windows `around0`, ... of the disc at r_0 and as many
    angles as determine the harmonics that modes without nodal circles are; raises `Missing` if they
    do not."""
    p = parameters_of(case)
    harmonics = np.arange(p.n_diameters + 1)
    count = 2 * len(harmonics) - 1
    windows = [dataset.samples(case, f"around{j}", at_least=1) for j in range(count)]
    if p.n_circles:
        raise dataset.Missing(
            "has modes with nodal circles, which a circle of points does not tell apart"
        )
    time, psi, u = (windows[0][name].values for name in ("time", "psi", "u"))
    if any(not np.array_equal(window["time"].values, time) for window in windows):
        raise dataset.Missing("recorded the disc at other times at other angles")

    # harmonics at each instant, by least squares
    angles = np.array([window.attrs["theta"] for window in windows])
    values = np.array([window["w_point"].values for window in windows])
    solution = _harmonics(angles, harmonics, values)
    amplitudes = solution / modes_at_point(p).psi[:, None]
    ramps = [Ramp(**ramp) for ramp in json.loads(case.attrs.get("ramps", "[]"))]
    intervals = pieces(p, ramps)
    drive = np.array([angle_of_drive(intervals, t) for t in time])
    slider = drive - psi
    return Motion(p, time, amplitudes, slider, u, flag_names(windows[0]["phase"]))


def _harmonics(angles: Array, orders: Indices, values: Array) -> ComplexArray:
    """Cosine + i sine of the harmonics of some orders in values at angles, shape (angles, n):
    (orders, n)."""
    turns = orders * angles[:, None]
    terms = np.hstack([np.cos(turns), np.sin(turns)[:, 1:]])
    found = np.linalg.lstsq(terms, values, rcond=None)[0]
    solution = found[: len(orders)].astype(complex)
    solution[1:] += 1j * found[len(orders) :]
    return solution
