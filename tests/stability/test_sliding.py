"""Steady sliding: an equilibrium with the flow's eigenvalues, or why there is none."""

import math

import numpy as np
import pytest

from disc_model import Disc, Parameters, plate_modes, steady_sliding
from disc_model.disc.plate import mode_arrays, tangential_amplitudes
from disc_model.engine import transitions
from disc_model.simulation.states import State
from disc_model.stability.sliding import (
    SlidingStatus,
    SteadySliding,
    follow_modes,
    height_of_slider,
    sliding_modes,
    split_rows,
)
from tests.contact_laws import ALL_LAWS, COMPILES
from tests.engine.full_system import Full
from tests.references import taylor
from tests.references.block import friction_coefficient

P = Parameters(N=200, Omega=20, n_diameters=1)


def state_of(p: Parameters, sliding: SteadySliding) -> State:
    """The equilibrium as a state."""
    modes = plate_modes(p)
    w = float(modes["psi"] @ sliding.a)
    share = 1.0
    if p.contact_force == "normal":
        weights = modes["diameters"] * modes["psi"]
        slope = float(weights @ sliding.b)
        surface_speed = float(tangential_amplitudes(p) @ sliding.beta)
        mu = friction_coefficient(p, p.r_0 * p.Omega - surface_speed)
        share = 1 - mu * slope / p.r_0
    height = w - p.contact_compliance * share * sliding.contact_force
    return State(
        time=0.0,
        phase="slip",
        direction=1,
        psi=sliding.psi,
        f=p.Omega,
        u=height,
        u_velocity=0.0,
        a=sliding.a,
        b=sliding.b,
        alpha=sliding.alpha,
        beta=sliding.beta,
    )


SLIDING = {
    "base": Parameters(N=200, Omega=20),
    "damped": Parameters(N=300, Omega=50, c_p=0.7, c=0.3),
    "orthonormal": Parameters(N=100, Omega=40, normalization="orthonormal"),
}
for _name, _law in ALL_LAWS.items():
    # two nodal diameters, and damping that counts beside l Omega and omega
    SLIDING[_name] = P.replace(n_diameters=2, c=0.3, c_p=0.7, D_star=5e-3, **_law)


@pytest.mark.parametrize(
    "p",
    [
        pytest.param(p, marks=COMPILES if name in ALL_LAWS else pytest.mark.compiled, id=name)
        for name, p in SLIDING.items()
    ],
)
def test_steady_sliding_is_an_equilibrium_with_the_flows_eigenvalues(p):
    """It stays where it is, and its eigenvalues are those of an orbit from there."""
    sliding = steady_sliding(p)
    duration = 1e-3
    assert sliding.status is SlidingStatus.OK
    symbol = "R" if p.contact_force == "normal" else "P"
    assert f"{symbol} = {sliding.contact_force:.6g} N" in sliding.message
    run = Full(p, state_of(p, sliding), scalars=4 if p.contact_compliance else 2)
    before = run.coordinates
    assert run.fly(duration) == transitions.TIME_OVER
    rounding = 1e-12 * np.max(np.abs(before))
    np.testing.assert_allclose(run.coordinates, before, rtol=0, atol=rounding)

    flow = np.linalg.eigvals(run.columns)
    expected = np.exp(sliding.eigenvalues * duration)
    assert len(expected) == len(flow)
    apart = np.abs(expected[:, None] - flow[None, :])
    assert apart.min(axis=1).max() < 1e-10  # roundings of the orbit
    rate = np.log(np.abs(flow).max()) / duration
    assert sliding.growth_rate == pytest.approx(rate, abs=1e-6)


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_without_friction_sliding_is_stable_up_to_the_critical_speed_of_the_moving_load(
    normalization,
):
    """That is where the first mode stands still under the slider: the least omega_l / l."""
    p = Parameters(
        N=1, Omega=1, mu_s=0, mu_k=0, contact="bilateral", D_star=0, normalization=normalization
    )
    modes = plate_modes(p).query("diameters > 0")
    critical = float((modes["omega"] / modes["diameters"]).min())
    for share, grows in ((0.5, False), (0.999, False), (1.001, True)):
        sliding = steady_sliding(p.replace(Omega=share * critical))
        end = ", neutral"
        if grows:
            end = ", not stable"
        assert sliding.message.endswith(end), share
        # rounding leaves 1e-12 1/s, a thousandth above the critical speed it is 3 to 7
        assert (sliding.growth_rate > 1e-6) == grows == sliding.growing.size, share


