"""Speed against accuracy: what is measured, how often, and what is made of it."""

import json
import logging
import math

import numpy as np
import pytest
import xarray as xr

from disc_model.benchmarks import work_precision
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


def test_every_point_is_reported_and_slow_ones_are_not_repeated(
    known: dict[str, Known], caplog: pytest.LogCaptureFixture
) -> None:
    known["RK4"].cost = lambda h: 5.0
    caplog.set_level(logging.INFO, work_precision.log.name)
    work_precision.work_precision({"stick_slip": SETTINGS["stick_slip"]}, rounds=3)
    assert "stick_slip RK4 0.0004: 5 s" in caplog.messages
    seen = [message.split()[1] for message in caplog.messages]
    assert seen.count("RK4") == 4
    assert seen.count("series") == 9


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
