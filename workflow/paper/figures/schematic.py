"""Drawing of the model: from the side, from above to scale, and the contact forces; figure 1 of the
paper."""

import numpy as np
import xarray as xr
from matplotlib.patches import Annulus, Arc, Circle

from disc_model.figures.drawing import BLACK, DISC, FORCE, SLIDER
from disc_model.figures.types import Axes, Figure
from disc_model.parameters import Parameters
from workflow.paper.figures.kinds import Schematic
from workflow.paper.figures.strokes import (
    BODY,
    DAMPER,
    DARK,
    SPRING,
    arrow,
    at,
    join,
    slider,
    wall,
    write,
)

SOFT = "0.45"  # lines that only guide the eye
PLATE = "#dbe9f4"  # the disc,
CLAMP = "0.93"  # and its clamped middle
SMALL = 8.0  # size of the text that is no symbol, in points
OUTER = 1.2  # radius of the disc as drawn


def draw(plot: Schematic, case: xr.DataTree) -> Figure:
    """Draw the three views."""
    return sketch(Parameters.model_validate_json(case.attrs["parameters"]), plot.inches)


def sketch(p: Parameters, width: float) -> Figure:
    """Draw the three views of a case in a figure of a width in inches."""
    figure = Figure(figsize=(width, 0.97 * width))
    boxes = ((0.0, 0.5, 1, 0.45), (0.0, 0.0, 0.57, 0.45), (0.57, 0.0, 0.43, 0.45))
    side, above, forces = (figure.add_axes(box) for box in boxes)
    _draw_side(side)
    _draw_above(above, p)
    _draw_forces(forces)
    for ax in (side, above, forces):
        ax.set_aspect("equal")
        ax.axis("off")
    return figure


def _draw_side(ax: Axes) -> None:
    """Draw the side view, unrolled along the circle of radius r_0; the gap is open so that u and w
    are distinct."""
    x = np.linspace(-2.5, 4.4, 300)
    bottom = 0.55  # of the slider
    top = 2.15  # of the springs
    drive = 2.6  # where the drive point is
    under, beside = (float(0.22 * np.sin(1.15 * angle + 0.55)) for angle in (0.0, 0.12))
    ax.plot(x, 0.22 * np.sin(1.15 * x + 0.55), color=DISC, lw=2.5)
    ax.axhline(0, color=SOFT, lw=0.8, ls="--")
    ax.text(-2.45, 0.08, "disc at rest, no load", color=SOFT, va="bottom", fontsize=SMALL)
    ax.text(3.35, -0.5, r"disc, $w(r_0, \theta, t)$", color=DISC)
    slider(ax, (-0.4, bottom), 0.8, 0.55)
    ax.text(0, bottom + 0.275, "$m$", ha="center", va="center")
    ax.plot([0, 0], [under, bottom], color=SOFT, lw=0.8, ls=":")
    # heights, measured from the plane of the disc at rest, at the slider's place
    arrow(ax, (-0.75, 0), (-0.75, bottom), "$u$", (-0.16, 0), SLIDER)
    ax.plot([-0.85, -0.4], [bottom, bottom], color=SLIDER, lw=0.7)
    arrow(ax, (-1.2, 0), (-1.2, -0.38), colour=SLIDER)
    ax.plot([-1.35, -1.05], [-0.38, -0.38], color=SLIDER, lw=0.7)
    write(ax, (-1.2, -0.52), "$u_0$ at the static start", color=DARK, fontsize=SMALL)
    arrow(ax, (0.18, 0), (0.18, beside), "$w$", (0.2, -0.01), DISC, "->")
    # vertical branch
    wall(ax, (-0.6, top), (0.6, top), (0.12, 0.15))
    join(ax, SPRING, (-0.2, bottom + 0.55), (-0.2, top))
    join(ax, DAMPER, (0.2, bottom + 0.55), (0.2, top))
    ax.text(-0.47, 1.63, "$k$", ha="center")
    ax.text(0.5, 1.63, "$c$", ha="center")
    arrow(ax, (0.85, top + 0.3), (0.85, top))
    ax.plot([0.6, 1.0], [top, top], color=BLACK, lw=0.7)
    ax.text(1.02, top + 0.12, r"$\Delta$, kept: preload $N$", va="center")
    # in-plane branch
    wall(ax, (drive, 0.5), (drive, 1.15), (0.13, 0.12))
    join(ax, SPRING, (0.4, 0.97), (drive, 0.97), width=0.08)
    join(ax, DAMPER, (0.4, 0.68), (drive, 0.68), width=0.08)
    ax.text(1.5, 1.16, "$k_p$", ha="center")
    ax.text(1.85, 0.44, "$c_p$", ha="center", va="center")
    arrow(ax, (drive + 0.2, 1.3), (drive + 0.95, 1.3), r"drive point, $r_0\,\Omega$", (0.15, 0.2))
    arrow(ax, (-0.4, 1.3), (-1.15, 1.3), style="<|-", colour=SLIDER)
    ax.text(-1.25, 1.3, r"$r_0\,\dot\varphi = r_0\,f$", ha="right", va="center", color=DARK)
    arrow(ax, (0, -0.55), (drive, -0.55), r"$r_0\,\psi$", (-0.4, -0.17), SLIDER, "<|-|>")
    for angle in (0.0, drive):
        ax.plot([angle, angle], [-0.65, -0.1], color=SLIDER, lw=0.7)
    arrow(ax, (-2.45, -0.72), (-1.85, -0.72), r"$\theta$", (0.42, 0))
    ax.set_xlim((-2.6, 4.6))
    ax.set_ylim((-0.85, 2.45))
    ax.set_title("(a) from the side, along the circle of radius $r_0$", loc="left")


