"""Compute the stored references of tests/references/data and of the benchmark (an hour); run from
the root::

    python -m tests.references.make_stored_references

Each run of `taylor.Reference` is repeated with another truncation; what the two differ by is
stored.  Times of A, B, C, wild and first_separation that are in the repository were found by
heyoka's series in long double, with another search for roots: they agree with these to 1e-17 s.
"""

import json
import math
from itertools import accumulate
from pathlib import Path

import numpy as np

from disc_model import benchmarks
from disc_model.benchmarks.scenes import problem
from disc_model.errors import script
from tests.contact_laws import LAWS
from tests.references.stored import (
    DATA,
    State,
    as_json,
    engine_state,
    load,
    reference_state,
    rounded,
)
from tests.references.taylor import TRUNCATION, Reference, problem_of, stored_problem, violent_start

#: s; violent motion is chaotic (neighbours part by a factor of e in 3 ms): it is stored in pieces, each from the
#: state, rounded to doubles, in which the one before ended.
PIECE = 0.01
#: Little friction and all dampers.
SLIPPERY = {
    "N": 100.0,
    "Omega": 3.0,
    "mu_s": 0.06,
    "mu_k": 0.04,
    "c": 2.0,
    "c_p": 0.3,
    "D_star": 2e-5,
}


def decimal(x):
    return np.format_float_positional(np.longdouble(x), precision=20, unique=False)


def repeated(q, start, t_end):
    """A run, and by how many s one of another truncation differs."""
    run, check = (Reference(q, start, size).run(t_end) for size in (TRUNCATION, TRUNCATION / 1e3))
    if [e["kind"] for e in run.events] != [e["kind"] for e in check.events]:
        raise RuntimeError("two long-double runs disagree")
    differences = [
        abs(x["time"] - y["time"]) for x, y in zip(run.events, check.events, strict=True)
    ]
    return run, float(max(differences, default=0))


def described(run, difference, *more):
    """A run, in columns: kinds, times and contact forces of its events, and what ``more`` is asked
    for."""
    columns = {
        "kinds": [e["kind"] for e in run.events],
        "times": [decimal(e["time"]) for e in run.events],
    }
    columns |= {
        name: [e[name] if name == "phase" else float(e[name]) for e in run.events]
        for name in ("P", *more)
    }
    return {"largest_difference_to_check_run": difference} | columns


def published(**changes):
    """Parameters and modes of a published case; the modes, as stored, were found in 40 digits by
    mpmath."""
    return {"parameters": load("C")["parameters"] | changes, "modes": load("C")["modes"]}


def write(name, data):
    (DATA / f"{name}.json").write_text(json.dumps(data) + "\n", encoding="utf-8")
    print(name, flush=True)


def record(name, data, start, t_end):
    """Every event of a run with what is continuous there."""
    q = stored_problem(data)
    found = described(*repeated(q, start or q.equilibrium(), t_end), "phase", "psi", "f")
    write(name, data | {"start": None if start is None else vars(start), "t_end": t_end} | found)


def wild_start(psi, base, rng):
    """A separated state of violent vibration: crowded switches, impacts with P < 0 after them,
    reversals."""
    scale, n = rng.uniform(0.2, 3), len(psi)
    a, b = (
        np.array(base.a) * scale * rng.normal(1, 0.3, n),
        np.array(base.b) * scale * rng.normal(1, 5, n),
    )
    alpha, beta = (np.array(x) * scale * rng.normal(0, 4, n) for x in (base.alpha, base.beta))
    height = float(np.dot(psi, a)) + 1e-3 * abs(rng.normal())
    angle, f, fall = 0.03 * rng.normal(), 25 * rng.normal(), rng.normal()
    modal = (list(x) for x in (a, b, alpha, beta))
    return rounded(State(0.0, "separation", 0, float(angle), float(f), height, float(fall), *modal))


def wild(base):
    """Short runs from violent starts, half of them with little friction and all dampers."""
    rng, groups = np.random.default_rng(1), []
    for data in (published(), published(**SLIPPERY)):
        runs = []
        for _ in range(16):
            start = wild_start(data["modes"]["psi"], base, rng)
            runs.append(
                {"start": vars(start)} | described(*repeated(stored_problem(data), start, 0.2))
            )
        groups.append({"parameters": data["parameters"], "t_end": 0.2, "runs": runs})
    write("wild", {"modes": published()["modes"], "groups": groups})


