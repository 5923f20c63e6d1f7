"""Motions that begin where another one ended, or with a kick."""

import functools
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from disc_model import Window, deflection, floquet, outcome, run_study
from disc_model.data.variables import PHASES, flag_names
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Start
from disc_model.simulation.starts import initial_state, make_initial_state
from disc_model.simulation.states import State, perturb, static_start, transfer_state
from tests.contact_laws import LAWS
from tests.references.printed import Printed
from tests.refusals import refusal


def test_a_preparation_that_fails_is_reported() -> None:
    options = {"prerun": {"parameters": {"mu_k": 0.9}, "time": 1}, "transient": 1}
    raw = {
        "study": "b",
        "quantity": "bifurcation",
        "base": {"N": 385},
        "axes": {"Omega": [15]},
        "options": options,
    }
    found = run_study(raw).isel(Omega=0)
    assert flag_names(found["status"]) == "failed"
    assert "ParameterError" in str(found["message"].item())


def test_a_start_can_be_simulated_by_itself() -> None:
    """A start perturbed as in `outcome` could not be given to `simulate`."""
    case = Parameters(N=385, Omega=13)
    kick = {"u": -2.75e-3, "u_velocity": 1.375}
    prerun = {"parameters": {"Omega": 14.0}, "time": 0.5}
    before = transfer_state(case, simulate(case.replace(Omega=14.0), 0.5).final_state)
    assert initial_state(case) == static_start(case)
    assert initial_state(case, kick) == perturb(case, static_start(case), **kick)
    assert initial_state(case, prerun=prerun) == before
    assert initial_state(case, kick, prerun=prerun) == perturb(case, before, **kick)

    reached = outcome(case, 45, start=kick)
    run = simulate(case, 45, initial_state=initial_state(case, kick))
    # both compute the same steps up to the event
    assert reached["first_separation"].item() == pytest.approx(run.first_separation, rel=1e-12)
    assert np.isnan(simulate(case, 45).first_separation)


def test_a_wrong_start_is_named_as_an_argument() -> None:
    for given, fault in (
        ({"start": {"v": 1.0}}, "start.v="),
        ({"prerun": {"parameters": {"Omga": 3}, "time": 1}}, "prerun.parameters.Omga=3"),
        ({"prerun": {"parameters": {"n_diameters": 2}, "time": 1}}, "prerun.parameters.n_diam"),
    ):
        with refusal(fault):
            initial_state(Parameters(N=385, Omega=15.1), **given)


# ---- the modes that a state belongs to


ORTHONORMAL = Parameters(N=800, Omega=30, normalization="orthonormal")


def test_a_state_of_other_modes_is_refused(tmp_path: Path) -> None:
    """On another processor one mode had the other sign, and the state went on as another motion,
    without a word."""
    state = simulate(ORTHONORMAL, 0.1).final_state
    other = state.replace(
        mode_amplitudes=np.array([1.0, 1.0, 1.0, -1.0, 1.0]) * state.mode_amplitudes
    )
    path = tmp_path / "state.nc"
    other.save(path)
    rule = r"mode_amplitudes=array\(.*: must be psi of plate_modes"
    for start in (other, State.load(path), other.replace(time=0.0)):
        with refusal(rf"^initial_state\.{rule}"):
            simulate(ORTHONORMAL, 0.2, initial_state=start)
    with refusal(rf"^states\.0\.{rule}"):
        deflection(ORTHONORMAL, other, 0.1, 0.0)
    with refusal(rf"^initial_state\.{rule}"):
        floquet(ORTHONORMAL, guess=other)
    # by less than other processors make it the state is the same, and by more it is not
    for share, same in ((1e-12, True), (1e-6, False)):
        near = state.replace(mode_amplitudes=(1 + share) * state.mode_amplitudes)
        if same:
            simulate(ORTHONORMAL, 0.101, initial_state=near)
        else:
            with refusal("must be psi of plate_modes"):
                simulate(ORTHONORMAL, 0.101, initial_state=near)
    by_hand = state.replace(mode_amplitudes=None)
    assert simulate(
        ORTHONORMAL, 0.2, initial_state=by_hand.replace(phase="separation", u=1.0)
    ).status.complete


# ---- at a switch


APART = Parameters(N=385, Omega=15.1)
C = LAWS["compliant_normal"]