EQUILIBRIA = {"base": {}, "surface": {"friction_offset": "surface"}, **ALL_LAWS}


@pytest.mark.parametrize("law", EQUILIBRIA.values(), ids=EQUILIBRIA)
@pytest.mark.parametrize("changes", [{"Omega": 7.0}, {"Omega": 120.0, "k": 2e5}, {"N": 900.0}])
def test_all_rates_of_the_model_s_equations_vanish_in_steady_sliding(law, changes):
    """By the equations of slip of an independent program, of which every rate of size counts."""
    p = Parameters(
        **{"N": 300, "Omega": 40, "c": 0.3, "c_p": 0.7, "D_star": 5e-4, **changes, **law}
    )
    state = state_of(p, steady_sliding(p))
    modes = plate_modes(p)
    sign = np.sign(modes["psi"].to_numpy())
    flipped = {name: sign * getattr(state, name) for name in ("a", "b", "alpha", "beta")}
    step = taylor.Step(taylor.problem_of(p), "slip", 1, state.replace(**flipped), order=1)
    # the size of a rate is that of its largest term
    static = p.N * np.abs(modes["psi"] / modes["omega"]).max()
    fast = modes["omega"].max() * static
    sizes = {"alpha": fast, "beta": fast, "a": static, "b": static}
    sizes |= {"psi": 0.1 * p.Omega, "f": p.N / (p.m * p.r_0)}
    if p.contact_compliance:
        assert abs(step.u[1]) < 1e-14
        sizes |= {"v": 10 * p.N / p.m}
    for name, size in sizes.items():
        assert np.abs(getattr(step, name)[1]).max() < 1e-12 * size, name


@pytest.mark.parametrize("force", ["vertical", "normal"])
def test_the_slider_sinks_into_a_compliant_contact(force: str) -> None:
    p = Parameters(N=300, Omega=40, k=2e5, contact_compliance=1e-7, contact_force=force)
    sliding = steady_sliding(p)
    # of the contact's 30 micrometres, rounding leaves 1e-12
    assert height_of_slider(p, sliding) == pytest.approx(state_of(p, sliding).u, rel=1e-11)


BONDED = {"Omega": 1520.0, "contact": "bilateral"}
LOOSE = {"k_p": 0, "mu_k": 0}


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, SlidingStatus.OK),
        ({"Omega": 0}, SlidingStatus.AT_REST),
        # above a resonance the disc yields upwards, and the slider's spring with it
        ({"Omega": 1520.0}, SlidingStatus.NO_CONTACT),
        # softened, the spring pulls less than N presses
        ({"Omega": 1520.0, "k": 100.0}, SlidingStatus.OK),
        # a lower speed was advised, which changes nothing without a load
        ({"N": 0}, SlidingStatus.NO_LOAD),
        ({"N": 0, "friction_offset": "surface"}, SlidingStatus.NO_LOAD),
        ({"N": 0, "Omega": 1520.0}, SlidingStatus.NO_LOAD),
        (BONDED, SlidingStatus.OK),
        # a bond that pulls tilts the disc against the slip
        ({**BONDED, "N": 1e6, "D_star": 2e-4}, SlidingStatus.PARADOX),
        # the damper alone cannot balance friction at f = Omega, where it does nothing; without
        # friction it need not
        ({"k_p": 0, "c_p": 0.5}, SlidingStatus.NO_SPRING),
        ({"k_p": 0, "c_p": 0.5, "mu_s": 0, "mu_k": 0}, SlidingStatus.OK),
        # nor can it the slope of the disc
        (LOOSE, SlidingStatus.OK),
        ({**LOOSE, "contact_force": "normal"}, SlidingStatus.NO_SPRING),
        ({**LOOSE, "contact_force": "normal", "D_star": 0}, SlidingStatus.OK),
        # the damping that counts is that of the modes, whatever gives it
        ({**LOOSE, "contact_force": "normal", "damping_ratio": 0.0}, SlidingStatus.OK),
        ({**LOOSE, "contact_force": "normal", "damping_ratio": 1e-3}, SlidingStatus.NO_SPRING),
        # nor does it slope where no mode has a nodal diameter
        ({**LOOSE, "contact_force": "normal", "n_diameters": 0}, SlidingStatus.OK),
        # friction that falls with the speed has not fallen to mu_k = 0 at any
        ({**LOOSE, "friction_decay": 5.0}, SlidingStatus.NO_SPRING),
        ({**LOOSE, "friction_decay": 5.0, "mu_s": 0.0}, SlidingStatus.OK),
        # nor has friction that grows with it
        ({**LOOSE, "mu_s": 0.0, "viscous_friction": 0.1}, SlidingStatus.NO_SPRING),
    ],
)
def test_steady_sliding_says_why_there_is_none(changes, status):
    found = steady_sliding(P.replace(**changes))
    assert found.status is status
    assert found.stable == (found.growth_rate < 0)
    if status is not SlidingStatus.OK:
        assert found.message == status.advice
        assert math.isnan(found.contact_force)


