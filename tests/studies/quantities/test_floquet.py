"""Cycles near the static start, and whether the motion is near them."""

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.variables import CycleStatus
from disc_model.figures.classes import FILLED_MARK, NOT_NEAR
from tests.figures.reading import draw, labels
from tests.studies.conftest import computed

LOADS = [370, 375]
SPEEDS = [7.3, 7.35, 7.4]


@pytest.fixture(scope="module")
def study() -> xr.Dataset:
    """A cycle of 375 N that the motion is not near, among others."""
    axes = {"N": LOADS, "Omega": SPEEDS}
    return computed(quantity="floquet", options={}, base={}, axes=axes)


@pytest.mark.compiled
def test_a_study_says_as_a_sweep_where_the_motion_is_not_near_a_cycle(study: xr.Dataset) -> None:
    """Studies had growth rates of such cycles alone."""
    case = dm.Parameters(N=375, Omega=7.35)
    swept = dm.sweep(dm.floquet, case, N=LOADS, Omega=SPEEDS)
    assert (study["near_motion"] == 0).values.tolist() == [3 * [False], [False, True, False]]
    for name in ("near_motion", "growth_rate", "other_growth_rate"):
        np.testing.assert_allclose(study[name].values, swept[name].transpose("N", "Omega").values)
        units = study[name].attrs["units"]
        assert units == swept[name].attrs["units"]
        assert study[name].attrs["long_name"].startswith(swept[name].attrs["long_name"][:40])


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


@pytest.mark.compiled
@pytest.mark.parametrize("variable", ["growth_rate", "period", "stick_fraction", "multiplier_re"])
@pytest.mark.parametrize("width", ["column", "page"])
def test_figures_of_a_study_mark_such_points(study: xr.Dataset, variable: str, width: str) -> None:
    """They looked like any other."""
    wishes = {"variable": variable, "x": "Omega", "width": width}
    assert NOT_NEAR.label in labels(draw("heat_map", study, y="N", **wishes))
    assert FILLED_MARK.format(NOT_NEAR.label) in labels(draw("curve", study, **wishes))
    without = study.sel(N=[370])
    assert NOT_NEAR.label not in " ".join(labels(draw("curve", without, **wishes)))
    pyplot.close("all")
