"""The stick-slip cycle near the static start and its stability, from Floquet multipliers instead of
simulation."""

import math
from typing import Any, ClassVar

from disc_model.data.variables import OF_QUANTITIES, WORDS, CycleStatus, message_of
from disc_model.studies.quantity import Point, Quantity, State
from disc_model.units import CycleTolerance

FROM_START = "The motion from the static start, near which no stick-slip cycle was found."
SLIDING_BY = {
    "steady_sliding": "The motion from the static start, near which steady sliding is stable.",
    "unstable_sliding": "The motion from the static start: the steady sliding near it is unstable.",
}
"""What is shown where sliding goes on, by its stability."""


class Floquet(Quantity):
    """The stick-slip cycle at each point and its growth rate, by Floquet multipliers."""

    tol: CycleTolerance = 1e-12
    """tolerance of cycles: relative residual of the return map"""
    points_per_job: ClassVar = 1000
    motions: ClassVar = 7
    motion: ClassVar = "The stick-slip cycle itself, stable or not."
    motion_by: ClassVar = {
        **dict.fromkeys(WORDS["cycle_statuses"], FROM_START),
        **SLIDING_BY,
        "ok": motion,
    }
    COLUMNS: ClassVar = OF_QUANTITIES["floquet"]["columns"]

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.cycle import find_cycle

        cycle = find_cycle(point.parameters, self.tol)
        leading = (
            complex(cycle.multipliers[0])
            if cycle.status is CycleStatus.OK
            else complex(math.nan, math.nan)
        )
        values = {
            "status": cycle.status.value, "growth_rate": cycle.growth_rate, "period": cycle.period,
            "stick_fraction": cycle.stick_fraction, "multiplier_re": leading.real, "multiplier_im": leading.imag,
            "sliding_growth_rate": cycle.sliding.growth_rate,
        }  # fmt: skip
        return values, message_of(cycle)

    def state_at(self, point: Point) -> State:
        from disc_model.simulation.states import static_start
        from disc_model.stability.cycle import find_cycle

        found = find_cycle(point.parameters, self.tol)
        return static_start(point.parameters) if found.state is None else found.state
