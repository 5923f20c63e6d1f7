"""Split pairs in steady sliding: the periodic equations, and both of their limits."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

import disc_model as dm
from disc_model.disc.plate import mode_arrays
from disc_model.stability.splitting import SplitGrowth, _floquet_growth, _pairs

PAD: dict[str, Any] = {
    "r_0": 0.1,
    "k": 1e6,
    "k_p": 1e6,
    "c_p": 50,
    "m": 0.5,
    "mu_s": 0.45,
    "mu_k": 0.35,
}
LIGHT: dict[str, Any] = {**PAD, "k": 5e4, "m": 0.02, "k_p": 1e6, "c_p": 20, "N": 2e4}


def case(pad: dict[str, Any], damping: float = 1e-3, **changes: Any) -> dm.Parameters:
    """A brake-like disc of one pair under a pad."""
    disc = dm.Disc(
        diameters=[2], omega=[3000.0], amplitude=[0.54], tangential=[-0.13], damping_ratio=[damping]
    )
    base = {"N": 8000, "Omega": 80, "disc": disc, "friction_offset": "surface"}
    return dm.Parameters(**{**base, **pad, **changes})


def by_integration(p: dm.Parameters, split: float) -> float:
    """Growth rate by an integrator of scipy, with the stiffness of the disc turned by a matrix into
    the slider's frame."""
    jacobian = dm.steady_sliding(p).jacobian
    omega = 3000.0
    size = len(jacobian)  # a, alpha, b, beta, psi, f
    upper = omega * (1 + split / 2)
    lower = omega * (1 - split / 2)
    halves = np.diag([upper**2, lower**2])

    def rate(t: float, x: Any) -> Any:
        angle = 2 * p.Omega * t
        cosine = np.cos(angle)
        sine = np.sin(angle)
        turn = np.array([[cosine, sine], [-sine, cosine]])
        added = turn @ halves @ turn.T - omega**2 * np.eye(2)
        changed = jacobian.copy()
        changed[np.ix_([1, 3], [0, 2])] -= added
        return (changed @ x.reshape(size, size)).ravel()

    end = np.pi / (2 * p.Omega)  # a quarter of a turn brings two diameters back
    run = solve_ivp(rate, (0, end), np.eye(size).ravel(), method="DOP853", rtol=1e-10, atol=1e-12)
    multipliers = np.linalg.eigvals(run.y[:, -1].reshape(size, size))
    return float(np.log(np.abs(multipliers).max()) / end)


@pytest.mark.parametrize("split", [1e-3, 0.01, 0.05])
def test_growth_rates_are_those_of_an_integrator(split: float) -> None:
    """Ten steps in a period of the mode, of the fourth order, are good to 1e-3 of the splitting."""
    p = case(PAD)
    found = dm.split_growth(p, split).growth_rate
    assert found == pytest.approx(by_integration(p, split), abs=2e-2 * split**0.5)


def test_growth_by_more_than_a_propagator_holds_is_taken_out_of_it() -> None:
    """All solutions grow by 50/s more, which is exp(314) in half a turn; steps hardly differ."""
    p = case(PAD, Omega=0.5)
    jacobian = dm.steady_sliding(p).jacobian
    modes = mode_arrays(p)
    pairs = _pairs(modes, len(jacobian))
    raised = jacobian + 50 * np.eye(len(jacobian))
    usual = _floquet_growth(p, modes, pairs, [0.01], jacobian)
    found = _floquet_growth(p, modes, pairs, [0.01], raised)
    assert found - usual == pytest.approx(50, abs=1e-2)


@pytest.mark.parametrize("split", [5e-5, 2e-4, 5e-4, 2e-3])
def test_a_light_pad_couples_both_waves_as_averaging_has_it(split: float) -> None:
    """Where slider and split are weak beside the drive's 2 l Omega, the waves obey two equations of
    the first order, whose eigenvalues have a closed form; its error is of the second order."""
    p = case(LIGHT, damping=5e-5)
    values = dm.steady_sliding(p).eigenvalues
    of_pair = values[(values.imag > 2000) & (values.imag < 4000)]
    waves = of_pair[np.argsort(of_pair.imag)]
    with_slider = waves[0] + 2j * p.Omega
    against = waves[1] - 2j * p.Omega
    root = np.sqrt(((with_slider - against) / 2) ** 2 - (3000 * split / 2) ** 2)
    expected = ((with_slider + against) / 2).real + abs(root.real)
    found = dm.split_growth(p, split)
    scale = found.together - found.apart
    assert found.growth_rate == pytest.approx(expected, abs=0.02 * scale)


def test_both_limits_are_reached() -> None:
    p = case(LIGHT, damping=5e-5)
    none = dm.split_growth(p, 0.0)
    large = dm.split_growth(p, 0.03)
    assert none.growth_rate == none.together
    assert none.together == dm.steady_sliding(p).growth_rate
    assert not none.matters
    assert large.apart < 0 < large.together
    scale = large.together - large.apart
    assert large.growth_rate == pytest.approx(large.apart, abs=0.03 * scale)
    assert large.matters


def test_both_limits_are_no_bounds() -> None:
    """The page on brake discs said that the growth rate lies between them."""
    above = dm.split_growth(dm.Parameters(N=385, Omega=100, c_p=5), 0.02)
    below = dm.split_growth(dm.Parameters(N=385, Omega=100), 0.02)
    assert above.growth_rate > 1.01 * max(above.together, above.apart)
    assert below.growth_rate < 0.995 * min(below.together, below.apart)
    page = (Path(__file__).parents[2] / "docs" / "brake_disc.md").read_text(encoding="utf-8")
    assert "they are no bounds" in " ".join(page.split())


