"""The studies of the benchmark, the runner that measures their points, and figures."""

import json
import math

import numpy as np
import pytest
import xarray as xr
from docs.write_benchmark_pages import headline

from disc_model.benchmarks import answers, figures, study, work_precision
from disc_model.benchmarks.answers import AnswerStatus, AnswerVerdict, Reply, verdict
from disc_model.benchmarks.methods import METHODS, Method
from disc_model.benchmarks.methods.integrators import MethodResult, RunStatus
from disc_model.benchmarks.scaling import contact_study, scaling
from disc_model.benchmarks.scenes import Verdict
from disc_model.benchmarks.work_precision import measured_points, table
from disc_model.data.variables import flag_names
from disc_model.figures.drawing import save
from disc_model.simulation.api import simulate
from disc_model.units import CYCLE_TOLERANCES, limits_faults
from tests.benchmarks.conftest import SET_UP, SETTINGS, Known
from tests.figures.reading import labels

RIGHT, WRONG, SILENT = AnswerVerdict


# ------------------------------------------------------------------------ The runner
def test_points_are_measured_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    variables = {
        "size": ["m", "how big"],
        "state": ["1", "what it is"],
        "other": ["s", "never measured"],
    }
    monkeypatch.setitem(study.TABLES, "made_up", variables)
    turns = []

    def measure(kind: str, count: int):
        turns.append((kind, count))
        if kind == "b":
            yield {"size": float(len(turns)), "state": Verdict.CONVERGED}

    points = [{"kind": kind, "count": count} for kind in "ba" for count in (2, 1)]
    dataset = study.run(
        "made_up", points, measure, ["kind", "count"], rounds=3, flags={"state": Verdict}
    )
    assert turns == [("b", 2), ("b", 1), ("a", 2), ("a", 1)] * 3
    assert (dataset["kind"].values.tolist(), dataset["count"].values.tolist()) == (
        ["b", "a"],
        [2, 1],
    )
    np.testing.assert_array_equal(
        dataset["size"], [[5.0, 6.0], [np.nan, np.nan]]
    )  # medians of 1, 5, 9 and 2, 6, 10
    assert dataset["size"].attrs == {"units": "m", "long_name": "how big"}
    assert flag_names(dataset["state"]).tolist() == [["converged"] * 2, ["not_run"] * 2]
    assert np.isnan(dataset["other"]).all()
    assert "cores" in dataset.attrs["machine"]
    assert json.loads(dataset.attrs["versions"])["heyoka"]


# ------------------------------------------------------------------------ Speed against accuracy
def test_the_dataset_holds_what_the_methods_did(
    dataset: xr.Dataset, known: dict[str, Known]
) -> None:
    rk4 = dataset.sel(scene="stick_slip", solver="RK4")
    np.testing.assert_allclose(
        rk4["event_error"], [1e8 * h**4 for h in SETTINGS["stick_slip"]["RK4"]], rtol=1e-5
    )
    assert flag_names(rk4["verdict"]).tolist() == [
        "inaccurate",
        "converged",
        "converged",
        "converged",
    ]
    series = dataset.sel(scene="stick_slip", solver="series")
    assert flag_names(series["verdict"])[3] == "not_run"
    assert (series["repeats"][:3] == 2).all()
    assert series["cost"][0] == pytest.approx(1e-3 + 6e-5)
    assert series["marginal_cost"][0] == pytest.approx(1e-3 + 6e-5 - SET_UP)
    assert np.isfinite(series["whole_call"].values).tolist() == [False, False, True, False]
    np.testing.assert_allclose(rk4["glue"], 0.25)
    # too long to be followed further
    assert np.isnan(rk4["marginal_cost"][3])
    assert (
        flag_names(dataset.sel(scene="stick_slip", solver="Radau")["verdict"])[0] == "wrong_events"
    )
    # what gives up at a coarse setting is not tried at a finer one
    assert known["regularised"].tried == [1.0]
    words = flag_names(dataset.sel(scene="separating", solver="regularised")["verdict"])
    assert words[:2].tolist() == ["gave_up", "not_run"]


