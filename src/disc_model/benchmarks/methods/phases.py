"""The switches between phases, for methods that integrate one phase at a time and stop at its end.

A method supplies ``advance``; `run_phases` does the rest: what follows a switch, and what is recorded.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import BudgetExceeded, Meter, MethodResult, Outcome, Problem
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.data.variables import EVENT_KINDS, PHASES

CROWD = 50
"""More events than this at one instant: the method is stuck."""
INSTANT = 1e-12
"""s; two events closer than this count as at one instant."""
GUARD = 2e-5
"""s after a separation begins in which no reattachment is looked for: the gap begins with a triple root there, at which
general event detection reports a false return or none.  Tuned by hand, as any user of such a method has to."""


class Phase(NamedTuple):
    """A phase, and the sign of f in it (0 but in slip)."""

    name: str
    direction: int


class Switch(NamedTuple):
    """A function of the state that ends a phase when it falls through zero."""

    kind: str
    value: Callable[[Array], float]


class Ended(NamedTuple):
    """Where ``advance`` stopped: index of the switch (None at t_end), local time (s) and state."""

    cause: int | None
    t: float
    y: Array


Advance = Callable[[Phase, float, Array, float], Ended]


class IntegrationFailed(Exception):
    """The integrator gave up."""


def switch_kinds(phase: Phase, bonded: bool) -> tuple[str, ...]:
    """What ends a phase, in the order in which ties are decided."""
    if phase.name == "separation":
        return ("reattachment",)
    own = ("rest",) if phase.name == "slip" else ("forward", "backward")
    return own if bonded else ("separation", *own)


def switches(physics: Physics, phase: Phase) -> tuple[Switch, ...]:
    """`switch_kinds` with their functions, in numpy."""
    p, direction = physics.p, phase.direction
    functions: dict[str, Callable[[Array], float]] = {
        "reattachment": physics.gap,
        "separation": lambda y: physics.force(y, direction),
        "rest": lambda y: float(direction * y[physics.f]),
        "forward": lambda y: p.mu_s * physics.force(y, 0) - p.r_0 * physics.pull(y),
        "backward": lambda y: p.mu_s * physics.force(y, 0) + p.r_0 * physics.pull(y),
    }
    return tuple(Switch(kind, functions[kind]) for kind in switch_kinds(phase, p.contact == "bonded"))


class _Stop(Exception):
    """The motion cannot go on."""

    def __init__(self, outcome: Outcome, message: str) -> None:
        super().__init__(message)
        self.outcome = outcome


def run_phases(problem: Problem, physics: Physics, advance: Advance, meter: Meter) -> MethodResult:
    """Integrate phase after phase to the end of ``problem``.

    ``advance(phase, t, y, t_end)`` integrates from local time ``t`` (s, 0 at the start) to the first falling zero of
    ``switches(physics, phase)``, or to ``t_end``.
    """
    modes, c = kernels.tables(physics)
    phase, bonded = Phase(problem.start.phase, problem.start.direction), physics.p.contact == "bonded"
    t, y, span = 0.0, physics.pack(problem.start), problem.span
    new = np.zeros(2, np.int64)
    kernels.switch(modes, c, kernels.SEPARATION, 1, y.copy(), new)  # compiles
    times: list[float] = []
    kinds: list[int] = []
    crowd = 0
    outcome, message = Outcome.FINISHED, ""
    meter.start()
    try:
        while True:
            meter.check()
            cause, t, y = advance(phase, t, y, span)
            if not math.isfinite(float(np.sum(y))):
                raise _Stop(Outcome.NON_FINITE, "the state is no longer finite")
            if cause is None:
                break
            kind, y = switch_kinds(phase, bonded)[cause], y.copy()
            code = 1 if kind in ("separation", "reattachment") else 2
            number, direction, added = kernels.switch(modes, c, PHASES.index(phase.name), code, y, new)
            phase = Phase(PHASES[number], direction)
            crowd = crowd + 1 if times and t - times[-1] < INSTANT else 0
            for i in range(added):
                times.append(t)
                kinds.append(int(new[i]))
            if problem.stop and phase.name == "separation":
                break
            if crowd > CROWD:
                raise _Stop(Outcome.STALLED, f"more than {CROWD} events at one instant")
    except _Stop as stop:
        outcome, message = stop.outcome, str(stop)
    except BudgetExceeded:
        outcome, message = Outcome.TOO_SLOW, f"not finished after {meter.budget:g} s"
    except IntegrationFailed as failure:
        outcome, message = Outcome.FAILED, str(failure)
    seconds, origin = meter.seconds, problem.start.time
    final = physics.unpack(origin + t, phase.name, phase.direction, y)
    words = tuple(EVENT_KINDS[kind] for kind in kinds)
    return meter.result(seconds, origin + np.array(times), words, final, outcome, message)
