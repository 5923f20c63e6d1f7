"""Marks of maps of growth rates and of classes: on the right cells, and seen on their colours."""

import numpy as np
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch

from disc_model.figures.cells import edges_of, lay_over
from disc_model.figures.classes import STABLE
from disc_model.figures.colour_maps import draw_maps
from disc_model.figures.colours import growth_norm
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


def test_a_few_large_rates_do_not_pale_all_others() -> None:
    """Two unresolved cells of 660/s left the map of a brake, of 20/s and less, in shades of grey."""
    common = np.linspace(-20, 20, 200)
    assert 19 < growth_norm(np.append(common, [660.0, 400.0])).vmax <= 20
    assert growth_norm(np.append(common[::10], 400.0)).vmax == 400  # one of twenty is not rare


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


def test_cells_are_not_dotted_by_the_sign_of_rounding() -> None:
    """An undamped slider (c_p = 0) has a rate of some 1e-13/s, of either sign, where no mode grows."""
    rates = np.array([[-6e-13, 3e-13, -2e-10], [-0.1, 0.2, -1e-13]])
    neutral = plane().assign(growth_rate=(("N", "Omega"), rates))
    figure, ax = pyplot.subplots()
    entries = growth_panels(figure, [ax], [neutral])
    assert {"stable", "neutral"} <= {entry.get_label() for entry in entries}
    (dotted,) = hatched(ax, STABLE.hatch)
    assert len(middles(dotted)) == 1
    pyplot.close(figure)


def test_marks_are_black_on_light_cells_and_white_on_dark_ones() -> None:
    _, ax = pyplot.subplots()
    white = [1, 1, 1, 1]
    dark = [0, 0, 0.2, 1]
    nothing = [0, 0, 0, 0]
    light = [0.9, 0.9, 0.7, 1]
    colours = np.array([[white, dark, nothing], [light] * 3])
    cells = np.array([[True, True, True], [False, False, False]])
    lay_over(ax, edges_of(plane()["growth_rate"]), cells, STABLE, colours.astype(float))
    inks = {to_hex(patch.get_edgecolor()): middles(patch) for patch in ax.patches}
    assert {ink: len(places) for ink, places in inks.items()} == {"#000000": 2, "#ffffff": 1}
    assert {round(x) for x, _ in inks["#ffffff"]} == {11}
    pyplot.close("all")


def test_a_map_of_growth_rates_is_that_of_every_figure() -> None:
    figure = Figure()
    key = draw_maps(figure, [figure.subplots()], [plane()], "growth_rate")
    assert [handle.get_label() for handle in key.handles] == ["no value", "stable"]


def test_a_map_without_neutral_cells_does_not_name_them() -> None:
    figure, ax = pyplot.subplots()
    entries = growth_panels(figure, [ax], [plane()])
    assert "neutral" not in {entry.get_label() for entry in entries}
    pyplot.close(figure)


def test_one_large_rate_does_not_level_all_others() -> None:
    """The scale was linear up to it over thirty, and all other cells had one colour."""
    usual = np.linspace(-1.6, -0.8, 15)
    norm = growth_norm(np.append(usual, 60.0))
    lowest = norm(-1.6)
    highest = norm(-0.8)
    zero = norm(0.0)
    assert highest - lowest > 0.05
    assert zero - highest > 0.1


def test_small_rates_have_the_usual_scale_beside_a_larger_one() -> None:
    small = np.linspace(-0.016, -0.008, 15)
    beside_larger = growth_norm(np.append(small, 0.6))
    usual = growth_norm(np.array([0.1]))
    assert beside_larger.linear_width == usual.linear_width
