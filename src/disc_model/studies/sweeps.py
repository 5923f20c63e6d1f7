"""Sweeps: any function of a case, called for many cases, with its results in one dataset."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import xarray as xr

from disc_model.data.variables import COMMON, WITHOUT_EFFECT, attributes_of_mode, message_of
from disc_model.errors import Fault, ParameterError, raise_faults
from disc_model.hashing import canonical_json
from disc_model.parameters import PLATE, RATIOS, Parameters
from disc_model.sources import versions_text
from disc_model.studies.calls import Call, are_recorded, checked_call
from disc_model.studies.gathering import variables_of_result
from disc_model.studies.quantity import NUMERICAL
from disc_model.studies.registry import quantity_names, quantity_of
from disc_model.studies.run import describe
from disc_model.studies.samples import OF_SWEEPS
from disc_model.studies.stacking import stacked
from disc_model.studies.varied_arguments import hint_of_lists, values_along
from disc_model.studies.workers import checked_workers

FAILED = "failed"  # status of a point whose call raised an error
RECORD = 'with errors="record" a sweep goes on after such an error'
OWN = "sweep a function of your own that calls {} and returns numbers of {}"
WITHOUT_SAMPLES = f"a sweep keeps no samples: {OWN.format('simulate', 'them')}"
WITHOUT_RESULT = {
    "neutral_curves": f"a sweep keeps no curves: {OWN.format('it', 'them')}",
    "fit": f"a sweep keeps no fitted parameters: {OWN.format('it', 'them')}",
}
"""Functions of this package whose results a sweep would leave out, and what to do instead."""


def sweep(  # noqa: PLR0913
    function: Callable[..., Any],
    case: Parameters,
    *unnamed: Any,
    over: Mapping[str, Any] | None = None,
    zip: Mapping[str, Any] | None = None,
    workers: int = 1,
    processes: bool = False,
    executor: Any = None,
    progress: bool = False,
    errors: str = "raise",
    **named: Any,
) -> xr.Dataset:
    """Call a function for each combination of values of parameters, and gather the results.

    `disc_model.save` writes the results to a file.

    Parameters
    ----------
    function : one that takes a case first, such as `floquet`, `simulate`, `outcome` or a function of your own
    case : values of all parameters that do not vary
    *unnamed : further arguments of the function in their order, as after the case in its own call:
        ``sweep(simulate, case, 60)`` is ``sweep(simulate, case, t_end=60)``
    over : values of arguments of the function that vary, by their names, such as ``{"horizon": [50, 100]}``: numbers,
        words, or mappings and lists such as starts and bounds, for which words stand along the dimension. Each is one,
        after those of the case
    zip : columns of values that vary together, by names of numbers of the case, such as a pandas.DataFrame of cases.
        They are one dimension, whose name joins theirs. Columns of words or numbers under other names are
        coordinates along it: a warning says that such numbers have no effect, and a name like a known one is refused
    workers : number of calls at a time, in threads. They pay for `simulate` over a minute or more; `floquet`,
        `outcome`, `critical` and `lyapunov_exponents` are little faster so, or slower: use `processes`
    processes : whether they are processes instead: the function must then be importable. They pay from half a second of
        work on; where processes are not forked (macOS, Windows), each first takes some seconds
    executor : who makes the calls instead: any object with the method `submit` of `concurrent.futures.Executor`, such
        as an executor of mpi4py or a client of dask.distributed, or with `map`
    progress : whether a bar on standard error shows how many calls are done
    errors : "raise" to end the sweep at an error of the function that is neither of this package nor of arithmetic, or
        "record" to go on: the point has then failed, and `message` names the error
    **named : values of numbers of the case, each of which becomes a dimension; other names are passed to the function

    Returns
    -------
    xarray.Dataset
        Numbers, words and arrays of the results along the dimensions in their order, that of `zip` last. `status` is
        "ok", the result's own status, or "failed" where the function raised an error of this package or of arithmetic
        (any error if `errors` is "record"), or returned nothing; `message` then says which, and is "" elsewhere.
        Numbers are nan there, words "", whole numbers are real ones, and a variable of True and False, such as
        `stable`, consists of 1, 0 and nan: select by ``found["stable"] == 1``. Attributes are the `function`, its other
        arguments (`options`), the case's `parameters`, and the `versions` of what is used; the last three are in JSON

    Raises
    ------
    ParameterError
        If `case` is no case, a name is neither a number of it nor an argument of the function, a value is no number, an
        axis has a value twice or one that is nan or infinite, columns differ in length, or no value of an axis or
        column can be; the message names the row, counted from 0, as in ``zip.N[1]=-1``. If no point makes a case. If
        the function would compute what a sweep leaves out, as `neutral_curves`, `fit`, and `simulate` with `windows`
        do. And if an argument of the function is missing, or refused at the first point that is a case, or the function
        returns nothing there. Where numbers of the case break a rule, such as a load below zero or nan for an empty
        cell of a table, the point has failed. Any other error of the function ends the sweep, with a note of what
        varies at the point, unless `errors` is "record".

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> growth = dm.sweep(dm.floquet, case, Omega=[10, 12, 14], mu_k=[0.2, 0.24], workers=2)
    >>> growth["growth_rate"].dims, growth["growth_rate"].attrs["units"]
    (('Omega', 'mu_k'), 's-1')
    >>> growth["status"].sel(Omega=10).values.tolist()
    ['ok', 'ok']
    >>> pairs = dm.sweep(dm.floquet, case, zip={"N": [385, 300], "Omega": [10, 12]})
    >>> pairs["growth_rate"].sizes, pairs["N"].values
    (Frozen({'N_Omega': 2}), array([385., 300.]))
    """
    call = checked_call(function, case, unnamed, over, zip, named)
    calls = checked_workers(workers, processes, executor, progress)
    searched = _searched(call)
    _refuse_searched(call, searched)
    _refuse_what_is_left_out(call)
    records = are_recorded(errors)
    points = [*call.points()]
    first = _first_possible(case, call, points)
    row = partial(_row, partial(function, **call.options), case, call, records)
    numbered = [(number == first, point) for number, point in enumerate(points)]
    rows = calls.results(row, numbered, call.title)

    sizes = {dimension.name: len(dimension) for dimension in call.dimensions}
    variables, fixed = stacked(rows, sizes)
    for name in OF_SWEEPS:
        variables[name].attrs.setdefault("long_name", COMMON[name].long_name)
    attrs = {
        "function": call.title,
        "options": json.dumps({**call.defaults, **call.options}, sort_keys=True, default=repr),
        "parameters": case.canonical_json,
        "base": _base(case, searched),
        "versions": versions_text(),
    }
    return xr.Dataset(variables, {**fixed, **_coordinates(call)}, attrs)


def _base(case: Parameters, searched: set[str]) -> str:
    """What the case states, in JSON, but for what the function varies by itself."""
    stated = {**case.stated, "disc": case.canonical.get("disc")}
    without = {*searched, *(PLATE if case.disc is not None else ())}
    return canonical_json({name: x for name, x in stated.items() if name not in without})


def _refuse_searched(call: Call, searched: set[str]) -> None:
    """Raise `ParameterError` where what the function varies by itself is swept."""
    swept = [name for dimension in call.dimensions for name in dimension.columns]
    rule = f"must not be swept, because {call.title} searches along it"
    raise_faults([Fault((name,), "", rule) for name in swept if name in searched])


def _refuse_what_is_left_out(call: Call) -> None:
    """Raise `ParameterError` where a function of this package would compute what a sweep leaves
    out."""
    if call.ours in WITHOUT_RESULT:
        raise ParameterError(Fault(("function",), call.ours, WITHOUT_RESULT[call.ours]))
    windows = call.options.get("windows")
    if call.ours == "simulate" and windows:
        raise ParameterError(Fault.of(("windows",), windows, WITHOUT_SAMPLES))


def _searched(call: Call) -> set[str]:
    """Parameters that a function of this package varies by itself, so that their values in the case
    mean nothing: of `critical`, `continue_cycle` and `hysteresis` the one along which they go, of a quantity
    those of its scan."""
    if call.ours in ("critical", "continue_cycle", "hysteresis"):
        return {name for name in call.values_of("name") if isinstance(name, str)}
    if call.ours in quantity_names():
        return {*quantity_of(call.ours).scans}
    return set()


def _coordinates(call: Call) -> dict[str, Any]:
    """Values and attributes of all that varies, and labels of points, along their dimensions."""
    coordinates: dict[str, Any] = {}
    for dimension in call.dimensions:
        for name, values in dimension.columns.items():
            if name in call.over:
                shown = values_along(values)
                attributes = dict(call.over[name])
                if any(isinstance(each, str) for each in shown):
                    attributes.pop("units", None)
                coordinates[name] = (dimension.name, shown, attributes)
            else:
                coordinates[name] = (dimension.name, _plain(values), _described(name))
        for name, words in dimension.labels.items():
            coordinates[name] = (dimension.name, words)
        for name, numbers in dimension.beside.items():
            coordinates[name] = (dimension.name, numbers, WITHOUT_EFFECT)
    return coordinates


def _plain(values: list[Any]) -> list[Any]:
    """The values of a coordinate, whole numbers as floats."""
    return [float(value) if isinstance(value, int) else value for value in values]


def _described(name: str) -> dict[str, Any]:
    """Attributes of a coordinate: a parameter, a ratio, or a number of one of a disc's modes."""
    if name in (*Parameters.model_fields, *RATIOS):
        return describe(name)
    return attributes_of_mode(name)


