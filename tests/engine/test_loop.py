"""Where the machine and the flights of the return map cannot go on, and that they say so; samples
on a switch."""

import math

import numba
import numpy as np
import pytest

from disc_model import Parameters, Window, initial_state, plate_modes, simulate
from disc_model.engine import step, transitions
from disc_model.engine.model import build_state
from disc_model.engine.state import U, known_roots
from disc_model.errors import DiscModelError
from disc_model.simulation.result import EVENT_KINDS, PHASES
from disc_model.simulation.states import engine_case
from disc_model.stability.return_map import ReturnMap
from tests.contact_laws import COMPILES
from tests.engine.test_saltation import differences, solved
from tests.references import printed

STEEP = Parameters(N=100, Omega=20, mu_k=50, mu_s=60, k_p=2e7, n_diameters=1)


def about_to_slip(denominator: float):
    """Stick a moment before its release, on a slope that gives the denominator of P in slip this
    value."""
    psi = plate_modes(STEEP)["psi"].to_numpy()
    slope = (denominator - 1 - STEEP.m * psi @ psi) * STEEP.r_0 / STEEP.mu_k
    start = simulate(STEEP, 1e-9).final_state
    angle = STEEP.mu_s * STEEP.N / (STEEP.r_0 * STEEP.k_p)
    return start.replace(b=np.array([0.0, slope / psi[1]]), psi=angle * (1 - 1e-6))


def test_release_without_a_solution_is_a_paradox() -> None:
    result = simulate(STEEP, 1e-4, initial_state=about_to_slip(-0.5))
    assert result.status == "paradox"
    assert result.final_state.time < 1e-6
    assert "in stick" in result.message
    assert "slope B" in result.message
    with pytest.raises(DiscModelError, match="Painleve"):
        result.raise_for_status()


@pytest.mark.skipif(not numba.config.DISABLE_JIT, reason="the limit is a constant of compiled code")
def test_switches_without_the_clock_moving_end_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step, "MAX_EVENTS_IN_A_ROW", 0)
    # stick cannot hold from the start
    result = simulate(Parameters(N=200, Omega=10, k_p=0, c_p=100, n_diameters=1), 0.1)
    assert result.status == "stalled"
    assert result.status.advice.startswith("Switches follow each other")


# ------------------------------------------------------------------------------------- flights of
# the return map
P = Parameters(N=200, Omega=20, n_diameters=2, c=0.05, c_p=0.02)


def outcome(map_: ReturnMap, x: np.ndarray, **how) -> int:
    with np.errstate(all="ignore"):
        return map_.evaluate(x, tangent=False, **how).outcome


def test_flights_say_how_they_end() -> None:
    map_ = ReturnMap(P)
    flight = map_.evaluate(map_.static, releases=2, tangent=False)
    assert flight.outcome == transitions.RETURNED
    assert flight.counts == (2, 0, 0, 0, 2)
    x = map_.static + 3 * np.max(np.abs(map_.static)) * np.random.default_rng(1).normal(
        size=map_.size
    )
    assert outcome(map_, x) == transitions.STOPPED  # it loses contact
    assert outcome(ReturnMap(P, patient=True), x) == transitions.RETURNED
    assert outcome(map_, -5 * map_.static) == transitions.OFF_SECTION  # P would be negative
    assert outcome(map_, np.full(map_.size, math.nan)) != transitions.RETURNED
    start = simulate(P, 1e-6).final_state
    with np.errstate(all="ignore"):
        assert (
            map_.next_release(start.replace(phase="slip", direction=1, f=1e308)).outcome
            == transitions.NON_FINITE
        )


def test_without_a_drop_of_friction_only_a_pull_that_outgrows_it_begins_slip() -> None:
    """A hundredth before the speed of a mode at which both grow alike by the paper's equations, and
    beyond it."""
    map_ = ReturnMap(P.replace(mu_k=P.mu_s))
    # alpha of a mode
    p = map_.parameters
    along = np.linalg.norm(map_.static) * (np.arange(map_.size) == 4)

    def outgrows(speed: float) -> float:
        run = printed.Printed(p, map_.state(map_.static + speed * along))
        return differences(
            lambda t: p.r_0 * p.k_p * run.at(t)["psi"] - p.mu_s * run.at(t)["P"], 1e-5
        )

    alike = solved(outgrows)  # P is linear in it
    beyond = [
        outcome(map_, map_.static + share * alike * along) == transitions.OFF_SECTION
        for share in (0.99, 1.01)
    ]
    assert beyond == [False, True]


