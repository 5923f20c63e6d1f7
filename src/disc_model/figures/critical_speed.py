"""Charts over speed and preload: where separation begins from the static start, and in sweeps."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures.borders import curves_of, draw_curves, parts_of, passes
from disc_model.figures.cells import edges_of, entries, paint
from disc_model.figures.classes import LOOKS
from disc_model.figures.drawing import BLACK, PAPER, halo, letters, mark_failed, row_of_panels
from disc_model.figures.kinds.maps import CriticalSpeed
from disc_model.figures.legends import figure_legend
from disc_model.figures.onset_lines import draw_onsets, draw_without_onset
from disc_model.figures.selection import failed
from disc_model.figures.swept_speeds import draw_sweeps
from disc_model.figures.types import Artist, Axes, Figure
from disc_model.figures.words import LOAD, SPEED

CONTACT = LOOKS["growing"]._replace(
    label="oscillations grow, or another\ncycle is reached, in contact"
)


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
    draw_onsets(axes[0], study, horizon, f"separation begins, within {horizon:g} s")
    draw_without_onset(axes[0], study, horizon)
    _paper_points(axes[0], plot.paper_points)

    # in sweeps
    titles = ["from the static start"]
    if sweep is not None:
        draw_onsets(axes[1], study, horizon, "_nolegend_")
        titles.append(draw_sweeps(axes[1], sweep, cycle, overlays.get("basins")))

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
