"""`simulate` and its series under every law of contact: compliant or rigid, force vertical or normal."""

import numpy as np
import pytest

from disc_model import Parameters, Record, Window, plate_modes, simulate
from disc_model.engine import layout
from disc_model.simulation.api import static_start
from tests.contact_laws import COMPILES, EACH_LAW, LAWS, classical_events, compare_series
from tests.references import stored, taylor
from tests.references.printed import MOTIONS

#: s; what the issue asks for. Rounding of the engine's doubles alone is some 1e-15 s in quiet motion.
EVENT_TIMES = 1e-13


def _difference(name, runs, tol, record=None):
    """Largest difference of event times (s) and of contact forces (N), all switches being there, in order."""
    data, times, forces = stored.load(f"contact_{name}"), [0.0], [0.0]
    p = Parameters(**data["parameters"])
    for run in data["runs"][runs]:
        start = stored.engine_state(run["start"], p) if run["start"] else None
        result = simulate(p, run["t_end"], tol=tol, initial_state=start, record=record)
        events = result.events
        if record is not None:
            assert result.statistics["energy_residual"] < 1e-13
        assert list(events["kind"]) == run["kinds"]
        if len(events):
            times.append(float(np.abs(events["time"].to_numpy() - stored.times_of(run)).max()))
            forces.append(float(np.abs(events["P"].to_numpy() - run["P"]).max()))
    return max(times), max(forces)


@pytest.mark.parametrize("name", EACH_LAW)
def test_two_violent_pieces(name):
    """Short enough to run uncompiled: all phases and switches, each step's energy balance."""
    times, forces = _difference(name, slice(1, 3), 1e-14, Record(audit_every_step=True))
    assert times <= EVENT_TIMES
    assert forces <= 1e-6  # some kN pass; the rounding of u is felt as 1e-17/C = 4e-11 N


@pytest.mark.compiled
@pytest.mark.parametrize("name", EACH_LAW)
def test_every_switch_of_a_quiet_second_and_of_half_a_violent_one(name):
    """`tol` promises errors of about that size; up to three times that was measured."""
    assert _difference(name, slice(1, None), 1e-15)[0] <= EVENT_TIMES
    for tol in (1e-6, 1e-8, 1e-10, 1e-12, 1e-15):
        times, forces = _difference(name, slice(0, 1), tol)
        assert times <= (4 * tol if tol > 1e-15 else 0.0) + EVENT_TIMES
    assert forces <= 1e-8  # of 385 N; a compliant contact feels a rounding of u as 1e-18/C = 4e-12 N at least


@pytest.mark.compiled
def test_release_by_the_slope_s_acceleration_is_found_as_exactly_as_all_else():
    """Steps looked at the contact force alone: a release of a heavy slider on a disc of many modes was 5e-13 s off."""
    disc = {"a": 0.0327, "b": 0.0952, "r_0": 0.0927, "h": 0.0011, "E": 86e9, "D_star": 1e-6, "n_diameters": 4}
    slider = {"m": 0.197, "k": 0.0, "c": 0.0, "k_p": 5168.0, "c_p": 0.0, "mu_s": 0.72, "mu_k": 0.35}
    laws = {"normalization": "orthonormal", "contact": "bonded", "contact_force": "normal"}
    p = Parameters(N=187.0, Omega=11.7, **disc, **slider, **laws)
    q = taylor.problem_of(p)
    wanted = [float(event["time"]) for event in taylor.Reference(q, q.equilibrium()).run(0.15).events]
    assert len(wanted) > 4
    assert simulate(p, 0.15, tol=1e-14).events["time"].to_numpy() == pytest.approx(wanted, abs=EVENT_TIMES, rel=0)


# ------------------------------------------------------------------------ where nothing but the disc's slope pulls
RIGID_OR_NOT = [pytest.param(0.0, marks=COMPILES), 1e-7]
SLOPING = {"n_diameters": 1, "contact_force": "normal", "mu_s": 0.02, "mu_k": 0.01}


def _swinging(p, psi=0.0, **modal):
    """The static start, but psi, and one of the mode's coordinates across the slider's direction."""
    start = static_start(p)
    return start.replace(psi=psi, **{name: np.array([0.0, value]) for name, value in modal.items()})


@pytest.mark.parametrize("give", RIGID_OR_NOT)
@pytest.mark.parametrize(
    ("modal", "psi"), [({"beta": 3.0}, 0), ({"beta": -3.0}, 0), ({"b": 2e-3}, 0), ({"beta": 3.0}, 1e-5)]
)
@pytest.mark.parametrize("weak", ["k_p", "Omega"])
def test_a_slope_pulls_as_without_as_with_a_feeble_drive(weak, modal, psi, give):
    """Without any the slider stuck, however steep the disc: the limit of contact alone was looked for."""
    p = Parameters(N=200, Omega=20, contact_compliance=give, **SLOPING)
    found = []
    for value in (0.0, 1e-10):
        case = p.replace(**{weak: value})
        found.append(simulate(case, 8e-4, initial_state=_swinging(case, psi, **modal)))
    none, feeble = found
    assert none.events["kind"].iloc[0] == "stick_to_slip"
    assert list(none.events["kind"]) == list(feeble.events["kind"])
    # the feeble drive moves events by its share in the friction limit, 1e-10 rad/s times 20 kN/m in N
    np.testing.assert_allclose(none.events["time"], feeble.events["time"], rtol=0, atol=1e-9)
    assert none.final_state.f == pytest.approx(feeble.final_state.f, rel=1e-6)


