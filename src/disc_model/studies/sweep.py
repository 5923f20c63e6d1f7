"""Sweeps: any function of a case, called for many cases, with its results in one dataset."""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.columns import result_dataset
from disc_model.data.variables import COMMON, OF_RESULTS, attributes_of_mode
from disc_model.errors import Fault, ParameterError, raise_faults, require, suggestion
from disc_model.mode_units import mode_number_in_si
from disc_model.parameters import PLATE, Parameters, foreign_case
from disc_model.provenance import canonical_json, versions_text
from disc_model.studies.compute import Call, compute, failure, is_of_case, stack
from disc_model.studies.grid import checked_value, expand, records
from disc_model.studies.quantity import NUMERICAL, QUANTITIES
from disc_model.studies.run import coordinate_attributes

Dims = dict[str, pd.DataFrame]


def sweep(
    function: Callable[..., Any],
    case: Parameters,
    *,
    over: Mapping[str, Sequence[Any]] | None = None,
    zip: Mapping[str, Sequence[Any]] | None = None,
    map: Callable[..., Iterable[Any]] = map,
    progress: bool = False,
    **named: Any,
) -> xr.Dataset:
    """Call a function for each combination of values of parameters, and gather the results.

    Parameters
    ----------
    function : one that takes a case first, such as `floquet`, `simulate`, `outcome` or a function of your own
    case : values of all parameters that do not vary
    over : values of arguments of the function that vary, by their names, such as ``{"horizon": [50, 100]}``
    zip : columns of values that vary together, by names of numbers of the case, such as a pandas.DataFrame of cases.
        They are one dimension, whose name joins theirs
    map : who makes the calls: `map` of an executor, such as of concurrent.futures, dask.distributed or mpi4py
    progress : whether a bar on standard error shows how many calls are done
    **named : values of numbers of the case, each of which becomes a dimension; other names are passed to the function

    Returns
    -------
    xarray.Dataset
        Numbers, words and arrays of the results along the dimensions in their order, that of `zip` last. `status` is
        "ok", the result's own status, or "failed" where the function raised an error of this package or of arithmetic,
        and `message` says which. Numbers are nan there, words "". Attributes are the `function`, its other arguments
        (`options`), the case's `parameters`, and the `versions` of what is used

    Raises
    ------
    ParameterError
        If a name is neither a number of the case nor an argument of the function, or a value cannot be; or if the
        function refuses its arguments at the first point that is a case. Points whose numbers break a rule have failed.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> growth = dm.sweep(dm.floquet, case, Omega=[10, 12, 14], mu_k=[0.2, 0.24])
    >>> growth["growth_rate"].dims, growth["growth_rate"].attrs["units"]
    (('Omega', 'mu_k'), 's-1')
    >>> growth["status"].sel(Omega=10).values.tolist()
    ['ok', 'ok']
    >>> pairs = dm.sweep(dm.floquet, case, zip={"N": [385, 300], "Omega": [10, 12]})
    >>> pairs["growth_rate"].sizes, pairs["N"].values
    (Frozen({'N_Omega': 2}), array([385., 300.]))
    """
    raise_faults(foreign_case(case))
    table = isinstance(zip, Mapping | pd.DataFrame | None)
    require(
        (
            callable(function),
            "function",
            function,
            "must be a function, such as disc_model.floquet",
        ),
        (isinstance(over, Mapping | None), "over", over, "must be lists of values by name"),
        (table, "zip", zip, "must be columns by name, or a pandas.DataFrame"),
        (callable(map), "map", map, "must be a function, such as map of an executor"),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
    )
    arguments = dict(inspect.signature(function).parameters)
    arguments.pop(next(iter(arguments), ""), None)
    varied = {name: x for name, x in named.items() if is_of_case(name) and name not in arguments}
    options = {name: x for name, x in named.items() if name not in varied}
    over = {str(name): x for name, x in (over or {}).items()}
    raise_faults([*_unknown(options, arguments)])
    raise_faults([each.inside(("over",)) for each in _unknown(over, arguments)])
    dims = _dimensions(case, varied, zip, over)
    points = expand(dims)
    rows = records(points)

    call = Call(_Gathered(function), case.replace, options)
    _try_first(call, rows, {"function", *arguments, *over})
    results = compute(call, rows, map=map, title=_name_of(function), progress=progress)
    if _name_of(function) == "steady_sliding":
        _number_fastest(call, rows, results)
    sizes = {dim: len(frame) for dim, frame in dims.items()}
    taken = {*map(str, points), *dims}
    results = [_beside(result, taken) for result in results]
    found = stack(results, np.array([*points.index], dtype=int).reshape(len(rows), -1), sizes)
    for name in ("status", "message"):
        found[name].attrs.setdefault("long_name", COMMON[name].long_name)
    defaults = {
        name: x.default
        for name, x in arguments.items()
        if isinstance(x.default, bool | int | float | str)
    }
    used = {**defaults, **options}
    attrs = {
        "function": _name_of(function),
        "options": json.dumps(used, sort_keys=True, default=repr),
        "parameters": case.canonical_json,
        "base": _base(case, function, used),
        "versions": versions_text(),
    }
    return found.assign_coords(_coordinates(dims, over)).assign_attrs(attrs)


