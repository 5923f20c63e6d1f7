"""Sweeps up and down along another number than the speed."""

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.swept_speeds import swept_speeds
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=14)
STAYS = {"dwell": 10, "max_dwell": 40, "evaluation_time": 1, "tol": 1e-8}


@pytest.fixture(scope="module")
def sweep() -> xr.Dataset:
    return dm.hysteresis(CASE, ("0.3 kN", "420 N"), name="N", step="40 N", **STAYS)


@pytest.mark.compiled
def test_a_sweep_of_the_preload_goes_on_from_load_to_load(sweep: xr.Dataset) -> None:
    """Only the speed could be swept."""
    assert sweep["sweep_N"].values.tolist() == [300, 340, 380, 420]
    assert sweep["sweep_N"].attrs["parameter"] == "N"
    assert sweep["sweep_N"].attrs["units"] == "N"
    rates = sweep["separation_rate"]
    assert rates.sel(direction="up").values[0] == 0
    assert (rates.sel(direction="down").values[:3] > 100).all()
    assert np.isnan(sweep["offset"].item())
    assert sweep["onset"].units == "N"
    assert "still lost on the way down at the lower bound, N = 300 N" in sweep.message
    assert not any(
        "speed" in sweep[name].long_name for name in ("range", "stay", "onset", "offset")
    )


@pytest.mark.compiled
def test_a_picture_names_the_number_that_is_swept(sweep: xr.Dataset) -> None:
    ax = dm.plot_sweep(sweep, "range")
    assert ax.get_xlabel() == "Preload N (N)"
    assert ax.get_ylabel() == "Range of the slider's height (mm)"
    pyplot.close("all")


@pytest.mark.compiled
def test_sweeps_of_such_sweeps_say_where_contact_is_still_lost() -> None:
    swept = dm.sweep(
        dm.hysteresis, CASE, (300, 420), name="N", step=60, Omega=[13.0, 14.0], **STAYS
    )
    assert "N" not in swept.attrs["base"].partition("Omega")[0].replace("D_star", "")
    assert swept_speeds(swept).end_at_bound.values.tolist() == [True, True]
    with refusal("N: must not be swept, because hysteresis searches along it"):
        dm.sweep(dm.hysteresis, CASE, (300, 420), name="N", step=60, N=[300, 400], **STAYS)


def test_a_sweep_of_the_speed_is_as_before() -> None:
    by_name = dm.hysteresis(CASE, (13, 14), name="Omega", **STAYS)
    assert by_name.identical(dm.hysteresis(CASE, (13, 14), **STAYS))
    assert {"onset_speed", "offset_speed", "sweep_Omega"} <= {*by_name.variables}


@pytest.mark.parametrize(
    ("name", "bounds", "step", "rule"),
    [
        ("h", ("1.9 mm", "2.1 mm"), "0.1 mm", "name='h': must be a number that does not change"),
        ("Nn", (300, 420), 60, "name='Nn': must be a number of the case, did you mean N"),
        ("N", (300, "420 s"), 60, "bounds='420 s': must be a number in N"),
        ("N", 300, 60, "bounds=300: must be the lowest and the highest value"),
        ("mu_k", (0.2, 0.5), 0.1, "mu_k=0.5: must be <= mu_s=0.4"),
        ("N", (300, 420), 50, r"bounds=.*: highest - lowest must be a multiple of step=50"),
    ],
)
def test_what_cannot_be_swept_is_said(name: str, bounds: object, step: object, rule: str) -> None:
    with refusal(rule):
        dm.hysteresis(CASE, bounds, name=name, step=step, **STAYS)


@pytest.mark.compiled
def test_both_edges_of_a_number_have_its_unit() -> None:
    case = CASE.replace(mu_k=0.2)
    options = {"name": "mu_s", "step": 0.06, **STAYS}
    swept = dm.sweep(dm.hysteresis, case, (0.3, 0.42), Omega=[14.0, 15.0], **options)
    assert swept["onset"].attrs["units"] == swept["offset"].attrs["units"] == "1"
