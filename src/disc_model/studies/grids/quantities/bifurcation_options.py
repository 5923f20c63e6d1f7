"""What a study file may say about the quantity `bifurcation`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from disc_model.parameters import Count
from disc_model.studies.grids.axes import MOST, Finite
from disc_model.studies.grids.quantities.lead_options import Lead
from disc_model.studies.grids.quantities.options import Positive


class BifurcationOptions(Lead):
    """Samples once a turn of the drive, of what the motion has settled to.

    transient : s, left out
    samples : number of turns sampled after it
    theta : rad, the disc's point whose displacement is sampled
    """

    transient: Positive
    samples: Annotated[Count, Field(ge=1, le=MOST)] = 50
    theta: Finite = 1.0
