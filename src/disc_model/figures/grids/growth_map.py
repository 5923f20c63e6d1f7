"""Growth maps: the growth rate of the stick-slip cycle over speed and preload, its neutral curves and folds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import GrowthMap
from disc_model.figures.grids.region_map import cycle_patches, growth_cells
from disc_model.figures.grids.stability_map import growth_bar, growth_mesh, no_cycle_patch
from disc_model.figures.parts import BLACK, COLUMN, PAGE, axis_of, new_figure, styled
from disc_model.stability.resonances import Tongue

# ----------------------------------------------------------------------------------------------------
# Curves, from datasets of the quantity `stability_curves`

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


def crossings(curve: Curve, load: float) -> Array:
    """Speeds at which a curve passes a load, rad/s."""
    side = curve.N - load
    at = np.flatnonzero(side[:-1] * side[1:] <= 0)
    step = side[at] - side[at + 1]
    share = np.where(step == 0, 0.0, side[at] / np.where(step == 0, 1.0, step))
    return np.unique(curve.Omega[at] + share * (curve.Omega[at + 1] - curve.Omega[at]))


def draw_curve(ax: Axes, curve: Curve, number: int = 0) -> None:
    """A curve; its number, if it has one, stands beyond its upper end, where it covers no line."""
    ax.plot(curve.Omega, curve.N, color=BLACK, linewidth=1.0, linestyle="-" if curve.kind == "neutral" else DASHED)
    if number and np.isfinite(curve.N).any():
        i = int(np.nanargmax(curve.N))
        ax.annotate(
            str(number),
            (curve.Omega[i], min(float(curve.N[i]), ax.get_ylim()[1])),
            xytext=(0, 2),
            textcoords="offset points",
            fontsize=6,
            ha="center",
            va="bottom",
            annotation_clip=False,
        )


def numbers_of(curves: Sequence[Curve]) -> dict[str, int]:
    """Numbers of the labels, in the order of their speeds; those that are equal have one."""
    named = sorted((curve for curve in curves if curve.label), key=lambda curve: float(np.nanmax(curve.Omega)))
    return {label: i for i, label in enumerate(dict.fromkeys(curve.label for curve in named), 1)}


def number_handles(numbers: Mapping[str, int]) -> list[Line2D]:
    """For legends: what the numbers stand for."""
    return [
        Line2D(
            [],
            [],
            linestyle="",
            marker=f"${number}$",
            color=BLACK,
            markersize=4,
            markeredgewidth=0,
            label=_shown(label),
        )
        for label, number in numbers.items()
    ]


def _shown(label: str) -> str:
    return label.replace("f_s", "$f_s$")


def span(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


# ----------------------------------------------------------------------------------------------------
# Maps


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: GrowthMap) -> Figure:
    """A panel for each normalization.

    Parameters
    ----------
    study : of the quantity `floquet` or `regions` over N and Omega
    others : ``curves`` of the quantity `stability_curves` over Omega and N, if they are to be shown
    """
    norms = parts.normalizations(study)
    figure = new_figure(PAGE if len(norms) > 1 else COLUMN, 2.9)
    axes = list(figure.subplots(1, len(norms), sharey=True, squeeze=False)[0])
    shown = {norm: curves_of(parts.of(others["curves"], norm)) if "curves" in others else [] for norm in norms}
    numbers = numbers_of([curve for curves in shown.values() for curve in curves])
    for ax, norm, letter in zip(axes, norms, "abcdef", strict=False):
        grid = parts.of(study, norm)
        cells = growth_cells if "cycle" in study else growth_mesh
        mesh = cells(ax, grid, "Omega", "N")
        ax.set(xlabel=SPEED, xlim=span(grid["Omega"].values), ylim=span(grid["N"].values))
        for curve in shown[norm]:
            draw_curve(ax, curve, numbers.get(curve.label, 0))
        ax.set_title(f"({letter}) {parts.MODES[norm]}" if len(norms) > 1 else parts.MODES[norm], loc="left", pad=9)
    axes[0].set_ylabel(LOAD)
    _legend(figure, [curve for curves in shown.values() for curve in curves], study)
    growth_bar(figure, mesh, axes)
    return figure


def _legend(figure: Figure, curves: Sequence[Curve], study: xr.Dataset) -> None:
    ax = figure.axes[-1]
    kinds = {curve.kind for curve in curves}
    handles: list[Artist] = []
    if "neutral" in kinds:
        handles += ax.plot([], [], color=BLACK, linewidth=1.0, label="a multiplier crosses the unit circle")
    if "fold" in kinds:
        handles += ax.plot([], [], color=BLACK, linewidth=1.0, linestyle=DASHED, label="fold")
    if "cycle" in study:
        handles += cycle_patches(study)
    elif study["growth_rate"].isnull().any():
        handles.append(no_cycle_patch())
    handles += number_handles(numbers_of(curves))
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=3 if figure.get_figwidth() > COLUMN else 1)
