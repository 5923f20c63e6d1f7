"""How simulations begin, end and pause, what they refuse, and stops and run-ups of the drive."""

import json
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model import Execution, Parameters, Poincare, Ramp, State, Window, simulate, snapshots
from disc_model.simulation import run as runs
from disc_model.simulation.states import perturb, static_start
from tests import processes
from tests.references import block
from tests.refusals import refusal

pytestmark = pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")

P = Parameters(N=200, Omega=50, n_diameters=1)
NONE = np.zeros(0)
RIGID = Parameters(n_diameters=-1, N=30, Omega=0.5, m=0.2, k=0, k_p=2e3, mu_s=0.5, mu_k=0.3)
STANDING = RIGID.replace(Omega=0.0)
SOFT = STANDING.replace(contact_compliance=1e-6)
STOP = Ramp(parameter="Omega", to=0, start=0, end=0.3)


def at_rest(phase: str, **changes: Any) -> State:
    """A rigid disc with a slider that touches it without force."""
    start = State(0.0, phase, 0, 0.0, 0.0, 0.0, 0.0, NONE, NONE, NONE, NONE)
    return start.replace(**changes)


# ---- how runs end


@pytest.mark.parametrize(
    ("p", "options", "status"),
    [
        (P, {"execution": Execution(max_steps=3)}, "step_limit"),
        (P, {"initial_state": static_start(P).replace(phase="slip", direction=1, f=1e308)},
         "non_finite"),
        (RIGID, {}, "ok"),
        (RIGID, {"ramps": STOP}, "at_rest"),
        (RIGID, {"ramps": STOP.replace(end=0.6)}, "ok"),
        # something is still to come
        (RIGID, {"ramps": (STOP, Ramp(parameter="Omega", to=1, start=0.6, end=0.7))}, "ok"),
        (RIGID, {"ramps": (STOP, Ramp(parameter="N", to=10, start=0.6, end=0.7))}, "ok"),
        # touching without force; slip on a compliant contact stalled
        *((SOFT, {"initial_state": at_rest(phase)}, "at_rest") for phase in ("stick", "separation")),
        *((SOFT, {"initial_state": at_rest("slip", direction=d)}, "at_rest") for d in (-1, 1)),
        (STANDING, {"initial_state": at_rest("separation", u=1e-3)}, "at_rest"),
    ],
)  # fmt: skip
def test_the_status_of_a_run(p: Parameters, options: dict[str, Any], status: str) -> None:
    with np.errstate(all="ignore"):
        run = simulate(p, 0.5, **options)
    assert run.status.value == status
    assert run.message.startswith(f"{status}: at t = ")
    if run.status.complete:
        assert run.raise_for_status() is run
    else:
        with pytest.raises(dm.errors.SimulationError, match=status):
            run.raise_for_status()


def test_a_run_stops_at_its_first_separation() -> None:
    p = Parameters(N=385, Omega=15.1)
    start = perturb(p, static_start(p), u=-0.02)
    run = simulate(p, 1.0, initial_state=start, stop_at="first_separation")
    assert run.status.value == "stopped"
    assert run.first_separation == run.final_state.time == run.events["time"].iloc[-1]
    assert run.final_state.phase == "separation"


# ---- what is asked for


INSIDE = "must be at or above the disc under the slider"


@pytest.mark.parametrize(
    ("p", "arguments", "fault"),
    [
        (P, {}, "^t_end=None: "),
        (P, {"t_end": 1, "duration": 1}, "^t_end=1: .*duration"),
        (P, {"t_end": 0.0}, "^t_end=0: must be > 0"),
        (P, {"duration": "5 kg"}, "^duration='5 kg': .* s,"),
        (P, {"t_end": 1, "tol": 0.9e-15}, r"tol=.*: must be [<>]= (1e-15|0\.01)$"),
        (P, {"t_end": 1, "tol": 1.1e-2}, r"tol=.*: must be [<>]= (1e-15|0\.01)$"),
        (P, {"t_end": 1, "stop_at": "end"}, "^stop_at='end': .*'first_separation'"),
        (P, {"t_end": 1, "events": 1}, "^events=1: must be a valid boolean"),
        (P, {"t_end": 1, "ramps": "x"}, "^ramps="),
        (P.replace(N=0), {"t_end": 1, "ramps": STOP}, "N=0: must be > 0 where there are ramps"),
        (P, {"t_end": 1, "stop_at": "first_separation", "windows": {"w": Window(last=1, rate=9)}},
         "^windows.w.last=1: must not be given with stop_at"),
        # a slider within the disc was put on it, or reattached at once, without a word
        *((p, {"t_end": 1, "initial_state": at_rest("separation", u=u)}, INSIDE)
          for u in (-1e-6, -0.1) for p in (STANDING, SOFT)),
        (P, {"t_end": 1, "initial_state": static_start(P).replace(phase="separation", u=-0.1)},
         INSIDE),
        (P, {"t_end": 1, "initial_state": static_start(P).replace(u=0.0)},
         r"initial_state\.u=0: must be at the disc under the slider"),
        (P, {"t_end": 1, "initial_state": static_start(P).replace(f=1.0)},
         r"initial_state\.f=1: must be 0 in stick"),
        (P, {"t_end": 1, "initial_state": static_start(P).replace(phase="slip")},
         "initial_state.direction=0: must be -1 or 1 in slip"),
        (P, {"t_end": 1, "initial_state": static_start(P).replace(time_low=1e-9)},
         "time_low=1e-09: must be less than the last digit of the time"),
        (P, {"t_end": 1, "initial_state": static_start(P.replace(n_diameters=2))},
         "initial_state.a=.*must be 2 finite numbers"),
    ],
)  # fmt: skip
def test_what_a_run_refuses(p: Parameters, arguments: dict[str, Any], fault: str) -> None:
    with refusal(fault):
        simulate(p, **arguments)