BRAKE = Parameters(
    N=4000,
    Omega=10,
    E=210e9,
    rho=7850,
    nu=0.3,
    a=0.05,
    b=0.15,
    r_0=0.12,
    h=0.008,
    m=0.3,
    k=5e5,
    k_p=5e5,
    mu_s=0.45,
    mu_k=0.35,
    damping_ratio=5e-4,
    normalization="orthonormal",
    friction_offset="surface",
    contact_arc=0.4,
    n_diameters=6,
)
"""A steel disc, damped, under a pad without a damper in the plane, whose sliding is neutral."""


@pytest.mark.parametrize(
    "p",
    [
        *(BRAKE.replace(Omega=speed) for speed in np.linspace(10, 40, 7)),
        P.replace(n_diameters=0, D_star=1e-3),
    ],
)
def test_the_growth_rate_of_neutral_sliding_is_exactly_0(p):
    """Half of the points of a sweep over the speed grew, by 4e-13/s: of a slider without a damper in the
    plane."""
    found = steady_sliding(p)
    assert found.growth_rate == 0
    assert not found.stable
    assert not found.growing.size
    assert steady_sliding(p.replace(c_p=1.0)).growth_rate != 0
    modes = sliding_modes(p)
    assert np.count_nonzero(modes.growth_rate == 0) == 1
    assert modes.growth_rate.max() == 0
    [ratio] = modes.damping_ratio[modes.growth_rate == 0]
    assert ratio == 0
    assert not np.signbit(ratio)


# ------------------------------------------------------------------------ modes


@pytest.mark.parametrize("modes", [([2, 1, 3], [0, 1, 1], [0.4, 0.35, 0.25]), ([0], [0], [1.0])])
def test_a_mode_has_the_circles_of_most_energy_and_the_shares_of_a_mass_on_springs(modes):
    """Modes of 1000 rad/s and the mass on 1e6 N/m move together at the square root of 4e6/3."""
    diameters, circles, energies = modes
    n = len(diameters)
    disc = Disc(
        diameters=diameters,
        circles=circles,
        omega=[1000.0] * n,
        amplitude=np.sqrt(energies).tolist(),
        damping_ratio=[0.0] * n,
    )
    springs = {"k": 1e6, "k_p": 1e-3, "m": 0.5, "mu_s": 0, "mu_k": 0, "contact": "bilateral"}
    found = sliding_modes(Parameters(N=1, Omega=1e-3, disc=disc, **springs))
    i = np.argmin(np.abs(2 * np.pi * found.frequency - np.sqrt(4e6 / 3)))
    assert (found.diameters[i], found.circles[i]) == (diameters[0], circles[0])
    assert found.disc[i] == pytest.approx(7 / 12, abs=1e-3)


