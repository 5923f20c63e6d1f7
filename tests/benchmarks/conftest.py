"""Methods whose errors and costs are laid down, and what a benchmark makes of them."""

import math

import numpy as np
import pytest
import xarray as xr

from disc_model.benchmarks import answers, figures, scenes, work_precision
from disc_model.benchmarks.answers import AnswerStatus, Reply
from disc_model.benchmarks.methods import METHODS, SCENES, Method
from disc_model.benchmarks.methods.integrators import MethodResult, RunStatus
from disc_model.benchmarks.scenes import answer

SET_UP = 1e-4
"""s that every run of a `Known` method takes, however long the motion."""


class Known:
    """A method whose error is ``error`` (value) seconds at every event, and which takes ``cost``
    (value) seconds.

    Of these ``glue`` is the share of Python.
    """

    def __init__(self, like: str, error, cost, outcome=RunStatus.FINISHED, glue=math.nan) -> None:
        own = METHODS[like]
        self.name, self.label, self.setting = own.name, own.label, own.setting
        self.error, self.cost, self.outcome, self.glue = error, cost, outcome, glue
        self.tried: list[float] = []

    def absent(self) -> list[str]:
        return []

    def solve(self, problem, value, budget):
        self.tried.append(value)
        name = next(name for name in SCENES if scenes.problem(name).start is problem.start)
        times_longer = problem.span / scenes.problem(name).span
        right, off = answer(name), self.error(value)
        kinds = right.kinds if off < 1e-2 else ("slip_reversal",) * len(right.kinds)
        times = (right.times[: len(kinds)] + off).astype(float)
        final = right.final.replace(psi=right.final.psi * (1 + off), f=right.final.f * (1 + off))
        work = round(1 / value) if self.setting == "step" else 1000
        seconds = SET_UP + times_longer * (self.cost(value) - SET_UP)
        return MethodResult(
            times, kinds, final, seconds, work, self.outcome, glue=self.glue * seconds
        )


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> dict[str, Known]:
    methods = {
        "series": Known("series", lambda tol: 0.5 * tol, lambda tol: 1e-3 - 1e-5 * math.log10(tol)),
        "RK4": Known("RK4", lambda h: 1e8 * h**4, lambda h: 1e-5 / h, glue=0.25),
        "Radau": Known("Radau", lambda tol: 1.0, lambda tol: 0.2),
        "regularised": Known("regularised", lambda e: 1e-4, lambda e: 100.0, RunStatus.TOO_SLOW),
    }
    for name, method in methods.items():
        monkeypatch.setitem(METHODS, name, method)
    return methods


SETTINGS = {
    "stick_slip": {
        "series": (1e-6, 1e-8, 1e-10),
        "RK4": (4e-4, 2e-4, 1e-4, 2e-5),
        "Radau": (1e-3,),
    },
    "separating": {"series": (1e-6, 1e-8), "RK4": (2e-4,), "regularised": (1.0, 0.1)},
}


@pytest.fixture
def dataset(known: dict[str, Known]) -> xr.Dataset:
    return work_precision.work_precision(SETTINGS, rounds=2)


class Late(Method):
    """Finds the first separation late by its tolerance, and none at a coarse one; the finest takes
    too long."""

    def solve(self, problem, value, budget=math.inf):
        times = [54.4 + value, 54.9] if 1e-5 < value < 0.5 else []
        outcome = RunStatus.FINISHED if value > 1e-5 else RunStatus.TOO_SLOW
        seconds = 2.0 if value > 1e-3 else 3.0
        return MethodResult(
            np.array(times), ("separation",) * len(times), problem.start, seconds, 1, outcome
        )


@pytest.fixture
def late(monkeypatch: pytest.MonkeyPatch) -> Method:
    method = Late(name="late", label="late", function="", settings={})
    monkeypatch.setitem(METHODS, "late", method)
    monkeypatch.setitem(figures.LINES, "late", figures.LINES["RK4"])
    return method


@pytest.fixture
def priced(late: Method, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """Costs of answers: of `Late`, of the cycle itself and of models with other modes, which are
    all laid down."""

    def ask(model):
        count = model["n_diameters"]
        status = AnswerStatus.FOUND if count else AnswerStatus.NONE
        return {
            "first_separation": Reply(51.0 + (8 - count) / 80 if count else math.nan, 0.1, status)
        }

    def ask_cycle(model, tol):
        onset, none = Reply(15.09 + tol, 1e-4 / tol**0.1, AnswerStatus.FOUND), AnswerStatus.NONE
        return {"onset": onset, "growth_rate": Reply(math.nan, 1e-4 / tol**0.1, none, "no cycle")}

    monkeypatch.setattr(answers, "ask_model", ask)
    monkeypatch.setattr(answers, "ask_cycle", ask_cycle)
    monkeypatch.setattr(answers, "_richest", lambda: ask({"n_diameters": 8}))
    monkeypatch.setattr(answers, "CONTACTS", {"rigid": {}})
    parts = [
        answers.answers(late.name, (1.0, 0.3, 1e-2, 1e-4, 1e-6, 1e-7), asked=("first_separation",))
    ]
    parts += [answers.answers("cycle"), answers.answers("models", models=(0, 4, 8))]
    return xr.concat(parts, "row", combine_attrs="override")
