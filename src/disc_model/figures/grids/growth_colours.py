"""The one scale of colours for growth rates of the stick-slip cycle."""

from __future__ import annotations

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import AsinhNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from disc_model.figures.parts import axis_of
from disc_model.figures.style import GREY

GREATEST = 0.3
"""Growth rate at which the colours end, 1/s."""
LINEAR = 0.01
"""Growth rate up to which the colours are about linear, 1/s."""
TICKS = (-0.1, -0.01, 0, 0.01, 0.1)
HATCH = "//////"
"""How it looks where there is no cycle."""


def growth_mesh(ax: Axes, growth: xr.Dataset, x: str, y: str) -> QuadMesh:
    """`growth_rate` (1/s, nan without a cycle) over two parameters in colour; hatched where there is no cycle."""
    across, up = (growth[name].values * axis_of(name)[1] for name in (x, y))
    rate = np.ma.masked_invalid(growth["growth_rate"].transpose(y, x).values)
    norm = AsinhNorm(linear_width=LINEAR, vmin=-GREATEST, vmax=GREATEST)
    ax.patch.set(facecolor="white", hatch=HATCH, edgecolor=GREY, linewidth=0)
    return ax.pcolormesh(across, up, rate, cmap=cm.vik, norm=norm, shading="nearest", rasterized=True)


def growth_bar(figure: Figure, mesh: QuadMesh, axes: list[Axes]) -> None:
    """The scale beside the panels."""
    bar = figure.colorbar(mesh, ax=axes, extend="both", pad=0.01, aspect=30)
    bar.set_label("Growth rate of the stick-slip cycle (1/s)")
    bar.set_ticks(TICKS, labels=[f"{x:g}".replace("-", "−") for x in TICKS])
    bar.minorticks_off()


def no_cycle_patch() -> Patch:
    """For legends."""
    return Patch(facecolor="white", hatch=HATCH, edgecolor=GREY, label="no cycle found")
