"""`simulate` on ramps of Omega and of N, against references that know nothing of the engine."""

from dataclasses import replace

import numpy as np
import pytest

from disc_model import Parameters, Ramp
from tests.contact_laws import ALL_LAWS, COMPILES
from tests.references import taylor
from tests.validation.agree import followed

#: s, what is promised.
EVENT_TIMES = 1e-12


def compared(p, ramps, span, start=None):
    """A run on ramps, whose samples also show where the drive has turned to."""
    return followed(p, span, start, ramps=ramps, within=EVENT_TIMES, theta=0.7)[0]


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
