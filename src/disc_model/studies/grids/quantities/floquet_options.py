"""What a study file may say about the quantity `floquet`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from disc_model.parameters import Real
from disc_model.studies.faults import Strict


class FloquetOptions(Strict):
    """The stick-slip cycle of each point.

    tol : relative, of the series and of the return map's residual
    """

    tol: Annotated[Real, Field(ge=1e-14, le=1e-6)] = 1e-12
