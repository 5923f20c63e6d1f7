"""Points of lines that have no value along the axis."""

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.symbols import in_a_row
from tests.figures.reading import labels

CASE = dm.Parameters(N=385, Omega=15)
TABLE = pd.DataFrame({"c": [0.5, np.nan, 1.5], "mu_s": [0.38, 0.39, 0.4]})
WORDS = "not drawn: 1 of 3 without Damper c"


def load_of(case: dm.Parameters) -> dict[str, float]:
    """A result of its own."""
    return {"size": case.N * case.c}


def shown(ax: Axes) -> list[str]:
    """What the legend of a picture says, without lines."""
    return [in_a_row(text) for text in labels(ax.figure)]


def test_samples_without_a_value_along_the_axis_are_counted() -> None:
    """They were left out without a word."""
    sizes = dm.sweep(load_of, CASE, zip=TABLE)
    assert shown(dm.plot_sweep(sizes, "size")).count(WORDS) == 1


def test_nothing_is_said_where_all_have_a_place() -> None:
    sizes: xr.Dataset = dm.sweep(load_of, CASE, zip=TABLE.dropna())
    said = shown(dm.plot_sweep(sizes, "size"))
    assert not [text for text in said if "not drawn" in text]
