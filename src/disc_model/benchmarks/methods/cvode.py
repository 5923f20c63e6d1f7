"""SUNDIALS CVODE through scikit-sundae (extra `bench`), with its own root finding, started anew at every switch."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import GaveUp, Meter, Method, MethodResult, Problem, decades
from disc_model.benchmarks.methods.phases import ENDS, Ended, Phase, run_phases
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.benchmarks.methods.solve_ivp import absolute_scale
from disc_model.benchmarks.register import SCENES

MAX_STEPS = 10_000_000
ROOT_FOUND = 2
"""SUNDIALS' CV_ROOT_RETURN."""


class Cvode(Method):
    """Variable-order multistep methods: Adams where nothing is stiff, else BDF; compiled right-hand side."""

    def __init__(self, family: str) -> None:
        self.family = family
        self.label = f"SUNDIALS CVODE ({family})"
        if family == "BDF":  # where something is stiff
            self.settings = {"rigid": decades(-4, -6, -8, -10)}
            return
        self.settings = dict.fromkeys(SCENES, decades(-4, -6, -8, -10)) | {"rigid": decades(-4)}

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        from sksundae.cvode import CVODE

        physics = Physics(problem.parameters)
        modes, c = kernels.tables(physics)
        scale = absolute_scale(physics)
        meter = Meter(problem, physics, budget)

        @cache
        def solver(phase: Phase, watched: bool) -> Any:
            code, direction, count = phase.code, phase.direction, ENDS[phase.name]

            def rhs(_t: float, y: Array, dy: Array) -> None:
                meter.work += 1
                kernels.rate(modes, c, code, direction, y, dy)

            def events(_t: float, y: Array, out: Array) -> None:
                kernels.switch_values(modes, c, code, direction, y, out)

            options = {"method": self.family, "rtol": value, "atol": value * scale, "max_num_steps": MAX_STEPS}
            if not watched:
                return CVODE(rhs, **options)
            events.direction = [-1] * count  # type: ignore[attr-defined]
            events.terminal = [True] * count  # type: ignore[attr-defined]
            return CVODE(rhs, eventsfn=events, num_events=count, **options)

        solver(Phase("separation", 0), watched=False)

        def advance(phase: Phase, t: float, y: Array, t_end: float, *, watched: bool) -> Ended:
            cvode = solver(phase, watched=watched)
            cvode.init_step(t, y)
            if not watched:
                return Ended(None, t_end, np.array(cvode.step(t_end, tstop=t_end).y))
            while True:
                meter.check()
                found = cvode.step(t_end, method="onestep", tstop=t_end)
                if not found.success:
                    raise GaveUp(str(found.message))
                if problem.watched:
                    before, t, y = (t, y), float(found.t), np.array(found.y)
                    meter.path(np.array([before[0], t]), np.array([before[1], y]))
                rooted = found.status == ROOT_FOUND
                if rooted or found.t >= t_end:
                    # earlier roots stay listed: the last row is this one's
                    cause = int(np.flatnonzero(np.atleast_2d(found.i_events)[-1])[0]) if rooted else None
                    return Ended(cause, float(found.t), np.array(found.y))

        return run_phases(problem, physics, advance, meter)
