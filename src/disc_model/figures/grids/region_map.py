"""Maps of regions: what becomes of the published start over two parameters, and the growth of the cycle it follows."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.colors import BoundaryNorm, ListedColormap, to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import RegionMap
from disc_model.figures.grids.stability_map import LARGE, PAPER, growth_bar, growth_norm, paper_ring, set_scales
from disc_model.figures.grids.stability_map import OUTCOMES as MARKERS
from disc_model.figures.parts import BLACK, GREY, PAGE, SEPARATED, new_figure, styled

Array = NDArray[np.float64]
Names = NDArray[np.str_]


DOTTED = (0, (1.2, 0.8))
"""Of a border along cells, so short that corners stay visible."""


PALER = 0.35
"""How far the colours inside undivided cells are from the others' towards white."""


class Look(NamedTuple):
    """How cells are filled."""

    label: str
    face: str
    hatch: str = ""


OUTCOMES = {
    "stable": Look("stays quiet", "#e9eef2"),
    "unstable": Look("grows, no separation", "#a9b4bd"),
    "separation": Look("separation", SEPARATED),
    "undecided": Look("undecided", "white", "xxxx"),
    "unknown": Look("failed", "white", "++++"),
}
CYCLES = {
    "slides": Look("slides steadily", "#d9cfe3"),
    "sticks": Look("sticks", "#cfe3d6"),
    "only_near": Look("start follows no cycle", "white", "////"),
    "none_found": Look("no cycle found", "white", "...."),
}
"""What there is to see where no cycle is followed."""


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: RegionMap) -> Figure:
    """Two panels for each normalization: outcomes, and growth rates; the paper's cases are marked.

    Parameters
    ----------
    study : of the quantity `regions`
    others : none
    """
    norms = parts.normalizations(study)
    figure = new_figure(PAGE, 5.6)
    axes = figure.subplots(2, len(norms), sharex=True, sharey=True, squeeze=False)
    for column, norm in enumerate(norms):
        one = parts.of(study, norm)
        _outcomes(axes[0, column], one, plot)
        mesh = growth_cells(axes[1, column], one, plot.x, plot.y)
        for row in range(2):
            letter = "abcdef"[row * len(norms) + column]
            axes[row, column].set_title(f"({letter}) {parts.MODES[norm] if row == 0 else ''}", loc="left")
            _borders(axes[row, column], one, plot)
    set_scales(axes, study, plot)
    for ax, norm in zip(axes[0], norms, strict=True):
        if norm == "as_published":
            _marks(ax, plot)
    growth_bar(figure, mesh, list(axes[1]))
    _legends(figure, study, plot)
    return figure


def _cells(data: xr.Dataset, x: str, y: str) -> tuple[Array, Array]:
    """Edges of the cells around the points, halfway between neighbours, in the units of the axes."""
    edges = []
    for name in (x, y):
        values = data[name].values * parts.axis_of(name)[1]
        log = set_logarithmic(values, name)
        along = np.log(values) if log else values
        middle = 0.5 * (along[1:] + along[:-1])
        whole = np.concatenate([along[:1], middle, along[-1:]])
        edges.append(np.exp(whole) if log else whole)
    return edges[0], edges[1]


def set_logarithmic(values: Array, name: str) -> bool:
    """Whether an axis is logarithmic throughout."""
    return bool(name not in ("N", "Omega") and values[0] > 0 and values[-1] / values[0] > 15)


def _words(data: xr.Dataset, name: str, x: str, y: str) -> Names:
    return np.asarray(flag_names(data[name].transpose(y, x)))


def _fill(ax: Axes, cells: tuple[Array, Array], words: Names, looks: Mapping[str, Look]) -> None:
    """Cells in the look of their word; those of no look stay as they are."""
    codes = np.full(words.shape, np.nan)
    for i, (word, look) in enumerate(looks.items()):
        codes[words == word] = i
        if look.hatch and (words == word).any():
            _hatch(ax, cells, words == word, look)
    colours = ListedColormap([look.face for look in looks.values()])
    plain = np.ma.masked_invalid(codes)
    for i, look in enumerate(looks.values()):
        if look.hatch:
            plain = np.ma.masked_where(codes == i, plain)
    norm = BoundaryNorm(np.arange(len(looks) + 1) - 0.5, len(looks))
    ax.pcolormesh(*cells, plain, cmap=colours, norm=norm, rasterized=True)


