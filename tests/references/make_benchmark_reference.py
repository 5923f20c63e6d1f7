"""Compute the benchmark's high-precision references (extra `bench`); run from the repository's root::

    python -m tests.references.make_benchmark_reference src/disc_model/benchmarks/data/benchmark_reference.json

Event times, kinds and the state at the end, by the long-double Taylor reference of tests/references, which shares no
code with the engine.  Each run is repeated with a tighter tolerance; the larger of the two differences is stored.
"""

import json
from pathlib import Path

import numpy as np

from disc_model import plate_modes
from disc_model.benchmarks.scenes import REFERENCED, problem
from disc_model.errors import script
from disc_model.parameters import Parameters
from tests.references.heyoka_reference import LONG, Reference, decimal
from tests.references.stored import BASE, Case, reference_state

FIELDS = ("time", "phase", "direction", "psi", "f", "u", "u_velocity", "a", "b", "alpha", "beta")


def case_of(p: Parameters) -> Case:
    modes = plate_modes(p)
    values = p.model_dump()
    base = {name: values[name] for name in BASE}
    return Case(p.N, p.Omega, list(modes["omega"]), list(np.abs(modes["psi"])), base)


def final(run: Reference, p: Parameters) -> dict[str, object]:
    """The state with the signs of `plate_modes`, as doubles."""
    sign = np.sign(plate_modes(p)["psi"].to_numpy())
    state = vars(run.state())
    modal = {name: [float(x) for x in sign * np.array(state[name], float)] for name in FIELDS[7:]}
    scalars = {name: float(state[name]) for name in ("time", "psi", "f", "u", "u_velocity")}
    return scalars | {"phase": state["phase"], "direction": int(state["direction"])} | modal


def reference(name: str) -> dict[str, object]:
    task = problem(name)
    case, start = case_of(task.parameters), reference_state(task.start, task.parameters)
    run, check = (Reference(case, start, tol=tol).run(task.t_end) for tol in (1e-21, 1e-23))
    if [e["kind"] for e in run.events] != [e["kind"] for e in check.events]:
        raise RuntimeError(f"{name}: two long-double runs disagree")
    difference = max(abs(LONG(x["time"]) - y["time"]) for x, y in zip(run.events, check.events, strict=True))
    return {
        "parameters": task.parameters.key,
        "t_end": task.t_end,
        "largest_difference_to_check_run": float(difference),
        "kinds": [e["kind"] for e in run.events],
        "times": [decimal(e["time"]) for e in run.events],
        "final": final(run, task.parameters),
    }


@script
def main(output: str) -> None:
    data = {name: reference(name) for name in REFERENCED}
    Path(output).write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
