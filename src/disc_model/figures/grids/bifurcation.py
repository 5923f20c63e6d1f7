"""Bifurcation diagrams, with the largest Lyapunov exponent below."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.grids.kinds import Bifurcation
from disc_model.figures.grids.stability import bifurcation_diagram


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Bifurcation) -> Figure:
    """The figure of a study of the quantity `bifurcation`; others: ``lyapunov`` of that quantity over the same axis."""
    norm = parts.normalizations(study)[0]
    study = parts.of(study, norm)
    study = study.assign(phase=(study["phase"].astype(int) - 1).where(~parts.failed(study), -1))
    exponents = None
    if "lyapunov" in others:
        exponents = parts.without_failed(parts.of(others["lyapunov"], norm), "exponent", "exponent_error")
    return bifurcation_diagram(study, plot.x, plot.variable, plot.scale, exponents)
