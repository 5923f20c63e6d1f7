"""What maps and charts draw: cells in flat colours, growth rates of the stick-slip cycle, neutral curves and folds."""

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.variables import EXCLUDED, WITHOUT_CYCLE, axis_of, flag_names, typeset
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, GREY, AsinhNorm, Axes, FigureBase, Line2D, Outline, Patch, edges, label_of
from disc_model.stability.resonances import Resonance

Array = NDArray[np.float64]
Names = NDArray[np.str_]
Edges = tuple[Array, Array]

# ---- Cells in flat colours, and a hatch for single ones


class Look(NamedTuple):
    """Appearance of cells: fill or hatch, and label."""

    label: str
    face: str
    hatch: str = ""


UNRESOLVED = Look("unresolved", "none", 8 * "/")
"""Look of cells whose neighbours on both sides have another outcome: what is there is finer than the cells. A cell of
a fiftieth of a panel has two lines of their hatch."""
OUTCOME_LOOKS = {  # in all maps and charts, distinct in grey print by darkness or a hatch
    "quiet": Look("quiet", "#f3f6f8"),
    "steady_sliding": Look("steady sliding", "#e3d5ee", 3 * "|"),
    "at_rest": Look("permanent stick", "#c4e3cd", 3 * "-"),
    "growing": Look("growing, in contact", "#c2ccd6"),
    "other_cycle": Look("another cycle in contact", "#86a0b8"),
    "separation": Look("separation", "#bb5200"),
    "undecided": Look("undecided", "#43372a"),
    "failed": Look("failed", "#222222"),
}
CYCLE_LOOKS = {
    "steady_sliding": OUTCOME_LOOKS["steady_sliding"],
    "at_rest": OUTCOME_LOOKS["at_rest"],
    "separates": Look(WITHOUT_CYCLE["separates"], "#f3c9ae", 6 * "\\"),
    "nearby_only": Look("cycle nearby, not followed", "#f2e6a2", 5 * "-"),
    "no_cycle": Look(WITHOUT_CYCLE["no_cycle"], "#b5b5b5", 4 * "x"),
    "stable": Look("stable cycle", "none", 3 * "."),
    "alone": UNRESOLVED,
    "failed": OUTCOME_LOOKS["failed"],
    EXCLUDED: Look("left out by the study's rule", "white"),
}
"""Looks of points where no cycle is followed, of decay, whose sign a grey print does not show, and of growth rates that
may be another cycle's."""
CELL_LOOKS = OUTCOME_LOOKS | {"fine": UNRESOLVED}
GREYNESS, DARK = np.array([0.299, 0.587, 0.114]), 0.5
"""Weights of red, green and blue in grey print, and the lightness below which a hatch is white."""


def unresolved(words: Names) -> NDArray[np.bool_]:
    """Cells between two that have one other word: single ones, and strips that are one cell wide."""
    around = np.pad(words, 1)
    pairs = ((around[:-2, 1:-1], around[2:, 1:-1]), (around[1:-1, :-2], around[1:-1, 2:]))
    return np.asarray(np.any([(word == other) & (word != words) & (word != "") for word, other in pairs], axis=0))


def scale_of(name: str, values: Array) -> str:
    """Scale of an axis: logarithmic for values over decades, most at the lower end; with a linear start from 0."""
    positive = values[values > 0]
    if name in ("N", "Omega") or positive.size < 2 or positive[-1] / positive[0] <= 15:
        return "linear"
    if np.median(values) - values[0] > 0.25 * (values[-1] - values[0]):
        return "linear"
    return "log" if values[0] > 0 else "symlog"


def edges_of(plane: xr.DataArray, scale: Callable[[str, Array], str] = scale_of) -> Edges:
    """Edges of the cells around the points, halfway between neighbours, in the units of the axes; across, then up."""
    sides = []
    for name in map(str, plane.dims):
        values = plane[name].values * label_of(plane[name])[1]
        log = scale(name, values) == "log"
        sides.append(np.exp(edges(np.log(values))) if log else edges(values))
    return sides[1], sides[0]


