"""Discs given by a table of modes, from finite elements or modal tests: reading and writing of CSV files."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.disc.plate import Array, modal_damping, mode_arrays, modes_of_table
from disc_model.errors import Fault, ParameterError, as_text, raise_faults, suggestion
from disc_model.parameters import Disc, Parameters

if TYPE_CHECKING:
    import os

COLUMNS = {
    "diameters": ("diameters", 1.0),
    "frequency_Hz": ("omega", math.tau),
    "omega_rad_per_s": ("omega", 1.0),
    "amplitude_per_sqrt_kg": ("amplitude", 1.0),
    "damping_ratio": ("damping_ratio", 1.0),
    "circles": ("circles", 1.0),
}
"""Field of a `Disc` that each column of a table gives, and the factor on its values; shapes have further columns."""
SHAPE = re.compile(r"shape_at_(\d*\.?\d+(?:e-?\d+)?)_m")
"""Name of the column with the shapes at a radius."""
STATIC_COMPLIANCE = "static_compliance_m_per_N"
"""Value that a comment line may give, as ``# static_compliance_m_per_N: 1.2e-7``."""


def read_disc(path: str | os.PathLike[str]) -> Disc:
    """Read a disc from a table of its modes.

    Parameters
    ----------
    path : CSV file. Its columns, in any order, are ``diameters``, ``frequency_Hz`` or ``omega_rad_per_s``, and
        ``amplitude_per_sqrt_kg``; optional are ``damping_ratio``, ``circles``, and shapes at radii, such as
        ``shape_at_0.08_m``. Lines that begin with # are comments; one may give ``static_compliance_m_per_N: ...``

    Returns
    -------
    Disc

    Raises
    ------
    ParameterError
        If the file cannot be read or breaks a rule; the message names the column or mode, its value and the rule.
    """
    lines = _text(path).splitlines()
    values: dict[str, Any] = {"static_compliance": _static_compliance(lines, path)}
    try:
        return _disc(values, *_rows([line for line in lines if not line.lstrip().startswith("#")]))
    except ParameterError as error:
        raise ParameterError(*(fault.inside((Path(path).name,)) for fault in error.faults)) from None


def _rows(lines: list[str]) -> tuple[list[str], list[list[str]]]:
    """Names of the columns, and the cells of each mode; empty rows, which spreadsheets append, are skipped."""
    try:
        table = [[cell.strip() for cell in row] for row in csv.reader(lines, skipinitialspace=True)]
    except csv.Error as error:
        raise ParameterError(Fault((), "", f"must be a table of comma-separated values ({error})")) from None
    names, *rows = [row for row in table if any(row)] or [[]]
    uneven = [
        Fault((), "", f"mode {i} has {len(row)} values: must be as many as columns, {len(names)}")
        for i, row in enumerate(rows, 1)
        if len(row) != len(names)
    ]
    raise_faults(_column_faults(names) or uneven[:3])
    return names, rows


def _disc(values: dict[str, Any], names: list[str], rows: list[list[str]]) -> Disc:
    """The disc of a table; a fault in a number names its column, mode and cell."""
    radii = {float(match[1]): column for column, name in enumerate(names) if (match := SHAPE.fullmatch(name))}
    columns: dict[tuple[str, ...], int] = {}
    for column, (target, factor) in ((column, COLUMNS[name]) for column, name in enumerate(names) if name in COLUMNS):
        columns[target,] = column
        values[target] = [_number(row[column], factor) for row in rows]
    if radii:
        values |= {"radii": sorted(radii), "shapes": [[_number(row[radii[r]]) for r in sorted(radii)] for row in rows]}
        columns |= {("shapes", str(i)): radii[r] for i, r in enumerate(sorted(radii))}
    try:
        disc = Disc(**values)
    except ParameterError as error:
        raise ParameterError(*(_of_table(fault, columns, names, rows) for fault in error.faults)) from None
    static, modal = disc.static_compliance, modes_of_table(disc).flexibility
    if static is not None and static < modal * (1 - 1e-9):  # both may be the same sum with different rounding
        rule = f"must not be less than what the modes give at the slider, {modal:.6g} m/N"
        raise ParameterError(Fault.of((STATIC_COMPLIANCE,), static, rule))
    return disc


