"""The studies of the benchmark: the runner that measures their points, and what they find."""

import json
import math
from collections.abc import Iterator

import numpy as np
import pytest
import xarray as xr
from docs.write_benchmark_pages import headline

from benchmarks import answer_maps, answers, failure_maps, figures, study
from benchmarks.methods import METHODS, Method
from benchmarks.questions import AnswerStatus, AnswerVerdict, reference
from benchmarks.scaling import scaling
from benchmarks.scenes import Verdict
from benchmarks.shares import SAMPLES, shares
from benchmarks.truncation import contact_study
from benchmarks.work_precision import measured_points, table
from disc_model.data.variables import flag_names
from disc_model.simulation.api import simulate
from disc_model.studies.registry import QUANTITIES
from disc_model.studies.study import parse_study
from tests.benchmarks.conftest import SET_UP, SETTINGS, Known

RIGHT, WRONG, SILENT = AnswerVerdict


# ---- The runner


def test_points_are_measured_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    variables = {
        "size": ["m", "how big"],
        "state": ["1", "what it is"],
        "other": ["s", "never measured"],
    }
    monkeypatch.setitem(study.TABLES, "made_up", variables)
    turns = []

    def measure(kind: str, count: int) -> Iterator[study.Row]:
        turns.append((kind, count))
        if kind == "b":
            yield {"size": float(len(turns)), "state": Verdict.CONVERGED}

    points = [{"kind": kind, "count": count} for kind in "ba" for count in (2, 1)]
    dims = ["kind", "count"]
    dataset = study.run("made_up", points, measure, dims, rounds=3, flags={"state": Verdict})
    assert turns == [("b", 2), ("b", 1), ("a", 2), ("a", 1)] * 3
    assert dataset["kind"].values.tolist() == ["b", "a"]
    assert dataset["count"].values.tolist() == [2, 1]
    # medians of 1, 5, 9 and 2, 6, 10
    missing = [np.nan, np.nan]
    np.testing.assert_array_equal(dataset["size"], [[5.0, 6.0], missing])
    assert dataset["size"].attrs == {"units": "m", "long_name": "how big"}
    first, second = flag_names(dataset["state"]).tolist()
    assert first == ["converged"] * 2
    assert second == ["not_run"] * 2
    assert np.isnan(dataset["other"]).all()
    assert "cores" in dataset.attrs["machine"]
    assert json.loads(dataset.attrs["versions"])["heyoka"]


# ---- Speed against accuracy


def of(dataset: xr.Dataset, scene: str, solver: str) -> xr.Dataset:
    """Return the points of a method on a scene."""
    return dataset.sel(scene=scene, solver=solver)


def test_errors_and_verdicts_are_those_of_the_methods(dataset: xr.Dataset) -> None:
    rk4 = of(dataset, "stick_slip", "RK4")
    expected = [1e8 * h**4 for h in SETTINGS["stick_slip"]["RK4"]]
    np.testing.assert_allclose(rk4["event_error"], expected, rtol=1e-5)
    words = ["inaccurate", "converged", "converged", "converged"]
    assert flag_names(rk4["verdict"]).tolist() == words
    radau = of(dataset, "stick_slip", "Radau")
    assert flag_names(radau["verdict"])[0] == "wrong_events"


def test_costs_are_those_of_the_methods(dataset: xr.Dataset) -> None:
    series = of(dataset, "stick_slip", "series")
    assert flag_names(series["verdict"])[3] == "not_run"
    assert (series["repeats"][:3] == 2).all()
    assert series["cost"][0] == pytest.approx(1e-3 + 6e-5)
    cost = 1e-3 + 6e-5 - SET_UP
    assert series["marginal_cost"][0] == pytest.approx(cost)
    finite = np.isfinite(series["whole_call"].values)
    assert finite.tolist() == [False, False, True, False]
    rk4 = of(dataset, "stick_slip", "RK4")
    np.testing.assert_allclose(rk4["glue"], 0.25)
    assert np.isnan(rk4["marginal_cost"][3]), "too long to be followed further"


def test_what_gives_up_at_a_coarse_setting_is_not_tried_at_a_finer_one(
    dataset: xr.Dataset, known: dict[str, Known]
) -> None:
    assert known["regularised"].tried == [1.0]
    words = flag_names(of(dataset, "separating", "regularised")["verdict"])
    assert words[:2].tolist() == ["gave_up", "not_run"]


