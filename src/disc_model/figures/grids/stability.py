"""Stability of the stick-slip cycle: growth maps, neutral curves, the chart of thresholds, bifurcation diagrams.

Curves are given as `Curve`s, plain arrays, so that nothing here computes a cycle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import AsinhNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from disc_model.figures.parts import MOTION, axis_of, letter, mark_failed
from disc_model.figures.style import BLACK, BLUE, COLUMN, ORANGE, PAGE, VERMILION, new_figure, styled

Array = NDArray[np.float64]

GREY = "#bdbdbd"
DASHED = (0, (3, 1.5))
SPEED, LOAD = "drive speed Ω (rad/s)", "preload N (N)"
TITLES = {"as_published": "modes as published", "orthonormal": "orthonormal modes"}


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


@styled
def growth_map(
    grids: Mapping[str, xr.Dataset], curves: Mapping[str, Sequence[Curve]] | None = None, limit: float | None = None
) -> Figure:
    """Growth rate of the cycle over speed and load, a panel for each normalisation.

    grids : by normalisation, datasets with `growth_rate` (1/s, nan without a cycle) over dimensions N and Omega
    curves : by normalisation, neutral curves and folds to draw on top
    limit : 1/s, end of the colour scale; by default that of the 98th percentile of all moduli
    """
    figure = new_figure(PAGE if len(grids) > 1 else COLUMN, 2.9)
    axes = np.atleast_1d(figure.subplots(1, len(grids), sharey=True, squeeze=True))
    if limit is None:
        every = np.concatenate([np.abs(grid["growth_rate"].values).ravel() for grid in grids.values()])
        limit = float(np.nanpercentile(every, 98)) if np.any(np.isfinite(every)) else 1.0
    mesh: QuadMesh | None = None
    for i, (ax, (name, grid)) in enumerate(zip(axes, grids.items(), strict=True)):
        mesh = _rate_mesh(ax, grid, limit)
        for curve in (curves or {}).get(name, ()):
            _draw(ax, curve)
        ax.set(xlabel=SPEED, xlim=_span(grid["Omega"].values), ylim=_span(grid["N"].values))
        ax.set_title(TITLES.get(name, name), loc="right")
        if len(grids) > 1:
            letter(ax, "abcdef"[i])
    axes[0].set_ylabel(LOAD)
    _legend(axes[-1], curves or {}, any(bool(grid["growth_rate"].isnull().any()) for grid in grids.values()))
    if mesh is not None:
        bar = figure.colorbar(mesh, ax=list(axes), pad=0.02, extend="both")
        bar.set_label("growth rate of the cycle (1/s)")
        ticks = [x for x in (-10, -1, -0.1, -0.01, 0, 0.01, 0.1, 1, 10) if abs(x) <= limit]
        bar.set_ticks(ticks, labels=[f"{x:g}".replace("-", "−") for x in ticks])
        bar.minorticks_off()
    return figure


def _rate_mesh(ax: Axes, grid: xr.Dataset, limit: float) -> QuadMesh:
    ax.set_facecolor(GREY)
    rate = grid["growth_rate"].transpose("N", "Omega")
    norm = AsinhNorm(linear_width=min(0.01, limit / 10), vmin=-limit, vmax=limit)
    values = np.ma.masked_invalid(rate.values)
    return ax.pcolormesh(rate["Omega"], rate["N"], values, norm=norm, cmap=cm.vik, shading="nearest", rasterized=True)


def _span(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _draw(ax: Axes, curve: Curve) -> None:
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


def _legend(ax: Axes, curves: Mapping[str, Sequence[Curve]], gaps: bool) -> None:
    kinds = {curve.kind for group in curves.values() for curve in group}
    handles: list[object] = []
    if "neutral" in kinds:
        handles += ax.plot([], [], color=BLACK, linewidth=1.0, label="a multiplier crosses the unit circle")
    if "fold" in kinds:
        handles += ax.plot([], [], color=BLACK, linewidth=1.0, linestyle=DASHED, label="fold")
    if gaps:
        handles.append(Patch(facecolor=GREY, label="no cycle"))
    if handles:
        ax.figure.legend(handles=handles, loc="outside lower center", ncols=3)  # type: ignore[call-arg]


@styled
def threshold_chart(
    N: Array,
    separation: Array,
    horizon: float,
    neutral: Curve,
    folds: Sequence[Curve] = (),
    printed: Mapping[float, float] | None = None,
    cycle: xr.Dataset | None = None,
    failed: NDArray[np.bool_] | None = None,
) -> Figure:
    """Where the cycle becomes unstable, and where separation follows within a stated time, on one chart.

    N, separation : shape (n,), load (N) and the lowest speed (rad/s) with separation within `horizon` (s), nan if none
    neutral : curve on which the cycle loses stability; the band from it to `separation` is shaded and named. The
        cycle may be stable again beyond: then give `cycle`
    folds : where the cycle ceases to exist
    printed : critical speeds of the paper by load
    cycle : `growth_rate` (1/s, nan without a cycle) over N and Omega: what is shaded is where no cycle is stable
    failed : shape (n,), loads at which separation is not known; they are marked
    """
    figure = new_figure(COLUMN, 3.4)
    ax = figure.subplots()
    ax.set_ylim(0.95 * N.min(), 1.02 * N.max())
    lost = np.zeros(len(N), bool) if failed is None else failed
    mark_failed(ax, N[lost], on="y")
    order = np.argsort(N[~lost])
    N, separation = N[~lost][order], separation[~lost][order]
    ax.plot(separation, N, "o-", color=VERMILION, markersize=3, label=f"separation within {horizon:g} s")
    ax.plot(neutral.Omega, neutral.N, color=BLUE, label="cycle loses stability")
    band = f"no stable cycle, no separation within {horizon:g} s"
    if cycle is None:
        lowest = _lowest_speed(neutral, N)
        both = np.isfinite(lowest) & np.isfinite(separation) & (lowest < separation)
        ax.fill_betweenx(N, lowest, separation, where=both, color=BLUE, alpha=0.15, linewidth=0, label=band)
    elif N.size:
        _unstable_before(ax, cycle, N, separation, band)
    for i, fold in enumerate(folds):
        label = "fold: the cycle ends" if i == 0 else "_nolegend_"
        ax.plot(fold.Omega, fold.N, color=BLACK, linestyle=DASHED, label=label)
        if fold.label:
            _draw(ax, fold)
    if printed:
        ax.plot(list(printed.values()), list(printed), "s", color=ORANGE, markersize=4, label="paper")
    ax.set(xlabel=SPEED, ylabel=LOAD)
    if cycle is not None:
        ax.set_xlim(*_span(cycle["Omega"].values))
    figure.legend(loc="outside upper center", ncols=1)
    return figure


def _unstable_before(ax: Axes, cycle: xr.Dataset, N: Array, separation: Array, label: str) -> None:
    """Shade where no cycle is stable, at speeds below those of separation."""
    rate = cycle["growth_rate"].transpose("N", "Omega")
    loads, speeds = rate["N"].values, rate["Omega"].values
    known = np.isfinite(separation)
    until = np.interp(loads, N[known], separation[known]) if known.any() else np.full(len(loads), np.inf)
    # none found at the loads on both sides
    until[np.interp(loads, N, known.astype(float)) == 0] = np.inf
    here = ~(rate.values < 0) & (speeds[None, :] < until[:, None])
    ax.contourf(speeds, loads, here.astype(float), levels=[0.5, 1.5], colors=[BLUE], alpha=0.18)
    ax.fill_between([], [], [], color=BLUE, alpha=0.18, linewidth=0, label=label)


def _lowest_speed(curve: Curve, N: Array) -> Array:
    """Lowest speed at which the curve passes each load: (len(N),), nan where it does not."""
    lowest = np.full(len(N), np.nan)
    for i, load in enumerate(N):
        side = curve.N - load
        at = np.flatnonzero(side[:-1] * side[1:] <= 0)
        if len(at):
            share = side[at] / np.where(side[at] == side[at + 1], 1.0, side[at] - side[at + 1])
            lowest[i] = np.min(curve.Omega[at] + share * (curve.Omega[at + 1] - curve.Omega[at]))
    return lowest


@styled
def bifurcation_diagram(
    samples: xr.Dataset, name: str, variable: str = "psi", scale: float = 1e3, lyapunov: xr.Dataset | None = None
) -> Figure:
    """Samples once a turn against a parameter; those in stick apart from those in slip or separation.

    Where all samples or the largest exponent are missing, a cross says so.

    samples : as `disc_model.stability.bifurcation.bifurcation_samples` returns; name : its parameter's dimension
    scale : factor for the axis, 1e3 shows mrad or mm
    lyapunov : `exponent` and `exponent_error` (1/s) over the parameter and `exponent_number`, for a panel below
    """
    figure = new_figure(PAGE, 2.6 if lyapunov is None else 4.0)
    axes = figure.subplots(1 if lyapunov is None else 2, 1, sharex=True, squeeze=False)[:, 0]
    ax = axes[0]
    values = samples[variable].transpose(name, "sample")
    phase = samples["phase"].transpose(name, "sample").values
    label, factor = axis_of(name)
    along = values[name].values * factor
    position = np.broadcast_to(along[:, None], values.shape)
    for code, color, name_of_phase in ((0, BLUE, "stick"), (1, ORANGE, "slip"), (2, VERMILION, "separation")):
        here = phase == code
        if np.any(here):
            ax.plot(position[here], values.values[here] * scale, ".", color=color, markersize=1.5, label=name_of_phase)
    mark_failed(ax, along[(phase == -1).all(axis=1)])
    unit = values.attrs.get("units", "")
    prefix = {1e3: "m", 1.0: "", 1e6: "µ"}.get(scale, f"{1 / scale:g} ")
    axes[-1].set_xlabel(label)
    ax.set_ylabel(f"{MOTION[variable]} ({prefix}{unit.replace(' s-1', '/s')})")
    if lyapunov is not None:
        _exponents(axes[1], lyapunov, name)
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, markerscale=5, borderaxespad=0.2)
    return figure


def _exponents(ax: Axes, lyapunov: xr.Dataset, name: str) -> None:
    """The largest exponents with four standard errors."""
    exponent = lyapunov["exponent"].transpose("exponent_number", name)
    error = lyapunov["exponent_error"].transpose("exponent_number", name)
    along = exponent[name].values * axis_of(name)[1]
    ax.axhline(0, color=GREY, linewidth=0.8)
    for i, color in zip(range(len(exponent)), (VERMILION, BLUE, ORANGE, BLACK), strict=False):
        label = "largest exponent" if i == 0 else f"exponent {i + 1}"
        low, high = (exponent[i].values + s * 4 * error[i].values for s in (-1, 1))
        ax.plot(along, exponent[i], ".-", color=color, markersize=3, linewidth=0.8, label=label)
        ax.fill_between(along, low, high, color=color, alpha=0.15, linewidth=0)
    mark_failed(ax, along[np.isnan(exponent[0].values)])
    ax.set_ylabel("Lyapunov exponents (1/s)")
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0.2)


__all__ = ["Curve", "bifurcation_diagram", "growth_map", "threshold_chart"]