def first_separation(q, truncation=TRUNCATION):
    """Time of the first separation, and how many events are before it."""
    run = Reference(q, q.equilibrium(), truncation)
    while True:
        kinds = [e["kind"] for e in run.run(run.time + 0.1).events]
        if "separation" in kinds:
            before = kinds.index("separation")
            return run.events[before]["time"], before


def shifts(data, time):
    """By how many s the first separation moves when one omega or psi is one unit in the last place
    larger."""
    found = {}
    for name in ("omega", "psi"):
        for l, value in enumerate(data["modes"][name]):
            values = list(data["modes"][name])
            values[l] = float(np.nextafter(value, np.inf))
            other = data | {"modes": data["modes"] | {name: values}}
            found[f"{name}_{l}"] = float(first_separation(stored_problem(other))[0] - time)
    return found


def contact(name):
    """A first second and half a second of violent motion under another law of contact."""
    parameters = published(**{"contact_compliance": 0.0, "contact_force": "vertical"} | LAWS[name])[
        "parameters"
    ]
    q = stored_problem({"parameters": parameters})
    first, difference = repeated(q, q.equilibrium(), 1.0)
    runs, start = (
        [{"start": None, "t_end": 1.0} | described(first, difference)],
        violent_start(1.0 if q.C else 1.3),
    )
    for i in range(round(0.5 / PIECE)):
        run, difference = repeated(q, start, (i + 1) * PIECE)
        runs.append({"start": vars(start), "t_end": (i + 1) * PIECE} | described(run, difference))
        start = rounded(run.state())
    write(f"contact_{name}", {"parameters": parameters, "runs": runs})


def of_benchmark(name):
    """A scene of the benchmark: event times, kinds and the state at the end."""
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


def rigid_cycle():
    """Stick-slip on a rigid disc from a relaxed spring, in closed form (contact force N, no
    damping), up to its third event. At E = 1e20 Pa the disc's remaining flexibility, k
    psi^2/omega^2, is 3e-9: this is exact to about that."""
    task = problem("rigid")
    p, w = task.parameters, math.sqrt(task.parameters.k_p / task.parameters.m)
    held, slipping = p.mu_s * p.N / (p.k_p * p.r_0), p.mu_k * p.N / (p.k_p * p.r_0)
    d = held - slipping
    slip = 2.0 / w * (math.pi - math.atan(d * w / p.Omega))
    times = [*accumulate([held / p.Omega, slip, (held - (slipping - d)) / p.Omega])]
    tau = task.t_end - times[-1]
    psi = slipping + d * math.cos(w * tau) + p.Omega / w * math.sin(w * tau)
    f = p.Omega + d * w * math.sin(w * tau) - p.Omega * math.cos(w * tau)
    return {
        "parameters": p.key,
        "t_end": task.t_end,
        "largest_difference_to_check_run": 1e-9 * task.t_end,
        "kinds": ["stick_to_slip", "slip_to_stick", "stick_to_slip"],
        "times": [f"{t:.25f}" for t in times],
        "final": as_json(
            task.start.replace(time=task.t_end, phase="slip", direction=1, psi=psi, f=f)
        ),
    }


@script
def main():
    case = published()
    record("A", case, None, 1.0)
    record("B", published(N=300.0, Omega=20.0), None, 1.0)
    q = stored_problem(case)
    start = rounded(Reference(q, q.equilibrium()).run(54.4).state())
    record("C", case, start, 55.4)
    wild(start)
    (time, before), (check, _) = (
        first_separation(q, truncation) for truncation in (TRUNCATION, TRUNCATION / 1e3)
    )
    times = {"long_double": decimal(time), "long_double_check": decimal(check)}
    found = {"events_before": before, "time": float(time), "time_decimal": times}
    write("first_separation", case | found | {"shift_per_unit_in_last_place": shifts(case, time)})
    for name in LAWS:
        contact(name)
    data = {name: of_benchmark(name) for name in ("stick_slip", "separating", "many_modes")} | {
        "rigid": rigid_cycle()
    }
    target = Path(benchmarks.__file__).parent / "data" / "benchmark_reference.json"
    target.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
