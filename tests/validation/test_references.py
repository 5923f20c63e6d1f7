"""simulate against references that were computed apart from it, and these against each other.

tests/references/data holds event times of long-double runs (two of different order and step size
agree to 4e-18 s, a 53-bit run to 3e-15 s), found by heyoka's series; tests/references/taylor.py
gives them again and has other laws of contact.  Phases and switches by themselves are compared with
the paper's equations in test_equations.py.
"""

import itertools
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from disc_model import Parameters, plate_modes, simulate
from disc_model.analysis.classify import CLOSES, shortest_period
from tests.contact_laws import LAWS
from tests.references import stored, taylor
from tests.references.fixed_step import switches
from tests.references.literal import from_slider_frame
from tests.references.printed import MOTIONS, P, Printed, lively

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
    start = stored.reference_state(run.final_state, p)
    times, kinds = switches(taylor.problem_of(p), start, length)
    intervals = releases(pd.DataFrame({"time": times, "kind": kinds}))
    assert len(intervals) >= 2 * period
    assert shortest_period(intervals, CLOSES) == period


# ------------------------------------------------------------------------ the references themselves
@pytest.mark.parametrize("name", ["A", "B", "C", *(f"contact_{name}" for name in LAWS)])
def test_stored_runs_can_be_computed_again(name):
    """Those of the default law by an integrator that shares no code with the one that found
    them."""
    data = stored.load(name)
    q = taylor.stored_problem(data)
    if name in "ABC":
        runs = [(data, 0.1)]
    else:
        runs = [(run, 0.01) for run in data["runs"][:2]]
    for run, span in runs:
        start = run["start"] or q.equilibrium()
        reference = taylor.Reference(q, start).run(float(start.time) + span)
        again = reference.events
        assert [event["kind"] for event in again] == run["kinds"][: len(again)]
        for event, t in zip(again, stored.times_of(run), strict=False):
            assert abs(event["time"] - t) < 1e-16


@pytest.mark.parametrize("law", ["default", *LAWS])
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_rates_of_the_reference_balance_in_coordinates_fixed_in_space(law, phase, direction):
    """What acts on each mode, on the slider across the disc and on it along the disc: nothing is
    eliminated."""
    p = P.replace(**LAWS.get(law, {}))
    C = p.contact_compliance
    start = lively(phase, direction, p)
    if C:
        start = start.replace(u=start.u - 500 * C, u_velocity=start.u_velocity + 0.01)
    step = taylor.Step(
        taylor.problem_of(p), phase, direction, stored.reference_state(start, p), order=1
    )
    V, R, T, f, f_rate = (float(x) for x in (step.V[0], step.R[0], step.T[0], *step.f[:2]))
    printed = Printed(p, start)
    case = printed.literal
    y = printed.y
    l = printed.literal.l
    q, v, phi, _, u, u_rate = case.unpack(y)
    turning = step.q.l * f  # the axes of alpha and beta turn with the slider
    rates = {
        "alpha": step.alpha[1] - turning * step.beta[0],
        "beta": step.beta[1] + turning * step.alpha[0],
    }
    pushed = replace(stored.reference_state(start, p), **rates)
    _, acceleration, *_ = case.unpack(from_slider_frame(pushed, plate_modes(p)["diameters"])[1])
    shape = case.Psi * np.exp(1j * l * phi)
    free = -case.damping * v - case.omega**2 * q
    np.testing.assert_allclose(
        acceleration - free, -shape.conj() * V, rtol=0, atol=1e-9 * np.abs(free).max()
    )
    w, slope, velocity = case.disc(q, v, phi, f)
    rise = float(step.v[1])
    if phase != "separation" and not C:
        u = w
        u_rate = velocity
        rise = (
            (shape * (acceleration + 2j * l * f * v + (1j * l * f_rate - (l * f) ** 2) * q))
            .sum()
            .real
        )
    elif phase != "separation":
        assert pytest.approx((w - u) / C, rel=1e-9) == V
    lean = 0.0
    if p.contact_force == "normal":
        lean = slope / p.r_0
    load = p.N + p.k * (u - case.w_0 + C * p.N) + p.c * u_rate
    friction = p.r_0 * (case.pull(0.0, y) - p.m * f_rate) - lean * R
    assert [p.m * rise, V, T] == pytest.approx([V - load, R - lean * T, friction], abs=1e-9 * load)
    if phase == "stick":
        assert f_rate == 0
    else:
        assert pytest.approx(direction * p.mu_k * R, abs=1e-9 * load) == T


@pytest.mark.parametrize("law", ["default", "normal"])
def test_an_impact_of_the_reference_keeps_momentum_and_loses_energy_by_the_approach(law):
    """Half the impulse times the velocity of approach, less what a vertical force does on the
    moving slope."""
    p = P.replace(**LAWS.get(law, {}))
    run = taylor.Reference(
        taylor.problem_of(p), stored.reference_state(lively("separation", 0, p), p)
    )
    run.v = run.disc()[1] - 0.3
    q = run.q
    alpha = run.alpha
    v = run.v
    f = run.f

    def energy():
        return (
            run.alpha @ run.alpha + run.beta @ run.beta + q.m * run.v**2 + q.m * q.r_0**2 * run.f**2
        ) / 2

    before = energy()
    run._switch("reattachment")
    impulse = q.m * (run.v - v)
    slope = run.disc()[2] / q.r_0 * q.normal
    assert impulse > 0
    assert abs(slope) > 1e-4 or not q.normal
    np.testing.assert_allclose(
        (run.alpha - alpha).astype(float), (-q.s * impulse).astype(float), rtol=1e-12
    )
    assert float(q.m * q.r_0 * (run.f - f)) == pytest.approx(float(-slope * impulse), rel=1e-12)
    if q.normal:
        driven = 0
    else:
        driven = f * run.disc()[2]
    assert float(before - energy()) == pytest.approx(float(impulse * (0.3 / 2 - driven)), rel=1e-9)