def fill(ax: Axes, sides: Edges, words: Names, looks: Mapping[str, Look], below: Array | None = None) -> None:
    """Fill and hatch cells in the look of their word; cells whose word has no look remain unchanged.

    A hatch is black over light colours and white over dark ones.

    below : colours that are drawn there already, shape (rows, columns, 4)
    """
    from matplotlib.colors import to_rgba
    from matplotlib.patches import PathPatch

    colours = np.zeros((*words.shape, 4))
    for word, look in looks.items():
        colours[words == word] = to_rgba(look.face)
    if colours.any():
        ax.pcolormesh(*sides, colours, rasterized=True)
    light = np.ones(words.shape)  # that of the page
    for layer in (colours if below is None else below, colours):
        light = np.where(layer[..., 3] > 0, layer[..., :3] @ GREYNESS, light)
    dark = light < DARK
    for word, look in looks.items():
        for ink, ground in ((BLACK, ~dark), ("white", dark)):
            mask = ground & (words == word)
            if look.hatch and mask.any():
                ax.add_patch(PathPatch(_outline(sides, mask), fill=False, hatch=look.hatch, ec=ink, lw=0, zorder=1.1))


def _outline(sides: Edges, mask: NDArray[np.bool_]) -> Outline:
    """The outlines of all these cells as one path: a hatch of each cell would take a hundred times as long."""
    from matplotlib.path import Path

    (low, leftmost), (x, y) = np.nonzero(mask), sides
    corners = [(x[leftmost + across], y[low + up]) for across, up in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return Path.make_compound_path_from_polys(np.moveaxis(np.array(corners), (0, 1, 2), (1, 2, 0)))


def outcome_cells(ax: Axes, outcome: xr.DataArray) -> set[str]:
    """Fill cells in the look of their outcome, hatched where unresolved; returns the used keys of `CELL_LOOKS`."""
    words = flag_names(outcome)
    words = np.where(unresolved(words), "fine", words)
    fill(ax, edges_of(outcome), words, CELL_LOOKS)
    return set(words.flat)


def patches(looks: Mapping[str, Look], words: Container[str]) -> list[Patch]:
    """Legend entries of the looks that are among words."""
    from matplotlib.patches import Patch

    return [
        Patch(fc=look.face, ec=BLACK if look.hatch else GREY, hatch=look.hatch, linewidth=0.4, label=look.label)
        for name, look in looks.items()
        if name in words
    ]


# ---- The one scale of colours for growth rates of the stick-slip cycle
GREATEST = 0.3  # growth rate at which the colours end, 1/s, unless most rates are larger
LINEAR = 1 / 30  # fraction of the scale's end up to which the colours are nearly linear


def growth_norm(rates: Array) -> AsinhNorm:
    """A colour scale that is nearly linear near 0 and nearly logarithmic beyond."""
    from matplotlib.colors import AsinhNorm

    sizes = np.abs(rates[np.isfinite(rates)])
    greatest = float(sizes.max()) if sizes.size and np.median(sizes) > GREATEST else GREATEST
    return AsinhNorm(linear_width=LINEAR * greatest, vmin=-greatest, vmax=greatest)


def growth_panels(figure: FigureBase, axes: Sequence[Axes], panels: Sequence[xr.Dataset]) -> set[str]:
    """Draw `growth_rate` (1/s) over two parameters on one scale of colours, or the status where no cycle is followed.

    Cells of decay are dotted, isolated ones hatched. Returns the used keys of `CYCLE_LOOKS`, and "".

    panels : of the quantity `regions` or `floquet`; without flags, points without a rate have no cycle
    """
    from cmcrameri import cm

    norm = growth_norm(np.concatenate([panel["growth_rate"].values.ravel() for panel in panels]))
    used: set[str] = set()
    for ax, data in zip(axes, panels, strict=True):
        sides, without = edges_of(data["growth_rate"]), cycles_of(data)
        rates = np.ma.masked_invalid(data["growth_rate"].values)
        mesh = ax.pcolormesh(*sides, rates, cmap=cm.vik, norm=norm, rasterized=True)
        fill(ax, sides, without, CYCLE_LOOKS)
        hatched = np.where(isolated(data), "alone", np.where((rates < 0).filled(False), "stable", ""))
        fill(ax, sides, hatched, CYCLE_LOOKS, mesh.to_rgba(rates))
        used |= {*without.flat, *hatched.flat}
    label = "Growth rate of the\nstick-slip cycle (1/s)"
    bar = figure.colorbar(mesh, ax=list(axes), extend="both", format="{x:g}", pad=0.01, aspect=30, label=label)
    largest = 10.0 ** np.floor(np.log10(norm.vmax or GREATEST))
    bar.set_ticks([-largest, -largest / 10, 0, largest / 10, largest])
    bar.minorticks_off()
    return used


def stability_of(data: xr.Dataset) -> Names:
    """Stability of the followed cycle, or the word of the quantity `regions` where there is none."""
    rate = data["growth_rate"].values
    return np.where(rate < 0, "stable", np.where(rate > 0, "unstable", flag_names(data["cycle"])))


def isolated(data: xr.Dataset) -> NDArray[np.bool_]:
    """Cells whose growth rate, or whose stability, differs from that around them."""
    cells = alone(data["growth_rate"].values)
    return cells | unresolved(stability_of(data)) if "cycle" in data else cells


def cycles_of(data: xr.Dataset) -> Names:
    """Words where no cycle is followed, a key of `CYCLE_LOOKS`, otherwise ""; of `regions` or `floquet`."""
    rate = data["growth_rate"].values
    words = np.full(rate.shape, "no_cycle")
    if "cycle" in data:
        words = flag_names(data["cycle"])
    elif "status" in data:
        words = flag_names(data["status"])
        words = np.select([words == "ok", words == "no_stick_slip"], ["no_cycle", "steady_sliding"], words)
        words = np.where(np.isin(words, [*CYCLE_LOOKS]), words, "failed")
    if "sliding_growth_rate" in data:
        # growing steady sliding is no lasting motion
        grows = ~(data["sliding_growth_rate"].values < 0)
        words = np.where((words == "steady_sliding") & grows, "no_cycle", words)
    return np.where(np.isfinite(rate), "", words)


def alone(rate: Array) -> NDArray[np.bool_]:
    """Cells whose growth rate differs from that of the eight around them: of another cycle, or a narrow resonance."""
    share = np.where(np.isfinite(rate), growth_norm(rate)(np.nan_to_num(rate)), np.nan).clip(0, 1)
    padded = np.pad(share, 1, constant_values=np.nan)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3, 3))
    like = np.abs(share[..., None, None] - around) < 0.1  # of the colour scale
    # each cell equals itself
    return (like.sum((2, 3)) == 1) & (np.isfinite(around).sum((2, 3)) > 1)


