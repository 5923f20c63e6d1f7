"""Friction that follows the slip speed on a moving surface: `simulate` against long-double runs in
material coordinates (`tests.references.taylor`), and what follows from the law."""

from pathlib import Path

import numpy as np
import pytest

import disc_model as dm
from disc_model import Disc, Execution, Parameters, Window, simulate
from disc_model.simulation.states import engine_case, perturb, slip_rate, static_start, surface_rate
from tests.references import stored, taylor
from tests.references.printed import P as LIVELY
from tests.references.printed import lively
from tests.refusals import refusal

BRAKE = Disc.from_csv(Path("config/discs/brake.csv"))
PAD = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "m": 0.5, "mu_s": 0.45, "mu_k": 0.35}


def brake(N: float, Omega: float, **law) -> Parameters:
    """The brake-like disc with friction on its surface."""
    return Parameters(N=N, Omega=Omega, disc=BRAKE, friction_offset="surface", **PAD, **law)


def thick(N: float, Omega: float, **law) -> Parameters:
    """The paper's disc with friction ten thicknesses above it, which shows at once."""
    return Parameters(N=N, Omega=Omega, **{"friction_offset": 0.02, **law})


def violent(p: Parameters, scale: float) -> dm.State:
    """A start out of contact, far from equilibrium."""
    return stored.engine_state(taylor.violent_start(scale), p)


def backwards(p: Parameters) -> dm.State:
    """The static start, its slider slipping backwards on a surface that vibrates."""
    start = perturb(p, static_start(p), u_velocity=0.05)
    paired = dm.plate_modes(p)["diameters"].to_numpy() > 0
    start = start.replace(beta=0.05 * np.random.default_rng(1).normal(size=len(paired)) * paired)
    return start.replace(phase="slip", direction=-1, f=surface_rate(p, start) - 3.0)


COMPLIANT = {"contact_compliance": taylor.COMPLIANCE}
NORMAL = {"contact_force": "normal"}
FALLING = {"friction_decay": 2.0}
STRIBECK = {"friction_decay": 2.0, "friction_law": "exponential", "viscous_friction": 0.005}
DAMPED = {"c": 0.5, "c_p": 0.5, "normalization": "orthonormal", "friction_offset": 0.05}
#: A case, its start (None: static) and its duration in s. Compliant contact after a violent start is
#: irregular: two runs part by a factor e in 8 ms.
SCENES = {
    "rigid": (brake(8000, 20), None, 0.12),
    "normal, with dampers": (brake(16000, 20, c=20, c_p=50, **NORMAL), None, 0.1),
    "compliant": (brake(8000, 40, contact_compliance=1e-8), None, 0.1),
    "separations": (thick(385, 15.1), violent, 0.2),
    "separations, normal": (thick(385, 15.1, **NORMAL), violent, 0.2),
    "separations, compliant": (thick(385, 15.1, **COMPLIANT), violent, 0.06),
    "separations, compliant, normal, falling": (
        thick(385, 15.1, **COMPLIANT, **NORMAL, **FALLING),
        violent,
        0.05,
    ),
    "separations, falling": (thick(385, 15.1, **FALLING), violent, 0.2),
    "separations, exponential, viscous": (thick(385, 15.1, **STRIBECK), violent, 0.2),
    "separations, compliant, normal, exponential": (
        thick(385, 15.1, **COMPLIANT, **NORMAL, **STRIBECK),
        violent,
        0.05,
    ),
    "rigid, exponential, viscous": (brake(8000, 20, **STRIBECK), None, 0.12),
    "bilateral": (thick(385, 3, contact="bilateral"), violent, 0.2),
    "bilateral, normal, falling": (
        brake(16000, 10, contact="bilateral", friction_decay=1.0, **NORMAL),
        None,
        0.1,
    ),
    "backwards on a surface faster than the drive": (thick(200, 1, **DAMPED), backwards, 0.2),
}
#: What compiles kernels of its own is left to the long tests.
QUICK = (
    "rigid",
    "separations",
    "separations, exponential, viscous",
    "bilateral",
    "backwards on a surface faster than the drive",
)
EACH = [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in SCENES]


