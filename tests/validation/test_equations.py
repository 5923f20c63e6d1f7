"""Each equation of motion, wherever the package implements it, against the paper's as printed.

tests/references/printed.py has Eqs. (18)-(37), and the states from which single phases are compared
with them.
"""

import numpy as np
import pytest

from disc_model import Execution, Window, simulate
from disc_model.engine import transitions
from disc_model.engine.model import build_state
from disc_model.engine.state import scalars_of
from disc_model.simulation.states import engine_case, read_state, write_state
from tests.references.printed import MOTIONS, SPAN, THETA, P, Printed, lively

ACCURACY = 1e-10
"""Of the literal integration; a missing term would show in the third digit or before."""


def close(got, expected, accuracy=ACCURACY, names=None):
    """Each quantity to the accuracy of its own size."""
    for name in names or expected:
        size = np.max(np.abs(expected[name]))
        np.testing.assert_allclose(
            got[name], expected[name], rtol=0, atol=accuracy * size, err_msg=name
        )


def engine_state(p, state):
    """The engine's model and state."""
    case = engine_case(p)
    inside = build_state(case.model)
    write_state(case, state, inside)
    return case.model, inside


# ------------------------------------------------------------------------------------------------
# the engine
@pytest.mark.parametrize("tol", [1e-13, 1e-6])
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_motion_of_each_phase(phase, direction, tol):
    """At a loose tolerance steps are long: a wrong coefficient of any order shows."""
    start = lively(phase, direction)
    window = Window(start=0, stop=SPAN, rate=3 / SPAN, theta=THETA)
    execution = Execution(audit_every_step=True)
    result = simulate(P, SPAN, {"w": window}, tol=tol, initial_state=start, execution=execution)
    assert len(result.events) == 0
    printed = Printed(P, start)
    accuracy = max(ACCURACY, 10 * tol)
    end = printed.at(SPAN)
    close(
        {name: getattr(result.final_state, name) for name in vars(start)},
        end,
        accuracy,
        vars(start).keys() & end,
    )
    samples = result.samples["w"]
    wanted = [printed.at(t) if t else printed.described(0.0, printed.y) for t in samples["time"]]
    names = ("P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi")
    assert len(wanted) == 4
    close(samples, {name: np.array([row[name] for row in wanted]) for name in names}, accuracy)
    np.testing.assert_allclose(
        samples["psi_velocity"], [P.Omega - row["f"] for row in wanted], rtol=accuracy
    )
    for name in ("energy_residual_transverse", "energy_residual_inplane"):
        assert result.statistics[name] < accuracy


def test_impact():
    start = lively("separation")
    printed = Printed(P, start)
    expected = printed.described(0.0, printed.literal.impact(printed.y))
    model, state = engine_state(P, start)
    impulse = transitions.impact(model, state)
    close(
        vars(read_state(engine_case(P), state)),
        expected,
        1e-12,
        ("a", "b", "alpha", "beta", "psi", "f"),
    )
    w, velocity, _ = transitions.disc_point(model, state)
    scalars = scalars_of(state)
    assert scalars["u_velocity"] == pytest.approx(expected["u_velocity"], rel=1e-12)
    assert scalars["u"] == w
    assert scalars["u_velocity"] == velocity
    assert impulse == pytest.approx(P.m * (velocity - start.u_velocity), rel=1e-12)


def test_static_equilibrium():
    """The static start: nothing moves, and the contact force is the preload."""
    model = engine_case(P).model
    start = read_state(engine_case(P), build_state(model))
    assert start.phase == "stick"
    assert start.f == 0
    assert start.psi == 0
    printed = Printed(P, start)
    assert printed.force() == pytest.approx(P.N, rel=1e-12)
    assert np.max(np.abs(printed.rates()["alpha"])) < 1e-9 * P.N
    assert model.u_0 == pytest.approx(printed.literal.w_0, rel=1e-13)
    assert start.u == pytest.approx(model.u_0, rel=1e-13)
    assert transitions.stick_force(model, build_state(model)) == pytest.approx(P.N, rel=1e-12)


def test_release_conditions_of_stick():
    """Stick breaks forwards where mu_s P = r_0 F and backwards where mu_s P = -r_0 F."""
    p = P.replace(Omega=0.5)  # so slow that the release is due to P, which swings by some per cent
    start = lively("stick", p=p)
    held = p.mu_s * Printed(p, start).force() / (p.r_0 * p.k_p)
    for side in (1, -1):
        tense = start.replace(psi=side * 0.98 * held)
        first = simulate(p, 5e-3, tol=1e-13, initial_state=tense).events.iloc[0]
        assert first["kind"] == "stick_to_slip"
        assert first["time"] > 1e-5
        printed = Printed(p, tense)
        time = first["time"]
        y = printed.literal.fresh("stick", 0.0, printed.y, time)
        friction = p.mu_s * printed.literal.contact(time, y, "stick")
        pull = p.r_0 * printed.literal.pull(time, y)
        assert friction == pytest.approx(side * pull, rel=1e-9)
        slipping = "slip-"
        if side > 0:
            slipping = "slip+"
        assert first["P"] == pytest.approx(printed.literal.contact(time, y, slipping), rel=1e-9)
