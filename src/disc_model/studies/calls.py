"""What a sweep calls: a function, its arguments, and the values of numbers of the case that vary."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from itertools import product
from typing import Any

import numpy as np

from disc_model.disc.plausibility import warn_of_doubts
from disc_model.errors import (
    Fault,
    ParameterError,
    as_text,
    raise_faults,
    require,
    suggestion,
    violations,
)
from disc_model.parameters import RATIOS, Parameters, foreign_case
from disc_model.studies.quantity import STATUS
from disc_model.studies.swept_values import checked_values, faults_of_repeated, is_missing

OF_SWEEPS = {"status": STATUS.long_name, "message": "what became of it, in words"}
"""Variables that every sweep has, and their names."""
RETURNED = (
    "must return a number, a mapping of names to numbers, words and one-dimensional arrays, or an "
    "xarray.Dataset"
)
BY_PLACE = (
    inspect.Parameter.POSITIONAL_ONLY,
    inspect.Parameter.POSITIONAL_OR_KEYWORD,
    inspect.Parameter.VAR_POSITIONAL,
)
"""Kinds of arguments that can be given without a name."""
ERRORS = ("raise", "record")
"""What may become of an error that is neither of this package nor of arithmetic."""
LIKE = 0.8
"""Likeness of two names from which the first is taken to be the second with a slip of the pen."""


@dataclass(frozen=True)
class Dimension:
    """Values of numbers of the case that vary together, in columns of one length by name.

    Attributes
    ----------
    columns : the values
    labels : words of the points beside them, such as names of samples
    """

    columns: Mapping[str, list[Any]]
    labels: Mapping[str, list[Any]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return "_".join(self.columns)

    @property
    def coordinates(self) -> list[str]:
        """Names of all that stands along the dimension."""
        return [*self.columns, *self.labels]

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

    def checked(self, result: Any, variables: Mapping[str, Any]) -> dict[str, Any]:
        """Return the variables of a result without arguments of the function whose names a
        coordinate has; raises `ParameterError`, with the name of the function, if there are
        none."""
        if not variables:
            rule = f"returned {as_text(result)}, and {RETURNED}"
            raise ParameterError(Fault((self.title,), "", rule))
        kept = dict(variables)
        taken = {name for dimension in self.dimensions for name in dimension.coordinates}
        for name in taken & kept.keys():
            if name not in self.arguments:
                rule = f"returned {name}, which is a coordinate of the sweep: give it another name"
                raise ParameterError(Fault((self.title,), "", rule))
            del kept[name]
        return kept


def are_recorded(errors: Any) -> bool:
    """Whether a sweep goes on after any error; raises `ParameterError`."""
    known = isinstance(errors, str) and errors in ERRORS
    require((known, "errors", errors, f"must be one of {', '.join(ERRORS)}"))
    return bool(errors == "record")


def checked_call(
    function: Any, case: Any, unnamed: Sequence[Any], zipped: Any, named: Mapping[str, Any]
) -> Call:
    """Return the call of a sweep; raises `ParameterError` with all that is wrong with it, such as
    arguments of the function without a name."""
    rule = "must be a function, such as disc_model.floquet"
    faults = [*foreign_case(case), *violations((callable(function), "function", function, rule))]
    raise_faults(faults)
    warn_of_doubts(case)

    # what is named is a number of the case, or an argument of the function
    parameters = inspect.signature(function).parameters
    takes_case = any(each.kind in BY_PLACE for each in parameters.values())
    faults += violations((takes_case, "function", function, "must take a case first"))
    faults += _faults_of_unnamed(unnamed, [*parameters][1:])
    raise_faults(faults)
    names = case.numbers.keys() | Parameters.model_fields.keys() | RATIOS.keys()
    numbers = sorted(case.numbers.keys() | RATIOS.keys(), key=str.lower)
    dimensions = []
    options = {}
    for name, value in named.items():
        if name in names and name not in parameters:
            column = checked_values(name, value, faults)
            faults += faults_of_repeated(name, column)
            dimensions.append(Dimension({name: column}))
        else:
            options[name] = value
    if zipped is not None:
        alone = [dimension.name for dimension in dimensions]
        dimensions.append(_zipped_dimension(zipped, sorted(names), numbers, alone, faults))

    if not any(each.kind is each.VAR_KEYWORD for each in parameters.values()):
        faults += _unknown(options, parameters, numbers)

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


def _unknown(
    options: Mapping[str, Any], parameters: Mapping[str, Any], numbers: Sequence[str]
) -> Iterator[Fault]:
    """Yield a fault for each named value that neither the case nor the function has."""
    known = [*[*parameters][1:], *numbers]
    for name in options.keys() - parameters.keys():
        rule = f"is no number of the case, and no argument of the function{suggestion(name, known)}"
        yield Fault.of((name,), options[name], rule)


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


def _columns_of(zipped: Any) -> dict[str, list[Any]]:
    """The columns of a mapping or of a pandas.DataFrame, of which an index of words with a name is
    one; none of anything else."""
    if not (isinstance(zipped, Mapping) or hasattr(zipped, "columns")):
        return {}
    table = dict(zipped.items())
    index: Any = getattr(zipped, "index", None)
    if isinstance(getattr(index, "name", None), str):
        words = list(index)
        if _are_labels(words):
            table = {index.name: words, **table}
    return table


def _are_labels(values: Any) -> bool:
    """Whether these are words, or yes and no, of which some may be missing."""
    if isinstance(values, str) or not np.iterable(values):
        return False
    present = [value for value in values if not is_missing(value)]
    return bool(present) and all(isinstance(value, str | bool | np.bool_) for value in present)


def _labels_in(table: Mapping[str, Any], names: Sequence[str]) -> dict[str, list[Any]]:
    """The columns that only name the points: of words or of yes and no, under names that no number
    of the case has and that are no slip of the pen of one."""
    folded = [name.lower() for name in names]
    labels = {}
    for name, values in table.items():
        meant = get_close_matches(str(name).lower(), folded, n=1, cutoff=LIKE)
        if name in names or meant or not _are_labels(values):
            continue
        labels[str(name)] = ["" if is_missing(value) else value for value in values]
    return labels


def _zipped_dimension(
    zipped: Any,
    names: Sequence[str],
    numbers: Sequence[str],
    alone: Sequence[str],
    faults: list[str],
) -> Dimension:
    """The dimension of values that vary together, in SI units, with their labels.

    Parameters
    ----------
    zipped : what the user gave
    names, numbers : all that may vary, and those of them that are numbers
    alone : names that are dimensions by themselves
    faults : gets what is wrong
    """
    table = _columns_of(zipped)
    labels = _labels_in(table, names)
    for name in labels.keys() & {*OF_SWEEPS}:
        faults.append(Fault(("zip", name), "", "must have another name: every sweep has one"))
    values_by_name = {name: values for name, values in table.items() if name not in labels}
    if not values_by_name:
        rule = "must have columns of values by the names of numbers of the case, such as N"
        faults.append(Fault.of(("zip",), zipped, rule))
    columns = {}
    for name, values in values_by_name.items():
        if name not in names:
            like = suggestion(str(name), names, all_of_them=False).partition(" (known")[0]
            known = f"(known: {', '.join(numbers)}); a column of labels must hold words"
            faults.append(Fault(("zip", str(name)), "", f"is no number of the case{like} {known}"))
        elif name in alone:
            faults.append(Fault(("zip", name), "", "must not be an axis as well"))
        else:
            columns[name] = checked_values(name, values, faults, "zip")
    lengths = {name: len(values) for name, values in (columns | labels).items()}
    if len({*lengths.values()}) > 1:
        faults.append(Fault.of(("zip",), lengths, "must have columns of one length"))
    return Dimension(columns, labels)
