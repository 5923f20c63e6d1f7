"""Marks of maps of growth rates and of classes: on the right cells, and seen on their colours."""

import numpy as np
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch

from disc_model.figures.cells import edges_of
from disc_model.figures.classes import STABLE
from disc_model.figures.colour_maps import draw_maps
from disc_model.figures.growth import growth_panels

SPEEDS = [10.0, 11.0, 12.0]
LOADS = [100.0, 200.0]
RATES = np.array([[-0.2, -0.1, 0.1], [-0.05, 0.2, np.nan]])


def plane() -> xr.Dataset:
    data = {"growth_rate": (("N", "Omega"), RATES)}
    return xr.Dataset(data, {"N": LOADS, "Omega": SPEEDS})


def hatched(ax: Axes, hatch: str) -> list[PathPatch]:
    return [patch for patch in ax.patches if patch.get_hatch() == hatch]


def middles(patch: PathPatch) -> set[tuple[float, float]]:
    """The middles of the cells that a patch hatches; a path closes each cell once more."""
    corners = patch.get_path().vertices.reshape(-1, 5, 2)[:, :4]
    return {tuple(np.round(cell, 6)) for cell in corners.mean(axis=1)}


def test_cells_are_dotted_where_disturbances_decay() -> None:
    figure, ax = pyplot.subplots()
    growth_panels(figure, [ax], [plane()])
    dotted = set.union(*map(middles, hatched(ax, STABLE.hatch)))
    edges = edges_of(plane()["growth_rate"])
    columns = (edges.across[1:] + edges.across[:-1]) / 2
    rows = (edges.up[1:] + edges.up[:-1]) / 2
    expected = {
        (round(columns[j], 6), round(rows[i], 6))
        for i, j in zip(*np.nonzero(RATES < 0), strict=True)
    }
    assert dotted == expected
    pyplot.close(figure)


def test_a_map_of_growth_rates_is_that_of_every_figure() -> None:
    figure = Figure()
    key = draw_maps(figure, [figure.subplots()], [plane()], "growth_rate")
    assert [handle.get_label() for handle in key.handles] == ["no value", "stable"]
