"""Drawing of the model: from the side, from above to scale, and the contact forces; figure 1 of the
paper."""

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import (
    BLACK,
    DISC,
    FORCE,
    PAGE,
    SEPARATED,
    SLIDER,
    STICK,
    Axes,
    Figure,
    mpl,
    panels,
)
from disc_model.figures.kind import CasePlot, Need, Ranges, as_samples
from disc_model.figures.legends import legend_above
from disc_model.figures.phases import spans_between
from disc_model.parameters import Parameters
from disc_model.units import Finite, Positive, Unit

Point = tuple[float, float] | NDArray[np.float64]
SOFT, BODY, PLATE, CLAMP = "0.45", "0.88", "#dbe9f4", "0.93"
"""Lines that only guide the eye; the slider; the disc and its clamped middle."""
SMALL = 8.0  # size of the text that is no symbol, in points
OUTER = 1.2  # radius of the disc as drawn
STRETCH = 0.04  # of contact force in the composite, s
PALE, DARK = (
    "0.72",
    "#8a5a00",
)  # of ignored separation; of words on the slider, legible in grey print
PHASES: dict[str, dict[str, Any]] = {  # looks that differ in grey print as well; slip is white
    "stick": {"facecolor": "none", "edgecolor": STICK, "hatch": "//////"},
    "separation": {"facecolor": SEPARATED, "alpha": 0.35},
}


class Schematic(CasePlot):
    """The model of a case, its radii to scale."""

    kind: Literal["paper.schematic"] = "paper.schematic"

    def draw(self, case: xr.DataTree) -> Figure:
        figure: Figure = mpl.figure.Figure(figsize=(PAGE, 0.97 * PAGE))
        boxes = ((0.0, 0.5, 1, 0.45), (0.0, 0.0, 0.57, 0.45), (0.57, 0.0, 0.43, 0.45))
        axes = [figure.add_axes(box) for box in boxes]
        _side(axes[0])
        _above(axes[1], Parameters.model_validate_json(case.attrs["parameters"]))
        _forces(axes[2])
        for ax in axes:
            ax.set_aspect("equal")
            ax.axis("off")
        return figure


class Composite(CasePlot):
    """The model, the disc's vibration with separation and, in the case `ignored`, bilateral, and
    the contact force."""

    further = ("ignored",)
    kind: Literal["paper.composite"] = "paper.composite"
    ignored: str
    history: Ranges = "history"
    force: tuple[
        str, Finite
    ]  # window of the contact force, and the time at which the stretch shown begins, s
    until: Annotated[Positive, Unit("s")]  # end of the part of the runs that is shown

    def needs(self) -> Iterator[Need]:
        yield from super().needs()
        yield Need("force", self.case, self.force[0], as_samples)

    def draw(self, case: xr.DataTree, bilateral: xr.DataTree) -> Figure:
        figure, axes = panels(PAGE, 2.35, 1, 3, width_ratios=(1, 1.15, 1.3))
        model, growth, force = axes
        _small(model)
        followed, ignored = (
            drawing.history(each, self.history, self.until) for each in (case, bilateral)
        )
        drawing.envelope(growth, ignored, "w_point", color=PALE)
        drawing.envelope(growth, followed, "w_point")
        top = 1e3 * float(ignored["w_point_max"].max()) or 1.0
        for share, text, colour in (
            (1.08, "separation ignored", "0.35"),
            (-0.05, "with separation", "white"),
        ):
            place = (0.98 * growth.get_xlim()[1], share * top)
            growth.text(*place, text, ha="right", color=colour, fontsize=7, fontweight="bold")
        growth.set(
            xlabel="Time (s)",
            ylabel="Displacement of the disc (mm)",
            ylim=(-1.25 * top, 1.25 * top),
        )
        if (lost := float(case["first_separation"])) <= growth.get_xlim()[1]:
            growth.axvline(lost, ymax=0.88, color=SEPARATED, linewidth=0.9, linestyle=(0, (4, 2)))
            drawing.say(
                growth, "contact\nis lost", (lost, -1.2 * top), (-3, 1), fontsize=7, color=SEPARATED
            )
        drawing.show_thickness(growth, case, "y")
        name, start = self.force
        part = dataset.samples(case, name).sel(time=slice(start, start + STRETCH))
        if part.sizes["time"] < 2:
            raise Missing(f"has no samples from {start:g} s on")
        time, words = 1e3 * (part["time"].values - start), flag_names(part["phase"])
        spans = spans_between(case, start, start + STRETCH)
        for word, look in PHASES.items():
            for i, (begin, end) in enumerate(spans[word]):
                label = "_nolegend_" if i else word
                force.axvspan(
                    1e3 * (begin - start), 1e3 * (end - start), label=label, linewidth=0, **look
                )
        # zero, and not drawn, in separation, since no line leads to the force after an impact
        force.plot(time, part["P"].where(words != "separation"), color=BLACK, linewidth=1.1)
        force.set(
            xlabel=f"Time after {start:g} s (ms)",
            ylabel="Contact force (N)",
            xlim=(0, 1e3 * STRETCH),
        )
        force.set_ylim(bottom=0)
        if force.patches:
            legend_above(force)
        drawing.letters(axes)
        return figure


