"""Quick plot of one run: contact force and disc displacement, one column for each recorded window."""

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from disc_model.data.variables import axis_of, typeset, values_text
from disc_model.errors import Fault, ParameterError

PANELS = ("P", "w")


def quicklook(result: Any) -> Figure:
    """Plot contact force (top) and disc displacement under the slider (bottom), one column for each window.

    result : a `disc_model.Result`, untyped since its module imports this one

    Envelope windows are drawn as bands.  Raises `ParameterError` if the result holds no window.
    """
    if not result.samples:
        example = "simulate(p, 20, windows={'all': Window(rate=2000)})"
        raise ParameterError(Fault(("windows",), "", f"must have one window or more to be drawn: {example}"))
    columns = len(result.samples)
    how: dict[str, Any] = {"sharex": "col", "squeeze": False, "layout": "constrained"}
    figure, axes = plt.subplots(len(PANELS), columns, figsize=(4.5 + 3.5 * (columns - 1), 5.0), **how)
    for column, window in enumerate(result.samples.values()):
        for row, name in enumerate(PANELS):
            label, scale = axis_of(name)
            _draw(axes[row, column], window, name, scale)
            if column == 0:
                axes[row, column].set_ylabel(label)
        _mark_separation(axes[:, column], window["time"], result.first_separation)
        axes[-1, column].set_xlabel("Time (s)")
    p = result.parameters
    figure.suptitle(typeset(f"{values_text(dict(p))}, {p.normalization.replace('_', ' ')}, {p.contact}"))
    return figure


def _draw(axes: Axes, window: Mapping[str, NDArray[np.float64]], name: str, scale: float) -> None:
    time = window["time"]
    if f"{name}_min" in window:
        low, high = window[f"{name}_min"] * scale, window[f"{name}_max"] * scale
        axes.fill_between(time, low, high, color="C0", linewidth=0)
    else:
        axes.plot(time, window[name] * scale, color="C0", linewidth=0.8)
    axes.margins(x=0)


def _mark_separation(axes: NDArray[Any], time: NDArray[np.float64], first: float) -> None:
    """Draw a line at the first separation if it lies within the window."""
    if time.size and time[0] <= first <= time[-1]:
        for panel in axes:
            panel.axvline(first, color="C3", linewidth=0.8, linestyle="--")
        style: dict[str, Any] = {"ha": "right", "va": "bottom", "fontsize": "small"}
        axes[0].annotate("first separation", (first, 1), xycoords=("data", "axes fraction"), **style)
