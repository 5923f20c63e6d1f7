"""Run-up from rest and stops: when a slider is at rest, and that a run says so."""

from collections.abc import Mapping

import pytest

import disc_model as dm
from disc_model import Parameters, Ramp, simulate
from disc_model.errors import Status
from disc_model.simulation.states import static_start
from tests.references import block
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
    assert run.message == "at_rest: at t = 0.5 s in stick, the drive stands still"


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


# ------------------------------------------------------------------------ requests
def test_a_preload_must_stay_and_be_there() -> None:
    with refusal("to=0: must be > 0 for N"):
        Ramp(parameter="N", to=0, start=0, end=1)
    with refusal("to=-1: must be"):
        Ramp(parameter="Omega", to=-1, start=0, end=1)
    with refusal("N=0: must be > 0 where there are ramps"):
        simulate(BLOCK.replace(N=0), 1, ramps=Ramp(parameter="Omega", to=0, start=0, end=1))