def _small(ax: Axes) -> None:
    """Draw the model from the side with the fewest words."""
    x = np.linspace(-2.0, 2.6, 200)
    ax.plot(x, 0.2 * np.sin(1.6 * x + 0.5) - 0.1, color=DISC, lw=3)
    ax.text(-2.0, -0.75, "elastic disc", color=DISC, fontsize=7)
    _slider(ax, (-0.55, 0.15), 1.1, 0.45, lw=1.2)
    ax.text(0, 0.375, "slider", ha="center", va="center", fontsize=7)
    _wall(ax, (-0.6, 1.6), (0.6, 1.6), (0.12, 0.14))
    _join(ax, SPRING, (0, 0.6), (0, 1.6))
    _arrow(ax, (0, 2.35), (0, 1.8))
    ax.text(0.15, 2.1, "preload", fontsize=7)
    _wall(ax, (1.8, 0.05), (1.8, 0.65), (0.13, 0.12))
    _join(ax, SPRING, (0.55, 0.375), (1.8, 0.375))
    _arrow(ax, (1.85, 0.95), (2.6, 0.95))
    ax.text(2.6, 1.08, "drive", ha="right", fontsize=7)
    _arrow(ax, (-0.65, 0.22), (-1.45, 0.22), colour=FORCE)
    ax.text(-2.0, 0.38, "friction", color=FORCE, fontsize=7)
    _arrow(ax, (-0.8, 0.8), (-0.8, 1.35), style="<|-|>", colour=SLIDER)
    ax.text(-0.95, 1.07, "bounces", ha="right", va="center", color=DARK, fontsize=7)
    _arrow(ax, (0.4, 0.8), (1.2, 0.8), style="<|-|>", colour=SLIDER)
    ax.text(0.8, 0.95, "sticks,\nslips", ha="center", color=DARK, fontsize=7)
    ax.set(xlim=(-2.1, 2.7), ylim=(-0.95, 2.5))
    ax.set_box_aspect(1.05)
    ax.axis("off")


