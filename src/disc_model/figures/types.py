"""Types of what figures are made of: arrays of values, and the objects of matplotlib."""

from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from disc_model.arrays import Array, ComplexArray, Indices, Mask, Words

Legend = Any
"""A legend of matplotlib, some of whose methods its types do not know."""

__all__ = [
    "Array",
    "Artist",
    "Axes",
    "ComplexArray",
    "Figure",
    "FigureBase",
    "Indices",
    "Legend",
    "Mask",
    "Words",
]