def _first_possible(case: Parameters, call: Call, points: Sequence[Mapping[str, Any]]) -> int:
    """The number of the first point whose values make a case; raises `ParameterError`, with what is
    wrong at the first point, if none does."""
    faults = []
    for number, point in enumerate(points):
        try:
            case.replace(**call.changes(point))
        except NUMERICAL as error:
            faults.append(error)
            continue
        return number
    place = _place(call.changes(points[0]))
    raise ParameterError(f"no point of the sweep makes a case: at the first, {place}: {faults[0]}")


def _place(point: Mapping[str, Any]) -> str:
    """What varies at a point, in words."""
    return ", ".join(f"{name}={value!r}" for name, value in point.items())


def _called(function: Any, case: Parameters, call: Call, point: Mapping[str, Any]) -> Any:
    """The result of a function for one point; an error that ends the sweep has a note of the point."""
    try:
        return function(case.replace(**call.changes(point)), **call.varied(point))
    except NUMERICAL:
        raise
    except Exception as error:
        error.add_note(f"at the point {_place(point)} of the sweep; {RECORD}")
        if call.listed:
            error.add_note(hint_of_lists(call.listed))
        raise


def _with_hint(error: Exception, call: Call) -> Exception:
    """The error of wrong arguments, of which lists may be meant to vary."""
    if not call.listed:
        return error
    faults = []
    for fault in getattr(error, "faults", ()):
        rule = fault.rule
        if len(fault.path) == 1 and fault.path[0] in call.listed:
            rule = f"{rule}; {hint_of_lists({fault.path[0]: None})}"
        faults.append(Fault(fault.path, fault.value, rule))
    return ParameterError(*faults)