def test_modes_are_the_eigenvalues_of_steady_sliding():
    """With what brake engineers read from them: frequency in Hz, damping ratio, number of unstable
    modes."""
    p = Parameters(N=385, Omega=20, normalization="orthonormal")
    sliding = steady_sliding(p)
    modes = sliding_modes(p)
    values = modes.growth_rate + 2j * math.pi * modes.frequency
    oscillating = sliding.eigenvalues[sliding.eigenvalues.imag > 0]
    order = np.argsort(oscillating.imag)
    np.testing.assert_allclose(values, oscillating[order], rtol=1e-10)
    sizes = np.abs(values)
    ratios = -modes.growth_rate / sizes
    np.testing.assert_allclose(modes.damping_ratio, ratios, rtol=1e-12)
    # a two-diameter mode of a disc in the space of nine has another one beside it
    assert sorted(modes.diameters) == [-1, 0, 1, 1, 2, 2, 3, 3, 4, 4]
    assert sliding.growing.size == np.sum(modes.growth_rate > 0) == 3


def test_a_real_eigenvalue_counts_as_an_unstable_mode():
    """Divergence under a moving spring: between omega / l and sqrt(omega^2 + k psi^2) / l,
    docs/verification.md."""
    disc = Disc(diameters=[2], omega=[1823.881], amplitude=[2.1491])
    p = Parameters(N=1, Omega=900, mu_s=0, mu_k=0, contact="bilateral", disc=disc)
    cases = [p.replace(Omega=Omega) for Omega in (900, 930, 950)]
    counts = [steady_sliding(case).growing.size for case in cases]
    assert counts == [0, 1, 0]
    # the two modes of the pair meet at the frequency 0, and part again
    found = follow_modes(cases)
    numbers = [sorted(one.numbers) for one in found]
    assert numbers == [[0, 1, 2], [1, 2], [0, 1, 2]]


def test_modes_keep_their_numbers_where_frequencies_cross():
    """In the slider's frame waves of two diameters against it fall by 2 Omega, and cross those of
    one, which rise."""
    disc = Disc(diameters=[1, 2], omega=[1000, 1100], amplitude=[1e-3, 1e-3])
    p = Parameters(N=1, Omega=1, mu_s=0, mu_k=0, contact="bilateral", disc=disc)
    slow = p.replace(Omega=1.0)
    fast = p.replace(Omega=60.0)
    first, last = follow_modes([slow, fast])
    assert first.numbers.tolist() == [0, 1, 2, 3, 4]
    assert last.numbers.tolist() != [0, 1, 2, 3, 4]
    assert waves_by_number(last) == waves_by_number(first)
    at_rest = {1: 1000.0, 2: 1100.0}
    modes = last.modes
    for i, l in enumerate(modes.diameters.tolist()):
        if l == -1:
            expected = math.sqrt(p.k_p / p.m)
        else:
            # with the slider the wave seems slower
            sense = 2 * round(modes.forward[i]) - 1
            expected = at_rest[l] - sense * l * 60.0
        omega = math.tau * modes.frequency[i]
        assert omega == pytest.approx(expected, abs=6e-3)


def waves_by_number(followed):
    """Nodal diameters of each mode by its number, and whether its wave turns with the slider."""
    modes = followed.modes
    turns = (modes.diameters > 0) & (modes.forward > 0.5)
    waves = zip(modes.diameters.tolist(), turns.tolist(), strict=True)
    return dict(zip(followed.numbers.tolist(), waves, strict=True))


