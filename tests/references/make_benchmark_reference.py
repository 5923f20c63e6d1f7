"""Compute the benchmark's high-precision references; run from the repository's root::

    python -m tests.references.make_benchmark_reference src/disc_model/benchmarks/data/benchmark_reference.json

Event times, kinds and the state at the end, by the long-double Taylor reference of tests/references, which shares no
code with the engine.  Each run is repeated with a tighter tolerance; the larger of the two differences is stored.
"""

import json
from pathlib import Path

from disc_model.benchmarks.scenes import problem
from disc_model.errors import script
from tests.references.make_stored_references import decimal, repeated
from tests.references.stored import as_json, engine_state, reference_state, rounded
from tests.references.taylor import problem_of


def reference(name: str) -> dict[str, object]:
    task = problem(name)
    q, start = problem_of(task.parameters), reference_state(task.start, task.parameters)
    run, difference = repeated(q, start, task.t_end)
    return {
        "parameters": task.parameters.key,
        "t_end": task.t_end,
        "largest_difference_to_check_run": difference,
        "kinds": [e["kind"] for e in run.events],
        "times": [decimal(e["time"]) for e in run.events],
        "final": as_json(engine_state(rounded(run.state()), task.parameters)),
    }


@script
def main(output: str) -> None:
    data = {name: reference(name) for name in ("stick_slip", "separating", "many_modes")}
    Path(output).write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
