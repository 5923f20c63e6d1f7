"""What each answer costs: error against processor time of quantities that a study computes.

Kinds of lines:

- of a method: its tolerance or step varies, with the nine modes of the published model; its error is that of the
  numbers, against the stored right answer;
- ``cycle``: onset and growth rate without a simulation, from the stick-slip cycle itself, at several tolerances;
- ``rigid`` and ``residual``: the number of nodal diameters varies, the engine at its default tolerance; the error is
  that of the model, its distance from the `RICHEST`, and no tolerance makes up for it. Rigid contact converges to it
  slowly; a few modes suffice with residual flexibility.
"""

import math
import time as clock
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache, partial, wraps
from typing import Any

import pandas as pd
import xarray as xr

from disc_model.benchmarks import questions
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.questions import AnswerStatus, AnswerVerdict, Replies, Reply, reply_of, verdict
from disc_model.benchmarks.study import Row, run
from disc_model.benchmarks.truncation import CONTACTS
from disc_model.benchmarks.work_precision import DEFAULT
from disc_model.data.dataset import json_attribute
from disc_model.data.variables import CycleStatus, flag_names
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import floquet

TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)
"""Tolerances of the search for a cycle."""
LINES: Mapping[str, tuple[str, str]] = {
    "cycle": ("series, from the cycle itself", "tol"),
    "rigid": ("series, modes, rigid contact", "diameters"),
    "residual": ("series, modes, residual flexibility", "diameters"),
}
"""Lines that belong to no method: name in words, and meaning of the setting."""
RICHEST: dict[str, Any] = {"n_diameters": 12, "contact_compliance": "residual"}
CELLS = 64
"""Number of cells of the region on which models are compared."""
SETTLES_WITHIN, SETTLES_FOR = 400.0, 100.0
"""Time within which contact is lost, and time from then until the motion is examined, s."""
NEVER = 1e6
"""A budget in s that is never used up: models take their time."""
Model = Mapping[str, Any]
solve = questions.setting_of(METHODS["series"], DEFAULT)


def answers(
    part: str,
    settings: Sequence[float] | None = None,
    *,
    asked: Sequence[str] = tuple(questions.ASKED),
    models: Sequence[int] = (0, 1, 2, 3, 4, 6, 8),
) -> xr.Dataset:
    """Measure the points of a method, of the cycle itself, or of models.

    Parameters
    ----------
    part : name of a method, ``cycle`` or ``models``
    settings : of a method, from coarse to fine; those of the scene ``stick_slip`` if not given
    asked : questions put to a method
    models : numbers of nodal diameters, for each contact

    Returns
    -------
    Dataset along ``row``. A question for which a method is too slow is skipped at its finer settings.
    """
    hopeless: set[str] = set()

    def of_method(line: str, setting: float, question: str) -> Iterator[Row]:
        if question in hopeless:
            return
        for answer, reply in questions.ask(questions.setting_of(METHODS[line], setting), question).items():
            yield _row(answer, line, questions.reference(answer).value, reply)
            if reply.status is AnswerStatus.TOO_SLOW:
                hopeless.add(question)

    def of_cycle(line: str, setting: float) -> Iterator[Row]:
        yield _row("onset", line, questions.reference("fold").value, onset(questions.SEPARATING, setting))
        rate = growth_rate(questions.GROWING, setting)
        yield _row("growth_rate", line, questions.reference("growth_rate").value, rate)

    def of_model(line: str, setting: int) -> Iterator[Row]:
        for answer, reply in ask({"n_diameters": setting} | CONTACTS[line]):
            yield _row(answer, line, _richest()[answer].value, reply)

    points: Sequence[Row]
    measure: Callable[..., Iterator[Row]]
    if part == "cycle":
        points, measure = [{"line": part, "setting": tol} for tol in TOLERANCES], of_cycle
    elif part == "models":
        points, measure = [{"line": line, "setting": count} for line in CONTACTS for count in models], of_model
    else:
        values, measure = settings or METHODS[part].settings["stick_slip"], of_method
        points = [{"line": part, "setting": value, "question": name} for value in values for name in asked]
    about = {}
    for name, question in questions.QUESTIONS.items():
        right = questions.reference(name)
        about[name] = question._asdict() | {"error": f"{right.error:.2g}, {right.by}"}
    flags = {"status": AnswerStatus, "verdict": AnswerVerdict}
    title = "What each answer costs"
    return run("answers", points, measure, flags=flags, title=title, questions=json_attribute(about))