def _side(ax: Axes) -> None:
    """Draw the side view, unrolled along the circle of radius r_0; the gap is open so that u and w
    are distinct."""
    x, bottom, top, drive = np.linspace(-2.5, 4.4, 300), 0.55, 2.15, 2.6
    under, beside = (float(0.22 * np.sin(1.15 * angle + 0.55)) for angle in (0.0, 0.12))
    ax.plot(x, 0.22 * np.sin(1.15 * x + 0.55), color=DISC, lw=2.5)
    ax.axhline(0, color=SOFT, lw=0.8, ls="--")
    ax.text(-2.45, 0.08, "disc at rest, no load", color=SOFT, va="bottom", fontsize=SMALL)
    ax.text(3.35, -0.5, r"disc, $w(r_0, \theta, t)$", color=DISC)
    _slider(ax, (-0.4, bottom), 0.8, 0.55)
    ax.text(0, bottom + 0.275, "$m$", ha="center", va="center")
    ax.plot([0, 0], [under, bottom], color=SOFT, lw=0.8, ls=":")
    # heights, measured from the plane of the disc at rest, at the slider's place
    _arrow(ax, (-0.75, 0), (-0.75, bottom), "$u$", (-0.16, 0), SLIDER)
    ax.plot([-0.85, -0.4], [bottom, bottom], color=SLIDER, lw=0.7)
    _arrow(ax, (-1.2, 0), (-1.2, -0.38), colour=SLIDER)
    ax.plot([-1.35, -1.05], [-0.38, -0.38], color=SLIDER, lw=0.7)
    _write(ax, (-1.2, -0.52), "$u_0$ at the static start", color=DARK, fontsize=SMALL)
    _arrow(ax, (0.18, 0), (0.18, beside), "$w$", (0.2, -0.01), DISC, "->")
    # vertical branch
    _wall(ax, (-0.6, top), (0.6, top), (0.12, 0.15))
    _join(ax, SPRING, (-0.2, bottom + 0.55), (-0.2, top))
    _join(ax, DAMPER, (0.2, bottom + 0.55), (0.2, top))
    ax.text(-0.47, 1.63, "$k$", ha="center")
    ax.text(0.5, 1.63, "$c$", ha="center")
    _arrow(ax, (0.85, top + 0.3), (0.85, top))
    ax.plot([0.6, 1.0], [top, top], color=BLACK, lw=0.7)
    ax.text(1.02, top + 0.12, r"$\Delta$, kept: preload $N$", va="center")
    # in-plane branch
    _wall(ax, (drive, 0.5), (drive, 1.15), (0.13, 0.12))
    _join(ax, SPRING, (0.4, 0.97), (drive, 0.97), width=0.08)
    _join(ax, DAMPER, (0.4, 0.68), (drive, 0.68), width=0.08)
    ax.text(1.5, 1.16, "$k_p$", ha="center")
    ax.text(1.85, 0.44, "$c_p$", ha="center", va="center")
    _arrow(ax, (drive + 0.2, 1.3), (drive + 0.95, 1.3), r"drive point, $r_0\,\Omega$", (0.15, 0.2))
    _arrow(ax, (-0.4, 1.3), (-1.15, 1.3), style="<|-", colour=SLIDER)
    ax.text(-1.25, 1.3, r"$r_0\,\dot\varphi = r_0\,f$", ha="right", va="center", color=DARK)
    _arrow(ax, (0, -0.55), (drive, -0.55), r"$r_0\,\psi$", (-0.4, -0.17), SLIDER, "<|-|>")
    for angle in (0.0, drive):
        ax.plot([angle, angle], [-0.65, -0.1], color=SLIDER, lw=0.7)
    _arrow(ax, (-2.45, -0.72), (-1.85, -0.72), r"$\theta$", (0.42, 0))
    ax.set(xlim=(-2.6, 4.6), ylim=(-0.85, 2.45))
    ax.set_title("(a) from the side, along the circle of radius $r_0$", loc="left")


