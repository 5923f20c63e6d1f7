"""What the benchmark makes of its methods: costs at equal error, verdicts on answers, pages."""

import math

import numpy as np
import pandas as pd
import pytest

from benchmarks import answers, figures, pages
from benchmarks.failure_maps import failure_map
from benchmarks.methods import METHODS
from benchmarks.methods.integrators import MethodResult, Problem, RunStatus
from benchmarks.work_precision import cost_at, costs_of_methods, work_precision
from disc_model.errors import DiscModelError

LINE = pd.DataFrame(
    # the second setting is dearer and less accurate than the first
    {"further": [1.0, 2.0, 4.0, 16.0], "event_error": [1e-4, 1e-3, 1e-6, 1e-10]}
)


@pytest.mark.parametrize(
    ("wanted", "cost"),
    [(1e-2, 1.0), (1e-4, 1.0), (1e-5, 2.0), (1e-6, 4.0), (1e-8, 8.0), (1e-11, math.nan)],
)
def test_costs_are_interpolated_along_the_settings_that_pay(wanted: float, cost: float) -> None:
    assert cost_at(LINE, wanted) == pytest.approx(cost, nan_ok=True)


@pytest.mark.parametrize(
    ("found", "reason", "verdict"),
    [
        (54.45, "", "right"),
        (54.6, "", "wrong"),
        (math.nan, "", "wrong"),
        (math.nan, "too_slow", "no answer"),
    ],
)
def test_to_deny_what_there_is_is_wrong_and_to_give_up_is_not(
    found: float, reason: str, verdict: str
) -> None:
    assert answers.judged("first_separation", found, reason)["verdict"] == verdict


@pytest.mark.parametrize("rate", [-0.3, 0.0, 0.2])
def test_a_growth_rate_is_found_from_releases(rate: float) -> None:
    t = np.arange(0.0, 10.0, 0.015)
    releases = t + 1e-6 * np.exp(rate * t) * np.cos(9.0 * t)
    assert answers.growth(releases) == pytest.approx(rate, abs=2e-3)
    assert math.isnan(answers.growth(t[:20]))


def separating_above(speed: float):  # type: ignore[no-untyped-def]
    """Return a method that takes 0.1 s a run, and finds a separation from a speed on."""

    def solve(problem: Problem, budget: float) -> MethodResult:
        late = budget <= 0.1
        kinds = ("separation",) if problem.parameters.Omega >= speed and not late else ()
        outcome = RunStatus.TOO_SLOW if late else RunStatus.FINISHED
        return MethodResult(np.ones(len(kinds)), kinds, problem.start, 0.1, outcome)

    return solve


def test_the_onset_is_enclosed_between_two_speeds() -> None:
    found, seconds = answers.onset(separating_above(15.1), 12.0)
    assert found["onset"] == pytest.approx(15.1, abs=answers.ONSET_WITHIN / 2)
    assert seconds == pytest.approx(0.8)  # two ends, six halves
    assert math.isnan(answers.onset(separating_above(16.0), 12.0)[0]["onset"])
    with pytest.raises(answers.Broken):
        answers.onset(separating_above(15.1), 0.45)


def test_the_engine_gives_the_right_answers() -> None:
    """Those were found by methods that share no code with it."""
    found = answers.answers("series", (1e-12,)).set_index("question")
    assert {*found["verdict"]} == {"right"}
    assert found.loc["first_separation", "error"] < 1e-9
    assert found.loc["growth_rate", "error"] < 1e-6
    assert {*answers.answers("cycle", (1e-10,))["verdict"]} == {"right"}


@pytest.mark.slow
def test_a_run_makes_figures_and_pages() -> None:
    settings = {
        "stick_slip": {"series": (1e-8, 1e-10), "RK4": (2e-5, 1e-5)},
        "separating": {"series": (1e-10,)},
    }
    points = work_precision(settings, rounds=1)
    costs = costs_of_methods(points)
    assert costs.loc["series", "stick_slip"] == 1.0
    assert costs.loc["RK4", "stick_slip"] > 3.0

    known = pages.passages(points)
    page = pages.filled("all: <!-- bench speed -->old<!-- end -->.", known)
    assert f"| {METHODS['RK4'].label} |" in page
    assert "old" not in page
    with pytest.raises(DiscModelError, match="sped"):
        pages.filled("<!-- bench sped --><!-- end -->", known)

    drawn = figures.draw("overview", points)
    assert len(drawn.axes) == 4
    cells = failure_map("RK4", "separating", (1, 2), (2e-3, 1e-4))
    assert len(figures.draw("failure_maps", cells).axes) == 1
    replies = answers.answers("series", (1e-8,))
    assert len(figures.draw("answers", replies).axes) == 4
