"""Films of the whole disc: from above, along the slider's circle, and the contact force."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation, writers

from disc_model.errors import require
from disc_model.figures.disc import Motion, colour_of, draw_circle, draw_disc, scale_of
from disc_model.figures.drawing import BLACK, GREY, wide
from disc_model.figures.style import styled
from disc_model.figures.types import Array, Axes, Figure
from disc_model.parameters import Parameters
from disc_model.units import is_number

LEVELS = (-2 / 3, -1 / 3, 1 / 3, 2 / 3)
"""Deflections that lines on the disc are at, over the greatest; grey print does not show their sign, which
dashes do."""


def film(figure: Figure, motion: Motion, time: Array, force: Array) -> FuncAnimation:
    """Make the film of disc, circle under the slider, and contact force (N) over the time (s) of
    the whole stretch."""
    disc = figure.add_axes((0.01, 0.05, 0.38, 0.9))
    circle = figure.add_axes((0.48, 0.62, 0.5, 0.29))
    trace = figure.add_axes((0.48, 0.13, 0.5, 0.29))
    scale = scale_of(motion)
    levels = [share * (scale.vmax or 0.0) for share in LEVELS]
    begin = motion.time[0]

    def draw(i: int) -> list[Axes]:
        for ax in (disc, circle, trace):
            ax.cla()
        draw_disc(disc, motion, i, scale, levels)

        draw_circle(circle, motion, i, 6)
        circle.set_ylim(scale.vmin, scale.vmax)
        now = motion.time[i]
        words = f"{1e3 * (now - begin):.1f} ms, {motion.phase[i]}"
        circle.set_title(words, color=colour_of(motion, i, BLACK))

        trace.plot(1e3 * (time - begin), force, color=GREY, lw=wide(0.7))
        trace.plot(
            1e3 * (now - begin),
            np.interp(now, time, force),
            "o",
            ms=4,
            mfc=colour_of(motion, i),
            mec=BLACK,
        )
        trace.set_xlabel("Time (ms)")
        trace.set_ylabel("Contact force P (N)")
        trace.set_xlim(1e3 * (time[[0, -1]] - begin))
        return [disc, circle, trace]

    return FuncAnimation(figure, draw, frames=motion.time.size, blit=False)


def animate(
    p: Parameters, states: Sequence[Any], window: xr.Dataset, path: str | Path | None, fps: int
) -> FuncAnimation:
    """Make a film of disc, slider and contact force through states; written to a path if there is
    one."""
    writer = film_writer(path, fps)
    with styled():
        figure = Figure(figsize=(6.4, 2.7))
        motion = Motion.of(p, states)
        made = film(figure, motion, window["time"].values, window["P"].values)
        if path is not None:
            made.save(path, writer=writer, fps=fps, dpi=100)
        return made


def film_writer(path: str | Path | None, fps: int) -> str:
    """The program that writes a film to a path, "" without a path; raises `ParameterError` if none
    can, or `fps` is no number of pictures in a second."""
    file = Path(path) if isinstance(path, str | Path) else Path()
    writer = {".gif": "pillow", ".mp4": "ffmpeg"}.get(file.suffix, "")
    suffix = "must end in .gif or .mp4; a window is given by window="
    available = not writer or writers.is_available(writer)
    require(
        (is_number(fps) and fps > 0, "fps", fps, "must be a number > 0"),
        (path is None or writer, "path", str(path), suffix),
        (file.absolute().parent.is_dir(), "path", str(path), "must be in a folder that exists"),
        (available, "path", str(path), f"needs the program {writer}"),
    )
    return writer
