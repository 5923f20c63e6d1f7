"""Units and names of the variables of results."""

from __future__ import annotations

from dataclasses import is_dataclass
from functools import cache
from typing import Any

from disc_model.data.variables import COORDINATES, OF_RESULTS, SCALARS, attributes_of_number
from disc_model.stability.critical_values import OF_PARAMETER, long_name_of
from disc_model.studies.registry import quantity_names, quantity_of


@cache
def _common() -> dict[str, dict[str, Any]]:
    """Units and names that all quantities and simulations give a variable of this name; what they
    disagree about is left out, since such a name says nothing of another result's variable."""
    tables = [quantity_of(name).COLUMNS for name in quantity_names()]
    found: dict[str, list[dict[str, Any]]] = {}
    for table in (*tables, SCALARS):
        for name, column in table.items():
            if column.units and not column.flags:
                found.setdefault(name, []).append(column.attributes)
    common = {}
    for name, several in found.items():
        first = several[0]
        common[name] = {
            key: first[key] for key in first if all(each[key] == first[key] for each in several)
        }
    return common


@cache
def _of_kind(kind: str) -> dict[str, dict[str, Any]]:
    """Units and names of the variables of a class of results, or of a function of plain numbers,
    which has names of its own: a cycle and steady sliding both have a growth rate."""
    columns = dict(OF_RESULTS.get(kind, {}))
    of_cycle = quantity_of("floquet").COLUMNS
    match kind:
        case "FloquetResult":
            columns = {**of_cycle, **columns}
        case "SteadySliding":
            columns |= {"growth_rate": of_cycle["sliding_growth_rate"], **COORDINATES}
        case "Result":
            columns = dict(SCALARS)
    return {name: column.attributes for name, column in columns.items() if not column.flags}


def attributes_of(result: Any, name: str, function: str) -> dict[str, Any]:
    """Unit and name of a variable of a result of this package; empty if they are not known, and of a
    reader's own results, whose names need not mean the same."""
    kind = type(result).__name__
    if not is_dataclass(type(result)):
        return _of_kind(function).get(name, {})
    if kind == "Critical" and name in OF_PARAMETER:
        parameter = attributes_of_number(result.name)
        meaning = parameter["long_name"]
        return {**parameter, "long_name": long_name_of(name, result.kind, meaning)}
    return _of_kind(kind).get(name) or _common().get(name, {})
