"""Maps of regions: outcomes over two parameters as cells, and below them the growth rates of the cycle."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names, stated_in
from disc_model.errors import Fault
from disc_model.figures import cells, drawing
from disc_model.figures.cells import CYCLE_LOOKS, OUTCOME_LOOKS, growth_panels, patches
from disc_model.figures.curves import curves_of, draw_curves, parted, span
from disc_model.figures.drawing import BORDERS, MODES, PAGE, Artist, Axes, Figure, Line2D, panels
from disc_model.figures.kind import CURVES, Roles, Values
from disc_model.figures.stability_map import StabilityMap, finish, legend_above, planes


class RegionMap(StabilityMap):
    """Regions of outcomes over two parameters, and the growth rate of the cycle below."""

    quantities = ("regions",)
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["region_map"] = "region_map"  # type: ignore[assignment]

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults as of any map; in addition, curves over speed and preload need that plane."""
        yield from super().faults(values)
        if "curves" in self.overlays and (self.x, self.y) != ("Omega", "N"):
            yield Fault.of(("overlays", "curves"), self.overlays["curves"], "needs x: Omega and y: N")

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw two panels for each normalization, outcomes and growth rates; the paper's cases are marked.

        Lines come from the further study ``curves``, if it is given, and else lie between cells.
        """
        norms = drawing.normalizations(study)
        shown = planes(study, norms, self)
        figure, axes = panels(PAGE, 5.6, 2, len(norms), sharex=True, sharey=True)
        above, below = axes[: len(norms)], axes[len(norms) :]
        drawing.letters(axes, [MODES[norm] for norm in norms])
        gaps = growth_panels(figure, below, shown) - {"alone"}
        # branches are continued along the study's first dimension, which may be either axis
        upward = [name for name in study["outcome"].dims if name in (self.x, self.y)] == [self.y, self.x]
        outcomes: set[str] = set()
        lines: list[Artist] = []
        for upper, lower, plane in zip(above, below, shown, strict=True):
            outcomes |= cells.outcome_cells(upper, plane["outcome"])
            for ax in (upper, lower):
                lines += _curves(ax, plane, overlays["curves"]) if "curves" in overlays else _borders(ax, plane, upward)
        named = {line.get_label(): line for line in lines}.values()
        legend_above(figure, [*patches(cells.CELL_LOOKS, outcomes), *named, *finish(axes, study, self)])
        said = drawing.sample(linestyle="", label="\n".join(_captions(study, self)))
        handles = [*patches(CYCLE_LOOKS, gaps), said]
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
        return figure


def _curves(ax: Axes, data: xr.Dataset, curves: xr.Dataset) -> list[Line2D]:
    """Draw continued curves of the map's cycle, within its points; growth maps show their numbers."""
    paths = []
    for curve in parted(curves_of(drawing.of(curves, drawing.normalizations(data)[0])), data)[0]:
        along = {"Omega": curve.Omega, "N": curve.N}
        inside = [values == np.clip(values, *span(data[name].values)) for name, values in along.items()]
        paths.append(replace(curve, N=np.where(np.all(inside, axis=0), curve.N, np.nan), label=""))
    return draw_curves([ax], [paths], [])


def _borders(ax: Axes, data: xr.Dataset, upward: bool) -> list[Line2D]:
    """Draw borders between cells: where the same cycle changes its stability, and where a stable one ends.

    A cycle ends where the next cell has no cycle and the motion does not stay quiet there. A start that follows no
    cycle, or another one, does not prove an end. Nothing is drawn around unresolved cells.

    upward : whether the study's first dimension is the vertical one
    """
    from matplotlib.collections import LineCollection

    x, y = cells.edges_of(data["outcome"])
    state = cells.stability_of(data)
    state[cells.unresolved(state)] = "unresolved"
    stable, unstable = state == "stable", state == "unstable"
    gone = (flag_names(data["cycle"]) == "no_cycle") & (flag_names(data["outcome"]) != "quiet")
    names = ("branch_continues_first", "branch_continues_second")
    up, right = names if upward else names[::-1]
    segments: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    for joined, ahead, current, ends in (
        (up, np.s_[1:, :], np.s_[:-1, :], lambda i, j: [(x[j], y[i + 1]), (x[j + 1], y[i + 1])]),
        (right, np.s_[:, 1:], np.s_[:, :-1], lambda i, j: [(x[j + 1], y[i]), (x[j + 1], y[i + 1])]),
    ):
        same = flag_names(data[joined])[current] == "yes"
        changes = (stable[current] & unstable[ahead]) | (unstable[current] & stable[ahead])
        stops = (stable[current] & gone[ahead]) | (gone[current] & stable[ahead])
        segments["neutral"] += [ends(i, j) for i, j in np.argwhere(changes & same)]
        segments["fold"] += [ends(i, j) for i, j in np.argwhere(stops)]
    for kind, lines in segments.items():
        ax.add_collection(LineCollection(lines, capstyle="projecting" if kind == "neutral" else None, **BORDERS[kind]))
    return [drawing.sample(**BORDERS[kind]) for kind, lines in segments.items() if lines]


def _captions(study: xr.Dataset, plot: RegionMap) -> Iterator[str]:
    """Captions: the horizon, and disagreements between paper, start and cycle."""
    yield f"Within {stated_in(study, 'options')['horizon']:g} s of the static start."
    if "as_published" not in drawing.normalizations(study):
        return
    data = drawing.of(study, "as_published")
    for name, mark in plot.marks.items():
        point = data.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome, rate = str(flag_names(point["outcome"])), float(point["growth_rate"])
        label = OUTCOME_LOOKS[outcome].label
        if outcome != mark.paper_outcome:
            stated = OUTCOME_LOOKS[mark.paper_outcome].label
            yield f"{name}: paper: “{stated}”, static start: {label}."
        if (outcome == "quiet") != (rate < 0) and np.isfinite(rate):
            kind = "stable" if rate < 0 else "unstable"
            why = "another motion is reached" if rate < 0 else "its growth is not seen within the horizon"
            yield f"{name}: {label}, beside a cycle that is {kind} ({rate:.2g}/s): {why}."
