"""How cells of maps are filled."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures.grids.cells import alone, cycles_of, growth_cells, scale_of

STATUS = {"flag_meanings": "ok no_cycle separates no_stick_slip at_rest failed"}


@pytest.mark.parametrize(
    ("name", "values", "scale"),
    [
        ("D_star", np.linspace(0, 4e-5, 33), "linear"),  # was logarithmic, with the labels 0 and 1 only
        ("c_p", np.linspace(0.0, 1, 33), "linear"),
        ("E", np.linspace(8e10, 2.2e11, 33), "linear"),
        ("m", np.geomspace(0.01, 1, 33), "log"),
        ("c", np.append([0, 0.0025], np.geomspace(0.005, 0.5, 31)), "symlog"),
        ("N", np.geomspace(1, 1000, 5), "linear"),
    ],
)
def test_evenly_spaced_values_have_a_linear_axis(name: str, values: np.ndarray, scale: str) -> None:
    assert scale_of(name, values) == scale


def test_what_there_is_without_a_cycle_is_told_apart() -> None:
    codes = np.array([[0, 1, 2, 3, 3, 4, 5]])
    data = xr.Dataset(
        {
            "growth_rate": (("N", "Omega"), np.where(codes == 0, 0.1, np.nan)),
            "status": (("N", "Omega"), codes, STATUS),
            "sliding_growth_rate": (("N", "Omega"), np.array([[0.1, 0.1, 0.1, -0.1, 0.1, 0.1, 0.1]])),
        },
        {"N": [100.0], "Omega": np.arange(7.0)},
    )
    expected = ["", "none_found", "separates", "slides", "none_found", "sticks", "failed"]
    assert cycles_of(data, "Omega", "N")[0].tolist() == expected


def test_a_growth_rate_unlike_all_around_is_marked() -> None:
    rate = np.full((4, 4), 0.01)
    rate[1, 1] = -0.1
    rate[2, 3] = rate[3, 2] = -0.02  # corners that touch go on into each other, as thin tongues do
    rate[0, 3] = np.nan
    there = np.zeros((4, 4), bool)
    there[1, 1] = True
    np.testing.assert_array_equal(alone(rate), there)
    assert not alone(np.array([[0.1]])).any(), "without neighbours nothing can be said"
    axes = Figure().subplots()
    data = xr.Dataset({"growth_rate": (("N", "Omega"), rate)}, {"N": np.arange(4.0), "Omega": np.arange(4.0)})
    shown = growth_cells(axes, data, "Omega", "N").get_array()
    assert shown[1, 1] == -0.1, "its value was hidden"
    (hatched,) = (cells for cells in axes.collections if cells.get_hatch())
    np.testing.assert_array_equal(~np.ma.getmaskarray(hatched.get_array()), there)
