"""Fits end at a minimum near the start, name the values beyond which there is no case, and doubt only what
is not determined."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import OptimizeResult

import disc_model as dm
from disc_model.fitting.arguments import limits_in_si
from disc_model.fitting.result import STILL_FALLING
from disc_model.fitting.search import Search

CASE = dm.Parameters(N=385, Omega=14)
SPEEDS = (12.0, 12.5, 13.0, 13.5, 14.0, 14.5)
BRAKE = dm.Disc(
    diameters=[0, 1, 2],
    omega=[5837, 3462, 7615],
    amplitude=[0.431, 0.553, 0.5415],
    damping_ratio=[0.001, 0.001, 0.0011],
    tangential=[0, -0.25, -0.13],
)
SQUEAL = dm.Parameters(
    N=8000,
    Omega=80,
    disc=BRAKE,
    r_0=0.1,
    k=1e6,
    k_p=1e6,
    m=0.5,
    c_p=50,
    mu_s=0.45,
    mu_k=0.35,
    friction_offset="surface",
)


def difference(case: dm.Parameters) -> float:
    """A quantity that two parameters determine only by their difference."""
    return case.mu_s - case.mu_k


def cycles(truth: dm.Parameters, speeds: Sequence[float] = SPEEDS) -> list[dm.Measurement]:
    """Exact periods and shares of stick of a case at some speeds."""
    found = []
    for speed in speeds:
        cycle = dm.floquet(truth.replace(Omega=speed))
        at = {"Omega": speed}
        found.append(dm.Measurement("period", cycle.period, 2e-5, at))
        found.append(dm.Measurement("stick_fraction", cycle.stick_fraction, 2e-3, at))
    return found


def test_a_parameter_that_runs_to_its_last_value_leaves_no_other_behind() -> None:
    """The damping ratio was 3.85 standard deviations off, since m had run to 2e-11 kg and shortened all
    steps; no bound was named, and the measured ratio was said not to be determined."""
    measured = {
        "damping_ratio_2_0": (0.0015, 0.0001),
        "coupled_frequency_2": (890, 1),
        "sliding_frequency": (900, 2),
    }
    found = dm.fit(SQUEAL, ["damping_ratio_2_0", "m"], measured)
    assert found.converged
    assert found.parameters["damping_ratio_2_0"].value == pytest.approx(0.0015, abs=1e-6)
    assert found.at_bounds == {"m": 0.0}
    assert found.indistinct == ()
    alone = dm.fit(SQUEAL.replace(m=found.case.m), ["damping_ratio_2_0"], measured)
    assert found.chi_squared == pytest.approx(alone.chi_squared, abs=0.01)


def stopped(search: Search, x: np.ndarray, *_: object) -> OptimizeResult:
    """The end of a search that stays where it begins."""
    fun = search.deviations(x)
    return OptimizeResult(
        x=x,
        fun=fun,
        jac=search.slopes(x),
        cost=0.5 * float(fun @ fun),
        active_mask=np.zeros(len(x), int),
        success=True,
        status=2,
        message="`ftol` termination condition is satisfied.",
    )


def test_a_search_that_has_not_ended_at_a_minimum_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was said to have converged."""
    monkeypatch.setattr(Search, "run", stopped)
    measured = {"frequency_0_0": (500.0, 0.5), "frequency_2_0": (600.0, 0.5)}
    case = dm.Parameters(N=385, Omega=15, n_diameters=2, normalization="orthonormal")
    monkeypatch.setattr("disc_model.fitting.search.ROUNDS", 1)
    found = dm.fit(case, ["E"], measured)
    assert not found.converged
    assert found.message == STILL_FALLING
    assert found.indistinct == ()
    assert found.doubt.startswith("the search has not converged: chi squared still falls")


@pytest.mark.compiled
@pytest.mark.parametrize("speeds", [SPEEDS[1::2], pytest.param(SPEEDS, marks=pytest.mark.slow)])
def test_an_outlier_does_not_make_parameters_undetermined(speeds: Sequence[float]) -> None:
    """It was said that the measurements do not determine mu_s and k_p apart, and to measure more; chi
    squared rises faster there than predictions that are linear would have it."""
    truth = CASE.replace(mu_s=0.42, k_p=19000)
    outlier = dm.Measurement("period", 0.0154, 2e-5, {"Omega": 14.2})
    found = dm.fit(CASE, ["mu_s", "k_p"], [*cycles(truth, speeds), outlier])
    assert found.misses
    assert found.indistinct == ()
    assert "measure more" not in found.doubt
    assert "period (Omega=14.2) deviates most" in found.doubt