def roots_of_energies(p, shapes):
    """Of each row of modes' shapes: its energy is the square of the modulus. Of the disc, and of the
    slider in its plane and on its springs across."""
    modes = mode_arrays(p)
    omega = modes.omega[:, None]
    (a, alpha, b, beta), (psi, f), (u, _) = split_rows(modes, shapes)
    disc = np.concatenate([omega * a, alpha, omega * b, beta])
    in_plane = p.r_0 * np.array([math.sqrt(p.k_p) * psi, math.sqrt(p.m) * f])
    across = math.sqrt(p.k + 1 / p.contact_compliance) * u
    return disc, in_plane, across


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_modes_are_named_by_their_energies():
    """Where the slider's frequency passes those of the disc most of the energy passes from one to
    the other."""
    base = Parameters(
        N=385, Omega=20, normalization="orthonormal", contact_compliance=1e-7, c_p=0.5
    )
    l = mode_arrays(base).diameters
    kinds = set()
    stiffnesses = np.geomspace(1.8e5, 3.6e5, 25).tolist()
    lasts = [base.replace(k_p=k_p) for k_p in stiffnesses]
    # here not |f| but its square tells whose motion it is
    lasts.append(base.replace(N=3e4, m=100.0, k_p=3.468e8))
    for last in lasts:
        modes = sliding_modes(last)
        roots = roots_of_energies(last, modes.shapes)

        # the name is that of most energy
        disc, slider = (np.abs(rows) ** 2 for rows in roots[:2])
        by_l = np.array([disc[np.tile(l, 4) == number].sum(axis=0) for number in range(5)])
        in_plane = slider.sum(axis=0) > disc.sum(axis=0)
        expected = np.where(in_plane, -1, by_l.argmax(axis=0))
        np.testing.assert_array_equal(modes.diameters, expected)
        kinds.add(tuple(expected))
    assert len(kinds) > 2, "the energy does not pass on"


def test_a_step_that_changes_modes_much_is_halved():
    """Of a slider ten times as light; matched at once, three modes of the disc change places."""
    p = Parameters(N=385, Omega=20, normalization="orthonormal")
    wide = follow_modes([p.replace(m=0.1), p.replace(m=0.01)])
    masses = np.linspace(0.1, 0.01, 120).tolist()
    narrow = follow_modes([p.replace(m=m) for m in masses])
    numbers = narrow[-1].numbers
    np.testing.assert_array_equal(wide[-1].numbers, numbers)


# one pair of modes without damping, whose diameters turn at omega / l = 911.94 rad/s, and rates at
# which the slider is as fast as the drive, from the equations of docs/model.md alone
PAIR = Parameters(
    N=1.0,
    Omega=911.0,
    disc=Disc(diameters=[2], omega=[1823.881], amplitude=[2.1491], damping_ratio=[0.0]),
    r_0=0.1,
    k=1e3,
    m=1e-6,
    mu_s=0.3,
    mu_k=0.3,
    k_p=2e4,
    friction_offset=1e-3,
)
PLATE = Parameters(N=385, Omega=920, normalization="orthonormal", friction_offset="surface")


def equations_of_pair(g: float, Omega: float) -> tuple[float, float]:
    """Contact force (N), and what the slider's rate has over the drive's (rad/s)."""
    l, w, psi, t, k = 2, 1823.881, 2.1491, -1e-3 / 0.1 * 2 * 2.1491, 1e3
    gap = (l * g) ** 2 - w**2
    force = PAIR.N * (1 + k * psi**2 / w**2) / (1 - k * psi**2 / gap)
    return force, g + g * l * t * psi * force / gap / 0.1 - Omega


@pytest.mark.parametrize(
    ("Omega", "count"), [(911.8, 2), (911.95, 2), (912.2, 2), (912.5, 1), (912.6, 1), (913.0, 1)]
)
def test_all_equilibria_on_a_moving_surface_are_found(Omega: float, count: int) -> None:
    """Near omega / l there are two; a search from the drive's rate found one or none."""
    sliding = steady_sliding(PAIR.replace(Omega=Omega))
    assert len(sliding.rates) == count
    assert sliding.status == ("several" if count > 1 else "ok")
    for rate in sliding.rates:
        force, excess = equations_of_pair(rate, Omega)
        assert force > 0
        assert abs(excess) < 1e-6
    # the one nearest to the drive's rate
    assert sliding.rate == min(sliding.rates, key=lambda rate: abs(rate - Omega))
    assert sliding.contact_force == pytest.approx(
        equations_of_pair(sliding.rate, Omega)[0], rel=1e-6
    )


@pytest.mark.parametrize(
    ("Omega", "rates"), [(920, [956.256]), (930, [957.553]), (950, [920.117, 963.174])]
)
def test_equilibria_of_the_plate_beyond_a_resonance_are_found(Omega, rates) -> None:
    sliding = steady_sliding(PLATE.replace(Omega=Omega))
    assert sliding.status is SlidingStatus.SEVERAL
    for rate in rates:
        assert np.abs(sliding.rates - rate).min() < 1e-3
