"""`simulate` on ramps of Omega and of N, against references that know nothing of the engine."""

from dataclasses import replace

import numpy as np
import pytest

from disc_model import Execution, Parameters, Ramp, Window, simulate
from tests.contact_laws import ALL_LAWS, COMPILES, course_of, turned
from tests.references import stored, taylor

#: s, what is promised.
EVENT_TIMES = 1e-12
THETA = 0.7


def compared(p, ramps, t_end, start=None):
    """Switches of a run on ramps, its audit, and samples that also show where the drive has turned
    to."""
    q = taylor.problem_of(p)
    course = course_of(p, ramps)
    reference = taylor.Reference(q, start or q.equilibrium(), course=course)
    windows = {"w": Window(rate=1e3, theta=THETA)}
    execution = Execution(audit_every_step=True)
    given = start and stored.engine_state(start, p)
    found = simulate(
        p, t_end, windows, tol=1e-15, initial_state=given, ramps=ramps, execution=execution
    )
    assert found.statistics["audited_steps"] == found.statistics["steps"]
    assert found.statistics["energy_residual"] < 1e-13
    sample = found.samples["w"]
    wanted = np.array([reference.run(t).sample(turned(course, t), THETA) for t in sample["time"]])
    for name, values in zip(taylor.SAMPLED, wanted.T, strict=True):
        np.testing.assert_allclose(
            sample[name], values, rtol=0, atol=1e-9 * np.abs(values).max(), err_msg=name
        )
    events = reference.run(t_end).events
    assert list(found.events["kind"]) == [event["kind"] for event in events]
    times = [float(event["time"]) for event in events]
    np.testing.assert_allclose(found.events["time"], times, rtol=0, atol=EVENT_TIMES)
    return found


def _ramp(p, parameter, rate, end=0.0625):
    """From time 0 on; powers of two keep the rate what was said."""
    return Ramp(parameter=parameter, to=getattr(p, parameter) + rate * end, start=0.0, end=end)


@pytest.mark.parametrize(
    "name", ["default", *(pytest.param(name, marks=COMPILES) for name in ALL_LAWS)]
)
def test_every_law_on_ramps_of_both(name):
    """Of a motion that separates."""
    p = Parameters(N=385.0, Omega=15.1, c=5.0, c_p=0.5, **ALL_LAWS.get(name, {}))
    ramps = (_ramp(p, "Omega", -128.0), _ramp(p, "N", -2048.0))
    size = 1.3
    if p.contact_compliance:
        size = 1.0
    start = taylor.violent_start(size)
    found = compared(p, ramps, 0.02, start)
    assert {"separation", "reattachment"} <= set(found.events["kind"])


def vibrating(p):
    """The static start of a reference, with a disc that vibrates along the slider's direction."""
    q = taylor.problem_of(p)
    rest = q.equilibrium()
    alpha = 0.02 * np.sqrt(q.w2) * np.abs(rest.a)
    return replace(rest, alpha=alpha, u_velocity=q.s @ alpha)


def test_a_run_up_from_rest():
    p = Parameters(N=20.0, Omega=0.0, c_p=5.0, n_diameters=1)
    run_up = Ramp(parameter="Omega", to=0.5, start=0.0, end=0.0078125)
    kinds = list(compared(p, (run_up,), 0.025, vibrating(p)).events["kind"])
    assert kinds == ["stick_to_slip", "slip_to_stick"]


def test_a_brake_stop_and_the_rest_after_it():
    p = Parameters(N=50.0, Omega=15.0, c_p=5.0, n_diameters=1)
    stop = Ramp(parameter="Omega", to=0.0, start=0.0078125, end=0.015625)
    found = compared(p, (stop,), 0.025, vibrating(p))
    assert found.final_state.phase == "stick"
    assert found.message.startswith("at_rest: at t = 0.025 s in stick, the drive stands still")


@pytest.mark.parametrize(
    "ramps",
    [
        (Ramp(parameter="Omega", to=5.0, start=0.013, end=0.041),),
        (
            Ramp(parameter="Omega", to=25.0, start=0.01, end=0.03),
            Ramp(parameter="N", to=600.0, start=0.02, end=0.05),
            Ramp(parameter="Omega", to=10.0, start=0.03, end=0.045),
        ),
    ],
    ids=["Omega", "both"],
)
def test_ramps_that_begin_and_end_within_the_run(ramps):
    p = Parameters(N=400.0, Omega=15.0, c_p=1.0, n_diameters=1)
    assert len(compared(p, ramps, 0.07).events) > 5
