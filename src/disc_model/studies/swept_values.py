"""The values along an axis of a sweep: what a table may hold, in SI units, and what is wrong with them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from pydantic import create_model

from disc_model.errors import Fault, ParameterError
from disc_model.mode_units import column_of, mode_number_in_si
from disc_model.parameters import Disc, Parameters
from disc_model.simulation.case import SomeParameters
from disc_model.units import Finite, Strict, in_si, is_missing, number


def checked_values(name: str, values: Any, faults: list[str], *within: str) -> list[Any]:
    """The values of an axis in SI units; what is wrong with them, each by itself, is added to the
    faults, whose path begins with the names `within` which the axis stands.

    A number that breaks a rule, nan among them, stays: it makes its points fail, unless no value of
    the axis can be.
    """
    several = _are_several(values)
    raw = as_list(values)
    if not raw:
        faults.append(Fault.of((*within, name), values, "must have one value or more"))
    if any(isinstance(value, list | tuple | np.ndarray) for value in raw):
        faults.append(Fault.of((*within, name), values, "must be values in one dimension"))
        return raw
    model = _model_of(name)
    checked: list[Any] = []
    impossible: list[list[Fault]] = []
    if column_of(name):
        faults += _convert_mode_numbers(raw, (*within, name), several=several)
    for row, value in enumerate(raw):
        try:
            checked.append(getattr(model(**{name: value}), name))
        except ParameterError as error:
            told = [_at_row(fault, (*within, name), row, several=several) for fault in error.faults]
            meant = _number_of(name, value)
            checked.append(meant)
            if meant is None:
                faults += told
            else:
                impossible.append(told)
    if impossible and len(impossible) == len(raw):
        faults += [fault for told in impossible for fault in told]
    return checked


def _convert_mode_numbers(raw: list[Any], path: tuple[str, ...], *, several: bool) -> list[Fault]:
    """Set the values of a number of a mode in SI units; returns what is wrong with their units."""
    faults = []
    for row, value in enumerate(raw):
        of_unit: list[Fault] = []
        raw[row] = mode_number_in_si(path[-1], value, of_unit)
        faults += [_at_row(each, path, row, several=several) for each in of_unit]
    return faults


def as_list(values: Any) -> list[Any]:
    """The values of an axis, without numpy's types; a single one is a list of its own."""
    listed = values if _are_several(values) else [values]
    return [_plain_value(value) for value in listed]


def _are_several(values: Any) -> bool:
    """Whether these are values, and not a single one."""
    return np.iterable(values) and not isinstance(values, str | Mapping | Disc)


def _at_row(fault: Fault, path: tuple[str, ...], row: int, *, several: bool) -> Fault:
    """The fault of one of several values, whose row it names, or of the only one."""
    *within, name = path
    place = f"{name}[{row}]" if several else name
    return Fault((*within, place), fault.value, fault.rule)


def _plain_value(value: Any) -> Any:
    """A value without numpy's type."""
    return value.item() if isinstance(value, np.generic) else value


def _model_of(name: str) -> type[Strict]:
    """The model that checks a value of a parameter, a ratio, or a number of a disc's mode."""
    if name in Parameters.model_fields:
        return SomeParameters
    only: dict[str, Any] = {name: Finite}
    return create_model("Number", __base__=Strict, **only)


def _number_of(name: str, value: Any) -> float | None:
    """The number in SI units that is given for a number of the case, whatever its size, nan for what
    a table has for a missing one; None for all else, and where the case takes a word."""
    unit = "1"
    if name in Parameters.model_fields:
        unit = Parameters.unit(name)
    if not unit:
        return None
    try:
        return math.nan if is_missing(value) else float(number(in_si(value, unit, [], ())))
    except ValueError:
        return None


def faults_along_axis(name: str, values: Sequence[Any]) -> Iterator[Fault]:
    """Yield a fault for each number that is nan or infinite, which has no place along an axis, and for
    each number or word that stands there once more."""
    known = set()
    for row, value in enumerate(values):
        if not isinstance(value, float | int | str):
            continue
        if isinstance(value, float) and not math.isfinite(value):
            yield Fault.of((f"{name}[{row}]",), value, "must be a finite number along an axis")
            continue
        if value in known:
            yield Fault.of((f"{name}[{row}]",), value, "must not be given twice along an axis")
        known.add(value)
