"""Questions that methods are compared by: replies, and verdicts on them."""

import math

import numpy as np
import pytest

from benchmarks import answers, own_answers, replies
from benchmarks.methods import METHODS
from benchmarks.methods.integrators import MethodResult, Problem, RunStatus
from benchmarks.questions import QUESTIONS, AnswerStatus, AnswerVerdict, Reply, reference, verdict
from benchmarks.scenes import stored
from disc_model.units import CYCLE_TOLERANCES, limits_faults

RIGHT, WRONG, SILENT = AnswerVerdict


@pytest.mark.parametrize(
    ("value", "status", "right", "expected"),
    [
        (54.45, AnswerStatus.FOUND, 54.4, RIGHT),
        (54.6, AnswerStatus.FOUND, 54.4, WRONG),
        (54.4, AnswerStatus.FOUND, math.nan, WRONG),
        (math.nan, AnswerStatus.NONE, 54.4, WRONG),
        (math.nan, AnswerStatus.NONE, math.nan, RIGHT),
        (math.nan, AnswerStatus.TOO_SLOW, 54.4, SILENT),
    ],
)
def test_to_deny_what_there_is_is_wrong_and_to_give_up_is_not(
    value: float, status: AnswerStatus, right: float, expected: AnswerVerdict
) -> None:
    assert verdict("first_separation", Reply(value, 1.0, status), right) is expected


# ---- The engine


@pytest.mark.compiled
def test_the_engine_gives_the_right_answers() -> None:
    """Those were found by methods that share no code with it."""
    solve = replies.setting_of(METHODS["series"], 1e-12)
    found = {
        **replies.first_separation(solve, 10.0),
        **replies.after_separation(solve, 6.0),
        **replies.growth_rate(solve, 6.0),
    }
    # room for rounding that grows, and for the fit of the growth rate
    tolerances = {
        "first_separation": 1e-9,
        "separation_rate": 1e-9,
        "period": 0,
        "growth_rate": 1e-6,
    }
    for name, tolerance in tolerances.items():
        assert found[name].value == pytest.approx(reference(name).value, abs=tolerance)
    # sampled 20,000 times a second
    assert found["disc_range"].value == pytest.approx(reference("disc_range").value, rel=2e-4)


@pytest.mark.parametrize("tol", [*answers.CYCLE_SETTINGS, own_answers.DEFAULT])
def test_the_search_for_a_cycle_takes_the_tolerances_that_it_is_asked_with(tol: float) -> None:
    """The rule broke off at one that it refuses."""
    assert not limits_faults("tol", tol, CYCLE_TOLERANCES)


@pytest.mark.compiled
def test_models_answer_by_their_own_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the modes of the references all is right."""
    monkeypatch.setattr(own_answers, "RICHEST", {})
    found = own_answers.ask_model({})
    assert found.pop("region").value == 0
    assert QUESTIONS.keys() - found == {"region"}
    for name, reply in found.items():
        assert verdict(name, reply, reference(name).value) == RIGHT
    # what a deviation of finite size adds to the rate at which an infinitesimal one grows
    growth = reference("growth_rate").value
    assert found["growth_rate"].value == pytest.approx(growth, abs=2e-5)
    assert found["onset"].value == pytest.approx(15.0949, abs=5e-5)


@pytest.mark.compiled
def test_without_pairs_of_modes_nothing_ever_grows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_answers, "RICHEST", {})
    found = own_answers.ask_model({"n_diameters": 0})
    assert found["onset"].status == AnswerStatus.NONE
    assert found["onset"].message == "no fold from 14.5 to 16 rad/s"
    assert found["period"].status == AnswerStatus.NONE
    assert found["period"].message == "no separation within 400 s"
    assert found["region"].value > 0


@pytest.mark.compiled
def test_a_case_without_a_cycle_has_no_onset() -> None:
    reply = own_answers.cycle_onset(replies.SEPARATING.replace(N=0), 1e-10)
    assert "no cycle to follow" in reply.message


# ---- A made-up method


def separating_above(speed: float) -> replies.Solve:
    """Return a method that takes 0.1 s a run, and finds a separation from a speed on."""

    def solve(problem: Problem, budget: float) -> MethodResult:
        late = budget <= 0.1
        kinds: tuple[str, ...] = ()
        if problem.parameters.Omega >= speed and not late:
            kinds = ("separation",)
        if late:
            outcome = RunStatus.TOO_SLOW
        else:
            outcome = RunStatus.FINISHED
        return MethodResult(np.ones(len(kinds)), kinds, problem.start, 0.1, 1, outcome)

    return solve


def test_the_onset_is_enclosed_between_two_speeds() -> None:
    found = replies.onset(separating_above(15.1), 12.0)["onset"]
    assert found.low < 15.1 <= found.high <= found.low + replies.ONSET_WITHIN
    assert found.value == pytest.approx((found.low + found.high) / 2)
    assert found.seconds == pytest.approx(0.8)  # two ends, six halves


@pytest.mark.parametrize(
    ("speed", "message"),
    [(16.0, "no separation at 15.6 rad/s"), (14.0, "a separation already at 14.6 rad/s")],
)
def test_an_onset_outside_the_interval_is_none(speed: float, message: str) -> None:
    found = replies.onset(separating_above(speed), 12.0)["onset"]
    assert found.status == AnswerStatus.NONE
    assert found.message == message


def test_an_onset_that_takes_too_long_is_given_up_with_its_bounds() -> None:
    found = replies.onset(separating_above(15.1), 0.45)["onset"]
    assert found.status == AnswerStatus.TOO_SLOW
    assert found.high - found.low == pytest.approx(0.25)


STORED = np.array([[*row] for row in stored("answers")["region"]]) == "1"
SEPARATING = np.linspace(14, 34, 32) >= 24
WRONG_SHARE = float(np.mean(STORED ^ SEPARATING))
"""Share of cells that a method which separates from 24 rad/s on judges wrongly."""


@pytest.mark.parametrize(
    ("budget", "cells", "status"),
    [
        (0.05, 0, AnswerStatus.TOO_SLOW),
        (1.0, 4, AnswerStatus.TOO_SLOW),
        (8.0, 64, AnswerStatus.FOUND),
        (200.0, 1024, AnswerStatus.FOUND),
    ],
)
def test_a_region_is_judged_by_as_many_cells_as_the_budget_allows(
    budget: float, cells: int, status: AnswerStatus
) -> None:
    found = replies.region(separating_above(24.0), budget)["region"]
    assert found.status == status
    assert found.cells == cells
    if cells:
        # 0.1 s for each of the 1024 cells
        assert found.seconds == pytest.approx(102.4)


def test_a_region_that_is_judged_in_part_has_bounds() -> None:
    some = replies.region(separating_above(24.0), 8.0)["region"]
    assert some.low < WRONG_SHARE < some.high
    whole = replies.region(separating_above(24.0), 200.0)["region"]
    assert whole.value == whole.low == whole.high == pytest.approx(WRONG_SHARE)


@pytest.mark.parametrize("question", replies.ASKED)
def test_no_question_is_answered_by_a_method_that_gives_up(question: str) -> None:
    function, _ = replies.ASKED[question]
    found = function(separating_above(0), 0.05)
    assert {reply.status for reply in found.values()} == {AnswerStatus.TOO_SLOW}


@pytest.mark.parametrize("releases", [np.arange(9.0), np.arange(99.0)], ids=["few", "regular"])
def test_no_growth_is_found_in_releases_that_do_not_oscillate(releases: np.ndarray) -> None:
    assert math.isnan(replies.growth(releases))
