"""The whole disc: its deflection from above, and along the slider's circle."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

import numpy as np
from cmcrameri import cm
from matplotlib.colors import Normalize
from matplotlib.patches import Circle

from disc_model.data.dataset import Missing
from disc_model.disc.plate import mode_arrays, mode_shapes, modes_at_point, radial_range
from disc_model.figures.drawing import BLACK, DISC, GREY, SEPARATED, SLIDER, wide
from disc_model.figures.types import Array, Axes, ComplexArray, Words
from disc_model.parameters import Parameters

RADII = 25  # points across the disc at which it is drawn
ANGLES = 181  # points around it
SCALED = 50  # instants at most by which the colour scale is chosen


class Motion(NamedTuple):
    """Motion of the disc and the slider through n states.

    parameters : of the case
    time : s, shape (n,)
    amplitudes : m sqrt(kg), cosine + i sine of the angle fixed to the disc, shape (n_modes, n)
    slider : rad, angle on the disc of the material under it, shape (n,)
    u : m, its height, shape (n,)
    phase : shape (n,)
    """

    parameters: Parameters
    time: Array
    amplitudes: ComplexArray
    slider: Array
    u: Array
    phase: Words

    @classmethod
    def of(cls, p: Parameters, states: Sequence[Any]) -> Self:
        """The motion through states such as those of `disc_model.snapshots`."""
        time = np.array([state.time for state in states])
        u = np.array([state.u for state in states])
        phase = np.array([state.phase for state in states])
        slider = np.array([state.material_angle(p) for state in states])
        shapes = np.transpose([state.a + 1j * state.b for state in states])
        turned = shapes * np.exp(1j * np.multiply.outer(mode_arrays(p).diameters, slider))
        return cls(p, time, turned, slider, u, phase)

    def deflection(self, i: int, r: Array | None, theta: Array) -> Array:
        """Displacement at sample i, m, at radii (k,) and angles (m,): (k, m); without radii on the
        slider's circle."""
        modes = modes_at_point(self.parameters)
        shapes = modes.psi[:, None] if r is None else mode_shapes(self.parameters, r)
        turns = modes.diameters[:, None] * theta
        around = self.amplitudes[:, i, None].conj() * np.exp(1j * turns)
        return np.asarray(shapes.T @ around.real)


class Plane(NamedTuple):
    """Points of the disc at which it is drawn: radii (m) and angles (rad), and their coordinates in
    mm, shape (radii, angles)."""

    r: Array
    theta: Array
    x: Array
    y: Array


def plane_of(p: Parameters) -> Plane:
    """Points over the disc of a case."""
    r = np.linspace(*radial_range(p), RADII)
    theta = np.linspace(0, 2 * np.pi, ANGLES)
    x = 1e3 * r[:, None] * np.cos(theta)
    y = 1e3 * r[:, None] * np.sin(theta)
    return Plane(r, theta, x, y)


def scale_of(motion: Motion) -> Normalize:
    """Colour scale of the deflection, mm, equal at all times and centred on 0."""
    edge = np.array([radial_range(motion.parameters)[1]])
    theta = np.linspace(0, 2 * np.pi, ANGLES)
    step = max(1, motion.time.size // SCALED)
    sizes = [
        float(np.abs(motion.deflection(i, edge, theta)).max())
        for i in range(0, motion.time.size, step)
    ]
    largest = max(sizes)
    if not largest > 0:
        raise Missing("did not move the disc")
    return Normalize(-1e3 * largest, 1e3 * largest)


def colour_of(motion: Motion, i: int, otherwise: str = SLIDER) -> str:
    """Colour of the slider, or of words on it."""
    return SEPARATED if motion.phase[i] == "separation" else otherwise


# ---- From above


def draw_plane(ax: Axes, plane: Plane, values: Array, scale: Normalize) -> Any:
    """Draw values over the disc from above, in mm; blue below the plane of the disc at rest, red
    above it."""
    mesh = ax.pcolormesh(
        plane.x, plane.y, values, cmap=cm.vik, norm=scale, shading="gouraud", rasterized=True
    )
    inner = Circle((0, 0), 1e3 * plane.r[0], fc="0.85", ec=GREY, lw=wide(0.6))
    outer = Circle((0, 0), 1e3 * plane.r[-1], fc="none", ec=GREY, lw=wide(0.6), clip_on=False)
    ax.add_patch(inner)
    ax.add_patch(outer)
    ax.set_aspect("equal")
    ax.axis("off")
    return mesh


def draw_disc(
    ax: Axes, motion: Motion, i: int, scale: Normalize, levels: Sequence[float] = ()
) -> Any:
    """Draw the disc from above, in mm, with the slider on it, and lines at levels in mm, dashed
    below zero."""
    p = motion.parameters
    plane = plane_of(p)
    values = 1e3 * motion.deflection(i, plane.r, plane.theta)
    mesh = draw_plane(ax, plane, values, scale)
    if levels:
        ax.contour(plane.x, plane.y, values, levels, colors=BLACK, linewidths=wide(0.5))

    angle = motion.slider[i]
    x = 1e3 * p.r_0 * np.cos(angle)
    y = 1e3 * p.r_0 * np.sin(angle)
    ax.plot(x, y, "o", ms=5, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)

    # a tick at theta = 0, and an arrow in the direction of theta, in which the slider is dragged
    edge = 1e3 * plane.r[-1]
    ax.plot([edge, 1.07 * edge], [0, 0], color=BLACK, lw=wide(0.8))
    middle = 0.6 * 1e3 * plane.r[0]
    arc = np.radians(np.linspace(-60, 60, 30))
    ax.plot(middle * np.cos(arc), middle * np.sin(arc), color=BLACK, lw=wide(0.8))
    start, end = np.radians([60, 75])
    arrow = {"arrowstyle": "-|>", "lw": wide(0.8), "shrinkA": 0, "shrinkB": 0, "fc": BLACK}
    ax.annotate("", _at(middle, end), _at(middle, start), arrowprops=arrow)
    return mesh


def _at(radius: float, angle: float) -> tuple[float, float]:
    return float(radius * np.cos(angle)), float(radius * np.sin(angle))


# ---- Along the slider's circle


def draw_circle(ax: Axes, motion: Motion, i: int, size: float, **look: Any) -> None:
    """Draw the disc along the circle of radius r_0 at an instant, with the slider as a mark of a
    size in points."""
    theta = np.linspace(0, 2 * np.pi, ANGLES)
    deflection = 1e3 * motion.deflection(i, None, theta)[0]
    ax.plot(theta, deflection, color=DISC, **look)
    angle = motion.slider[i] % (2 * np.pi)
    ax.plot(angle, 1e3 * motion.u[i], "s", ms=size, mfc=colour_of(motion, i), mec=BLACK, mew=0.6)
    ax.set_xlabel("Angle θ (rad)")
    ax.set_ylabel("Deflection at $r_0$ (mm)")
    ax.set_xlim((0, 2 * np.pi))
