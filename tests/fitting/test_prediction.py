"""What a case predicts, against closed forms."""

import math

import pytest

import disc_model as dm
from disc_model.fitting.block_cycle import Unpredicted
from disc_model.fitting.prediction import Prediction

BLOCK = dm.Parameters(N=30, Omega=0.5, n_diameters=-1, m=0.2, k=0, k_p=2e3, mu_s=0.5, mu_k=0.3)
"""A block on a rigid disc."""
DISC = dm.Parameters(N=385, Omega=15)


def block_times(p: dm.Parameters) -> tuple[float, float]:
    """Return durations of stick and slip of a block on constant friction, in closed form.

    It is released with the speed of the belt, V, at the distance d = (mu_s - mu_k) N / k from where
    friction and spring balance, and swings about that place until it has this speed again.
    """
    swing = math.sqrt(p.k_p / p.m)
    speed = p.r_0 * p.Omega
    distance = (p.mu_s - p.mu_k) * p.N / p.k_p
    stick = 2 * distance / speed
    ratio = distance * swing / speed
    angle = math.pi - math.atan(ratio)
    slip = 2 * angle / swing
    return stick, slip


@pytest.mark.parametrize("Omega", [0.1, 0.5, 5.0])
def test_a_block_sticks_and_slips_as_long_as_the_closed_form_says(Omega: float) -> None:
    p = BLOCK.replace(Omega=Omega)
    stick, slip = block_times(p)
    prediction = Prediction(p)
    # events of a simulation err by 1e-10 s
    assert prediction.of("stick_time") == pytest.approx(stick, abs=1e-9)
    assert prediction.of("slip_time") == pytest.approx(slip, abs=1e-9)
    assert prediction.of("period") == pytest.approx(stick + slip, abs=1e-9)
    path = p.r_0 * Omega * (stick + slip)
    assert prediction.of("slip_length") == pytest.approx(path, rel=1e-8)


def test_a_damped_block_that_slips_on_has_no_cycle() -> None:
    with pytest.raises(Unpredicted, match="do not repeat"):
        Prediction(BLOCK.replace(c_p=100.0)).of("period")


def test_cycles_are_those_of_floquet() -> None:
    cycle = dm.floquet(DISC)
    prediction = Prediction(DISC)
    assert prediction.of("period") == cycle.period
    assert prediction.of("growth_rate") == cycle.growth_rate
    assert prediction.of("stick_fraction") == cycle.stick_fraction
    both = prediction.of("stick_time") + prediction.of("slip_time")
    assert both == pytest.approx(cycle.period / cycle.releases, rel=1e-14)


def test_modes_are_those_of_the_plate_in_hertz() -> None:
    omega = dm.plate_modes(DISC)["omega"][2]
    assert Prediction(DISC).of("frequency_2_0") == omega / math.tau
    coupled = dm.coupled_natural_frequencies(DISC)
    assert Prediction(DISC).of("coupled_frequency_3") == coupled[2] / math.tau


def test_damping_ratios_are_those_of_each_way_to_give_them() -> None:
    omega = dm.plate_modes(DISC)["omega"][2]
    expected = DISC.D_star / (2 * DISC.D) * omega
    assert Prediction(DISC).of("damping_ratio_2_0") == pytest.approx(expected, rel=1e-14)
    constant = dm.Parameters(N=385, Omega=15, damping_ratio=0.01)
    assert Prediction(constant).of("damping_ratio_2_0") == 0.01
    disc = dm.Disc(diameters=[2], omega=[1e3], amplitude=[1.0], damping_ratio=[0.02])
    given = dm.Parameters(N=385, Omega=15, disc=disc, r_0=0.1)
    assert Prediction(given).of("damping_ratio_2_0") == 0.02


def test_steady_sliding_gives_its_leading_eigenvalue() -> None:
    leading = dm.steady_sliding(DISC).eigenvalues[0]
    assert Prediction(DISC).of("sliding_growth_rate") == leading.real
    assert Prediction(DISC).of("sliding_frequency") == abs(leading.imag) / math.tau


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("frequency_9_0", "no mode of 9 nodal diameters"),
        ("coupled_frequency_99", "has 9 frequencies"),
    ],
)
def test_what_a_case_does_not_have_is_said(name: str, reason: str) -> None:
    with pytest.raises(Unpredicted, match=reason):
        Prediction(DISC).of(name)


def test_a_cycle_that_is_not_there_is_said() -> None:
    with pytest.raises(Unpredicted, match="slips on"):
        Prediction(DISC.replace(c_p=100.0)).of("period")
    with pytest.raises(Unpredicted, match="not defined"):
        Prediction(BLOCK).of("growth_rate")
