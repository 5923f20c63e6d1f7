"""Growth of the stick-slip cycle, its neutral curves and folds, and where separation follows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import GrowthMap, Thresholds
from disc_model.figures.grids.stability import Curve, growth_map, threshold_chart
from disc_model.stability.tongue import Tongue

NEAR = 3.0
"""Hz; a resonance further off than this is not named."""


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: GrowthMap | Thresholds) -> Figure:
    """The figure of a study of the quantity `floquet` or `critical_speed`.

    Parameters
    ----------
    others : ``curves`` of the quantity `stability_curves` over Omega and N; for thresholds also ``cycle`` of the
        quantity `floquet` over the same
    """
    if isinstance(plot, GrowthMap):
        norms = parts.normalizations(study)
        grids = {norm: parts.of(study, norm) for norm in norms}
        curves = {norm: curves_of(parts.of(others["curves"], norm)) for norm in norms} if "curves" in others else None
        return growth_map(grids, curves)
    norm = parts.normalizations(study)[0]
    study = parts.of(study, norm)
    horizon = float(study["horizon"].max())
    found = curves_of(parts.of(others["curves"], norm))
    # beyond the scan nothing is known of separation
    scan = study["scan_Omega"].values
    cycle = parts.of(others["cycle"], norm).sel(Omega=slice(scan[0], scan[-1])) if "cycle" in others else None
    if cycle is not None and min(cycle["growth_rate"].shape) < 2:
        cycle = None
    return threshold_chart(
        study["N"].values,
        study["critical_speed"].sel(horizon=horizon).values,
        horizon,
        joined([curve for curve in found if curve.kind == "neutral"]),
        [curve for curve in found if curve.kind == "fold"],
        dict(plot.claim.values()),
        cycle,
        parts.failed(study).values,
    )


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
