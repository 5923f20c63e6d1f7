"""Answers of this package with other modes at its default tolerance, and from the cycle itself without simulation.

The error of a model is its distance from the richest one, `RICHEST` nodal diameters with residual flexibility. Rigid
contact converges to it slowly as modes are added; a few modes suffice with residual flexibility.
"""

import math
import time as clock
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache, partial, wraps
from typing import Any

from disc_model.benchmarks.answers import questions, simulated
from disc_model.benchmarks.answers.questions import Found
from disc_model.benchmarks.answers.simulated import found
from disc_model.benchmarks.registry import METHODS
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import CycleStatus, floquet

DEFAULT = 1e-10
RICHEST: dict[str, Any] = {"n_diameters": 12, "contact_compliance": "residual"}
CELLS = 64
"""Number of cells of the region on which models are compared."""
SETTLES_WITHIN, SETTLES_FOR = 400.0, 100.0
"""Time within which contact is lost, and time from then until the motion is examined, s."""
NEVER = 1e6
"""A budget in s that is never used up: models take their time."""

Model = Mapping[str, Any]
solve = simulated.by(METHODS["series"], DEFAULT)


def ask(model: Model) -> Iterator[tuple[str, Found]]:
    """The answers to all questions with these modes, given as fields of the parameters."""
    yield from simulated.first_separation(solve, NEVER, questions.SEPARATING.replace(**model)).items()
    yield from after_separation(questions.SETTLED.replace(**model)).items()
    yield "onset", onset(questions.SEPARATING.replace(**model), DEFAULT)
    yield "growth_rate", growth_rate(questions.GROWING.replace(**model), DEFAULT)
    yield "region", simulated.judged(partial(_cell, model), _right_cell, NEVER, CELLS)


def after_separation(p: Parameters) -> simulated.Answers:
    """Answers as of `simulated.after_separation`, from the state that this model's motion reaches."""
    quiet = Record(events=False)
    first = simulate(p, SETTLES_WITHIN, tol=DEFAULT, record=quiet, stop_at="first_separation")
    if not math.isfinite(first.first_separation):
        nothing = found(math.nan, math.nan, f"no separation within {SETTLES_WITHIN:g} s")
        return dict.fromkeys(simulated.AFTER_SEPARATION, nothing)
    state = first.final_state
    late = simulate(p, state.time + SETTLES_FOR, tol=DEFAULT, record=quiet, initial_state=state)
    return simulated.after_separation(solve, NEVER, p, late.final_state)


def _timed(ask: Callable[[Parameters, float], Found]) -> Callable[[Parameters, float], Found]:
    """A question with the least processor time (s) of several runs; the first run may have compiled."""

    @wraps(ask)
    def asked(p: Parameters, tol: float) -> Found:
        seconds, answer = math.inf, ask(p, tol)
        for _ in range(simulated.REPEATS):
            began = clock.thread_time()
            answer = ask(p, tol)
            seconds = min(seconds, clock.thread_time() - began)
            if seconds > simulated.QUICK:
                break
        return answer._replace(seconds=seconds)

    return asked


@_timed
def onset(p: Parameters, tol: float) -> Found:
    """Speed (rad/s) of the first fold of the quiet cycle above 14.5 rad/s."""
    low, high = 14.5, 16.0
    try:
        folds = continue_cycle(p.replace(Omega=14.8), "Omega", (low, high), tol=tol).folds
    except ParameterError as error:
        return found(math.nan, 0.0, f"no cycle to follow: {error}")
    return found(folds[0, 0] if len(folds) else math.nan, 0.0, f"no fold from {low:g} to {high:g} rad/s")


@_timed
def growth_rate(p: Parameters, tol: float) -> Found:
    """Growth rate (1/s) of the stick-slip cycle, from its multipliers."""
    cycle = floquet(p, tol=tol)
    return found(cycle.growth_rate if cycle.status is CycleStatus.OK else math.nan, 0.0, cycle.message)


def _cell(model: Model, place: int) -> tuple[bool, float]:
    return simulated.cell(solve, questions.cell(place).replace(**model), NEVER)


@lru_cache(maxsize=CELLS)
def _right_cell(place: int) -> bool:
    """Separation in a cell under the richest model."""
    return _cell(RICHEST, place)[0]