def test_rounding_does_not_put_a_slider_into_the_disc() -> None:
    state = simulate(P, 0.0371).final_state
    assert state.phase != "separation"
    assert simulate(P, 0.04, initial_state=state.replace(u=state.u * (1 + 1e-12))).status.complete
    apart = state.replace(phase="separation", direction=0, u=state.u * (1 + 1e-12))
    assert simulate(P, 0.04, initial_state=apart).status.complete


def test_a_duration_begins_at_the_initial_state() -> None:
    first = simulate(P, duration="20 ms")
    assert first == simulate(P, 0.02)
    state = first.final_state
    assert simulate(P, duration=0.01, initial_state=state) == simulate(P, 0.03, initial_state=state)


@pytest.mark.parametrize(
    ("law", "loosest"), [({}, 1.25e-7), ({"contact_compliance": 1e-7}, 2e-6)], ids=str
)
def test_a_tolerance_that_makes_no_difference_is_said(law: Any, loosest: float) -> None:
    """It was used in silence."""
    p = P.replace(**law)
    for tol in (1e-15, 1e-10):
        assert simulate(p, 1e-4, tol=tol).tol == tol
    with pytest.warns(UserWarning, match=f"tol=0.01: the series need {loosest:g} at most"):
        run = simulate(p, 1e-4, tol=1e-2)
    assert run.tol == pytest.approx(loosest, rel=1e-12)
    assert run == simulate(p, 1e-4, tol=run.tol)


# ---- pauses, threads, memory

WINDOWS = {
    "fine": Window(start=54.5, stop=55.2, rate=3e3),
    "bins": Window(start=54.45, stop=55.5, rate=1e3, theta=2.0, envelope=7),
}
ALL = {"windows": WINDOWS | {"turns": Poincare(start=54.6)}}
RAMPS = (
    Ramp(parameter="Omega", to=14.0, start=54.5, end=55.5),
    Ramp(parameter="N", to=300.0, start=54.9, end=55.2),
)
SEPARATING = Parameters(N=385, Omega=15.1)


@pytest.mark.compiled
@pytest.mark.parametrize(
    "options",
    [
        ALL | {"execution": Execution(audit_every_step=True)},
        {"events": False},
        ALL | {"execution": Execution(max_steps=900)},
        {"windows": WINDOWS, "ramps": RAMPS},
    ],
)
def test_pauses_change_nothing(monkeypatch: pytest.MonkeyPatch, options: dict[str, Any]) -> None:
    start = simulate(SEPARATING, 60, stop_at="first_separation").final_state
    undisturbed = simulate(SEPARATING, 55.6, initial_state=start, **options)
    monkeypatch.setattr(runs, "STEPS_PER_PAUSE", 120)
    assert simulate(SEPARATING, 55.6, initial_state=start, **options) == undisturbed


def test_runs_in_threads_equal_runs_in_turn() -> None:
    """Few cases, so that threads share constants and reuse each other's workspaces."""
    cases = [Parameters(N=100.0 + 150.0 * (i % 4), Omega=15.1 + i % 3) for i in range(48)]
    with ThreadPoolExecutor(8) as threads:
        together = list(threads.map(lambda p: simulate(p, 0.5), cases))
    assert together == [simulate(p, 0.5) for p in cases]


TWO_HOURS = """
import json, resource
from disc_model import Parameters, simulate
sizes = []
for end in (720, 7200):
    run = simulate(Parameters(N=385, Omega=15.1), end, events=False)
    sizes.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print(json.dumps({"sizes": sizes, "status": run.status.value, **run.statistics}))
"""


@pytest.mark.slow
def test_two_hours_need_no_more_memory_than_twelve_minutes() -> None:
    found = json.loads(processes.python(TWO_HOURS).stdout)
    assert found["status"] == "ok"
    assert found["n_events"] >= 1e6
    assert found["energy_residual"] < 1e-10
    unit = 1 if sys.platform == "darwin" else 1024
    early, late = found["sizes"]
    assert (late - early) * unit < 2e6


