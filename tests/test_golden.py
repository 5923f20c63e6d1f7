"""Cycles and special points are those of the golden tables, which `tests/golden/make.py` made.

A cycle's numbers hold to 1e-9 on every processor, a growth rate over one period. The column
`rtol` is larger where another tolerance, or other steps along a branch, make as much of a
difference: where two multipliers meet, near grazing and at narrow folds.
"""

from typing import Any

import pandas as pd
import pytest

from tests.golden.make import FOLDER, OF_CYCLES, OF_POINTS, cycle_of, errors, special_points_of

CYCLES = pd.read_csv(FOLDER / "cycles.csv")
BRANCHES = pd.read_csv(FOLDER / "branches.csv")
SPECIAL = pd.read_csv(FOLDER / "special_points.csv")
# of laws whose kernels other quick tests compile
QUICK = {
    *CYCLES[CYCLES["law"] == "paper"].index[::5],
    *CYCLES[CYCLES["law"] == "couple"].index[::3],
}


def rows(table: pd.DataFrame, name: str, quick: set[int]) -> list[Any]:
    """The rows of a table as parameters of a test, of which few are quick."""
    found = []
    for number, row in enumerate(table.to_dict("records")):
        marks = [] if number in quick else [pytest.mark.slow]
        found.append(pytest.param(row, marks=marks, id=f"{number}, {row[name]}"))
    return found


@pytest.mark.compiled
@pytest.mark.parametrize("row", rows(CYCLES, "law", QUICK))
def test_cycles(row: dict[str, Any]) -> None:
    found = cycle_of(row)
    assert found["status"] == row["status"]
    assert errors(found, {name: row[name] for name in OF_CYCLES}) <= row["rtol"]


@pytest.mark.compiled
@pytest.mark.parametrize("row", rows(BRANCHES, "branch", {0}))
@pytest.mark.parametrize("longest", [0.1, 0.05])
def test_special_points(row: dict[str, Any], longest: float) -> None:
    """Each is found at half the step, too: its test function changes sign there."""
    found = special_points_of(row, longest=longest)
    stored = SPECIAL[SPECIAL["branch"] == row["branch"]].to_dict("records")
    assert [point["kind"] for point in found] == [point["kind"] for point in stored]
    for point, right in zip(found, stored, strict=True):
        assert errors(point, {name: right[name] for name in OF_POINTS}) <= right["rtol"], right