class _Gathered:
    """A function whose result is a dataset, with a status and a message."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function

    def __call__(self, case: Parameters, **options: Any) -> xr.Dataset:
        return result_dataset(self.function(case, **options), _name_of(self.function))


def _number_fastest(call: Call, rows: Sequence[Any], results: Sequence[xr.Dataset]) -> None:
    """Add the number of the mode that grows fastest to results of steady sliding, followed from point to point."""
    from disc_model.stability.sliding import follow_modes

    found = [i for i, result in enumerate(results) if result.get("frequency", 0) > 0]
    followed = follow_modes([call.case_at(rows[i]) for i in found])
    for i, one in zip(found, followed, strict=True):
        number = 1 + one.numbers[np.argmax(one.modes.growth_rate)]
        results[i]["mode"] = ((), float(number), OF_RESULTS["SteadySliding"]["mode"].texts())


def _name_of(function: Any) -> str:
    return str(getattr(function, "__name__", type(function).__name__))


def _unknown(names: Iterable[str], arguments: Mapping[str, inspect.Parameter]) -> Iterable[Fault]:
    """Faults of names that neither the case nor the function has."""
    if any(x.kind is x.VAR_KEYWORD for x in arguments.values()):
        return
    known = [*arguments, *Parameters.model_fields]
    for name in names:
        if name not in arguments:
            rule = f"is no number of the case, and no argument of the function{suggestion(name, known)}"
            yield Fault((name,), "", rule)


def _dimensions(
    case: Parameters, varied: Mapping[str, Any], zipped: Any, over: Mapping[str, Sequence[Any]]
) -> Dims:
    """The columns of each dimension by its name; raises `ParameterError`."""
    faults: list[Fault] = []
    dims = {
        name: pd.DataFrame({name: _column(name, values, case, faults)})
        for name, values in varied.items()
    }
    dims |= {
        name: pd.DataFrame({name: pd.Series([*values], dtype=object)})
        for name, values in over.items()
    }
    if zipped is not None:
        wrong: list[Fault] = []
        columns = {str(name): _column(str(name), zipped[name], case, wrong) for name in zipped}
        faults += [each.inside(("zip",)) for each in wrong]
        lengths = {*map(len, columns.values())}
        if len(lengths) != 1:
            faults.append(
                Fault(("zip",), "", "must have columns of equal length, and at least one")
            )
        else:
            dims["_".join(columns)] = pd.DataFrame(columns)
    if not dims:
        faults.append(Fault(("sweep",), "", "needs values that vary, such as Omega=[10, 12]"))
    raise_faults(faults)
    return dims


def _column(name: str, values: Any, case: Parameters, faults: list[Fault]) -> list[Any]:
    """Values of a number of the case, in SI units; what is wrong with them is added to the faults."""
    if isinstance(values, str) or np.ndim(values) != 1 or len(values) == 0:
        faults.append(Fault.of((name,), values, "must be a list of values"))
        return []
    known = name in Parameters.model_fields or name in case.numbers
    if not known:
        faults.append(
            Fault.of((name,), values, f"is no number of the case{suggestion(name, case.numbers)}")
        )
    column = []
    for i, value in enumerate(values):
        try:
            plain = value.item() if isinstance(value, np.generic) else value
            checked = _in_si(name, plain) if isinstance(plain, str) else plain
            column.append(float(checked) if isinstance(checked, int | float) else checked)
        except ParameterError as error:
            faults += [each.inside((f"{name}[{i}]",)) for each in error.faults]
    return column


def _in_si(name: str, text: str) -> Any:
    """A value that is a text, in SI units; raises `ParameterError`."""
    if name in Parameters.model_fields:
        return checked_value(name, text)
    faults: list[Fault] = []
    value = mode_number_in_si(name, text, faults)
    raise_faults([Fault.of((), text, each.rule) for each in faults])
    return value


def _try_first(call: Call, rows: Sequence[Mapping[str, Any]], arguments: set[str]) -> None:
    """Call the function at the first point that is a case, and raise what it says of its arguments."""
    first: Exception | None = None
    for row in rows:
        try:
            case = call.case_at(row)
        except NUMERICAL as error:
            first = first or error
            continue
        try:
            call.function(case, **call.options_at(row))
        except ParameterError as error:
            if any(fault.path and fault.path[0] in arguments for fault in error.faults):
                raise
        except NUMERICAL:
            pass
        return
    raise ParameterError(f"no point of the sweep makes a case: {first}")


def _beside(result: xr.Dataset, taken: set[str]) -> xr.Dataset:
    """A result without variables and dimensions of one value that the sweep has itself."""
    shared = [dim for dim in result.dims if dim in taken]
    for dim in shared:
        if result.sizes[dim] > 1:
            rule = f"returned values along {dim}, which is a dimension of the sweep"
            return failure(ParameterError(Fault(("function",), "", rule)))
    own = [name for name in result.variables if name in taken]
    return result.squeeze(shared, drop=True).drop_vars(own, errors="ignore")


def _base(case: Parameters, function: Any, options: Mapping[str, Any]) -> str:
    """What the case states, in JSON, but for what the function varies by itself."""
    without = {str(options.get("name", ""))}
    if (name := _name_of(function)) in QUANTITIES:
        without |= {str(options.get(own, own)) for own in QUANTITIES[name].own}
    if case.disc is not None:
        without.update(PLATE)
    return canonical_json({name: x for name, x in case.canonical.items() if name not in without})


def _coordinates(dims: Dims, over: Mapping[str, Any]) -> dict[str, Any]:
    """Values and attributes of all that varies, along their dimensions; mappings are words."""
    coordinates: dict[str, Any] = {}
    for dim, frame in dims.items():
        for name, column in frame.items():
            values = [*column]
            attrs: dict[str, Any] = {}
            if name in over:
                plain = all(isinstance(value, int | float | str) for value in values)
                values = values if plain else [*map(str, values)]
            else:
                of_case = name in Parameters.model_fields
                attrs = (
                    coordinate_attributes(str(name)) if of_case else attributes_of_mode(str(name))
                )
            coordinates[str(name)] = (dim, values, attrs)
    return coordinates