@pytest.mark.compiled
@pytest.mark.parametrize("name", EACH)
def test_every_event_is_that_of_the_reference(name: str) -> None:
    p, start, t_end = SCENES[name]
    state = start
    if start is violent:
        state = violent(p, 1.0 if p.contact == "bilateral" else 1.3)
    elif start is backwards:
        state = backwards(p)
    q = taylor.problem_of(p)
    if state is None:
        begin = q.equilibrium()
    else:
        begin = stored.reference_state(state, p)
    reference = taylor.Reference(q, begin).run(t_end)

    audited = Execution(audit_every_step=True)
    result = simulate(p, t_end, initial_state=state, tol=1e-13, execution=audited)
    wanted = [float(event["time"]) for event in reference.events]
    assert list(result.events["kind"]) == [event["kind"] for event in reference.events]
    assert len(wanted) > 20
    np.testing.assert_allclose(result.events["time"], wanted, rtol=0, atol=5e-9)
    # energy closes in every step
    assert result.statistics["energy_residual"] < 1e-12
    # and the material under the slider is where the reference has it
    assert result.final_state.surface_turn == pytest.approx(float(reference.shift), abs=1e-7)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("N", "Omega", "law", "time"),
    [
        (8000, 60, {}, 0.6329979635),
        (8000, 80, {}, 0.3602535215),
        (8000, 120, {}, 0.2333944788),
        (16000, 80, {}, 0.4889389784),
        (16000, 120, {}, 0.3548766209),
        pytest.param(8000, 120, NORMAL, 0.23340722717, marks=pytest.mark.slow),
        pytest.param(
            8000, 120, {"contact_compliance": 1e-8}, 0.07766673811, marks=pytest.mark.slow
        ),
        pytest.param(
            8000, 120, {"contact_compliance": 1e-8, **NORMAL}, 0.0776685172, marks=pytest.mark.slow
        ),
    ],
)
def test_the_brake_like_disc_separates_when_an_independent_program_says(N, Omega, law, time):
    found = simulate(brake(N, Omega, **law), 1, tol=1e-13, stop_at="first_separation")
    assert found.first_separation == pytest.approx(time, abs=1e-8, rel=0)


@pytest.mark.compiled
def test_energy_closes_over_long_runs_with_separations_and_a_surface_faster_than_the_drive():
    p = thick(385, 8)
    audited = Execution(audit_every_step=True)
    result = simulate(p, 20, initial_state=violent(p, 1.3), tol=1e-14, execution=audited)
    statistics = result.statistics
    assert statistics["n_separations"] > 100
    assert statistics["surface_speed"] > 1
    assert statistics["audited_steps"] == statistics["steps"]
    assert statistics["energy_residual_transverse"] < 1e-12
    assert statistics["energy_residual_inplane"] < 1e-12


@pytest.mark.compiled
@pytest.mark.slow
def test_normal_force_and_friction_take_more_than_the_drive_gives() -> None:
    """Nothing but the drive feeds the motion where forces act on both bodies: impacts and friction
    only take."""
    p = thick(385, 15.1, contact_force="normal", D_star=0.0)
    window = {"all": Window(start=0.0, stop=0.05, rate=2e6)}
    start = violent(p, 1.3)
    result = simulate(p, 0.05, window, initial_state=start, tol=1e-13)
    sample = result.samples["all"]
    pull = p.r_0 * p.k_p * sample["psi"]
    work = p.r_0 * p.Omega * float(np.trapezoid(pull, sample["time"]))
    assert energy(p, result.final_state) - energy(p, start) < work - 0.01 * abs(work)
    assert (result.events["kind"] == "reattachment").sum() > 3


