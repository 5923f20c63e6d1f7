"""What each answer costs, from methods, from the cycle itself, and with other modes.

Of a method the tolerance or step varies. The line ``cycle`` finds onset and growth rate without a
simulation. In the lines ``rigid`` and ``residual`` the number of nodal diameters varies, and errors
are distances from the `RICHEST`.
"""

import math
import time as clock
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache, partial
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks import failure_maps, replies, study
from disc_model.benchmarks.methods import METHODS, Method
from disc_model.benchmarks.questions import (
    FLAGS,
    QUESTIONS,
    AnswerStatus,
    Replies,
    Reply,
    reference,
    reply_of,
    verdict,
)
from disc_model.benchmarks.study import CONTACTS, TABLES, Row
from disc_model.benchmarks.work_precision import DEFAULT
from disc_model.data.dataset import json_attribute
from disc_model.data.variables import CycleStatus, flag_names
from disc_model.errors import ParameterError
from disc_model.mode_choice import real_modes
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import floquet

CYCLE_SETTINGS = (1e-6, 1e-8, 1e-10, 1e-12)
"""Tolerances of the search for a cycle."""
LINES: Mapping[str, tuple[str, str]] = TABLES["lines"]
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


# ---- Costs


def answers(
    part: str,
    settings: Sequence[float] | None = None,
    *,
    asked: Sequence[str] = tuple(replies.ASKED),
    models: Sequence[int] = (0, 1, 2, 3, 4, 6, 8),
) -> xr.Dataset:
    """Measure what answers cost, a row for each reply.

    Parameters
    ----------
    part : name of a method, ``cycle`` or ``models``
    settings : of a method, from coarse to fine; those of the scene ``stick_slip`` if None
    asked : questions to a method
    models : numbers of nodal diameters
    """
    points: list[Row] = []
    if part == "cycle":
        points = [{"line": part, "setting": tol} for tol in CYCLE_SETTINGS]
    elif part == "models":
        for line in CONTACTS:
            points += [{"line": line, "setting": count} for count in models]
    else:
        for value in settings or METHODS[part].settings["stick_slip"]:
            points += [{"line": part, "setting": value, "question": name} for name in asked]
    described = {}
    for name, question in QUESTIONS.items():
        right = reference(name)
        described[name] = {**question, "error": f"{right.error:.2g}, {right.by}"}
    return study.run(
        "answers",
        points,
        _Questioning().measure,
        flags=FLAGS,
        title="What each answer costs",
        questions=json_attribute(described),
    )


class _Questioning:
    """Asks lines at settings, and judges their replies.

    Attributes
    ----------
    hopeless : questions for which a method is too slow, which are skipped at finer settings
    """

    def __init__(self) -> None:
        self.hopeless: set[str] = set()

    def measure(self, line: str, setting: Any, question: str = "") -> Iterator[Row]:
        """Yield a row for each reply.

        Parameters
        ----------
        line : name of a method, ``cycle``, or a contact whose number of modes varies
        setting : of the line
        question : to a method
        """
        if question in self.hopeless:
            return
        found, right = self._ask(line, setting, question)
        label, varies = _words(line)
        for answer, reply in found.items():
            yield {
                "answer": answer,
                "label": label,
                "varies": varies,
                "right": right[answer],
                "found": reply.value,
                "error": abs(reply.value - right[answer]),
                "verdict": verdict(answer, reply, right[answer]),
                **reply._asdict(),
            }

    def _ask(self, line: str, setting: Any, question: str) -> tuple[Replies, Mapping[str, float]]:
        """Return the replies of a line, and the right answers."""
        if line == "cycle":
            right = {"onset": "fold", "growth_rate": "growth_rate"}
            return ask_cycle({}, setting), {
                answer: reference(name).value for answer, name in right.items()
            }
        if line in CONTACTS:
            found = ask_model({"n_diameters": setting, **CONTACTS[line]})
            return found, {answer: reply.value for answer, reply in _richest().items()}
        function, budget = replies.ASKED[question]
        found = function(replies.setting_of(METHODS[line], setting), budget)
        if any(reply.status is AnswerStatus.TOO_SLOW for reply in found.values()):
            self.hopeless.add(question)
        return found, {answer: reference(answer).value for answer in found}


def _words(line: str) -> tuple[str, str]:
    """Return a line in words, and what its setting is."""
    if line in LINES:
        label, varies = LINES[line]
        return label, varies
    return METHODS[line].label, METHODS[line].setting


