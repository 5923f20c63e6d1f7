"""Pictures of the whole disc: its deflection from above and along the slider's circle, a film, and its modes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.data.dataset import Missing
from disc_model.disc.plate import mode_arrays, mode_shapes, radial_range
from disc_model.figures.drawing import BLACK, DISC, GREY, SEPARATED, SLIDER, Axes, Figure, Normalize, cm, mpl
from disc_model.parameters import Parameters

if TYPE_CHECKING:
    from disc_model.simulation.states import State

Array = NDArray[np.float64]
RADII, ANGLES = 25, 181  # points across and around the disc at which it is drawn


class Motion(NamedTuple):
    """Motion of the disc and the slider through n states."""

    parameters: Parameters
    time: Array  # s
    amplitudes: NDArray[np.complex128]  # m sqrt(kg), cosine + i sine of the angle fixed to the disc, (n_modes, n)
    slider: Array  # rad, its angle on the disc
    u: Array  # m, its height
    phase: NDArray[np.str_]

    @classmethod
    def of(cls, p: Parameters, states: Sequence[State]) -> Motion:
        """The motion through states such as those of `disc_model.snapshots`."""
        time, psi, u = (np.array([getattr(state, name) for state in states]) for name in ("time", "psi", "u"))
        slider = p.Omega * time - psi
        shapes = np.transpose([state.a + 1j * state.b for state in states])
        turned = shapes * np.exp(1j * np.multiply.outer(mode_arrays(p).diameters, slider))
        return cls(p, time, turned, slider, u, np.array([state.phase for state in states]))

    def deflection(self, i: int, r: Array | None, theta: Array) -> Array:
        """Displacement at sample i, m, at radii (k,) and angles (m,): (k, m); without radii on the slider's circle."""
        modes = mode_arrays(self.parameters)
        shapes = modes.psi[:, None] if r is None else mode_shapes(self.parameters, r)
        turns = modes.diameters[:, None] * theta
        return np.asarray(shapes.T @ (self.amplitudes[:, i, None].conj() * np.exp(1j * turns)).real)


def scale_of(motion: Motion) -> Normalize:
    """Colour scale of the deflection, mm, equal at all times and centred on 0."""
    edge, theta = np.array([radial_range(motion.parameters)[1]]), np.linspace(0, 2 * np.pi, ANGLES)
    step = max(1, motion.time.size // 50)
    largest = max(float(np.abs(motion.deflection(i, edge, theta)).max()) for i in range(0, motion.time.size, step))
    if not largest > 0:
        raise Missing("did not move the disc")
    return mpl.colors.Normalize(-1e3 * largest, 1e3 * largest)


def colour_of(motion: Motion, i: int, otherwise: str = SLIDER) -> str:
    """Colour of the slider, or of words on it."""
    return SEPARATED if motion.phase[i] == "separation" else otherwise


def _plane(p: Parameters) -> tuple[Array, Array, Array, Array]:
    """Radii and angles of points of the disc, and their coordinates in mm, shape (radii, angles)."""
    r, theta = np.linspace(*radial_range(p), RADII), np.linspace(0, 2 * np.pi, ANGLES)
    return r, theta, 1e3 * r[:, None] * np.cos(theta), 1e3 * r[:, None] * np.sin(theta)


def _draw_plane(ax: Axes, p: Parameters, values: Array, scale: Normalize) -> Any:
    """Draw values over the disc from above, in mm; blue below the plane of the disc at rest, red above it."""
    r, _, x, y = _plane(p)
    mesh = ax.pcolormesh(x, y, values, cmap=cm.vik, norm=scale, shading="gouraud", rasterized=True)
    for radius, fill in ((r[0], "0.85"), (r[-1], "none")):
        ax.add_patch(mpl.patches.Circle((0, 0), 1e3 * radius, fc=fill, ec=GREY, lw=0.6, clip_on=radius == r[0]))
    ax.set_aspect("equal")
    ax.axis("off")
    return mesh


def draw_disc(ax: Axes, motion: Motion, i: int, scale: Normalize, levels: Sequence[float] = ()) -> Any:
    """Draw the disc from above, in mm, with the slider on it, and lines at levels in mm, dashed below zero."""
    p = motion.parameters
    r, theta, x, y = _plane(p)
    values = 1e3 * motion.deflection(i, r, theta)
    mesh = _draw_plane(ax, p, values, scale)
    if levels:
        ax.contour(x, y, values, levels, colors=BLACK, linewidths=0.5)
    angle = motion.slider[i]
    point = 1e3 * p.r_0 * np.array([np.cos(angle), np.sin(angle)])
    ax.plot(*point, "o", ms=5, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    # a tick at theta = 0, and an arrow in the direction of theta, in which the slider is dragged
    edge, middle = 1e3 * r[-1], 0.6 * 1e3 * r[0]
    ax.plot([edge, 1.07 * edge], [0, 0], color=BLACK, lw=0.8)
    arc = np.radians(np.linspace(-60, 60, 30))
    ax.plot(middle * np.cos(arc), middle * np.sin(arc), color=BLACK, lw=0.8)
    start, end = [(middle * np.cos(angle), middle * np.sin(angle)) for angle in np.radians([60, 75])]
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "lw": 0.8, "shrinkA": 0, "shrinkB": 0, "fc": BLACK})
    return mesh


