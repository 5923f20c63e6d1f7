"""Many cycles at once are the single ones."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model import Parameters, floquet
from disc_model.stability.cycle import (
    CycleStatus,
)
from disc_model.stability.floquet_batch import STATUS_NAMES, solve

P = Parameters(N=200, Omega=20, n_diameters=1)


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"Omega": 0}, CycleStatus.AT_REST),
        ({"N": 0}, CycleStatus.NO_STICK_SLIP),
        ({"k_p": 0}, CycleStatus.AT_REST),
        ({"c_p": 5}, CycleStatus.NO_STICK_SLIP),
    ],
)
def test_batch_and_single_name_the_same_status(changes, status):
    p = P.replace(**changes)
    single, batch = floquet(p), solve([p])
    assert single.status is status
    assert STATUS_NAMES[batch["status"][0]] == status.value
    assert np.isnan(batch["growth_rate"][0])
    np.testing.assert_equal(batch["sliding_growth_rate"][0], single.sliding.growth_rate)


def test_batch_equals_the_single_result():
    single, batch = floquet(P), solve([P])
    assert batch["growth_rate"][0] == single.growth_rate
    assert batch["multiplier_re"][0] + 1j * batch["multiplier_im"][0] == single.multipliers[0]
    assert (batch["period"][0], batch["stick_fraction"][0]) == (single.period, single.stick_fraction)


BASE = Parameters(N=200, Omega=20)


@pytest.mark.compiled
def test_batch_equals_the_single_results():
    cases = [BASE, Parameters(N=385, Omega=15.1), Parameters(N=50, Omega=15), BASE.replace(Omega=0)]
    batch = solve(cases)
    singles = [floquet(p) for p in cases]
    assert [STATUS_NAMES[code] for code in batch["status"]] == [single.status.value for single in singles]
    for name in ("growth_rate", "period", "stick_fraction"):
        assert np.array_equal(batch[name], [getattr(s, name) for s in singles], equal_nan=True)
    assert np.array_equal(batch["sliding_growth_rate"], [s.sliding.growth_rate for s in singles], equal_nan=True)
    assert batch["multiplier_re"][0] == singles[0].multipliers[0].real
    assert batch["multiplier_im"][0] == singles[0].multipliers[0].imag
    assert all(array.shape == (len(cases),) for array in batch.values())
