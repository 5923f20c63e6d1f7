"""The benchmark's bookkeeping: errors, verdicts, orders, datasets, figures."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model.benchmarks import failure_maps, scenes, work_precision
from disc_model.benchmarks.flops import vector_flops
from disc_model.benchmarks.methods import METHODS, MethodResult, Outcome
from disc_model.benchmarks.scenes import Verdict, answer, errors, event_time_error, problem
from disc_model.benchmarks.table import headline, table, to_markdown
from disc_model.data.dataset import load, save
from disc_model.figures import benchmark as figures

QUICK = {"stick_slip": {"series": (1e-6, 1e-8, 1e-10), "RK4": (7e-4, 2e-4, 1e-4, 5e-5)}, "separating": {"RK4": (1e-4,)}}


@pytest.fixture(scope="module")
def dataset():
    return work_precision.work_precision(QUICK, rounds=2)


def _result(scene, times, kinds, outcome=Outcome.FINISHED, final=None):
    right = answer(scene)
    return MethodResult(np.asarray(times, float), tuple(kinds), final or right.final, 0.1, 1, outcome)


# ------------------------------------------------------------------------------------- errors and verdicts
def test_the_right_answer_has_no_error():
    right = answer("stick_slip")
    found = errors(problem("stick_slip"), right, _result("stick_slip", right.times, right.kinds))
    assert (found.state, found.verdict) == (0.0, Verdict.CONVERGED)
    assert found.event_time < 1e-15


def test_an_event_too_few_is_wrong_unless_it_is_late():
    right, t_end = answer("stick_slip"), problem("stick_slip").t_end
    times = right.times.astype(float)
    missing = _result("stick_slip", np.delete(times, 7), np.delete(right.kinds, 7))
    assert math.isnan(event_time_error(right, missing, t_end))
    short = _result("stick_slip", times[:-1], right.kinds[:-1])
    assert math.isnan(event_time_error(right, short, t_end))
    late = t_end - times[-1]
    delayed = _result("stick_slip", times[:-1] + late, right.kinds[:-1])
    assert event_time_error(right, delayed, t_end) == pytest.approx(late)


def test_verdicts():
    task, right = problem("stick_slip"), answer("stick_slip")

    def verdict(**changes):
        return errors(
            task, right, _result("stick_slip", **({"times": right.times, "kinds": right.kinds} | changes))
        ).verdict

    assert verdict(times=right.times + 1e-4) is Verdict.INACCURATE
    assert verdict(kinds=("separation",) * 135) is Verdict.MISSED
    assert verdict(outcome=Outcome.NON_FINITE) is Verdict.UNSTABLE
    assert verdict(outcome=Outcome.TOO_SLOW) is Verdict.GAVE_UP
    assert verdict(outcome=Outcome.STALLED) is Verdict.GAVE_UP
    assert verdict(final=right.final.replace(alpha=right.final.alpha + 100.0)) is Verdict.UNSTABLE


def test_rigid_cycle():
    task, right = problem("rigid"), answer("rigid")
    p = task.parameters
    assert right.kinds == ("stick_to_slip", "slip_to_stick", "stick_to_slip")
    assert float(right.times[0]) == pytest.approx(p.mu_s * p.N / (p.k_p * p.r_0) / p.Omega, rel=1e-15)
    result = METHODS["RK4"].solve(task, 6e-8)
    assert errors(task, right, result).event_time < 1e-10


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


# ------------------------------------------------------------------------------------- the dataset
def test_dataset(dataset, tmp_path):
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


def test_table(dataset):
    frame = table(dataset)
    assert len(frame) == 8
    best = frame[(frame["method"] == "RK4") & (frame["verdict"] == "converged")]
    assert (best["times_series"] > 1.0).all()
    text = to_markdown(dataset)
    assert dataset.attrs["machine"] in text
    assert "wrong events" in text
    assert "(4)" in text


def test_headline_compares_the_default_with_the_cheapest_right_setting(dataset):
    """RK4 with 1e-5 s is the coarsest of the three that is right to 1e-10 s; the wrong ones do not count."""
    cost = {"series": (2e-3, 5e-4), "RK4": (1e-3, 4e-3, 4e-2)}
    error = {"series": (1e-7, 2e-12), "RK4": (1e-5, 1e-11, 1e-13)}
    value = {"series": (1e-6, 1e-10), "RK4": (1e-4, 1e-5, 1e-6)}
    grids = {name: np.full((1, 2, 3), np.nan) for name in ("cost", "event_error", "value")}
    for i, method in enumerate(("series", "RK4")):
        for name, given in (("cost", cost), ("event_error", error), ("value", value)):
            grids[name][0, i, : len(given[method])] = given[method]
    verdict = np.where(np.isfinite(grids["cost"]), int(Verdict.CONVERGED), int(Verdict.NOT_RUN))
    made = xr.Dataset(
        {name: (("scene", "solver", "point"), grid) for name, grid in (grids | {"verdict": verdict}).items()},
        coords={"scene": ["stick_slip"], "solver": ["series", "RK4"]},
    )
    assert headline(made) == {"stick_slip": {"series": 1.0, "RK4": pytest.approx(8.0)}}


def test_arithmetic_is_that_of_the_convolutions_and_some_more():
    """A slip step of order 22 has two products (f e, f z) of 231 inner terms on eight lanes, multiply and add."""
    flops = vector_flops("stick_slip", 1e-10)
    steps = 677  # of slip in this second
    assert steps * 7392 < flops < 3 * steps * 7392


def test_a_hopeless_method_is_not_tried_again():
    tried = []
    settings = {"many_modes": {"RK45": (1e-4, 1e-6, 1e-8)}}
    found = work_precision.work_precision(
        settings, rounds=1, budget=0.02, progress=lambda point, _: tried.append(point.value)
    )
    assert tried == [1e-4]
    assert int(found["verdict"].values[0, 0, 0]) == Verdict.GAVE_UP


# ------------------------------------------------------------------------------------- failure maps
@pytest.mark.parametrize("diameters", [2, 4])
def test_observed_stability_limit_is_the_linear_one(diameters):
    """2 sqrt(2)/omega_max is exact for a linear undamped system; stick-slip and damping shift it by 3 % at most."""
    theory = float(failure_maps.failure_map("RK4", "separating", (diameters,), (1e-3,))["step_limit"][0])
    assert failure_maps.observed_step_limit(diameters) == pytest.approx(theory, rel=0.03)


def test_failure_map():
    found = failure_maps.failure_map("RK4", "stick_slip", (1, 4), (1e-3, 3e-4, 5e-5))
    words = np.array(found["verdict"].attrs["flag_meanings"].split())[found["verdict"].values]
    assert words.tolist() == [["inaccurate", "inaccurate", "converged"], ["unstable", "inaccurate", "converged"]]
    assert found["modes"].values.tolist() == [3, 9]
    engine = failure_maps.failure_map("series", "separating", (1, 4), (1e-6, 1e-10))
    assert (engine["verdict"].values == Verdict.CONVERGED).all()


# ------------------------------------------------------------------------------------- figures
def test_figures(dataset, tmp_path):
    from disc_model.figures.style import save as save_figure

    maps = [failure_maps.failure_map("RK4", "stick_slip", (1, 4), (1e-3, 5e-5))]
    drawn = {
        "overview": figures.overview(dataset),
        "scene": figures.work_precision(dataset, "stick_slip"),
        "maps": figures.failure_maps(maps),
    }
    for name, figure in drawn.items():
        assert isinstance(figure, Figure)
        save_figure(figure, tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").stat().st_size > 5000


def test_every_method_has_a_look_and_every_scene_a_title():
    assert set(METHODS) <= set(figures.LOOKS)
    assert set(figures.TITLES) == set(scenes.SCENES)
    assert figures.VERDICTS == scenes.VERDICT_WORDS


def test_the_rules_name_every_scene_and_every_failure_map() -> None:
    rules = (Path(__file__).parents[2] / "workflow/rules/benchmark.smk").read_text()
    from disc_model.benchmarks.failure_maps import VALUES

    for name in (*scenes.SCENES, *VALUES):
        assert f'"{name}"' in rules
