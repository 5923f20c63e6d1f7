"""What stands in a figure, to be compared."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D


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
