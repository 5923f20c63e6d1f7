"""Squeal against matrices of mass, damping and stiffness that share nothing with the package's Jacobian."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import disc_model as dm
from tests.references.growth import couple, pad_means
from tests.references.squeal import Squeal

SIZES = {"a": 0.07, "b": 0.13, "h": 0.01, "E": 210e9, "rho": 7850, "nu": 0.3, "n_diameters": 8}
STEEL = dm.Parameters(
    **SIZES,
    N=5000, Omega=60, r_0=0.1, m=0.5, k=1e6, k_p=1e6, mu_s=0.45, mu_k=0.3,
    damping_ratio=1e-3, friction_offset="surface", contact_arc=0.4,
    normalization="orthonormal",
)  # fmt: skip
BRAKE = dm.Parameters(
    disc=dm.Disc.from_csv(Path(__file__).parents[2] / "config/discs/brake.csv"),
    N=8000, Omega=60, r_0=0.1, m=0.5, k=1e6, k_p=1e6, mu_s=0.45, mu_k=0.35,
    friction_offset="surface", contact_arc=0.4,
)  # fmt: skip
PAPER = dm.Parameters(N=385, Omega=15)
THIN = PAPER.replace(
    N=100, normalization="orthonormal", mu_s=0.45, mu_k=0.3, friction_decay=5.0, c_p=0.2
)
SPEEDS = (5.0, 120.0)
FALLING, WORK, MOVING, SEVERAL = (
    "falling friction",
    "tangential work",
    "moving load",
    "more than one",
)
STEEL_WORK = {7116: WORK, 5285: WORK, 9346: WORK, 3884: WORK}
RISING = {5285: WORK, 7116: WORK, 3884: WORK}  # friction that rises with the speed
# case, number, its bounds, and why modes grow, by their frequencies in Hz
TABLES = {
    "paper": (PAPER, "Omega", (5.0, 50.0), {71: MOVING, 135: MOVING}),
    "thin": (THIN, "Omega", (10.0, 60.0), {71: FALLING, 187: MOVING}),
    "thin, surface": (
        THIN.replace(friction_offset="surface"),
        *("Omega", (10.0, 60.0)),
        {71: FALLING, 635: WORK, 396: WORK, 269: WORK, 187: WORK},
    ),
    "steel": (STEEL.replace(friction_decay=5.0), "Omega", SPEEDS, {220: FALLING}),
    "steel, exponential": (
        STEEL.replace(friction_decay=0.1, friction_law="exponential", c_p=5.0),
        *("Omega", SPEEDS, {225: FALLING}),
    ),
    "steel, viscous": (STEEL.replace(viscous_friction=0.01), "Omega", SPEEDS, RISING),
    "steel, constant": (STEEL.replace(mu_k=0.45), "Omega", SPEEDS, STEEL_WORK),
    "steel, by load": (STEEL.replace(mu_k=0.45, Omega=82), "N", (1e3, 1e4), {7143: WORK}),
    # two causes at two frequencies
    "steel, both": (
        STEEL.replace(mu_s=0.6, mu_k=0.43, friction_decay=5.0),
        *("Omega", (60.0, 90.0), {225: FALLING, 7138: WORK, 5302: WORK}),
    ),
    # the pad's mode in the plane passes that of two nodal diameters
    "steel, crossing": (
        STEEL.replace(mu_k=0.45, Omega=120),
        *("k_p", (1.1e8, 1.35e8), {2532: MOVING, **STEEL_WORK}),
    ),
    "brake": (BRAKE, "Omega", SPEEDS, {1774: WORK, 510: WORK, 1138: WORK, 2736: WORK}),
    "brake, both": (
        BRAKE.replace(friction_decay=5.0),
        *("Omega", (5.0, 40.0), {219: FALLING, 1760: SEVERAL, 551: SEVERAL, 516: WORK}),
    ),
}


def reference(p: dm.Parameters, works: bool = True) -> np.ndarray:
    """Eigenvalues, with or without work of friction on tangential motion."""
    table = dm.plate_modes(p.replace(contact_arc=0))
    omega, psi, l = (table[name].to_numpy(float) for name in ("omega", "psi", "diameters"))
    if p.disc is None:
        ratio = p.damping_ratio
        damping = p.D_star / p.D * omega**2 if ratio is None else 2 * ratio * omega
        height = p.h / 2 if p.friction_offset == "surface" else p.friction_offset
        tangential = couple(height, psi, l, p.r_0)
    else:
        damping = 2 * np.array(p.disc.damping_ratio) * omega
        tangential = np.array(p.disc.tangential)
    pad = pad_means(l, p.contact_arc)
    return Squeal(p, omega, pad * psi, l, damping, works * pad * tangential).eigenvalues()


def growth_near(p: dm.Parameters, hertz: float, works: bool = True) -> float:
    """The largest growth rate of modes within 5 % of a frequency."""
    values = reference(p, works)
    near = values[np.abs(values.imag / math.tau / hertz - 1) < 0.05]
    return float(near.real.max())


def at_constant_friction(p: dm.Parameters) -> dm.Parameters:
    """The case with the friction that it has at its speed at any speed."""
    v = p.r_0 * p.Omega
    fall = 0.0
    if math.isfinite(p.friction_decay):
        fall = 1 / (1 + p.friction_decay * v)
        if p.friction_law == "exponential":
            fall = math.exp(-p.friction_decay * v)
    mu = p.mu_k + (p.mu_s - p.mu_k) * fall + p.viscous_friction * v
    return p.replace(mu_s=mu, mu_k=mu, viscous_friction=0.0, friction_decay=math.inf)


@pytest.fixture(scope="module", params=TABLES.values(), ids=TABLES)
def found(request: pytest.FixtureRequest):
    case, name, bounds, _ = request.param
    return *request.param, dm.squeal(case, bounds, name=name, points=13)


def test_modes_are_eigenvalues_of_matrices_and_none_is_missed(found) -> None:
    case, name, bounds, _, table = found
    for row in table.itertuples():
        own = row.growth_rate + 1j * math.tau * row.frequency
        values = reference(case.replace(**{name: row.at}))
        assert np.abs(values - own).min() < 1e-8 * abs(own)
    values = reference(case.replace(**{name: bounds[1]}))
    growing = values.real[(values.imag > 0) & (values.real > 1e-8)]
    ends = table.drop_duplicates("mode")["end_growth_rate"]
    np.testing.assert_allclose(np.sort(ends[ends > 0]), np.sort(growing), rtol=1e-8)


def test_onsets_are_zeros_of_the_real_part(found) -> None:
    case, name, bounds, _, table = found
    for row in table.itertuples():
        for value, outside in ((row.onset, -1), (row.until, 1)):
            if value in bounds:
                continue

            def rate(x: float, hertz: float = row.frequency) -> float:
                values = reference(case.replace(**{name: x}))
                near = values[np.abs(values.imag / math.tau / hertz - 1) < 0.05].real
                return float(near[np.abs(near).argmin()])

            width = 1e-6 * value * outside
            assert rate(value + width) < 0 < rate(value - width)
            own = brentq(rate, value - width, value + width, rtol=1e-13)
            assert own == pytest.approx(value, rel=1e-8)


def test_each_cause_is_confirmed_by_switching_it_off(found) -> None:
    case, name, _, causes, table = found
    assert dict(zip(table["frequency"].round(), table["cause"], strict=True)) == causes
    for row in table.itertuples():
        p = case.replace(**{name: row.at})
        constant = at_constant_friction(p)
        cases = ((constant, True), (p, False), (constant, False))
        rates = [growth_near(each, row.frequency, works) for each, works in cases]
        # moving load cannot be switched off: beside it, what makes more than half of the growth counts
        enough = row.growth_rate / 2 if rates[2] > 1e-9 else 1e-9
        without_fall, without_work, without_both = (rate > enough for rate in rates)
        assert {
            FALLING: without_work and not without_fall,
            WORK: without_fall and not without_work,
            MOVING: without_both,
            SEVERAL: without_fall == without_work and not without_both,
        }[row.cause]


def test_the_table_of_modes_has_those_that_grow_first() -> None:
    sliding = dm.steady_sliding(STEEL.replace(mu_k=0.45, Omega=120))
    table = sliding.modes
    assert str(sliding).endswith(table.to_string())
    assert table["growth_rate"].is_monotonic_decreasing
    growing = table[table["growth_rate"] > 0]
    assert growing["frequency"].round().tolist() == [7116, 5285, 9346, 3884]
    assert growing["diameters"].tolist() == [6, 5, 7, 4]
    assert (growing["disc"] > 0.98).all()
    pad = table[table["growth_rate"] == 0]
    assert pad[["frequency", "disc"]].round(3).values.tolist() == [[225.079, 0.0]]
    assert dm.steady_sliding(STEEL.replace(Omega=0)).modes.empty


def test_a_sweep_follows_the_fastest_mode() -> None:
    case = STEEL.replace(mu_k=0.45)
    swept = dm.sweep(dm.steady_sliding, case, Omega=[0, 60, 90, 120], N=[5000, 6000])
    assert swept["mode"].values[1:].tolist() == [[1, 1], [13, 13], [13, 13]]
    np.testing.assert_allclose(swept["frequency"][3], [7116.1159, 7116.1184], rtol=1e-7)
    assert swept["mode"][0].isnull().all()


def test_without_sliding_nothing_squeals() -> None:
    assert dm.squeal(STEEL.replace(N=0), SPEEDS, points=3).empty
