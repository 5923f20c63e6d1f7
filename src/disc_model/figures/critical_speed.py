"""Charts over speed and preload: where separation begins from the static start, and in sweeps."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.transforms import ScaledTranslation

from disc_model.data.swept_speeds import swept_speeds
from disc_model.data.variables import flag_names, stated_in
from disc_model.figures.borders import curves_of, draw_curves, parts_of, passes
from disc_model.figures.cells import edges_of, entries, paint
from disc_model.figures.classes import AT_BOUND, LOOKS
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    ORANGE,
    PAPER,
    SEPARATED,
    halo,
    large,
    letters,
    mark,
    mark_failed,
    row_of_panels,
    wide,
)
from disc_model.figures.kinds.maps import CriticalSpeed
from disc_model.figures.legends import figure_legend
from disc_model.figures.onsets import branches, speeds_of
from disc_model.figures.selection import failed, stretches
from disc_model.figures.types import Artist, Axes, Figure
from disc_model.figures.words import LOAD, SPEED

ONSET = SEPARATED  # colour of speeds at which separation begins,
END = BLUE  # and at which it ends
CONTACT = LOOKS["growing"]._replace(
    label="oscillations grow, or another\ncycle is reached, in contact"
)
ARROW = 5.0  # pt, length of an arrow to lower speeds, and its distance from the mark
BAR = 20.0  # N, height of the mark of coexistence, well within a step of the sweeps


def draw(plot: CriticalSpeed, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw (a) where separation begins from the static start, over a map, and (b) sweeps of the
    speed."""
    sweep = overlays.get("hysteresis")
    cycle = _within_scan(overlays.get("cycle"), study)
    lost = failed(study).values
    loads = study["N"].values

    # panels
    count = 1 if sweep is None else 2
    width = plot.inches_of(count)
    figure, axes = row_of_panels(width, count, 3.8, 3.8, sharex=True, sharey=True)
    speeds = study["scan_Omega"].values
    if cycle is not None:
        speeds = cycle["Omega"].values
    axes[0].set_xlim(speeds.min(), speeds.max())
    axes[0].set_ylim(0.95 * loads.min(), 1.02 * loads.max())
    mark_failed(axes[0], loads[lost], on="y")
    study = study.isel(N=~lost).sortby("N")

    # from the static start
    handles: list[Artist] = []
    if cycle is not None:
        handles += _behind(axes[0], cycle)
    if "curves" in overlays:
        handles += _curves(axes[0], overlays["curves"], cycle)
    horizon = float(study["horizon"].max())
    _onsets(axes[0], study, horizon, f"separation begins, within {horizon:g} s")
    _paper_points(axes[0], plot.paper_points)

    # in sweeps
    titles = ["from the static start"]
    if sweep is not None:
        _onsets(axes[1], study, horizon, "_nolegend_")
        titles.append(_beside(axes[1], sweep, cycle, overlays.get("basins")))

    letters(axes, titles, pad=12)
    for ax in axes:
        ax.set_xlabel(SPEED)
        handles += _new_marks(ax, handles)
        ax.set_ylabel(LOAD)
        ax.label_outer()
    figure_legend(figure, handles, loc="outside lower center", columns=3, columnspacing=1.0)
    return figure


def _new_marks(ax: Axes, known: list[Artist]) -> list[Artist]:
    """Lines and marks of a panel that the legend does not have yet, by their kind and name."""
    names = {(type(handle), handle.get_label()) for handle in known}
    found = ax.get_legend_handles_labels()[0]
    return [handle for handle in found if (type(handle), handle.get_label()) not in names]


def _within_scan(cycle: xr.Dataset | None, study: xr.Dataset) -> xr.Dataset | None:
    """A map at the speeds that were scanned; beyond them separation is unknown."""
    if cycle is None:
        return None
    speeds = study["scan_Omega"].values
    return cycle.sel(Omega=slice(speeds.min(), speeds.max())).transpose("N", "Omega", ...)


def _behind(ax: Axes, cycle: xr.Dataset) -> list[Artist]:
    """Draw outcomes of the static start; returns entries of a legend."""
    words = flag_names(cycle["outcome"])
    words = np.where(words == "other_cycle", "growing", words)
    horizon = stated_in(cycle, "options")["horizon"]
    apart = LOOKS["separation"]._replace(label=f"separation within {horizon:g} s")
    looks = {**LOOKS, "growing": CONTACT, "separation": apart}
    paint(ax, edges_of(cycle["growth_rate"]), words, looks)
    return entries(words.flat, looks)


def _curves(ax: Axes, curves: xr.Dataset, cycle: xr.Dataset | None) -> list[Artist]:
    """Draw continued curves; what passes no cell with separation has no name. Returns entries of a
    legend."""
    found = curves_of(curves)
    if cycle is None:
        return draw_curves(ax, found)
    apart = cycle["outcome"].copy(data=flag_names(cycle["outcome"]) == "separation")
    shown = []
    for curve in parts_of(found, cycle):
        if not passes(curve, apart).any():
            curve = curve._replace(label="")
        shown.append(curve)
    return draw_curves(ax, shown)


