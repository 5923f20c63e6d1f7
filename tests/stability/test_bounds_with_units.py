"""Bounds and values of parameters, and of numbers of single modes, as texts with units."""

from typing import Any

import numpy as np
import pytest

import disc_model as dm
from tests.refusals import refusal


def disc_of_one_mode() -> dm.Parameters:
    """A case whose disc is given by one pair of modes."""
    disc = dm.Disc(diameters=[2], circles=[0], omega=[7600], amplitude=[0.5], damping_ratio=[1e-3])
    pad = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "m": 0.5, "mu_s": 0.4, "mu_k": 0.3}
    return dm.Parameters(N=100, Omega=10, disc=disc, **pad)


@pytest.mark.parametrize(
    ("name", "bounds", "expected"),
    [
        ("omega_2_0", ("7500 rad/s", "7700 rad/s"), (7500, 7700)),
        ("omega_2_0", ("1190 Hz", "1.22 kHz"), (2 * np.pi * 1190, 2 * np.pi * 1220)),
        ("omega_2_0", ("7500", 7700), (7500, 7700)),
        ("amplitude_2_0", ("0.4 kg^-1/2", "0.5 kg^-0.5"), (0.4, 0.5)),
        ("damping_ratio_2_0", ("0.1 %", "0.2 %"), (1e-3, 2e-3)),
        ("mu_s", ("0.35", "0.5"), (0.35, 0.5)),
    ],
)
def test_bounds_may_be_texts_with_units(
    name: str, bounds: tuple[Any, Any], expected: tuple[float, float]
) -> None:
    found = dm.critical(disc_of_one_mode(), name, bounds, points=3, kind="sliding")
    np.testing.assert_allclose(found.values[[0, -1]], expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("omega_2_0", "the unit of omega must be Hz, kHz or rad/s, not kg"),
        ("N", "must be a number in N, or with a unit of its kind"),
    ],
)
def test_a_unit_of_another_kind_is_told(name: str, rule: str) -> None:
    case = disc_of_one_mode()
    with refusal(rf"bounds='3 kg': {rule}"):
        dm.critical(case, name, ("3 kg", "5 kg"), kind="sliding")
    with refusal(rf"bounds='3 kg': {rule}"):
        dm.neutral_curves(case, {name: ("3 kg", "5 kg"), "mu_s": (0.3, 0.4)}, [0.35])
    with refusal(rf"bounds='3 kg': {rule}"):
        dm.continue_cycle(case, name, ("3 kg", "5 kg"))


def test_a_sweep_takes_numbers_of_modes_with_units() -> None:
    swept = dm.sweep(dm.steady_sliding, disc_of_one_mode(), omega_2_0=["1190 Hz", "7600 rad/s"])
    np.testing.assert_allclose(swept["omega_2_0"], [2 * np.pi * 1190, 7600], rtol=1e-12)


def test_a_single_value_needs_no_list() -> None:
    case = dm.Parameters(N=385, Omega=14.9)
    for value in (14.95, "14.95 rad/s", np.float64(14.95)):
        branch = dm.continue_cycle(case, "Omega", (14.85, 15), values=value)
        assert 14.95 in branch.values[:, 0]
    with refusal("values=None: must be a finite number, or a list of these"):
        dm.continue_cycle(case, "Omega", (14.85, 15), values=None)
