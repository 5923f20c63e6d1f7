"""What a comparison is: a measured and a predicted number, and when they agree."""

from pathlib import Path
from typing import NamedTuple

import pandas as pd

TABLES = Path(__file__).parent / "tables"


class Comparison(NamedTuple):
    """A measured and a predicted number.

    Parameters
    ----------
    what : the quantity and its conditions
    measured, predicted : in the unit
    unit : of both, "" for none
    agrees : whether the criterion that was set beforehand is met
    """

    what: str
    measured: float
    predicted: float
    unit: str
    agrees: bool

    @property
    def ratio(self) -> float:
        """The predicted value over the measured one."""
        return self.predicted / self.measured


def within(measured: float, predicted: float, tolerance: float) -> bool:
    """Return whether a prediction differs by at most a part of the measured value."""
    return abs(predicted - measured) <= tolerance * abs(measured)


def read(name: str) -> pd.DataFrame:
    """Read a table of measurements."""
    return pd.read_csv(TABLES / name, comment="#")
