"""The bookkeeping of the benchmark on methods whose errors and costs are laid down, and maps of a few milliseconds."""

from __future__ import annotations

import json
import math
import os

import numpy as np
import pytest
import xarray as xr

from disc_model.benchmarks import failure_maps, scenes, table, work_precision
from disc_model.benchmarks.methods import METHODS, Outcome
from disc_model.benchmarks.methods.base import Method, MethodResult
from disc_model.benchmarks.scenes import Verdict, answer
from disc_model.data.variables import flag_names
from disc_model.figures import benchmark as figures
from disc_model.figures.style import save


def available() -> set[int]:
    """Cores that this process may use."""
    return os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()


CORES = available()


class Known(Method):
    """A method whose error is ``error`` (value) seconds at every event, and which takes ``cost`` (value) seconds."""

    def __init__(self, like: str, error, cost, outcome=Outcome.FINISHED) -> None:
        own = METHODS[like]
        self.name, self.label, self.setting, self.order = own.name, own.label, own.setting, own.order
        self.error, self.cost, self.outcome = error, cost, outcome
        self.tried: list[float] = []

    def unavailable(self) -> str:
        return ""

    def _solve(self, problem, value, budget):
        self.tried.append(value)
        name = next(name for name in scenes.SCENES if scenes.problem(name) is problem)
        right, off = answer(name), self.error(value)
        kinds = right.kinds if off < 1e-2 else ("slip_reversal",) * len(right.kinds)
        times = (right.times[: len(kinds)] + off).astype(float)
        final = right.final.replace(psi=right.final.psi * (1 + off), f=right.final.f * (1 + off))
        work = round(1 / value) if self.setting == "step" else 1000
        return MethodResult(times, kinds, final, self.cost(value), work, self.outcome)


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> dict[str, Known]:
    methods = {
        "series": Known("series", lambda tol: 0.5 * tol, lambda tol: 1e-3 - 1e-5 * math.log10(tol)),
        "RK4": Known("RK4", lambda h: 1e8 * h**4, lambda h: 1e-5 / h),
        "Radau": Known("Radau", lambda tol: 1.0, lambda tol: 0.2),
        "regularised": Known("regularised", lambda e: 1e-4, lambda e: 100.0, Outcome.TOO_SLOW),
    }
    for name, method in methods.items():
        monkeypatch.setitem(METHODS, name, method)
    return methods


SETTINGS = {
    "stick_slip": {"series": (1e-6, 1e-8, 1e-10), "RK4": (4e-4, 2e-4, 1e-4, 2e-5), "Radau": (1e-3,)},
    "separating": {"series": (1e-6, 1e-8), "RK4": (2e-4,), "regularised": (1.0, 0.1)},
}


@pytest.fixture
def dataset(known: dict[str, Known]) -> xr.Dataset:
    return work_precision.work_precision(SETTINGS, rounds=2)


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
    assert flag_names(dataset.sel(scene="stick_slip", solver="Radau")["verdict"])[0] == "wrong_events"
    assert json.loads(dataset.attrs["versions"])["heyoka"]
    # what gives up at a coarse setting is not tried at a finer one
    assert known["regularised"].tried == [1.0]
    assert flag_names(dataset.sel(scene="separating", solver="regularised")["verdict"])[:2].tolist() == [
        "gave_up",
        "not_run",
    ]


def test_the_process_has_its_cores_back(dataset: xr.Dataset) -> None:
    """It stayed on one of them."""
    assert available() == CORES


def test_the_table_compares_at_equal_error(dataset: xr.Dataset) -> None:
    frame = table.table(dataset)
    row = frame[(frame["scene"] == "stick_slip") & (frame["setting"] == "step=0.0001")].iloc[0]
    # 1e8 h^4 = 1e-8 s: half the tolerance is the series' error, so that it reaches that at 1e-8
    assert row["event_time_error"] == pytest.approx(1e-8, rel=1e-6)
    assert row["times_series"] == pytest.approx((1e-5 / 1e-4) / (1e-3 + 8e-5), rel=0.03)
    coarse = frame[(frame["scene"] == "stick_slip") & (frame["setting"] == "step=0.0004")].iloc[0]
    assert coarse["times_series"] == pytest.approx((1e-5 / 4e-4) / (1e-3 + 6e-5), rel=1e-6)
    assert math.isnan(frame[frame["method"] == "Radau"]["times_series"].iloc[0])
    text = table.to_markdown(dataset)
    assert "4.0 (4)" in text
    assert "tol^1.00" in text
    assert "| - |" in text
    # at its default the series takes 1.1 ms a second; RK4 is as accurate with steps of 2e-5 s, at 0.5 s
    assert table.headline(dataset) == {"stick_slip": {"series": 1.0, "RK4": pytest.approx(0.5 / 1.1e-3)}}
    assert "event-time error within\n1e-10 s: RK4, fixed step 455." in text
    counted = dataset.assign(flops=("scene", [2.2e6, np.nan]))
    assert "2.2 MFlop in vectors per simulated second at tol=1e-10,\n2.0 GFlop/s." in table.to_markdown(counted)
    without = table.table(dataset.sel(solver=["RK4"]))
    assert without["times_series"].isna().all()


