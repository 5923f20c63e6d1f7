"""Looks of lines, words, and panels of the benchmark's figures."""

from pathlib import Path
from typing import Any, NamedTuple

import yaml

from disc_model.figures import drawing
from disc_model.figures.types import Axes, Figure

Look = dict[str, Any]
"""Arguments of matplotlib on how something looks."""

TEXTS = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
"""Words of the figures, and the looks of lines by their names."""


def _looks() -> dict[str, Look]:
    """Return the looks of lines, with colours of `drawing` instead of their names."""
    looks = {}
    for name, look in TEXTS["lines"].items():
        looks[name] = {**look, "color": getattr(drawing, look["color"])}
    return looks


class Setting(NamedTuple):
    """Words of a method's setting."""

    axis: str
    phrase: str
    """How a cell of prices says its value."""


SETTINGS = {name: Setting(*words) for name, words in TEXTS["settings"].items()}
LINES = _looks()
"""Colour, marker and line style of each method and map, and of lines that belong to no method."""
OUTLINE = drawing.halo()


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
    figure, axes = drawing.panels(drawing.PAGE, row * rows + more, rows, columns, **shared)
    for ax in axes[count:]:
        ax.set_axis_off()
    for ax in axes[::columns]:
        ax.set_ylabel(ylabel)
    return figure, axes[:count]