def _row(
    function: Any, case: Parameters, call: Call, records: bool, numbered: tuple[bool, Any]
) -> dict[str, xr.Variable]:
    """The variables of one call; what the function is wrongly given or returns at the first point that
    is a case, which is said with the point, is a fault of all."""
    is_first, point = numbered
    try:
        result = _called(function, case, call, point)
    except NUMERICAL as error:
        refused = {re.split(r"\W", fault)[0] for fault in getattr(error, "faults", ())}
        if is_first and call.arguments & refused:
            raise _with_hint(error, call) from None
        return _failure(error)
    except Exception as error:
        if records:
            return _failure(error)
        raise
    try:
        variables = call.checked(result, variables_of_result(result, call.ours))
    except NUMERICAL as error:
        if is_first:
            raise
        return _failure(error)
    if isinstance(result, xr.Dataset):  # whose attributes are also those of the object
        status = "ok"
        message = result.attrs.get("message", "")
    else:
        status = str(getattr(result, "status", "ok"))
        message = message_of(result)
    words = {"status": xr.Variable((), status), "message": xr.Variable((), message)}
    return {**words, **variables}


def _failure(error: Exception) -> dict[str, xr.Variable]:
    """The variables of a point that failed."""
    return {
        "status": xr.Variable((), FAILED),
        "message": xr.Variable((), f"{type(error).__name__}: {error}"),
    }