def _paper_points(ax: Axes, points: Mapping[str, tuple[float, float]]) -> None:
    """Mark what the paper says, hollow, as marks lie below."""
    if not points:
        return
    load, speed = np.transpose([*points.values()])
    ax.plot(
        speed,
        load,
        "*",
        ms=10,
        mew=1.1,
        label="paper",
        mfc="none",
        mec=PAPER,
        path_effects=halo(2.1, BLACK),
        zorder=5,
        clip_on=False,
    )


# ---- Onsets


def _onsets(ax: Axes, study: xr.Dataset, horizon: float, label: str) -> None:
    """Draw onsets of separation, joined along their branches, seen on any area by black edges and
    below the curves."""
    loads = study["N"].values
    speeds = speeds_of(study, horizon)
    ends = speeds_of(study, horizon, "ends")
    points: list[tuple[float, float]] = []
    gap = (np.nan, np.nan)
    for link in branches(speeds, ends):
        points += [(link.speed, loads[link.load]), (link.ahead, loads[link.load + 1]), gap]
    for load, row in zip(loads, speeds, strict=True):
        for speed in row:
            points += [(speed, load), gap]
    outline = halo(1.3, BLACK)
    ax.plot(
        *np.reshape(points, (-1, 2)).T,
        path_effects=outline,
        zorder=1.9,
        label=label,
        c="white",
        marker="o",
        ms=mark(2.4),
        mec=BLACK,
        mew=0.5,
    )


# ---- Sweeps


def _beside(
    ax: Axes, sweep: xr.Dataset, cycle: xr.Dataset | None, basins: xr.Dataset | None
) -> str:
    """Draw sweeps of the speed, and shade where some motions stay quiet and others separate;
    returns a title."""
    loads = sweep["N"].values
    lost = failed(sweep).values
    swept = swept_speeds(sweep)
    onset = np.where(lost, np.nan, swept.onset.values)
    end = np.where(lost, np.nan, swept.end.values)
    for speeds, shape, colour, label in (
        (onset, "^", ONSET, "sweep up: separation begins"),
        (end, "v", END, "sweep down: separation ends"),
    ):
        ax.plot(
            speeds,
            loads,
            shape,
            color=colour,
            markersize=mark(4),
            markerfacecolor="none",
            clip_on=False,
            label=label,
        )
    _point_to_less(ax, loads, onset, swept.onset_at_bound.values & ~lost, ONSET)
    _point_to_less(ax, loads, end, swept.end_at_bound.values & ~lost, END)
    mark_failed(ax, loads[lost], on="y")
    if basins is not None:
        _coexistence(ax, basins)
    elif cycle is not None:
        _stable_cycles(ax, sweep, cycle)
    step = float(np.diff(sweep["sweep_Omega"].values[:2])[0])
    return f"sweeps in steps of {step:g} rad/s"


def _point_to_less(
    ax: Axes, loads: np.ndarray, speeds: np.ndarray, at_bound: np.ndarray, colour: str
) -> None:
    """Set an arrow beside each speed that is the lowest of its sweep, and may be less."""
    if not at_bound.any():
        return
    label = AT_BOUND.label
    if label in ax.get_legend_handles_labels()[1]:
        label = "_nolegend_"
    page: Any = ax.get_figure(root=True)
    left = ScaledTranslation(-large(ARROW) / 72, 0, page.dpi_scale_trans)
    ax.plot(
        speeds[at_bound],
        loads[at_bound],
        linestyle="",
        marker=r"$\leftarrow$",
        color=colour,
        label=label,
        markersize=mark(ARROW),
        markeredgewidth=0,
        transform=ax.transData + left,
        clip_on=False,
    )


def _coexistence(ax: Axes, basins: xr.Dataset) -> None:
    """Mark speeds at which some starts stay quiet and others separate: both fractions exceed zero
    with their intervals. A single speed is a line."""
    load = stated_in(basins, "base")["N"]
    speeds = basins["Omega"].values
    quiet = basins["basin_fraction_low"].sel(attractor_class="quiet")
    apart = basins["separating_fraction_low"]
    both = ((quiet > 0) & (apart > 0)).values
    label = f"quiet or separating,\ncomputed at {load:g} N"
    for first, after in stretches(both):
        width = speeds[after - 1] - speeds[first]
        ax.barh(
            load,
            width,
            BAR,
            speeds[first],
            label=label,
            color=ORANGE,
            ec=ORANGE,
            alpha=0.6,
            lw=wide(0.8),
        )
        label = "_nolegend_"


def _stable_cycles(ax: Axes, sweep: xr.Dataset, cycle: xr.Dataset) -> None:
    """Shade where the cycle is stable by its multipliers, as short stays only delay a sweep up, and
    the sweep down still separates; not between loads of which one never does."""
    speeds = cycle["Omega"].values
    loads = cycle["N"].values
    ends = swept_speeds(sweep).end.values
    lowest = np.interp(loads, sweep["N"].values, ends, left=np.nan, right=np.nan)
    highest = float(sweep["sweep_Omega"].max())
    within = (speeds >= lowest[:, None]) & (speeds <= highest)
    stable = (cycle["growth_rate"].values < 0) & within
    shown = np.ma.masked_where(~stable, stable)
    ax.pcolormesh(
        speeds,
        loads,
        shown,
        cmap=ListedColormap([ORANGE]),
        alpha=0.25,
        shading="nearest",
        rasterized=True,
    )
    label = "the cycle is stable where the\nsweep down still separates"
    ax.fill_between([], [], [], color=ORANGE, alpha=0.25, label=label)
