"""`simulate` under every law of contact: compliant or rigid, force vertical or
normal."""

import numpy as np
import pytest

from disc_model import Execution, Parameters, Window, plate_modes, simulate
from disc_model.engine.state import STICK
from disc_model.simulation.states import static_start
from tests.contact_laws import ALL_LAWS, COMPILES, COUPLE, LAWS
from tests.references import stored, taylor
from tests.references.block import undamped_stick_slip
from tests.validation.agree import followed

# Kernels of each law take minutes to compile: the quick tests try the law that has both, the long
# ones all.
EACH_LAW = [
    pytest.param(name, marks=() if name == "compliant_normal" else pytest.mark.slow, id=name)
    for name in LAWS
]


@pytest.mark.compiled
@pytest.mark.parametrize("name", EACH_LAW)
def test_every_switch_of_a_quiet_and_of_a_violent_motion(name):
    p = Parameters(N=385, Omega=15.1, **LAWS[name])
    violent = stored.rounded(taylor.violent_start(1.3))
    for start, span in ((None, 0.2), (violent, 0.03)):
        run, _ = followed(p, span, start)
        assert len(run.events) >= 10


@pytest.mark.compiled
def test_release_by_the_slope_s_acceleration_is_found_as_exactly_as_all_else():
    """Steps looked at the contact force alone: a release of a heavy slider on a disc of many modes
    was 5e-13 s off."""
    disc = {
        "a": 0.0327,
        "b": 0.0952,
        "r_0": 0.0927,
        "h": 0.0011,
        "E": 86e9,
        "D_star": 1e-6,
        "n_diameters": 4,
    }
    slider = {"m": 0.197, "k": 0.0, "c": 0.0, "k_p": 5168.0, "c_p": 0.0, "mu_s": 0.72, "mu_k": 0.35}
    laws = {"normalization": "orthonormal", "contact": "bilateral", "contact_force": "normal"}
    p = Parameters(N=187.0, Omega=11.7, **disc, **slider, **laws)
    run, _ = followed(p, 0.15, tol=1e-14)
    assert len(run.events) > 4


# ------------------------------------------------------------------------ where nothing but the
# disc's slope pulls
RIGID_OR_NOT = [pytest.param(0.0, marks=COMPILES), 1e-7]
SLOPING = {"n_diameters": 1, "contact_force": "normal", "mu_s": 0.02, "mu_k": 0.01}


def _swinging(p, psi=0.0, **modal):
    """The static start, but psi, and one of the mode's coordinates across the slider's
    direction."""
    start = static_start(p)
    arrays = {name: np.array([0.0, value]) for name, value in modal.items()}
    return start.replace(psi=psi, **arrays)


@pytest.mark.parametrize("give", RIGID_OR_NOT)
@pytest.mark.parametrize(
    ("modal", "psi"),
    [({"beta": 3.0}, 0), ({"beta": -3.0}, 0), ({"b": 2e-3}, 0), ({"beta": 3.0}, 1e-5)],
)
@pytest.mark.parametrize("weak", ["k_p", "Omega"])
def test_a_slope_pulls_as_without_as_with_a_feeble_drive(weak, modal, psi, give):
    """Without any the slider stuck, however steep the disc: the limit of contact alone was looked
    for."""
    p = Parameters(N=200, Omega=20, contact_compliance=give, **SLOPING)
    found = []
    for value in (0.0, 1e-10):
        case = p.replace(**{weak: value})
        found.append(simulate(case, 8e-4, initial_state=_swinging(case, psi, **modal)))
    none, feeble = found
    assert none.events["kind"].iloc[0] == "stick_to_slip"
    assert list(none.events["kind"]) == list(feeble.events["kind"])
    # the feeble drive moves events by its share in the friction limit, 1e-10 rad/s times 20 kN/m in
    # N
    np.testing.assert_allclose(none.events["time"], feeble.events["time"], rtol=0, atol=1e-9)
    assert none.final_state.f == pytest.approx(feeble.final_state.f, rel=1e-6)


