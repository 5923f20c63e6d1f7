"""Answers of this package with other modes, and from the cycle itself."""

import math
import time as clock
from collections.abc import Mapping
from functools import lru_cache, partial
from typing import Any

from benchmarks import replies
from benchmarks.methods import METHODS
from benchmarks.questions import Replies, Reply, reply_of
from benchmarks.work_precision import DEFAULT
from disc_model.data.variables import CycleStatus
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.floquet import floquet

RICHEST: dict[str, Any] = {"n_diameters": 12, "contact_compliance": "residual"}
CELLS = 64
"""Number of cells of the region on which models are compared."""
SETTLES_WITHIN = 400.0
"""Time within which a model loses contact, s."""
SETTLES_FOR = 100.0
"""Time from then until the examined motion, s."""
NEVER = 1e6
"""A budget in s that is never used up: models take their time."""
SERIES = replies.setting_of(METHODS["series"], DEFAULT)


# ---- With other modes, at its default tolerance


def ask_model(model: Mapping[str, Any]) -> Replies:
    """Return the replies to all questions with modes that are given as fields of the parameters."""
    cell = partial(replies.cell, SERIES, NEVER, **model)
    return {
        **replies.first_separation(SERIES, NEVER, replies.SEPARATING.replace(**model)),
        **settled_after_separation(replies.SETTLED.replace(**model)),
        **ask_cycle(model, DEFAULT),
        "region": replies.judged(cell, right_cell, NEVER, CELLS),
    }


@lru_cache(maxsize=1)
def richest() -> Replies:
    """Return the replies with the `RICHEST` modes."""
    return ask_model(RICHEST)


@lru_cache(maxsize=CELLS)
def right_cell(index: int) -> bool:
    """Return whether a cell of the region separates with the `RICHEST` modes."""
    separates, _ = replies.cell(SERIES, NEVER, index, **RICHEST)
    return separates


def settled_after_separation(p: Parameters) -> Replies:
    """Return replies as of `replies.after_separation`, from the state that a case reaches."""
    first = simulate(p, SETTLES_WITHIN, events=False, tol=DEFAULT, stop_at="first_separation")
    if not math.isfinite(first.first_separation):
        missing = f"no separation within {SETTLES_WITHIN:g} s"
        return dict.fromkeys(replies.AFTER_SEPARATION, reply_of(math.nan, math.nan, missing))
    state = first.final_state
    late = simulate(p, state.time + SETTLES_FOR, events=False, tol=DEFAULT, initial_state=state)
    return replies.after_separation(SERIES, NEVER, p, late.final_state)


# ---- From the cycle itself

FOLD_FROM = 14.8
"""Speed at which the quiet cycle is followed from, rad/s."""
FOLD_BETWEEN = (14.5, 16.0)
"""Speeds between which it is followed, rad/s."""


def ask_cycle(model: Mapping[str, Any], tol: float) -> Replies:
    """Return onset and growth rate from the cycle itself, without a simulation.

    Their time is the least processor time of several runs.

    Parameters
    ----------
    model : modes, as fields of the parameters
    tol : tolerance
    """
    found = {}
    for name, function, case in (
        ("onset", cycle_onset, replies.SEPARATING),
        ("growth_rate", cycle_growth_rate, replies.GROWING),
    ):
        p = case.replace(**model)
        reply = function(p, tol)  # may have compiled
        seconds = math.inf
        for _ in range(replies.REPEATS):
            began = clock.thread_time()
            function(p, tol)
            seconds = min(seconds, clock.thread_time() - began)
            if seconds > replies.QUICK:
                break
        found[name] = reply._replace(seconds=seconds)
    return found


def cycle_onset(p: Parameters, tol: float) -> Reply:
    """Reply at which speed the first fold of the quiet cycle is, rad/s, above 14.5 rad/s."""
    low, high = FOLD_BETWEEN
    start = p.replace(Omega=FOLD_FROM)
    try:
        folds = continue_cycle(start, "Omega", FOLD_BETWEEN, direction=1, tol=tol).folds
    except ParameterError as error:
        return reply_of(math.nan, 0.0, f"no cycle to follow: {error}")
    speed = folds[0, 0] if len(folds) else math.nan
    return reply_of(speed, 0.0, f"no fold from {low:g} to {high:g} rad/s")


def cycle_growth_rate(p: Parameters, tol: float) -> Reply:
    """Reply at which rate disturbances of the stick-slip cycle grow, 1/s, by its multipliers."""
    cycle = floquet(p, tol=tol)
    rate = math.nan
    if cycle.status is CycleStatus.OK:
        rate = cycle.growth_rate
    return reply_of(rate, 0.0, cycle.message)
