"""What a study file may say about the quantity `hysteresis`."""

from __future__ import annotations

from typing import Self

from pydantic import model_validator

from disc_model.studies.faults import Strict
from disc_model.studies.grids.axes import Range
from disc_model.studies.grids.quantities.options import Positive, Tolerance


class HysteresisOptions(Strict):
    """Sweep of the speed up from the published start and down again, each speed going on where the last one ended.

    scan : rad/s
    dwell : s at each speed
    late : s, the last stretch of it, over which separations, ranges and shares of the phases are taken
    """

    tol: Tolerance = 1e-10
    scan: Range
    dwell: Positive
    late: Positive = 5.0

    @model_validator(mode="after")
    def _room(self) -> Self:
        if self.late > self.dwell:
            raise ValueError("late must be <= dwell")
        return self
