"""Tests of the legends of branches: of those that are unstable throughout, and of points without one."""

from typing import Any

import pytest
import xarray as xr

import disc_model as dm
from disc_model.figures.types import Axes

CASE = dm.Parameters(N=385, Omega=12)


@pytest.fixture(scope="module")
def swept() -> xr.Dataset:
    """Branches at three loads: one is unstable throughout, one point has none."""
    options = {"name": "Omega", "bounds": (11.5, 13)}
    return dm.sweep(dm.continue_cycle, CASE, N=[200, 300, 385], **options)


def drawn(swept: xr.Dataset, variable: str, **options: Any) -> Axes:
    """The branches of a sweep, of which one point has none."""
    with pytest.warns(UserWarning, match=r"^no branch at N = 300 N: swept.* says why$"):
        return dm.plot_branches(swept, variable, **options)


def said(ax: Axes) -> list[str]:
    """The words of the legend of a figure."""
    [legend] = ax.figure.legends
    return [text.get_text() for text in legend.get_texts()]


def test_a_point_without_a_branch_is_in_the_legend(swept: xr.Dataset) -> None:
    """Only a warning named it, which a saved figure does not show."""
    words = said(drawn(swept, "period"))
    assert words[:2] == ["N = 200 N", "N = 385 N"]
    assert words[-1] == "N = 300 N: no branch"
