"""The events between phases, for methods that integrate one phase at a time and stop at its end.

A method supplies ``advance``; `run_phases` carries out the events and records them.
"""

import math
from collections.abc import Callable

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import GaveUp, Meter, MethodResult, RunStatus
from disc_model.benchmarks.methods.physics import Array
from disc_model.data.variables import EVENT_KINDS, PHASES

CROWD = 50
"""Greatest number of events at one instant; with more the method is stuck."""
NOT_FINITE = "the state is no longer finite"
ENDS = (3, 2, 1)
"""By the number of a phase in `kernels`: functions of the state that end it where they fall through zero. The first is
the contact force (1 if bonded) or the gap. The others are f in slip, and the margins of friction forwards and backwards
in stick. Ties are decided in that order.
"""
Ended = tuple[int | None, float, Array]
"""End of ``advance``: index of the function that stopped it (None at t_end), local time (s), and the state, which the
caller may change.
"""
Advance = Callable[[int, int, float, Array, float], Ended]
"""Integrates a phase ``(phase, direction, t, y, t_end)``, given by its number in `kernels` and the sign of f in it (0
except in slip), from local time ``t`` (s, 0 at the start) to its end, or to ``t_end``; ``y`` is not changed.
"""


def run_phases(advance: Advance, meter: Meter) -> MethodResult:
    """Integrate phase by phase to the end of the problem."""
    problem, physics, modes, c = meter.problem, meter.physics, meter.modes, meter.c
    phase, direction = PHASES.index(problem.start.phase), problem.start.direction
    t, y, span = 0.0, physics.pack(problem.start), problem.span
    new = np.zeros(2, np.int64)
    for compiled in (kernels.rate, kernels.switch_values):
        compiled(modes, c, 1, 1, y, np.empty_like(y))
    kernels.jacobian(modes, c, 1, 1, y, np.empty((len(y), len(y))))
    kernels.switch(modes, c, kernels.SEPARATION, 0, y.copy(), new)
    times: list[float] = []
    kinds: list[str] = []
    crowd = 0
    with meter.running():
        while True:
            if len(times) & 15 == 0:  # the clock takes as long as a phase of some methods
                meter.check()
            cause, t, y = advance(phase, direction, t, y, span)
            if cause is None:
                break
            phase, direction, added = kernels.switch(modes, c, phase, cause, y, new)
            if added < 0:
                raise GaveUp(NOT_FINITE, RunStatus.NON_FINITE)
            crowd = crowd + 1 if times and t - times[-1] < 1e-12 else 0  # s, at one instant
            for place in range(added):
                times.append(t)
                kinds.append(EVENT_KINDS[new[place]])
            if problem.stop and phase == kernels.SEPARATION:
                break
            if crowd > CROWD:
                raise GaveUp(f"more than {CROWD} events at one instant", RunStatus.STALLED)
        if not math.isfinite(y.sum()):
            raise GaveUp(NOT_FINITE, RunStatus.NON_FINITE)
    return meter.result(times, kinds, physics.unpack(problem.start.time + t, PHASES[phase], direction, y))
