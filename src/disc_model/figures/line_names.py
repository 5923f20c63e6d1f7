"""Names of the lines of a panel: beside their ends where these are apart, else in a legend."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from disc_model.figures.classes import AT_BOUND, DOUBTS, FILLED_MARK
from disc_model.figures.drawing import BLACK, large, say_beside
from disc_model.figures.head_texts import CHARACTER
from disc_model.figures.legends import figure_legend, keep_share, small
from disc_model.figures.separating_share import names_interval
from disc_model.figures.types import Artist, Axes, Figure

MOST_BESIDE = 4  # names of lines from which the legend stands beside the panel
MANY = 8  # names of lines in a legend beyond which their text is smaller
LONGEST_BESIDE = 25  # characters of a name that fits there
APART = 0.14  # least distance of the ends of lines that are named there, inch of the row of panels
IN_LEGEND = (AT_BOUND.label, *(FILLED_MARK.format(look.label) for look in DOUBTS))
"""Marks that only a legend names."""
WIDEST_NAME = 0.35  # width of such a name, as a share of the page


def name_lines(figure: Figure, axes: Sequence[Axes], several: bool, in_legend: bool) -> None:
    """Name lines at their ends, if there is room, or in a legend.

    several : whether there are panels
    in_legend : whether there is a legend in any case
    """
    unnamed: dict[str, Artist] = {}
    for ax in axes:
        handles, names = ax.get_legend_handles_labels()
        marked = any(words in names for words in IN_LEGEND)
        marked = marked or any(map(names_interval, names))
        if names and (in_legend or marked or not name_ends(ax)):
            unnamed.update(zip(names, handles, strict=True))
    longest = max(map(len, unnamed), default=0)
    if len(unnamed) > MOST_BESIDE and longest < LONGEST_BESIDE and not several:
        figure_legend(figure, [*unnamed.values()], columns=1, loc="outside right center")
    else:
        size = small() if len(unnamed) > MANY else {}
        legend = figure_legend(figure, [*unnamed.values()], columns=3, **size)
        keep_share(figure, legend)


# ---- Lines


def name_ends(ax: Axes) -> bool:
    """Write the names of lines beside their right ends, if all end there and apart from each other;
    else do nothing."""
    low, high = ax.get_ylim()
    lines: list[Any] = ax.get_legend_handles_labels()[0]
    ends = np.array([line.get_ydata()[-1] for line in lines])
    apart = np.diff(np.sort(ends)) / (high - low)
    widest = CHARACTER * max((len(str(line.get_label())) for line in lines), default=0)
    page: Any = ax.get_figure(root=True)
    place = ax.get_subplotspec()
    rows = place.get_gridspec().nrows if place is not None else 1
    row = page.get_figheight() / rows
    if widest > WIDEST_NAME * page.get_figwidth():
        return False
    if len(lines) < 2 or not (row * apart > APART).all() or ax.get_yscale() != "linear":
        return False
    for line, end in zip(lines, ends, strict=True):
        line.set_color(BLACK)
        say_beside(ax, end, line.get_label(), fontsize=large(7))
    return True
