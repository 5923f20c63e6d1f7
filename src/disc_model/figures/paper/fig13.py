"""Figure 13 of the paper, N = 385 N, Omega = 15.1 rad/s: just above the threshold contact is lost."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures.paper.histories import force_and_disc
from disc_model.figures.style import styled


@styled
def draw(cases: Mapping[str, xr.DataTree], *, until: float = np.inf) -> Figure:
    """(a) contact force, (b) disc at r_0 and a fixed angle."""
    return force_and_disc(cases["F13"], until)
