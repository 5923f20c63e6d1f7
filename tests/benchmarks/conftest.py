"""Methods whose errors and costs are laid down, and what a benchmark makes of them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest
import xarray as xr

from benchmarks import answers, own_answers, scenes, work_precision
from benchmarks.figures.looks import LINES
from benchmarks.methods import METHODS, SCENES, Method
from benchmarks.methods.integrators import MethodResult, Problem, RunStatus
from benchmarks.questions import AnswerStatus, Replies, Reply
from benchmarks.scenes import answer

SET_UP = 1e-4
"""s that every run of a `Known` method takes, however long the motion."""


@dataclass
class Known:
    """A method whose error and cost are known.

    Attributes
    ----------
    like : name of the method that it stands for
    error : error of every event, s, by the setting
    cost : time of a scene, s, by the setting
    outcome : how its runs end
    glue : share of Python in its time
    tried : settings that were run
    """

    like: str
    error: Callable[[float], float]
    cost: Callable[[float], float]
    outcome: RunStatus = RunStatus.FINISHED
    glue: float = math.nan
    tried: list[float] = field(default_factory=list)

    @property
    def name(self) -> str:
        return self.like

    @property
    def label(self) -> str:
        return DECLARED[self.like].label

    @property
    def setting(self) -> str:
        return DECLARED[self.like].setting

    def absent(self) -> list[str]:
        return []

    def solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        self.tried.append(value)
        scene = next(name for name in SCENES if scenes.problem(name).start is problem.start)
        right = answer(scene)
        off = self.error(value)
        kinds = right.kinds
        if off >= 1e-2:
            kinds = ("slip_reversal",) * len(right.kinds)
        times_longer = problem.span / scenes.problem(scene).span
        seconds = SET_UP + times_longer * (self.cost(value) - SET_UP)
        return MethodResult(
            times=(right.times + off).astype(float),
            kinds=kinds,
            final=right.final.replace(psi=right.final.psi * (1 + off), f=right.final.f * (1 + off)),
            seconds=seconds,
            work=round(1 / value) if self.setting == "step" else 1000,
            outcome=self.outcome,
            glue=self.glue * seconds,
        )


DECLARED = dict(METHODS)
"""The methods themselves, in whose place tests put known ones."""


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> dict[str, Known]:
    methods = [
        Known("series", lambda tol: 0.5 * tol, lambda tol: 1e-3 - 1e-5 * math.log10(tol)),
        Known("RK4", lambda h: 1e8 * h**4, lambda h: 1e-5 / h, glue=0.25),
        Known("Radau", lambda tol: 1.0, lambda tol: 0.2),
        Known("regularised", lambda e: 1e-4, lambda e: 100.0, RunStatus.TOO_SLOW),
    ]
    for method in methods:
        monkeypatch.setitem(METHODS, method.name, method)
    return {method.name: method for method in methods}


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
    """Finds the first separation late by its tolerance, and none at a coarse one.

    The finest takes too long.
    """

    def solve(self, problem: Problem, value: float, budget: float = math.inf) -> MethodResult:
        times = []
        if 1e-5 < value < 0.5:
            times = [54.4 + value, 54.9]
        return MethodResult(
            times=np.array(times),
            kinds=("separation",) * len(times),
            final=problem.start,
            seconds=2.0 if value > 1e-3 else 3.0,
            work=1,
            outcome=RunStatus.FINISHED if value > 1e-5 else RunStatus.TOO_SLOW,
        )


@pytest.fixture
def late(monkeypatch: pytest.MonkeyPatch) -> Method:
    method = Late(name="late", label="late", function="", settings={})
    monkeypatch.setitem(METHODS, "late", method)
    monkeypatch.setitem(LINES, "late", LINES["RK4"])
    return method


def ask_model(model: dict[str, int]) -> Replies:
    """Reply with a first separation that comes later with more modes, and never without pairs."""
    count = model["n_diameters"]
    reply = Reply(math.nan, 0.1, AnswerStatus.NONE)
    if count:
        reply = Reply(51.0 + (8 - count) / 80, 0.1, AnswerStatus.FOUND)
    return {"first_separation": reply}


def ask_cycle(model: dict[str, int], tol: float) -> Replies:
    """Reply with an onset that is off by the tolerance, and without a growth rate."""
    seconds = 1e-4 / tol**0.1
    return {
        "onset": Reply(15.09 + tol, seconds, AnswerStatus.FOUND),
        "growth_rate": Reply(math.nan, seconds, AnswerStatus.NONE, "no cycle"),
    }


@pytest.fixture
def priced(late: Method, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """Costs of answers of `Late`, of the cycle itself and of models, which are all laid down."""
    monkeypatch.setattr(own_answers, "ask_model", ask_model)
    monkeypatch.setattr(own_answers, "ask_cycle", ask_cycle)
    monkeypatch.setattr(own_answers, "richest", lambda: ask_model({"n_diameters": 8}))
    monkeypatch.setattr(answers, "CONTACTS", {"rigid": {}})
    settings = (1.0, 0.3, 1e-2, 1e-4, 1e-6, 1e-7)
    parts = [
        answers.answers(late.name, settings, asked=("first_separation",)),
        answers.answers("cycle"),
        answers.answers("models", models=(0, 4, 8)),
    ]
    return xr.concat(parts, "row", combine_attrs="override")
