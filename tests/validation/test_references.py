"""simulate against references that were computed apart from it, and these against each other.

tests/references/data holds event times of long-double runs (two of different order and step size
agree to 4e-18 s, a 53-bit run to 3e-15 s), found by heyoka's series; tests/references/taylor.py
gives them again and has other laws of contact.  Phases and switches by themselves are compared with
the paper's equations in test_equations.py.
"""

import itertools

import numpy as np
import pandas as pd
import pytest

from disc_model import Parameters, plate_modes, simulate
from disc_model.analysis.classify import CLOSES, shortest_period
from tests.contact_laws import ALL_LAWS
from tests.references import fixed_step, growth, stored, taylor
from tests.references.printed import MOTIONS, P, lively

#: Largest event-time error over the stored second divided by tol, s: 0.2 to 2 at all tolerances that tell.
ERROR_PER_TOL = 3.0
#: The same of violent motions, whose impacts and reversals amplify errors: up to 6.
ERROR_PER_TOL_VIOLENT = 10.0
#: Below this, double precision (53 bits, times near 55 s have a spacing of 7e-15 s) decides, not tol.
ROUNDING = 1e-13


def test_modes_are_those_of_the_reference():
    data = stored.load("C")
    modes = plate_modes(Parameters(**data["parameters"]))
    np.testing.assert_allclose(modes["omega"], data["modes"]["omega"], rtol=2e-15)
    np.testing.assert_allclose(np.abs(modes["psi"]), data["modes"]["psi"], rtol=4e-15)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("name", "count", "separations"), [("A", 135, 0), ("B", 140, 0), ("C", 398, 131)]
)
def test_every_event_is_there_with_an_error_that_falls_with_tol(name, count, separations):
    data = stored.load(name)
    errors = []
    kinds = data["kinds"]
    assert len(kinds) == count
    assert kinds.count("separation") == separations
    p = Parameters(**data["parameters"])
    start = data["start"] and stored.engine_state(data["start"], p)
    tolerances = [10.0**-digits for digits in range(4, 16)]
    for tol in tolerances:
        events = simulate(p, data["t_end"], tol=tol, initial_state=start).events
        assert list(events["kind"]) == kinds
        assert list(events["phase"]) == data["phase"]
        errors.append(float(np.abs(events["time"].to_numpy() - stored.times_of(data)).max()))
    assert np.all(np.array(errors) <= ERROR_PER_TOL * np.array(tolerances) + ROUNDING), errors
    assert errors[-1] <= 1e-13
    for value in ("psi", "f", "P"):
        wanted = np.array(data[value])
        np.testing.assert_allclose(events[value], wanted, atol=1e-10 * np.abs(wanted).max(), rtol=0)
    for coarse, fine in itertools.pairwise(errors[3:10:2]):
        assert fine <= coarse / 10 + ROUNDING, (
            errors
        )  # tol falls a hundredfold: at least ten, in practice 60 to 200
    # nor far better than asked for, which would cost time: it was a fiftieth of tol
    assert np.all(np.array(errors[3:8]) >= np.array(tolerances[3:8]) / 6), errors


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("tol", "allowed"), [(1e-8, 1e-6), (1e-10, 3e-8), (1e-12, 1e-9), (1e-15, 1e-11)]
)
def test_first_separation_at_15_1_rad_s(tol, allowed):
    """54.418905535947973 s: long-double runs agree to 4e-16 s, 53-bit runs to 4e-13 s.

    Rounding of one unit in the last place of any mode shifts it by no more than 4e-16 s, see the
    stored data.
    """
    data = stored.load("first_separation")
    result = simulate(Parameters(**data["parameters"]), 60.0, tol=tol, stop_at="first_separation")
    assert result.first_separation == pytest.approx(data["time"], abs=allowed, rel=0)
    assert len(result.events) == data["events_before"] + 1


@pytest.mark.compiled
def test_violent_motion():
    """Crowded switches, P < 0 after an impact, reversals, both directions, all dampers: 2076
    events."""
    kinds = []
    gaps = []
    for group in stored.load("wild")["groups"]:
        p = Parameters(**group["parameters"])
        for i, run in enumerate(group["runs"]):
            start = stored.engine_state(run["start"], p)
            times = stored.times_of(run)
            kinds = kinds + run["kinds"]
            gaps = [*gaps, *np.diff(times.astype(float))]
            for tol in (1e-6, 1e-10, 1e-14):
                events = simulate(p, group["t_end"], tol=tol, initial_state=start).events
                assert list(events["kind"]) == run["kinds"], (p, i, tol)
                error = float(np.abs(events["time"].to_numpy() - times).max())
                assert error <= ERROR_PER_TOL_VIOLENT * tol + ROUNDING, (p, i, tol)
    assert kinds.count("slip_reversal") > 100
    gaps = np.array(gaps)
    assert (gaps == 0).sum() > 10  # contact lost again in the instant of the impact
    assert ((gaps > 0) & (gaps < 1e-5)).sum() >= 3