def test_the_table_compares_at_equal_error(dataset: xr.Dataset) -> None:
    frame = table(dataset).set_index(["scene", "method", "setting"])
    row = frame.loc["stick_slip", "RK4", "step=0.0001"]
    # 1e8 h^4 = 1e-8 s: half the tolerance is the series' error, so that it reaches that at 1e-8
    assert row["event_time_error"] == pytest.approx(1e-8, rel=1e-6)
    assert row["times_series"] == pytest.approx((1e-5 / 1e-4) / (1e-3 + 8e-5), rel=0.03)
    coarse = frame.loc["stick_slip", "RK4", "step=0.0004"]
    assert coarse["times_series"] == pytest.approx((1e-5 / 4e-4) / (1e-3 + 6e-5), rel=1e-6)
    assert math.isnan(frame.loc["stick_slip", "Radau", "tol=0.001"]["times_series"])
    assert row["verdict"] == "converged"
    # at its default the series takes 1 ms a further second; RK4 is right to 1e-10 s between two of
    # its steps, at 3.16e-5 s, which takes 0.316 s
    step = (1e-10 / 1e8) ** 0.25
    expected = {"series": 1.0, "RK4": pytest.approx(1e-5 / step / 1e-3, rel=1e-3)}
    assert headline(measured_points(dataset)) == {"stick_slip": expected}
    assert table(dataset.sel(solver=["RK4"]))["times_series"].isna().all()


# ------------------------------------------------------------------------ Questions
def test_to_deny_what_there_is_is_wrong_and_to_give_up_is_not() -> None:
    for value, status, right, expected in (
        (54.45, AnswerStatus.FOUND, 54.4, RIGHT),
        (54.6, AnswerStatus.FOUND, 54.4, WRONG),
        (54.4, AnswerStatus.FOUND, math.nan, WRONG),
        (math.nan, AnswerStatus.NONE, 54.4, WRONG),
        (math.nan, AnswerStatus.NONE, math.nan, RIGHT),
        (math.nan, AnswerStatus.TOO_SLOW, 54.4, SILENT),
    ):
        assert verdict("first_separation", Reply(value, 1.0, status), right) is expected


@pytest.mark.compiled
def test_the_engine_gives_the_right_answers() -> None:
    """By methods that share no code with it; 1e-9 s and 1e-6 1/s leave room for rounding that grows
    and for the fit."""
    solve = answers.setting_of(METHODS["series"], 1e-12)
    replies = answers.first_separation(solve, 10.0) | answers.after_separation(solve, 6.0)
    replies |= answers.growth_rate(solve, 6.0)
    tolerances = {
        "first_separation": 1e-9,
        "separation_rate": 1e-9,
        "period": 0,
        "growth_rate": 1e-6,
    }
    for name, tolerance in tolerances.items():
        assert replies[name].value == pytest.approx(answers.reference(name).value, abs=tolerance)
    # sampled 20,000 times a second
    assert replies["disc_range"].value == pytest.approx(
        answers.reference("disc_range").value, rel=2e-4
    )
    # the rule broke off at a tolerance that the search for a cycle refuses
    assert not any(
        limits_faults("tol", tol, CYCLE_TOLERANCES)
        for tol in (*answers.CYCLE_SETTINGS, answers.DEFAULT)
    )


