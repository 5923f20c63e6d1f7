"""The switches between phases, for methods that integrate one phase at a time and stop at its end.

A method supplies ``advance``; `run_phases` does the rest: what follows a switch, and what is recorded.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import GaveUp, Meter, MethodResult, Outcome, Problem
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.data.variables import EVENT_KINDS, PHASES

CROWD = 50
"""More events than this at one instant: the method is stuck."""
INSTANT = 1e-12
"""s; two events closer than this count as at one instant."""
GUARD = 2e-5
"""s after a separation begins in which no reattachment is looked for: the gap begins with a triple root there, at which
general event detection reports a false return or none.  Tuned by hand, as any user of such a method has to."""
ENDS = {"stick": 3, "slip": 2, "separation": 1}
"""How many functions of the state end a phase where they fall through zero.  The first is the contact force (1 where it
is bonded) or the gap; the others are f in slip, and what is left of friction forwards and backwards in stick.  Ties are
decided in that order."""


class Phase(NamedTuple):
    """A phase, and the sign of f in it (0 but in slip)."""

    name: str
    direction: int

    @property
    def code(self) -> int:
        """Its number in `kernels`."""
        return PHASES.index(self.name)


class Ended(NamedTuple):
    """Where ``advance`` stopped: place of the function that did it (None at t_end), local time (s) and state."""

    cause: int | None
    t: float
    y: Array


class Advance(Protocol):
    """Integrates a phase from local time ``t`` (s, 0 at the start) to its end, or to ``t_end`` if not ``watched``."""

    def __call__(self, phase: Phase, t: float, y: Array, t_end: float, *, watched: bool) -> Ended: ...


def run_phases(
    problem: Problem, physics: Physics, advance: Advance, meter: Meter, guard: float = GUARD
) -> MethodResult:
    """Integrate phase after phase to the end of ``problem``; for ``guard`` s a separation is not watched."""
    modes, c = kernels.tables(physics)
    phase = Phase(problem.start.phase, problem.start.direction)
    t, y, span = 0.0, physics.pack(problem.start), problem.span
    new = np.zeros(2, np.int64)
    for compiled in (kernels.rate, kernels.switch_values):
        compiled(modes, c, 1, 1, y, np.empty_like(y))
    kernels.switch(modes, c, kernels.SEPARATION, 0, y.copy(), new)
    times: list[float] = []
    kinds: list[str] = []
    crowd = 0
    with meter.running():
        while True:
            meter.check()
            cause = None
            if phase.name == "separation" and guard > 0.0:
                until = min(t + guard, span)
                t, y = until, advance(phase, t, y, until, watched=False).y
            if t < span:
                cause, t, y = advance(phase, t, y, span, watched=True)
            if not math.isfinite(float(np.sum(y))):
                raise GaveUp("the state is no longer finite", Outcome.NON_FINITE)
            if cause is None:
                break
            y = y.copy()
            number, direction, added = kernels.switch(modes, c, phase.code, cause, y, new)
            phase = Phase(PHASES[number], direction)
            crowd = crowd + 1 if times and t - times[-1] < INSTANT else 0
            times += [t] * added
            kinds += [EVENT_KINDS[kind] for kind in new[:added]]
            if problem.stop and phase.name == "separation":
                break
            if crowd > CROWD:
                raise GaveUp(f"more than {CROWD} events at one instant", Outcome.STALLED)
    return meter.result(times, kinds, physics.unpack(problem.start.time + t, *phase, y))
