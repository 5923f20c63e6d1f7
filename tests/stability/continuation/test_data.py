"""A branch as a dataset."""

import functools
from pathlib import Path

import numpy as np
import pytest

import disc_model as dm
from disc_model.simulation.states import MODAL
from disc_model.stability.continuation import Branch

pytestmark = pytest.mark.compiled

WITHOUT_UNIT = {"kind", "label", "phase"}  # words
WITHOUT_UNIT |= {f"special_{name}" for name in WITHOUT_UNIT} | {"point", "special"}


@functools.cache
def branch() -> Branch:
    """From 14.8 rad/s round the fold at 15.09 and back."""
    case = dm.Parameters(N=385, Omega=14.9)
    return dm.continue_cycle(case, "Omega", (14.8, 15.2), values=[15.0, 15.15])


def test_a_dataset_has_what_the_branch_has() -> None:
    found = branch().to_dataset()
    same = {"Omega": branch().values[:, 0], "multipliers": branch().multipliers}
    for name in ("growth_rate", "period", "stick_fraction", "range", "separations", "diameters"):
        same[name] = getattr(branch(), name)
    for name, values in same.items():
        np.testing.assert_array_equal(found[name], values)
    exponents = np.log(found["largest_multiplier"]) / found["period"]
    np.testing.assert_allclose(exponents, found["growth_rate"], rtol=0, atol=1e-9)  # rounding
    stable = found["Omega"].values[found["stable"].values]
    assert stable.max() < branch().folds[0, 0]
    assert found["stable"].values.any()
    assert not found["stable"].values.all()
    assert found.attrs["ended"] == branch().ended
    assert found.attrs["not_reached"] == "15.15"


def test_special_points_are_a_dimension_of_their_own() -> None:
    found = branch().to_dataset()
    assert found["special_kind"].values.tolist() == ["end", "fold", "end"]
    assert found["special_label"].values.tolist() == ["EP", "LP", "EP"]
    assert found["special_changes_stability"].values.tolist() == [False, True, False]
    table = branch().special_points
    for name in ("Omega", "period", "growth_rate", "multiplier", "after"):
        np.testing.assert_array_equal(found[f"special_{name}"], table[name])
    np.testing.assert_array_equal(found["special_u"], [state.u for state in table["state"]])


def test_every_number_has_a_unit_and_everything_a_name() -> None:
    found = branch().to_dataset()
    for name, variable in found.variables.items():
        assert variable.attrs["long_name"], name
        assert ("units" in variable.attrs) == (name not in WITHOUT_UNIT), name
    assert found["Omega"].attrs["units"] == "rad s-1"


@pytest.mark.parametrize("suffix", [".nc", ".mat"])
def test_a_dataset_of_a_branch_comes_back_from_a_file(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"branch{suffix}"
    found = branch().to_dataset()
    dm.save(found, path)
    assert dm.load(path).identical(found)
    rule = "must be an xarray.Dataset or xarray.DataTree, such as its method to_dataset"
    with pytest.raises(dm.ParameterError, match=rule):
        dm.save(branch(), path)


def test_a_table_of_pandas_has_the_parameter_beside_the_values() -> None:
    table = branch().to_dataset()[["growth_rate", "stable"]].to_dataframe()
    assert sorted(table.columns) == ["Omega", "growth_rate", "stable"]
    assert len(table) == len(branch())


def test_a_cycle_is_simulated_from_its_row() -> None:
    """An unstable one, of growth rate 0.5/s, repeats within a period."""
    last = branch().to_dataset().isel(point=-1)
    numbers = {name: float(last[name]) for name in ("psi", "f", "u", "u_velocity")}
    modal = {name: last[name].values for name in MODAL}
    direction = int(last["direction"])
    phase = str(last["phase"].values)
    start = dm.State(time=0.0, phase=phase, direction=direction, **numbers, **modal)
    case = branch().case.replace(Omega=float(last["Omega"]))
    run = dm.simulate(case, float(last["period"]), initial_state=start)
    # the state is that of a cycle within 1e-7, times the leading multiplier
    assert run.final_state.u == pytest.approx(start.u, rel=2e-7)
    np.testing.assert_allclose(run.final_state.a, start.a, rtol=0, atol=2e-7 * abs(start.a).max())


def test_a_rigid_disc_has_no_modes() -> None:
    rigid = {"n_diameters": -1, "k": 0, "friction_decay": 10, "c_p": 5.946, "N": 10}
    block = dm.Parameters(m=0.538, k_p=6957, mu_s=0.6, mu_k=0.2, Omega=2, **rigid)
    assert dm.continue_cycle(block, "Omega", (1.9, 2.1)).to_dataset().sizes["mode"] == 0


def test_a_frequency_of_a_given_disc_is_a_parameter_too() -> None:
    """It is no field of `Parameters`, whose fields are described there."""
    damping = [1e-3, 1e-3]
    disc = dm.Disc(
        diameters=[0, 1], omega=[1490, 1515], amplitude=[1.53, 2.16], damping_ratio=damping
    )
    case = dm.Parameters(N=385, Omega=10, disc=disc, r_0=0.1)
    found = dm.continue_cycle(case, "omega_1_0", (1510, 1520)).to_dataset()
    assert found["omega_1_0"].attrs["long_name"] == "omega_1_0"
    assert found["omega_1_0"].values[[0, -1]] == pytest.approx([1510, 1520])