@pytest.mark.compiled
def test_a_wrong_model_does_not_make_a_parameter_undetermined() -> None:
    truth = CASE.replace(mu_s=0.42, k_p=19000)
    found = dm.fit(CASE.replace(m=0.3), ["mu_s"], cycles(truth))
    assert found.share_as_bad < 1e-3
    assert found.indistinct == ()
    assert "measure more" not in found.doubt


@pytest.mark.compiled
@pytest.mark.parametrize(("name", "length", "bound"), [("mu_s", 0.01, 0.24), ("mu_k", 0.003, 0.4)])
def test_the_last_value_of_any_case_is_that_of_the_other_coefficient(
    name: str, length: float, bound: float
) -> None:
    """It was said to be 0."""
    found = dm.fit(CASE, [name], {"slip_length": (length, 1e-4)})
    assert found.at_bounds == {name: bound}
    assert f"passes {bound}, beyond which there is no case" in found.doubt


def test_a_bound_beyond_the_last_value_of_any_case_is_not_the_one_named() -> None:
    def twice(case: dm.Parameters) -> float:
        return 2 * case.mu_s

    measured = [dm.Measurement(twice, 0.4, 1e-3)]
    found = dm.fit(CASE, ["mu_s"], measured, bounds={"mu_s": (0.1, 1.0)})
    assert found.at_bounds == {"mu_s": 0.24}


def measured_difference(value: float, uncertainty: float = 2.0) -> list[dm.Measurement]:
    """Differences of coefficients, and their product, which is hardly known."""

    def product(case: dm.Parameters) -> float:
        return case.mu_s * case.mu_k

    return [dm.Measurement(difference, value, 7e-4), dm.Measurement(product, 1.7, uncertainty)]


def test_a_fit_stays_near_its_start_in_directions_that_are_not_determined() -> None:
    """It ended at mu_s = 1.4, though the start was as good."""
    found = dm.fit(CASE, ["mu_s", "mu_k"], measured_difference(0.18))
    assert found.indistinct == ("mu_s", "mu_k")
    assert found.case.mu_s == pytest.approx(0.4, abs=0.03)
    assert found.case.mu_k == pytest.approx(0.24, abs=0.03)
    assert found.case.mu_s - found.case.mu_k == pytest.approx(0.18, abs=1e-5)
    known = found.determined["mu_s - mu_k"]
    assert known.value == pytest.approx(0.18, abs=1e-5)
    assert known.deviation == pytest.approx(7e-4, rel=0.01)


def test_a_start_within_the_uncertainty_fits_as_well() -> None:
    """It ended at mu_s = 1.4, since the start is 1.6 standard deviations of the product away."""
    found = dm.fit(CASE, ["mu_s", "mu_k"], measured_difference(0.18, uncertainty=1.0))
    assert found.indistinct == ("mu_s", "mu_k")
    assert found.case.mu_s == pytest.approx(0.4, abs=0.03)
    assert found.case.mu_k == pytest.approx(0.24, abs=0.03)


def test_a_fit_goes_from_its_start_no_farther_than_measurements_ask() -> None:
    """It ended at mu_s = 1.4, although chi squared is below 3.84 from mu_s = 0.95 on."""
    found = dm.fit(CASE, ["mu_s", "mu_k"], measured_difference(0.18, uncertainty=0.5))
    assert found.indistinct == ("mu_s", "mu_k")
    assert found.case.mu_s == pytest.approx(0.95, abs=0.07)
    assert found.chi_squared < 3.85
    assert found.case.mu_s - found.case.mu_k == pytest.approx(0.18, abs=1e-3)


