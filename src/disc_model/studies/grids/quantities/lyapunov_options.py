"""What a study file may say about the quantity `lyapunov`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from disc_model.parameters import Count
from disc_model.studies.grids.quantities.lead_options import Lead
from disc_model.studies.grids.quantities.options import Positive


class LyapunovOptions(Lead):
    """The largest Lyapunov exponents of the motion.

    transient : s, left out
    duration : s, over which the rates are averaged
    exponents : how many, 1 to 8
    interval : s, between orthonormalisations
    """

    transient: Positive
    duration: Positive
    exponents: Annotated[Count, Field(ge=1, le=8)] = 2
    interval: Positive = 0.01
