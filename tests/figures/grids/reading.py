"""What stands in a figure, to be compared."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure


def crosses(ax: Axes) -> list[list[float]]:
    """Where points are marked as failed, along the axis."""
    lines = [line for line in ax.lines if line.get_label() == "failed"]
    return [
        list(line.get_xdata() if line.get_transform() == ax.get_xaxis_transform() else line.get_ydata())
        for line in lines
    ]


def labels(figure: Figure) -> list[str]:
    """What the legends of a figure say."""
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]
