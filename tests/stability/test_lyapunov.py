"""Largest Lyapunov exponents."""

import numpy as np
import pytest

from disc_model import Parameters, Status, floquet, plate_modes, steady_sliding
from disc_model.stability.lyapunov import averages, lyapunov_exponents
from tests.refusals import refusal
from tests.stability.test_attractor import paradox
from tests.stability.test_sliding import state_of

STICK = Parameters(N=300, Omega=1e-3, n_diameters=0, c=3.0, D_star=2e-4)
"""Of a slow drive, for seconds."""


def test_exponents_of_stick_are_those_of_the_coupled_mode():
    """Stick is linear: the exponents are 0, of the spring that is wound up, and the decay rate of
    one coupled mode."""
    p = STICK
    mode = plate_modes(p).iloc[0]
    damping = p.D_star / p.D * mode["omega"] ** 2 + p.c * mode["psi"] ** 2
    mass = 1 + p.m * mode["psi"] ** 2
    decay = float(damping / (2 * mass))
    found = lyapunov_exponents(p, 0.1, count=3, interval=0.005)
    assert found.status is Status.OK
    assert found.duration == pytest.approx(0.1)
    # the two of the pair take turns; their sum does not
    assert found.exponents.sum() == pytest.approx(-2 * decay, rel=1e-6)
    assert abs(found.exponents[0]) < decay
    assert found.final_state.time == pytest.approx(0.2)


@pytest.mark.filterwarnings("error")
def test_exponents_that_do_not_exist_were_zero_and_converged():
    """In stick f is 0, and u and u' are the disc's: of six coordinates of the state three are
    left."""
    found = lyapunov_exponents(STICK, 0.1, count=5, interval=0.005)
    assert np.isfinite(found.exponents[:3]).all()
    assert found.exponents[3:].tolist() == [-np.inf] * 2
    assert not found.converged[3:].any()
    assert np.isnan(found.errors[3:]).all()
    with refusal("^count=6: must be a whole number from 1 to 5$"):
        lyapunov_exponents(STICK, 0.1, count=6)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("n_diameters", "c_p", "interval"), [(0, 10.0, 0.01), (4, 10.0, 0.01), (0, 400.0, 0.002)]
)
def test_exponents_of_steady_sliding_are_its_eigenvalues(
    n_diameters: int, c_p: float, interval: float
):
    """Without a switch u, u' of columns stayed as they were, and what remained when the rest died
    out was they. With a strong damper, steps too long for it gave 284/s."""
    p = Parameters(N=100, Omega=40, n_diameters=n_diameters, c_p=c_p, D_star=1e-3)
    sliding = steady_sliding(p)
    assert sliding.stable
    found = lyapunov_exponents(
        p, 2.0, count=4, interval=interval, initial_state=state_of(p, sliding)
    )
    # either of a pair oscillates, which leaves a fraction of 2 s
    rates = sliding.eigenvalues.real[:4]
    expected = rates.reshape(2, 2).sum(axis=1)
    of_pairs = found.exponents.reshape(2, 2).sum(axis=1)
    np.testing.assert_allclose(of_pairs, expected, atol=0.05)


def test_a_motion_that_cannot_go_on_has_no_exponents():
    p, start = paradox()
    found = lyapunov_exponents(p, 0.1, initial_state=start)
    assert found.status is Status.PARADOX
    assert found.status.advice.startswith("Painleve")
    assert np.isnan(found.exponents).all()
    assert found.duration == 0
    assert found.final_state.time < start.time + 0.1


@pytest.mark.compiled
def test_on_a_cycle_they_are_its_exponents():
    """The multipliers leave the 1 along the orbit out as well."""
    p = Parameters(N=200, Omega=20, c=2.0, D_star=1e-3)
    cycle = floquet(p)
    assert cycle.stable
    found = lyapunov_exponents(p, 10.0, count=2, initial_state=cycle.state)
    assert found.status is Status.OK
    assert found.duration == pytest.approx(10.0)
    # a complex pair has one rate: the two are equal in the mean
    rate = np.mean(cycle.exponents.real[:2])
    assert np.mean(found.exponents) == pytest.approx(rate, rel=1e-3)


def test_errors_are_standard_errors_of_16_segments_unless_both_halves_differ_by_more() -> None:
    """Of an exponent of 1/s in the mean: segments alternate about it, or rise in the second
    half."""
    segment = np.arange(16)
    alternating = 1 + 0.4 * (-1.0) ** segment
    rising = np.where(segment < 8, 0.5, 1.5)
    logs = np.repeat(np.column_stack([alternating, rising]), 5, axis=0) * 0.01
    exponents, errors, converged = averages(logs, 0.01)
    assert exponents == pytest.approx([1.0, 1.0], rel=1e-12)
    # the standard error of a mean of n values is their deviation over the root of n
    standard_error = np.std(alternating, ddof=1) / np.sqrt(16)
    assert errors == pytest.approx([standard_error, 1.0], rel=1e-12)
    assert converged.tolist() == [True, False]


@pytest.mark.parametrize(
    ("halves", "expected"),
    [
        ((0.0005, 0.0015), True),  # within 0.002/s, though not within 5 %
        ((0.99, 1.01), True),  # within 5 %, though not within 0.002/s
        ((-0.0009, 0.0009), True),
        ((-0.0011, 0.0011), False),
        ((-0.98, -1.02), True),
        ((-0.97, -1.03), False),
    ],
)
def test_halves_agree_within_a_share_or_within_a_rate(
    halves: tuple[float, float], expected: bool
) -> None:
    exponents, _, converged = averages(np.repeat(halves, 80)[:, None] * 0.01, 0.01)
    assert exponents == pytest.approx([sum(halves) / 2], abs=1e-12)
    assert converged.tolist() == [expected]
