"""Maps of regions: what becomes of the published start over two parameters, and the growth of the cycle it follows."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids import cells
from disc_model.figures.grids.stability_map import legend_below_head, paper_ring, paper_rings, set_scales
from disc_model.figures.kinds import RegionMap
from disc_model.figures.parts import PAGE, new_figure

PALER = 0.35
"""How far the colours of what is inferred are from the others' towards white."""
LARGE = 0.02
"""Share of a map's points from which on a branch is named."""
NAMES = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
Mask = NDArray[np.bool_]


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: RegionMap) -> Figure:
    """Two panels for each normalization: outcomes, and growth rates; the paper's cases are marked."""
    norms = parts.normalizations(study)
    figure = new_figure(PAGE, 5.6)
    axes = figure.subplots(2, len(norms), sharex=True, sharey=True, squeeze=False)
    kinds: set[str] = set()
    are_named = False
    for column, norm in enumerate(norms):
        one = parts.of(study, norm)
        _outcomes(axes[0, column], one, plot)
        mesh = cells.growth_cells(axes[1, column], one, plot.x, plot.y)
        are_named |= _branches(axes[1, column], one, plot)
        for row in range(2):
            parts.letter(axes[row, column], "abcd"[row * len(norms) + column], "" if row else parts.MODES[norm])
            kinds |= _borders(axes[row, column], one, plot)
    set_scales(axes, study, plot)
    for ax, norm in zip(axes[0], norms, strict=True):
        if norm == "as_published":
            _marks(ax, plot)
    cells.growth_bar(figure, mesh, list(axes[1]))
    _legends(figure, study, plot, kinds, are_named)
    return figure


def _outcomes(ax: Axes, data: xr.Dataset, plot: RegionMap) -> None:
    """Outcomes, paler where they were not worked out."""
    edges, words = cells.edges_of(data, plot.x, plot.y), cells.words_of(data, "outcome", plot.x, plot.y)
    inside = cells.words_of(data, "origin", plot.x, plot.y) == "undivided_cell"
    cells.fill(ax, edges, np.where(inside, "", words), cells.OUTCOMES)
    inferred = {name: cells.paler(look, PALER) for name, look in cells.OUTCOMES.items()}
    cells.fill(ax, edges, np.where(inside, words, ""), inferred)


def branches(followed: Mask, up: Mask, right: Mask) -> NDArray[np.int64]:
    """Number of the branch at each point, the largest 0; -1 where no cycle is followed: shape (rows, columns).

    up, right : whether the cycle goes on into the point of the next row, or column; shape (rows, columns)
    """
    number = np.arange(followed.size).reshape(followed.shape)
    here = np.concatenate([number[:-1][up[:-1]], number[:, :-1][right[:, :-1]]])
    there = np.concatenate([number[1:][up[:-1]], number[:, 1:][right[:, :-1]]])
    graph = coo_array((np.ones(len(here)), (here, there)), shape=(followed.size,) * 2)
    _, labels = connected_components(graph, directed=False)
    sizes = np.bincount(labels[followed.ravel()], minlength=labels.max() + 1)
    rank = np.empty_like(sizes)
    rank[np.argsort(-sizes, kind="stable")] = np.arange(len(sizes))
    return np.where(followed, rank[labels].reshape(followed.shape), -1)


def named(labels: NDArray[np.int64]) -> Iterator[tuple[str, int, int]]:
    """Names of the large branches, the largest A, each with row and column of the point nearest to its middle."""
    for label, name in enumerate(NAMES):
        places = np.argwhere(labels == label)
        if len(places) < LARGE * labels.size:
            return
        row, column = places[np.argmin(np.sum((places - places.mean(axis=0)) ** 2, axis=1))]
        yield name, int(row), int(column)


def _branches(ax: Axes, data: xr.Dataset, plot: RegionMap) -> bool:
    """Name the branches of the cycle; whether there are any that are large enough."""
    followed = cells.words_of(data, "cycle", plot.x, plot.y) == "followed"
    x, y = (data[name].values * parts.axis_of(name)[1] for name in (plot.x, plot.y))
    found = list(named(branches(followed, *_joined(data, plot))))
    look: dict[str, Any] = {"ha": "center", "va": "center", "zorder": 4, "path_effects": parts.halo(2.0)}
    for name, row, column in found:
        ax.text(x[column], y[row], name, fontsize=8, fontweight="bold", **look)
    return bool(found)


def _borders(ax: Axes, data: xr.Dataset, plot: RegionMap) -> set[str]:
    """Between cells: where the same cycle changes its stability, and where a stable one ends; which of them there are.

    It ends where no cycle is found in the next cell, and the motion does not stay quiet there either. That the start
    follows none, or another one, does not say that.
    """
    x, y = cells.edges_of(data, plot.x, plot.y)
    growth = data["growth_rate"].transpose(plot.y, plot.x).values
    stable, unstable = growth < 0, growth > 0
    gone = cells.words_of(data, "cycle", plot.x, plot.y) == "none_found"
    gone &= cells.words_of(data, "outcome", plot.x, plot.y) != "quiet"
    lines: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    up, right = _joined(data, plot)

    def between(here: tuple[slice, ...], ahead: tuple[slice, ...], joined: Mask) -> dict[str, NDArray[np.int64]]:
        """Between which cells and the next ones a line is."""
        changes = (stable[here] & unstable[ahead]) | (unstable[here] & stable[ahead])
        ends = (stable[here] & gone[ahead]) | (gone[here] & stable[ahead])
        return {"neutral": np.argwhere(changes & joined[here]), "fold": np.argwhere(ends)}

    for kind, places in between(np.s_[:-1, :], np.s_[1:, :], up).items():
        lines[kind] += [[(x[j], y[i + 1]), (x[j + 1], y[i + 1])] for i, j in places]
    for kind, places in between(np.s_[:, :-1], np.s_[:, 1:], right).items():
        lines[kind] += [[(x[j + 1], y[i]), (x[j + 1], y[i + 1])] for i, j in places]
    ax.add_collection(LineCollection(lines["neutral"], capstyle="projecting", **parts.border("neutral")))
    ax.add_collection(LineCollection(lines["fold"], **parts.border("fold")))
    return {kind for kind, found in lines.items() if found}


