"""Parts of what a study file may say about its quantity."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from disc_model.parameters import Real
from disc_model.studies.faults import Strict

Positive = Annotated[Real, Field(gt=0, allow_inf_nan=False)]
Tolerance = Annotated[Real, Field(ge=1e-15, le=1e-2)]
Deviation = Annotated[Real, Field(ge=0, le=1e-2)]


class SettlingOptions(Strict):
    """When a motion without separation may be left before the horizon; see `disc_model.stability.settling`.

    settled : successive cycles that agree this well, relative, end the simulation; 0 never does
    near : a motion this near to a stable stick-slip cycle, relative, and ever nearer, ends it too; 0 never does
    """

    tol: Tolerance = 1e-10
    settled: Deviation = 1e-9
    near: Deviation = 1e-4
