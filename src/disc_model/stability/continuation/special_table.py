"""The table of special points of a branch."""

import pandas as pd

WIDTH = 80  # characters of a line of a printed table, as terminals have


class SpecialTable(pd.DataFrame):
    """A table of which all columns are printed, below each other where they are too wide for a line."""

    def __repr__(self) -> str:
        return self.to_string(line_width=WIDTH)
