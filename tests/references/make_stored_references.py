"""Compute the stored references of tests/references/data again, from the starts that they state, in
an hour.

Run from the repository's root::

    python -m tests.references.make_stored_references

Each run of `taylor.Reference` is repeated with another truncation; what the two differ by is stored.
Violent motion is chaotic, neighbours part by a factor of e in 3 ms: it is stored in pieces, each
from the state, rounded to doubles, in which the one before ended.
"""

import json

import numpy as np

from disc_model.errors import script
from tests.references.stored import DATA, load
from tests.references.taylor import TRUNCATION, Reference, stored_problem

FINER = TRUNCATION / 1e3
"""Truncation of the runs that check others."""


def decimal(x):
    """Return a number as text with 20 decimals."""
    return np.format_float_positional(np.longdouble(x), precision=20, unique=False)


def repeated(q, start, t_end):
    """Return a run, and by how many s the events of one of another truncation differ."""
    run, check = (Reference(q, start, size).run(t_end) for size in (TRUNCATION, FINER))
    if [e["kind"] for e in run.events] != [e["kind"] for e in check.events]:
        raise RuntimeError("two long-double runs disagree")
    apart = [
        abs(one["time"] - two["time"]) for one, two in zip(run.events, check.events, strict=True)
    ]
    return run, float(max(apart, default=0.0))


def again(q, run, t_end):
    """Return a stored run with its events computed anew."""
    found, difference = repeated(q, run["start"] or q.equilibrium(), t_end)
    columns = {
        "largest_difference_to_check_run": difference,
        "times": [decimal(event["time"]) for event in found.events],
    }
    for name, of_event in (("kinds", "kind"), ("phase", "phase")):
        columns[name] = [event[of_event] for event in found.events]
    for name in ("psi", "f", "P"):
        columns[name] = [float(event[name]) for event in found.events]
    return run | {name: values for name, values in columns.items() if name in run}


def first_separation(q, truncation=TRUNCATION):
    """Return the time of the first separation."""
    run = Reference(q, q.equilibrium(), truncation)
    while True:
        for event in run.run(run.time + 0.1).events:
            if event["kind"] == "separation":
                return event["time"]


def write(name, data):
    """Write a stored reference."""
    (DATA / f"{name}.json").write_text(json.dumps(data, default=vars) + "\n", encoding="utf-8")
    print(name, flush=True)


@script
def main():
    """Write all stored references."""
    for name in "ABC":
        data = load(name)
        write(name, again(stored_problem(data), data, data["t_end"]))

    wild = load("wild")
    for group in wild["groups"]:
        q = stored_problem({**group, "modes": wild["modes"]})
        group["runs"] = [again(q, run, group["t_end"]) for run in group["runs"]]
    write("wild", wild)

    first = load("first_separation")
    q = stored_problem(first)
    times = [first_separation(q, size) for size in (TRUNCATION, FINER)]
    decimals = dict(zip(("long_double", "long_double_check"), map(decimal, times), strict=True))
    write("first_separation", first | {"time": float(times[0]), "time_decimal": decimals})
