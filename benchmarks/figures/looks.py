"""Looks of lines, words, and panels of the benchmark's figures."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from disc_model.figures import looks
from disc_model.figures.draw import PAGE

Look = dict[str, Any]
"""Arguments of matplotlib on how something looks."""

TEXTS = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
"""Words of the figures, and the looks of lines by their names."""


def _looks() -> dict[str, Look]:
    """Return the looks of lines, with colours instead of their names."""
    found = {}
    for name, look in TEXTS["lines"].items():
        found[name] = {**look, "color": getattr(looks, look["color"], look["color"])}
    return found


class Setting(NamedTuple):
    """Words of a method's setting."""

    axis: str
    phrase: str
    """How a cell of prices says its value."""


SETTINGS = {name: Setting(*words) for name, words in TEXTS["settings"].items()}
LINES = _looks()
"""Colour, marker and line style of each method and map, and of lines that belong to no method."""
OUTLINE = [withStroke(linewidth=1.5, foreground="white")]


def panels(
    width: float, height: float, rows: int = 1, columns: int = 1, **shared: Any
) -> tuple[Figure, list[Axes]]:
    """Create a figure of a size in inches with panels, row by row."""
    figure = Figure(figsize=(width, height), layout="constrained")
    axes: Any = figure.subplots(rows, columns, squeeze=False, **shared)
    return figure, list(axes.flat)


def letter(ax: Axes, text: str, title: str = "", **look: Any) -> None:
    """Write a panel's letter above its upper left corner, and its subject."""
    ax.set_title(f"({text}) {title}".strip(), loc="left", **look)


def say(
    ax: Axes, text: str, point: tuple[float, float], offset: tuple[float, float], **look: Any
) -> None:
    """Write a few words beside a point, on the side to which an offset in points leads."""
    across, up = np.sign(offset)
    side: Any = {-1: "right", 0: "center", 1: "left"}[across]
    height: Any = {-1: "top", 0: "center", 1: "bottom"}[up]
    ax.annotate(text, point, offset, textcoords="offset points", ha=side, va=height, **look)


def row_panels(
    count: int, ylabel: str, columns: int, row: float, more: float = 0.0, **shared: Any
) -> tuple[Figure, list[Axes]]:
    """Create panels.

    Parameters
    ----------
    count : number of panels
    ylabel : of the first in each row
    columns : number of columns
    row : height of a row, inches
    more : height that is left for the legend, inches
    shared : as `Figure.subplots` has it
    """
    rows = -(-count // columns)
    figure, axes = panels(PAGE, row * rows + more, rows, columns, **shared)
    for ax in axes[count:]:
        ax.set_axis_off()
    for ax in axes[::columns]:
        ax.set_ylabel(ylabel)
    return figure, axes[:count]
