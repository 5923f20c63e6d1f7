"""The whole disc: its deflection at some instants, and as a film; an addition to the paper's figures.

A case records the disc at r_0 at some angles, in windows `around0`, `around1`, ... Modes without nodal circles are
harmonics of the angle. Twice their number and one of angles therefore determine each mode's amplitude, and the mode
shapes determine the rest.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import Field

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.disc.plate import mode_arrays, mode_shapes
from disc_model.figures import drawing
from disc_model.figures.drawing import (
    BLACK,
    DISC,
    GREY,
    PAGE,
    SEPARATED,
    SLIDER,
    Axes,
    Figure,
    Normalize,
    new_figure,
)
from disc_model.figures.kind import CasePlot, Need, as_samples
from disc_model.parameters import Parameters

Array = NDArray[np.float64]
RADII, ANGLES = 25, 181
"""Points across and around the disc at which it is drawn."""


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


class Motion(NamedTuple):
    """Motion of the disc and the slider in a stretch of time.

    Attributes
    ----------
    parameters : of the case
    time : s, shape (n,)
    amplitudes : m, at r_0, cosines + i sines of 0, 1, ... times the disc's angle, shape (harmonics, n)
    slider : rad, shape (n,), its angle on the disc
    u : m, shape (n,), its height
    phase : shape (n,), words of `disc_model.data.variables.PHASES`
    """

    parameters: Parameters
    time: Array
    amplitudes: NDArray[np.complex128]
    slider: Array
    u: Array
    phase: NDArray[np.str_]

    def deflection(self, i: int, r: Array, theta: Array) -> Array:
        """The disc's displacement at sample i, m, at radii (k,) in m and angles (m,) in rad: shape (k, m)."""
        shapes = mode_shapes(self.parameters, r) / mode_arrays(self.parameters).psi[:, None]
        turns = np.arange(len(self.amplitudes))[:, None] * theta
        return np.asarray(shapes.T @ (self.amplitudes[:, i, None].conj() * np.exp(1j * turns)).real)


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
    found = np.linalg.lstsq(np.hstack([np.cos(turns), np.sin(turns)[:, 1:]]), values, rcond=None)[0]
    amplitudes = found[: len(harmonics)].astype(complex)
    amplitudes[1:] += 1j * found[len(harmonics) :]
    time, psi, u = (windows[0][name].values for name in ("time", "psi", "u"))
    return Motion(p, time, amplitudes, p.Omega * time - psi, u, flag_names(windows[0]["phase"]))


def scale_of(motion: Motion) -> Normalize:
    """Colour scale of the deflection, mm, equal at all times and centred on 0."""
    from matplotlib.colors import Normalize

    edge, theta = np.array([motion.parameters.b]), np.linspace(0, 2 * np.pi, ANGLES)
    step = max(1, motion.time.size // 50)
    largest = max(float(np.abs(motion.deflection(i, edge, theta)).max()) for i in range(0, motion.time.size, step))
    if not largest > 0:
        raise Missing("did not move in around0")
    return Normalize(-1e3 * largest, 1e3 * largest)


def colour_of(motion: Motion, i: int, otherwise: str = SLIDER) -> str:
    """Colour of the slider, or of words on it."""
    return SEPARATED if motion.phase[i] == "separation" else otherwise


def draw_disc(ax: Axes, motion: Motion, i: int, scale: Normalize) -> Any:
    """Draw the disc from above, in mm, with the slider on it."""
    from cmcrameri.cm import vik
    from matplotlib.patches import Circle

    p = motion.parameters
    r, theta = np.linspace(p.a, p.b, RADII), np.linspace(0, 2 * np.pi, ANGLES)
    x, y = (1e3 * r[:, None] * turn(theta) for turn in (np.cos, np.sin))
    values = 1e3 * motion.deflection(i, r, theta)
    # blue below the plane of the disc at rest, red above it
    mesh = ax.pcolormesh(x, y, values, cmap=vik, norm=scale, shading="gouraud", rasterized=True)
    ax.add_patch(Circle((0, 0), 1e3 * p.a, fc="0.85", ec=GREY, lw=0.6))
    ax.add_patch(Circle((0, 0), 1e3 * p.b, fc="none", ec=GREY, lw=0.6, clip_on=False))
    angle = motion.slider[i]
    place = 1e3 * p.r_0 * np.array([np.cos(angle), np.sin(angle)])
    ax.plot(*place, "o", ms=5, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    # a tick at theta = 0, and an arrow in the direction of theta, in which the slider is dragged
    edge, middle = 1e3 * p.b, 0.6 * 1e3 * p.a
    ax.plot([edge, 1.07 * edge], [0, 0], color=BLACK, lw=0.8)
    arc = np.radians(np.linspace(-60, 60, 30))
    ax.plot(middle * np.cos(arc), middle * np.sin(arc), color=BLACK, lw=0.8)
    start, end = [(middle * np.cos(angle), middle * np.sin(angle)) for angle in np.radians([60, 75])]
    look = {"arrowstyle": "-|>", "lw": 0.8, "shrinkA": 0, "shrinkB": 0, "fc": BLACK}
    ax.annotate("", end, start, arrowprops=look)
    ax.set_aspect("equal")
    ax.axis("off")
    return mesh


def draw_circle(ax: Axes, motion: Motion, i: int, size: float, **look: Any) -> None:
    """Draw the disc along the circle of radius r_0 at an instant, with the slider as a mark of a size in points."""
    theta = np.linspace(0, 2 * np.pi, ANGLES)
    along = 1e3 * motion.deflection(i, np.array([motion.parameters.r_0]), theta)[0]
    ax.plot(theta, along, color=DISC, **look)
    angle, height = motion.slider[i] % (2 * np.pi), 1e3 * motion.u[i]
    ax.plot(angle, height, "s", ms=size, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    ax.set(xlabel="Angle θ (rad)", ylabel="Deflection at $r_0$ (mm)", xlim=(0, 2 * np.pi))
