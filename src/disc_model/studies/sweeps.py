"""Sweeps: any function of a case, called for many cases, with its results in one dataset."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from pydantic import create_model

from disc_model.errors import Fault, ParameterError, raise_faults, suggestion, violations
from disc_model.parameters import RATIOS, Disc, Parameters, foreign_case
from disc_model.simulation.case import SomeParameters
from disc_model.studies.gathering import stacked, variables_of_result
from disc_model.studies.quantity import NUMERICAL
from disc_model.studies.run import describe
from disc_model.studies.workers import checked_workers
from disc_model.units import Finite, Strict, canonical_json


def sweep(
    function: Callable[..., Any],
    case: Parameters,
    *,
    zip: Mapping[str, Any] | None = None,
    workers: int = 1,
    processes: bool = False,
    executor: Any = None,
    progress: bool = False,
    **named: Any,
) -> xr.Dataset:
    """Call a function for each combination of values of parameters, and gather the results.

    `disc_model.save` writes the results to a file.

    Parameters
    ----------
    function : one that takes a case first, such as `floquet`, `simulate`, `outcome` or a function of your own
    case : values of all parameters that do not vary
    zip : columns of values that vary together, by the names of numbers of the case, such as paired samples or a
        pandas.DataFrame of cases. They are one dimension, whose name joins theirs
    workers : number of calls at a time; compiled code runs beside other threads
    processes : whether they are processes instead of threads: the function must then be importable
    executor : who makes the calls instead: any object with the method `submit` of `concurrent.futures.Executor`, such
        as an executor of mpi4py or a client of dask.distributed, or with `map`
    progress : whether a bar on standard error shows how many calls are done
    **named : values of numbers of the case, each of which becomes a dimension; other names are passed to the function

    Returns
    -------
    xarray.Dataset
        Numbers, words and arrays of the results along the dimensions in their order, that of `zip` last. `status` is
        "ok", the result's own status, or "failed" where the function raised an error of this package or of arithmetic;
        `message` then says which

    Raises
    ------
    ParameterError
        If `case` is no case, a name is neither a number of it nor an argument of the function, or a value breaks a rule
        by itself; and if an argument of the function is missing, or refused at the first point. Where values of the
        case break a rule together, the point has failed.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> growth = dm.sweep(dm.floquet, case, Omega=[10, 12, 14], mu_k_over_mu_s=[0.5, 0.6], workers=2)
    >>> growth["growth_rate"].dims, growth["growth_rate"].attrs["units"]
    (('Omega', 'mu_k_over_mu_s'), 's-1')
    >>> growth["status"].sel(Omega=10).values.tolist()
    ['ok', 'ok']
    >>> pairs = dm.sweep(dm.floquet, case, zip={"N": [385, 300], "Omega": [10, 12]})
    >>> pairs["growth_rate"].sizes, pairs["N"].values
    (Frozen({'N_Omega': 2}), array([385., 300.]))
    """
    call = _checked_call(function, case, zip, named)
    calls = checked_workers(workers, processes, executor, progress)
    row = partial(_row, partial(function, **call.options), case, call.arguments)
    rows = calls.results(row, [*enumerate(call.points())], call.title)

    coordinates: dict[str, Any] = {}
    for dimension in call.dimensions:
        for name, values in dimension.columns.items():
            coordinates[name] = (dimension.name, _plain(values), _described(name))
    sizes = {dimension.name: len(dimension) for dimension in call.dimensions}
    variables, fixed = stacked(rows, sizes)
    base = canonical_json({**case.stated, "disc": case.canonical.get("disc")})
    attrs = {"function": call.title, "parameters": case.canonical_json, "base": base}
    return xr.Dataset(variables, {**fixed, **coordinates}, attrs)


def _plain(values: list[Any]) -> list[Any]:
    """The values of a coordinate, whole numbers as floats."""
    return [float(value) if isinstance(value, int) else value for value in values]


def _described(name: str) -> dict[str, Any]:
    """Attributes of a coordinate; numbers of a disc's modes have none."""
    if name in (*Parameters.model_fields, *RATIOS):
        return describe(name)
    return {}


@dataclass(frozen=True)
class _Dimension:
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
class _Call:
    """What a sweep calls.

    Attributes
    ----------
    title : name of the function
    dimensions : values of numbers of the case
    options : arguments of the function that do not vary
    arguments : names of all arguments of the function beside the case
    """

    title: str
    dimensions: list[_Dimension]
    options: Mapping[str, Any]
    arguments: frozenset[str]

    def points(self) -> Iterator[dict[str, Any]]:
        """Yield the values of all that varies, by name, at each point; the last dimension varies
        fastest."""
        for parts in product(*(dimension.points() for dimension in self.dimensions)):
            point: dict[str, Any] = {}
            for part in parts:
                point.update(part)
            yield point


def _checked_call(function: Any, case: Any, zipped: Any, named: Mapping[str, Any]) -> _Call:
    """Return the call of a sweep; raises `ParameterError` with all that is wrong with it."""
    rule = "must be a function, such as disc_model.floquet"
    faults = [
        *foreign_case(case, "case"),
        *violations((callable(function), "function", function, rule)),
    ]
    raise_faults(faults)

    # what is named is a number of the case, or an argument of the function
    parameters = inspect.signature(function).parameters
    numbers = case.numbers.keys() | Parameters.model_fields.keys() | RATIOS.keys()
    dimensions = []
    options = {}
    for name, value in named.items():
        if name in numbers and name not in parameters:
            dimensions.append(_Dimension({name: _values(name, value, faults)}))
        else:
            options[name] = value
    if zipped is not None:
        alone = [dimension.name for dimension in dimensions]
        dimensions.append(_Dimension(_zipped_columns(zipped, numbers, alone, faults)))

    takes_all = any(each.kind is each.VAR_KEYWORD for each in parameters.values())
    if not takes_all:
        for name in options.keys() - parameters.keys():
            rule = "is no number of the case, and no argument of the function"
            told = suggestion(name, case.numbers)
            faults.append(Fault.of((name,), named[name], f"{rule}{told}"))

    title = getattr(function, "__name__", type(function).__name__)
    arguments = []
    for each in [*parameters.values()][1:]:
        if each.kind in (each.VAR_POSITIONAL, each.VAR_KEYWORD):
            continue
        arguments.append(each.name)
        if each.default is each.empty and each.name not in named:
            faults.append(Fault((each.name,), "", f"is required by {title}"))
    raise_faults(faults)
    return _Call(title, dimensions, options, frozenset(arguments))


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


def _row(
    function: Any, case: Parameters, names: frozenset[str], numbered: tuple[int, Any]
) -> dict[str, xr.Variable]:
    """The variables of one call; a fault of the function's own arguments at the first point is that
    of all."""
    number, point = numbered
    try:
        result = function(case.replace(**point))
    except NUMERICAL as error:
        refused = {re.split(r"\W", fault)[0] for fault in getattr(error, "faults", ())}
        if number == 0 and names & refused:
            raise
        return {
            "status": xr.Variable((), "failed"),
            "message": xr.Variable((), f"{type(error).__name__}: {error}"),
        }
    if isinstance(result, xr.Dataset):  # whose attributes are also those of the object
        status = "ok"
        message = result.attrs.get("message", "")
    else:
        status = str(getattr(result, "status", "ok"))
        message = getattr(result, "message", "")
    words = {"status": xr.Variable((), status), "message": xr.Variable((), message)}
    return {**words, **variables_of_result(result)}
