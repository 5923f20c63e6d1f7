"""Neutral curves and folds of the stick-slip cycle over speed and preload, as maps and charts draw them."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.variables import axis_of, flag_names, typeset
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, Axes, Line2D
from disc_model.stability.resonances import Resonance

Array = NDArray[np.float64]

SPEED, LOAD = axis_of("Omega")[0], axis_of("N")[0]


@dataclass(frozen=True, eq=False)
class Curve:
    """A line on a stability chart.

    Attributes
    ----------
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
            near = Resonance(
                **{field.name: curve_data[f"resonance_{field.name}"].item() for field in fields(Resonance)}
            )
            label = near.label.replace(" - ", " − ").replace("Ω/2π", "f_Ω")
        curves.append(Curve(x, y, str(kinds[i]), label))
    return curves


def parted(curves: Sequence[Curve], cycle: xr.Dataset) -> tuple[list[Curve], list[Curve]]:
    """Split curves into the parts that bound the cycle of a map, and those that belong to another cycle.

    cycle : `growth_rate` (1/s, nan without a cycle) over N and Omega
    """
    from scipy.ndimage import binary_dilation

    rate = cycle["growth_rate"]
    # beside a cell are the eight around it
    stable, unstable, not_stable = (
        binary_dilation(side, np.ones((3, 3))) for side in (rate < 0, rate > 0, ~(rate < 0))
    )
    beside = {"neutral": stable & unstable, "fold": stable & not_stable}
    shown: list[Curve] = []
    other: list[Curve] = []
    for curve in curves:
        side = np.isfinite(curve.Omega)
        i, j = (
            np.abs(rate[name].values - np.nan_to_num(getattr(curve, name))[:, None]).argmin(axis=1)
            for name in ("N", "Omega")
        )
        bounding = side & beside[curve.kind][i, j]
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


def draw_curves(axes: Sequence[Axes], curves: Sequence[Sequence[Curve]], data: Sequence[xr.Dataset]) -> list[Line2D]:
    """Draw the curves of each panel, numbered if they have a label; returns legend entries of lines and numbers.

    Numbers ascend with speed, equal labels share one, and they stand beyond the upper end, where they cover no line.

    data : the curves' datasets, with the number of places at which continuation failed
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
    lost = [int(dataset["n_continuation_failures"].sum()) for dataset in data]
    if any(lost):
        counts = [f"{count} in ({'abcdef'[i]})" if len(lost) > 1 else f"{count}" for i, count in enumerate(lost)]
        handles.append(drawing.sample(linestyle="", label=f"continuation failed: {', '.join(counts)}"))
    return handles


def span(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())
