"""Arrows beside points whose value is the bound of its search, and may lie beyond it."""

from typing import Any

from matplotlib.transforms import ScaledTranslation

from disc_model.figures.classes import AT_BOUND
from disc_model.figures.drawing import large, mark
from disc_model.figures.types import Array, Axes

DIRECTIONS = {"down": (0, -1), "left": (-1, 0)}


def draw_arrows(ax: Axes, x: Array, y: Array, colour: str, direction: str, size: float) -> None:
    """Set an arrow beside each point, at its distance and of its size in points; those of a panel
    have one entry in the legend."""
    label = "_nolegend_" if has_arrows(ax) else AT_BOUND.label
    page: Any = ax.get_figure(root=True)
    across, up = DIRECTIONS[direction]
    distance = large(size) / 72
    beside = ScaledTranslation(across * distance, up * distance, page.dpi_scale_trans)
    ax.plot(
        x,
        y,
        linestyle="",
        marker=rf"$\{direction}arrow$",
        color=colour,
        label=label,
        markersize=mark(size),
        markeredgewidth=0,
        transform=ax.transData + beside,
        clip_on=False,
    )


def has_arrows(ax: Axes) -> bool:
    """Whether a panel has such arrows."""
    return AT_BOUND.label in ax.get_legend_handles_labels()[1]
