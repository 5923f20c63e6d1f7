"""What each answer costs: how answers are found and judged, what is missing, tables, sentences and charts."""

import math

import numpy as np
import pytest
import xarray as xr

from disc_model.benchmarks import failure_maps, figures
from disc_model.benchmarks.answers import measure, modelled, questions, simulated
from disc_model.benchmarks.answers.questions import SIDE, AnswerStatus, AnswerVerdict, Found, verdict
from disc_model.benchmarks.methods import MethodResult, Problem, RunStatus
from disc_model.benchmarks.registry import METHODS, Method
from disc_model.parameters import CYCLE_TOLERANCES, limits_faults
from tests.references.stored import load


def result(problem: Problem, times, kind="separation", outcome=RunStatus.FINISHED, seconds=2.0) -> MethodResult:
    return MethodResult(np.array(times, float), (kind,) * len(times), problem.start, seconds, 1, outcome)


class Late(Method):
    """Finds the first separation late by its tolerance, and none at a coarse one; the finest takes too long."""

    def solve(self, problem, value, budget=math.inf):
        times = [54.4 + value, 54.9] if 1e-5 < value < 0.5 else []
        outcome = RunStatus.FINISHED if value > 1e-5 else RunStatus.TOO_SLOW
        return result(problem, times, outcome=outcome, seconds=2.0 if value > 1e-3 else 3.0)


LATE = Late(name="late", label="late", place="", settings={})

# ----------------------------------------------------------------------------------------------------
# Judging


def test_to_deny_what_there_is_is_wrong_and_to_give_up_is_not() -> None:
    for found, right, expected in (
        (Found(54.45, 1.0, AnswerStatus.FOUND), 54.4, AnswerVerdict.RIGHT),
        (Found(54.6, 1.0, AnswerStatus.FOUND), 54.4, AnswerVerdict.WRONG),
        (Found(54.4, 1.0, AnswerStatus.FOUND), math.nan, AnswerVerdict.WRONG),
        (Found(math.nan, 1.0, AnswerStatus.NONE), 54.4, AnswerVerdict.WRONG),
        (Found(math.nan, 1.0, AnswerStatus.NONE), math.nan, AnswerVerdict.RIGHT),
        (Found(math.nan, 1.0, AnswerStatus.TOO_SLOW), 54.4, AnswerVerdict.NO_ANSWER),
        (Found(math.nan, 1.0, AnswerStatus.UNSTABLE), math.nan, AnswerVerdict.NO_ANSWER),
    ):
        assert verdict("first_separation", found, right) is expected


def test_what_is_stored_fits_the_questions() -> None:
    cells = questions.region()
    assert cells.shape == (SIDE, SIDE)
    assert 0.1 < cells.mean() < 0.9  # a region that is all one would ask nothing
    assert questions.reference("first_separation").value == load("first_separation")["time"]
    for name, own in questions.QUESTIONS.items():
        assert questions.reference(name).error < 0.2 * own.enough
    corner = questions.cell(SIDE * SIDE - 1)
    assert (corner.N, corner.Omega) == (questions.REGION_LOADS[1], questions.REGION_SPEEDS[1])


# ----------------------------------------------------------------------------------------------------
# Finding


def test_the_period_is_counted_in_releases() -> None:
    gaps = np.tile([1.0, 2.0, 1.5], 6)
    assert simulated.period(np.cumsum(gaps)) == 3
    assert math.isnan(simulated.period(np.cumsum(gaps + np.linspace(0, 0.1, 18))))  # never the same again
    assert math.isnan(simulated.period(np.array([1.0])))


@pytest.mark.parametrize("rate", [0.02, -0.3])
def test_growth_is_read_from_releases(rate: float) -> None:
    """Stretches that swing at 1.7 Hz beside a steady 15 ms, as at 67 releases a second."""
    times = 100.0 + np.cumsum(np.full(600, 0.015))
    gaps = 0.015 + 1e-5 * np.exp(rate * (times - 100.0)) * np.cos(2 * math.pi * 1.7 * times + 0.3)
    # the fit is exact but for where in its stretch a gap is taken to stand
    assert simulated.growth(100.0 + np.cumsum(gaps)) == pytest.approx(rate, abs=1e-3)
    assert math.isnan(simulated.growth(times[:10]))


