"""How many starts a share is of, and the confidence interval of the share that separates, on bars and on
lines."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.path import Path
from matplotlib.transforms import ScaledTranslation

from disc_model.data.variables import stated_in
from disc_model.display import counted
from disc_model.figures.drawing import BLACK, GREY, halo, mark, sample, wide
from disc_model.figures.selection import parts_along, remaining
from disc_model.figures.types import Array, Artist, Axes
from disc_model.figures.words import label_of

SEPARATING = "separating"
SHARE = "separating_fraction"
OF_SHARE = "interval of the share that separates"
CORNERS = [(-0.4, -1), (0.4, -1), (0, -1), (0, 1), (-0.4, 1), (0.4, 1)]
INTERVAL = Path(CORNERS, 3 * [Path.MOVETO, Path.LINETO])
"""Mark of an interval in a legend: a line between two short ones,"""
BAR = Path([(0, -1), (0, 1)], [Path.MOVETO, Path.LINETO])
"""and a line alone, as at points of lines."""
FAINT = 0.6  # opacity of intervals there, so that those of other lines show,
APART = 2.0  # and points by which those of each further line stand to the right of its points


def share_of_starts(study: xr.Dataset, variable: str) -> str:
    """What the axis of shares says: of how many starts they are, if the study states it."""
    options = stated_in(study, "options")
    number = options.get("n_starts")
    energies = options.get("energies")
    if not isinstance(number, int) or not isinstance(energies, list):
        return label_of(study[variable])[0]
    if variable == "basin_fraction":  # of the starts of all energies
        number *= len(energies)
    return share_text(number)


def share_text(number: int) -> str:
    """The name of shares of a number of starts."""
    return f"Share of {counted(number, 'start')}"


def interval_of(study: xr.Dataset, variable: str) -> xr.Dataset | None:
    """The ends of the confidence interval of the share of the starts that separate, the lower one first;
    None if the study does not have them."""
    names = [f"{variable}_low", f"{variable}_high"]
    if not {*names} <= {*study} or SEPARATING not in study["attractor_class"]:
        return None
    return study[names].sel(attractor_class=SEPARATING, drop=True)


def draw_interval(ax: Axes, interval: xr.Dataset | None, along: Array) -> None:
    """Draw the interval of the share that separates on each bar, at the places `along`, also where no
    start or each of them separates."""
    if interval is None:
        return
    look: dict[str, Any] = {"linewidth": wide(0.9), "markersize": mark(4), "marker": "_"}
    ends = interval.to_dataarray().transpose("variable", ...).values
    for place, (low, high) in zip(along, ends.T, strict=True):
        ax.plot([place, place], [low, high], color=BLACK, path_effects=halo(2.5), zorder=3, **look)


def entries_of_interval(study: xr.Dataset, variable: str) -> list[Artist]:
    """The entry of a legend for the intervals that are drawn, with their level, if any are."""
    interval = interval_of(study, variable)
    if interval is None or not interval.to_dataarray().notnull().any():
        return []
    look: dict[str, Any] = {"color": BLACK, "markersize": mark(8), "markeredgewidth": wide(0.9)}
    return [sample(label=_name_of_interval(study), linestyle="", marker=INTERVAL, **look)]


def _name_of_interval(study: xr.Dataset) -> str:
    """What legends call the intervals, with their level if the study states it."""
    level = stated_in(study, "options").get("confidence")
    return OF_SHARE if level is None else f"{100 * level:g} % {OF_SHARE}"


# ---- Lines


def draw_intervals_of_lines(
    ax: Axes, study: xr.Dataset, array: xr.DataArray, x: str, colours: Mapping[str, Any]
) -> None:
    """Draw the interval of the share that separates at each point of lines, in their colours by name:
    also where no share is known; those of a panel have one entry in the legend."""
    ends = [f"{array.name}_low", f"{array.name}_high"]
    if array.name != SHARE or not {*ends} <= {*study}:
        return
    by = remaining(array, [x])
    along = array[x].values * label_of(array[x])[1]
    lows, highs = (parts_along(study[end], by) for end in ends)
    page: Any = ax.get_figure(root=True)
    for number, (low, high) in enumerate(zip(lows, highs, strict=True)):
        aside = ScaledTranslation(number * mark(APART) / 72, 0, page.dpi_scale_trans)
        look: dict[str, Any] = {"linewidth": wide(0.6), "alpha": FAINT, "label": "_nolegend_"}
        between = np.full(along.size, np.nan)  # the bars are one line with gaps
        heights = np.column_stack([low.data.values, high.data.values, between])
        look |= {"color": colours[low.name], "transform": ax.transData + aside}
        ax.plot(np.repeat(along, 3), heights.ravel(), **look)
        for end in (low, high):  # lines that stand aside do not count by themselves
            ax.update_datalim(np.column_stack([along, end.data.values]))
    ax.autoscale_view()
    name = _name_of_interval(study)
    if name not in ax.get_legend_handles_labels()[1]:
        bar: dict[str, Any] = {"markersize": mark(8), "markeredgewidth": wide(0.6)}
        ax.plot([], [], linestyle="", marker=BAR, color=GREY, label=name, **bar)


def names_interval(name: str) -> bool:
    """Whether an entry of a legend is that of the intervals."""
    return name.endswith(OF_SHARE)
