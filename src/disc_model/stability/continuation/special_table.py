"""The table of special points of a branch."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from disc_model.data.coded import head_of

WIDTH = 80  # characters of a line of a printed table, as terminals have
UNITS = "units"
"""What `attrs` of a table call the units of its columns."""


class SpecialTable(pd.DataFrame):
    """A table of which all columns are printed, below each other where they are too wide for a line, and
    whose heads in a file have units."""

    def __repr__(self) -> str:
        return self.to_string(line_width=WIDTH)

    def to_csv(self, *args: Any, **options: Any) -> Any:
        """Write the table as `pandas.DataFrame.to_csv` does, with units in the heads."""
        units = self.attrs.get(UNITS, {})
        heads = {name: head_of(name, {"units": unit}) for name, unit in units.items()}
        return pd.DataFrame(self).rename(columns=heads).to_csv(*args, **options)


def special_table(
    columns: Mapping[str, Sequence[object]], described: Mapping[str, Mapping[str, Any]]
) -> SpecialTable:
    """The table of some columns, some of which are described by attributes with a unit."""
    table = SpecialTable(columns)
    units = {name: attributes.get(UNITS, "") for name, attributes in described.items()}
    table.attrs[UNITS] = {name: unit for name, unit in units.items() if unit not in ("", "1")}
    return table
