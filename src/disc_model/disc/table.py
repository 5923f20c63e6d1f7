"""Discs from tables of their modes: CSV files with fixed heads."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from disc_model.errors import Fault, ParameterError, require
from disc_model.parameters import Disc

if TYPE_CHECKING:
    import os

    import pandas as pd

HEADS = {
    "diameters": ("diameters", 1.0),
    "circles": ("circles", 1.0),
    "omega_rad_per_s": ("omega", 1.0),
    "frequency_Hz": ("omega", math.tau),
    "amplitude_per_sqrt_kg": ("amplitude", 1.0),
    "tangential_per_sqrt_kg": ("tangential", 1.0),
    "damping_ratio": ("damping_ratio", 1.0),
}
"""Field of a `Disc` that each column gives, and the factor to its SI unit."""
NEEDED = {"diameters", "omega", "amplitude"}
KNOWN = (
    "columns are diameters, omega_rad_per_s or frequency_Hz, and amplitude_per_sqrt_kg; "
    "circles, tangential_per_sqrt_kg and damping_ratio may be left out"
)


def disc_of_table(path: str | os.PathLike[str]) -> Disc:
    """Read a disc from a table of its modes, see `disc_model.Disc.from_csv`."""
    import pandas as pd

    faults: tuple[Fault, ...]
    try:
        cells = pd.read_csv(
            path, header=None, dtype=str, keep_default_na=False, comment="#",
            skipinitialspace=True, encoding="utf-8-sig",
        )  # fmt: skip
        return Disc(**_columns(cells))
    except ParameterError as error:
        faults = error.faults
    except (OSError, ValueError) as error:
        rule = f"must be a table with commas that can be read ({str(error).strip()}); {KNOWN}"
        faults = (Fault((), "", rule),)
    raise ParameterError(*(fault.inside((Path(path).name,)) for fault in faults))


def table_of_disc(disc: Disc) -> pd.DataFrame:
    """The table that `disc_of_table` reads, with frequencies in rad/s."""
    import pandas as pd

    columns = {}
    for head, (field, factor) in HEADS.items():
        if factor == 1.0 and getattr(disc, field):
            columns[head] = getattr(disc, field)
    return pd.DataFrame(columns)


def _columns(cells: pd.DataFrame) -> dict[str, Any]:
    """The fields of a `Disc` in a table whose first row has the heads."""
    heads = [head.strip() for head in cells.iloc[0]]
    unknown = [head for head in heads if head not in HEADS]
    require((not unknown, "columns", unknown, f"unknown: {KNOWN}"))
    fields = [HEADS[head][0] for head in heads]
    is_whole = {*fields} >= NEEDED and len({*fields}) == len(fields)
    require((is_whole, "columns", heads, f"must have each once: {KNOWN}"))
    columns = {}
    for i, head in enumerate(heads):
        field, factor = HEADS[head]
        try:
            columns[field] = [float(cell) * factor for cell in cells[i][1:]]
        except ValueError as error:
            raise ParameterError(Fault((head,), "", f"{error}; {KNOWN}")) from None
    return columns