def test_a_drift_is_not_taken_for_the_oscillation() -> None:
    """The lowest frequencies were cut off, and the drift was highest at the cut."""
    k = np.arange(400)
    gaps = 0.015 + 1e-6 * np.exp(0.1 * 0.015 * k) * np.cos(0.9 * k) + 1e-5 * np.exp(-0.01 * k)
    # what the drift leaves in the fit, which has none
    assert simulated.growth(np.cumsum(gaps)) == pytest.approx(0.1, abs=0.005)


def onset_of(threshold: float, outcome: RunStatus = RunStatus.FINISHED, seconds: float = 1.0) -> Found:
    def solve(problem: Problem, budget: float) -> MethodResult:
        if budget < seconds:
            return result(problem, [], outcome=RunStatus.TOO_SLOW, seconds=budget)
        return result(problem, [50.0] if problem.parameters.Omega > threshold else [], "separation", outcome, seconds)

    return simulated.onset(solve, 20.0)["onset"]


def test_the_speed_of_onset_is_bracketed() -> None:
    found = onset_of(15.0834)
    assert found.low < 15.0834 <= found.high
    assert found.high - found.low <= questions.ONSET_WITHIN
    assert found.value == pytest.approx(15.0834, abs=questions.ONSET_WITHIN)
    assert found.seconds == 2 + math.ceil(math.log2(1.0 / questions.ONSET_WITHIN))
    assert onset_of(16.0)[2:4] == (AnswerStatus.NONE, "no separation at 15.6 rad/s")
    assert onset_of(14.0)[2:4] == (AnswerStatus.NONE, "a separation already at 14.6 rad/s")
    assert onset_of(15.08, seconds=6.0).status is AnswerStatus.TOO_SLOW
    assert onset_of(16.0, outcome=RunStatus.NON_FINITE).status is AnswerStatus.UNSTABLE


def judged(wrong: int, seconds: float, budget: float = 64.0) -> Found:
    """``wrong`` of the cells that are looked at first are judged wrong."""
    right = questions.region().ravel()
    bad = set(simulated.drawn()[:wrong].tolist())
    return simulated.judged(lambda place: (bool(right[place]) != (place in bad), seconds), right.__getitem__, budget)


def test_cells_are_drawn_where_not_all_can_be_looked_at() -> None:
    whole = judged(wrong=32, seconds=0.01)
    assert (whole.value, whole.low, whole.high, whole.cells) == (1 / 32, 1 / 32, 1 / 32, SIDE * SIDE)
    part = judged(wrong=2, seconds=1.0)
    assert (part.value, part.cells, part.seconds) == (2 / 64, 64, SIDE * SIDE)
    # Wilson's interval of 2 in 64, from its formula
    z, n, share = 1.959964, 64, 2 / 64
    half = z / (1 + z * z / n) * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    assert (part.low, part.high) == pytest.approx((middle - half, middle + half), rel=1e-5)
    few = judged(wrong=0, seconds=8.0)
    assert (few.status, few.seconds) == (AnswerStatus.TOO_SLOW, 8.0 * SIDE * SIDE)


def test_what_breaks_off_has_a_status_and_a_reason() -> None:
    def solve(problem: Problem, budget: float) -> MethodResult:
        return result(problem, [], outcome=RunStatus.STALLED)

    for name in simulated.ASKED:
        for found in simulated.ask(solve, name).values():
            assert found.status is AnswerStatus.STALLED
            assert found.message == "stalled"


# ----------------------------------------------------------------------------------------------------
# Measuring