def in_words(dataset: xr.Dataset) -> pd.DataFrame:
    """Return all rows, in the order in which they were measured.

    Status, verdict and setting (``at``) are in words.
    """
    frame = dataset.to_dataframe()
    settings = []
    for varies, setting in zip(frame["varies"], frame["setting"], strict=True):
        if varies == "diameters":
            settings.append(f"{setting:.0f} diameters")
        else:
            settings.append(f"{varies}={setting:g}")
    return frame.assign(
        at=settings, status=flag_names(dataset["status"]), verdict=flag_names(dataset["verdict"])
    )


# ---- Answers of this package with other modes, at its default tolerance


def ask_model(model: Mapping[str, Any]) -> Replies:
    """Return the replies to all questions with modes that are given as fields of the parameters."""
    cell = partial(replies.cell, SERIES, NEVER, **model)
    return {
        **replies.first_separation(SERIES, NEVER, replies.SEPARATING.replace(**model)),
        **settled_after_separation(replies.SETTLED.replace(**model)),
        **ask_cycle(model, DEFAULT),
        "region": replies.judged(cell, _right_cell, NEVER, CELLS),
    }


@lru_cache(maxsize=1)
def _richest() -> Replies:
    """Return the replies with the `RICHEST` modes."""
    return ask_model(RICHEST)


@lru_cache(maxsize=CELLS)
def _right_cell(index: int) -> bool:
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


# ---- Answers from the cycle itself

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


# ---- Where methods find the first separation

MAP_CASE = Parameters(N=600.0, Omega=27.0)
"""A case that loses contact within the horizon."""
MAP_HORIZON = 25.0
"""Simulated time, s."""
MAP_BUDGET = 3.0
"""Time for a point, s, beyond which finer settings with the same modes are skipped."""
MAP_VALUES = 6
"""Greatest number of settings of a map."""


def answer_map(
    method: str, diameters: Sequence[int] = (1, 2, 4, 8), values: Sequence[float] | None = None
) -> xr.Dataset:
    """Judge a method's first separation along (diameters, value).

    Parameters
    ----------
    method : its name
    diameters : highest numbers of nodal diameters
    values : settings from coarse to fine; some of `failure_maps.map_settings` if None
    """
    judged = METHODS[method].economical()
    if values is None:
        values = _some_of(failure_maps.map_settings(judged))
    series = METHODS["series"]
    right = {
        count: _map_reply(series, failure_maps.REFERENCE_TOL, math.inf, count).value
        for count in diameters
    }
    late: set[int] = set()

    def measure(diameters: int, value: float) -> Iterator[Row]:
        reply = Reply(math.nan, math.nan, AnswerStatus.TOO_SLOW)
        if diameters not in late:
            reply = _map_reply(judged, value, MAP_BUDGET, diameters)
        if reply.status is AnswerStatus.TOO_SLOW:
            late.add(diameters)
        yield {
            "verdict": verdict("first_separation", reply, right[diameters]),
            "error": abs(reply.value - right[diameters]),
            "status": reply.status,
            "found": reply.value,
            "seconds": reply.seconds,
        }

    def facts(diameters: int) -> Iterator[Row]:
        yield {"modes": real_modes(diameters, 0), "right": right[diameters]}

    dataset = study.run(
        "answer_map",
        {"diameters": diameters, "value": values},
        measure,
        flags=FLAGS,
        budget=MAP_BUDGET,
        horizon=MAP_HORIZON,
        parameters=MAP_CASE.canonical_json,
    )
    return failure_maps.with_facts(judged, dataset, facts, "answer_map_facts")


def _map_reply(method: Method, value: float, budget: float, diameters: int) -> Reply:
    """Return the reply of a method on the case of the maps.

    Parameters
    ----------
    method, value : the method, and its setting
    budget : seconds
    diameters : highest number of nodal diameters
    """
    p = MAP_CASE.replace(n_diameters=diameters)
    solve = replies.setting_of(method, value)
    return replies.first_separation(solve, budget, p, MAP_HORIZON)["first_separation"]


def _some_of(settings: Sequence[float]) -> list[float]:
    """Return `MAP_VALUES` settings at most: the first, the last, and some between."""
    count = min(MAP_VALUES, len(settings))
    places = np.linspace(0, len(settings) - 1, count).round().astype(int)
    return [settings[i] for i in places]