def test_every_point_is_reported_and_slow_ones_are_not_repeated(known: dict[str, Known]) -> None:
    known["RK4"].cost = lambda h: 5.0
    seen = []
    work_precision.work_precision(
        {"stick_slip": SETTINGS["stick_slip"]}, rounds=3, progress=lambda point, seconds: seen.append(point.method)
    )
    assert seen.count("RK4") == 4
    assert seen.count("series") == 9


def test_cost_against_accuracy_is_drawn(dataset: xr.Dataset, tmp_path) -> None:
    figure = figures.work_precision(dataset, "stick_slip")
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert set(labels) == {METHODS[name].label for name in ("series", "RK4", "Radau")}
    texts = {text.get_text() for text in figure.axes[0].texts}
    assert "4.0" in texts
    assert "wrong\nevents" in texts
    save(figure, tmp_path / "scene.png")
    save(figures.overview(dataset), tmp_path / "overview.png")
    assert figures._spread([(1e-8, 1.0, "a", "k"), (1e-8, 1.1, "b", "k"), (1e-3, 1.1, "c", "k")]) == [
        (1e-8, 1.0, "a", "k"),
        (1e-8, 1.5, "b", "k"),
        (1e-3, 1.1, "c", "k"),
    ]


# ------------------------------------------------------------------------------------- failure maps
@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch):
    """Maps of 20 ms of stick-slip and 10 ms of separations."""
    monkeypatch.setattr(failure_maps, "SPANS", {"stick_slip": 0.02, "separating": 1e-2})
    for cached in (failure_maps.short_problem, failure_maps.engine_answer):
        cached.cache_clear()
    yield
    for cached in (failure_maps.short_problem, failure_maps.engine_answer):
        cached.cache_clear()


@pytest.mark.usefixtures("short")
def test_maps_of_steps_and_of_tolerances(tmp_path) -> None:
    found = failure_maps.failure_map("RK4", "separating", (1, 2), (1e-3, 2e-5))
    assert found["modes"].values.tolist() == [3, 5]
    assert found["step_limit"].values == pytest.approx(2 * math.sqrt(2) / found["omega_max"].values)
    assert found["shortest_phase"].values.min() > 0
    assert "observed_limit" not in found
    assert available() == CORES  # it stayed on one of them
    engine = failure_maps.failure_map("series", "separating", (1, 2), (1e-6, 1e-10))
    assert (engine["verdict"].values == Verdict.CONVERGED).all()
    adaptive = failure_maps.failure_map("RK45", "separating", (1,), (1e-2, 1e-5))
    smooth = failure_maps.failure_map("regularised", "separating", (1,), (10.0, 1.0))
    assert np.isfinite(adaptive["longest_step"]).all()
    figure = figures.failure_maps([found, engine, adaptive, smooth, adaptive])
    titles = [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]
    assert titles[0] == f"(a) {METHODS['RK4'].label}"
    assert len(titles) == 5
    save(figure, tmp_path / "maps.png")


@pytest.mark.usefixtures("short")
def test_the_observed_limit_is_where_the_bisection_puts_it(monkeypatch: pytest.MonkeyPatch) -> None:
    limit = 6.4e-4

    class Breaking(failure_maps.FixedStep):
        def solve(self, problem, value, budget=math.inf):
            right = failure_maps.engine_answer("stick_slip", 2)
            outcome = Outcome.NON_FINITE if value > limit else Outcome.FINISHED
            return MethodResult(right.times.astype(float), right.kinds, right.final, 0.0, 1, outcome)

    monkeypatch.setattr(failure_maps, "FixedStep", Breaking)
    theory = float(failure_maps.failure_map("RK4", "separating", (2,), (1e-4,))["step_limit"][0])
    limit = 1.1 * theory
    assert failure_maps.observed_step_limit(2) == pytest.approx(limit, rel=3e-3)
    contact = failure_maps.failure_map("RK4", "stick_slip", (2,), (1e-4, 2e-4))
    assert float(contact["observed_limit"][0]) == pytest.approx(limit, rel=3e-3)
    assert "contact" in figures.failure_maps([contact]).axes[0].get_title(loc="left")


def test_heyoka_is_compiled_compactly_for_maps() -> None:
    own = failure_maps._economical(METHODS["heyoka-unguarded"])
    assert own.compact
    assert own.guard == 0.0
