"""Maps of regions: outcome of the static start over two parameters, and growth rate of the cycle that it follows."""

import json
from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids import cells
from disc_model.figures.grids.growth_map import curves_of, draw_curves, parted
from disc_model.figures.grids.stability_map import finish, legend_above
from disc_model.figures.kinds import RegionMap
from disc_model.figures.parts import PAGE, new_figure


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: RegionMap) -> Figure:
    """Draw two panels for each normalization, outcomes and growth rates; the paper's cases are marked.

    Lines come from the further study ``curves``, if it is given, and else lie between cells.
    """
    norms = parts.normalizations(study)
    figure = new_figure(PAGE, 5.6)
    axes = figure.subplots(2, len(norms), sharex=True, sharey=True, squeeze=False)
    lines: list[Artist] = []
    outcomes: set[str] = set()
    parts.letters(axes.ravel(), [parts.MODES[norm] for norm in norms])
    panels = [parts.of(study, norm) for norm in norms]
    gaps = cells.growth_panels(figure, axes[1], panels, plot.x, plot.y) - {"alone"}
    for column, one in zip(axes.T, panels, strict=True):
        outcomes |= cells.outcome_cells(column[0], one, plot.x, plot.y)
        for ax in column:
            lines += _curves(ax, one, overlays) if "curves" in overlays else _borders(ax, one, plot)
    above: list[Artist] = [*cells.patches(cells.CELL_LOOKS, outcomes)]
    above += {line.get_label(): line for line in lines}.values()
    legend_above(figure, [*above, *finish(axes, study, plot)])
    below: list[Artist] = list(cells.patches(cells.CYCLE_LOOKS, gaps))
    below.append(Line2D([], [], linestyle="", label="\n".join(_captions(study, plot))))
    figure.legend(handles=below, loc="outside lower center", ncols=len(below), handlelength=1.2)
    return figure


def _curves(ax: Axes, data: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> list[Artist]:
    """Draw continued curves of the map's cycle; growth maps show their numbers."""
    norm = parts.normalizations(data)[0]
    found = parted(curves_of(parts.of(overlays["curves"], norm)), data)[0]
    return list(draw_curves([ax], [[curve.unnumbered for curve in found]], []))


def _borders(ax: Axes, data: xr.Dataset, plot: RegionMap) -> list[Artist]:
    """Draw borders between cells: where the same cycle changes its stability, and where a stable one ends.

    A cycle ends where the next cell has no cycle and the motion does not stay quiet there. A start that follows no
    cycle, or another one, does not prove an end. Nothing is drawn around unresolved cells.
    """
    x, y = cells.edges_of(data, plot.x, plot.y)
    state = cells.stability_of(data, plot.x, plot.y)
    state[cells.unresolved(state)] = "unresolved"
    stable, unstable = state == "stable", state == "unstable"
    gone = cells.words_of(data, "cycle", plot.x, plot.y) == "no_cycle"
    gone &= cells.words_of(data, "outcome", plot.x, plot.y) != "quiet"
    # the axes of the study's plane may be exchanged
    names = ("branch_continues_first", "branch_continues_second")
    up, right = names if str(data["outcome"].dims[0]) == plot.y else names[::-1]
    found: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    for joined, ahead, here, ends in (
        (up, np.s_[1:, :], np.s_[:-1, :], lambda i, j: [(x[j], y[i + 1]), (x[j + 1], y[i + 1])]),
        (right, np.s_[:, 1:], np.s_[:, :-1], lambda i, j: [(x[j + 1], y[i]), (x[j + 1], y[i + 1])]),
    ):
        same = cells.words_of(data, joined, plot.x, plot.y)[here] == "yes"
        changes = (stable[here] & unstable[ahead]) | (unstable[here] & stable[ahead])
        stops = (stable[here] & gone[ahead]) | (gone[here] & stable[ahead])
        found["neutral"] += [ends(i, j) for i, j in np.argwhere(changes & same)]
        found["fold"] += [ends(i, j) for i, j in np.argwhere(stops)]
    for kind, lines in found.items():
        ax.add_collection(
            LineCollection(lines, capstyle="projecting" if kind == "neutral" else None, **parts.border(kind))
        )
    return [Line2D([], [], **parts.border(kind)) for kind, lines in found.items() if lines]


def _captions(study: xr.Dataset, plot: RegionMap) -> Iterator[str]:
    """Captions: the horizon, and disagreements between paper, start and cycle."""
    yield f"Within {json.loads(study.attrs['options'])['horizon']:g} s of the static start."
    if "as_published" not in parts.normalizations(study):
        return
    data = parts.of(study, "as_published")
    for name, mark in plot.marks.items():
        here = data.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome, rate = str(flag_names(here["outcome"])), float(here["growth_rate"])
        found = cells.OUTCOME_LOOKS[outcome].label
        if outcome != mark.paper_outcome:
            stated = cells.OUTCOME_LOOKS[mark.paper_outcome].label
            yield f"{name}: paper: “{stated}”, static start: {found}."
        if (outcome == "quiet") != (rate < 0) and np.isfinite(rate):
            kind = "stable" if rate < 0 else "unstable"
            why = "another motion is reached" if rate < 0 else "its growth is not seen within the horizon"
            yield f"{name}: {found}, beside a cycle that is {kind} ({rate:.2g}/s): {why}."