def test_a_combination_is_known_beside_a_large_chi_squared() -> None:
    measured = [*measured_difference(0.18), dm.Measurement(difference, 0.15, 7e-4)]
    found = dm.fit(CASE, ["mu_s", "mu_k"], measured)
    assert found.share_as_bad < 1e-3
    assert found.indistinct == ("mu_s", "mu_k")
    assert found.case.mu_s == pytest.approx(0.4, abs=0.03)
    assert [*found.determined] == ["mu_s - mu_k"]
    for words in (
        "determine mu_s and mu_k apart",
        "model, fixed parameters or uncertainties may be wrong",
    ):
        assert words in found.doubt
        assert words in repr(found)


def test_a_tangential_amplitude_can_be_fitted() -> None:
    """It was no number of the case, unlike the amplitude."""

    def tangential(case: dm.Parameters) -> float:
        return case.disc.tangential[2]

    measured = [dm.Measurement(tangential, -0.2, 1e-3)]
    found = dm.fit(SQUEAL, ["tangential_2_0"], measured)
    assert found.case.disc.tangential == pytest.approx((0, -0.25, -0.2))
    assert found.to_dataset()["unit"].item() == "kg^-1/2"
    set_there = [dm.Measurement(tangential, -0.2, 1e-3, at={"damping_ratio_0_0": 0.002})]
    setting = dm.fit(SQUEAL, ["tangential_2_0"], set_there).to_dataset()["damping_ratio_0_0"]
    assert setting.units == "1"
    assert setting.long_name == "damping ratio of the mode of 0 nodal diameters and 0 circles"
    assert "tangential_0_0" not in SQUEAL.numbers
    with pytest.raises(dm.ParameterError, match="friction_offset must be 'surface'"):
        dm.fit(SQUEAL.replace(friction_offset=0), ["tangential_2_0"], measured)


@pytest.mark.parametrize(
    ("name", "bounds", "ends"),
    [
        ("omega_2_0", ("7000 rad/s", "8000"), (7000.0, 8000.0)),
        ("tangential_2_0", ("-0.2", "-0.1 kg^-1/2"), (-0.2, -0.1)),
        ("amplitude_2_0", ("0.5 kg^-1/2", "0.6 kg^-1/2"), (0.5, 0.6)),
        ("damping_ratio_2_0", ("0.01 %", "1 %"), (1e-4, 1e-2)),
        ("mu_s", ("0.4", 0.5), (0.4, 0.5)),
    ],
)
def test_bounds_may_be_texts(name: str, bounds: tuple, ends: tuple[float, float]) -> None:
    """Numbers of a disc were refused as not ascending."""
    assert limits_in_si([name], {name: bounds}) == {name: ends}
    measured = [dm.Measurement(lambda case: case.numbers[name], SQUEAL.numbers[name], 1e-3)]
    assert dm.fit(SQUEAL, [name], measured, bounds={name: bounds}).converged


@pytest.mark.parametrize(
    ("name", "bounds", "message"),
    [
        ("omega_2_0", ("1 m", 8000), "bounds.omega_2_0.0='1 m': the unit of omega must be Hz, kHz"),
        (
            "amplitude_2_0",
            (0.1, "1 m"),
            "bounds.amplitude_2_0.1='1 m': the unit of amplitude must be",
        ),
        ("mu_s", ("0.1 kg", 1), "bounds.mu_s.0='0.1 kg': must be a number without a unit"),
        ("mu_s", (0.1, "much"), "bounds.mu_s.1='much': must be a number"),
    ],
)
def test_bounds_in_other_units_are_refused_by_the_reason(
    name: str, bounds: tuple, message: str
) -> None:
    measured = [dm.Measurement(difference, 0.1, 1e-3)]
    with pytest.raises(dm.ParameterError) as error:
        dm.fit(SQUEAL, [name], measured, bounds={name: bounds})
    assert message in str(error.value)


def test_the_share_of_fits_as_bad_follows_from_chi_squared() -> None:
    """An unlucky draw of the right model was called wrong."""
    found = dm.fit(
        CASE, ["mu_s"], [dm.Measurement(difference, value, 1e-2) for value in (0.1, 0.2)]
    )
    assert found.share_as_bad < 1e-6
    unlucky = replace(found, chi_squared=11.5)
    assert unlucky.share_as_bad == pytest.approx(7e-4, rel=0.01)
    share = "may be wrong, chi squared is 11.5 times its degrees of freedom: 0.07 % of fits of the right"
    assert share in unlucky.doubt


