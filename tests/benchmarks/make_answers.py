"""Compute the right answers of the benchmark (extra ``bench``).

Run from the repository's root::

    python -m tests.benchmarks.make_answers benchmarks/data/answers.json

Each is found without the engine: by the long-double Taylor reference of tests/references, or by
heyoka in double precision, and once more at another tolerance; what the two differ by is stored
with it. The states at which motions start are the engine's at its tightest tolerance, because any
state would do there. The fold of the quiet cycle is the engine's alone.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import own_answers, replies
from benchmarks.methods import METHODS
from benchmarks.methods.integrators import Problem
from benchmarks.questions import Replies, Reply
from benchmarks.scenes import read_state, stored
from disc_model.errors import script
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.continuation import continue_cycle
from tests.references.stored import as_json, load

TIGHT = 1e-13
TIGHTER = 1e-15
ENGINE = 1e-14
"""Tolerance of the engine."""
ONSET_WITHIN = 2e-4
"""rad/s"""
HEYOKA = "heyoka at tolerances 1e-13 and 1e-15"
LONG = "long-double Taylor series (tests/references)"
CONTINUATION = "continuation of the cycle by the engine at tolerances 1e-12 and 1e-14"
Entry = dict[str, Any]
"""A value with its error and the method by which it was found."""


def entry(value: float, error: float, by: str) -> Entry:
    """Return an entry of the file."""
    return {"value": value, "error": error, "by": by}


def state_at(p: Parameters, time: float) -> dict[str, Any]:
    """Return the engine's state at a time in s, as JSON holds it."""
    return as_json(simulate(p, time, tol=ENGINE).raise_for_status().final_state)


def by_heyoka(tol: float) -> replies.Solve:
    """Return heyoka at a tolerance, as a method without a budget."""
    return lambda problem, budget: METHODS["heyoka"].solve(problem, tol, budget)


def at_two_tolerances(ask: Callable[..., Replies], name: str) -> tuple[Reply, Reply]:
    """Return the replies of heyoka to a question, at the looser tolerance first."""
    loose = ask(by_heyoka(TIGHT), np.inf)[name]
    tight = ask(by_heyoka(TIGHTER), np.inf)[name]
    return loose, tight


def compared(ask: Callable[..., Replies], name: str) -> Entry:
    """Return heyoka's answer, with the difference between two tolerances as its error."""
    loose, tight = at_two_tolerances(ask, name)
    return entry(tight.value, abs(tight.value - loose.value), HEYOKA)


def first_separation() -> Entry:
    """Return the answer of the stored long-double run of tests/references."""
    known = load("first_separation")
    # what a unit in the last place of each constant of the disc comes to there
    shifts = known["shift_per_unit_in_last_place"].values()
    return entry(known["time"], sum(abs(shift) for shift in shifts), LONG)


def disc_range() -> Entry:
    """Return the range of the disc after a separation, by fixed steps of two lengths."""
    start = read_state(stored("answers")["starts"]["settled"])
    end = start.time + replies.SETTLED_SPAN
    watched = Problem(replies.SETTLED, start, end, watched=True)
    ranges = []
    for step in (2e-5, 1e-5):
        low, high = METHODS["RK4"].solve(watched, step).heights
        ranges.append(high - low)
    coarse, fine = ranges
    return entry(fine, abs(fine - coarse), "fixed steps of 2e-5 and 1e-5 s (RK4)")


def region() -> tuple[list[str], Entry]:
    """Return all cells of the region as rows of digits, and the share judged wrongly.

    The error of this share is what another tolerance judges otherwise.
    """
    maps = []
    for tol in (TIGHT, TIGHTER):
        solve = by_heyoka(tol)
        cells = range(replies.SIDE**2)
        maps.append(np.array([replies.cell(solve, np.inf, index)[0] for index in cells]))
    loose, tight = maps
    rows = tight.reshape(replies.SIDE, replies.SIDE)
    digits = rows.astype(int).astype(str)
    lines = ["".join(row) for row in digits]
    return lines, entry(0.0, float(np.mean(loose != tight)), HEYOKA)


def fold() -> Entry:
    """Return the fold of the quiet cycle, by the engine at two tolerances."""
    start = replies.SEPARATING.replace(Omega=own_answers.FOLD_FROM)
    speeds = []
    for tol in (1e-12, ENGINE):
        branch = continue_cycle(start, "Omega", own_answers.FOLD_BETWEEN, direction=1, tol=tol)
        speeds.append(float(branch.folds[0, 0]))
    loose, tight = speeds
    return entry(tight, max(abs(tight - loose), 1e-12), CONTINUATION)


def onset() -> Entry:
    """Return the speed of onset, whose error is half the wider bracket of two tolerances."""

    def ask(solve: replies.Solve, budget: float) -> Replies:
        return replies.onset(solve, budget, ONSET_WITHIN)

    found = at_two_tolerances(ask, "onset")
    widths = [reply.high - reply.low for reply in found]
    return entry(found[1].value, 0.5 * max(widths), HEYOKA)


@script
def main(output: str) -> None:
    """Write all answers to a file, each as soon as what follows needs it."""
    references: dict[str, Entry] = {}
    data: dict[str, Any] = {
        "starts": {
            "settled": state_at(replies.SETTLED, replies.SETTLED_AT),
            "growing": state_at(replies.GROWING, replies.GROWING_AT),
        },
        "references": references,
    }

    def keep() -> None:
        Path(output).write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
        stored.cache_clear()

    keep()
    references["first_separation"] = first_separation()
    for name in ("separation_rate", "period"):
        references[name] = compared(replies.after_separation, name)
    references["disc_range"] = disc_range()
    references["growth_rate"] = compared(replies.growth_rate, "growth_rate")
    keep()
    references["fold"] = fold()
    references["onset"] = onset()
    keep()
    data["region"], references["region"] = region()
    keep()
