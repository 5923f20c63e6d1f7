"""Signs of deviations that follow a pattern over what was set."""

import numpy as np
import pytest

import disc_model as dm
from disc_model.fitting.measured import sign_pattern

SPEEDS = np.linspace(5.0, 30.0, 16)  # rad/s
CASE = dm.Parameters(N=385, Omega=10, c_p=3.0)
ERROR = 0.4  # N
STATED = 2.0  # N, uncertainty, which is often rounded up


def force(case: dm.Parameters) -> float:
    """A force that friction and a damper give."""
    return float(case.mu_k * case.N + case.c_p * case.Omega)


def measured(case: dm.Parameters, seed: int) -> list[dm.Measurement]:
    """Forces of a case at all speeds, with errors, in no order."""
    random = np.random.default_rng(seed)
    found = []
    for speed in random.permutation(SPEEDS):
        value = force(case.replace(Omega=speed)) + ERROR * random.normal()
        found.append(dm.Measurement(force, value, STATED, {"Omega": speed}))
    return found


def note_of(fixed: float, seed: int) -> str:
    """The note of a fit of the damper's value, with a coefficient of friction that may not be that of the
    data."""
    fitted = dm.fit(CASE.replace(mu_k=fixed), ["c_p"], measured(CASE, seed))
    return fitted.note


def test_a_wrong_fixed_parameter_is_seen_by_signs_though_chi_squared_is_small() -> None:
    fitted = dm.fit(CASE.replace(mu_k=CASE.mu_k + 0.01), ["c_p"], measured(CASE, 0))
    assert fitted.consistent
    assert "the model or a fixed parameter may be wrong" in fitted.note
    assert "steps from one setting to the next" in str(fitted)
    assert fitted.to_dataset().attrs["note"] == fitted.note


def test_the_right_fixed_parameter_has_no_pattern() -> None:
    notes = [note_of(CASE.mu_k, seed) for seed in range(20)]
    assert notes == [""] * 20


@pytest.mark.parametrize(
    ("deviations", "changes", "steps"),
    [
        ([1.0, 1.0, -1.0, -1.0], 1, 3),
        ([1.0, 0.01, 1.0, 1.0], 0, 2),
        ([1e-9, -1e-9, 1e-9, 1e-9], 0, 0),
    ],
)
def test_changes_of_sign_are_counted_but_for_rounding(
    deviations: list[float], changes: int, steps: int
) -> None:
    measurements = [dm.Measurement(force, 1.0, 1.0, {"Omega": speed}) for speed in range(4)]
    assert sign_pattern(measurements, np.array(deviations)) == (changes, steps)


def test_quantities_and_settings_of_words_are_not_mixed() -> None:
    measurements = [
        dm.Measurement("period", 1.0, 1.0, {"Omega": 1.0}),
        dm.Measurement("slip_time", 1.0, 1.0, {"Omega": 2.0}),
        dm.Measurement("period", 1.0, 1.0),
        dm.Measurement("period", 1.0, 1.0, {"normalization": "orthonormal"}),
    ]
    assert sign_pattern(measurements, np.ones(4)).steps == 0


def test_a_fit_without_further_measurements_is_called_untested() -> None:
    one = [dm.Measurement(force, 120.0, ERROR, {"Omega": 10.0})]
    said = dict(dm.fit(CASE, ["c_p"], one).summary())
    assert said["consistent"].startswith("yes, but nothing tests it")