def _hatch(ax: Axes, cells: tuple[Array, Array], there: NDArray[np.bool_], look: Look) -> None:
    """Hatched cells, without a line around each."""
    shown = np.ma.masked_where(~there, there.astype(float))
    ax.pcolor(*cells, shown, cmap=ListedColormap([look.face]), hatch=look.hatch, edgecolor=GREY, linewidth=0)


def _outcomes(ax: Axes, data: xr.Dataset, plot: RegionMap) -> None:
    """Outcomes, paler where they were not worked out."""
    cells, words = _cells(data, plot.x, plot.y), _words(data, "outcome", plot.x, plot.y)
    inside = _words(data, "origin", plot.x, plot.y) == "undivided_cell"
    _fill(ax, cells, np.where(inside, "", words), OUTCOMES)
    _fill(ax, cells, np.where(inside, words, ""), {name: _paler(look) for name, look in OUTCOMES.items()})


def _paler(look: Look) -> Look:
    """The look inside an undivided cell."""
    red, green, blue = (part + PALER * (1 - part) for part in to_rgb(look.face))
    return look._replace(face=to_hex((red, green, blue)))


def growth_cells(ax: Axes, data: xr.Dataset, x: str, y: str) -> QuadMesh:
    """Growth rate of the cycle that the published start follows; where it follows none, what it does instead."""
    cells = _cells(data, x, y)
    _fill(ax, cells, _words(data, "cycle", x, y), CYCLES)
    rate = np.ma.masked_invalid(data["growth_rate"].transpose(y, x).values)
    return ax.pcolormesh(*cells, rate, cmap=cm.vik, norm=growth_norm(), rasterized=True)


def _borders(ax: Axes, data: xr.Dataset, plot: RegionMap) -> None:
    """Between cells: where the same cycle changes its stability, and where a stable one ends."""
    x, y = _cells(data, plot.x, plot.y)
    growth = data["growth_rate"].transpose(plot.y, plot.x).values
    stable, unstable = growth < 0, growth > 0
    joined = _joined(data, plot)
    lines: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    for axis in (0, 1):
        here, ahead = ([slice(None, -1), slice(1, None)][i] for i in (0, 1))
        one = (here, slice(None)) if axis == 0 else (slice(None), here)
        two = (ahead, slice(None)) if axis == 0 else (slice(None), ahead)
        goes_on = joined[axis][one]
        changes = (stable[one] & unstable[two]) | (unstable[one] & stable[two])
        ends = stable[one] != stable[two]
        for kind, there in (("neutral", changes & goes_on), ("fold", ends & ~(changes & goes_on))):
            for i, j in np.argwhere(there):
                if axis == 0:
                    lines[kind].append([(x[j], y[i + 1]), (x[j + 1], y[i + 1])])
                else:
                    lines[kind].append([(x[j + 1], y[i]), (x[j + 1], y[i + 1])])
    ax.add_collection(LineCollection(lines["neutral"], colors=BLACK, linewidths=1.0, capstyle="projecting"))
    ax.add_collection(LineCollection(lines["fold"], colors=BLACK, linewidths=1.0, linestyles=DOTTED))


def _joined(data: xr.Dataset, plot: RegionMap) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether the cycle goes on upwards, and to the right; the study's plane may lie the other way round."""
    first = str(data["outcome"].dims[0])
    names = ("joined_first", "joined_second") if first == plot.y else ("joined_second", "joined_first")
    up, right = (_words(data, name, plot.x, plot.y) == "yes" for name in names)
    return up, right


