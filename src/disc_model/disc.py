"""Discs given by a table of modes, as finite elements and modal tests find them: from CSV files and back."""

from __future__ import annotations

import math
import re
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.errors import Fault, ParameterError, shown, suggestion
from disc_model.parameters import Disc, Parameters
from disc_model.plate import modal_damping, mode_arrays

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
"""What each column of a table says of a `Disc`, and by what it is multiplied; besides, there may be shapes."""
SHAPE = re.compile(r"shape_at_(\d*\.?\d+(?:e-?\d+)?)_m")
"""The column of the shapes at a radius."""
STATIC_COMPLIANCE = "static_compliance_m_per_N"
"""What a commented line may give, as ``# static_compliance_m_per_N: 1.2e-7``."""
LARGEST = 10_000_000
"""Bytes of a table."""


def read_disc(path: str | os.PathLike[str]) -> Disc:
    """A disc from a table of its modes.

    Parameters
    ----------
    path : CSV file; columns, in any order, are ``diameters``, ``frequency_Hz`` or ``omega_rad_per_s``,
        ``amplitude_per_sqrt_kg``, and perhaps ``damping_ratio``, ``circles``, and shapes at some radii, such as
        ``shape_at_0.08_m``. Lines that begin with # are comments; one may give ``static_compliance_m_per_N: ...``

    Returns
    -------
    Disc

    Raises
    ------
    ParameterError
        If the file cannot be read or is no such table; the message names the column or mode, its value and the rule.
    """
    import pandas as pd

    text = _text(path)
    lines = text.splitlines()
    compliance = _static_compliance(lines, path)
    rows = "\n".join(line for line in lines if not line.lstrip().startswith("#"))
    try:
        table = pd.read_csv(StringIO(rows), skipinitialspace=True, dtype=str, keep_default_na=False)
    except (ValueError, pd.errors.ParserError) as error:
        raise _fault(path, f"must be a table of comma-separated values ({' '.join(str(error).split())})") from None
    faults = _column_faults([str(name) for name in table.columns])
    if faults:
        raise ParameterError(*(fault.inside((Path(path).name,)) for fault in faults))
    values: dict[str, Any] = {"static_compliance": compliance}
    shapes: dict[float, list[float]] = {}
    for name, column in table.items():
        target, factor = COLUMNS.get(str(name), ("", 1.0))
        numbers = [_value(path, str(name), i, cell, factor) for i, cell in enumerate(column)]
        if target:
            values[target] = numbers
        else:
            shapes[float(SHAPE.fullmatch(str(name))[1])] = numbers  # type: ignore[index]
    if shapes:
        values["radii"] = sorted(shapes)
        values["shapes"] = list(zip(*(shapes[radius] for radius in sorted(shapes)), strict=True))
    try:
        return Disc(**values)
    except ParameterError as error:
        raise ParameterError(*(Fault((Path(path).name,), "", str(fault)) for fault in error.faults)) from None


def disc_table(p: Parameters) -> str:
    """The modes of a case as a table that `read_disc` reads; 17 digits bring numbers back as they were."""
    from disc_model.flexibility import residual_flexibility

    modes, lines = mode_arrays(p), []
    static = residual_flexibility(p).total if p.disc is None else p.disc.static_compliance
    if static is not None:
        lines.append(f"# {STATIC_COMPLIANCE}: {static:.17g}")
    radii, shapes = ((), ()) if p.disc is None else (p.disc.radii, p.disc.shapes)
    shape_columns = [f"shape_at_{radius:.17g}_m" for radius in radii]
    names = ("diameters", "circles", "omega_rad_per_s", "amplitude_per_sqrt_kg", "damping_ratio", *shape_columns)
    lines.append(",".join(names))
    with np.errstate(invalid="ignore"):
        ratios = modal_damping(p) / (2 * modes.omega)
    for row in zip(
        modes.diameters, modes.circles, modes.omega, modes.psi, ratios, *zip(*shapes, strict=True), strict=True
    ):
        lines.append(",".join(f"{value:.17g}" for value in row))
    return "\n".join(lines) + "\n"


def _text(path: str | os.PathLike[str]) -> str:
    try:
        too_large = Path(path).stat().st_size > LARGEST
        text = "" if too_large else Path(path).read_text(encoding="utf-8-sig")
    except (OSError, TypeError, ValueError) as error:
        said = getattr(error, "strerror", None) or type(error).__name__
        raise _fault(path, f"must be a text file that can be read ({said})") from None
    if too_large:
        raise _fault(path, f"must be a table of at most {LARGEST // 1_000_000} MB")
    return text


def _static_compliance(lines: list[str], path: object) -> float | None:
    found = [
        match[1] for line in lines if (match := re.fullmatch(rf"\s*#\s*{STATIC_COMPLIANCE}\s*[:=]\s*(\S+)\s*", line))
    ]
    if len(found) > 1:
        raise _fault(path, f"must give {STATIC_COMPLIANCE} once")
    try:
        return float(found[0]) if found else None
    except ValueError:
        raise _fault(path, f"{STATIC_COMPLIANCE}={shown(found[0])}: must be a number") from None


def _column_faults(names: list[str]) -> list[Fault]:
    """What is wrong with the names of the columns."""
    faults = []
    for name in names:
        if name not in COLUMNS and not SHAPE.fullmatch(name):
            if ";" in name or "\t" in name:
                return [Fault(("columns",), shown(name), "must be separated by commas, with points in numbers")]
            faults.append(Fault(("columns",), shown(name), f"unknown column{suggestion(name, list(COLUMNS))}"))
    given = [COLUMNS[name][0] for name in names if name in COLUMNS]
    for target in ("diameters", "omega", "amplitude"):
        wanted = " or ".join(name for name, (which, _) in COLUMNS.items() if which == target)
        if given.count(target) != 1:
            rule = f"must have one column {wanted}" + (f", and not {given.count(target)}" if target in given else "")
            faults.append(Fault(("columns",), "", rule))
    return faults


def _value(path: object, name: str, i: int, cell: str, factor: float) -> float:
    try:
        return float(cell) * factor
    except ValueError:
        raise ParameterError(
            Fault((Path(str(path)).name, name), shown(cell), f"must be a number (mode {i + 1})")
        ) from None


def _fault(path: object, rule: str) -> ParameterError:
    return ParameterError(Fault((shown(str(path)),), "", rule))
