"""Compute the right answers of the benchmark (extra `bench`); run from the repository's root::

    python -m tests.references.make_answer_references src/disc_model/benchmarks/data/answers.json

Each is found without the engine: by the long-double Taylor reference of tests/references, or by
heyoka in double precision, and once more at another tolerance; what the two differ by is stored
with it.  Where motions start is the engine's doing at its tightest tolerance: any state would do
there.  The fold of the quiet cycle is the engine's alone.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from disc_model.benchmarks import answers
from disc_model.benchmarks.answers import Reply, Solve
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.methods.integrators import Problem
from disc_model.benchmarks.scenes import stored
from disc_model.errors import script
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.continuation import continue_cycle
from tests.references.stored import as_json, load

TIGHT, TIGHTER = 1e-13, 1e-15
ENGINE = 1e-14
ONSET_WITHIN = 2e-4
"""rad/s"""
HEYOKA = "heyoka at tolerances 1e-13 and 1e-15"
LONG = "long-double Taylor series (tests/references)"


def state_at(p: Parameters, time: float) -> dict[str, Any]:
    """The engine's state, as JSON holds it."""
    return as_json(simulate(p, time, tol=ENGINE).raise_for_status().final_state)


def by_heyoka(tol: float) -> Solve:
    return lambda problem, budget: METHODS["heyoka"].solve(problem, tol, budget)


def twice(ask: Callable[..., Any], name: str) -> dict[str, Any]:
    """An answer at two tolerances."""
    loose, tight = (ask(by_heyoka(tol), np.inf)[name] for tol in (TIGHT, TIGHTER))
    return entry(tight, abs(tight.value - loose.value), HEYOKA)


def entry(reply: Reply, error: float, by: str) -> dict[str, Any]:
    return {"value": reply.value, "error": error, "by": by}


def first_separation() -> dict[str, Any]:
    """From the stored long-double run of tests/references."""
    known = load("first_separation")
    # what a unit in the last place of each constant of the disc comes to there
    error = sum(abs(shift) for shift in known["shift_per_unit_in_last_place"].values())
    return {"value": known["time"], "error": error, "by": LONG}


def after_separation() -> dict[str, dict[str, Any]]:
    """Rate and period by heyoka; the range by two methods of short steps."""
    start = answers.read_state(answers.stored("answers")["starts"]["settled"])
    watched = Problem(answers.SETTLED, start, start.time + answers.SETTLED_SPAN, watched=True)
    steps = [
        METHODS[name].solve(watched, setting).heights
        for name, setting in (("RK4", 2e-5), ("RK4", 1e-5))
    ]
    coarse, fine = (high - low for low, high in steps)
    return {
        name: twice(answers.after_separation, name) for name in ("separation_rate", "period")
    } | {
        "disc_range": {
            "value": fine,
            "error": abs(fine - coarse),
            "by": "fixed steps of 2e-5 and 1e-5 s (RK4)",
        }
    }


def region() -> tuple[list[str], dict[str, Any]]:
    """All cells, and the reference of the share judged wrong; its error: what another tolerance
    judges otherwise."""
    maps = []
    for tol in (TIGHT, TIGHTER):
        solve = by_heyoka(tol)
        maps.append([answers.cell(solve, np.inf, index)[0] for index in range(answers.SIDE**2)])
    rows = np.array(maps[1]).reshape(answers.SIDE, answers.SIDE)
    unlike = float(np.mean(np.array(maps[0]) != np.array(maps[1])))
    return ["".join("01"[int(x)] for x in row) for row in rows], {
        "value": 0.0,
        "error": unlike,
        "by": HEYOKA,
    }


def fold() -> dict[str, Any]:
    start, way = answers.SEPARATING.replace(Omega=14.8), {"bounds": (14.5, 16.0), "direction": 1}
    speeds = [
        float(continue_cycle(start, "Omega", **way, tol=tol).folds[0, 0]) for tol in (1e-12, ENGINE)
    ]
    return {"value": speeds[1], "error": max(abs(speeds[1] - speeds[0]), 1e-12),
            "by": "continuation of the cycle by the engine at tolerances 1e-12 and 1e-14"}  # fmt: skip


@script
def main(output: str) -> None:
    data: dict[str, Any] = {
        "starts": {
            "settled": state_at(answers.SETTLED, answers.SETTLED_AT),
            "growing": state_at(answers.GROWING, answers.GROWING_AT),
        },
        "references": {},
    }

    def keep() -> None:
        Path(output).write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
        stored.cache_clear()

    keep()
    data["references"]["first_separation"] = first_separation()
    data["references"] |= after_separation()
    data["references"]["growth_rate"] = twice(answers.growth_rate, "growth_rate")
    keep()
    data["references"]["fold"] = fold()
    onset = [
        answers.onset(by_heyoka(tol), np.inf, ONSET_WITHIN)["onset"] for tol in (TIGHT, TIGHTER)
    ]
    data["references"]["onset"] = entry(
        onset[1], max(0.5 * (o.high - o.low) for o in onset), HEYOKA
    )
    keep()
    data["region"], data["references"]["region"] = region()
    keep()
