"""The measured points as a table, and in a few words."""

import math

import pandas as pd
import pytest
import xarray as xr

from disc_model.benchmarks import table
from disc_model.benchmarks.scenes import Verdict
from disc_model.benchmarks.table import cost_at, headline, measured_points


def test_the_table_compares_at_equal_error(dataset: xr.Dataset) -> None:
    frame = table.table(dataset)
    row = frame[(frame["scene"] == "stick_slip") & (frame["setting"] == "step=0.0001")].iloc[0]
    # 1e8 h^4 = 1e-8 s: half the tolerance is the series' error, so that it reaches that at 1e-8
    assert row["event_time_error"] == pytest.approx(1e-8, rel=1e-6)
    assert row["times_series"] == pytest.approx((1e-5 / 1e-4) / (1e-3 + 8e-5), rel=0.03)
    coarse = frame[(frame["scene"] == "stick_slip") & (frame["setting"] == "step=0.0004")].iloc[0]
    assert coarse["times_series"] == pytest.approx((1e-5 / 4e-4) / (1e-3 + 6e-5), rel=1e-6)
    assert math.isnan(frame[frame["method"] == "Radau"]["times_series"].iloc[0])
    assert row["verdict"] == "converged"
    # at its default the series takes 1 ms a further second; RK4 is right to 1e-10 s between two of its
    # steps, at 3.16e-5 s, which takes 0.316 s
    step = (1e-10 / 1e8) ** 0.25
    expected = {"series": 1.0, "RK4": pytest.approx(1e-5 / step / 1e-3, rel=1e-3)}
    assert headline(measured_points(dataset)) == {"stick_slip": expected}
    without = table.table(dataset.sel(solver=["RK4"]))
    assert without["times_series"].isna().all()


def line(*points: tuple[float, float]) -> pd.DataFrame:
    """Errors and costs."""
    return pd.DataFrame(points, columns=["event_error", "further"])


def test_a_cost_at_an_error_is_between_settings() -> None:
    coarse, fine = (1e-9, 2.0), (1e-11, 8.0)
    for points in ((coarse, fine), (fine, (math.nan, 0.1), (1e-8, 3.0), coarse)):  # dearer and worse does not count
        assert cost_at(line(*points), 1e-10) == pytest.approx(4.0)
    assert cost_at(line(fine), 1e-10) == pytest.approx(8.0)  # nothing coarser was measured
    assert math.isnan(cost_at(line(coarse), 1e-10))  # no setting is as accurate
    assert cost_at(line((0.0, 5.0)), 0.0) == pytest.approx(5.0)


def test_headline_compares_the_default_with_others_at_the_same_error() -> None:
    """Of RK4 only whole runs were measured; of the series also a further second, which is what counts.

    Where the series engine's own error is larger than 1e-10 s, others are allowed as much.
    """
    rows = [
        ("series", 0, 1e-6, 2e-3, 1.9e-3, 1e-7),
        ("series", 1, 1e-10, 5e-4, 4e-4, 2e-12),
        ("RK4", 0, 1e-4, 1e-3, math.nan, 1e-5),
        ("RK4", 1, 1e-5, 4e-3, math.nan, 1e-10),
        ("RK4", 2, 1e-6, 4e-2, math.nan, 1e-13),
    ]
    frame = pd.DataFrame(rows, columns=["solver", "point", "value", "cost", "marginal_cost", "event_error"])
    frame = frame.assign(scene="stick_slip", verdict=int(Verdict.CONVERGED))
    for own, ratio in ((2e-12, 10.0), (1e-5, 2.5)):
        frame.loc[1, "event_error"] = own
        made = frame.set_index(["scene", "solver", "point"]).to_xarray()
        assert headline(measured_points(made)) == {"stick_slip": {"series": 1.0, "RK4": pytest.approx(ratio)}}