# ---- run-up and stop of the drive

# box on a belt of which the speed rises by 3/50 m/s^2: a published example of stick-slip
BOX = Parameters(
    n_diameters=-1, Omega=0, m=20, k=0, k_p=70, c_p=10, N=196.2, mu_s=1.5, mu_k=1.5, r_0=1, a=0.5, b=2
)  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "begin"),
    [({}, 0.0), ({}, 3.0), ({"mu_s": 0.005, "mu_k": 0.005, "k_p": 0}, 0.0),
     ({"mu_s": 0.005, "mu_k": 0.005, "c_p": 0}, 0.0)],
)  # fmt: skip
def test_a_run_up_releases_the_slider_where_the_pull_reaches_friction_s_limit(
    changes: dict[str, float], begin: float
) -> None:
    p = BOX.replace(**changes)
    ramp = Ramp(parameter="Omega", to=6, start=begin, end=begin + 100)
    run = simulate(p, 20, ramps=ramp, tol=1e-14)
    expected = begin + block.release_on_run_up(p, 0.06)  # 11.6961996315 s by DOP853
    assert run.events["time"].iloc[0] == pytest.approx(expected, rel=1e-12)
    assert run.events["kind"].iloc[0] == "stick_to_slip"
    assert not len(simulate(p.replace(k_p=0, c_p=0), 5, ramps=ramp).events)


def test_a_stop_of_an_overdamped_slider_is_that_in_closed_form() -> None:
    p = RIGID.replace(c_p=60)
    psi = dm.steady_sliding(p).psi
    start = static_start(p).replace(phase="slip", direction=1, f=p.Omega, psi=psi)
    stop = STOP.replace(end=0.05)
    run = simulate(p, 0.5, initial_state=start, tol=1e-13, ramps=stop)
    expected = block.stop_of_overdamped_block(p, p.r_0 * p.Omega / 0.05)
    assert run.events["kind"].tolist() == ["slip_to_stick"]
    assert run.events["time"].iloc[0] == pytest.approx(expected.time, abs=1e-12)
    assert run.final_state.psi * p.r_0 == pytest.approx(expected.stretch, rel=1e-12)


@pytest.mark.parametrize("pulls", [1.001, 1.7, 4.4, -6.3])
def test_without_a_drive_the_slider_stops_as_a_block_under_dry_friction(pulls: float) -> None:
    limit = STANDING.mu_s * STANDING.N / STANDING.k_p
    expected = block.stop_of_released_block(STANDING, pulls * limit)
    start = at_rest("slip", direction=int(np.sign(pulls)), psi=pulls * limit / STANDING.r_0)
    run = simulate(STANDING, 1.0, initial_state=start, tol=1e-13)
    assert run.events["time"].iloc[-1] == pytest.approx(expected.time, rel=1e-11)
    assert run.final_state.psi * STANDING.r_0 == pytest.approx(expected.stretch, abs=1e-11 * limit)
    assert run.status.value == "at_rest"


@pytest.mark.parametrize("tol", [1e-8, 1e-10, 1e-12, 1e-14])
def test_the_last_release_of_a_stop_is_as_accurate_as_the_tolerance(tol: float) -> None:
    """It erred by 15 to 24 times as much: a release waits for an angle, at a speed that goes to 0."""
    p = Parameters(n_diameters=-1, N=10, Omega=0, m=0.5, k=0, k_p=7e3, c_p=1, mu_s=0.6, mu_k=0.3)
    up = Ramp(parameter="Omega", to=5, start=0.5, end=1)
    down = Ramp(parameter="Omega", to=0, start=2, end=2.5)
    run = simulate(p, 3, ramps=(up, down), tol=tol)
    right = 2.497485227751759  # by a program of its own in long double, with three steps
    assert run.events["time"].iloc[-1] == pytest.approx(right, rel=0, abs=max(tol, 4e-15))


@pytest.mark.parametrize("offset", [0.0, "surface"])
def test_what_is_rounding_before_a_run_up_is_no_energy(offset: Any) -> None:
    """Where friction acts on a surface that moves, the residual was 0.0035 to 0.6."""
    p = SEPARATING.replace(Omega=0.0, friction_offset=offset)
    ramp = Ramp(parameter="Omega", to=15, start=0.03, end=0.1)
    run = simulate(p, 0.25, ramps=ramp, execution=Execution(audit_every_step=True))
    assert run.statistics["energy_residual"] < 1e-9


@pytest.mark.parametrize(
    ("times", "fault"), [([0.2, 0.1], "times=.*must be >= 0.*and ascend"), (-1.0, "times=.*-1.*: must be >= 0")]
)  # fmt: skip
def test_states_at_times_that_cannot_be_are_refused(times: Any, fault: str) -> None:
    with refusal(fault):
        snapshots(P, times)