@pytest.fixture(scope="module")
def switch() -> Callable[..., State]:
    """The first loss of contact of a case, after a kick that brings it soon."""

    @functools.cache
    def found(**changes: object) -> State:
        p = APART.replace(**changes)
        start = perturb(p, static_start(p), u=-0.02)
        state = simulate(p, 1.0, initial_state=start, stop_at="first_separation").final_state
        assert any(state._roots)
        return state

    return found


def test_a_switch_continued_under_its_own_parameters_keeps_its_bits(
    switch: Callable[..., State], tmp_path: Path
) -> None:
    state = switch()
    start = perturb(APART, static_start(APART), u=-0.02)
    whole = simulate(APART, state.time + 0.05, initial_state=start)
    path = tmp_path / "state.nc"
    state.save(path)
    for given in (state, State.load(path), state.replace(time=state.time, time_low=state.time_low)):
        rest = simulate(APART, state.time + 0.05, initial_state=given)
        expected = whole.event_rows[whole.event_rows[:, 0] > state.time]
        assert len(expected) > 3
        np.testing.assert_array_equal(rest.event_rows, expected)


@pytest.mark.parametrize(
    "change",
    [
        {"N": 386.0}, {"N": 435.0}, {"N": 384.0}, {"N": 200.0}, {"k": 1e5}, {"k": 1e3}, {"m": 0.09}, {"m": 0.2},
        {"c": 100.0}, {"E": 160e9}, {"r_0": 0.09}, {"rho": 7000.0},
    ],
    ids=str,
)  # fmt: skip
def test_a_switch_continued_under_other_parameters_is_one_of_these(
    switch: Callable[..., State], change: dict
) -> None:
    """The contact force vanishes under the former ones alone: the slider went into the disc, by up
    to 0.2 mm."""
    p = APART.replace(**change)
    start = transfer_state(p, switch())
    # by formulas that share nothing with the engine
    force = Printed(p, start.replace(phase="slip", direction=1)).force()
    assert abs(force) > 1e-3
    window = Window(start=0, stop=2e-3, rate=1e6)
    run = simulate(p, 2e-3, windows={"w": window}, initial_state=start)
    samples = run.samples["w"]
    expected = "separation"
    if force > 0:
        expected = "slip"
    first = int(samples["phase"][0])
    assert PHASES[first] == expected
    assert samples["P"][0] == pytest.approx(max(force, 0.0), rel=1e-9)
    # as far as rounding goes: the disc's deflection is some millimetres
    assert (samples["u"] - samples["w"]).min() > -1e-15
    assert samples["P"].min() >= 0


@pytest.mark.compiled
@pytest.mark.parametrize(
    "change", [{}, {"N": 500.0}, {"N": 300.0}, {"r_0": 0.09}, {"contact_compliance": 2e-6}], ids=str
)
def test_a_switch_of_a_compliant_contact_keeps_its_distance(
    switch: Callable[..., State], change: dict
) -> None:
    p = APART.replace(**(C | change))
    window = Window(start=0, stop=2e-3, rate=1e6)
    run = simulate(p, 2e-3, windows={"w": window}, initial_state=transfer_state(p, switch(**C)))
    samples = run.samples["w"]
    assert PHASES[int(samples["phase"][0])] == "separation"
    apart = samples["phase"] == PHASES.index("separation")
    assert apart[:10].all()
    assert (samples["u"] - samples["w"])[apart].min() > -1e-15


def test_a_switch_continued_under_other_parameters_keeps_the_digits_of_its_clock(
    switch: Callable[..., State],
) -> None:
    """The phase is found by a run of no duration, with a clock of fewer digits."""
    p = APART.replace(N=386.0)
    start = switch()
    late = start.replace(time=1e6)
    digit = math.ulp(late.time)
    ends = [
        simulate(p, 1e6 + 1e-3, initial_state=late.replace(time_low=low)).final_state
        for low in (0.0, digit)
    ]
    speed = p.Omega - ends[0].f
    assert abs(speed) > 1
    # the second run is shorter by a digit of the clock
    assert ends[0].psi - ends[1].psi == pytest.approx(speed * digit, rel=1e-3)
    with refusal(r"time_low=.* less than the last digit of the time"):
        simulate(p, 1e6 + 1e-3, initial_state=late.replace(time_low=1.01 * digit))


# ---- kicks


P = Parameters(N=385, Omega=15)


