"""Borders of stability over two parameters: neutral curves and folds of the cycle, their selection and
drawing, and the edges of cells where no curves are known.
"""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.collections import LineCollection
from scipy.ndimage import binary_dilation

from disc_model.analysis.spectra import Resonance
from disc_model.data.variables import flag_names, typeset
from disc_model.figures.cells import Edges, edges_of, unresolved
from disc_model.figures.drawing import BLACK, BORDERS, border, halo, large, mark, sample, say
from disc_model.figures.growth import stability_of
from disc_model.figures.types import Array, Artist, Axes, Indices, Mask

NEAR = 3.0  # Hz, from a resonance, within which a fold has its name
BOUNDING = 0.5
"""Share of points from which a stretch of a curve bounds a cycle, as cells are coarser."""
JOINED = ("branch_continues_first", "branch_continues_second")
"""Whether the branch continues along the study's first and second dimension."""
CAPS: dict[str, Any] = {"neutral": "projecting", "fold": None}
"""Ends of the segments of borders; dashes have none."""
EDGE = 0.02  # of a panel's width, beside its ends, where numbers stand on the inner side
Segment = list[tuple[float, float]]


class Curve(NamedTuple):
    """A line on a stability chart.

    Omega, N : rad/s and N, shape (n,); nan where it is not drawn
    kind : "neutral" or "fold"
    label : of its resonance, such as "2 f_s = 135.42 Hz", or ""
    """

    Omega: Array
    N: Array
    kind: str
    label: str = ""

    def within(self, shown: Mask) -> "Curve":
        """The curve where a mask holds."""
        Omega = np.where(shown, self.Omega, np.nan)
        N = np.where(shown, self.N, np.nan)
        return self._replace(Omega=Omega, N=N)


# ---- Selection


def curves_of(data: xr.Dataset) -> list[Curve]:
    """Curves with a stable cycle beside them, from the quantity `stability_curves`; x is Omega and
    y is N."""
    kinds = flag_names(data["kind"])
    curves = []
    for i in np.flatnonzero(kinds != "none"):
        points = data.isel(curve=int(i))
        adjoins = flag_names(points["adjoins_stable_cycle"]) == "yes"
        border = adjoins & np.isfinite(points["x"].values)
        if border.sum() > 1:
            label = ""
            if kinds[i] == "fold":
                label = _resonance_of(points)
            curve = Curve(points["x"].values, points["y"].values, str(kinds[i]), label)
            curves.append(curve.within(border))
    return curves


def _resonance_of(points: xr.Dataset) -> str:
    """The label of the resonance of a fold; "" where it is far away."""
    if not abs(float(points["resonance_detuning"])) < NEAR:
        return ""
    values = [points[f"resonance_{field.name}"].item() for field in fields(Resonance)]
    return Resonance(*values).label.replace(" - ", " − ").replace("Ω/2π", "f_Ω")


def passes(curve: Curve, cells: xr.DataArray) -> Mask:
    """Whether each point of a curve lies in one of these cells over N and Omega, or in one of the
    eight around it."""
    i = _nearest(cells["N"].values, curve.N)
    j = _nearest(cells["Omega"].values, curve.Omega)
    around = binary_dilation(cells, np.ones((3, 3)))
    return np.asarray(np.isfinite(curve.Omega) & around[i, j])


def _nearest(values: Array, places: Array) -> Indices:
    """Index of the value nearest each place; any for nan."""
    return np.abs(values - np.nan_to_num(places)[:, None]).argmin(axis=1)


def parts_of(curves: Sequence[Curve], cycle: xr.Dataset) -> list[Curve]:
    """The parts of curves that bound the cycle of a map over N and Omega, without those of another
    cycle."""
    rate = cycle["growth_rate"]
    beyond = {"neutral": rate > 0, "fold": ~(rate < 0)}
    parts = []
    for curve in curves:
        bounding = passes(curve, rate < 0) & passes(curve, beyond[curve.kind])
        within = slice(bounding.argmax(), bounding.size - bounding[::-1].argmax())
        if bounding[within].mean() >= BOUNDING:
            bounding[within] = np.isfinite(curve.Omega)[within]
        if bounding.any():
            bounding[1:] |= bounding[:-1].copy()  # up to the point beyond
            parts.append(curve.within(bounding))
    return parts


def crossings(curve: Curve, load: float) -> Array:
    """Speeds at which a curve crosses a load, rad/s."""
    side = curve.N - load
    indices = np.flatnonzero(side[:-1] * side[1:] <= 0)
    step = side[indices] - side[indices + 1]
    share = np.divide(side[indices], step, out=np.zeros(step.shape), where=step != 0)
    ahead = curve.Omega[indices + 1] - curve.Omega[indices]
    return np.unique(curve.Omega[indices] + share * ahead)


