"""Measurements in the rows of a pandas.DataFrame: quantity, value, uncertainty, and what was set."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from disc_model.errors import Fault, ParameterError, suggestion
from disc_model.fitting.measured import Measurement
from disc_model.units import is_missing, number

NEEDED = ("quantity", "value", "uncertainty")
"""Columns that every table has."""
PASSED_OVER = ("comment", "comments", "remark", "remarks", "note")
"""Columns for readers, in small or capital letters."""


def is_table(measured: object) -> bool:
    """Whether measurements are given as a table."""
    return hasattr(measured, "columns") and hasattr(measured, "items")


def measurements_in(
    table: Any, numbers: Collection[str], vary: object, faults: list[str]
) -> tuple[Measurement, ...]:
    """Return the measurement of each row; what is wrong becomes a fault.

    Parameters
    ----------
    table : a pandas.DataFrame, whose index may have the name of a column
    numbers : names of the numbers of the case, which may be further columns; an empty cell stands for the value of the
        case
    vary : names of those that are fitted, which cannot be set; anything else counts as none
    faults : gets what is wrong
    """
    index = table.index.name
    if index in (*NEEDED, *numbers) and index not in table.columns:
        table = table.reset_index()
    table = table[[name for name in table.columns if str(name).lower() not in PASSED_OVER]]
    names = list(table.columns)
    wrong = _column_faults(names, numbers, vary)
    faults += wrong
    if wrong:
        return ()
    columns = [[_plain(cell) for cell in table[name]] for name in names]
    found = []
    for row, cells in enumerate(zip(*columns, strict=True)):
        given = dict(zip(names, cells, strict=True))
        quantity, value, uncertainty = (given.pop(name) for name in NEEDED)
        at = {name: cell for name, cell in given.items() if not _is_empty(cell)}
        try:
            found.append(Measurement(quantity, value, uncertainty, at))
        except ParameterError as error:
            faults += [in_row(fault, row) for fault in error.faults]
    return tuple(found)


def _column_faults(names: Sequence[object], numbers: Collection[str], vary: object) -> list[str]:
    """Return faults of the names of columns."""
    known = [*NEEDED, *numbers]
    faults: list[str] = []
    for name in dict.fromkeys(names):
        if name not in known:
            rule = "is neither a column of measurements nor a number of the case"
            faults.append(Fault(("measured", str(name)), "", rule + suggestion(name, known)))
        elif isinstance(vary, Sequence) and name in vary:
            rule = "must be no column, because it is varied"
            faults.append(Fault(("measured", str(name)), "", rule))
        elif names.count(name) > 1:
            faults.append(Fault(("measured", str(name)), "", "must not be given twice"))
    missing = [name for name in NEEDED if name not in names]
    faults += [Fault(("measured",), "", f"must have a column {name}") for name in missing]
    return faults


def _plain(cell: Any) -> Any:
    """A cell without numpy's type. A number among the texts of a file has become a text, too."""
    if isinstance(cell, np.generic):
        return cell.item()
    if not isinstance(cell, str):
        return cell
    try:
        return number(cell)
    except ValueError:
        return cell


def _is_empty(cell: Any) -> bool:
    """Whether a cell is empty: a missing value, or a text of blanks."""
    is_blank = isinstance(cell, str) and not cell.strip()
    return is_blank or is_missing(cell)


def in_row(fault: str, row: int) -> str:
    """The fault of a measurement with the row in which it stands."""
    if not isinstance(fault, Fault):
        return fault
    name = ".".join(fault.path)
    return Fault(("measured", f"{name}[{row}]"), fault.value, fault.rule)
