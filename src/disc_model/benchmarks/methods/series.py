"""The package's own engine behind the common interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from disc_model.benchmarks.methods.base import Method, MethodResult, Outcome, Problem, decades
from disc_model.errors import Status
from disc_model.figures.parts import VERMILION
from disc_model.simulation.api import simulate

STEPS_PER_SECOND = 300_000
"""What the budget of seconds is turned into: the engine stops by steps, not by the clock."""


class Series(Method):
    """`disc_model.simulation.api`: Taylor series of high order, switches as roots of polynomials."""

    label = "series (this package)"
    look = (VERMILION, "o", "-")
    settings: Mapping[str, Sequence[float]] = {
        **dict.fromkeys(("stick_slip", "separating", "many_modes"), decades(-4, -6, -8, -10, -12, -14)),
        "rigid": decades(-4, -8, -12),
    }

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        steps = int(max(1, min(budget, 1e6) * STEPS_PER_SECOND))
        result = simulate(
            problem.parameters, problem.t_end, tol=value, initial_state=problem.start, max_steps=steps
        )  # fmt: skip
        outcome = {
            Status.OK: Outcome.FINISHED,
            Status.STEP_LIMIT: Outcome.TOO_SLOW,
            Status.STALLED: Outcome.STALLED,
            Status.NON_FINITE: Outcome.NON_FINITE,
        }.get(result.status, Outcome.FAILED)
        return MethodResult(
            times=result.events["time"].to_numpy(),
            kinds=tuple(result.events["kind"]),
            final=result.final_state,
            seconds=result.statistics["wall_time"],
            work=int(result.statistics["steps"]),
            outcome=outcome,
            message=result.message,
        )
