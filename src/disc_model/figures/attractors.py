"""Bifurcation diagrams, with the largest Lyapunov exponent below."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures.plots import Bifurcation
from disc_model.figures.stability import bifurcation_diagram


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Bifurcation) -> Figure:
    """The figure of a study of the quantity `bifurcation`; others: ``lyapunov`` of that quantity over the same axis."""
    study = study.assign(phase=study["phase"].astype(int) - 1)
    return bifurcation_diagram(study, plot.x, plot.variable, plot.scale, others.get("lyapunov"))