def _above(ax: Axes, p: Parameters) -> None:
    """Draw the view from above: radii, to scale, and angles."""
    a, b, r_0 = (radius * OUTER / p.b for radius in (p.a, p.b, p.r_0))
    ax.add_patch(mpl.patches.Annulus((0, 0), b, b - a, fc=PLATE, ec=DISC, lw=1.5))
    ax.add_patch(mpl.patches.Circle((0, 0), a, fc=CLAMP, ec=DISC, lw=1.5))
    ax.add_patch(mpl.patches.Circle((0, 0), r_0, fc="none", ec=SOFT, lw=0.8, ls="--"))
    phi, ahead, fixed = np.radians(38), np.radians(92), np.radians(-32)
    ax.plot([0, 1.55], [0, 0], color=BLACK, lw=0.8)
    for angle, colour in ((phi, SLIDER), (ahead, BLACK)):
        ax.plot(*np.transpose([(0, 0), _at(angle, 1.38)]), color=colour, lw=0.9)
    ax.add_patch(
        mpl.patches.Circle(tuple(_at(phi, r_0)), 0.075, fc=BODY, ec=BLACK, lw=1.3, zorder=5)
    )
    _write(ax, _at(phi, r_0), "$m$", fontsize=SMALL, zorder=6)
    ax.plot(*_at(ahead, r_0), "o", color=BLACK, ms=5, zorder=5)
    _write(ax, _at(ahead, 1.45, (0.05, 0)), r"drive point, $\Omega t$", va="baseline")
    _write(ax, _at(phi, 1.42, (0.16, 0.02)), "slider", va="baseline", color=DARK)
    for low, high, text in ((0.0, phi, r"$\varphi$"), (phi, ahead, r"$\psi$")):
        theta = {"theta1": np.degrees(low), "theta2": np.degrees(high) - 6}
        ax.add_patch(mpl.patches.Arc((0, 0), 1.44, 1.44, **theta, color=SLIDER, lw=1.5))
        _arrow(ax, _at(high - 0.11, 0.72), _at(high, 0.72), colour=SLIDER)
        _write(ax, _at((low + high) / 2, 0.85), text, color=DARK, fontsize=13)
    ax.plot(*_at(fixed, r_0), "x", color=BLACK, ms=7)
    _write(
        ax, _at(fixed, 1.3, (0.43, -0.06)), "point of the disc\nat $r_0$, $\\theta$", fontsize=SMALL
    )
    ax.text(1.62, 0, r"$\theta = 0$", va="center", fontsize=SMALL)
    for degrees, radius, text in ((170, a, "$a$"), (212, r_0, "$r_0$"), (250, b, "$b$")):
        angle = np.radians(degrees)
        _arrow(ax, (0, 0), _at(angle, radius), style="->")
        _write(ax, _at(angle, 0.6 * radius, 0.1 * _at(angle - np.pi / 2, 1)), text)
    radii = f"clamped at\n$a$ = {1e3 * p.a:g} mm,\nfree at\n$b$ = {1e3 * p.b:g} mm"
    ax.text(-1.72, 1.66, radii, fontsize=SMALL, va="top")
    ax.set(xlim=(-1.75, 2.05), ylim=(-1.3, 1.7))
    ax.set_title(f"(b) from above, $r_0$ = {1e3 * p.r_0:g} mm", loc="left")


def _forces(ax: Axes) -> None:
    """Draw the free-body diagrams of the slider and of the disc under it."""
    _slider(ax, (-0.45, 0.55), 0.9, 0.6)
    ax.text(0, 0.85, "$m$", ha="center", va="center")
    _arrow(ax, (-0.12, 2.0), (-0.12, 1.15), "$N + k\\,(u - u_0) + c\\,\\dot u$", (0.12, 0.58))
    _arrow(ax, (0, 0.02), (0, 0.55), "$P$", (0.2, -0.02), FORCE)
    _arrow(ax, (0.45, 0.93), (1.3, 0.93), "$r_0\\,F$", (0.1, 0.2), FORCE)
    ax.text(
        1.62,
        1.42,
        "$F = k_p\\,\\psi + c_p\\,(\\Omega - f)$",
        ha="right",
        color=FORCE,
        fontsize=SMALL,
    )
    _arrow(ax, (-0.45, 0.62), (-1.3, 0.62), colour=FORCE)
    ax.text(-0.9, 0.86, "slip: $\\mu_k P$", ha="center", color=FORCE, fontsize=SMALL)
    _arrow(ax, (-1.25, 1.5), (-0.65, 1.5), "$f > 0$", (0.0, 0.17))
    x = np.linspace(-1.15, 1.5, 100)
    level = -0.62
    ax.plot(x, level + 0.2 * x - 0.05 * x**2, color=DISC, lw=2.5)
    ax.plot([-1.5, 1.5], [level, level], color=SOFT, lw=0.8, ls="--")
    _arrow(ax, (0, level + 0.53), (0, level), "$P$", (0.2, 0.03), FORCE)
    ax.text(1.6, level + 0.52, "slope $B / r_0$,", ha="right", color=DISC, fontsize=SMALL)
    ax.text(
        1.6,
        level + 0.32,
        "$B = \\partial w / \\partial\\theta$",
        ha="right",
        color=DISC,
        fontsize=SMALL,
    )
    ax.set(xlim=(-1.65, 1.65), ylim=(-0.95, 2.35))
    ax.set_title("(c) forces at the contact", loc="left")