@pytest.mark.parametrize(
    ("changes", "split", "phrase"),
    [
        ({}, None, "split='None': must be given: the disc does not come from a file"),
        ({}, -0.1, "split=-0.1: must be one number from 0 to 0.2"),
        (
            {},
            [0.1, 0.1],
            "split=[0.1, 0.1]: must be one number from 0 to 0.2, or one for each of 1",
        ),
        ({"Omega": 1e-3}, 0.01, "Omega=0.001: must be faster: half a turn takes"),
        ({"Omega": 0}, 0.01, "there is no steady sliding: The disc is not driven"),
    ],
)
def test_what_cannot_be_computed_is_said(changes: Any, split: Any, phrase: str) -> None:
    with pytest.raises(dm.ParameterError) as error:
        dm.split_growth(case(PAD, **changes), split)
    assert phrase.replace("'None'", "None") in str(error.value)


def test_a_disc_without_pairs_has_nothing_to_split() -> None:
    disc = dm.Disc(diameters=[0], omega=[3000], amplitude=[0.5])
    found: SplitGrowth = dm.split_growth(case(PAD, disc=disc, friction_offset=0.0), 0.01)
    assert found.growth_rate == found.together
    assert found.together == found.apart
    assert len(found.pairs) == 0


def heavily_damped(**changes: Any) -> dm.Parameters:
    """A case whose pair decays faster than another mode."""
    return case(PAD, damping=0.1, **changes)


def test_a_mode_outside_the_pairs_may_grow_most() -> None:
    """The slider in the disc's plane, whose frequency and damping are nearly its own."""
    p = heavily_damped(c_p=0.0)
    values = dm.steady_sliding(p).eigenvalues
    [slider] = values[np.abs(values.imag - np.sqrt(p.k_p / p.m)) < 30]
    found = dm.split_growth(p, 0.01)
    [pair] = found.pairs.to_dict("records")
    assert pair["apart"] < pair["together"] < slider.real
    assert found.apart == found.together == 0


def test_a_damped_slider_is_below_the_mean_of_the_pair() -> None:
    p = case(PAD)
    values = dm.steady_sliding(p).eigenvalues
    of_pair = values[(values.imag > 2000) & (values.imag < 4000)].real
    assert len(of_pair) == 2
    found = dm.split_growth(p, 0.01)
    assert found.apart == pytest.approx(of_pair.mean(), rel=1e-12)
    [pair] = found.pairs.to_dict("records")
    expected = {
        "diameters": 2,
        "circles": 0,
        "frequency_Hz": 3000 / (2 * np.pi),
        "split": 0.01,
        "together": of_pair.max(),
        "apart": of_pair.mean(),
    }
    assert pair == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("together", "growth_rate", "matters"),
    [
        (10.0, 10.9, False),
        (10.0, 11.1, True),
        (10.0, 8.9, True),
        (-10.0, -9.1, False),
        (-10.0, -11.1, True),
        (0.01, -0.0001, True),
        (-0.0001, 0.0001, True),
        (0.0, 0.0, False),
    ],
)
def test_a_split_matters_from_a_tenth_of_the_rate_or_if_the_sign_changes(
    together: float, growth_rate: float, matters: bool
) -> None:
    found = SplitGrowth(together, growth_rate, 0.0, pd.DataFrame())
    assert found.matters is matters
    expected = "no"
    if matters:
        expected = "yes"
    summary = dict(found.summary())
    assert summary["the split matters"] == expected


def test_a_split_does_not_matter_where_growth_is_zero_but_for_rounding() -> None:
    """Any split mattered beside a neutral mode, by 1e-9 1/s."""
    neutral = SplitGrowth(together=5e-12, growth_rate=-7.6e-10, apart=-1e-9, pairs=pd.DataFrame())
    assert not neutral.matters
    growing = SplitGrowth(together=-0.01, growth_rate=0.01, apart=0.02, pairs=pd.DataFrame())
    assert growing.matters


def test_a_change_that_is_nothing_beside_the_damping_does_not_matter() -> None:
    """A change from 0 to -1.07e-6/s mattered, of a pair whose damping is 8/s."""
    pair = {"omega": [7622.0, 5837.0], "amplitude": [0.54, 0.43], "damping_ratio": [1.1e-3, 1e-3]}
    disc = dm.Disc(diameters=[2, 0], **pair)
    p = dm.Parameters(N=8000, Omega=80, disc=disc, friction_offset=0.006, **{**PAD, "c_p": 0})
    found = dm.split_growth(p, [0.005, 0.0])
    assert found.growth_rate == pytest.approx(found.together, abs=1e-4)
    assert found.damping_rate == pytest.approx(1.1e-3 * 7622)
    assert not found.matters


def test_a_change_must_be_more_than_the_accuracy_of_the_damping() -> None:
    growing = SplitGrowth(-0.01, 0.01, 0.02, pd.DataFrame(), damping_rate=8.0)
    assert not growing.matters
    faster = SplitGrowth(-0.1, 0.1, 0.2, pd.DataFrame(), damping_rate=8.0)
    assert faster.matters


def test_an_undamped_pair_has_no_damping_rate() -> None:
    assert dm.split_growth(case(PAD, damping=0.0), 0.01).damping_rate == 0