# ---- Neutral curves and folds of the cycle over speed and preload
SPEED, LOAD = axis_of("Omega")[0], axis_of("N")[0]


@dataclass(frozen=True, eq=False)
class Curve:
    """A line on a stability chart.

    Omega, N : shape (n,), rad/s and N
    kind : "neutral" or "fold"
    label : text next to it, such as a resonance's "2 f_s = 135.42 Hz"; may be empty
    """

    Omega: Array
    N: Array
    kind: str
    label: str = ""


def curves_of(data: xr.Dataset) -> list[Curve]:
    """Curves with a stable cycle beside them, from the quantity `stability_curves`; x is Omega and y is N."""
    kinds = flag_names(data["kind"])
    curves = []
    for i in np.flatnonzero(kinds != "none"):
        curve_data = data.isel(curve=int(i))
        border = (flag_names(curve_data["adjoins_stable_cycle"]) == "yes") & np.isfinite(curve_data["x"].values)
        if border.sum() < 2:
            continue
        x, y = (np.where(border, curve_data[name].values, np.nan) for name in ("x", "y"))
        label = ""
        # a resonance farther away, in Hz, is not named
        if kinds[i] == "fold" and abs(float(curve_data["resonance_detuning"])) < 3.0:
            values = (curve_data[f"resonance_{field.name}"].item() for field in fields(Resonance))
            label = Resonance(*values).label.replace(" - ", " − ").replace("Ω/2π", "f_Ω")
        curves.append(Curve(x, y, str(kinds[i]), label))
    return curves


