"""Compute the right answers of the benchmark (extra ``bench``), in minutes.

Run from the repository's root::

    python -m tests.benchmarks.make_references

None is found by the engine: scenes by the long-double Taylor series of tests/references, and answers
by heyoka at two tolerances, whose difference is stored as their error. Starts of motions,
which any states could be, stay as stored. The rigid disc's answer is that of the
textbook friction oscillator, exact to the disc's remaining flexibility of 3e-9, and stays as stored.
"""

import json
from pathlib import Path

import numpy as np

from benchmarks import answers
from benchmarks.methods import METHODS
from benchmarks.scenes import problem, stated, stored
from disc_model.errors import script
from tests.references import stored as references
from tests.references.make_stored_references import decimal, repeated
from tests.references.taylor import problem_of

DATA = Path("benchmarks/data")
TOLERANCES = (1e-13, 1e-15)


def scene(name):
    """Return the answer of a scene: event times, kinds and the state at the end."""
    task = problem(name)
    p = task.parameters
    start = references.reference_state(task.start, p)
    run, difference = repeated(problem_of(p), start, task.t_end)
    final = references.engine_state(references.rounded(run.state()), p)
    return {
        "parameters": stated(p),
        "t_end": task.t_end,
        "largest_difference_to_check_run": difference,
        "kinds": [event["kind"] for event in run.events],
        "times": [decimal(event["time"]) for event in run.events],
        "final": references.as_json(final),
    }


def answers_by_heyoka():
    """Return the answer to each question, with the difference of two tolerances as its error."""
    found = []
    for tol in TOLERANCES:
        values = {}
        for ask in answers.ASKED:
            further = (2e-4,) if ask is answers.onset else ()
            values |= ask(
                lambda task, _, tol=tol: METHODS["heyoka"].solve(task, tol), np.inf, *further
            )[0]
        found.append(values)
    loose, tight = found
    by = f"heyoka at tolerances {TOLERANCES[0]:g} and {TOLERANCES[1]:g}"
    return {
        name: {
            "value": value,
            "error": max(abs(value - loose[name]), 1e-4 * (name == "onset")),
            "by": by,
        }
        for name, value in tight.items()
    }


def write(name, content):
    """Write a file of the benchmark's data, and forget what it held."""
    Path(DATA, f"{name}.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    stored.cache_clear()


@script
def main():
    """Write all files."""
    right = {name: scene(name) for name in ("stick_slip", "separating", "many_modes")}
    write("benchmark_reference", stored("benchmark_reference") | right)
    starts = {"starts": stored("answers")["starts"]}
    write("answers", starts)
    write("answers", starts | {"references": answers_by_heyoka()})