def test_parameters_that_act_alike_are_named_in_front_of_a_gap() -> None:
    """Only the missing cycles were said, to which the search had drifted along a valley."""

    def ending(case: dm.Parameters) -> float:
        if case.mu_s > 0.45:
            raise dm.ParameterError("mu_s", "too large")
        return difference(case)

    measured = [dm.Measurement(ending, value, 1e-3) for value in (0.4, 0.401)]
    found = dm.fit(CASE.replace(mu_s=0.44), ["mu_s", "mu_k"], measured)
    assert found.gap is not None
    assert "determine mu_s and mu_k apart, only mu_s - mu_k: fix one of them" in found.doubt
    assert "determine" not in found.note


@pytest.mark.compiled
@pytest.mark.slow
def test_a_search_along_a_valley_to_missing_cycles_names_what_acts_alike() -> None:
    rng = np.random.default_rng(3)
    truth = CASE.replace(mu_s=0.43, k_p=21e3)
    measured = []
    for speed in (11.5, 12.0, 13.0, 14.0, 14.5):
        cycle = dm.floquet(truth.replace(Omega=speed))
        at = {"Omega": speed}
        period = cycle.period + 2e-5 * rng.normal()
        measured.append(dm.Measurement("period", period, 2e-5, at))
        slip_time = cycle.slip_time + 2e-5 * rng.normal()
        measured.append(dm.Measurement("slip_time", slip_time, 2e-5, at))
    found = dm.fit(CASE, ["mu_s", "mu_k", "k_p"], measured)
    assert found.gap is not None
    assert "determine mu_s and mu_k apart, only mu_s - mu_k: fix one of them" in found.doubt
    assert found.determined["mu_s - mu_k"].value == pytest.approx(0.1904, abs=1e-3)


def friction_times() -> list[dm.Measurement]:
    """Periods and times of slip that determine the difference of the coefficients of friction alone, with errors."""
    rng = np.random.default_rng(1)
    truth = CASE.replace(mu_s=0.43, mu_k=0.3, k_p=21e3)
    found = []
    for speed in (11.5, 12.0, 13.0, 14.0, 14.5):
        cycle = dm.floquet(truth.replace(Omega=speed))
        at = {"Omega": speed}
        period = cycle.period + 2e-5 * rng.normal()
        found.append(dm.Measurement("period", period, 2e-5, at))
        slip_time = cycle.slip_time + 2e-5 * rng.normal()
        found.append(dm.Measurement("slip_time", slip_time, 2e-5, at))
    return found


@pytest.mark.compiled
def test_a_determined_parameter_keeps_its_interval_beside_others() -> None:
    """Its end was said to be no case, at mu_s = -0.71, along the direction that is not determined."""
    times = friction_times()
    found = dm.fit(CASE, ["mu_s", "mu_k", "k_p"], times)
    alone = dm.fit(CASE.replace(mu_s=0.43), ["mu_k", "k_p"], times).parameters["k_p"]
    stiffness = found.parameters["k_p"]
    assert found.indistinct == ("mu_s", "mu_k")
    assert found.outside == {}
    assert stiffness.value == pytest.approx(alone.value, abs=0.1 * alone.deviation)
    assert stiffness.deviation == pytest.approx(alone.deviation, rel=0.1)
    assert np.isfinite([stiffness.low, stiffness.high]).all()
    assert "k_p=20984.7 ± 21;" in repr(found)
    assert "mu_s=0.377974, mu_k" in repr(found)
    assert "none of mu_s and mu_k" in dict(found.summary())["intervals"]
    assert found.note.startswith("the measurements determine mu_s - mu_k = 0.13004 ± ")


@pytest.mark.compiled
def test_one_parameter_that_is_not_determined_leaves_no_direction() -> None:
    case = dm.Parameters(N=375, Omega=7.35)
    measured = {"period": (dm.floquet(case).period, 1e-6)}
    found = dm.fit(case, ["mu_s"], measured)
    assert found.indistinct == ("mu_s",)
    assert np.isnan(found.parameters["mu_s"].low)