def test_the_table_compares_at_equal_error(dataset: xr.Dataset) -> None:
    frame = table(dataset).set_index(["scene", "method", "setting"])
    row = frame.loc["stick_slip", "RK4", "step=0.0001"]
    assert row["verdict"] == "converged"
    # 1e8 h^4 = 1e-8 s: half the tolerance is the series' error, so that it reaches that at 1e-8
    assert row["event_time_error"] == pytest.approx(1e-8, rel=1e-6)
    price = 1e-5 / 1e-4
    price_of_series = 1e-3 + 8e-5
    assert row["times_series"] == pytest.approx(price / price_of_series, rel=0.03)
    coarse = frame.loc["stick_slip", "RK4", "step=0.0004"]
    price = 1e-5 / 4e-4
    price_of_series = 1e-3 + 6e-5
    assert coarse["times_series"] == pytest.approx(price / price_of_series, rel=1e-6)
    assert math.isnan(frame.loc["stick_slip", "Radau", "tol=0.001"]["times_series"])
    alone = table(dataset.sel(solver=["RK4"]))
    assert alone["times_series"].isna().all()


def test_the_headline_compares_at_the_default_error(dataset: xr.Dataset) -> None:
    """The series takes 1 ms a further second there.

    RK4 is right to 1e-10 s between two of its steps, at 3.16e-5 s, which takes 0.316 s.
    """
    step = (1e-10 / 1e8) ** 0.25
    found = headline(measured_points(dataset))
    rk4 = pytest.approx(1e-5 / step / 1e-3, rel=1e-3)
    assert found == {"stick_slip": {"series": 1.0, "RK4": rk4}}


# ---- Costs of answers


def column(dataset: xr.Dataset, line: str, name: str) -> list:
    """Return a variable of the rows of a line."""
    values = dataset[name].values
    on_line = dataset["line"].values == line
    return values[on_line].tolist()


def test_errors_of_models_are_against_the_richest(priced: xr.Dataset) -> None:
    errors = column(priced, "rigid", "error")
    np.testing.assert_allclose(errors, [math.nan, 0.05, 0.0], atol=1e-12)
    assert column(priced, "rigid", "verdict") == [WRONG, RIGHT, RIGHT]


def test_errors_of_methods_are_against_the_stored(priced: xr.Dataset) -> None:
    exact = reference("first_separation").value
    errors = [math.nan, 54.7 - exact, exact - 54.41, exact - 54.4001, math.nan]
    np.testing.assert_allclose(column(priced, "late", "error"), errors, atol=1e-9)
    found = [AnswerStatus.FOUND] * 3
    statuses = [AnswerStatus.NONE, *found, AnswerStatus.TOO_SLOW]
    assert column(priced, "late", "status") == statuses
    assert column(priced, "late", "verdict") == [WRONG, WRONG, RIGHT, RIGHT, SILENT]


def test_rows_of_answers_are_told_in_words(priced: xr.Dataset) -> None:
    assert "no cycle" in column(priced, "cycle", "message")
    words = answers.in_words(priced)[["line", "at", "verdict", "status", "message"]]
    first, *_, last = words.values.tolist()
    assert first == ["late", "tol=1", "wrong", "none", "no separation within 55 s"]
    assert last == ["rigid", "8 diameters", "right", "found", ""]


# ---- Maps


@pytest.fixture
def short_spans(monkeypatch: pytest.MonkeyPatch) -> None:
    """20 ms of stick-slip and 10 ms of separations."""
    monkeypatch.setattr(failure_maps, "SPANS", {"stick_slip": 0.02, "separating": 1e-2})


@pytest.mark.usefixtures("short_spans")
def test_a_map_of_steps_has_the_facts_that_explain_it() -> None:
    steps = failure_maps.failure_map("RK4", "separating", (1, 2), (1e-3, 2e-5))
    assert steps["modes"].values.tolist() == [3, 5]
    limit = 2 * math.sqrt(2) / steps["omega_max"].values
    assert steps["step_limit"].values == pytest.approx(limit)
    assert steps["shortest_phase"].values.min() > 0


@pytest.mark.usefixtures("short_spans")
def test_the_engine_converges_at_all_its_settings() -> None:
    engine = failure_maps.failure_map("series", "separating", (1, 2), (1e-7, 1e-10))
    assert (engine["verdict"].values == Verdict.CONVERGED).all()


@pytest.mark.usefixtures("short_spans")
def test_maps_of_tolerances_know_the_longest_step() -> None:
    adaptive = failure_maps.failure_map("RK45", "separating", (1,), (1e-2, 1e-5))
    smooth = failure_maps.failure_map("regularised", "separating", (1,), (10.0, 1.0))
    assert np.isfinite(adaptive["longest_step"]).all()
    figure = figures.failure_maps(adaptive, smooth)
    titles = [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]
    labels = [METHODS[name].label for name in ("RK45", "regularised")]
    first, second = labels
    assert titles == [f"(a) {first}", f"(b) {second}"]


