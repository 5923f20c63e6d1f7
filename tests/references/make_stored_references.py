"""Compute the stored references of tests/references/data, in an hour.

Run from the repository's root::

    python -m tests.references.make_stored_references

Each run of `taylor.Reference` is repeated with another truncation; what the two differ by is stored.
Times of A, B, C, wild and first_separation that are in the repository were found by heyoka's series
in long double, with another search for roots: they agree with these to 1e-17 s.
"""

import json

import numpy as np

from disc_model.errors import script
from tests.contact_laws import LAWS
from tests.references.stored import DATA, State, load, rounded
from tests.references.taylor import TRUNCATION, Reference, stored_problem, violent_start

FINER = TRUNCATION / 1e3
"""Truncation of the runs that check others."""
PIECE = 0.01
"""Length of a piece of violent motion, s.

Such motion is chaotic: neighbours part by a factor of e in 3 ms. It is stored in pieces, each from
the state, rounded to doubles, in which the one before ended.
"""
SLIPPERY = {
    "N": 100.0,
    "Omega": 3.0,
    "mu_s": 0.06,
    "mu_k": 0.04,
    "c": 2.0,
    "c_p": 0.3,
    "D_star": 2e-5,
}
"""Little friction and all dampers."""


def decimal(x):
    """Return a number as text with 20 decimals."""
    return np.format_float_positional(np.longdouble(x), precision=20, unique=False)


def repeated(q, start, t_end):
    """Return a run, and by how many s the events of one of another truncation differ."""
    run = Reference(q, start, TRUNCATION).run(t_end)
    check = Reference(q, start, FINER).run(t_end)
    if [e["kind"] for e in run.events] != [e["kind"] for e in check.events]:
        raise RuntimeError("two long-double runs disagree")
    difference = 0.0
    for event, other in zip(run.events, check.events, strict=True):
        difference = max(difference, abs(event["time"] - other["time"]))
    return run, float(difference)


def described(run, difference, *more):
    """Return a run in columns: kinds, times and contact forces of its events, and further values.

    Parameters
    ----------
    run, difference : of `repeated`
    more : names of the further values
    """
    columns = {
        "largest_difference_to_check_run": difference,
        "kinds": [e["kind"] for e in run.events],
        "times": [decimal(e["time"]) for e in run.events],
    }
    for name in ("P", *more):
        values = [e[name] for e in run.events]
        if name == "phase":
            columns[name] = values
        else:
            columns[name] = [float(value) for value in values]
    return columns


def published(**changes):
    """Return parameters and modes of a published case.

    The modes, as stored, were found in 40 digits by mpmath.
    """
    known = load("C")
    return {"parameters": {**known["parameters"], **changes}, "modes": known["modes"]}


def write(name, data):
    """Write a stored reference."""
    (DATA / f"{name}.json").write_text(json.dumps(data) + "\n", encoding="utf-8")
    print(name, flush=True)


# ---- Motions of the paper's case


def record(name, data, start, t_end):
    """Write every event of a run, with what is continuous there.

    Parameters
    ----------
    name : of the reference
    data : parameters and modes
    start : state, or None for the static start
    t_end : s
    """
    q = stored_problem(data)
    run, difference = repeated(q, start or q.equilibrium(), t_end)
    found = described(run, difference, "phase", "psi", "f")
    if start is None:
        stored_start = None
    else:
        stored_start = vars(start)
    write(name, {**data, "start": stored_start, "t_end": t_end, **found})


def first_separation(q, truncation=TRUNCATION):
    """Return the time of the first separation, and how many events are before it."""
    run = Reference(q, q.equilibrium(), truncation)
    while True:
        kinds = [e["kind"] for e in run.run(run.time + 0.1).events]
        if "separation" in kinds:
            before = kinds.index("separation")
            return run.events[before]["time"], before


