"""Pauses of the engine change nothing, and long runs need no more memory than short ones."""

import importlib
import json
import sys
from typing import Any

import pytest

from disc_model import Execution, Parameters, Poincare, Ramp, State, Window, simulate
from tests import processes
from tests.simulation.equal import same

P = Parameters(N=385, Omega=15.1)
WINDOWS = {
    "fine": Window(start=54.5, stop=55.2, rate=3e3),
    "bins": Window(start=54.45, stop=55.5, rate=1e3, theta=2.0, envelope=7),
}
ALL = {"windows": WINDOWS | {"turns": Poincare(start=54.6)}}
RAMPS = (
    Ramp(parameter="Omega", to=14.0, start=54.5, end=55.5),
    Ramp(parameter="N", to=300.0, start=54.9, end=55.2),
)
RUNS: dict[str, dict[str, Any]] = {
    "everything": ALL | {"execution": Execution(audit_every_step=True)},
    "nothing recorded": {"events": False},
    "out of steps": ALL | {"execution": Execution(max_steps=900, audit_every_step=True)},
    "on ramps": {"windows": WINDOWS, "ramps": RAMPS},
}


@pytest.fixture(scope="module")
def separating() -> State:
    """The first loss of contact."""
    return simulate(P, 60, stop_at="first_separation").final_state


@pytest.mark.compiled
@pytest.mark.parametrize("options", RUNS.values(), ids=RUNS)
def test_pauses_change_nothing(
    separating: State, monkeypatch: pytest.MonkeyPatch, options: dict[str, Any]
) -> None:
    undisturbed = simulate(P, 55.6, initial_state=separating, **options)
    monkeypatch.setattr(
        importlib.import_module("disc_model.simulation.run"), "STEPS_PER_PAUSE", 120
    )
    same(simulate(P, 55.6, initial_state=separating, **options), undisturbed)


TWO_HOURS = """
import json, resource
from disc_model import Execution, Parameters, simulate
seen = []
def progress(time):
    seen.append((time, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss))
execution = Execution(progress=progress)
result = simulate(Parameters(N=385, Omega=15.1), 7200, events=False, execution=execution)
print(json.dumps({"seen": seen, "status": result.status.value, **result.statistics}))
"""


@pytest.mark.slow
def test_two_hours_need_no_more_memory_than_twelve_minutes() -> None:
    found = json.loads(processes.python(TWO_HOURS).stdout)
    assert found["status"] == "ok"
    assert found["events"] >= 1e6
    assert found["energy_residual"] < 1e-10
    unit = 1024
    if sys.platform == "darwin":
        unit = 1
    early = max(size for time, size in found["seen"] if time <= 720)
    assert (found["seen"][-1][1] - early) * unit < 2e6
