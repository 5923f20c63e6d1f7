"""Friction that falls with the speed: the package against references, and its way to the paper's
law."""

import numpy as np
import pytest

from disc_model import Parameters, continue_cycle, floquet, simulate, steady_sliding
from disc_model.engine import transitions
from disc_model.engine.record import EVENT_ROW
from disc_model.stability.return_map import ReturnMap
from tests.contact_laws import COUPLE, COUPLED, EXPONENTIAL, FALLING, LAWS, VISCOUS
from tests.references import stored, taylor
from tests.validation.agree import followed
from tests.validation.test_friction_couple import compare_sliding

P = Parameters(N=385, Omega=15.1, n_diameters=1)
FALLING_QUICK = ("vertical_falling", "vertical_exponential")
EACH_LAW = [
    pytest.param(name, marks=() if name in FALLING_QUICK else pytest.mark.slow) for name in FALLING
]
BONDED = {"bilateral_coupled": COUPLE | {"contact": "bilateral"}}
QUICK = (
    "vertical_coupled",
    "bilateral_coupled",
)  # whose kernels the quick tests compile in any case
COUPLES = [
    pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in COUPLED | BONDED
]


@pytest.mark.compiled
@pytest.mark.parametrize("law", [*EACH_LAW, *COUPLES])
def test_events_are_those_of_the_reference_and_the_energy_balances(law):
    """Of a violent piece with separations and impacts, and of slip and stick from rest."""
    p = Parameters(N=385, Omega=15.1, c=0.3, c_p=0.2, **(FALLING | COUPLED | BONDED)[law])
    violent = stored.rounded(taylor.violent_start(1.3))
    for start, span in ((violent, 0.012), (None, 0.05)):
        run, _ = followed(p, span, start)
        assert len(run.events) >= 3


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize(("law", "span"), [({}, 0.6), (EXPONENTIAL | VISCOUS, 1.0)])
def test_a_long_motion_with_separations_and_backward_slips(law, span):
    """Some thousand events: 2.4e-10 s and 2.2e-11 s off were measured."""
    p = Parameters(N=385, Omega=2, c=3, c_p=0.2, contact_compliance=1e-6, **COUPLE | law)
    q = taylor.problem_of(p)
    start = taylor.violent_start(1.3)
    a, b, alpha, beta = (np.array(getattr(start, name)) for name in stored.MODAL)
    start.u = q.s @ a + 1e-5
    rate = start.f - q.surface_speed(beta) / q.r_0
    start.u_velocity = q.s @ (alpha + q.l * rate * b)
    run, _ = followed(p, span, stored.rounded(start), tol=1e-13, within=5e-9)
    assert len(run.events) > 2126
    assert run.statistics["n_separations"] > 377
    assert np.sum(run.event_rows[:, EVENT_ROW.index("direction")] < 0) > 10


@pytest.mark.parametrize("law", FALLING)
@pytest.mark.parametrize("decay", [0.0, 0.5, 20.0])
def test_growth_rates_of_steady_sliding(law, decay):
    """All eigenvalues at three speeds."""
    for Omega in (2.0, 15.1, 50.0):
        compare_sliding(Parameters(N=385, Omega=Omega, **FALLING[law] | {"friction_decay": decay}))


@pytest.mark.parametrize(
    ("law", "decays", "sliding"),
    [
        # by the hyperbola steady sliding comes as 1/d, and by exp(-d v) without a difference
        ("hyperbolic", (1e4, 1e5, 1e6), 0.01),
        ("exponential", (1e3, 1e4, 1e5), 0.0),
    ],
)
def test_fast_decay_comes_to_the_paper_s_law(law, decays, sliding):
    """Event times, as ln(d)/d."""
    paper = simulate(P, 0.05, tol=1e-13).events["time"].to_numpy()
    rate = steady_sliding(P).growth_rate
    late = []
    rates = []
    for decay in decays:
        p = P.replace(friction_decay=decay, friction_law=law)
        apart = np.abs(simulate(p, 0.05, tol=1e-13).events["time"].to_numpy() - paper).max()
        late.append(apart * decay / np.log(decay))
        rates.append(abs(steady_sliding(p).growth_rate - rate) * decay)
    assert np.ptp(late) < 0.1 * late[0]
    assert np.ptp(rates) <= sliding * rates[0] + 1e-5


