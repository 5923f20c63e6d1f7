"""What becomes of a motion."""

import math
import sys

import numpy as np
import pytest

from disc_model.data.variables import WORDS, Outcome, flag_names
from disc_model.parameters import Parameters
from disc_model.stability.follower import OutcomeResult
from disc_model.studies.quantities.outcome import HorizonOutcome
from disc_model.studies.quantity import Point
from tests.stability.test_attractor import stretch
from tests.studies.conftest import SMALL, compute, computed


def outcomes(cases: list[Parameters], **options: float) -> tuple[dict[str, np.ndarray], list[str]]:
    table = compute(HorizonOutcome(**{"horizon": 1000, **options}), map(Point, cases))
    words = HorizonOutcome.COLUMNS["outcome"].flags
    return table.arrays, [words[i] for i in table.arrays["outcome"]]


def test_steps_that_run_out_are_a_status(monkeypatch: pytest.MonkeyPatch) -> None:
    # the package shows the function under the module's name
    monkeypatch.setattr(sys.modules["disc_model.simulation.run"], "MOST_STEPS", 100)
    arrays, words = outcomes([Parameters(N=300, Omega=20)], horizon=20)
    assert words == ["failed"]
    assert WORDS["point_statuses"][arrays["status"][0]] == "step_limit"


def test_outcomes_of_a_damped_and_of_a_separating_motion() -> None:
    options = {"horizon": 3.0, "evaluation_time": 0.05, "after_separation": 0.05, "tol": 1e-9}
    base = SMALL | {"c": 20.0, "D_star": 1e-3}
    damped = computed(
        quantity="outcome", options=options, base=base, axes={"N": [200], "Omega": [20]}
    ).squeeze()
    assert flag_names(damped["outcome"]) == "stick_slip"
    assert damped["left_at"] == damped["time_reached"] < 3.0
    assert 0 < damped["cycle_distance"] < 0.1
    # which says nothing of how long the motion takes to settle
    assert "settl" not in damped["left_at"].attrs["long_name"]
    # the late stretch is the cycle itself
    assert damped["stick_fraction"] + damped["slip_fraction"] == pytest.approx(1)
    base = SMALL | {"mu_s": 1.4, "mu_k": 0.2, "k": 0}
    apart = computed(
        quantity="outcome", options=options, base=base, axes={"N": [700], "Omega": [50]}
    ).squeeze()
    assert flag_names(apart["outcome"]) == "separation"
    assert apart["time_reached"] == pytest.approx(float(apart["first_separation"]) + 0.05)
    assert np.isnan(apart["left_at"])
    assert apart["P_min"] == 0


def test_the_rate_of_the_residual_is_that_of_its_natural_logarithm(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Over the last four checks of the motion, which come at growing intervals."""
    times = [5.0, 15.0, 35.0, 75.0, 155.0]
    changes = [1.0, *(1e-3 * math.exp(0.02 * time) for time in times[1:])]

    def find_outcome(p: Parameters, horizon: float, **_: object) -> OutcomeResult:
        segment = stretch(separation_rate=0, separation_fraction=0)
        known = {"changes": changes, "times": times, "segment": segment}
        return OutcomeResult(Outcome.GROWING, horizon, time=horizon, **known)

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", find_outcome)
    arrays, words = outcomes([Parameters(N=300, Omega=20)], horizon=200)
    assert words == ["growing"]
    assert arrays["return_map_residual_rate"][0] == pytest.approx(0.02, rel=1e-9)
    assert arrays["return_map_residual"][0] == changes[-1]
    # nor does one at which nothing had changed
    last = changes[-1]
    changes[-1] = 0.0
    arrays, _ = outcomes([Parameters(N=300, Omega=20)], horizon=200)
    assert np.isnan(arrays["return_map_residual_rate"][0])
    assert arrays["return_map_residual"][0] == 0.0
    changes[-1] = last
    # three checks give no rate
    del times[3:], changes[3:]
    arrays, _ = outcomes([Parameters(N=300, Omega=20)], horizon=200)
    assert np.isnan(arrays["return_map_residual_rate"][0])


@pytest.mark.parametrize(("time", "is_left"), [(40.0, True), (200.0, False)])
def test_a_motion_that_is_left_before_the_horizon_says_when(
    time: float, is_left: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    segment = stretch(separation_rate=0, separation_fraction=0)

    def find_outcome(p: Parameters, horizon: float, **_: object) -> OutcomeResult:
        return OutcomeResult(Outcome.STICK_SLIP, horizon, time=time, segment=segment, distance=0.02)

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", find_outcome)
    arrays, words = outcomes([Parameters(N=300, Omega=20)], horizon=200)
    assert words == ["stick_slip"]
    assert np.isfinite(arrays["left_at"][0]) == is_left
    assert arrays["time_reached"][0] == time
    assert arrays["cycle_distance"][0] == 0.02
    assert arrays["P_max"][0] == segment.P_max
    assert arrays["slip_fraction"][0] == segment.slip_fraction


@pytest.mark.parametrize(("extrapolated", "timed"), [(False, 40.0), (True, np.nan)])
def test_a_separation_after_an_extrapolation_has_no_time(
    extrapolated: bool, timed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is known to a hundredth only."""
    segment = stretch(separation_rate=0, separation_fraction=0)
    known = OutcomeResult(
        Outcome.OTHER_CYCLE, first_separation=40.0, segment=segment, extrapolated=extrapolated
    )
    monkeypatch.setattr("disc_model.stability.follower.find_outcome", lambda *_, **__: known)
    arrays, words = outcomes([Parameters(N=300, Omega=20)], horizon=200)
    assert words == ["other_cycle"]
    np.testing.assert_array_equal(arrays["first_separation"], [timed])
