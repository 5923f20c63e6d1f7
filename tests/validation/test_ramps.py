"""`simulate` on ramps of Omega and of N, against references that know nothing of the engine."""

import numpy as np
import pytest

from disc_model import Parameters, Ramp, Record, Window, plate_modes, simulate
from tests.contact_laws import COMPILES, LAWS, course_of
from tests.references import stored, taylor

#: s, what is promised.
EVENT_TIMES = 1e-12


def _ramp(p, parameter, rate, end=0.0625):
    """From time 0 on; powers of two keep the rate what was said."""
    return Ramp(parameter=parameter, to=getattr(p, parameter) + rate * end, start=0.0, end=end)


@pytest.mark.parametrize("name", ["default", *(pytest.param(name, marks=COMPILES) for name in LAWS)])
def test_every_law_against_long_double(name):
    """All switches of a motion that separates, ramps of both."""
    p = Parameters(N=385.0, Omega=15.1, c=5.0, c_p=0.5, **LAWS.get(name, {}))
    ramps = (_ramp(p, "Omega", -128.0), _ramp(p, "N", -2048.0))
    start = taylor.violent_start(1.0 if p.contact_compliance else 1.3)
    reference = taylor.Reference(taylor.problem_of(p), start, course=course_of(p, ramps)).run(0.02)
    start, record = stored.engine_state(start, p), Record(audit_every_step=True)
    found = simulate(p, 0.02, tol=1e-15, initial_state=start, ramps=ramps, record=record)
    assert found.statistics["audited_steps"] == found.statistics["steps"]
    assert found.statistics["energy_residual"] < 1e-13
    assert list(found.events["kind"]) == [event["kind"] for event in reference.events]
    assert {"separation", "reattachment"} <= set(found.events["kind"])
    wanted = np.array([event["time"] for event in reference.events])
    assert np.abs(found.events["time"].to_numpy() - wanted).max() <= EVENT_TIMES


# ------------------------------------------------------------------------ begins and ends within the run
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
    p, t_end = Parameters(N=400.0, Omega=15.0, c_p=1.0, n_diameters=1), 0.07
    q = taylor.problem_of(p)
    run = taylor.Reference(q, q.equilibrium(), course=course_of(p, ramps)).run(t_end)
    found = simulate(p, t_end, tol=1e-14, ramps=ramps)
    assert len(run.events) > 5
    assert list(found.events["kind"]) == [event["kind"] for event in run.events]
    np.testing.assert_allclose(found.events["time"], [float(e["time"]) for e in run.events], atol=EVENT_TIMES, rtol=0)


# ------------------------------------------------------------------------ limits and continuity


def test_the_drive_goes_on_turning():
    """Points fixed to the disc see the slider pass where the integral of Omega says, on the ramp and after it."""
    p = Parameters(N=385.0, Omega=15.0)
    ramp = Ramp(parameter="Omega", to=5.0, start=0.02, end=0.04)
    record = Record(windows=tuple(Window(rate=1e3, theta=theta) for theta in (0.0, 0.7)))
    result = simulate(p, 0.06, ramps=ramp, record=record)
    sample, other = result.samples
    t = sample["time"]
    turned = (
        15 * t - np.where(t > 0.02, 250 * (np.clip(t, 0.02, 0.04) - 0.02) ** 2, 0) - 10 * np.clip(t - 0.04, 0, None)
    )
    phi = turned - sample["psi"]
    np.testing.assert_allclose(
        sample["psi_velocity"][sample["phase"] == 0], result.value_at("Omega", t[sample["phase"] == 0])
    )
    states = [simulate(p, time, ramps=ramp).final_state for time in (0.033, 0.059)]
    modes = plate_modes(p)
    for state in states:
        i = int(np.argmin(np.abs(t - state.time)))
        for window, theta in ((sample, 0.0), (other, 0.7)):
            turn = modes["diameters"].to_numpy() * (theta - phi[i])
            w = float(modes["psi"] @ (state.a * np.cos(turn) + state.b * np.sin(turn)))
            assert window["w_point"][i] == pytest.approx(w, abs=1e-12)
