"""Run-up from rest and stops: when a slider is at rest, and that a run says so."""

import math
from collections.abc import Mapping

import numpy as np
import pytest

import disc_model as dm
from disc_model import Parameters, Ramp, State, simulate
from disc_model.disc.plate import mode_arrays, tangential_amplitudes
from disc_model.errors import Status
from disc_model.simulation.rest import holds_for_good
from disc_model.simulation.states import static_start
from tests.contact_laws import LAWS
from tests.references import block
from tests.references.stick import margin_of_stick
from tests.refusals import refusal

pytestmark = pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")

BLOCK = Parameters(n_diameters=-1, N=30, Omega=0.5, m=0.2, k=0, k_p=2e3, mu_s=0.5, mu_k=0.3)
# box on a belt of which the speed rises by 3/50 m/s^2: a published example of stick-slip
BOX = Parameters(
    n_diameters=-1, Omega=0, m=20, k=0, k_p=70, c_p=10, N=196.2, mu_s=1.5, mu_k=1.5, r_0=1, a=0.5, b=2
)  # fmt: skip
# one mode without nodal diameter and damping, whose vibration never changes
SURFACE = {"friction_offset": 0.005}
ONE_MODE = Parameters(N=100, Omega=0, n_diameters=0, D_star=0)


# ------------------------------------------------------------------------ run-up
def test_a_run_up_from_rest_releases_the_slider_where_the_pull_reaches_friction_s_limit() -> None:
    run_up = Ramp(parameter="Omega", to=6, start=0, end=100)
    run = simulate(BOX, 20, ramps=run_up, tol=1e-14)
    expected = block.release_on_run_up(BOX, 0.06)
    assert expected == pytest.approx(11.6961996315, abs=1e-10)  # by DOP853
    assert run.events["time"].iloc[0] == pytest.approx(expected, abs=1e-12)
    assert run.events["kind"].iloc[0] == "stick_to_slip"


@pytest.mark.parametrize("change", [{"k_p": 0}, {"c_p": 0}, {"k_p": 0, "c_p": 0}])
def test_a_damper_or_a_spring_alone_pulls_on_a_run_up(change: Mapping[str, float]) -> None:
    p = BOX.replace(mu_s=0.005, mu_k=0.005, **change)
    run = simulate(p, 5, ramps=Ramp(parameter="Omega", to=6, start=0, end=100))
    if p.k_p == p.c_p == 0:
        assert len(run.events) == 0
        return
    expected = block.release_on_run_up(p, 0.06)
    assert run.events["time"].iloc[0] == pytest.approx(expected, rel=1e-9)


def test_a_run_up_may_begin_after_a_rest() -> None:
    late = simulate(BOX, 20, ramps=Ramp(parameter="Omega", to=6, start=3, end=103))
    expected = 3 + block.release_on_run_up(BOX, 0.06)
    assert late.events["time"].iloc[0] == pytest.approx(expected, rel=1e-9)
    assert late.value_at("Omega", [0, 3, 53]).tolist() == [0, 0, 3]


# ------------------------------------------------------------------------ stop
def test_a_brake_stop_of_an_overdamped_slider_ends_at_rest_as_in_closed_form() -> None:
    p = BLOCK.replace(c_p=60)
    sliding = dm.steady_sliding(p)
    start = static_start(p).replace(phase="slip", direction=1, f=p.Omega, psi=sliding.psi)
    run = simulate(
        p,
        0.5,
        initial_state=start,
        tol=1e-13,
        ramps=Ramp(parameter="Omega", to=0, start=0, end=0.05),
    )
    expected = block.stop_of_overdamped_block(p, p.r_0 * p.Omega / 0.05)
    assert run.events["kind"].tolist() == ["slip_to_stick"]
    assert run.events["time"].iloc[0] == pytest.approx(expected.time, abs=1e-12)
    assert run.final_state.psi * p.r_0 == pytest.approx(expected.stretch, rel=1e-12)
    assert run.status is Status.AT_REST
    assert run.status.complete
    assert run.raise_for_status() is run
    held = p.k_p * expected.stretch
    assert run.message == (
        "at_rest: at t = 0.5 s in stick, the drive stands still, "
        f"and friction holds the slider against {held:.6g} N"
    )
    assert held < p.mu_s * p.N