def _draw_above(ax: Axes, p: Parameters) -> None:
    """Draw the view from above: radii, to scale, and angles."""
    a, b, r_0 = (radius * OUTER / p.b for radius in (p.a, p.b, p.r_0))
    ax.add_patch(Annulus((0, 0), b, b - a, fc=PLATE, ec=DISC, lw=1.5))
    ax.add_patch(Circle((0, 0), a, fc=CLAMP, ec=DISC, lw=1.5))
    ax.add_patch(Circle((0, 0), r_0, fc="none", ec=SOFT, lw=0.8, ls="--"))
    phi = np.radians(38)  # of the slider,
    ahead = np.radians(92)  # of the drive point,
    fixed = np.radians(-32)  # and of a point of the disc
    ax.plot([0, 1.55], [0, 0], color=BLACK, lw=0.8)
    for angle, colour in ((phi, SLIDER), (ahead, BLACK)):
        ax.plot(*np.transpose([(0, 0), at(angle, 1.38)]), color=colour, lw=0.9)
    ax.add_patch(Circle(tuple(at(phi, r_0)), 0.075, fc=BODY, ec=BLACK, lw=1.3, zorder=5))
    write(ax, at(phi, r_0), "$m$", fontsize=SMALL, zorder=6)
    ax.plot(*at(ahead, r_0), "o", color=BLACK, ms=5, zorder=5)
    write(ax, at(ahead, 1.45, (0.05, 0)), r"drive point, $\Omega t$", va="baseline")
    write(ax, at(phi, 1.42, (0.16, 0.02)), "slider", va="baseline", color=DARK)
    for low, high, text in ((0.0, phi, r"$\varphi$"), (phi, ahead, r"$\psi$")):
        theta = {"theta1": np.degrees(low), "theta2": np.degrees(high) - 6}
        ax.add_patch(Arc((0, 0), 1.44, 1.44, **theta, color=SLIDER, lw=1.5))
        arrow(ax, at(high - 0.11, 0.72), at(high, 0.72), colour=SLIDER)
        write(ax, at((low + high) / 2, 0.85), text, color=DARK, fontsize=13)
    ax.plot(*at(fixed, r_0), "x", color=BLACK, ms=7)
    write(
        ax, at(fixed, 1.3, (0.43, -0.06)), "point of the disc\nat $r_0$, $\\theta$", fontsize=SMALL
    )
    ax.text(1.62, 0, r"$\theta = 0$", va="center", fontsize=SMALL)
    for degrees, radius, text in ((170, a, "$a$"), (212, r_0, "$r_0$"), (250, b, "$b$")):
        angle = np.radians(degrees)
        arrow(ax, (0, 0), at(angle, radius), style="->")
        write(ax, at(angle, 0.6 * radius, 0.1 * at(angle - np.pi / 2, 1)), text)
    radii = f"clamped at\n$a$ = {1e3 * p.a:g} mm,\nfree at\n$b$ = {1e3 * p.b:g} mm"
    ax.text(-1.72, 1.66, radii, fontsize=SMALL, va="top")
    ax.set_xlim((-1.75, 2.05))
    ax.set_ylim((-1.3, 1.7))
    ax.set_title(f"(b) from above, $r_0$ = {1e3 * p.r_0:g} mm", loc="left")


def _draw_forces(ax: Axes) -> None:
    """Draw the free-body diagrams of the slider and of the disc under it."""
    slider(ax, (-0.45, 0.55), 0.9, 0.6)
    ax.text(0, 0.85, "$m$", ha="center", va="center")
    arrow(ax, (-0.12, 2.0), (-0.12, 1.15), "$N + k\\,(u - u_0) + c\\,\\dot u$", (0.12, 0.58))
    arrow(ax, (0, 0.02), (0, 0.55), "$P$", (0.2, -0.02), FORCE)
    arrow(ax, (0.45, 0.93), (1.3, 0.93), "$r_0\\,F$", (0.1, 0.2), FORCE)
    ax.text(
        1.62,
        1.42,
        "$F = k_p\\,\\psi + c_p\\,(\\Omega - f)$",
        ha="right",
        color=FORCE,
        fontsize=SMALL,
    )
    arrow(ax, (-0.45, 0.62), (-1.3, 0.62), colour=FORCE)
    ax.text(-0.9, 0.86, "slip: $\\mu_k P$", ha="center", color=FORCE, fontsize=SMALL)
    arrow(ax, (-1.25, 1.5), (-0.65, 1.5), "$f > 0$", (0.0, 0.17))
    x = np.linspace(-1.15, 1.5, 100)
    level = -0.62
    ax.plot(x, level + 0.2 * x - 0.05 * x**2, color=DISC, lw=2.5)
    ax.plot([-1.5, 1.5], [level, level], color=SOFT, lw=0.8, ls="--")
    arrow(ax, (0, level + 0.53), (0, level), "$P$", (0.2, 0.03), FORCE)
    ax.text(1.6, level + 0.52, "slope $B / r_0$,", ha="right", color=DISC, fontsize=SMALL)
    ax.text(
        1.6,
        level + 0.32,
        "$B = \\partial w / \\partial\\theta$",
        ha="right",
        color=DISC,
        fontsize=SMALL,
    )
    ax.set_xlim((-1.65, 1.65))
    ax.set_ylim((-0.95, 2.35))
    ax.set_title("(c) forces at the contact", loc="left")
