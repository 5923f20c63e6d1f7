"""Tests of the legends of branches: of those that are unstable throughout, and of points without one."""

from typing import Any

import pytest
import xarray as xr
from matplotlib import pyplot

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


def test_it_is_the_last_entry_below_narrow_axes_too(swept: xr.Dataset) -> None:
    _, ax = pyplot.subplots(figsize=(3.31, 3.2), layout="constrained")
    drawn(swept, "growth_rate", ax=ax)
    assert ax.get_legend().get_texts()[-1].get_text() == "N = 300 N: no branch"


def test_it_stays_in_the_legend_beside_further_branches(swept: xr.Dataset) -> None:
    ax = drawn(swept.sel(N=[200, 300]), "period")
    dm.plot_branches(swept.sel(N=[385]), "period", ax=ax)
    assert "N = 300 N: no branch" in said(ax)


def test_a_legend_of_the_reader_has_it_too(swept: xr.Dataset) -> None:
    ax = drawn(swept, "period", legend=False)
    assert "N = 300 N: no branch" in ax.get_legend_handles_labels()[1]


@pytest.mark.parametrize("variable", ["period", "growth_rate"])
def test_a_branch_that_is_unstable_throughout_looks_so_in_the_legend(
    swept: xr.Dataset, variable: str
) -> None:
    """A thick line named it, and "unstable" was a thin one without the dots of the panel."""
    ax = dm.Branch.from_dataset(swept.sel(N=200)).plot(variable)
    [entry] = ax.figure.legends[0].get_lines()
    line, dots = [each for each in ax.lines if len(each.get_xdata()) > 2][:2]
    assert entry.get_color() == line.get_color()
    assert entry.get_linewidth() == line.get_linewidth()
    assert entry.get_marker() == dots.get_marker()


def test_the_name_of_such_a_branch_has_a_thin_line(swept: xr.Dataset) -> None:
    ax = drawn(swept, "growth_rate")
    unstable, stable = ax.figure.legends[0].get_lines()[:2]
    assert unstable.get_linewidth() <= 0.5 * stable.get_linewidth()