def _joined(data: xr.Dataset, plot: RegionMap) -> tuple[Mask, Mask]:
    """Whether the cycle goes on upwards, and to the right; the study's plane may lie the other way round."""
    first = str(data["outcome"].dims[0])
    names = ("joined_first", "joined_second") if first == plot.y else ("joined_second", "joined_first")
    up, right = (cells.words_of(data, name, plot.x, plot.y) == "yes" for name in names)
    return up, right


def _marks(ax: Axes, plot: RegionMap) -> None:
    """The paper's cases, their names within the panel."""
    to_panel = ax.transScale + ax.transLimits
    for name, mark in plot.marks.items():
        share, _ = to_panel.transform((mark.x * parts.axis_of(plot.x)[1], mark.y * parts.axis_of(plot.y)[1]))
        paper_ring(ax, plot, name, (-6 if share > 0.85 else 6, 0), path_effects=parts.halo(2.0))


def _legends(figure: Figure, study: xr.Dataset, plot: RegionMap, kinds: Collection[str], are_named: bool) -> None:
    """Outcomes and lines above, what stands for no cycle below; and what is to be said of how it was computed."""
    outcomes = set(np.unique(flag_names(study["outcome"])))
    above: list[Artist] = [cells.patch(look) for name, look in cells.OUTCOMES.items() if name in outcomes]
    if (flag_names(study["origin"]) == "undivided_cell").any():
        look = cells.paler(cells.OUTCOMES["separation"], PALER)
        above.append(cells.patch(look._replace(label="paler: inferred from the corners of a cell")))
    above += [Line2D([], [], **parts.border(kind)) for kind in parts.BORDERS if kind in kinds]
    if "as_published" in parts.normalizations(study):
        above += paper_rings(plot)
    legend_below_head(figure, study, plot, above)
    below: list[Artist] = list(cells.cycle_patches(set(flag_names(study["cycle"]).flat)))
    said = [*_said(study, plot)]
    said += ["A, B, ...: branches, on which one cycle goes on from point to point."] * are_named
    below.append(Line2D([], [], linestyle="", label="\n".join(said)))
    figure.legend(handles=below, loc="outside lower center", ncols=len(below), handlelength=1.2)


def _said(study: xr.Dataset, plot: RegionMap) -> Iterator[str]:
    """How it was computed, what the names of the marks are, and what does not fit."""
    outcome, cycle, origin = (flag_names(study[name]) for name in ("outcome", "cycle", "origin"))
    yield f"Within {json.loads(study.attrs['options'])['horizon']:g} s of the published start."
    figures = next((name[1:] for name in plot.marks if re.fullmatch(r"F\d+", name)), "")
    named = f" F{figures}: in Fig. {figures} of the paper." * bool(figures)
    yield f"{(origin == 'simulation').sum()} of {outcome.size} points simulated.{named}"
    if alone := standing_alone(study, plot):
        yield f"Points unlike all beside them: {alone}."
    quiet = (outcome == "quiet") & (origin == "undivided_cell") & np.isin(cycle, ["only_near", "none_found"])
    if quiet.any():
        yield f"Inferred to stay quiet, though the start was followed to no cycle: {quiet.sum()}."
    yield from contradictions(study, plot)


def standing_alone(study: xr.Dataset, plot: RegionMap) -> int:
    """Number of points whose outcome none of those beside them has."""
    count = 0
    for norm in parts.normalizations(study):
        words = np.pad(cells.words_of(parts.of(study, norm), "outcome", plot.x, plot.y), 1)
        own = words[1:-1, 1:-1]
        beside = (words[:-2, 1:-1], words[2:, 1:-1], words[1:-1, :-2], words[1:-1, 2:])
        count += int(np.sum(np.all([own != other for other in beside], axis=0)))
    return count


def contradictions(study: xr.Dataset, plot: RegionMap) -> list[str]:
    """A sentence for each case of the paper at which its answer, the start's outcome and the cycle do not agree."""
    if "as_published" not in parts.normalizations(study):
        return []
    data, said = parts.of(study, "as_published"), []
    for name, mark in plot.marks.items():
        here = data.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome, rate = str(flag_names(here["outcome"])), float(here["growth_rate"])
        found = cells.OUTCOMES[outcome].label
        if outcome != mark.paper:
            said.append(f"{name}: the paper says “{cells.OUTCOMES[mark.paper].label}”, the published start: {found}.")
        if (outcome == "quiet") != (rate < 0) and np.isfinite(rate):
            kind = "stable" if rate < 0 else "unstable"
            why = "another motion is reached" if rate < 0 else "its growth is not seen within the horizon"
            said.append(f"{name}: {found}, beside a cycle that is {kind} ({rate:.2g}/s): {why}.")
    return said