@pytest.mark.parametrize("give", RIGID_OR_NOT)
def test_contact_ends_where_its_force_does_although_friction_ends_there_too(give):
    p = Parameters(N=200, Omega=20, k_p=0, contact_compliance=give, **SLOPING)
    upward = np.array([0.0, 1.5])
    velocity = float(plate_modes(p)["psi"] @ upward)
    thrown = simulate(
        p, 8e-4, initial_state=_swinging(p, b=1e-5).replace(alpha=upward, u_velocity=velocity)
    )
    assert list(thrown.events["kind"])[:1] == ["separation"]


def test_a_compliant_contact_does_not_pull_where_friction_holds_on_a_steep_slope():
    """The slider stuck on, drawn down by a contact that had opened, until friction gave way."""
    p = Parameters(
        N=200, Omega=20, **SLOPING | LAWS["compliant_normal"] | {"mu_s": 2.0, "mu_k": 0.1}
    )
    psi = plate_modes(p)["psi"].to_numpy()
    upward = np.array([0.0, 6.0]) * np.sign(psi)  # kg^1/2 m/s
    start = _swinging(p, 0.01, b=0.8 * p.r_0 / psi[1]).replace(
        alpha=upward, u_velocity=float(psi @ upward)
    )
    run, _ = followed(p, 2e-4, stored.reference_state(start, p), tol=1e-14)
    assert list(run.events["kind"]) == ["separation"]
    window = {"all": Window(start=0.0, stop=2e-4, rate=1e6)}
    sample = simulate(p, 2e-4, window, initial_state=start, tol=1e-14).samples["all"]
    held = sample["phase"] == STICK
    assert (sample["w"] - sample["u"])[held].min() >= 0
    assert sample["P"][held].min() > 1.0  # normal to the disc it presses to the end


# ------------------------------------------------------------------------ energy


#: Laws on a moving surface, with bilateral contact, and under a pad, are left to the long tests.
BALANCED = LAWS | {
    "default": {},
    **{name: law for name, law in ALL_LAWS.items() if "friction_offset" in law},
    "bilateral_coupled": COUPLE | {"contact": "bilateral"},
    "pad_coupled": COUPLE | {"contact_arc": 0.4},
}
QUICK = ("default", "compliant_normal")


@pytest.mark.compiled
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in BALANCED],
)
def test_energy_balances_over_ten_thousand_switches(name):
    """In both directions, over 40 s of violent motion."""
    p = Parameters(N=385.0, Omega=15.1, **BALANCED[name])
    start = stored.engine_state(taylor.violent_start(1.3), p)
    if p.contact_arc:  # the disc is elsewhere under a pad
        start = start.replace(u=float(plate_modes(p)["psi"].to_numpy() @ start.a) + 1e-5)
    execution = Execution(audit_every_step=True)
    result = simulate(p, 40.0, events=False, tol=1e-15, initial_state=start, execution=execution)
    statistics = result.statistics
    assert statistics["n_events"] > 10_000
    assert statistics["audited_steps"] == statistics["steps"]
    for part in ("transverse", "inplane"):
        assert statistics[f"energy_residual_{part}"] < 1e-12
    if p.friction_offset:
        phases = ["stick", "slip", "separation"][: 2 if p.contact == "bilateral" else 3]
        assert all(statistics[f"time_{phase}"] > 0.5 for phase in phases)


# ------------------------------------------------------------------------ limits
@pytest.mark.parametrize(
    "name", ["default", *EACH_LAW, pytest.param("bonded", marks=pytest.mark.slow)]
)
def test_a_rigid_disc_gives_the_classical_cycle(name):
    """More events than the engine keeps room for at first."""
    law = {"default": {}, "bonded": {"contact": "bilateral"}} | LAWS
    p = Parameters(N=385.0, Omega=15.1, n_diameters=-1, **law[name])
    events = simulate(p, 2.0, tol=1e-13).events
    assert set(events["kind"]) == {"stick_to_slip", "slip_to_stick"}
    assert len(events) > 256
    # the clock reads up to 2 s
    cycle = undamped_stick_slip(p)
    release = p.mu_s * p.N / (p.k_p * p.r_0 * p.Omega)
    times = release + np.arange(len(events)) // 2 * cycle.period
    times[1::2] += cycle.slip
    np.testing.assert_allclose(events["time"], times, rtol=0, atol=2e-13)
    np.testing.assert_allclose(events["P"], p.N, rtol=1e-12)
