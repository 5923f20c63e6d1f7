"""Figures from made-up studies, and what stands in them."""

from collections.abc import Mapping
from typing import Any

import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from disc_model.figures import drawing
from disc_model.figures.kinds import PLOTS

ON_EACH_SCALE = pytest.mark.parametrize(
    ("x", "values", "scale"),
    [("Omega", [5.0, 10, 20], "linear"), ("D_star", [0, 1e-6, 1e-4], "symlog"), ("m", [0.01, 0.1, 1], "log")],
)
"""A parameter that maps show on each, with three values."""


def draw(kind: str, study: xr.Dataset, others: Mapping[str, xr.Dataset] | None = None, **phrase: Any) -> Figure:
    """A figure of a kind, as a file asks for it, with further studies by their roles."""
    shown = {"study": study, **(others or {})}
    plot = PLOTS[kind].model_validate({"kind": kind, **phrase})
    return drawing.draw(plot, {name: xr.DataTree(one) for name, one in shown.items()})


def crosses(ax: Axes) -> list[list[float]]:
    """Where points are marked as failed, along the axis."""
    lines = [line for line in ax.lines if line.get_label() == "failed"]
    return [
        list(line.get_xdata() if line.get_transform() == ax.get_xaxis_transform() else line.get_ydata())
        for line in lines
    ]


def labels(shown: Figure | Axes) -> list[str]:
    """What the legends of a figure, or that of a panel, say."""
    legends = shown.legends if isinstance(shown, Figure) else [shown.get_legend()]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


def lines(ax: Axes) -> dict[str, Line2D]:
    """By what they are called."""
    return {str(line.get_label()): line for line in ax.lines}