def draw_circle(ax: Axes, motion: Motion, i: int, size: float, **look: Any) -> None:
    """Draw the disc along the circle of radius r_0 at an instant, with the slider as a mark of a size in points."""
    theta = np.linspace(0, 2 * np.pi, ANGLES)
    ax.plot(theta, 1e3 * motion.deflection(i, None, theta)[0], color=DISC, **look)
    angle, height = motion.slider[i] % (2 * np.pi), 1e3 * motion.u[i]
    ax.plot(angle, height, "s", ms=size, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    ax.set(xlabel="Angle θ (rad)", ylabel="Deflection at $r_0$ (mm)", xlim=(0, 2 * np.pi))


def draw_modes(axes: Sequence[Axes], p: Parameters, slider: bool = True) -> None:
    """Draw the shape of each mode from above, its nodal lines in black, and its frequency, by ascending frequency."""
    modes = mode_arrays(p)
    r, theta, x, y = _plane(p)
    shapes = mode_shapes(p, r)
    inside = r > r[0] + 0.02 * (r[-1] - r[0])  # a clamped edge is no nodal line
    for ax, i in zip(axes, np.argsort(modes.omega), strict=False):
        values = shapes[i, :, None] * np.cos(modes.diameters[i] * theta)
        largest = float(np.abs(values).max()) or 1.0
        _draw_plane(ax, p, values, mpl.colors.Normalize(-1.6 * largest, 1.6 * largest))
        if values[inside].min() < 0 < values[inside].max():
            ax.contour(x[inside], y[inside], values[inside], levels=[0.0], colors=BLACK, linewidths=0.9)
        if slider:
            ax.plot(1e3 * p.r_0, 0, "o", ms=3.5, mfc=SLIDER, mec=BLACK, mew=0.5)
        ax.set_title(f"({modes.diameters[i]}, {modes.circles[i]})  {modes.omega[i] / (2 * np.pi):.0f} Hz", loc="center")


def film(figure: Figure, motion: Motion, time: Array, force: Array) -> Any:
    """Make the film of disc, circle under the slider, and contact force (N) over the time (s) of the whole stretch."""
    figure.set_layout_engine("none")  # panels keep their places in all frames
    boxes = ((0.01, 0.05, 0.38, 0.9), (0.48, 0.62, 0.5, 0.29), (0.48, 0.13, 0.5, 0.29))
    disc, circle, trace = (figure.add_axes(box) for box in boxes)
    scale, begin = scale_of(motion), motion.time[0]

    def draw(i: int) -> list[Axes]:
        for ax in (disc, circle, trace):
            ax.cla()
        draw_disc(disc, motion, i, scale)
        draw_circle(circle, motion, i, 6)
        circle.set_ylim(scale.vmin, scale.vmax)
        now = motion.time[i]
        circle.set_title(f"{1e3 * (now - begin):.1f} ms, {motion.phase[i]}", color=colour_of(motion, i, BLACK))
        trace.plot(1e3 * (time - begin), force, color=GREY, lw=0.7)
        trace.plot(1e3 * (now - begin), np.interp(now, time, force), "o", ms=4, mfc=colour_of(motion, i), mec=BLACK)
        trace.set(xlabel="Time (ms)", ylabel="Contact force P (N)", xlim=1e3 * (time[[0, -1]] - begin))
        return [disc, circle, trace]

    return mpl.animation.FuncAnimation(figure, draw, frames=motion.time.size, blit=False)
