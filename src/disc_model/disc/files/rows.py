"""Cells of the lines of a CSV file, whatever separates its columns and its decimals."""

import csv
import re
from itertools import chain

from disc_model.errors import Fault, ParameterError

_SEPARATOR = re.compile(r"sep=(.)\s*", re.IGNORECASE)


def rows_of(lines: list[str]) -> list[list[str]]:
    """The cells of a table, without empty rows and columns, which spreadsheets append."""
    separator = ""
    if lines and (stated := _SEPARATOR.fullmatch(lines[0])):
        separator = stated[1]
        lines = lines[1:]
    if not separator:
        separator = _separator_in(next((line for line in lines if line.strip()), ""))

    rows = []
    used: set[int] = set()
    for row in csv.reader(lines, delimiter=separator, skipinitialspace=True):
        cells = [cell.strip() for cell in row]
        filled = [i for i, cell in enumerate(cells) if cell]
        used.update(filled)
        if filled:
            rows.append(cells)
    rows = [_chosen(row, used) for row in rows]
    if separator != ",":
        rows[1:] = _with_points(rows[1:])
    return rows


def _separator_in(head: str) -> str:
    """What separates columns, by the line of their heads."""
    for mark in ";\t":
        if mark in head:
            return mark
    return ","


def _chosen(row: list[str], used: set[int]) -> list[str]:
    """The cells of a row in columns that are used."""
    return [cell for i, cell in enumerate(row) if i in used]


def _with_points(rows: list[list[str]]) -> list[list[str]]:
    """Cells with decimal points in place of decimal commas; both in one table are refused, because
    one of them may separate thousands."""
    cells = [*chain.from_iterable(rows)]
    with_comma = [cell for cell in cells if re.search(r",\d", cell)]
    with_point = [cell for cell in cells if re.search(r"\.\d", cell)]
    with_both = [cell for cell in with_comma if cell in with_point]
    if with_both:
        rule = f"must have commas or points for decimals, and nothing for thousands: not {with_both[0]}"
        raise ParameterError(Fault((), "", rule))
    if with_comma and with_point:
        rule = "all numbers must have commas, or all must have points, for decimals: not "
        raise ParameterError(Fault((), "", f"{rule}{with_comma[0]} and {with_point[0]}"))
    return [[*map(_with_point, row)] for row in rows]


def _with_point(cell: str) -> str:
    return cell.replace(",", ".")


# ---- Cells


def number_in(cell: str, factor: float = 1.0) -> float | str:
    """The number in a cell; other text as it is."""
    try:
        return float(cell) * factor
    except ValueError:
        return cell


def begins_a_number(cell: str) -> bool:
    """Whether a cell begins as a number does, so that its row is no row of units."""
    return bool(re.match(r"[-+]?[.,]?\d(?!/)", cell)) or cell.lower().startswith(("nan", "inf"))


def joined(name: str) -> str:
    """The words of a name in lower case, with "_" between them."""
    return re.sub(r"[\s_-]+", "_", name.strip().lower())
