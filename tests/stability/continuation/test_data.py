"""A branch as a dataset."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

import disc_model as dm
from disc_model.simulation.states import MODAL
from disc_model.stability.continuation import Branch
from tests.blocks import RIG
from tests.refusals import refusal

pytestmark = pytest.mark.compiled

WORDS = ("kind", "label", "phase")
"""Variables of words, which have no unit."""
OF_BOTH = ("growth_rate", "period", "stick_fraction", "range", "u_min", "u_max")
"""Variables of cycles and of special points."""
OF_CYCLES = (*OF_BOTH, "separations", "diameters")
OF_POINTS = (*OF_BOTH, "kind", "label", "after", "changes_stability")


@pytest.fixture(scope="module")
def branch() -> Branch:
    """From 14.8 rad/s round the fold at 15.09 and back."""
    case = dm.Parameters(N=385, Omega=14.9)
    bounds = (14.8, 15.2)
    return dm.continue_cycle(case, "Omega", bounds, values=[15.0, 15.15])


@pytest.fixture(scope="module")
def data(branch: Branch) -> xr.Dataset:
    return branch.to_dataset()


def test_a_dataset_has_what_the_branch_has(branch: Branch, data: xr.Dataset) -> None:
    for name in OF_CYCLES:
        known = getattr(branch, name)
        assert_array_equal(data[name], known)
    assert_array_equal(data["multipliers_real"], branch.multipliers.real)
    assert_array_equal(data["multipliers_imag"], branch.multipliers.imag)
    speeds = branch.values[:, 0]
    assert_array_equal(data["Omega"], speeds)
    assert data.ended == branch.ended
    assert data.not_reached == "15.15"


def test_stability_is_that_of_the_largest_multiplier(branch: Branch, data: xr.Dataset) -> None:
    """The branch is stable up to its fold, in the order of its points."""
    largest = data["largest_multiplier"]
    stable = data["stable"]
    [_, fold, _] = branch.special
    before = data["point"] <= fold.after
    assert_array_equal(stable, before)
    assert_array_equal(stable, branch.stable)
    assert_array_equal(stable, largest < 1)
    growth = np.log(largest) / data["period"]
    assert_allclose(
        growth,
        data["growth_rate"],
        rtol=0,
        atol=1e-9,  # 1/s, rounding of the multiplier over the period
    )


def test_special_points_are_a_dimension_of_their_own(branch: Branch, data: xr.Dataset) -> None:
    kinds = data["special_kind"]
    assert [*kinds.values] == ["end", "fold", "end"]
    for i, special in enumerate(branch.special):
        row = data.isel(special=i)
        for name in OF_POINTS:
            known = getattr(special, name)
            assert row[f"special_{name}"] == known
        assert row["special_Omega"] == special.values[0]
        assert row["special_u"] == special.state.u
        assert row["special_multiplier_real"] == special.multiplier.real
        assert_array_equal(row["special_alpha"], special.state.alpha)


def test_every_number_has_a_unit_and_everything_a_name(data: xr.Dataset) -> None:
    for name in data.data_vars:
        attrs = data[name].attrs
        assert attrs["long_name"]
        bare = str(name).removeprefix("special_")
        expected = bare not in WORDS
        assert ("units" in attrs) == expected
    for name in ("Omega", "special_Omega"):
        attrs = data[name].attrs
        assert attrs["units"] == "rad s-1"


def test_a_dataset_of_a_branch_comes_back_from_a_file(data: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "branch.nc"
    dm.save(data, path)
    stored = dm.load(path)
    assert stored.identical(data)


def test_a_branch_itself_is_saved_as_its_dataset(branch: Branch, tmp_path: Path) -> None:
    path = tmp_path / "branch.nc"
    dm.save(branch, path)
    assert dm.load(path).identical(branch.to_dataset())


def test_a_table_of_pandas_has_the_parameter_beside_the_values(data: xr.Dataset) -> None:
    names = ["growth_rate", "stable"]
    table = data[names].to_dataframe()
    assert {*table.columns} == {"Omega", *names}
    assert_array_equal(table["Omega"], data["Omega"])


def test_a_cycle_is_simulated_from_its_row(branch: Branch, data: xr.Dataset) -> None:
    """An unstable one, of growth rate 0.5/s, repeats after a period."""
    row = data.isel(point=-1)
    assert not row["stable"]
    state = {}
    for name in ("psi", "f", "u", "u_velocity"):
        state[name] = float(row[name])
    for name in MODAL:
        state[name] = row[name].values
    start = dm.State(
        time=0.0, phase=str(row["phase"].values), direction=int(row["direction"]), **state
    )
    speed = float(row["Omega"])
    run = dm.simulate(branch.case.replace(Omega=speed), float(row["period"]), initial_state=start)
    end = run.final_state
    size = np.abs(start.a).max()
    assert_allclose(
        end.a,
        start.a,
        rtol=0,
        atol=2e-7 * size,  # as `Branch.state` promises: 1e-7, times the leading multiplier
    )


def test_a_rigid_disc_has_no_modes() -> None:
    bounds = (1.9, 2.1)
    branch = dm.continue_cycle(RIG, "Omega", bounds)
    sizes = branch.to_dataset().sizes
    assert sizes["mode"] == 0


@pytest.mark.parametrize(
    ("name", "bounds", "units", "meaning"),
    [
        ("omega_1_0", (1510, 1520), "rad s-1", "natural frequency"),
        ("damping_ratio_1_0", (9e-4, 1.1e-3), "1", "damping ratio"),
    ],
)
def test_a_number_of_a_mode_of_a_given_disc_is_a_parameter_too(
    name: str, bounds: tuple[float, float], units: str, meaning: str
) -> None:
    """It is no field of `Parameters`, and had no unit, nor a meaning but its name."""
    disc = dm.Disc(
        diameters=[0, 1], omega=[1490, 1515], amplitude=[1.53, 2.16], damping_ratio=[1e-3, 1e-3]
    )
    case = dm.Parameters(N=385, Omega=10, disc=disc, r_0=0.1)
    data = dm.continue_cycle(case, name, bounds).to_dataset()
    along = data[name]
    said = f"{meaning} of the mode (1, 0)"
    assert (along.units, along.long_name) == (units, said)
    assert data[f"special_{name}"].units == units
    assert along.min() == bounds[0]
    assert along.max() == bounds[1]


def slipping_branch() -> Branch:
    return dm.continue_cycle(RIG, "Omega", (1.8, 2.2), kind="slipping")


@pytest.mark.parametrize("kind", ["stick_slip", "slipping"])
def test_a_stored_branch_is_a_branch_again(kind: str, branch: Branch, tmp_path: Path) -> None:
    """It could only be drawn point by point, and started again from a state put together by hand."""
    if kind == "slipping":
        branch = slipping_branch()
    dm.save(branch.to_dataset(), tmp_path / "branch.nc")
    again = dm.Branch.from_dataset(dm.load(tmp_path / "branch.nc"))
    assert repr(again) == repr(branch)
    assert_array_equal(again.folds, branch.folds)
    assert_array_equal(again.refined_growth_rate(), branch.refined_growth_rate())
    shown = ["kind", "label", "growth_rate", "period", "multiplier", "after"]
    assert again.special_points[shown].equals(branch.special_points[shown])
    assert_allclose(again.points, branch.points, rtol=1e-15, atol=0)  # a product and its quotient
    assert again.to_dataset().equals(branch.to_dataset())
    heights = [line.get_ydata() for line in again.plot("range").lines]
    for line, height in zip(branch.plot("range").lines, heights, strict=True):
        assert_array_equal(line.get_ydata(), height)


def test_a_stored_branch_goes_on_from_one_of_its_unstable_cycles(data: xr.Dataset) -> None:
    again = dm.Branch.from_dataset(data)
    onward = dm.continue_cycle(again.case_at(-1), "Omega", (14.6, 14.9), guess=again.state(-1))
    start = onward.values[:, 0] == 14.8
    # of floquet's search from there
    assert_allclose(onward.growth_rate[start], again.growth_rate[-1], rtol=1e-7)


def test_another_dataset_is_no_branch(data: xr.Dataset) -> None:
    for other in (data.drop_vars("special_a"), data.drop_attrs(), "branch.nc"):
        with refusal(r"must be a dataset of Branch\.to_dataset"):
            dm.Branch.from_dataset(other)


def test_a_stored_branch_is_drawn_over_its_parameter_without_lines(data: xr.Dataset) -> None:
    """Its points follow the branch, and turn at folds: `Branch.plot` joins them."""
    axes = dm.plot_sweep(data, "growth_rate", x="Omega")
    (points,) = (line for line in axes.lines if line.get_marker() == "o")
    drawn = np.asarray(points.get_xdata(), dtype=float)
    assert_array_equal(drawn[np.isfinite(drawn)], np.sort(data["Omega"]))
    assert points.get_linestyle() == "None"


def test_the_points_of_a_branch_are_a_table(data: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "branch.csv"
    dm.save(data.drop_dims(["special", "mode", "multiplier"]), path)
    table = pd.read_csv(path)
    assert_array_equal(table["point"], data["point"])
    assert_array_equal(table["range (m)"], data["range"])
    assert_array_equal(table["stable"], data["stable"])