def _at(angle: float, radius: float, aside: Point = (0.0, 0.0)) -> NDArray[np.float64]:
    return radius * np.array([np.cos(angle), np.sin(angle)]) + aside


def _arrow(
    ax: Axes,
    start: Point,
    end: Point,
    text: str = "",
    offset: Point = (0, 0),
    colour: str = BLACK,
    style: str = "-|>",
) -> None:
    """Draw an arrow from `start` to `end`, with a text at its middle, moved by `offset`."""
    look = {"arrowstyle": style, "color": colour, "lw": 1.5, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tuple(end), tuple(start), arrowprops=look)
    if text:
        _write(
            ax,
            0.5 * (np.array(start) + np.array(end)) + offset,
            text,
            color=DARK if colour == SLIDER else colour,
        )


def _write(ax: Axes, point: Point, text: str, **look: Any) -> None:
    ax.text(
        float(point[0]), float(point[1]), text, ha="center", va=look.pop("va", "center"), **look
    )


def _slider(ax: Axes, corner: Point, width: float, height: float, lw: float = 1.3) -> None:
    ax.add_patch(mpl.patches.Rectangle(tuple(corner), width, height, fc=BODY, ec=BLACK, lw=lw))


Strokes = Sequence[
    tuple[ArrayLike, ArrayLike]
]  # lines: fractions of the way, and offsets to its left in widths
SPRING: Strokes = [
    ([0, *np.linspace(0.2, 0.8, 11), 1], [0, 0, 1, -1, 1, -1, 1, -1, 1, -1, 1, 0, 0])
]  # a zigzag
_CUP: Strokes = [([0, 0.35], [0, 0]), ([0.7, 0.35, 0.35, 0.7], [1, 1, -1, -1])]
DAMPER: Strokes = [*_CUP, ([0.55, 0.55], [-0.7, 0.7]), ([0.55, 1], [0, 0])]  # a cup and a piston


def _join(ax: Axes, strokes: Strokes, start: Point, end: Point, width: float = 0.1) -> None:
    first, way = np.array(start, float), np.array(end, float) - np.array(start, float)
    normal = np.array([-way[1], way[0]]) / np.hypot(*way)
    for along, side in strokes:
        x, y = (
            first[:, None]
            + way[:, None] * np.array(along)
            + normal[:, None] * (width * np.array(side))
        )
        ax.plot(x, y, color=BLACK, lw=1.2)


def _wall(ax: Axes, start: Point, end: Point, depth: Point) -> None:
    """Draw a line with hatching on the side of `depth`, a vector."""
    ax.plot(*np.transpose([start, end]), color=BLACK, lw=1.5)
    for foot in np.array(start) + np.linspace(0, 1, 9)[:, None] * (np.array(end) - np.array(start)):
        ax.plot(*np.transpose([foot, foot + depth]), color=BLACK, lw=0.8)
