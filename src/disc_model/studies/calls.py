"""What a sweep calls: a function, its arguments, and the values of numbers of the case that vary."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from pydantic import create_model

from disc_model.errors import Fault, ParameterError, raise_faults, suggestion, violations
from disc_model.parameters import RATIOS, Disc, Parameters, foreign_case
from disc_model.simulation.case import SomeParameters
from disc_model.units import Finite, Strict


@dataclass(frozen=True)
class Dimension:
    """Values of numbers of the case that vary together, in columns of one length by name."""

    columns: Mapping[str, list[Any]]

    @property
    def name(self) -> str:
        return "_".join(self.columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def points(self) -> list[dict[str, Any]]:
        """The values by name, at each place along the dimension."""
        names = self.columns.keys()
        rows = zip(*self.columns.values(), strict=True)
        return [dict(zip(names, row, strict=True)) for row in rows]


@dataclass(frozen=True)
class Call:
    """What a sweep calls.

    Attributes
    ----------
    title : name of the function
    dimensions : values of numbers of the case
    options : arguments of the function that do not vary
    arguments : names of all arguments of the function beside the case
    defaults : numbers and words that arguments have that are not named
    """

    title: str
    dimensions: list[Dimension]
    options: Mapping[str, Any]
    arguments: frozenset[str]
    defaults: Mapping[str, Any]

    def points(self) -> Iterator[dict[str, Any]]:
        """Yield the values of all that varies, by name, at each point; the last dimension varies
        fastest."""
        for parts in product(*(dimension.points() for dimension in self.dimensions)):
            point: dict[str, Any] = {}
            for part in parts:
                point.update(part)
            yield point


def checked_call(
    function: Any, case: Any, unnamed: Sequence[Any], zipped: Any, named: Mapping[str, Any]
) -> Call:
    """Return the call of a sweep; raises `ParameterError` with all that is wrong with it, such as
    arguments of the function without a name."""
    rule = "must be a function, such as disc_model.floquet"
    faults = [*foreign_case(case), *violations((callable(function), "function", function, rule))]
    raise_faults(faults)

    # what is named is a number of the case, or an argument of the function
    parameters = inspect.signature(function).parameters
    faults += _faults_of_unnamed(unnamed, [*parameters][1:])
    raise_faults(faults)
    numbers = case.numbers.keys() | Parameters.model_fields.keys() | RATIOS.keys()
    dimensions = []
    options = {}
    for name, value in named.items():
        if name in numbers and name not in parameters:
            dimensions.append(Dimension({name: _values(name, value, faults)}))
        else:
            options[name] = value
    if zipped is not None:
        alone = [dimension.name for dimension in dimensions]
        dimensions.append(Dimension(_zipped_columns(zipped, numbers, alone, faults)))

    takes_all = any(each.kind is each.VAR_KEYWORD for each in parameters.values())
    if not takes_all:
        for name in options.keys() - parameters.keys():
            rule = "is no number of the case, and no argument of the function"
            told = suggestion(name, case.numbers)
            faults.append(Fault.of((name,), named[name], f"{rule}{told}"))

    title = getattr(function, "__name__", type(function).__name__)
    arguments = []
    defaults = {}
    for each in [*parameters.values()][1:]:
        if each.kind in (each.VAR_POSITIONAL, each.VAR_KEYWORD):
            continue
        arguments.append(each.name)
        if isinstance(each.default, bool | int | float | str) and each.name not in named:
            defaults[each.name] = each.default
        if each.default is each.empty and each.name not in named:
            faults.append(Fault((each.name,), "", f"is required by {title}"))
    raise_faults(faults)
    return Call(title, dimensions, options, frozenset(arguments), defaults)


def _faults_of_unnamed(unnamed: Sequence[Any], arguments: Sequence[str]) -> list[Fault]:
    """What is wrong with values without a name, which a function's arguments would take in turn."""
    faults = []
    for i, value in enumerate(unnamed):
        if i < len(arguments):
            rule = f"must be named, as in {arguments[i]}={value!r}"
            faults.append(Fault((arguments[i],), "", rule))
        else:
            rule = "must be named, and is one more than the function's arguments"
            faults.append(Fault.of(("function",), value, rule))
    return faults


def _zipped_columns(
    zipped: Any, numbers: Set[str], alone: Sequence[str], faults: list[str]
) -> dict[str, list[Any]]:
    """The columns of values that vary together, in SI units; what is wrong with them is added to
    the faults.

    Parameters
    ----------
    zipped : mapping or pandas.DataFrame
    numbers : names that may vary
    alone : names that are dimensions by themselves
    faults : gets what is wrong
    """
    is_table = isinstance(zipped, Mapping) or hasattr(zipped, "columns")
    table = dict(zipped.items()) if is_table else {}
    if not table:
        rule = "must have columns of values by the names of numbers of the case, such as N"
        faults.append(Fault.of(("zip",), zipped, rule))
    columns = {}
    for name, values in table.items():
        if name not in numbers:
            told = suggestion(str(name), numbers)
            faults.append(Fault(("zip", str(name)), "", f"is no number of the case{told}"))
        elif name in alone:
            faults.append(Fault(("zip", name), "", "must not be an axis as well"))
        else:
            columns[name] = _values(name, values, faults, "zip")
    lengths = {name: len(values) for name, values in columns.items()}
    if len({*lengths.values()}) > 1:
        rule = "must have columns of one length"
        faults.append(Fault.of(("zip",), lengths, rule))
    return columns


def _values(name: str, values: Any, faults: list[str], *within: str) -> list[Any]:
    """The values of an axis in SI units; what is wrong with them, each by itself, is added to the
    faults, whose path begins with the names `within` which the axis stands."""
    several = np.iterable(values) and not isinstance(values, str | Mapping | Disc)
    raw = list(values) if several else [values]
    if not raw:
        faults.append(Fault.of((*within, name), values, "must have one value or more"))
    model: type[Strict] = SomeParameters
    if name not in Parameters.model_fields:  # a ratio, or a number of a disc's mode
        number: dict[str, Any] = {name: Finite}
        model = create_model("Number", __base__=Strict, **number)
    checked = []
    for value in raw:
        plain = value.item() if isinstance(value, np.generic) else value
        try:
            checked.append(getattr(model(**{name: plain}), name))
        except ParameterError as error:
            for fault in error.faults:
                faults.append(Fault((*within, name), fault.value, fault.rule))
    return checked