def _number(cell: str, factor: float = 1.0) -> float | str:
    """The number in a cell; other text is returned unchanged, and `Disc` refuses it."""
    try:
        return float(cell) * factor
    except ValueError:
        return cell


def _of_table(fault: Fault, columns: dict[tuple[str, ...], int], names: list[str], rows: list[list[str]]) -> Fault:
    if len(fault.path) < 2 or (column := columns.get((fault.path[0], *fault.path[2:]))) is None:
        return fault
    i = int(fault.path[1])
    unit = " rad/s" if names[column] == "frequency_Hz" and "within" in fault.rule else ""
    return Fault.of((names[column],), rows[i][column], f"{fault.rule}{unit} (mode {i + 1})")


def damping_ratios(p: Parameters) -> Array:
    """Damping ratios of the modes of a case; for a disc that is given by a table, exactly those of the table."""
    if p.disc is not None:
        return np.array(p.disc.damping_ratio)
    with np.errstate(invalid="ignore"):
        return modal_damping(p) / (2 * mode_arrays(p).omega)


def disc_table(p: Parameters) -> str:
    """Write the modes of a case as a table, with enough digits for `read_disc` to restore each number exactly."""
    from disc_model.disc.flexibility import residual_flexibility

    modes = mode_arrays(p)
    columns: dict[str, Any] = {"diameters": modes.diameters, "circles": modes.circles, "omega_rad_per_s": modes.omega}
    columns |= {"amplitude_per_sqrt_kg": modes.psi, "damping_ratio": damping_ratios(p)}
    static = residual_flexibility(p).total if p.disc is None else p.disc.static_compliance
    if p.disc is not None:
        shapes = zip(p.disc.radii, zip(*p.disc.shapes, strict=True), strict=True)
        columns |= {f"shape_at_{radius}_m": shape for radius, shape in shapes}
    rows = [[*columns], *zip(*columns.values(), strict=True)]
    comment = "" if static is None else f"# {STATIC_COMPLIANCE}: {static}\n"
    return comment + "".join(",".join(map(str, row)) + "\n" for row in rows)


def _text(path: str | os.PathLike[str]) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, TypeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or ("not UTF-8" if isinstance(error, UnicodeError) else repr(error))
        raise _fault(path, f"must be a text file that can be read ({reason})") from None


def _static_compliance(lines: list[str], path: object) -> float | None:
    values = [
        match[1] for line in lines if (match := re.fullmatch(rf"\s*#\s*{STATIC_COMPLIANCE}\s*[:=]\s*(\S+)\s*", line))
    ]
    if len(values) > 1:
        raise _fault(path, f"must give {STATIC_COMPLIANCE} once")
    try:
        return float(values[0]) if values else None
    except ValueError:
        raise _fault(path, f"{STATIC_COMPLIANCE}={as_text(values[0])}: must be a number") from None


def _column_faults(names: list[str]) -> list[Fault]:
    """Faults of the names of the columns."""
    faults = []
    for name in names:
        if name not in COLUMNS and not SHAPE.fullmatch(name):
            if ";" in name or "\t" in name:
                return [Fault.of(("columns",), name, "must be separated by commas, with points in numbers")]
            faults.append(Fault.of(("columns",), name, f"unknown column{suggestion(name, list(COLUMNS))}"))
    radii = [f"shape_at_{float(match[1])}_m" for name in names if (match := SHAPE.fullmatch(name))]
    targets = [COLUMNS[name][0] for name in names if name in COLUMNS] + radii
    for target in dict.fromkeys(["diameters", "omega", "amplitude", *targets]):
        if (count := targets.count(target)) != 1:
            wanted = " or ".join(name for name, (which, _) in COLUMNS.items() if which == target) or target
            rule = f"must have one column {wanted}" + (f", and not {count}" if count else "")
            faults.append(Fault(("columns",), "", rule))
    return faults


def _fault(path: object, rule: str) -> ParameterError:
    return ParameterError(Fault((as_text(str(path)),), "", rule))
