"""What a study file may say about the quantity `critical_speed`."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import AfterValidator, Field, model_validator

from disc_model.parameters import Count
from disc_model.studies.grids.axes import Range
from disc_model.studies.grids.quantities.options import Positive, SettlingOptions


class CriticalSpeedOptions(SettlingOptions):
    """Scan of the speed, then bisection of each interval in which separation begins or ends.

    horizons : s, each has its own critical speed; all come from the same simulations
    scan : rad/s
    precision : rad/s, width of the last interval; the scan's step must be a multiple
    max_crossings : room for that many crossings at each horizon
    """

    horizons: Annotated[tuple[Positive, ...], Field(min_length=1), AfterValidator(lambda h: tuple(sorted(set(h))))]
    scan: Range
    precision: Positive = 0.1
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 12

    @model_validator(mode="after")
    def _lattice(self) -> Self:
        if self.scan.scale != "linear":
            raise ValueError("scan must be linear")
        step = (self.scan.stop - self.scan.start) / self.scan.intervals / self.precision
        if not math.isfinite(step) or abs(step - round(step)) > 1e-6 or round(step) < 1:
            raise ValueError("the scan's step must be a multiple of precision")
        return self
