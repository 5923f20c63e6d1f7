"""Sweeps of functions that return a table, and of what a function used in place of an argument."""

import numpy as np
import pandas as pd
from matplotlib import pyplot

import disc_model as dm

CASE = dm.Parameters(
    N=385, Omega=15, n_diameters=1, n_circles=0, normalization="orthonormal", D_star=1e-5
)
THICKNESS = [0.002, 0.0021]


def test_the_columns_of_a_table_are_variables() -> None:
    """It was refused, and a function of one column had "0" along its axis."""
    found = dm.sweep(dm.plate_modes, CASE, h=THICKNESS)
    first = dm.plate_modes(CASE.replace(h=THICKNESS[0]))
    assert found["omega"].dims == ("h", "row")
    assert found["omega"][0].values.tolist() == first["omega"].tolist()
    assert found["diameters"].values.tolist() == [[0, 1], [0, 1]]
    assert found["omega"].attrs["units"] == "rad s-1"


def test_frequencies_of_a_table_are_drawn_unasked() -> None:
    ax = dm.plot_sweep(dm.sweep(dm.plate_modes, CASE, h=THICKNESS))
    assert "atural frequency of the disc alone" in ax.get_ylabel().replace("\n", " ")
    pyplot.close("all")


def test_words_of_a_table_are_variables_too() -> None:
    def table_of(case: dm.Parameters) -> pd.DataFrame:
        return pd.DataFrame({"load": [case.N, 2 * case.N], "which": ["once", "twice"]})

    found = dm.sweep(table_of, CASE, N=[300, 385])
    assert found["load"].values.tolist() == [[300, 600], [385, 770]]
    assert found["which"].values.tolist() == [["once", "twice"]] * 2


def test_a_sweep_over_tolerances_says_which_ones_were_used() -> None:
    """Its axis said 1e-6 s, where runs had used the limit."""
    found = dm.sweep(dm.simulate, CASE, 0.01, over={"tol": [1e-10, 1e-6]})
    assert found["tol"].values.tolist() == [1e-10, 1e-6]
    assert found["tol_used"].values.tolist() == [1e-10, dm.simulate(CASE, 0.01, tol=1e-6).tol]
    assert "that was used" in found["tol_used"].attrs["long_name"]
    assert "tol_used" not in dm.sweep(dm.simulate, CASE, 0.01, N=[300, 385])


def test_a_result_that_has_the_name_of_an_axis_gets_another_one() -> None:
    """Coordinates of modes of steady sliding are called a and b, as the radii are."""
    case = dm.Parameters(N=385, Omega=18, normalization="orthonormal", damping_ratio=1e-3)
    swept = dm.sweep(dm.steady_sliding, case.replace(r_0=0.05), b=[0.14, 0.15])
    np.testing.assert_array_equal(swept["b"], [0.14, 0.15])
    alone = dm.steady_sliding(case.replace(r_0=0.05, b=0.14)).b
    np.testing.assert_array_equal(swept["steady_sliding_b"].isel(b=0), alone)