def merged(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """All parts as one dataset, with the attributes of the first."""
    return xr.concat(parts, "row", combine_attrs="override")


def in_words(dataset: xr.Dataset) -> pd.DataFrame:
    """All rows, in the order in which they were measured; status, verdict and setting (``at``) in words."""
    frame = dataset.to_dataframe()
    counted = frame["varies"] == "diameters"
    settings = [f"{x:.0f} diameters" if count else f"{kind}={x:g}"
          for count, kind, x in zip(counted, frame["varies"], frame["setting"], strict=True)]  # fmt: skip
    return frame.assign(at=settings, **{name: flag_names(dataset[name]) for name in ("status", "verdict")})


def _row(answer: str, line: str, right: float, reply: Reply) -> Row:
    label, varies = LINES[line] if line in LINES else (METHODS[line].label, METHODS[line].setting)
    row = {"answer": answer, "label": label, "varies": varies, "right": right, "found": reply.value}
    error = abs(reply.value - right)
    return row | {"error": error, "verdict": verdict(answer, reply, right)} | reply._asdict()


# ----------------------------------------------------------------------------------------------------
# Answers of this package with other modes at its default tolerance, and from the cycle itself


def ask(model: Model) -> Iterator[tuple[str, Reply]]:
    """The answers to all questions with these modes, given as fields of the parameters."""
    yield from questions.first_separation(solve, NEVER, questions.SEPARATING.replace(**model)).items()
    yield from after_separation(questions.SETTLED.replace(**model)).items()
    yield "onset", onset(questions.SEPARATING.replace(**model), DEFAULT)
    yield "growth_rate", growth_rate(questions.GROWING.replace(**model), DEFAULT)
    yield "region", questions.judged(partial(_cell, model), _right_cell, NEVER, CELLS)


@lru_cache(maxsize=1)
def _richest() -> Replies:
    return dict(ask(RICHEST))


def after_separation(p: Parameters) -> Replies:
    """Answers as of `questions.after_separation`, from the state that this model's motion reaches."""
    first = simulate(p, SETTLES_WITHIN, events=False, tol=DEFAULT, stop_at="first_separation")
    if not math.isfinite(first.first_separation):
        nothing = reply_of(math.nan, math.nan, f"no separation within {SETTLES_WITHIN:g} s")
        return dict.fromkeys(questions.AFTER_SEPARATION, nothing)
    state = first.final_state
    late = simulate(p, state.time + SETTLES_FOR, events=False, tol=DEFAULT, initial_state=state)
    return questions.after_separation(solve, NEVER, p, late.final_state)


def _timed(function: Callable[[Parameters, float], Reply]) -> Callable[[Parameters, float], Reply]:
    """A question with the least processor time (s) of several runs; the first run may have compiled."""

    @wraps(function)
    def timed(p: Parameters, tol: float) -> Reply:
        seconds, reply = math.inf, function(p, tol)
        for _ in range(questions.REPEATS):
            began = clock.thread_time()
            reply = function(p, tol)
            seconds = min(seconds, clock.thread_time() - began)
            if seconds > questions.QUICK:
                break
        return reply._replace(seconds=seconds)

    return timed


@_timed
def onset(p: Parameters, tol: float) -> Reply:
    """Speed (rad/s) of the first fold of the quiet cycle above 14.5 rad/s."""
    low, high = 14.5, 16.0
    try:
        folds = continue_cycle(p.replace(Omega=14.8), "Omega", (low, high), tol=tol).folds
    except ParameterError as error:
        return reply_of(math.nan, 0.0, f"no cycle to follow: {error}")
    return reply_of(folds[0, 0] if len(folds) else math.nan, 0.0, f"no fold from {low:g} to {high:g} rad/s")


@_timed
def growth_rate(p: Parameters, tol: float) -> Reply:
    """Growth rate (1/s) of the stick-slip cycle, from its multipliers."""
    cycle = floquet(p, tol=tol)
    return reply_of(cycle.growth_rate if cycle.status is CycleStatus.OK else math.nan, 0.0, cycle.message)


def _cell(model: Model, index: int) -> tuple[bool, float]:
    return questions.cell(solve, questions.cell_parameters(index).replace(**model), NEVER)


@lru_cache(maxsize=CELLS)
def _right_cell(index: int) -> bool:
    """Separation in a cell under the richest model."""
    return _cell(RICHEST, index)[0]
