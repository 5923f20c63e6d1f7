"""SUNDIALS CVODE through scikit-sundae (extra `bench`), with its own root finding, started anew at every switch."""

from __future__ import annotations

from typing import Any

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import Meter, Method, MethodResult, Problem, decades
from disc_model.benchmarks.methods.phases import GUARD, Ended, IntegrationFailed, Phase, run_phases, switch_kinds
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.benchmarks.methods.solve_ivp import absolute_scale
from disc_model.data.variables import PHASES
from disc_model.figures.parts import GREY

MAX_STEPS = 10_000_000
ROOT_FOUND = 2
"""SUNDIALS' CV_ROOT_RETURN."""


class Cvode(Method):
    """Variable-order multistep methods: Adams where nothing is stiff, else BDF; compiled right-hand side."""

    def __init__(self, family: str) -> None:
        self.family = family
        self.label = f"SUNDIALS CVODE ({family})"
        if family == "BDF":  # where something is stiff
            self.look, self.settings = (GREY, ">", "--"), {"rigid": decades(-4, -6, -8, -10)}
            return
        self.look = (GREY, "<", "-")
        shared = dict.fromkeys(("stick_slip", "separating", "many_modes"), decades(-4, -6, -8, -10))
        self.settings = shared | {"rigid": decades(-4)}

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        from sksundae.cvode import CVODE

        physics = Physics(problem.parameters)
        modes, c = kernels.tables(physics)
        scale = absolute_scale(physics)
        warm = physics.pack(problem.start)
        kernels.rate(modes, c, 1, 1, warm, warm.copy())  # compiles
        kernels.switch_values(modes, c, 1, 1, warm, np.empty(3))
        meter = Meter.of(problem, physics, budget)
        solvers: dict[Phase, Any] = {}

        def solver(phase: Phase, watched: bool = True) -> Any:
            code, direction = PHASES.index(phase.name), phase.direction
            count = len(switch_kinds(phase, problem.parameters.contact == "bonded"))

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

        quiet = solver(Phase("separation", 0), watched=False)

        def advance(phase: Phase, t: float, y: Array, t_end: float) -> Ended:
            if phase not in solvers:
                solvers[phase] = solver(phase)
            if phase.name == "separation":
                until = min(t + GUARD, t_end)
                quiet.init_step(t, y)
                t, y = until, np.array(quiet.step(until, tstop=until).y)
                if until >= t_end:
                    return Ended(None, t_end, y)
            cvode = solvers[phase]
            cvode.init_step(t, y)
            while True:
                meter.check()
                before = (t, y)
                found = cvode.step(t_end, method="onestep", tstop=t_end)
                if not found.success:
                    raise IntegrationFailed(str(found.message))
                if meter.heights is not None:
                    t, y = float(found.t), np.array(found.y)
                    meter.heights.path(np.array([before[0], t]), np.array([before[1], y]))
                if found.status == ROOT_FOUND:  # earlier roots stay listed: the last row is this one's
                    cause = int(np.flatnonzero(np.atleast_2d(found.i_events)[-1])[0])
                    return Ended(cause, float(found.t), np.array(found.y))
                if found.t >= t_end:
                    return Ended(None, t_end, np.array(found.y))

        return run_phases(problem, physics, advance, meter)
