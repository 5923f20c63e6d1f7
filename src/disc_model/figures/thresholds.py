"""Charts of thresholds: where the cycle becomes unstable, and where separation follows."""

from typing import ClassVar, Literal

from disc_model.figures.critical_speed import CriticalSpeed
from disc_model.figures.kind import CURVES, CYCLE, Roles


class Thresholds(CriticalSpeed):
    """Where the cycle becomes unstable and where separation follows, on one chart."""

    roles: ClassVar[Roles] = {"curves": CURVES._replace(required=True), "cycle": CYCLE}

    one_horizon = True

    kind: Literal["thresholds"] = "thresholds"  # type: ignore[assignment]
