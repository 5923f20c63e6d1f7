"""Methods that integrate one phase at a time and stop at its end."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from benchmarks.methods import kernels
from benchmarks.methods.integrators import GaveUp, Meter, MethodResult, RunStatus
from benchmarks.methods.kernels import Array
from disc_model.data.variables import EVENT_KINDS, PHASES

CROWD = 50
"""Greatest number of events at one instant; with more the method is stuck."""
INSTANT = 1e-12
"""Time between events that counts as none, s."""
CHECKED_EVENTS = 15
"""Events between two looks at the clock, as a mask of bits: a look takes as long as some phases."""

ENDS = (3, 2, 1)
"""Number of functions of the state that end a phase, by its number in `kernels`.

A phase ends where one of them falls through zero; of ties the first counts. They are the contact
force (1 in bilateral contact) or the gap, and then f in slip, or the margins of friction forwards and
backwards in stick.
"""
Ended = tuple[int | None, float, Array]
"""Index of the function that ended a phase, None at t_end; local time, s; a state to be changed."""
Advance = Callable[[int, int, float, Array, float], Ended]
"""Integrates a phase ``(phase, direction, t, y, t_end)``.

The phase is given by its number in `kernels` and the sign of f in it, 0 except in slip. It begins at
the local time ``t``, s, which is 0 at the start; ``y`` is not changed.
"""


def run_phases(advance: Advance, meter: Meter) -> MethodResult:
    """Integrate a problem phase by phase.

    Parameters
    ----------
    advance : integrates one phase
    meter : of the run
    """
    problem = meter.problem
    physics = meter.physics
    phase = PHASES.index(problem.start.phase)
    direction = problem.start.direction
    t = 0.0
    y = physics.pack(problem.start)
    _compile(physics, y)

    new = np.zeros(2, np.int64)
    times: list[float] = []
    kinds: list[str] = []
    crowd = 0
    with meter.running():
        while True:
            if len(times) & CHECKED_EVENTS == 0:
                meter.check()
            cause, t, y = advance(phase, direction, t, y, problem.span)
            if cause is None:
                break
            phase, direction, added = kernels.switch(physics.modes, physics.c, phase, cause, y, new)
            if added < 0:
                raise GaveUp(RunStatus.NON_FINITE)

            at_once = len(times) > 0 and t - times[-1] < INSTANT
            crowd = crowd + 1 if at_once else 0
            for kind in new[:added]:
                times.append(t)
                kinds.append(EVENT_KINDS[kind])
            if problem.stop and phase == kernels.SEPARATION:
                break
            if crowd > CROWD:
                raise GaveUp(RunStatus.STALLED)
        if not math.isfinite(y.sum()):
            raise GaveUp(RunStatus.NON_FINITE)
    end = problem.start.time + t
    return meter.result(times, kinds, physics.unpack(end, PHASES[phase], direction, y))


def _compile(physics: kernels.Physics, y: Array) -> None:
    """Call the kernels once, at a state, so that they are compiled before the clock runs."""
    modes = physics.modes
    c = physics.c
    size = len(y)
    kernels.rate(modes, c, 1, 1, y, np.empty_like(y))
    kernels.switch_values(modes, c, 1, 1, y, np.empty_like(y))
    kernels.jacobian(modes, c, 1, 1, y, np.empty((size, size)))
    kernels.switch(modes, c, kernels.SEPARATION, 0, y.copy(), np.zeros(2, np.int64))
