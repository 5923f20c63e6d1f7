"""Figures of studies over parameters: each a few lines over `draw`."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.plots.draw import (
    COLUMN,
    PAGE,
    bar_of,
    class_map,
    colours_of,
    each_value,
    is_rate,
    lines,
    number_map,
    panels,
    rate_axis,
    sign_changes,
)
from disc_model.plots.schema import NORM, grid_figure

SIGN_CHANGES = "growth rate changes its sign"


# ---- Any variable


@grid_figure()
def heat_map(
    study: xr.Dataset, variable: str, x: str, y: str, by: str = NORM, log: bool = False
) -> Figure:
    """Any variable in colour over two dimensions, with a panel for each value of a third."""
    parts = each_value(study, by)
    names = [str(i) for i in range(len(parts))]
    width = PAGE if len(parts) > 1 else COLUMN
    figure, axes = panels([names], width, 2.4, sharex=True, sharey=True)
    for ax, (title, part) in zip(axes.values(), parts, strict=True):
        plane = part[variable].transpose(y, x)
        ax.set_title(title)
        if plane.dtype == object:
            class_map(ax, plane)
            continue
        scale = colours_of(study[variable], log=log)
        mesh = number_map(ax, plane, why_missing(part, variable), **scale)
        if is_rate(plane):
            sign_changes(ax, plane, SIGN_CHANGES)
    if study[variable].dtype != object:
        bar_of(figure, [*axes.values()], mesh, study[variable])
    return figure


@grid_figure()
def curve(study: xr.Dataset, variable: str, x: str, by: str = NORM, log: bool = False) -> Figure:
    """Any variable against one dimension, with a line for each value of another."""
    figure, axes = panels([["a"]], COLUMN, 2.6)
    jump = 1.0 if is_rate(study[variable]) else np.inf
    lines(axes["a"], study[variable], x, doubtful=in_doubt(study, variable), jump=jump)
    if is_rate(study[variable]):
        rate_axis(axes["a"])
    elif log:
        axes["a"].set_yscale("log")
    return figure


def why_missing(data: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Words for the points of a variable without a number: what there is in place of a cycle, or a
    status that is not "ok"."""
    x = data[variable]
    if is_rate(x) and "cycle" in data and data["cycle"].dims == x.dims:
        return data["cycle"]
    if "status" in data and set(data["status"].dims) <= set(x.dims):
        status = data["status"].broadcast_like(x).transpose(*x.dims)
        return status.where(status != "ok", "no_value")
    return None


DOUBTS = {
    "settled": ("settled", "not settled"),
    "sweep_settled": ("settled", "not settled"),
    "converged": ("yes", "not converged"),
}
"""Variables that say whether others are sure, with the word for yes, and what is said otherwise."""
LATE = ("_min", "_max", "_fraction", "_rate", "surface_speed")
"""Ends of names of what `outcome` says of the late motion."""


def in_doubt(data: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Where a value is not known to be final, with the reason as `long_name`."""
    x, found = data[variable], dict[str, Any]()
    for name, (good, why) in DOUBTS.items():
        if name in data and name != variable:
            is_truth = data[name].dtype.kind in "bf"  # of sweeps in Python
            found[why] = data[name] != (True if is_truth else good)
    if "at_lower_bound" in data and variable in ("value", "critical_speed"):
        found["at the lower bound, or below"] = data["at_lower_bound"] == 1
    if {"outcome", "u_max"} <= {*data} and variable.endswith(LATE):
        found["still growing, or undecided"] = data["outcome"].isin(["growing", "undecided"])
    for why, unsure in found.items():
        if {*unsure.dims} <= {*x.dims}:
            whole: xr.DataArray = unsure.broadcast_like(x).transpose(*x.dims)
            return whole.assign_attrs(long_name=why)
    return None
