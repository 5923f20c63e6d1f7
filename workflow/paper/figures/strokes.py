"""Strokes of drawings of the model: arrows, springs, dampers, walls, the slider."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike

from disc_model.figures.drawing import BLACK, SLIDER
from disc_model.figures.types import Array, Axes

Point = tuple[float, float] | Array

BODY = "0.88"  # of the slider
DARK = "#8a5a00"  # of words on the slider, legible in grey print
LINES_OF_A_WALL = 9


class Stroke(NamedTuple):
    """A line of a part that joins two points: fractions of the way, and offsets to its left in
    widths of the part."""

    along: ArrayLike
    side: ArrayLike


TEETH = [1, -1] * 4 + [1]
ZIGZAG = Stroke([0, *np.linspace(0.2, 0.8, 11), 1], [0, 0, *TEETH, 0, 0])
CUP = (Stroke([0, 0.35], [0, 0]), Stroke([0.7, 0.35, 0.35, 0.7], [1, 1, -1, -1]))
PISTON = (Stroke([0.55, 0.55], [-0.7, 0.7]), Stroke([0.55, 1], [0, 0]))
SPRING = (ZIGZAG,)
DAMPER = (*CUP, *PISTON)


def at(angle: float, radius: float, aside: Point = (0.0, 0.0)) -> Array:
    """The point at an angle, rad, and a radius, moved aside."""
    return radius * np.array([np.cos(angle), np.sin(angle)]) + aside


def arrow(
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
        middle = 0.5 * (np.array(start) + np.array(end))
        write(ax, middle + offset, text, color=DARK if colour == SLIDER else colour)


def write(ax: Axes, point: Point, text: str, va: str = "center", **look: Any) -> None:
    """Write words centred on a point."""
    ax.text(float(point[0]), float(point[1]), text, ha="center", va=va, **look)


def slider(ax: Axes, corner: Point, width: float, height: float, lw: float = 1.3) -> None:
    """Draw the slider as a box with its lower left corner at a point."""
    place = (float(corner[0]), float(corner[1]))
    ax.add_patch(Rectangle(place, width, height, fc=BODY, ec=BLACK, lw=lw))


def join(
    ax: Axes, strokes: tuple[Stroke, ...], start: Point, end: Point, width: float = 0.1
) -> None:
    """Draw a spring or a damper between two points."""
    first = np.array(start, float)[:, None]
    way = np.array(end, float)[:, None] - first
    normal = np.array([-way[1], way[0]]) / np.hypot(*way)
    for stroke in strokes:
        along = way * np.array(stroke.along)
        aside = normal * (width * np.array(stroke.side))
        x, y = first + along + aside
        ax.plot(x, y, color=BLACK, lw=1.2)


def wall(ax: Axes, start: Point, end: Point, depth: Point) -> None:
    """Draw a line with hatching on the side of `depth`, a vector."""
    ax.plot(*np.transpose([start, end]), color=BLACK, lw=1.5)
    way = np.array(end) - np.array(start)
    for share in np.linspace(0, 1, LINES_OF_A_WALL):
        foot = np.array(start) + share * way
        ax.plot(*np.transpose([foot, foot + depth]), color=BLACK, lw=0.8)
