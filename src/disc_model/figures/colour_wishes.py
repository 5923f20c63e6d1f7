"""What a reader asks of the colours of a map of numbers."""

import math
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap

from disc_model.errors import require
from disc_model.figures.classes import WEIGHTS

LIGHTER = 0.2  # lightness of the middle of diverging colours over that of both ends, at least


@dataclass(frozen=True)
class ColourWishes:
    """What a reader asks of the colours of a map of numbers.

    log : whether the scale is logarithmic
    cmap : another colour map of matplotlib, or its name
    limits : numbers at the ends of the scale, in the unit of its bar
    linear : whether the scale is linear, even that of growth rates
    """

    log: bool = False
    cmap: str | Colormap | None = None
    limits: tuple[float, float] | None = None
    linear: bool = False

    @property
    def has_no_middle(self) -> bool:
        """Whether the colours asked for say nothing of a sign: their middle is not set apart."""
        return self.cmap is not None and not is_diverging(colormaps.get_cmap(self.cmap))

    def refuse_of_classes(self) -> None:
        """Raise `ParameterError` where words or flags are drawn, which have no scale."""
        rule = "is for numbers: classes have places and colours of their own"
        require(
            (self.cmap is None, "cmap", self.cmap, rule.replace("numbers", "maps of numbers")),
            (self.limits is None, "limits", self.limits, rule),
            (not self.log, "log", self.log, rule),
        )

    def refuse(self, *, of_lines: bool = False) -> None:
        """Raise `ParameterError` where there are no colours of numbers to choose; lines have limits all
        the same."""
        rule = "is for maps of numbers: classes and lines have colours of their own"
        require(
            (self.cmap is None, "cmap", self.cmap, rule),
            (of_lines or self.limits is None, "limits", self.limits, rule),
        )


USUAL = ColourWishes()


def are_limits(limits: Any) -> bool:
    """Whether these are the ends of a scale, or None."""
    if limits is None:
        return True
    if not isinstance(limits, tuple | list) or len(limits) != 2:
        return False
    numbers = all(isinstance(end, Real) and math.isfinite(end) for end in limits)
    return numbers and limits[0] < limits[1]


def is_colormap(cmap: object) -> bool:
    """Whether this is a colour map, its name, or nothing."""
    if isinstance(cmap, str):
        return cmap in colormaps
    return cmap is None or isinstance(cmap, Colormap)


def is_diverging(cmap: Colormap) -> bool:
    """Whether the middle of a colour map is lighter than both of its ends, or darker."""
    low, middle, high = (float(np.dot(cmap(place)[:3], WEIGHTS)) for place in (0.0, 0.5, 1.0))
    return middle - max(low, high) > LIGHTER or min(low, high) - middle > LIGHTER