def test_a_flight_into_a_paradox_has_no_solution() -> None:
    map_ = ReturnMap(STEEP)
    start = about_to_slip(-0.5)
    x = map_.static.copy()
    # coordinates: a, b of the pair, then their velocities, then the axisymmetric mode
    x[1] = start.b[1] * map_.scale[1]
    assert outcome(map_, x) == transitions.NO_SOLUTION
    slipping = start.replace(phase="slip", direction=1, f=10.0)
    assert map_.next_release(slipping).outcome == transitions.NO_SOLUTION


@pytest.mark.parametrize(("gap", "known"), [(1e-16, 1), (1e-13, 0)])
def test_rounding_of_a_gap_is_that_of_the_modes_it_is_made_of(gap: float, known: int) -> None:
    """By the height alone, a small difference of large shares, a closed gap was taken for open: a
    run stalled."""
    case = engine_case(
        Parameters(N=600, Omega=30, normalization="orthonormal", contact_compliance="residual")
    )
    here = build_state(case.model)
    here.disc[:] = 0.0
    # two modes that lift the disc by 1 cm each, one up, one down
    here.z[0] = 0.01 / case.model.mode_amplitude[0]
    here.z[1] = -0.01 / case.model.mode_amplitude[1]
    w, _, _ = transitions.disc_point(case.model, here)
    here.x[U] = w + gap
    transitions.change_phase(case.model, here, transitions.CONTACT_LOST, False)
    assert known_roots(here)[0] == known


def test_a_sample_on_a_switch_shows_the_side_before_it() -> None:
    """Moved by less than rounding moves a switch it still does; moved by more it shows the side
    after."""
    p = printed.P.replace(N=100.0)  # it lands, sticks, is released and lets go again
    start = printed.lively("separation", p=p)
    events = simulate(p, 0.02, initial_state=start).events
    before = [start.phase, *events["phase"].iloc[:-1]]
    apart = np.diff(events["time"], prepend=0.0, append=1.0) > 1e-6
    seen = set()
    for i in np.flatnonzero(apart[1:] & apart[:-1]):
        t = events["time"].iloc[i]
        kind = events["kind"].iloc[i]
        after = events["phase"].iloc[i]
        if after == before[i]:
            continue
        seen.add(kind)
        offsets = (-1e-10, *(2.0**-52 * t * np.array([-200, -1, 0, 1, 200])), 1e-10)
        windows = {
            f"w{offset:+}": Window(start=t + offset, stop=t + offset + 1e-3, rate=999)
            for offset in offsets
        }
        samples = simulate(p, t + 2e-3, windows, initial_state=start).samples.values()
        phases = [PHASES[int(sample["phase"][0])] for sample in samples]
        assert phases == [before[i]] * 6 + [after], kind
        # what is continuous on either side changes by its rate times 1e-10 s: P by less than 1e7
        # N/s
        forces = [sample["P"][0] for sample in samples]
        np.testing.assert_allclose(forces[1:6], forces[0], rtol=0, atol=1e-3)
    assert seen == set(EVENT_KINDS) - {"slip_reversal"}, (
        "a kind of switch that changes the phase is missing"
    )


# ------------------------------------------------------------------------------------- touching down
@pytest.mark.parametrize("sense", [pytest.param(sense, marks=COMPILES) for sense in (1, -1)])
@pytest.mark.parametrize(
    ("psi", "f", "after"),
    [
        (0.02, 0.0, 0.08),  # without speed it slips to the side of its spring
        (-0.02, 5.0, 4.91),  # with speed it slips on, against its spring
    ],
)
def test_a_slider_that_touches_down_slips(psi: float, f: float, after: float, sense: int) -> None:
    """The spring takes k_p psi t / m = 0.08 rad/s, and the contact force is still too small to stop
    the slider."""
    p = Parameters(N=200, Omega=10, n_diameters=1, contact_compliance=1e-7)
    start = initial_state(p)
    falling = start.replace(
        phase="separation",
        direction=0,
        psi=sense * psi,
        u=p.N * 1e-7 + start.u,  # N C below the disc at rest
        u_velocity=-0.2,
        f=sense * f,
        _roots=(0, 0),
    )
    run = simulate(p, 2e-5, initial_state=falling)
    assert list(run.events.kind) == ["reattachment"]
    assert run.final_state.direction == sense
    assert run.final_state.f == pytest.approx(sense * after, abs=0.02)