# ---- Drawing


def draw_curves(ax: Axes, curves: Sequence[Curve]) -> list[Artist]:
    """Draw curves in axes whose limits are set, with a number beyond the upper end that is seen, by
    label and speed; returns entries of a legend."""
    named = [curve for curve in curves if curve.label and _in_view(ax, curve).any()]
    named.sort(key=lambda curve: float(np.nanmax(curve.Omega)))
    numbers: dict[str, int] = {}
    for curve in named:
        numbers.setdefault(curve.label, len(numbers) + 1)

    for curve in curves:
        look = border(curve.kind)
        look["label"] = "_nolegend_"
        ax.plot(curve.Omega, curve.N, **look)
    for curve in named:
        _number(ax, curve, numbers[curve.label])

    kinds = {curve.kind for curve in curves if _in_view(ax, curve).any()}
    handles = [sample(**border(kind)) for kind in BORDERS if kind in kinds]
    for label, number in numbers.items():
        sign = {"marker": f"${number}$", "ls": "", "c": BLACK, "ms": mark(4), "mew": 0}
        handles.append(sample(label=typeset(label), **sign))
    return handles


def _in_view(ax: Axes, curve: Curve) -> Mask:
    """Which points of a curve the limits of the axes include."""
    seen = np.ones(curve.N.shape, dtype=bool)
    for values, limits in ((curve.Omega, ax.get_xlim()), (curve.N, ax.get_ylim())):
        seen &= (values >= min(limits)) & (values <= max(limits))
    return seen


def _number(ax: Axes, curve: Curve, number: int) -> None:
    """Write the number of a curve beyond the upper end of what is seen of it, and within the
    panel's width."""
    i = int(np.argmax(np.where(_in_view(ax, curve), curve.N, -np.inf)))
    end = (float(curve.Omega[i]), float(curve.N[i]))
    across = ax.transAxes.inverted().transform(ax.transData.transform(end))[0]
    side = 0
    if across < EDGE:
        side = 1
    elif across > 1 - EDGE:
        side = -1
    look = {"fontsize": large(6), "annotation_clip": False, "path_effects": halo()}
    say(ax, str(number), end, (side, 2), **look)


# ---- Borders between cells


def draw_borders(ax: Axes, plane: xr.Dataset, upward: bool) -> list[Artist]:
    """Draw borders between resolved cells: where one cycle changes its stability, and where a
    stable one ends: the next cell has none and does not stay quiet. Upward: the study's first
    dimension is the vertical one."""
    up, right = JOINED
    if not upward:
        up, right = right, up
    edges = edges_of(plane["outcome"])
    rows = _segments(plane, edges, up, vertical=True)
    columns = _segments(plane, edges, right, vertical=False)
    drawn = []
    for kind in BORDERS:
        segments = rows[kind] + columns[kind]
        ax.add_collection(LineCollection(segments, capstyle=CAPS[kind], **border(kind)))
        if segments:
            drawn.append(sample(**border(kind)))
    return drawn


def _segments(
    plane: xr.Dataset, edges: Edges, joined: str, vertical: bool
) -> dict[str, list[Segment]]:
    """Segments of borders between cells that are neighbours in one direction, by their kind."""
    state = stability_of(plane)
    state[unresolved(state)] = "unresolved"
    stable = state == "stable"
    unstable = state == "unstable"
    without = np.isin(flag_names(plane["cycle"]), ("no_cycle", "unstable_sliding"))
    ends = without & (flag_names(plane["outcome"]) != "quiet")

    here: Any = np.s_[:, :-1]
    ahead: Any = np.s_[:, 1:]
    if vertical:
        here = np.s_[:-1, :]
        ahead = np.s_[1:, :]
    same = flag_names(plane[joined])[here] == "yes"
    changes = (stable[here] & unstable[ahead]) | (unstable[here] & stable[ahead])
    stops = (stable[here] & ends[ahead]) | (ends[here] & stable[ahead])
    found = {"neutral": np.argwhere(changes & same), "fold": np.argwhere(stops)}

    segments: dict[str, list[Segment]] = {}
    for kind, cells in found.items():
        segments[kind] = [_edge(edges, i, j, vertical) for i, j in cells]
    return segments


def _edge(edges: Edges, row: int, column: int, vertical: bool) -> Segment:
    """The edge between a cell and the one above it, or the one on its right."""
    x, y = edges
    corner = (x[column + 1], y[row + 1])
    if vertical:
        return [(x[column], y[row + 1]), corner]
    return [(x[column + 1], y[row]), corner]
