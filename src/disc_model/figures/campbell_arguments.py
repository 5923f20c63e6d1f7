"""Checks of the arguments of a Campbell diagram on a reader's axes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.errors import raise_faults, require, violations
from disc_model.figures.drawn_units import with_drawn_speeds
from disc_model.figures.selection import without_single
from disc_model.units import in_si, is_number

NEEDED = ("Omega", "sliding_frequency", "growth_rate", "crossing_Omega")
"""What a study has that such a diagram can show."""
OTHERS = ("Omega", "mode", "crossing")
"""Dimensions of such a study beside those of its grid."""
MOST_COLUMNS = 6
"""Values of a further dimension that have a panel each."""


def checked_study(
    study: xr.Dataset, highest: float | str | None, multiples: Sequence[float] | None
) -> tuple[xr.Dataset, float | None]:
    """The study along its speeds as they are drawn, and the highest frequency shown (Hz) if one is asked for, after all
    checks."""
    is_study = isinstance(study, xr.Dataset) and all(name in study for name in NEEDED)
    faults: list[Any] = []
    limit: Any = in_si(highest, "Hz", faults, ("highest",))
    known = bool(faults) or limit is None or (is_number(limit) and limit > 0)
    faults += violations(
        (is_study, "study", study, "must be a study of `quantity: campbell`, as of run_study"),
        (known, "highest", highest, "must be a number > 0, in Hz"),
        (
            _are_multiples(multiples),
            "multiples",
            multiples,
            "must be whole numbers or halves > 0, such as [2, 2.5]",
        ),
    )
    raise_faults(faults)
    drawn = without_single(study, *OTHERS).transpose("Omega", ...)
    further = dims_of_columns(drawn)
    few = not further or (len(further) == 1 and drawn.sizes[further[0]] <= MOST_COLUMNS)
    selection = f"select values, as by study.sel({_first_place(drawn, further)})"
    rule = f"must be one dimension of up to {MOST_COLUMNS} values: {selection}"
    points = "must have two speeds or more"
    require(
        (few, "study", ", ".join(further), rule),
        (drawn.sizes["Omega"] > 1, "study", "a single speed", points),
    )
    return with_drawn_speeds(drawn), limit


def dims_of_columns(study: xr.Dataset) -> list[str]:
    """The dimensions beside the speed along which a study varies."""
    return [str(dim) for dim in study.dims if dim not in OTHERS]


def _are_multiples(multiples: Any) -> bool:
    """Whether these are multiples of one half from one half on, or none."""
    if multiples is None:
        return True
    if np.ndim(multiples) != 1:
        return False
    return all(is_number(each) and each > 0 and each % 0.5 == 0 for each in multiples)


def _first_place(study: xr.Dataset, dims: Sequence[str]) -> str:
    """The first value along each of these dimensions, as arguments of ``sel``."""
    return ", ".join(f"{dim}={study[dim].values[0].item()!r}" for dim in dims)