@pytest.mark.parametrize("pulls", [1.001, 1.7, 4.4, -6.3])
def test_without_a_drive_the_slider_stops_as_a_block_under_dry_friction(pulls: float) -> None:
    p = BLOCK.replace(Omega=0)
    limit = p.mu_s * p.N / p.k_p
    expected = block.stop_of_released_block(p, pulls * limit)
    way = -1
    if pulls > 0:
        way = 1
    start = static_start(p).replace(phase="slip", direction=way, psi=pulls * limit / p.r_0)
    run = simulate(p, 1.0, initial_state=start, tol=1e-13)
    assert run.events["time"].iloc[-1] == pytest.approx(expected.time, rel=1e-11)
    assert run.final_state.psi * p.r_0 == pytest.approx(expected.stretch, abs=1e-12 * limit * 10)
    assert run.status is Status.AT_REST


def test_a_stop_that_is_not_over_and_one_that_a_ramp_ends_are_no_rest() -> None:
    stop = Ramp(parameter="Omega", to=0, start=0, end=0.3)
    again = Ramp(parameter="Omega", to=0.5, start=0.6, end=0.7)
    lighter = Ramp(parameter="N", to=10, start=0.6, end=0.7)
    assert simulate(BLOCK, 0.2, ramps=stop).status is Status.OK
    assert simulate(BLOCK, 0.5, ramps=stop).status is Status.AT_REST
    assert simulate(BLOCK, 0.5, ramps=(stop, again)).status is Status.OK
    assert simulate(BLOCK, 0.5, ramps=(stop, lighter)).status is Status.OK
    moved = simulate(BLOCK, 0.5, ramps=stop).message
    assert "the drive stands still" in moved
    assert "the drive" not in simulate(BLOCK, 0.5).message


def test_a_result_at_rest_survives_its_file(tmp_path) -> None:
    run = simulate(BLOCK, 0.5, ramps=Ramp(parameter="Omega", to=0, start=0, end=0.3))
    path = tmp_path / "run.nc"
    run.save(path)
    again = dm.Result.load(path)
    assert again.status == run.status
    assert again.message == run.message
    assert again.ramps == run.ramps


# ------------------------------------------------------------------------ for good
def vibrating(p: Parameters, share: float, pull: float) -> State:
    """A sticking state of `ONE_MODE` whose contact force swings by a share of what friction has in
    reserve over the pull (N)."""
    modes = mode_arrays(p)
    psi = float(modes.psi[0])
    force_by_way = abs(psi * (p.k - p.m * modes.omega[0] ** 2)) / (1 + p.m * psi**2)
    swing = p.N - pull / p.mu_s
    rest = static_start(p)
    a = rest.a + share * swing / force_by_way
    return rest.replace(a=a, u=float(modes.psi @ a), psi=pull / (p.r_0 * p.k_p))


@pytest.mark.parametrize(("share", "holds"), [(0.999, True), (1.001, False)])
def test_a_vibration_of_one_mode_releases_the_slider_exactly_where_rest_is_denied(share, holds):
    """For one mode the bound by the energy is the amplitude itself."""
    state = vibrating(ONE_MODE, share, pull=0.7 * ONE_MODE.mu_s * ONE_MODE.N)
    run = simulate(ONE_MODE, 0.2, initial_state=state)
    assert (len(run.events) == 0) == holds
    assert holds_for_good(ONE_MODE, state, ONE_MODE.N) == holds
    assert (simulate(ONE_MODE, 1e-4, initial_state=state).status is Status.AT_REST) == holds


