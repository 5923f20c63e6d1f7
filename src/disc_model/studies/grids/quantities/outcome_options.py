"""What a study file may say about the quantity `outcome`."""

from __future__ import annotations

from typing import Self

from pydantic import model_validator

from disc_model.studies.grids.quantities.options import Positive, SettlingOptions


class OutcomeOptions(SettlingOptions):
    """One simulation from the published start.

    horizon : s
    late : s, length of the last stretch, over which ranges and shares of the phases are taken
    after_separation : s that are simulated beyond the first separation, so that the late stretch shows its regime
    """

    horizon: Positive
    late: Positive = 1.0
    after_separation: Positive = 5.0

    @model_validator(mode="after")
    def _room(self) -> Self:
        if self.late > min(self.after_separation, self.horizon):
            raise ValueError("late must be <= after_separation and <= horizon")
        return self
