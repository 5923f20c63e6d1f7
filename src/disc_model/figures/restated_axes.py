"""Axes in the units of the reader."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullFormatter

from disc_model.data.variables import SHOWN, typeset
from disc_model.figures.drawing import DECADES
from disc_model.figures.types import Figure
from disc_model.figures.words import UNITS


def restate_axes(figure: Figure, key_by_label: Mapping[str, str] = MappingProxyType({})) -> None:
    """Give axes in the units of the reader: their labels and ticks; what is drawn stays.

    key_by_label : the parameter or sampled variable that has the unit of an axis, by labels that do not
        begin with its name
    """
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            for name, (unit, factor) in UNITS.get().items():
                shown = SHOWN[name]
                text = axis.get_label_text()
                known = typeset(f"{shown.name} {shown.symbol}".strip())
                is_meant = text.startswith(known) or key_by_label.get(text) == name
                if is_meant and text.endswith(f"({shown.unit})"):
                    axis.set_label_text(text.removesuffix(f"({shown.unit})") + f"({unit})")
                    _set_ticks(axis, factor / shown.factor)


def _set_ticks(axis: Any, ratio: float) -> None:
    """Set ticks at round numbers of another unit, `ratio` of which are one of the axis's: powers of ten
    on a scale that is not linear, unless it shows fewer than two of them."""
    low, high = ratio * np.asarray(axis.get_view_interval())
    ticks = np.asarray(DECADES)
    if axis.get_scale() == "linear" or np.count_nonzero((ticks >= low) & (ticks <= high)) < 2:
        ticks = np.asarray(MaxNLocator(7, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    axis.set_major_locator(FixedLocator((ticks / ratio).tolist()))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value * ratio:.6g}"))
    axis.set_minor_formatter(NullFormatter())  # its numbers would be those of the other unit
