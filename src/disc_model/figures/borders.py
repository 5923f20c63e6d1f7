"""Neutral curves and folds of the cycle over speed and preload: their selection and drawing."""

from collections.abc import Sequence
from dataclasses import fields
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from scipy.ndimage import binary_dilation

from disc_model.analysis.spectra import Resonance
from disc_model.data.variables import flag_names, typeset
from disc_model.figures import drawing
from disc_model.figures.arrays import Array, Indices, Mask
from disc_model.figures.drawing import BLACK, BORDERS, border, large, mark

NEAR = 3.0  # Hz, from a resonance, within which a fold has its name
BOUNDING = 0.5
"""Share of points from which a stretch of a curve bounds a cycle, as cells are coarser."""


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
    """Draw curves, with a number beyond the upper end by label and speed; returns entries of a
    legend."""
    named = [curve for curve in curves if curve.label]
    named.sort(key=lambda curve: float(np.nanmax(curve.Omega)))
    numbers: dict[str, int] = {}
    for curve in named:
        numbers.setdefault(curve.label, len(numbers) + 1)

    for curve in curves:
        look = border(curve.kind)
        look["label"] = "_nolegend_"
        ax.plot(curve.Omega, curve.N, **look)
        if curve.label and np.isfinite(curve.N).any():
            _number(ax, curve, numbers[curve.label])

    kinds = {curve.kind for curve in curves}
    handles = [drawing.sample(**border(kind)) for kind in BORDERS if kind in kinds]
    for label, number in numbers.items():
        sign = {"marker": f"${number}$", "ls": "", "c": BLACK, "ms": mark(4), "mew": 0}
        handles.append(drawing.sample(label=typeset(label), **sign))
    return handles


def _number(ax: Axes, curve: Curve, number: int) -> None:
    """Write the number of a curve beyond its upper end."""
    i = int(np.nanargmax(curve.N))
    end = (curve.Omega[i], min(float(curve.N[i]), ax.get_ylim()[1]))
    drawing.say(
        ax,
        str(number),
        end,
        (0, 2),
        fontsize=large(6),
        annotation_clip=False,
        path_effects=drawing.halo(),
    )
