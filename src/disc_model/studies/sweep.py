"""Sweeps: any function of a case, called for many cases, with its results in one dataset."""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from xarray import Dataset

from disc_model.data.columns import result_dataset
from disc_model.data.variables import COMMON, OF_RESULTS
from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.parameters import Parameters, require_case
from disc_model.provenance import versions_text
from disc_model.studies.compute import Call, Map, compute, stack
from disc_model.studies.grid import Points, expand
from disc_model.studies.quantity import Row
from disc_model.units import in_si, is_number


def sweep(
    function: Callable[..., Any],
    case: Parameters,
    *,
    over: Mapping[str, Sequence[Any]] | None = None,
    zip: Mapping[str, Sequence[Any]] | None = None,
    map: Map = map,
    progress: bool = False,
    **named: Any,
) -> Dataset:
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
        function refuses its arguments, or the numbers break a rule, at all points. Otherwise such points have failed.

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
    require_case(case)
    over = dict(over or {})
    arguments = inspect.signature(function).parameters.keys()
    numbers = Parameters.model_fields.keys() - arguments
    varied = {name: x for name, x in named.items() if name in numbers}
    options = {name: x for name, x in named.items() if name not in varied}
    used = _checked_arguments(function, case, {**options, **over})
    dims = _dimensions(varied, dict({} if zip is None else zip), over)
    points = expand(dims)
    name = str(getattr(function, "__name__", type(function).__name__))
    call = Call(partial(_gathered, function, name, {*points, *dims}), case.replace, options)
    rows: Points = points.to_dict("records")
    results = compute(call, rows, map=map, title=name, progress=progress)
    messages = [str(result["message"].values) for result in results]
    if all(text.startswith("ParameterError") for text in messages):
        raise ParameterError(f"no point of the sweep has a result: {messages[0]}")
    if name == "steady_sliding":
        _number_fastest(case, rows, results)
    found = stack(results, dims)
    for said in ("status", "message"):
        found[said].attrs.setdefault("long_name", COMMON[said].long_name)
    return found.assign_attrs(
        function=name,
        options=json.dumps(used | options, sort_keys=True, default=repr),
        parameters=case.canonical_json,
        versions=versions_text(),
    )


def _checked_arguments(function: Callable[..., Any], case: Parameters, given: Row) -> Row:
    """Arguments of a function that are numbers or words, with those that it has by default; raises
    `ParameterError` for what is none."""
    signature = inspect.signature(function)
    try:
        bound = signature.bind(case, **given)
    except TypeError as error:
        known = [*signature.parameters, *Parameters.model_fields]
        rule = "is no number of the case, and no argument of the function"
        unknown: list[Any] = [
            Fault((x,), "", rule + suggestion(x, known)) for x in given if x not in known
        ]
        raise ParameterError(*(unknown or [str(error)])) from None
    bound.apply_defaults()
    return {x: y for x, y in bound.arguments.items() if isinstance(y, bool | int | float | str)}


def _number_fastest(case: Parameters, rows: Points, results: Sequence[Dataset]) -> None:
    """Add the number of the mode that grows fastest to results of steady sliding, followed from point to point."""
    from disc_model.stability.sliding import follow_modes

    swings = [i for i, result in enumerate(results) if result.get("frequency", 0) > 0]
    followed = follow_modes([case.replace(**rows[i]) for i in swings])
    for i, one in zip(swings, followed, strict=True):
        number = 1 + one.numbers[np.argmax(one.modes.growth_rate)]
        results[i]["mode"] = ((), float(number), OF_RESULTS["SteadySliding"]["mode"].texts())


def _gathered(
    function: Callable[..., Any], name: str, taken: set[str], case: Parameters, /, **options: Any
) -> Dataset:
    """What a function returns, as a dataset without variables that the sweep has itself."""
    result = result_dataset(function(case, **options), name)
    shared = taken.intersection(map(str, result.dims))
    rule = f"returned values along {', '.join(shared)}, which the sweep varies"
    require((not shared, "function", "", rule))
    return result.drop_vars(taken, errors="ignore")


def _dimensions(varied: Row, zipped: Mapping[Any, Any], over: Row) -> dict[str, pd.DataFrame]:
    """The columns of each dimension by its name; raises `ParameterError`."""
    dims = {name: pd.DataFrame({name: _column(name, x)}) for name, x in varied.items()}
    dims |= {name: pd.DataFrame({name: pd.Series([*x], dtype=object)}) for name, x in over.items()}
    columns = {str(name): _column(str(name), x) for name, x in zipped.items()}
    if columns:
        try:
            dims["_".join(columns)] = pd.DataFrame(columns)
        except ValueError as error:  # of columns whose lengths differ
            raise ParameterError(Fault(("zip",), "", str(error))) from None
    require((dims, "sweep", "", "needs values that vary, such as Omega=[10, 12]"))
    return dims


def _column(name: str, values: Any) -> list[Any]:
    """Values of a number of the case, in SI units; raises `ParameterError`."""
    known = Parameters.model_fields
    several = not isinstance(values, str) and np.ndim(values) == 1 and len(values) > 0
    require(
        (several, name, values, "must be a list of values"),
        (name in known, name, values, f"is no number of the case{suggestion(name, known)}"),
    )
    given = np.asarray(values, dtype=object).tolist()
    column = in_si(given, Parameters.unit(name), name)
    return [float(value) if is_number(value) else value for value in column]
