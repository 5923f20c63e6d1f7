"""Types of what figures are made of: arrays of values, and the objects of matplotlib."""

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from disc_model.arrays import Array, ComplexArray, Indices, Mask, Words

__all__ = [
    "Array",
    "Artist",
    "Axes",
    "ComplexArray",
    "Figure",
    "FigureBase",
    "Indices",
    "Mask",
    "Words",
]