def test_a_drop_of_friction_of_no_height_is_none():
    flat = P.replace(mu_s=0.24)
    falling = simulate(flat.replace(friction_decay=1.0), 0.05)
    assert falling.events.equals(simulate(flat, 0.05).events)


@pytest.mark.compiled
def test_a_friction_limit_that_is_only_touched_releases_nothing():
    """Newton's method took points of the section where the limit rises for cycles of no
    duration."""
    p = Parameters(N=385, Omega=10, c_p=1, friction_decay=3, normalization="orthonormal")
    map_ = ReturnMap(p)
    outcomes = []
    for velocity in (0.1, -0.1):  # of all modes, over the deflection's
        x = map_.static.copy()
        x[map_.size // 2 :] += velocity * map_.deflection
        outcomes.append(map_.evaluate(x, tangent=False).outcome)
    assert outcomes == [transitions.RETURNED, transitions.OFF_SECTION]
    assert floquet(p).status == "no_cycle"


@pytest.mark.compiled
def test_the_fold_of_the_quiet_cycle_comes_to_the_paper_s():
    """By continuation in speed; and in the decay itself, from a cycle to that of another decay."""
    folds = []
    for decay in (1e4, 1e6, np.inf):
        branch = continue_cycle(
            Parameters(N=385, Omega=14.9, friction_decay=decay), "Omega", (14.8, 15.2)
        )
        assert len(branch.folds) == 1
        folds.append(branch.values.max())
    assert 15.11 < folds[0] < 15.12
    assert 0 < folds[1] - folds[2] < 0.02 * (folds[0] - folds[2])
    branch = continue_cycle(
        Parameters(N=385, Omega=14, friction_decay=50), "friction_decay", (40, 100)
    )
    reached = Parameters(N=385, Omega=14, friction_decay=branch.values[-1])
    assert branch.growth_rate[-1] == pytest.approx(floquet(reached).growth_rate, abs=1e-8)


EXACT = [
    (decay, {"friction_law": law})
    for decay in (3.0, 1e3, 1e9)
    for law in ("hyperbolic", "exponential")
]


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("decay", "law"),
    [
        *EXACT,
        (np.inf, LAWS["compliant_normal"]),
        *(
            pytest.param(np.inf, LAWS[law], marks=pytest.mark.slow)
            for law in ("compliant", "normal")
        ),
    ],
)
def test_event_times_are_as_exact_as_the_tolerance_says(decay, law):
    """Up to three times `tol` after a second and a half, four times with a compliant contact; they
    were up to 3000 times as far off."""
    p = Parameters(N=385, Omega=15.1, friction_decay=decay, **law)
    right = simulate(p, 1.5, tol=1e-15).events["time"]
    allowed = 4 if p.contact_compliance else 3
    for tol in (1e-8, 1e-10, 1e-12):
        assert np.abs(simulate(p, 1.5, tol=tol).events["time"] - right).max() < allowed * tol


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize(
    ("law", "largest"),
    [
        ({}, 32),
        ({"contact_force": "normal"}, 59),
        ({"friction_offset": "surface"}, 18),
        ({"friction_decay": 30.0, "viscous_friction": 0.01}, 22),
        ({"friction_decay": 30.0, "viscous_friction": 0.01, "friction_law": "exponential"}, 21),
    ],
)
def test_near_a_resonance_errors_are_as_large_as_the_page_says(law, largest):
    """In units of `tol`, at most speeds below three; of the largest the last digit may differ
    between processors."""
    errors = []
    for Omega in np.arange(8, 30, 0.25):
        p = Parameters(N=385, Omega=float(Omega), **law)
        right = simulate(p, 1.0, tol=1e-15).events["time"]
        each = [
            np.abs(simulate(p, 1.0, tol=tol).events["time"] - right).max() / tol
            for tol in (1e-8, 1e-10)
        ]
        errors.append(each)
    loose, default = np.array(errors).T
    assert max(loose.max(), default.max()) == pytest.approx(largest, rel=0.1)
    assert np.sum(default < 3) >= 78
