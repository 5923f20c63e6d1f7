"""Speed against accuracy: what is measured, how often, and what is made of it."""

import json
import math

import numpy as np
import pytest
import xarray as xr

from disc_model.benchmarks import work_precision
from disc_model.data.dataset import load, save
from disc_model.data.variables import flag_names
from tests.benchmarks.conftest import SET_UP, SETTINGS, Known


def test_the_dataset_holds_what_the_methods_did(dataset: xr.Dataset, known: dict[str, Known]) -> None:
    rk4 = dataset.sel(scene="stick_slip", solver="RK4")
    assert rk4["order_event"] == pytest.approx(4.0, abs=1e-3)
    assert rk4["order_theory"] == 4.0
    np.testing.assert_allclose(rk4["event_error"], [1e8 * h**4 for h in SETTINGS["stick_slip"]["RK4"]], rtol=1e-5)
    assert flag_names(rk4["verdict"]).tolist() == ["inaccurate", "converged", "converged", "converged"]
    series = dataset.sel(scene="stick_slip", solver="series")
    assert series["order_event"] == pytest.approx(1.0, abs=1e-3)  # exponent of the tolerance
    assert flag_names(series["verdict"])[3] == "not_run"
    assert (series["repeats"][:3] == 2).all()
    assert series["cost"][0] == pytest.approx(1e-3 + 6e-5)
    assert series["marginal_cost"][0] == pytest.approx(1e-3 + 6e-5 - SET_UP)
    np.testing.assert_allclose(rk4["glue"], 0.25)
    assert np.isnan(series["glue"]).all()
    # too long to be followed further
    assert np.isnan(rk4["marginal_cost"][3])
    assert flag_names(dataset.sel(scene="stick_slip", solver="Radau")["verdict"])[0] == "wrong_events"
    assert json.loads(dataset.attrs["versions"])["heyoka"]
    # what gives up at a coarse setting is not tried at a finer one
    assert known["regularised"].tried == [1.0]
    assert flag_names(dataset.sel(scene="separating", solver="regularised")["verdict"])[:2].tolist() == [
        "gave_up",
        "not_run",
    ]


def test_every_point_is_reported_and_slow_ones_are_not_repeated(known: dict[str, Known]) -> None:
    known["RK4"].cost = lambda h: 5.0
    seen = []
    work_precision.work_precision(
        {"stick_slip": SETTINGS["stick_slip"]}, rounds=3, progress=lambda point, seconds: seen.append(point.method)
    )
    assert seen.count("RK4") == 4
    assert seen.count("series") == 9


QUICK = {"stick_slip": {"series": (1e-6, 1e-8, 1e-10), "RK4": (7e-4, 2e-4, 1e-4, 5e-5)}, "separating": {"RK4": (4e-4,)}}


@pytest.mark.compiled
def test_real_methods_are_measured_and_stored(tmp_path):
    dataset = work_precision.work_precision(QUICK, rounds=2)
    words = dataset["verdict"].attrs["flag_meanings"].split()
    rk4 = dataset.sel(scene="stick_slip", solver="RK4")
    assert [words[i] for i in rk4["verdict"].values] == ["unstable", "inaccurate", "converged", "converged"]
    assert float(rk4["order_event"]) == pytest.approx(4.0, abs=0.3)
    assert float(rk4["order_theory"]) == 4.0
    series = dataset.sel(scene="stick_slip", solver="series")
    assert float(series["order_state"]) == pytest.approx(1.0, abs=0.5)  # exponent of the tolerance
    assert (series["separations"].values[:3] == 0).all()
    assert [words[i] for i in dataset.sel(scene="separating", solver="RK4")["verdict"].values[:2]] == [
        "wrong_events",
        "not_run",
    ]
    assert dataset.attrs["machine"]
    assert "heyoka" in json.loads(dataset.attrs["versions"])
    assert json.loads(dataset.attrs["scene_separating"])["separations"] == 131
    save(xr.DataTree(dataset), tmp_path / "bench.nc")
    back = load(tmp_path / "bench.nc").to_dataset()
    np.testing.assert_array_equal(back["verdict"], dataset["verdict"])
    assert list(back["solver"].values) == list(dataset["solver"].values)


def test_fitted_order():
    n = np.geomspace(10, 1e4, 7)
    assert work_precision.fitted_order(n, 3.0 * n**-4) == pytest.approx(4.0)
    with_floor = np.maximum(3.0 * n**-4, 1e-14)
    assert work_precision.fitted_order(n, with_floor) == pytest.approx(4.0)
    rough = 3.0 * n**-4
    rough[:2] = 1e-4  # not yet asymptotic
    assert work_precision.fitted_order(n, rough) == pytest.approx(4.0, abs=0.05)
    assert math.isnan(work_precision.fitted_order(n[:1], n[:1]))
    assert math.isnan(work_precision.fitted_order(n, np.full(7, np.nan)))
