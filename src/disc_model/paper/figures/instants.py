"""The whole disc: its deflection at some instants, and as a film; an addition to the paper's figures.

A case records the disc at r_0 at some angles, in windows `around0`, `around1`, ... Modes without nodal circles are
harmonics of the angle. Twice their number and one of angles therefore determine each mode's amplitude, and the mode
shapes determine the rest.
"""

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.disc.plate import mode_arrays
from disc_model.figures import drawing
from disc_model.figures.disc import Motion, draw_circle, draw_disc, scale_of
from disc_model.figures.drawing import BLACK, PAGE, SEPARATED, SLIDER, Figure, new_figure
from disc_model.figures.kind import CasePlot, Need, as_samples
from disc_model.parameters import Parameters


class Instants(CasePlot):
    """The disc from above at four instants, and along its circle of radius r_0.

    They are equidistant from the first loss of contact to the next, or over the whole stretch without two losses.

    around : number of the windows `around0`, ...
    """

    kind: Literal["paper.instants"] = "paper.instants"
    around: Annotated[int, Field(ge=1)] = 9

    def needs(self) -> Iterator[Need]:
        for i in range(self.around):
            yield Need("around", self.case, f"around{i}", [as_samples])

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure = new_figure(PAGE, 4.2)
        above, around = np.asarray(figure.subfigures(2, 1, height_ratios=(1.15, 1)))
        discs = above.subplots(1, 4)
        circle = around.subplots()
        motion = motion_of(cases[0])
        losses = [first for first, _ in drawing.stretches(motion.phase == "separation") if first > 0]
        first, last = losses[:2] if len(losses) > 1 else (0, motion.time.size - 1)
        scale = scale_of(motion)
        for j, (ax, style) in enumerate(zip(discs, ("-", "--", "-.", ":"), strict=True)):
            i = first + j * (last - first) // len(discs)
            mesh = draw_disc(ax, motion, i, scale)
            after = f"{1e3 * (motion.time[i] - motion.time[first]):.1f} ms"
            ax.set_title(f"({'abcd'[j]}) {after}, {motion.phase[i]}")
            draw_circle(circle, motion, i, 5, linestyle=style, label=f"disc, {after}")
        bar = above.colorbar(mesh, ax=list(discs), pad=0.01, aspect=20, fraction=0.04, label="Deflection (mm)")
        bar.outline.set_visible(False)
        circle.plot([], [], "s", ms=5, mfc=SLIDER, mec=BLACK, mew=0.6, label="slider")
        circle.plot([], [], "s", ms=5, mfc=SEPARATED, mec=BLACK, mew=0.6, label="slider, separated")
        circle.margins(y=0.08)
        circle.legend(loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2, ncols=6)
        circle.set_title("(e)", loc="left", x=-0.06)
        return figure


def motion_of(case: xr.DataTree) -> Motion:
    """The motion of disc and slider from the windows `around0`, ...; raises `Missing`."""
    p = Parameters.model_validate_json(case.attrs["parameters"])
    count = sum(str(name).startswith("around") for name in case.children)
    windows = [dataset.samples(case, f"around{j}", at_least=1) for j in range(count or 1)]
    harmonics = np.arange(p.n_diameters + 1)
    if p.n_circles:
        raise Missing("has modes with nodal circles, which a circle of points does not tell apart")
    if len(windows) < 2 * len(harmonics) - 1:
        raise Missing(f"recorded the disc at {len(windows)} angles, {2 * len(harmonics) - 1} are needed")
    if any(not np.array_equal(window["time"].values, windows[0]["time"].values) for window in windows):
        raise Missing("recorded the disc at other times at other angles")
    angles = np.array([window.attrs["theta"] for window in windows])
    turns = harmonics * angles[:, None]
    values = np.array([window["w_point"].values for window in windows])
    solution = np.linalg.lstsq(np.hstack([np.cos(turns), np.sin(turns)[:, 1:]]), values, rcond=None)[0]
    at_slider = solution[: len(harmonics)].astype(complex)
    at_slider[1:] += 1j * solution[len(harmonics) :]
    amplitudes = at_slider / mode_arrays(p).psi[:, None]
    time, psi, u = (windows[0][name].values for name in ("time", "psi", "u"))
    return Motion(p, time, amplitudes, p.Omega * time - psi, u, flag_names(windows[0]["phase"]))
