"""Cycles and special points are those that an earlier state of the package found, in tests/golden.

Cases were drawn at random, and kept where motion is regular. A cycle's numbers hold to 1e-9 on every
processor, a growth rate over one period. The column `rtol` is larger where another tolerance, or
other steps along a branch, make as much of a difference: where two multipliers meet, near grazing
and at narrow folds. An empty cell is the parameter's default.
"""

import math
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import disc_model as dm

FOLDER = Path(__file__).with_name("golden")
CYCLES = pd.read_csv(FOLDER / "cycles.csv")
BRANCHES = pd.read_csv(FOLDER / "branches.csv")
SPECIAL = pd.read_csv(FOLDER / "special_points.csv")
OF_POINTS = ["kind", "value", "period", "range"]
OF_CYCLES = ["period", "slip_time", "growth_rate", "multiplier"]
# of laws whose kernels other quick tests compile
QUICK = {
    *CYCLES[CYCLES["law"] == "paper"].index[::5],
    *CYCLES[CYCLES["law"] == "couple"].index[::3],
}
Row = dict[str, Any]


def rows(table: pd.DataFrame, name: str, quick: set[int]) -> list[Any]:
    """The rows of a table as parameters of a test, of which few are quick."""
    found = []
    for number, row in enumerate(table.to_dict("records")):
        marks = [] if number in quick else [pytest.mark.slow]
        found.append(pytest.param(row, marks=marks, id=f"{number}, {row[name]}"))
    return found


def case_of(row: Row) -> dm.Parameters:
    """The parameters of a row."""
    values = {}
    for name in dm.Parameters.model_fields:
        if name in row and not pd.isna(row[name]):
            values[name] = row[name]
            with suppress(ValueError):  # a word
                values[name] = float(row[name])
    counts = {name: int(values[name]) for name in ("n_diameters", "n_circles")}
    return dm.Parameters(**{**values, **counts})


def cycle_of(row: Row) -> Row:
    """Status and numbers of the cycle of a row."""
    kind: Any = "slipping" if row["law"] == "slipping" else "stick_slip"
    found = dm.floquet(case_of(row), tol=1e-12, kind=kind)
    modulus = np.abs(found.multipliers).max(initial=0.0)
    numbers = (found.period, found.slip_time, found.growth_rate, modulus)
    return {"status": found.status.name.lower(), **dict(zip(OF_CYCLES, numbers, strict=True))}


def special_points_of(row: Row, longest: float) -> list[Row]:
    """The special points of the branch of a row, with the words for its ends."""
    case = case_of(row)
    guess = None
    if row["kick"]:  # lifts slider and disc, to a motion with separation
        start = dm.initial_state(case, {"u": row["kick"]})
        guess = dm.simulate(case, 60, initial_state=start).final_state
    branch = dm.continue_cycle(
        case,
        row["along"],
        (row["low"], row["high"]),
        direction=row["direction"],
        guess=guess,
        releases=row["releases"],
        steps=dm.StepControl(longest=longest),
    )
    found = branch.special_points.rename(columns={row["along"]: "value"})
    return found[OF_POINTS].to_dict("records")


def errors(found: Row, stored: Row) -> float:
    """The largest relative difference of numbers; a growth rate counts over one period."""
    worst = 0.0
    for name, value in stored.items():
        if isinstance(value, float):
            scale = abs(value)
            if name == "growth_rate":
                scale = max(scale, 1 / stored["period"])
            if name == "range":  # whose samples have peaks to 1e-8, of heights above rounding
                scale = 10 * max(scale, 1e-9)
            if math.isnan(value) != math.isnan(found[name]):
                return math.inf
            if scale > 0 and not math.isnan(value):
                worst = max(worst, abs(found[name] - value) / scale)
    return worst


@pytest.mark.compiled
@pytest.mark.parametrize("row", rows(CYCLES, "law", QUICK))
def test_cycles(row: Row) -> None:
    found = cycle_of(row)
    assert found["status"] == row["status"]
    assert errors(found, {name: row[name] for name in OF_CYCLES}) <= row["rtol"]


@pytest.mark.compiled
@pytest.mark.parametrize("row", rows(BRANCHES, "branch", {0}))
@pytest.mark.parametrize("longest", [0.1, 0.05])
def test_special_points(row: Row, longest: float) -> None:
    """Each is found at half the step, too: its test function changes sign there."""
    found = special_points_of(row, longest)
    stored = SPECIAL[SPECIAL["branch"] == row["branch"]].to_dict("records")
    assert [point["kind"] for point in found] == [point["kind"] for point in stored]
    for point, right in zip(found, stored, strict=True):
        assert errors(point, {name: right[name] for name in OF_POINTS}) <= right["rtol"], right
