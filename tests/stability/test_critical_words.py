"""What critical values say of themselves: units, which motion is unstable; and their dataset."""

from pathlib import Path

import numpy as np
import pytest

import disc_model as dm
from disc_model.data.variables import value_with_unit
from disc_model.stability.critical_values import Critical

CASE = dm.Parameters(N=385, Omega=12)


@pytest.fixture(scope="module")
def damped() -> Critical:
    """Of a slider whose in-plane damper ends the cycle: steady sliding takes its place, and grows."""
    return dm.critical(dm.Parameters(N=385, Omega=16), "c_p", (0, "120 N s/m"), points=7)


@pytest.fixture(scope="module")
def found() -> Critical:
    return dm.critical(dm.Parameters(N=385, Omega=12), "Omega", (14, 16), points=5)


def test_values_have_units(found: Critical) -> None:
    assert "unstable from 15.0949 rad/s" in repr(found)
    assert repr(found).endswith(" rad/s)")


def test_a_branch_has_units() -> None:
    branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    assert "Omega from 14.8 to 15.0949 rad/s" in repr(branch)


def test_the_frequency_of_a_mode_has_its_unit() -> None:
    assert value_with_unit("omega_1_0", 3141.59) == "omega_1_0 = 3141.59 rad/s"
    assert value_with_unit("damping_ratio_1_0", 0.01) == "damping_ratio_1_0 = 0.01"


def test_message_says_that_steady_sliding_is_unstable(damped: Critical) -> None:
    said = "no cycle exists, and steady sliding is unstable"
    assert said in damped.message
    assert said in repr(damped)


def test_growth_rate_of_sliding_is_that_of_steady_sliding(damped: Critical) -> None:
    place = damped.values.tolist().index(40.0)
    sliding = dm.steady_sliding(dm.Parameters(N=385, Omega=16, c_p=40.0))
    assert damped.sliding_growth_rate[place] == sliding.growth_rate
    assert np.isnan(damped.growth_rate[place])
    assert np.isnan(damped.sliding_growth_rate[0])


def test_no_word_of_sliding_where_cycles_exist(found: Critical) -> None:
    assert found.message == ""


def test_critical_values_are_saved(found: Critical, tmp_path: Path) -> None:
    path = tmp_path / "critical.nc"
    dm.save(found, path)
    data = dm.load(path)
    assert data.identical(found.to_dataset())
    assert data["growth_rate"].dims == ("Omega",)
    assert data["Omega"].attrs["units"] == "rad s-1"
    assert data["value"].attrs["units"] == "rad s-1"
    assert float(data["value"]) == found.value
    assert data["crossings"].values.tolist() == found.crossings.tolist()


def test_critical_values_of_a_mode_are_saved(tmp_path: Path) -> None:
    disc = dm.Disc(diameters=[2], omega=[3000], amplitude=[1.0])
    case = dm.Parameters(N=385, Omega=12, disc=disc, r_0=0.1)
    found = dm.critical(case, "omega_2_0", (2900, 3100), points=2, kind="sliding")
    dm.save(found, tmp_path / "mode.nc")
    data = dm.load(tmp_path / "mode.nc")
    swept = dm.sweep(
        dm.critical, case, "omega_2_0", (2900, 3100), N=[385], points=2, kind="sliding"
    )
    meaning = "natural frequency of the mode (2, 0)"
    for units in (data["omega_2_0"].units, data["value"].units, swept["value"].units):
        assert units == "rad s-1"
    assert data["omega_2_0"].long_name == meaning
    assert data["omega_2_0"].comment == "2 nodal diameters and 0 circles"
    assert meaning in swept["border"].comment
    assert meaning in data["border"].comment


def test_a_sweep_of_critical_values_keeps_its_variables() -> None:
    swept = dm.sweep(dm.critical, CASE, "mu_s", over={"bounds": [(0.3, 0.32)]}, points=2)
    assert "crossings" in swept
    assert "sliding_growth_rate" not in swept
