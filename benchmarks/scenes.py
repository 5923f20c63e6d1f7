"""The benchmark's scenes: four motions with known correct answers, and errors of a method's answer."""

import enum
import json
import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.methods.integrators import MethodResult, Problem, RunStatus
from benchmarks.methods.kernels import Physics
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.simulation.states import State, static_start

JUDGED = ("stick_slip", "separating")
"""Scenes for short comparisons of methods, of a second each."""
CONVERGED = 1e-6
"""Greatest event-time error of a converged answer with all events, s."""
LOST = 2.0
"""Relative energy norm of the error of an unstable answer.

That of unrelated motions of equal energy is sqrt(2).
"""
Verdict = enum.Enum("Verdict", "CONVERGED INACCURATE WRONG_EVENTS UNSTABLE GAVE_UP")


class Answer(NamedTuple):
    """The correct answer of a scene."""

    times: np.ndarray
    """Event times, s, long double, (n,)."""
    kinds: tuple[str, ...]
    """Kinds of the events, n words."""
    final: State


class Errors(NamedTuple):
    """Errors of a result."""

    event_time: float
    """Largest error of an event time, s; nan if events are wrong."""
    state: float
    """Relative energy norm of the error of the final state."""
    verdict: Verdict


# ---- Starts


@lru_cache
def stored(name: str) -> dict[str, Any]:
    """Return the content of a file of ``data``: answers by other methods, and what belongs to them."""
    path = Path(__file__).parent / "data" / f"{name}.json"
    return dict(json.loads(path.read_text(encoding="utf-8")))


def stated(p: Parameters) -> dict[str, Any]:
    """Return the values of a case that differ from the defaults, as JSON has them."""
    return dict(p.model_dump(mode="json", exclude_defaults=True))


def separating_start(p: Parameters) -> State:
    """Return the state at 54.4 s of N = 385 N, Omega = 15.1 rad/s.

    Modes of ``p`` that the stored state has not are at static deflection.
    """
    start = stored("separating_start")
    physics = Physics(p)
    y = physics.pack(static_start(p))
    # modes without nodal circles come first
    known = slice(min(p.n_diameters + 1, len(start["diameters"])))
    signs = np.sign(physics.shape[known])
    for name in ("a", "b", "alpha", "beta"):
        place = getattr(physics, name)
        y[place][known] = np.array(start[name])[known] * signs
    y[physics.psi] = start["psi"]
    y[physics.f] = start["f"]
    return physics.unpack(start["time"], start["phase"], start["direction"], y)


def read_state(stored_state: Mapping[str, Any]) -> State:
    """Return a state that is stored as JSON."""
    values: dict[str, Any] = dict(stored_state)
    for name in ("a", "b", "alpha", "beta"):
        values[name] = np.array(values[name])
    return State(**values)


# ---- Scenes


class Motion(NamedTuple):
    """A scene's motion at N = 385 N and Omega = 15.1 rad/s."""

    further: dict[str, Any]
    """Its other parameters."""
    start: Callable[[Parameters], State]
    t_end: float
    """End, s."""
    max_step: float
    """Longest step of RK45 and DOP853, s; longer ones miss losses of contact at any tolerance."""


MOTIONS: Mapping[str, Motion] = {
    # 135 switches, no separation
    "stick_slip": Motion({}, static_start, 1.0, math.inf),
    # 398 switches, 131 separations among them
    "separating": Motion({}, separating_start, 55.4, 2e-5),
    # frequencies from 1492 to 33711 rad/s
    "many_modes": Motion({"n_diameters": 12}, static_start, 0.2, math.inf),
    # the classical stick-slip cycle; frequencies up to 3.9e7 rad/s that nothing excites
    "rigid": Motion({"E": 1e20, "n_diameters": 1}, static_start, 0.02, math.inf),
}
"""The motions of the scenes, by name."""


@lru_cache(maxsize=8)
def problem(name: str) -> Problem:
    """Return the problem of a scene."""
    motion = MOTIONS[name]
    p = Parameters(N=385.0, Omega=15.1, **motion.further)
    return Problem(p, motion.start(p), motion.t_end, max_step=motion.max_step)


@lru_cache(maxsize=8)
def answer(name: str) -> Answer:
    """Return the correct answer of a scene, as ``tests/references/`` has stored it.

    It was computed in long double, or in closed form (rigid).

    Raises
    ------
    disc_model.errors.DiscModelError
        If it is of other parameters.
    """
    right = stored("benchmark_reference")[name]
    if right["parameters"] != stated(problem(name).parameters):
        raise DiscModelError(f"the stored reference of {name} is of other parameters: make it anew")
    return Answer(
        times=np.array([np.longdouble(t) for t in right["times"]]),
        kinds=tuple(right["kinds"]),
        final=read_state(right["final"]),
    )


# ---- Errors


def errors(problem: Problem, answer: Answer, result: MethodResult) -> Errors:
    """Return the errors of a result, and the verdict on it.

    Parameters
    ----------
    problem, answer : what was asked, and the correct answer
    result : of a method
    """
    state = Physics(problem.parameters).distance(result.final, answer.final)
    if result.outcome is RunStatus.NON_FINITE or not math.isfinite(state):
        return Errors(math.nan, math.nan, Verdict.UNSTABLE)
    if result.outcome is not RunStatus.FINISHED:
        return Errors(math.nan, math.nan, Verdict.GAVE_UP)
    time = event_time_error(answer, result, problem.t_end)
    if state > LOST:
        verdict = Verdict.UNSTABLE
    elif math.isnan(time):
        verdict = Verdict.WRONG_EVENTS
    elif time <= CONVERGED:
        verdict = Verdict.CONVERGED
    else:
        verdict = Verdict.INACCURATE
    return Errors(time, state, verdict)


def event_time_error(answer: Answer, result: MethodResult, t_end: float) -> float:
    """Return the largest error of an event time, s; nan if the events are wrong.

    If only one of the two has an event just before the end, it counts as late, not as wrong.

    Parameters
    ----------
    answer, result : the correct answer, and that of a method
    t_end : end of the motion, s
    """
    common = min(len(answer.kinds), len(result.kinds))
    if common == 0 or answer.kinds[:common] != result.kinds[:common]:
        return math.nan
    times = result.times[:common].astype(np.longdouble)
    largest = float(np.max(np.abs(times - answer.times[:common])))
    single = (*answer.times[common:], *result.times[common:])
    late = [t_end - float(t) for t in single]
    if late and max(late) > 2.0 * largest:
        return math.nan
    return max([largest, *late])
