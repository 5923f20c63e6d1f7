"""Bounds and values of parameters, and of numbers of single modes, as texts with units."""

from typing import Any

import numpy as np
import pytest

import disc_model as dm
from tests.refusals import refusal

IN_HERTZ = 2 * np.pi  # rad/s
ON_THE_CYCLE = dm.Parameters(N=385, Omega=14.9)
ONE_MODE = dm.Disc(diameters=[2], circles=[0], omega=[7600], amplitude=[0.5], damping_ratio=[1e-3])


@pytest.fixture
def case() -> dm.Parameters:
    """A case whose disc is given by one pair of modes."""
    return dm.Parameters(
        N=100, Omega=10, disc=ONE_MODE, r_0=0.1, k=1e6, k_p=1e6, m=0.5, mu_s=0.4, mu_k=0.3
    )


@pytest.mark.parametrize(
    ("name", "bounds", "expected"),
    [
        ("omega_2_0", ("7500 rad/s", "7700 rad/s"), (7500, 7700)),
        ("omega_2_0", ("1190 Hz", "1.22 kHz"), (1190 * IN_HERTZ, 1220 * IN_HERTZ)),
        ("omega_2_0", ("7500", 7700), (7500, 7700)),
        ("amplitude_2_0", ("0.4 kg^-1/2", "0.5 kg^-0.5"), (0.4, 0.5)),
        ("damping_ratio_2_0", ("0.1 %", "0.2 %"), (1e-3, 2e-3)),
        ("mu_s", ("0.35", "0.5"), (0.35, 0.5)),
    ],
)
def test_bounds_may_be_texts_with_units(
    case: dm.Parameters, name: str, bounds: tuple[Any, Any], expected: tuple[float, float]
) -> None:
    found = dm.critical(case, name, bounds, points=3, kind="sliding")
    low, *_, high = found.values
    assert (low, high) == pytest.approx(expected, rel=1e-12)


OF_FREQUENCIES = "the unit of omega must be Hz, kHz or rad/s, not kg"
OF_FORCES = "must be a number in N, or with a unit of its kind"
MASSES = ("3 kg", "5 kg")
of_another_kind = pytest.mark.parametrize(
    ("name", "rule"), [("omega_2_0", OF_FREQUENCIES), ("N", OF_FORCES)]
)


@of_another_kind
def test_critical_values_tell_a_unit_of_another_kind(
    case: dm.Parameters, name: str, rule: str
) -> None:
    with refusal(f"bounds='3 kg': {rule}"):
        dm.critical(case, name, MASSES, kind="sliding")


@of_another_kind
def test_neutral_curves_tell_a_unit_of_another_kind(
    case: dm.Parameters, name: str, rule: str
) -> None:
    plane = {name: MASSES, "mu_s": (0.3, 0.4)}
    with refusal(f"bounds='3 kg': {rule}"):
        dm.neutral_curves(case, plane, [0.35])


@of_another_kind
def test_branches_tell_a_unit_of_another_kind(case: dm.Parameters, name: str, rule: str) -> None:
    with refusal(f"bounds='3 kg': {rule}"):
        dm.continue_cycle(case, name, MASSES)


def test_a_sweep_takes_numbers_of_modes_with_units(case: dm.Parameters) -> None:
    swept = dm.sweep(dm.steady_sliding, case, omega_2_0=["1190 Hz", "7600 rad/s"])
    in_hertz, in_radians = swept["omega_2_0"].values
    assert in_hertz == pytest.approx(1190 * IN_HERTZ, rel=1e-12)
    assert in_radians == 7600


@pytest.mark.parametrize("value", [14.95, "14.95 rad/s", np.float64(14.95)])
def test_a_single_value_needs_no_list(value: Any) -> None:
    branch = dm.continue_cycle(ON_THE_CYCLE, "Omega", (14.85, 15), values=value)
    speeds = branch.values[:, 0]
    assert 14.95 in speeds


def test_no_value_is_refused() -> None:
    with refusal("values=None: must be a finite number, or a list of these"):
        dm.continue_cycle(ON_THE_CYCLE, "Omega", (14.85, 15), values=None)
