"""How curves show the modes of a Campbell diagram, as its figure does: growing ones in a colour of their
own, and marks of crossings."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import xarray as xr

from disc_model.figures.campbell_looks import CROSSINGS, UNSTABLE
from disc_model.figures.colours import ROUNDING

RATES: Mapping[str, str] = MappingProxyType(
    {"sliding_frequency": "sliding_growth_rate", "cycle_frequency": "cycle_growth_rate"}
)
"""The growth rates of modes, by their frequencies."""
CROSSED = ("crossing_Omega", "crossing_frequency", "crossing_effect")
"""What is known of a crossing."""


def looks_of_modes(study: xr.Dataset) -> dict[str, Any] | None:
    """The looks of growing modes and of crossings, by what growth rates do there; None of a study that
    is no Campbell diagram."""
    if not {*CROSSED, *RATES} <= {*study}:
        return None
    crossings = []
    for crossing in CROSSINGS:
        crossings.append(
            {
                "effects": list(crossing.effects),
                "label": f"crossing: {crossing.meaning}",
                "shape": crossing.marker,
                "is_filled": crossing.face != "white",
            }
        )
    growing = {"label": "growing mode", "colour": UNSTABLE, "above": ROUNDING}
    return {"rates": dict(RATES), "growing": growing, "crossings": crossings}
