"""Cycles near the static start, and whether the motion is near them."""

import pytest
import xarray as xr

import disc_model as dm
from disc_model.data.variables import CycleStatus
from tests.studies.conftest import computed

LOADS = [370, 375]
SPEEDS = [7.3, 7.35, 7.4]


@pytest.fixture(scope="module")
def study() -> xr.Dataset:
    """A cycle of 375 N that the motion is not near, among others."""
    axes = {"N": LOADS, "Omega": SPEEDS}
    return computed(quantity="floquet", options={}, base={}, axes=axes)


@pytest.mark.compiled
def test_a_study_and_a_sweep_say_nothing_of_points_that_are_good(study: xr.Dataset) -> None:
    """A sweep said "ok: cycle of ..." at each point, and a study nothing."""
    swept = dm.sweep(dm.floquet, dm.Parameters(N=375, Omega=7.35), N=LOADS, Omega=SPEEDS)
    assert set(swept["message"].values.flat) == {""}
    assert set(study["message"].values.flat) == {""}
    sliding = dm.sweep(dm.steady_sliding, dm.Parameters(N=375, Omega=7.35), Omega=SPEEDS)
    assert set(sliding["message"].values.flat) == {""}
    runs = dm.sweep(dm.simulate, dm.Parameters(N=375, Omega=7.35), t_end=1.0, N=[1.0])
    assert set(runs["message"].values.flat) == {""}


@pytest.mark.compiled
def test_a_study_and_a_sweep_say_what_was_found_and_then_what_to_do() -> None:
    """A sweep gave no advice, and a study nothing but advice."""
    swept = dm.sweep(dm.floquet, dm.Parameters(N=375, Omega=7.35), Omega=[0.0, 7.3], N=[385, 2e4])
    grid = {"study": "mine", "quantity": "floquet", "axes": {"Omega": [0.0, 7.3], "N": [385, 2e4]}}
    study = dm.run_study(grid)
    said = study["message"].transpose("Omega", "N")
    assert said.values.tolist() == swept["message"].values.tolist()
    found = "at_rest: the slider stays where it is on the disc"
    assert swept["message"].values[0, 0] == f"{found}. {CycleStatus.AT_REST.advice}"
    without = str(swept["message"].sel(Omega=7.3, N=2e4).item())
    assert without.startswith("no_cycle: no cycle of up to 3 releases was found")
    assert without.endswith(CycleStatus.NO_CYCLE.advice)
    assert without.count("state of a") == 1