def test_a_map_of_answers_tries_no_finer_setting_after_one_that_is_too_slow(late: Method) -> None:
    answered = answer_maps.answer_map(late.name, (1, 4), (1.0, 1e-2, 1e-6, 1e-7))
    right = []
    for count in (1, 4):
        p = answer_maps.MAP_CASE.replace(n_diameters=count)
        run = simulate(p, answer_maps.MAP_HORIZON, stop_at="first_separation")
        right.append(run.first_separation)
    np.testing.assert_allclose(answered["right"], right, atol=1e-7)
    statuses = answered["status"].values.tolist()
    assert statuses == [[1, 0, 2, 2]] * 2
    verdicts = answered["verdict"].values.tolist()
    assert verdicts == [[WRONG, WRONG, SILENT, SILENT]] * 2
    ax = figures.answer_maps(answered).axes[0]
    assert ax.get_title(loc="left") == "(a) late"


def test_a_map_of_answers_has_six_of_the_settings(late: Method) -> None:
    settings = [1e-2, 1e-4, 1e-6, 1e-7, 1e-9, 1e-11]
    answered = answer_maps.answer_map(late.name, (0,))
    assert answered["value"].values == pytest.approx(settings)


def test_the_engine_finds_the_first_separation_of_the_maps() -> None:
    assert answer_maps.answer_map("series", (1,), (1e-6,))["verdict"] == RIGHT


# ---- What the size of a problem decides


@pytest.mark.compiled
def test_what_truncation_does_to_a_study() -> None:
    cases = {"paper": {"N": 385.0, "Omega": 15.1}}
    dataset = contact_study(((4, 0), (6, 0)), cases, horizon=60.0)
    rigid = dataset.sel(case="paper", contact="rigid")
    times = [54.4189, 53.51]
    assert rigid["first_separation"].values == pytest.approx(times, abs=0.01)
    assert (rigid["frequency_error"].diff("model") < 0).all()
    assert np.isnan(dataset["growth_rate"]).all(), "the quiet cycle ends at a lower speed"

    axes = figures.contact_truncation(dataset).axes
    assert len(axes) == 8
    assert axes[6].get_title(loc="left") == "(g) Range of the slider's\nheight (mm)"
    late = dataset["u_range"].sel(case="paper", contact="residual")
    line = axes[6].lines[0]
    drawn = line.get_ydata()
    np.testing.assert_allclose(drawn, 1e3 * late)


@pytest.mark.compiled
def test_the_time_of_a_quantity_is_that_of_its_parts() -> None:
    axes = {"N": [385], "Omega": [15.1]}
    samples = {
        "outcome": {"options": {"horizon": 30, "early_end": False}, "axes": axes},
        "floquet": {"axes": axes},
    }
    dataset = shares(samples)
    assert dataset["quantity"].values.tolist() == ["outcome", "floquet"]
    assert dataset["points"].values.tolist() == [1, 1]
    parts = [dataset[name].values for name in ("simulation", "newton", "return_maps", "rest")]
    np.testing.assert_allclose(np.sum(parts, axis=0), dataset["seconds"].values)
    assert (np.array(parts) >= 0).all()
    # to the horizon in legs, and the last second again; a growth rate needs no simulation
    assert dataset["simulated"].values[0] >= 30
    assert dataset["simulated"].values[1] == dataset["simulation"].values[1] == 0
    assert dataset["newton"].values[1] > 0


def test_every_quantity_has_a_sample_of_its_time() -> None:
    assert SAMPLES.keys() == QUANTITIES.keys()
    for quantity, sample in SAMPLES.items():
        parse_study({"study": "shares", "quantity": quantity, **sample})


@pytest.mark.compiled
def test_cost_is_that_of_all_processes() -> None:
    """Four outcomes take 0.3 s in two processes of their own, and 0.03 s in this one."""
    grids = ((1, 1), (1, 2), (2, 2))
    models = ((1, 0), (4, 0))
    horizons = (1.0, 500.0)
    dataset = scaling(grids, models, horizons, several=(2, 2))
    assert dataset["points"].values.tolist() == [2, 4, 1, 2, *[4] * 6]
    assert dataset["modes"].values.tolist() == [9, 9, 9, 9, 3, 9, 3, 9, 9, 9]
    assert dataset["seconds"][-1] > 0.1
    figure = figures.draw("scaling", [dataset])
    counts = [len(ax.lines) for ax in figure.axes]
    assert counts == [2, 2, 1]
    assert figure.axes[2].get_ylabel() == "Processor time of a point (ms)"
    np.testing.assert_allclose(
        figure.axes[2].lines[0].get_ydata(), 1e3 * dataset["seconds"][-2:] / 4
    )
