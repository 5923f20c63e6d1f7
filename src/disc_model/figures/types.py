"""Types of what figures are made of: arrays of values, and the objects of matplotlib."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from numpy.typing import NDArray

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

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Mask = NDArray[np.bool_]
Words = NDArray[np.str_]
Indices = NDArray[np.int64]