def shaken(p: Parameters, energy: float, rng: np.random.Generator) -> State:
    """A sticking state with a random vibration of the disc, and a random pull of the spring."""
    modes = mode_arrays(p)
    rest = static_start(p)
    draw = math.sqrt(energy) * rng.normal(size=(4, len(modes.psi)))
    draw[1, modes.diameters == 0] = 0
    draw[3, modes.diameters == 0] = 0
    a = rest.a + draw[0] / modes.omega
    return rest.replace(
        a=a,
        b=draw[1] / modes.omega,
        alpha=draw[2],
        beta=draw[3],
        f=float(tangential_amplitudes(p) @ draw[3]) / p.r_0,
        u=rest.u + float(modes.psi @ (a - rest.a)),
        u_velocity=float(modes.psi @ draw[2]),
        psi=rng.uniform(-0.9, 0.9) * p.mu_s * p.N / (p.r_0 * p.k_p),
    )


@pytest.mark.parametrize("law", [{}, *LAWS.values(), SURFACE, SURFACE | LAWS["compliant_normal"]])
@pytest.mark.parametrize("damped", [False, True])
def test_what_is_at_rest_stays_within_friction_s_limit_in_an_exponential(law, damped) -> None:
    p = Parameters(N=100, Omega=0, n_diameters=2, D_star=0, **law)
    if damped:
        p = p.replace(c=0.5, c_p=0.5, D_star=1e-5)
    rng = np.random.default_rng(7)
    holds = []
    margins = []
    for energy in np.geomspace(1e-6, 1.0, 30):
        state = shaken(p, energy, rng)
        holds.append(holds_for_good(p, state, p.N))
        margins.append(margin_of_stick(p, state, 0.1, 1000))
    within = np.array(margins) > 0
    assert not np.any(np.array(holds) & ~within)
    # the bound is no more than some times the vibration, of which it knows only the energy
    assert sum(holds) > 0.3 * within.sum()
    assert not within.all()


def test_what_is_at_rest_is_not_released_in_a_simulation() -> None:
    p = Parameters(N=100, Omega=0, n_diameters=2, D_star=0)
    rng = np.random.default_rng(7)
    for energy in np.geomspace(1e-6, 1.0, 12):
        state = shaken(p, energy, rng)
        released = len(simulate(p, 0.1, initial_state=state).events) > 0
        assert released == (margin_of_stick(p, state, 0.1, 10_000) < 0)
        assert not (released and holds_for_good(p, state, p.N))


def test_a_preload_that_has_changed_counts() -> None:
    """The spring k carries a part of the change."""
    p = Parameters(N=100, Omega=0, n_diameters=1, D_star=1e-3)
    lighter = Ramp(parameter="N", to=60, start=0, end=0.5)
    run = simulate(p, 5.0, ramps=lighter, windows={"end": dm.Window(last=0.01, rate=1e4)})
    modes = mode_arrays(p)
    flexibility = float(np.sum((modes.psi / modes.omega) ** 2))
    force = (60 + p.k * 100 * flexibility) / (1 + p.k * flexibility)
    assert run["end"]["P"].values == pytest.approx(force, rel=1e-6)
    for share, holds in ((0.99, True), (1.01, False)):
        state = run.final_state.replace(psi=share * p.mu_s * force / (p.r_0 * p.k_p))
        assert holds_for_good(p, state, 60) == holds


# ------------------------------------------------------------------------ requests
def test_a_preload_must_stay_and_be_there() -> None:
    with refusal("to=0: must be > 0 for N"):
        Ramp(parameter="N", to=0, start=0, end=1)
    with refusal("to=-1: must be"):
        Ramp(parameter="Omega", to=-1, start=0, end=1)
    with refusal("N=0: must be > 0 where there are ramps"):
        simulate(BLOCK.replace(N=0), 1, ramps=Ramp(parameter="Omega", to=0, start=0, end=1))