def _marks(ax: Axes, plot: RegionMap) -> None:
    """The paper's cases: their names above the panel, and large marks in the shape of what the paper says of them."""
    for name, mark in plot.marks.items():
        at = (mark.x * parts.axis_of(plot.x)[1], mark.y * parts.axis_of(plot.y)[1])
        for color, width in ((BLACK, 2.4), (PAPER, 1.4)):
            ax.scatter(
                *at, LARGE, marker=MARKERS[mark.paper].marker, facecolor="none", edgecolor=color, linewidth=width,
                zorder=4, clip_on=False,
            )  # fmt: skip
        low, high = ax.get_xlim()
        to_axis = ax.xaxis.get_transform()
        share = (to_axis.transform(at[0]) - to_axis.transform(low)) / (to_axis.transform(high) - to_axis.transform(low))
        right = share > 0.85
        ax.annotate(
            name,
            at,
            xytext=(-6 if right else 6, 0),
            textcoords="offset points",
            ha="right" if right else "left",
            va="center",
            fontsize=7,
            zorder=5,
            path_effects=[withStroke(linewidth=2.0, foreground="white")],
            annotation_clip=False,
        )


def _legends(figure: Figure, study: xr.Dataset, plot: RegionMap) -> None:
    """Outcomes and lines above, what stands for no cycle below; and what is to be said of how it was computed."""
    outcomes = set(np.unique(flag_names(study["outcome"])))
    above: list[Artist] = [_patch(look) for name, look in OUTCOMES.items() if name in outcomes]
    above.append(Line2D([], [], color=BLACK, linewidth=1.0, label="cycle loses stability"))
    above.append(Line2D([], [], color=BLACK, linewidth=1.0, linestyle=DOTTED, label="stable cycle ends (fold)"))
    if (flag_names(study["origin"]) == "undivided_cell").any():
        above.append(_patch(_paler(OUTCOMES["separation"])._replace(label="paler: inside an undivided cell")))
    if plot.marks and "as_published" in parts.normalizations(study):
        above.append(paper_ring())
    figure.legend(handles=above, loc="outside upper center", ncols=min(len(above), 4))
    below = cycle_patches(study)
    horizon = json.loads(study.attrs["options"])["horizon"]
    simulated = (flag_names(study["origin"]) == "simulation").sum()
    said = f"Within {horizon:g} s of the published start. {simulated} of {study['outcome'].size} points simulated."
    below.append(
        Line2D(
            [], [], linestyle="", label="\n".join([said, *standing_alone(study, plot), *contradictions(study, plot)])
        )
    )
    figure.legend(handles=below, loc="outside lower center", ncols=len(below), handlelength=1.2)


def standing_alone(study: xr.Dataset, plot: RegionMap) -> list[str]:
    """A sentence on points whose outcome none of those beside them has, if there are any."""
    count = 0
    for norm in parts.normalizations(study):
        words = np.pad(_words(parts.of(study, norm), "outcome", plot.x, plot.y), 1)
        own = words[1:-1, 1:-1]
        beside = (words[:-2, 1:-1], words[2:, 1:-1], words[1:-1, :-2], words[1:-1, 2:])
        count += int(np.sum(np.all([own != other for other in beside], axis=0)))
    return [f"Points unlike all beside them: {count}, most on strips thinner than the grid."] if count else []


def contradictions(study: xr.Dataset, plot: RegionMap) -> list[str]:
    """A sentence for each case of the paper at which its answer, the start's outcome and the cycle do not agree."""
    if "as_published" not in parts.normalizations(study):
        return []
    data, said = parts.of(study, "as_published"), []
    for name, mark in plot.marks.items():
        here = data.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome, rate = str(flag_names(here["outcome"])), float(here["growth_rate"])
        found = OUTCOMES[outcome].label
        if outcome != mark.paper:
            said.append(f"{name}: the paper says “{OUTCOMES[mark.paper].label}”, the published start: {found}.")
        if (outcome == "stable") != (rate < 0) and np.isfinite(rate):
            kind = "stable" if rate < 0 else "unstable"
            why = "another motion is reached" if rate < 0 else "its growth is not seen within the horizon"
            said.append(f"{name}: {found}, beside a cycle that is {kind} ({rate:.2g}/s): {why}.")
    return said


def cycle_patches(study: xr.Dataset) -> list[Artist]:
    """For legends: what there is where no cycle is followed."""
    cycles = set(np.unique(flag_names(study["cycle"])))
    return [_patch(look) for name, look in CYCLES.items() if name in cycles]


def _patch(look: Look) -> Patch:
    return Patch(facecolor=look.face, hatch=look.hatch, edgecolor=GREY, linewidth=0.4, label=look.label)