def shifts(data, time):
    """Return by how many s the first separation moves with each constant of the disc.

    One omega or psi at a time is one unit in the last place larger.
    """
    found = {}
    for name in ("omega", "psi"):
        for l, value in enumerate(data["modes"][name]):
            values = list(data["modes"][name])
            values[l] = float(np.nextafter(value, np.inf))
            modes = {**data["modes"], name: values}
            moved, _ = first_separation(stored_problem({**data, "modes": modes}))
            found[f"{name}_{l}"] = float(moved - time)
    return found


def record_first_separation(case):
    """Write the first separation of a case, with what rounding comes to there."""
    q = stored_problem(case)
    time, before = first_separation(q)
    check, _ = first_separation(q, FINER)
    write(
        "first_separation",
        {
            **case,
            "events_before": before,
            "time": float(time),
            "time_decimal": {"long_double": decimal(time), "long_double_check": decimal(check)},
            "shift_per_unit_in_last_place": shifts(case, time),
        },
    )


# ---- Violent motions


def wild_start(psi, base, rng):
    """Return a separated state of violent vibration.

    Switches crowd after it, impacts come with P < 0 after them, and slip reverses.

    Parameters
    ----------
    psi : amplitudes of the modes
    base : state whose amplitudes are made larger
    rng : source of random numbers
    """
    n = len(psi)
    scale = rng.uniform(0.2, 3)
    a = np.array(base.a) * scale * rng.normal(1, 0.3, n)
    b = np.array(base.b) * scale * rng.normal(1, 5, n)
    alpha = np.array(base.alpha) * scale * rng.normal(0, 4, n)
    beta = np.array(base.beta) * scale * rng.normal(0, 4, n)
    gap = 1e-3 * abs(rng.normal())
    return rounded(
        State(
            time=0.0,
            phase="separation",
            direction=0,
            psi=float(0.03 * rng.normal()),
            f=25 * rng.normal(),
            u=float(np.dot(psi, a)) + gap,
            u_velocity=float(rng.normal()),
            a=list(a),
            b=list(b),
            alpha=list(alpha),
            beta=list(beta),
        )
    )


def wild(base):
    """Write short runs from violent starts, half of them with little friction and all dampers."""
    rng = np.random.default_rng(1)
    groups = []
    for data in (published(), published(**SLIPPERY)):
        runs = []
        for _ in range(16):
            start = wild_start(data["modes"]["psi"], base, rng)
            run, difference = repeated(stored_problem(data), start, 0.2)
            runs.append({"start": vars(start), **described(run, difference)})
        groups.append({"parameters": data["parameters"], "t_end": 0.2, "runs": runs})
    write("wild", {"modes": published()["modes"], "groups": groups})


def contact(name):
    """Write a first second and half a second of violent motion under another law of contact."""
    law = {"contact_compliance": 0.0, "contact_force": "vertical", **LAWS[name]}
    parameters = published(**law)["parameters"]
    q = stored_problem({"parameters": parameters})
    run, difference = repeated(q, q.equilibrium(), 1.0)
    runs = [{"start": None, "t_end": 1.0, **described(run, difference)}]
    size = 1.3
    if q.C:
        size = 1.0
    start = violent_start(size)
    for i in range(round(0.5 / PIECE)):
        t_end = (i + 1) * PIECE
        run, difference = repeated(q, start, t_end)
        runs.append({"start": vars(start), "t_end": t_end, **described(run, difference)})
        start = rounded(run.state())
    write(f"contact_{name}", {"parameters": parameters, "runs": runs})


@script
def main():
    """Write all stored references."""
    case = published()
    record("A", case, None, 1.0)
    record("B", published(N=300.0, Omega=20.0), None, 1.0)
    q = stored_problem(case)
    start = rounded(Reference(q, q.equilibrium()).run(54.4).state())
    record("C", case, start, 55.4)
    wild(start)
    record_first_separation(case)
    for name in LAWS:
        contact(name)
