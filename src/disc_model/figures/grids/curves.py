"""Curves on charts of stability: from datasets of the quantity `stability_curves`, and how they are drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

from disc_model.data.variables import flag_names
from disc_model.figures.parts import BLACK, axis_of
from disc_model.stability.resonances import Tongue

Array = NDArray[np.float64]

NEAR = 3.0
"""Hz; a resonance further off than this is not named."""
DASHED = (0, (3, 1.5))
SPEED, LOAD = axis_of("Omega")[0], axis_of("N")[0]


@dataclass(frozen=True, eq=False)
class Curve:
    """A line on a stability chart.

    Attributes
    ----------
    Omega, N : shape (n,), rad/s and N
    kind : "neutral" or "fold"
    label : what stands next to it, such as a tongue's "2 f_s = 135.42 Hz"; may be empty
    """

    Omega: Array
    N: Array
    kind: str
    label: str = ""


def curves_of(data: xr.Dataset) -> list[Curve]:
    """Curves of a dataset of the quantity `stability_curves`, x as Omega and y as N, where a stable cycle is beside."""
    kinds = flag_names(data["kind"])
    found = []
    for i in np.flatnonzero(kinds != "none"):
        one = data.isel(curve=int(i))
        border = (flag_names(one["border"]) == "yes") & np.isfinite(one["x"].values)
        if border.sum() < 2:
            continue
        x, y = (np.where(border, one[name].values, np.nan) for name in ("x", "y"))
        near = kinds[i] == "fold" and abs(float(one["tongue_detuning"])) < NEAR
        found.append(Curve(x, y, str(kinds[i]), _tongue(one).label if near else ""))
    return found


def _tongue(one: xr.Dataset) -> Tongue:
    numbers = {
        name: one[f"tongue_{name}"].item() for name in ("harmonic", "frequency", "diameters", "sign", "detuning")
    }
    return Tongue(**numbers)


def joined(curves: list[Curve]) -> Curve:
    """Several curves as one, with gaps between."""
    gap = np.array([np.nan])
    Omega, N = ([part for curve in curves for part in (getattr(curve, name), gap)] or [gap] for name in ("Omega", "N"))
    return Curve(np.concatenate(Omega), np.concatenate(N), "neutral")


def draw_curve(ax: Axes, curve: Curve) -> None:
    ax.plot(curve.Omega, curve.N, color=BLACK, linewidth=1.0, linestyle="-" if curve.kind == "neutral" else DASHED)
    there = np.flatnonzero(np.isfinite(curve.N))
    if curve.label and len(there):
        i = int(there[len(there) // 2])
        ax.annotate(
            curve.label.replace("f_s", "$f_s$"),
            (curve.Omega[i], curve.N[i]),
            xytext=(4, -4),
            textcoords="offset points",
            fontsize=6,
            va="top",
            bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.8},
        )


def span(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())
