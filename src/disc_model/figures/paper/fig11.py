"""Figure 11 of the paper, N = 385 N, Omega = 15 rad/s: below the threshold nothing grows."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures.paper.histories import force_and_disc
from disc_model.figures.style import styled


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """(a) contact force, (b) disc at r_0 and a fixed angle."""
    return force_and_disc(cases["F11"])
