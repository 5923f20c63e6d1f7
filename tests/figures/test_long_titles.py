"""Titles of many values above axes of a reader."""

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.drawing import large
from disc_model.figures.sizes import COLUMN, INCH
from tests.figures.reading import as_map

MANY = {"mu_k": 0.25, "E": 2e11, "m": 0.3, "D_star": 2e-5, "k_p": 1.5e4, "nu": 0.3}
FEW = {"k_p": 1.5e4}


def outcomes(values: dict[str, float]) -> xr.Dataset:
    """Outcomes over speed and preload."""
    words = np.full((4, 4), "quiet")
    words[2:] = "separating"
    plane = xr.DataArray(words, {"Omega": [5.0, 6, 7, 8], "N": [200.0, 300, 400, 500]})
    case = dm.Parameters(N=385, Omega=15, **values)
    return plane.to_dataset(name="outcome").assign_attrs(base=json.dumps(case.model_dump()))


@pytest.mark.parametrize(("values", "share"), [(MANY, 0.75), (FEW, 1.0)])
def test_many_values_above_a_column_wide_map_have_two_lines(
    values: dict[str, float], share: float
) -> None:
    """They had three, of 10 points."""
    _, ax = pyplot.subplots(figsize=(COLUMN, 70 / INCH), layout="constrained")
    as_map(outcomes(values), "outcome", ax=ax, title=True)
    title = ax.get_title(loc="left")
    assert title.count("\n") < 2
    assert "more" not in title
    assert ax._left_title.get_fontsize() == pytest.approx(share * large(8))


def rates(case: dm.Parameters) -> xr.Dataset:
    """Growth rates over speed and preload."""
    plane = {"Omega": [5.0, 6, 7, 8], "N": [200.0, 300, 400, 500]}
    steady = xr.DataArray(np.linspace(-0.3, 0.3, 16).reshape(4, 4), plane, attrs={"units": "s-1"})
    return steady.to_dataset(name="growth_rate").assign_attrs(base=json.dumps(case.model_dump()))


@pytest.mark.parametrize("size", [8, 10])
@pytest.mark.parametrize("further", [{}, {"friction_offset": "surface"}])
def test_a_disc_given_by_its_modes_has_one_line_beside_a_bar(
    size: int, further: dict[str, str]
) -> None:
    """The title of a column-wide map had four lines, two or three of which were of the disc."""
    disc = dm.Disc.from_csv("config/discs/brake_3_modes.csv")
    pad = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "mu_s": 0.45, "mu_k": 0.35}
    case = dm.Parameters(N=8000, Omega=80, disc=disc, **pad, **further)
    with pyplot.rc_context({"font.size": size}):
        _, ax = pyplot.subplots(figsize=(COLUMN, 70 / INCH), layout="constrained")
        as_map(rates(case), "growth_rate", ax=ax, title=True)
    lines = ax.get_title(loc="left").split("\n")
    assert len(lines) <= 3
    assert "3 modes" in lines[0]
    assert lines[0].endswith(",")
    pyplot.close("all")