@pytest.mark.compiled
def test_models_answer_by_their_own_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the modes of the references all is right; without pairs of modes nothing ever grows."""
    monkeypatch.setattr(answers, "RICHEST", {})
    replies = answers.ask_model({})
    assert (replies.pop("region").value, answers.QUESTIONS.keys() - replies) == (0, {"region"})
    assert {
        verdict(name, reply, answers.reference(name).value) for name, reply in replies.items()
    } == {RIGHT}
    # what a deviation of finite size adds to the rate at which an infinitesimal one grows
    assert replies["growth_rate"].value == pytest.approx(
        answers.reference("growth_rate").value, abs=2e-5
    )
    assert replies["onset"].value == pytest.approx(15.0949, abs=5e-5)
    none = answers.ask_model({"n_diameters": 0})
    assert none["onset"][2:4] == (AnswerStatus.NONE, "no fold from 14.5 to 16 rad/s")
    assert none["period"][2:4] == (AnswerStatus.NONE, "no separation within 400 s")
    assert none["region"].value > 0
    assert (
        "no cycle to follow" in answers.cycle_onset(answers.SEPARATING.replace(N=0), 1e-10).message
    )


def separating_above(speed: float) -> answers.Solve:
    """A method that takes 0.1 s a run, and finds a separation from this speed on."""

    def solve(problem, budget):
        late, apart = budget <= 0.1, problem.parameters.Omega >= speed
        kinds = ("separation",) * (apart and not late)
        outcome = RunStatus.TOO_SLOW if late else RunStatus.FINISHED
        return MethodResult(np.ones(len(kinds)), kinds, problem.start, 0.1, 1, outcome)

    return solve


def test_the_onset_is_enclosed_between_two_speeds() -> None:
    found = answers.onset(separating_above(15.1), 12.0)["onset"]
    assert found.low < 15.1 <= found.high <= found.low + answers.ONSET_WITHIN
    assert found[:2] == (
        pytest.approx((found.low + found.high) / 2),
        pytest.approx(0.8),
    )  # two ends, six halves
    for speed, message in (
        (16.0, "no separation at 15.6 rad/s"),
        (14.0, "a separation already at 14.6 rad/s"),
    ):
        assert answers.onset(separating_above(speed), 12.0)["onset"][2:4] == (
            AnswerStatus.NONE,
            message,
        )
    given_up = answers.onset(separating_above(15.1), 0.45)["onset"]
    assert (given_up.status, given_up.high - given_up.low) == (
        AnswerStatus.TOO_SLOW,
        pytest.approx(0.25),
    )


def test_a_region_is_judged_by_as_many_cells_as_the_budget_allows() -> None:
    stored = np.array(
        [[letter == "1" for letter in row] for row in answers.stored("answers")["region"]]
    )
    wrong = float(np.mean(stored != (np.linspace(14, 34, 32) >= 24)))
    budgets = (0.05, 1.0, 8.0, 200.0)
    slow, few, some, whole = (
        answers.region(separating_above(24.0), budget)["region"] for budget in budgets
    )
    assert (slow.status, few.status) == (AnswerStatus.TOO_SLOW,) * 2
    assert (slow.cells, few.cells, some.cells, whole.cells) == (0, 4, 64, 1024)
    assert (few.seconds, some.seconds, whole.seconds) == pytest.approx((102.4, 102.4, 102.4))
    assert some.low < wrong < some.high
    assert whole.value == whole.low == whole.high == pytest.approx(wrong)


def test_no_question_is_answered_by_a_method_that_gives_up() -> None:
    for function, _ in answers.ASKED.values():
        assert {reply.status for reply in function(separating_above(0), 0.05).values()} == {
            AnswerStatus.TOO_SLOW
        }
    assert all(
        math.isnan(answers.growth(releases)) for releases in (np.arange(9.0), np.arange(99.0))
    )


# ------------------------------------------------------------------------ Costs of answers, and
# maps
def column(dataset: xr.Dataset, line: str, name: str) -> list:
    return dataset[name].values[dataset["line"].values == line].tolist()


def test_errors_of_models_are_against_the_richest_and_those_of_methods_against_the_stored(
    priced: xr.Dataset,
) -> None:
    np.testing.assert_allclose(column(priced, "rigid", "error"), [math.nan, 0.05, 0.0], atol=1e-12)
    assert column(priced, "rigid", "verdict") == [WRONG, RIGHT, RIGHT]
    exact = answers.reference("first_separation").value
    np.testing.assert_allclose(
        column(priced, "late", "error"),
        [math.nan, 54.7 - exact, exact - 54.41, exact - 54.4001, math.nan],
        atol=1e-9,
    )
    assert column(priced, "late", "status") == [
        AnswerStatus.NONE,
        *[AnswerStatus.FOUND] * 3,
        AnswerStatus.TOO_SLOW,
    ]
    assert column(priced, "late", "verdict") == [WRONG, WRONG, RIGHT, RIGHT, SILENT]
    assert "no cycle" in column(priced, "cycle", "message")
    first, *_, last = answers.in_words(priced)[
        ["line", "at", "verdict", "status", "message"]
    ].values.tolist()
    assert first == ["late", "tol=1", "wrong", "none", "no separation within 55 s"]
    assert last == ["rigid", "8 diameters", "right", "found", ""]


def test_maps_of_steps_and_of_tolerances(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    """Of 20 ms of stick-slip and 10 ms of separations."""
    monkeypatch.setattr(work_precision, "SPANS", {"stick_slip": 0.02, "separating": 1e-2})
    steps = work_precision.failure_map("RK4", "separating", (1, 2), (1e-3, 2e-5))
    assert steps["modes"].values.tolist() == [3, 5]
    assert steps["step_limit"].values == pytest.approx(2 * math.sqrt(2) / steps["omega_max"].values)
    assert steps["shortest_phase"].values.min() > 0
    engine = work_precision.failure_map("series", "separating", (1, 2), (1e-7, 1e-10))
    assert (engine["verdict"].values == Verdict.CONVERGED).all()
    adaptive = work_precision.failure_map("RK45", "separating", (1,), (1e-2, 1e-5))
    smooth = work_precision.failure_map("regularised", "separating", (1,), (10.0, 1.0))
    assert np.isfinite(adaptive["longest_step"]).all()
    figure = figures.failure_maps(steps, engine, adaptive, smooth, adaptive)
    titles = [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]
    assert titles[0] == f"(a) {METHODS['RK4'].label}"
    assert len(titles) == 5
    save(figure, tmp_path / "maps.png")


def test_a_map_of_answers_tries_no_finer_setting_after_one_that_is_too_slow(late: Method) -> None:
    answered = answers.answer_map(late.name, (1, 4), (1.0, 1e-2, 1e-6, 1e-7))
    cases = [answers.MAP_CASE.replace(n_diameters=count) for count in (1, 4)]
    right = [
        simulate(p, answers.MAP_HORIZON, stop_at="first_separation").first_separation for p in cases
    ]
    np.testing.assert_allclose(answered["right"], right, atol=1e-7)
    assert answered["status"].values.tolist() == [[1, 0, 2, 2]] * 2
    assert answered["verdict"].values.tolist() == [[WRONG, WRONG, SILENT, SILENT]] * 2
    settings = [1e-2, 1e-4, 1e-6, 1e-7, 1e-9, 1e-11]
    assert answers.answer_map(late.name, (0,))["value"].values == pytest.approx(settings)
    assert answers.answer_map("series", (1,), (1e-6,))["verdict"] == RIGHT
    assert figures.answer_maps(answered).axes[0].get_title(loc="left") == "(a) late"


# ------------------------------------------------------------------------ Numbers of modes
@pytest.mark.compiled
def test_what_truncation_does_to_a_study(tmp_path):
    dataset = contact_study(((4, 0), (6, 0)), {"paper": {"N": 385.0, "Omega": 15.1}}, horizon=60.0)
    rigid = dataset.sel(case="paper", contact="rigid")
    assert rigid["first_separation"].values == pytest.approx([54.4189, 53.51], abs=0.01)
    assert (rigid["frequency_error"].diff("model") < 0).all()
    assert np.isnan(dataset["growth_rate"]).all()  # the quiet cycle ends at a lower speed
    save(figures.contact_truncation(dataset), tmp_path / "truncation.png")


@pytest.mark.compiled
def test_cost_is_that_of_all_processes():
    """Four outcomes take 0.3 s, which two processes of their own compute; this one takes 0.03 s
    beside them."""
    dataset = scaling(((1, 1), (1, 2), (2, 2)), ((1, 0), (4, 0)), (1.0, 500.0), several=(2, 2))
    assert dataset["points"].values.tolist() == [2, 4, 1, 2, *[4] * 6]
    assert dataset["modes"].values.tolist() == [9, 9, 9, 9, 3, 9, 3, 9, 9, 9]
    assert dataset["seconds"][-1] > 0.1
    assert [len(ax.lines) for ax in figures.draw("scaling", [dataset]).axes] == [2, 2, 1]


# ------------------------------------------------------------------------ Figures
def test_cost_against_accuracy_is_drawn(dataset: xr.Dataset, tmp_path) -> None:
    figure = figures.overview(dataset)
    expected = {METHODS[name].label for name in ("series", "RK4", "Radau")}
    assert set(labels(figure)) == expected | {f"{METHODS['RK4'].label}, without Python"}
    assert [text.get_text() for text in figure.axes[0].texts] == ["wrong\nevents"]
    save(figure, tmp_path / "overview.png")


def test_a_cell_of_prices_names_its_setting(priced: xr.Dataset) -> None:
    texts = [text.get_text() for text in figures.prices(priced).axes[0].texts]
    assert texts == ["2 s", "tol 1e-2", "wrong at 2", "0.4 ms", "tol 1e-6", "wrong"]
    figure = figures.draw("answers", [priced])
    assert labels(figure) == [
        "late",
        "series, modes, rigid contact",
        "series, from the cycle itself",
    ]
    assert [text.get_text() for text in figure.axes[0].texts] == ["8", "4"]