@pytest.fixture
def dataset(monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    monkeypatch.setitem(METHODS, "late", LATE)
    monkeypatch.setitem(figures.LINES, "late", figures.LINES["RK4"])

    def ask(model):
        count = model["n_diameters"]
        status = AnswerStatus.FOUND if count else AnswerStatus.NONE
        yield "first_separation", Found(51.0 + (8 - count) / 80 if count else math.nan, 0.1, status)

    monkeypatch.setattr(modelled, "ask", ask)
    monkeypatch.setattr(modelled, "onset", lambda p, tol: Found(15.09 + tol, 1e-4 / tol**0.1, AnswerStatus.FOUND))
    monkeypatch.setattr(
        modelled, "growth_rate", lambda p, tol: Found(math.nan, 1e-4 / tol**0.1, AnswerStatus.NONE, "no cycle")
    )
    monkeypatch.setattr(modelled, "RICHEST", {"n_diameters": 8})
    monkeypatch.setattr(measure, "CONTACTS", {"rigid": {}})
    late = measure.measure("late", (1.0, 0.3, 1e-2, 1e-4, 1e-6), asked=("first_separation",))
    return measure.merged([late, measure.measure("cycle"), measure.measure("models", models=(0, 4, 8))])


def column(dataset: xr.Dataset, line: str, name: str) -> list:
    return dataset[name].values[dataset["line"].values == line].tolist()


def test_errors_of_models_are_against_the_richest_and_those_of_methods_against_the_stored(dataset: xr.Dataset) -> None:
    np.testing.assert_allclose(column(dataset, "rigid", "error"), [math.nan, 0.05, 0.0], atol=1e-12)
    assert column(dataset, "rigid", "verdict") == [AnswerVerdict.WRONG, AnswerVerdict.RIGHT, AnswerVerdict.RIGHT]
    exact = questions.reference("first_separation").value
    expected = [math.nan, 54.7 - exact, exact - 54.41, exact - 54.4001]
    np.testing.assert_allclose(column(dataset, "late", "error")[:4], expected, atol=1e-9)
    assert column(dataset, "late", "status") == [AnswerStatus.NONE, *[AnswerStatus.FOUND] * 3, AnswerStatus.TOO_SLOW]
    wrong, right, silent = AnswerVerdict.WRONG, AnswerVerdict.RIGHT, AnswerVerdict.NO_ANSWER
    assert column(dataset, "late", "verdict") == [wrong, wrong, right, right, silent]
    assert "no cycle" in column(dataset, "cycle", "message")


def test_rows_are_in_words(dataset: xr.Dataset) -> None:
    first, *_, last = measure.points(dataset)[["line", "at", "verdict", "status", "message"]].values.tolist()
    assert first == ["late", "tol=1", "wrong", "none", "no separation within 55 s"]
    assert last == ["rigid", "8 diameters", "right", "found", ""]


def test_maps_of_an_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(METHODS, "late", LATE)
    monkeypatch.setitem(figures.LINES, "late", figures.LINES["RK4"])
    monkeypatch.setattr(failure_maps, "_right", lambda count: 54.42 if count < 4 else math.nan)
    found = failure_maps.answer_map("late", (1, 4), (1.0, 0.3, 1e-2, 1e-6, 1e-7))
    right, wrong, silent = AnswerVerdict.RIGHT, AnswerVerdict.WRONG, AnswerVerdict.NO_ANSWER
    assert found["verdict"].values.tolist() == [
        [wrong, wrong, right, silent, silent],
        [right, wrong, wrong, *[silent] * 2],
    ]
    assert math.isnan(found["seconds"].values[0, 4])  # not tried where a coarser one took too long
    assert found["modes"].values.tolist() == [3, 9]
    figure = figures.answer_maps(found, found)
    assert figure.axes[1].get_title(loc="left") == "(b) late"


def test_what_is_asked_is_taken() -> None:
    """The rule broke off at a tolerance that the search for a cycle refuses."""
    assert not any(limits_faults("tol", tol, CYCLE_TOLERANCES) for tol in (*measure.TOLERANCES, modelled.DEFAULT))


@pytest.mark.compiled
def test_the_engine_gives_the_right_answers() -> None:
    """By methods that share no code with it; 1e-9 s and 1e-6 1/s leave room for rounding that grows and for the fit."""

    solve = simulated.by(METHODS["series"], 1e-12)
    found = simulated.first_separation(solve, 10.0) | simulated.after_separation(solve, 6.0)
    found |= simulated.growth_rate(solve, 6.0)
    for name, tolerance in (
        ("first_separation", 1e-9),
        ("separation_rate", 1e-9),
        ("period", 0),
        ("growth_rate", 1e-6),
    ):
        assert found[name].value == pytest.approx(questions.reference(name).value, abs=tolerance)
    # sampled 20,000 times a second
    assert found["disc_range"].value == pytest.approx(questions.reference("disc_range").value, rel=2e-4)
    cycle = modelled.growth_rate(questions.GROWING, 1e-12)
    # what a deviation of finite size adds to the rate at which an infinitesimal one grows
    assert cycle.value == pytest.approx(questions.reference("growth_rate").value, abs=2e-5)
    onset = modelled.onset(questions.SEPARATING, 1e-12)
    assert onset.value == pytest.approx(15.0949, abs=5e-5)
    no_cycle = modelled.onset(questions.SEPARATING.replace(n_diameters=0), 1e-10)
    assert no_cycle.status is AnswerStatus.NONE
    assert no_cycle.message == "no fold from 14.5 to 16 rad/s"