def releases(events):
    """Intervals between the starts of slip, s."""
    return np.diff(events["time"][events["kind"] == "stick_to_slip"])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("case", "t_end", "period", "length"),
    [
        ({"N": 300, "Omega": 20}, 480, 45, 5),
        ({"N": 200, "Omega": 20}, 800, 180, 30),
        ({"N": 300, "Omega": 50, "k_p": 2e3}, 400, 280, 28),
    ],
)
def test_the_papers_method_finds_the_same_period(case, t_end, period, length):
    """Long periods, of the paper's Figs. 7, 2 and 22, are no artefact of the engine. Errors of
    these steps are far below what intervals repeat to."""
    p = Parameters(**case)
    run = simulate(p, t_end)
    late = run.events[run.events["time"] > t_end - 60]
    assert shortest_period(releases(late), CLOSES) == period
    times, kinds = fixed_step.switches(p, run.final_state, length)
    intervals = releases(pd.DataFrame({"time": times, "kind": kinds}))
    assert len(intervals) >= 2 * period
    assert shortest_period(intervals, CLOSES) == period


# ------------------------------------------------------------------------ the references themselves
@pytest.mark.parametrize("name", ["A", "B", "C"])
def test_stored_runs_can_be_computed_again(name):
    """By an integrator that shares no code with the one that found them."""
    data = stored.load(name)
    q = taylor.stored_problem(data)
    start = data["start"] or q.equilibrium()
    again = taylor.Reference(q, start).run(float(start.time) + 0.1).events
    assert [event["kind"] for event in again] == data["kinds"][: len(again)]
    for event, t in zip(again, stored.times_of(data), strict=False):
        assert abs(event["time"] - t) < 1e-16


@pytest.mark.parametrize("law", ["default", *ALL_LAWS])
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_rates_and_forces_fulfil_the_equations_as_they_stand(law, phase, direction):
    """Those of `growth`, written by themselves: what is left of each is rounding of its terms."""
    p = P.replace(**ALL_LAWS.get(law, {}))
    q = taylor.problem_of(p)
    state = stored.reference_state(lively(phase, direction, p), p)
    if q.C:
        state.u -= 500 * float(q.C)
        state.u_velocity += 0.01
    step = taylor.Step(q, phase, direction, state, order=1)
    equations = growth.SteadySliding(p.model_dump(), np.sqrt(q.w2), q.s, q.l, q.d, q.t)
    equations.direction = direction
    names = ["a", "b", "alpha", "beta", "psi", "f", "u", "v"][: None if q.C else 6]
    x, rates = (np.hstack([getattr(step, name)[order] for name in names]) for order in (0, 1))
    forces = [getattr(step, name)[0] for name in ("V", "H", "R", "T", "g")]
    z = np.append(rates, forces)

    left = equations.residual(x[:, None], z[:, None])[:, 0]
    by_x, by_z = equations.jacobian(x, z)
    size = abs(by_x) @ abs(x) + abs(by_z) @ abs(z)
    slider = 4 * len(q.s) + 2
    holds = np.ones(len(left), bool)
    if phase != "slip":
        holds[slider + 2] = False  # the law of friction
    if phase == "separation":
        holds[[slider, -1]] = q.C > 0, not q.C  # contact
        assert forces[:4] == [0, 0, 0, 0]
    assert np.all(abs(left) <= 1e-12 * size, where=holds)


@pytest.mark.parametrize("law", ["default", "normal", "vertical_coupled", "normal_coupled"])
def test_an_impact_takes_the_momentum_that_it_gives(law):
    """One impulse normal to the disc acts on both, and leaves them with one velocity."""
    p = P.replace(**ALL_LAWS.get(law, {}))
    q = taylor.problem_of(p)
    before = stored.reference_state(lively("separation", 0, p), p)
    before.u_velocity -= 0.5
    run = taylor.Reference(q, before)
    run._impact()
    lean = run.disc()[2] / q.r_0 if q.normal else 0.0
    impulse = q.m * (run.v - before.u_velocity)
    assert abs(impulse) > 1e-3
    changes = {
        "alpha": -q.s * impulse,
        "beta": q.t * lean * impulse,
        "f": -lean * impulse / (q.m * q.r_0),
    }
    for name, change in changes.items():
        expected = np.array(getattr(before, name) + change, float)
        found = np.array(getattr(run, name), float)
        np.testing.assert_allclose(found, expected, rtol=1e-12, err_msg=name)
    assert run.v == pytest.approx(run.disc()[1], rel=1e-12)