@pytest.mark.parametrize("give", RIGID_OR_NOT)
def test_contact_ends_where_its_force_does_although_friction_ends_there_too(give):
    p = Parameters(N=200, Omega=20, k_p=0, contact_compliance=give, **SLOPING)
    upward = np.array([0.0, 1.5])
    velocity = float(plate_modes(p)["psi"] @ upward)
    thrown = simulate(p, 8e-4, initial_state=_swinging(p, b=1e-5).replace(alpha=upward, u_velocity=velocity))
    assert list(thrown.events["kind"])[:1] == ["separation"]


def test_a_compliant_contact_does_not_pull_where_friction_holds_on_a_steep_slope():
    """The slider stuck on, drawn down by a contact that had opened, until friction gave way."""
    p = Parameters(N=200, Omega=20, **SLOPING | LAWS["compliant_normal"] | {"mu_s": 2.0, "mu_k": 0.1})
    psi = plate_modes(p)["psi"].to_numpy()
    upward = np.array([0.0, 6.0]) * np.sign(psi)  # kg^1/2 m/s
    start = _swinging(p, 0.01, b=0.8 * p.r_0 / psi[1]).replace(alpha=upward, u_velocity=float(psi @ upward))
    record = Record(windows=(Window(start=0.0, stop=2e-4, rate=1e6),), audit_every_step=True)
    result = simulate(p, 2e-4, initial_state=start, record=record, tol=1e-14)
    assert list(result.events["kind"]) == ["separation"]
    sample = result.samples[0]
    held = sample["phase"] == layout.STICK
    assert (sample["w"] - sample["u"])[held].min() >= 0
    assert sample["P"][held].min() > 1.0  # normal to the disc it presses to the end
    reference = taylor.Reference(taylor.problem_of(p), stored.reference_state(start, p)).run(2e-4)
    assert [event["kind"] for event in reference.events] == ["separation"]
    assert result.events["time"][0] == pytest.approx(float(reference.events[0]["time"]), abs=EVENT_TIMES)


# ------------------------------------------------------------------------ the series, coefficient by coefficient
@pytest.mark.parametrize("name", ["default", *LAWS])
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
@pytest.mark.parametrize("n_diameters", [pytest.param(n, marks=COMPILES) for n in (2, 5)])
@pytest.mark.parametrize("rates", [None, (-9e3, 7e5)], ids=["constant", "ramps"])
def test_series_against_the_reference(name, phase, direction, n_diameters, rates):
    """One block of lanes and two."""
    compare_series(LAWS.get(name, {}), phase, direction, n_diameters, rates)


# ------------------------------------------------------------------------ energy
@pytest.mark.compiled
@pytest.mark.parametrize("name", [*EACH_LAW, "default"])
def test_energy_balances_over_ten_thousand_switches(name):
    p = Parameters(N=385.0, Omega=15.1, **LAWS.get(name, {}))
    start = stored.engine_state(taylor.violent_start(1.3), p)
    result = simulate(p, 40.0, tol=1e-15, initial_state=start, record=Record(audit_every_step=True, events=False))
    statistics = result.statistics
    assert statistics["events"] > 10_000
    assert statistics["audited_steps"] == statistics["steps"]
    assert max(statistics["energy_residual_transverse"], statistics["energy_residual_inplane"]) < 1e-12


# ------------------------------------------------------------------------ limits
@pytest.mark.parametrize("name", ["default", *EACH_LAW, pytest.param("bonded", marks=pytest.mark.slow)])
def test_a_rigid_disc_gives_the_classical_cycle(name):
    """More events than the engine keeps room for at first."""
    law = {"default": {}, "bonded": {"contact": "bonded"}} | LAWS
    p = Parameters(N=385.0, Omega=15.1, n_diameters=-1, **law[name])
    events = simulate(p, 2.0, tol=1e-13).events
    assert set(events["kind"]) == {"stick_to_slip", "slip_to_stick"}
    assert len(events) > 256
    # the clock reads up to 2 s
    np.testing.assert_allclose(events["time"], classical_events(p, len(events)), rtol=0, atol=2e-13)
    np.testing.assert_allclose(events["P"], p.N, rtol=1e-12)


def test_a_stiff_contact_does_not_shorten_the_steps_of_a_flight():
    """They were at most eight radians of the motion on the contact, which a flight has nothing of."""
    steps = []
    for give in (1e-7, 1e-9):
        p = Parameters(N=385.0, Omega=15.1, contact_compliance=give, contact_force="normal")
        start = static_start(p)
        # 1.4 of the 1.6 ms that a fall of 5 mm takes: hundreds of radians on the stiffer contact, 6 of the disc
        high = start.replace(phase="separation", u=start.u + 5e-3, u_velocity=0.0, f=5.0)
        result = simulate(p, 1.4e-3, initial_state=high)
        assert result.final_state.phase == "separation"
        steps.append(result.statistics["steps"])
    # a radian of the disc a step, and more; 5 and 6 were found
    assert max(steps) <= 8
