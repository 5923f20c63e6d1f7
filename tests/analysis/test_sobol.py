"""Sobol' indices against scipy's and known ones; shares with intervals against their definition."""

import numpy as np
import pytest
from scipy import stats
from scipy.stats import qmc

from disc_model.analysis.sobol import share, sobol_intervals


def design(n: int, seed: int) -> list[np.ndarray]:
    """Points of the unit cube: A, B, and A with each of three inputs in turn taken from B."""
    unit = qmc.Sobol(6, rng=np.random.default_rng(seed)).random(n)
    a, b = unit[:, :3], unit[:, 3:]
    return [a, b, *(np.where(np.arange(3) == i, b, a) for i in range(3))]


def linear(n: int, seed: int) -> np.ndarray:
    """Outputs of 3 x + 2 y + z: indices 9/14, 4/14, 1/14, first-order and total."""
    return np.stack([x @ [3, 2, 1] for x in design(n, seed)], axis=1)


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    """Those of resampled rows are too wide for quasi-random samples, and never much too narrow."""
    truth = np.array([9, 4, 1]) / 14
    held = []
    for seed in range(20):
        found = sobol_intervals(linear(64, seed), seed)
        held += [(found.first_low <= truth) & (truth <= found.first_high)]
        held += [(found.total_low <= truth) & (truth <= found.total_high)]
    # of 120, of which 95 % should: fewer than 90 % has a chance below 1 % if they were independent
    assert np.mean(held) >= 0.9


def test_rows_with_a_gap_are_left_out_and_what_does_not_vary_has_no_indices() -> None:
    outputs = linear(64, 1)
    holed = np.vstack([outputs, np.full((1, 5), np.nan), [[1, 2, np.nan, 4, 5]]])
    for one, other in zip(sobol_intervals(outputs), sobol_intervals(holed), strict=True):
        np.testing.assert_array_equal(one, other)
    assert np.isnan(sobol_intervals(np.full((32, 5), 0.1))).all()
    assert np.isnan(sobol_intervals(np.full((4, 5), np.nan))).all()


def test_a_share_has_wilsons_interval() -> None:
    z = stats.norm.ppf(0.95)  # two-sided, 0.9
    for k, n in ((9, 40), (1, 3), (0, 7), (7, 7)):
        centre, half = (k + z**2 / 2) / (n + z**2), z / (n + z**2) * np.sqrt(k * (n - k) / n + z**2 / 4)
        # the ends at 0 and 1 cancel to roundings here
        expected = pytest.approx((k / n, centre - half, centre + half), rel=1e-12, abs=1e-15)
        assert share(k, n, confidence=0.9) == expected
    assert share(0, 40).low == 0
    assert share(40, 40).high == 1


def test_what_is_unknown_counts_against_both_ends() -> None:
    found = share(9, 40, unknown=5)
    assert found.value == 9 / 40
    assert found.low == share(9, 45).low < share(9, 40).low
    assert found.high == share(14, 45).high > share(9, 40).high
    assert share(0, 0, unknown=3)[1:] == (0, 1)
