"""What a figure says and shows along its axes, so that it can be compared with its data: the label's
words, its unit, and the drawn values."""

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pint
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection, QuadMesh
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Rectangle
from numpy.typing import ArrayLike

UREG = pint.UnitRegistry()
PLAIN = {"²": "**2", "³": "**3", "μ": "u", "µ": "u", "10⁻⁵ ": "1e-5 * ", "\xa0": " "}
"""Signs of labels in the notation of pint, but for products."""
WORDS = {"dB re strongest line"}
"""What stands in the brackets of a label, and is no unit."""


class Shown(NamedTuple):
    """What one axis has to show.

    panel : number of the axes in the figure
    axis : "x", "y" or "bar" for the label of a colour bar, whose values are those of its panel
    words : what the label says before the unit
    values : in the unit `si`
    si : unit of the values, "" for none
    scale : "linear", "log", ... of the axis; None if it does not matter
    """

    panel: int
    axis: str
    words: str
    values: ArrayLike
    si: str = ""
    scale: str | None = None


def assert_shows(figure: Figure, expected: Shown) -> None:
    """The label names the quantity, and the drawn values are the expected ones in the label's
    unit."""
    ax = figure.axes[expected.panel]
    letter = expected.axis.replace("bar", "y")
    label = label_along(ax, letter)
    words, unit = parts_of(label)
    assert words == expected.words
    factor = 1.0
    if expected.si or unit:
        factor = UREG.Quantity(1, in_pint(expected.si)).to(in_pint(unit)).magnitude
    wanted = factor * np.asarray(expected.values, dtype=float).ravel()
    wanted = wanted[np.isfinite(wanted)]
    assert wanted.size, "a comparison with nothing"
    if expected.axis == "bar":
        found = bar_values(ax)
    else:
        found = drawn_values(ax, expected.axis)
    size = float(np.abs(wanted).max()) or 1.0
    for value in wanted:
        # single precision of vertices that matplotlib keeps of some collections
        assert np.abs(found - value).min() <= 2e-6 * size, (expected.words, label, value)
    if expected.scale is not None:
        assert getattr(ax, f"get_{letter}scale")() == expected.scale, expected.words


def label_along(ax: Axes, letter: str) -> str:
    """The label of an axis, or of the panel beside or below that shares it."""
    group = getattr(ax, f"get_shared_{letter}_axes")().get_siblings(ax)
    labels = [getattr(each, f"get_{letter}label")() for each in (ax, *group)]
    return next(filter(None, labels), "")


def parts_of(label: str) -> tuple[str, str]:
    """Words of a label, and its unit, "" without one; wherever its lines are broken."""
    text = " ".join(label.replace("$", "").split())
    found = re.fullmatch(r"(.*) \(([^()]+)\)", text)
    if found is None or found[2] in WORDS:
        return text, ""
    return found[1], found[2]


def in_pint(unit: str) -> str:
    """A unit of a label, such as N s/m, as pint reads it."""
    for sign, plain in PLAIN.items():
        unit = unit.replace(sign, plain)
    return re.sub(r"(?<=[A-Za-z]) (?=[A-Za-z])", "*", unit) or "dimensionless"


def drawn_values(ax: Axes, axis: str) -> np.ndarray:
    """All finite values along an axis that something is drawn at, and sizes of bars."""
    place = 1
    if axis == "x":
        place = 0
    values = [np.ravel(part) for part in _along(ax, place)]
    found = np.concatenate([np.asarray(part, dtype=float) for part in values] or [np.zeros(0)])
    return found[np.isfinite(found)]


def _along(ax: Axes, i: int) -> Iterator[ArrayLike]:
    data = ax.transData
    across = (ax.get_xaxis_transform(), ax.get_yaxis_transform())[i]
    for line in ax.get_children():
        if isinstance(line, Line2D) and line.get_transform() in (data, across):
            yield np.asarray(line.get_xydata(), dtype=float)[:, i]
    for shape in ax.collections:
        if isinstance(shape, PathCollection):
            yield np.ma.filled(np.ma.asarray(shape.get_offsets(), dtype=float), np.nan)[:, i]
        elif isinstance(shape, QuadMesh):
            corners = shape.get_coordinates()[..., i]
            yield corners
            yield 0.5 * (corners[1:, 1:] + corners[:-1, :-1])
        elif isinstance(shape, LineCollection | PolyCollection):
            for path in shape.get_paths():
                yield path.vertices[:, i]
    for patch in ax.patches:
        if isinstance(patch, Rectangle):
            start = patch.get_xy()[i]
            size = (patch.get_width(), patch.get_height())[i]
            yield [start, start + size, start + size / 2, size]
        elif isinstance(patch, PathPatch):
            corners = patch.get_path().vertices[:, i]
            yield corners
            if patch.get_fill() and corners.size % 5 == 0:  # cells, each closed
                yield corners.reshape(-1, 5)[:, :4].mean(axis=1)


def bar_values(bar: Axes) -> np.ndarray:
    """The numbers that panels of the figure show in the colours of a bar."""
    found = [
        np.ma.filled(np.ma.asarray(shape.get_array(), dtype=float), np.nan).ravel()
        for ax in bar.figure.axes
        for shape in ax.collections
        if shape.get_array() is not None and np.ndim(shape.get_array()) < 3
    ]
    values = np.concatenate(found)
    return values[np.isfinite(values)]
