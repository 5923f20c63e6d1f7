"""The benchmark's scenes: four motions with known correct answers, and the errors of a method's
answer."""

import enum
import json
import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from disc_model.benchmarks.methods.integrators import MethodResult, Problem, RunStatus
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.simulation.states import State

JUDGED = ("stick_slip", "separating")  # scenes for short comparisons of methods: a second each
CONVERGED = 1e-6  # greatest event-time error of a converged answer with all events, s
LOST = 2.0  # relative energy norm of an unstable answer's error; sqrt(2) is that of unrelated motions of equal energy
Verdict = enum.IntEnum(
    "Verdict", "CONVERGED INACCURATE WRONG_EVENTS UNSTABLE GAVE_UP NOT_RUN", start=0
)


class Answer(NamedTuple):
    """The correct answer: event times (s, long double, (n,)), kinds (n words), final state, its own
    error (s)."""

    times: np.ndarray
    kinds: tuple[str, ...]
    final: State
    error: float


class Errors(NamedTuple):
    """Errors of a result: largest event-time error (s; nan if events are wrong), energy norm,
    verdict."""

    event_time: float
    state: float
    verdict: Verdict


@lru_cache
def stored(name: str) -> dict[str, Any]:
    """The content of a file of ``data``: answers by other methods, and what belongs to them."""
    return dict(
        json.loads((Path(__file__).parent / "data" / f"{name}.json").read_text(encoding="utf-8"))
    )


def static_start(p: Parameters) -> State:
    """The static start as a state made by hand, of which the engine knows no more than any other
    method."""
    physics = Physics(p)
    zero = np.zeros(physics.n)
    a = -p.N * physics.shape / physics.stiffness
    return State(0.0, "stick", 0, 0.0, 0.0, physics.u_0, 0.0, a, zero, zero, zero)


def separating_start(p: Parameters) -> State:
    """The state at 54.4 s of N = 385 N, Omega = 15.1 rad/s; further modes of ``p`` are at static
    deflection."""
    start, physics = stored("separating_start"), Physics(p)
    y = physics.pack(static_start(p))
    known = slice(
        min(p.n_diameters + 1, len(start["diameters"]))
    )  # modes without nodal circles come first
    for name in ("a", "b", "alpha", "beta"):
        y[getattr(physics, name)][known] = np.array(start[name])[known] * np.sign(
            physics.shape[known]
        )
    y[physics.psi], y[physics.f] = start["psi"], start["f"]
    return physics.unpack(start["time"], start["phase"], start["direction"], y)


def read_state(stored_state: Mapping[str, Any]) -> State:
    values: dict[str, Any] = {
        name: np.array(x) if isinstance(x, list) else x for name, x in stored_state.items()
    }
    return State(**values)


MOTIONS: Mapping[str, tuple[dict[str, Any], Callable[[Parameters], State], float, float]] = {
    "stick_slip": ({}, static_start, 1.0, math.inf),  # 135 switches, no separation
    "separating": ({}, separating_start, 55.4, 2e-5),  # 398 switches, 131 separations among them
    "many_modes": (
        {"n_diameters": 12},
        static_start,
        0.2,
        math.inf,
    ),  # frequencies from 1492 to 33711 rad/s
    # the classical stick-slip cycle; frequencies up to 3.9e7 rad/s that nothing excites
    "rigid": ({"E": 1e20, "n_diameters": 1}, static_start, 0.02, math.inf),
}
"""By scene: parameters beside N = 385 N and Omega = 15.1 rad/s, the start, the end (s), and the longest step (s) of
RK45 and DOP853, with longer ones of which losses of contact are missed at any tolerance."""


@lru_cache(maxsize=8)
def problem(name: str) -> Problem:
    further, start, t_end, max_step = MOTIONS[name]
    p = Parameters(N=385.0, Omega=15.1, **further)
    return Problem(p, start(p), t_end, max_step=max_step)


@lru_cache(maxsize=8)
def answer(name: str) -> Answer:
    """The correct answer of a scene, as stored by ``tests/references/``: in long double, or in
    closed form (rigid)."""
    right = stored("benchmark_reference")[name]
    if right["parameters"] != problem(name).parameters.key:
        raise DiscModelError(f"the stored reference of {name} is of other parameters: make it anew")
    times, final = np.array([np.longdouble(t) for t in right["times"]]), read_state(right["final"])
    return Answer(times, tuple(right["kinds"]), final, right["largest_difference_to_check_run"])


def errors(problem: Problem, answer: Answer, result: MethodResult) -> Errors:
    state = Physics(problem.parameters).distance(result.final, answer.final)
    time = event_time_error(answer, result, problem.t_end)
    if result.outcome is RunStatus.NON_FINITE or not math.isfinite(state):
        return Errors(math.nan, math.nan, Verdict.UNSTABLE)
    if result.outcome is not RunStatus.FINISHED:
        return Errors(math.nan, math.nan, Verdict.GAVE_UP)
    finished = Verdict.CONVERGED if time <= CONVERGED else Verdict.INACCURATE
    verdict = (
        Verdict.UNSTABLE if state > LOST else Verdict.WRONG_EVENTS if math.isnan(time) else finished
    )
    return Errors(time, state, verdict)


def event_time_error(answer: Answer, result: MethodResult, t_end: float) -> float:
    """Largest error of an event time, s; nan if the events are wrong. If only one of the two has an
    event just before the end, it counts as late, not as wrong."""
    common = min(len(answer.kinds), len(result.kinds))
    if common == 0 or answer.kinds[:common] != result.kinds[:common]:
        return math.nan
    largest = np.max(np.abs(result.times[:common].astype(np.longdouble) - answer.times[:common]))
    late = [t_end - float(t) for t in (*answer.times[common:], *result.times[common:])]
    if late and max(late) > 2.0 * float(largest):
        return math.nan
    return float(max([largest, *late]))