def height(p: Parameters, state: State) -> float:
    """Of the disc under the slider."""
    return float(mode_arrays(p).psi @ state.a)


def test_a_kick_moves_slider_and_disc_as_a_steady_force_would() -> None:
    """In that shape a kick is the static deflection of another preload."""
    start = static_start(P)
    moved = perturb(P, start, u=1e-4)
    assert height(P, moved) - height(P, start) == pytest.approx(1e-4, rel=1e-12)
    assert moved.u - start.u == pytest.approx(1e-4, rel=1e-12)
    other = static_start(P.replace(N=200))
    there = perturb(P, start, u=other.u - start.u)
    np.testing.assert_allclose(there.a, other.a, rtol=1e-12)


def test_a_blow_changes_the_velocity_of_slider_and_disc_alike() -> None:
    start = static_start(P)
    hit = perturb(P, start, u_velocity=0.2)
    assert mode_arrays(P).psi @ hit.alpha == pytest.approx(0.2, rel=1e-12)
    assert hit.u_velocity == pytest.approx(0.2)
    np.testing.assert_array_equal(hit.a, start.a)
    # what velocities have at one slider they have at once in the simulation: it does not end
    # contact
    assert not len(simulate(P, 1e-6, initial_state=hit).event_rows)


def test_a_kick_along_the_disc_makes_the_slider_slip() -> None:
    start = static_start(P)
    assert start.phase == "stick"
    assert start.direction == 0
    forward = perturb(P, start, f=3.0)
    backward = perturb(P, start, f=-3.0)
    assert [(s.phase, s.direction, s.f) for s in (forward, backward)] == [
        ("slip", 1, 3.0),
        ("slip", -1, -3.0),
    ]
    stopped = perturb(P, forward, f=-3.0)
    assert stopped.phase == "stick"
    assert stopped.direction == 0
    assert stopped.f == 0.0
    apart = perturb(P, start.replace(phase="separation"), f=3.0)
    assert apart.phase == "separation"
    assert apart.f == 3.0
    for state in (forward, backward, stopped):
        assert simulate(P, 0.01, initial_state=state).status.complete


def test_a_state_of_another_case_starts_where_this_ones_disc_is() -> None:
    """The modes weigh otherwise at another radius, so that the height in contact is another."""
    p = Parameters(N=200, Omega=20, r_0=0.09)
    start = Start(prerun={"parameters": {"r_0": 0.1}, "time": 0.1})
    state = make_initial_state(p, start, 1e-10)
    assert state is not None
    other = simulate(p.replace(r_0=0.1), 0.1).final_state
    assert state.phase == other.phase != "separation"
    assert state.u == pytest.approx(mode_arrays(p).psi @ other.a, rel=1e-12)
    assert state.u != pytest.approx(other.u, rel=1e-3)
    assert simulate(p, 0.01, initial_state=state).status.complete
    apart = other.replace(phase="separation", direction=0, u=other.u + 1e-4, u_velocity=1.0)
    moved = transfer_state(p, apart)
    assert moved.u - mode_arrays(p).psi @ other.a == pytest.approx(1e-4, rel=1e-9)
    assert simulate(p, 1e-5, initial_state=moved).final_state.phase == "separation"


def test_on_a_compliant_contact_the_slider_keeps_its_distance_and_its_velocity_over_the_turning_disc() -> (
    None
):
    p = Parameters(N=200, Omega=20)
    former = mode_arrays(p)
    rest = static_start(p)
    moving = {
        "f": 5.0,
        "u_velocity": 1.0,
        "alpha": 0.01 * np.arange(5),
        "b": 1e-6 * np.sign(former.diameters),
    }
    state = rest.replace(
        phase="slip", direction=1, u=rest.u - 1e-5, mode_amplitudes=former.psi, **moving
    )
    rise = state.alpha + state.f * former.diameters * state.b
    for compliance, distance in ((0.0, 0.0), (1e-7, -1e-5)):
        case = p.replace(r_0=0.09, contact_compliance=compliance)
        found = transfer_state(case, state)
        psi = mode_arrays(case).psi
        # to the rounding of the static deflection
        assert found.u - psi @ state.a == pytest.approx(distance, abs=1e-15)
        assert found.u_velocity - psi @ rise == pytest.approx(1.0 - former.psi @ rise, rel=1e-12)
    assert transfer_state(case, state.replace(mode_amplitudes=None)).u == state.u