def passes(curve: Curve, cells: xr.DataArray) -> NDArray[np.bool_]:
    """Whether each point of a curve lies in one of these cells over N and Omega, or in one of the eight around it."""
    from scipy.ndimage import binary_dilation

    i, j = (
        np.abs(cells[name].values - np.nan_to_num(getattr(curve, name))[:, None]).argmin(axis=1)
        for name in ("N", "Omega")
    )
    return np.asarray(np.isfinite(curve.Omega) & binary_dilation(cells, np.ones((3, 3)))[i, j])


def parted(curves: Sequence[Curve], cycle: xr.Dataset) -> tuple[list[Curve], list[Curve]]:
    """Split curves into the parts that bound the cycle of a map, and those that belong to another cycle.

    cycle : `growth_rate` (1/s, nan without a cycle) over N and Omega
    """
    rate = cycle["growth_rate"]
    beyond = {"neutral": rate > 0, "fold": ~(rate < 0)}
    shown: list[Curve] = []
    other: list[Curve] = []
    for curve in curves:
        side = np.isfinite(curve.Omega)
        bounding = passes(curve, rate < 0) & passes(curve, beyond[curve.kind])
        within = slice(bounding.argmax(), bounding.size - bounding[::-1].argmax())
        if bounding[within].mean() >= 0.5:  # cells are coarser than the curve
            bounding[within] = side[within]
        for lines, stretch in ((shown, bounding), (other, side & ~bounding)):
            if stretch.any():
                # one point more at each end, so that the parts of a curve meet
                joined = stretch | np.roll(stretch, 1) & (np.arange(stretch.size) > 0)
                Omega, N = (np.where(joined, along, np.nan) for along in (curve.Omega, curve.N))
                lines.append(replace(curve, Omega=Omega, N=N, label=curve.label if lines is shown else ""))
    return shown, other


def crossings(curve: Curve, load: float) -> Array:
    """Speeds at which a curve crosses a load, rad/s."""
    side = curve.N - load
    indices = np.flatnonzero(side[:-1] * side[1:] <= 0)
    step = side[indices] - side[indices + 1]
    share = np.where(step == 0, 0.0, side[indices] / np.where(step == 0, 1.0, step))
    return np.unique(curve.Omega[indices] + share * (curve.Omega[indices + 1] - curve.Omega[indices]))


def draw_curves(axes: Sequence[Axes], curves: Sequence[Sequence[Curve]]) -> list[Line2D]:
    """Draw the curves of each panel, numbered if they have a label; returns legend entries of lines and numbers.

    Numbers ascend with speed, equal labels share one, and they stand beyond the upper end, where they cover no line.
    """
    labelled = [curve for of_panel in curves for curve in of_panel if curve.label]
    labelled.sort(key=lambda curve: float(np.nanmax(curve.Omega)))
    numbers = {label: i for i, label in enumerate(dict.fromkeys(curve.label for curve in labelled), 1)}
    for ax, of_panel in zip(axes, curves, strict=True):
        for curve in of_panel:
            ax.plot(curve.Omega, curve.N, **drawing.BORDERS[curve.kind] | {"label": "_nolegend_"})
            if curve.label and np.isfinite(curve.N).any():
                i = int(np.nanargmax(curve.N))
                end = (curve.Omega[i], min(float(curve.N[i]), ax.get_ylim()[1]))
                look: dict[str, Any] = {"fontsize": 6, "annotation_clip": False, "path_effects": drawing.halo()}
                drawing.say(ax, str(numbers[curve.label]), end, (0, 2), **look)
    kinds = {curve.kind for of_panel in curves for curve in of_panel}
    handles = [drawing.sample(**drawing.BORDERS[kind]) for kind in drawing.BORDERS if kind in kinds]
    mark: dict[str, Any] = {"linestyle": "", "color": BLACK, "markersize": 4, "markeredgewidth": 0}
    handles += [drawing.sample(marker=f"${i}$", label=typeset(label), **mark) for label, i in numbers.items()]
    return handles


def span(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())
