"""What a sweep calls: a function, its arguments, and the values of numbers of the case that vary."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from disc_model.data.swept_branches import name_beside
from disc_model.data.variables import OF_RESULTS
from disc_model.errors import (
    Fault,
    ImplausibleValue,
    ParameterError,
    as_text,
    raise_faults,
    require,
    rule_of_choice,
    suggestion,
    violations,
)
from disc_model.parameters import RATIOS, Parameters, foreign_case
from disc_model.studies.samples import OF_SWEEPS, Dimension, Known, zipped_dimension
from disc_model.studies.swept_values import checked_values, faults_along_axis
from disc_model.studies.varied_arguments import Arguments, values_over

LIMITED = ("simulate", "tol")
"""A function of this package and the argument in whose place it may use a limit."""
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
BY_NAME = inspect.Parameter.POSITIONAL_OR_KEYWORD
"""Kind of arguments that can be given in either way."""
ERRORS = ("raise", "record")
"""What may become of an error that is neither of this package nor of arithmetic."""


@dataclass(frozen=True)
class Call:
    """What a sweep calls.

    Attributes
    ----------
    title : name of the function
    ours : the same if it is one of this package, else ""
    dimensions : values of numbers of the case
    options : arguments of the function that do not vary
    arguments : names of all arguments of the function beside the case
    defaults : numbers and words that arguments have that are not named
    over : attributes of arguments of the function that vary, by name
    listed : options that are several values, though the function may take one
    """

    title: str
    ours: str
    dimensions: list[Dimension]
    options: Mapping[str, Any]
    arguments: frozenset[str]
    defaults: Mapping[str, Any]
    over: Mapping[str, Mapping[str, str]]
    listed: Mapping[str, Any]

    def points(self) -> Iterator[dict[str, Any]]:
        """Yield the values of all that varies, by name, at each point; the last dimension varies
        fastest."""
        for parts in product(*(dimension.points() for dimension in self.dimensions)):
            point: dict[str, Any] = {}
            for part in parts:
                point.update(part)
            yield point

    def changes(self, point: Mapping[str, Any]) -> dict[str, Any]:
        """The values of numbers of the case at a point."""
        return {name: value for name, value in point.items() if name not in self.over}

    def varied(self, point: Mapping[str, Any]) -> dict[str, Any]:
        """The values of arguments of the function that vary, at a point."""
        return {name: value for name, value in point.items() if name in self.over}

    def values_of(self, name: str) -> list[Any]:
        """All values that an argument of the function has in the sweep."""
        for dimension in self.dimensions:
            if name in self.over and name in dimension.columns:
                return dimension.columns[name]
        return [{**self.defaults, **self.options}[name]]

    def checked(self, result: Any, variables: Mapping[str, Any]) -> dict[str, Any]:
        """Return the variables of a result without arguments of the function whose names a
        coordinate has; those of branches get other names. Raises `ParameterError`, with the name of
        the function, if there are none, or if one is something else than the argument."""
        if not variables:
            rule = f"returned {as_text(result)}, and {RETURNED}"
            raise ParameterError(Fault((self.title,), "", rule))
        kept = dict(variables)
        taken = {name for dimension in self.dimensions for name in dimension.coordinates}
        for name in taken & kept.keys():
            own = kept.pop(name)
            if self.ours == "continue_cycle":
                kept[name_beside(name)] = own
            elif (self.ours, name) == LIMITED:
                kept[f"{name}_used"] = own.copy()
                kept[f"{name}_used"].attrs = OF_RESULTS["Result"][f"{name}_used"].attributes
            elif name in self.arguments and not {*own.dims} - {name}:
                continue
            elif self.ours:
                kept[f"{self.ours}_{name}"] = own
            else:
                rule = f"returned {name}, which is a coordinate of the sweep: give it another name"
                raise ParameterError(Fault((self.title,), "", rule))
        dims = taken | {dimension.name for dimension in self.dimensions}
        return {name: self._beside(variable, dims) for name, variable in kept.items()}

    def _beside(self, variable: Any, dims: Collection[str]) -> Any:
        """A variable of a result without those of the sweep's dimensions along which it has one
        value, such as a horizon; raises `ParameterError` if it has several."""
        shared = [dim for dim in variable.dims if dim in dims]
        for dim in shared:
            if variable.sizes[dim] > 1:
                rule = f"returned values along {dim}, which is a dimension of the sweep"
                raise ParameterError(Fault((self.title,), "", rule))
        return variable.squeeze(shared)


def are_recorded(errors: Any) -> bool:
    """Whether a sweep goes on after any error; raises `ParameterError`."""
    known = isinstance(errors, str) and errors in ERRORS
    require((known, "errors", errors, rule_of_choice(errors, ERRORS)))
    return bool(errors == "record")


def _is_ours(function: Any) -> bool:
    """Whether this is a function of this package; its module is None in some shells."""
    return str(getattr(function, "__module__", "")).startswith("disc_model.")


def _warn_beside(dimensions: Sequence[Dimension]) -> None:
    """Warn of columns of a table of samples that are no numbers of the case."""
    if beside := " and ".join(name for each in dimensions for name in each.beside):
        text = f"{beside}: no number of the case, kept beside the samples"
        warnings.warn(text, ImplausibleValue, stacklevel=4)


def checked_call(
    function: Any,
    case: Any,
    unnamed: Sequence[Any],
    over: Any,
    zipped: Any,
    named: Mapping[str, Any],
) -> Call:
    """Return the call of a sweep; raises `ParameterError` with all that is wrong with it."""
    rule = "must be a function, such as disc_model.floquet"
    faults = [*foreign_case(case), *violations((callable(function), "function", function, rule))]
    raise_faults(faults)

    title = getattr(function, "__name__", type(function).__name__)
    # what is named is a number of the case, or an argument of the function
    parameters = inspect.signature(function).parameters
    takes_case = any(each.kind in BY_PLACE for each in parameters.values())
    faults += violations((takes_case, "function", function, "must take a case first"))
    named = {**_by_name(title, unnamed, parameters, named, faults), **named}
    raise_faults(faults)
    names = case.numbers.keys() | Parameters.model_fields.keys() | RATIOS.keys()
    numbers = sorted(case.numbers.keys() | RATIOS.keys(), key=str.lower)
    of_case = [name for name in named if name in names and name not in parameters]
    options = {name: value for name, value in named.items() if name not in of_case}
    dimensions = [_dimension(name, named[name], faults) for name in of_case]
    together = []
    taken = {*named, *OF_SWEEPS}
    if zipped is not None:
        known = Known(sorted(names), numbers, of_case, [*parameters][1:])
        samples = zipped_dimension(zipped, known, faults)
        together.append(samples)
        taken.update(samples.coordinates)

    arguments = Arguments(title, title if _is_ours(function) else "", parameters)
    if not arguments.takes_any:
        faults += _unknown(options, parameters, numbers)
    varied: dict[str, list[Any]] = {}
    if over is not None:
        varied = values_over(over, arguments, names, taken, faults)
        dimensions += [Dimension({name: values}) for name, values in varied.items()]

    defaults = _defaults(arguments, named, over, faults)
    raise_faults(faults)
    _warn_beside(together)
    return Call(
        title,
        arguments.ours,
        dimensions + together,
        options,
        frozenset(arguments.names),
        defaults,
        {name: arguments.attributes(name) for name in varied},
        arguments.listed(options),
    )


def _dimension(name: str, values: Any, faults: list[str]) -> Dimension:
    """The dimension of a number of the case; what is wrong with its values is added to the faults."""
    wrong: list[str] = []
    column = checked_values(name, values, wrong)
    faults += wrong or faults_along_axis(name, column)
    return Dimension({name: column})


def _defaults(
    arguments: Arguments, named: Mapping[str, Any], over: Any, faults: list[str]
) -> dict[str, Any]:
    """Numbers and words that arguments have that are not given; those that must be are faults."""
    defaults = {}
    varied = over if isinstance(over, Mapping) else {}
    for name in arguments.names:
        if name in named or name in varied:
            continue
        each = arguments.parameters[name]
        if isinstance(each.default, bool | int | float | str):
            defaults[name] = each.default
        if each.default is each.empty:
            faults.append(Fault((name,), "", f"is required by {arguments.title}"))
    return defaults


def _unknown(
    options: Mapping[str, Any], parameters: Mapping[str, Any], numbers: Sequence[str]
) -> Iterator[Fault]:
    """Yield a fault for each named value that neither the case nor the function has."""
    known = [*[*parameters][1:], *numbers]
    for name in options.keys() - parameters.keys():
        rule = f"is no number of the case, and no argument of the function{suggestion(name, known)}"
        yield Fault.of((name,), options[name], rule)


def _by_name(
    title: str,
    unnamed: Sequence[Any],
    parameters: Mapping[str, inspect.Parameter],
    named: Mapping[str, Any],
    faults: list[str],
) -> dict[str, Any]:
    """Values without a name by those of the function's arguments after the case, which they are in
    turn; what is wrong with them is added to the faults."""
    others = [*parameters][1:]
    arguments = [name for name in others if parameters[name].kind is BY_NAME]
    for value in unnamed[len(arguments) :]:
        rule = f"is one more than the arguments of {title} that have a place"
        faults.append(Fault.of(("function",), value, rule))
    values = dict(zip(arguments, unnamed, strict=False))
    for name in values.keys() & named.keys():
        faults.append(Fault.of((name,), named[name], "is given by its place already"))
    return values
