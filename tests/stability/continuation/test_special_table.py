"""The printed table of special points."""

import csv
from pathlib import Path

import numpy as np
import pytest

import disc_model as dm


@pytest.fixture(scope="module")
def branch() -> dm.Branch:
    """From 14.8 rad/s round the fold at 15.09 and back."""
    return dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))


def test_the_table_has_the_extremes_of_the_height(branch: dm.Branch) -> None:
    """It had no measure of the motion beside its period."""
    table = branch.special_points
    [first, fold, _] = branch.special
    run = dm.simulate(
        fold.case, fold.period, {"cycle": dm.Window(rate=1e6)}, initial_state=fold.state
    )
    height = run["cycle"]["u"] - run.u_0
    assert table["u_max"][1] == pytest.approx(height.values.max(), rel=1e-4)
    assert table["u_min"][1] == pytest.approx(height.values.min(), rel=1e-4)
    np.testing.assert_array_equal(table["range"], table["u_max"] - table["u_min"])
    assert table["range"][0] == branch.range[0] == pytest.approx(first.range)


def test_a_file_of_the_table_has_units(branch: dm.Branch, tmp_path: Path) -> None:
    path = tmp_path / "special.csv"
    branch.special_points.to_csv(path, index=False)
    with open(path, encoding="utf-8", newline="") as file:
        heads = next(csv.reader(file))
    known = ["Omega (rad s-1)", "growth_rate (s-1)", "period (s)", "stick_fraction", "range (m)"]
    assert heads[2:7] == known
    assert branch.special_points.attrs["units"]["u_max"] == "m"


@pytest.mark.parametrize("name", ["u_min", "u_max"])
def test_extremes_of_the_height_are_drawn(branch: dm.Branch, name: str) -> None:
    axes = branch.plot(name)
    assert axes.get_ylabel().endswith("(mm)")
    heights = np.concatenate([line.get_ydata() for line in axes.lines])
    assert np.nanmax(heights) == pytest.approx(1e3 * getattr(branch, name).max())


def test_a_terminal_shows_all_columns(branch: dm.Branch) -> None:
    """The speed was left out of lines of 80 characters."""
    printed = str(branch.special_points)
    assert max(map(len, printed.splitlines())) <= 80
    assert {*branch.special_points} <= {*printed.split()}
