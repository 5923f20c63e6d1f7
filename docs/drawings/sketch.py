"""Draw the sketch of docs/model.md: the model from the side and from above, and the forces at the contact.

python docs/drawings/sketch.py    writes sketch.svg beside this file
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Annulus, Arc, Rectangle

from disc_model.figures.parts import BLACK, BLUE, GREEN, VERMILION

GREY = "0.55"
FONT = {"font.size": 11, "mathtext.fontset": "cm", "svg.hashsalt": "sketch", "font.family": "DejaVu Sans"}


def arrow(ax, start, end, text="", offset=(0.0, 0.0), colour=BLACK, style="-|>"):
    """An arrow from `start` to `end`, with a text at its middle, moved by `offset`."""
    ax.annotate(
        "", end, start, arrowprops={"arrowstyle": style, "color": colour, "lw": 1.5, "shrinkA": 0, "shrinkB": 0}
    )
    middle = 0.5 * (np.array(start) + np.array(end)) + offset
    ax.text(*middle, text, ha="center", va="center", color=colour)


def spring(ax, start, end, coils=5, width=0.1):
    """A zigzag between two points."""
    start, end = np.array(start, float), np.array(end, float)
    along = (end - start) / np.hypot(*(end - start))
    across = np.array([-along[1], along[0]])
    places = np.concatenate([[0, 0.2], np.linspace(0.2, 0.8, 2 * coils + 1)[1:-1], [0.8, 1]])
    swings = np.concatenate([[0, 0], [(-1) ** i for i in range(2 * coils - 1)], [0, 0]])
    points = start + places[:, None] * (end - start) + width * swings[:, None] * across
    ax.plot(*points.T, color=BLACK, lw=1.2)


def damper(ax, start, end, width=0.1):
    """A cup and a piston between two points."""
    start, end = np.array(start, float), np.array(end, float)
    across = np.array([-(end - start)[1], (end - start)[0]]) / np.hypot(*(end - start))

    def line(*points):
        places = [start + along * (end - start) + side * width * across for along, side in points]
        ax.plot(*np.transpose(places), color=BLACK, lw=1.2)

    line((0, 0), (0.35, 0))
    line((0.7, 1), (0.35, 1), (0.35, -1), (0.7, -1))
    line((0.55, -0.7), (0.55, 0.7))
    line((0.55, 0), (1, 0))


def wall(ax, start, end, depth):
    """A line with hatching on the side of `depth`, a vector."""
    ax.plot(*np.transpose([start, end]), color=BLACK, lw=1.5)
    for s in np.linspace(0, 1, 9):
        foot = np.array(start) + s * (np.array(end) - np.array(start))
        ax.plot(*np.transpose([foot, foot + depth]), color=BLACK, lw=0.8)


def side(ax):
    """Along the circle of radius r_0, unrolled; the gap is open to show u and w apart."""
    x = np.linspace(-2.5, 4.4, 300)

    def surface(at):
        return 0.22 * np.sin(1.15 * at + 0.55)

    ax.plot(x, surface(x), color=BLUE, lw=2.5)
    ax.axhline(0, color=GREY, lw=0.8, ls="--")
    ax.text(-2.45, 0.08, "disc at rest, no load", color=GREY, va="bottom", fontsize=9)
    ax.text(3.35, -0.5, r"disc, $w(r_0, \theta, t)$", color=BLUE)
    bottom = 0.55
    ax.add_patch(Rectangle((-0.4, bottom), 0.8, 0.55, fc="0.88", ec=BLACK, lw=1.3))
    ax.text(0, bottom + 0.275, "$m$", ha="center", va="center")
    ax.plot([0, 0], [surface(0), bottom], color=GREY, lw=0.8, ls=":")
    # heights, measured from the plane of the disc at rest, at the slider's place
    arrow(ax, (-0.75, 0), (-0.75, bottom), "$u$", (-0.16, 0), VERMILION)
    ax.plot([-0.85, -0.4], [bottom, bottom], color=VERMILION, lw=0.7)
    arrow(ax, (0.18, 0), (0.18, surface(0.12)), "$w$", (0.2, -0.01), BLUE, "->")
    # vertical branch
    top = 2.15
    wall(ax, (-0.6, top), (0.6, top), np.array([0.12, 0.15]))
    spring(ax, (-0.2, bottom + 0.55), (-0.2, top))
    damper(ax, (0.2, bottom + 0.55), (0.2, top))
    ax.text(-0.47, 1.63, "$k$", ha="center")
    ax.text(0.5, 1.63, "$c$", ha="center")
    arrow(ax, (1.0, 2.3), (1.0, 1.8), "preload $N$", (0.62, 0.02))
    # in-plane branch
    drive = 2.6
    wall(ax, (drive, 0.5), (drive, 1.15), np.array([0.13, 0.12]))
    spring(ax, (0.4, 0.97), (drive, 0.97), width=0.08)
    damper(ax, (0.4, 0.68), (drive, 0.68), width=0.08)
    ax.text(1.5, 1.16, "$k_p$", ha="center")
    ax.text(1.85, 0.44, "$c_p$", ha="center", va="center")
    arrow(ax, (drive + 0.2, 1.3), (drive + 0.95, 1.3), r"drive point, $r_0\,\Omega$", (0.15, 0.2))
    arrow(ax, (-0.4, 1.3), (-1.15, 1.3), style="<|-", colour=VERMILION)
    ax.text(-1.25, 1.3, r"$r_0\,\dot\varphi = r_0\,f$", ha="right", va="center", color=VERMILION)
    arrow(ax, (0, -0.55), (drive, -0.55), r"$r_0\,\psi$", (-0.4, -0.17), GREEN, "<|-|>")
    for place in (0, drive):
        ax.plot([place, place], [-0.65, -0.1], color=GREEN, lw=0.7)
    arrow(ax, (-2.4, -0.55), (-1.5, -0.55), r"$\theta$", (0.6, 0))
    ax.set(xlim=(-2.6, 4.6), ylim=(-0.85, 2.45))
    ax.set_title("(a) from the side, along the circle of radius $r_0$", fontsize=11, loc="left")


def above(ax):
    """From above: radii and angles."""
    a, b, r_0 = 0.44, 1.2, 1.0
    ax.add_patch(Annulus((0, 0), b, b - a, fc="#dbe9f4", ec=BLUE, lw=1.5))
    ax.add_patch(plt.Circle((0, 0), a, fc="0.93", ec=BLUE, lw=1.5))
    ax.add_patch(plt.Circle((0, 0), r_0, fc="none", ec=GREY, lw=0.8, ls="--"))
    phi, ahead, fixed = np.radians(38), np.radians(92), np.radians(-32)

    def at(angle, radius, aside=(0.0, 0.0)):
        return radius * np.array([np.cos(angle), np.sin(angle)]) + aside

    ax.plot([0, 1.55], [0, 0], color=BLACK, lw=0.8)
    for angle, colour in ((phi, VERMILION), (ahead, BLACK)):
        ax.plot(*np.transpose([(0, 0), at(angle, 1.38)]), color=colour, lw=0.9)
    ax.add_patch(plt.Circle(at(phi, r_0), 0.075, fc="0.88", ec=BLACK, zorder=5))
    ax.text(*at(phi, r_0), "$m$", ha="center", va="center", fontsize=8, zorder=6)
    ax.plot(*at(ahead, r_0), "o", color=BLACK, ms=5, zorder=5)
    ax.text(*at(ahead, 1.45, (0.05, 0)), r"drive point, $\Omega t$", ha="center")
    ax.text(*at(phi, 1.42, (0.16, 0.02)), "slider", ha="center", color=VERMILION)
    for low, high, radius, text, colour in (
        (0, phi, 0.72, r"$\varphi$", VERMILION),
        (phi, ahead, 0.72, r"$\psi$", GREEN),
    ):
        ax.add_patch(
            Arc(
                (0, 0),
                2 * radius,
                2 * radius,
                theta1=np.degrees(low),
                theta2=np.degrees(high) - 6,
                color=colour,
                lw=1.5,
            )
        )
        tip, before = at(high, radius), at(high - 0.11, radius)
        ax.annotate(
            "", tip, before, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.5, "shrinkA": 0, "shrinkB": 0}
        )
        ax.text(*at((low + high) / 2, radius + 0.13), text, color=colour, ha="center", va="center", fontsize=13)
    ax.plot(*at(fixed, r_0), "x", color=BLACK, ms=7)
    ax.text(
        *at(fixed, 1.3, (0.38, -0.06)),
        "point of the disc\nat $r_0$, $\\theta$",
        ha="center",
        va="center",
        fontsize=9,
    )
    ax.text(1.62, 0, r"$\theta = 0$", va="center", fontsize=9)
    for angle, radius, text in ((170, a, "$a$"), (212, r_0, "$r_0$"), (250, b, "$b$")):
        arrow(ax, (0, 0), at(np.radians(angle), radius), colour=BLACK, style="->")
        ax.text(
            *(at(np.radians(angle), 0.6 * radius) + 0.1 * at(np.radians(angle - 90), 1)), text, ha="center", va="center"
        )
    ax.text(-1.72, 1.25, "clamped at $a$,\nfree at $b$", fontsize=9)
    ax.set(xlim=(-1.75, 2.05), ylim=(-1.3, 1.7))
    ax.set_title("(b) from above", fontsize=11, loc="left")


def forces(ax):
    """Free bodies: the slider, and the disc under it."""
    ax.add_patch(Rectangle((-0.45, 0.55), 0.9, 0.6, fc="0.88", ec=BLACK, lw=1.3))
    ax.text(0, 0.85, "$m$", ha="center", va="center")
    arrow(ax, (-0.12, 2.0), (-0.12, 1.15), "$N + k\\,(u - u_0) + c\\,\\dot u$", (0.12, 0.58))
    arrow(ax, (0, 0.02), (0, 0.55), "$P$", (0.2, -0.02), VERMILION)
    arrow(ax, (0.45, 0.93), (1.3, 0.93), "$r_0\\,F$", (0.1, 0.2), GREEN)
    arrow(ax, (-0.45, 0.62), (-1.3, 0.62), style="-|>", colour=VERMILION)
    ax.text(-0.9, 0.86, "slip: $\\mu_k P$", ha="center", color=VERMILION, fontsize=10)
    arrow(ax, (-1.25, 1.5), (-0.65, 1.5), "$f > 0$", (-0.0, 0.17))
    x = np.linspace(-1.5, 1.5, 100)
    level = -0.62
    ax.plot(x, level + 0.2 * x - 0.05 * x**2, color=BLUE, lw=2.5)
    ax.plot([-1.5, 1.5], [level, level], color=GREY, lw=0.8, ls="--")
    arrow(ax, (0, level + 0.53), (0, level), "$P$", (0.2, 0.03), VERMILION)
    ax.text(1.45, level + 0.36, "slope $B / r_0$", ha="right", color=BLUE)
    ax.set(xlim=(-1.65, 1.65), ylim=(-0.95, 2.35))
    ax.set_title("(c) forces at the contact", fontsize=11, loc="left")


def main():
    with plt.rc_context(FONT):
        figure = plt.figure(figsize=(7.2, 7.0))
        axes = [figure.add_axes(box) for box in ((0.0, 0.5, 1, 0.45), (0.0, 0.0, 0.57, 0.45), (0.57, 0.0, 0.43, 0.45))]
        for ax, draw in zip(axes, (side, above, forces), strict=True):
            draw(ax)
            ax.set_aspect("equal")
            ax.axis("off")
        figure.savefig(Path(__file__).with_suffix(".svg"), metadata={"Date": None}, facecolor="white")


if __name__ == "__main__":
    main()