def energy(p: Parameters, state: dm.State) -> float:
    """Energy of disc, slider and springs, J."""
    omega = dm.plate_modes(p)["omega"].to_numpy()
    displacements = np.concatenate([omega * state.a, omega * state.b])
    modal = np.concatenate([state.alpha, state.beta, displacements])
    raised = state.u - engine_case(p).model.u_0
    vertical = p.m * state.u_velocity**2 + p.k * raised**2 + 2 * p.N * raised
    plane = p.r_0**2 * (p.m * state.f**2 + p.k_p * state.psi**2)
    return float(np.sum(modal**2) + vertical + plane) / 2


# ------------------------------------------------------------------------------------ states
RAISED = LIVELY.replace(friction_offset=0.02)


def test_a_sticking_slider_moves_with_the_surface() -> None:
    start = lively("stick", 0, RAISED)
    assert start.f == pytest.approx(surface_rate(RAISED, start))
    assert abs(start.f) > 0.1
    end = simulate(RAISED, 1e-6, initial_state=start).final_state
    assert end.phase == "stick"
    assert slip_rate(RAISED, end) == pytest.approx(0.0, abs=1e-12)
    # a push counts from the surface
    pushed = perturb(RAISED, start, f=-1.0)
    assert (pushed.phase, pushed.direction) == ("slip", -1)
    assert slip_rate(RAISED, pushed) == pytest.approx(-1.0)


@pytest.mark.parametrize(
    ("phase", "direction", "off", "phrase"),
    [("stick", 0, 1.0, "in stick, the disc's surface's"), ("slip", 1, -1.0, "less the surface's")],
)
def test_another_speed_than_the_surface_s_is_refused(
    phase: str, direction: int, off: float, phrase: str
) -> None:
    start = lively(phase, direction, RAISED)
    with refusal(phrase):
        wrong = start.replace(f=surface_rate(RAISED, start) + off)
        simulate(RAISED, 1e-6, initial_state=wrong)


# ------------------------------------------------------------------------------------ the disc's shape
def test_samples_and_deflection_show_the_disc_where_the_material_is() -> None:
    """The disc's shape lies about the material under the slider, which the surface has carried
    along: a fixed point would seem to move otherwise."""
    p = LIVELY.replace(friction_offset=0.02)
    start = lively("slip", 1, p)
    q = taylor.problem_of(p)
    reference = taylor.Reference(q, stored.reference_state(start, p)).run(2e-5)
    wanted = reference.sample(p.Omega * 2e-5, 1.0)
    window = {"all": Window(start=0.0, stop=2e-5, rate=1e6)}
    result = simulate(p, 2e-5, window, initial_state=start, tol=1e-14)
    sample = result.samples["all"]
    names = list(taylor.SAMPLED)
    for name in ("w", "w_point", "w_point_velocity", "psi", "psi_velocity"):
        assert sample[name][-1] == pytest.approx(wanted[names.index(name)], rel=1e-9), name
    shown = dm.deflection(p, result.final_state, [p.r_0], [1.0])
    assert float(shown.squeeze()) == pytest.approx(wanted[names.index("w_point")], rel=1e-9)
    assert abs(result.final_state.surface_turn) > 1e-8


# ------------------------------------------------------------------------------------ limits
@pytest.mark.compiled
def test_a_surface_that_hardly_moves_gives_the_paper_s_law() -> None:
    """The paper's law has no branch of this one; with amplitudes of a picometre results are the
    same to rounding."""
    p = Parameters(N=385, Omega=15.1)
    assert engine_case(p).model.has_moving_surface == ()
    usual = simulate(p, 0.3, tol=1e-13).events
    moved = simulate(p.replace(friction_offset=1e-12), 0.3, tol=1e-13).events
    np.testing.assert_allclose(moved["time"], usual["time"], rtol=0, atol=1e-10)
    np.testing.assert_allclose(moved["P"], usual["P"], rtol=1e-7)
