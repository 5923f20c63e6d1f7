"""What studies compute, as functions: a quantity of one case, a sweep of any function, and a whole
study."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import fields, is_dataclass
from functools import cache, partial
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import create_model

from disc_model.data.variables import SCALARS, Variable, flag_names
from disc_model.errors import Fault, ParameterError, raise_faults, require, suggestion, violations
from disc_model.hashing import canonical_json
from disc_model.mode_choice import choose_when_run
from disc_model.parameters import RATIOS, Disc, Parameters, foreign_case
from disc_model.simulation.case import SomeParameters, Start
from disc_model.simulation.named_case import run_case
from disc_model.simulation.result import Result
from disc_model.studies.merge import merge_batches, merge_cases
from disc_model.studies.quantity import NUMERICAL, Point
from disc_model.studies.registry import quantity_names, quantity_of
from disc_model.studies.run import POINT, coordinates_of, describe, run_batch, variables_of
from disc_model.units import Finite, Strict, is_whole

# ---- Quantities of one case


ARGUMENTS = {"perturbation": "start", "horizons": "horizon"}
"""Arguments of functions for options of other names."""


def _quantity(
    name: str,
    case: Parameters,
    options: Mapping[str, Any],
    start: Mapping[str, float] | None = None,
) -> xr.Dataset:
    """Compute a quantity of a case.

    Parameters
    ----------
    name, options : of the quantity
    case : the case
    start : perturbations of the static start by name

    Returns
    -------
    xarray.Dataset
        Its variables, flags as words; what went wrong is the attribute `message`
    """
    faults = foreign_case(case, "case")
    try:
        begin = Start.model_validate({} if start is None else {"perturbation": start})
        quantity = quantity_of(name).model_validate(options)
    except ParameterError as error:
        for fault in error.faults:
            path = tuple(ARGUMENTS.get(part, part) for part in fault.path)
            faults.append(Fault(path, fault.value, fault.rule))
    raise_faults(faults)

    row, message = quantity.compute_point(Point(case, begin))
    coordinates = coordinates_of(quantity.COORDINATES, quantity)
    columns = variables_of(quantity.COLUMNS, coordinates, [row], {POINT: 1})
    attrs = {"parameters": case.canonical_json, "message": message}
    dataset = xr.Dataset(columns, coordinates, attrs).isel({POINT: 0})
    for flag in [flag for flag, variable in dataset.items() if "flag_meanings" in variable.attrs]:
        words = flag_names(dataset[flag])
        dataset[flag] = (dataset[flag].dims, words, {"long_name": dataset[flag].attrs["long_name"]})
    return dataset


def _scan(ends: Any, step: Any) -> Any:
    """The range of a scan as an option of a quantity, which says what is wrong with it."""
    require(
        (
            np.shape(ends) == (2,),
            "scan",
            ends,
            "must be two numbers in rad/s, the lowest and the highest speed",
        )
    )
    return {"start": ends[0], "stop": ends[1], "step": step}


def outcome(
    case: Parameters,
    horizon: float | str = 1000.0,
    *,
    start: Mapping[str, float] | None = None,
    evaluation_time: float = 1.0,
    after_separation: float = 5.0,
    early_end: bool = True,
    tol: float = 1e-10,
) -> xr.Dataset:
    """Long-term behaviour within a horizon, such as "quiet" or "separation", with ranges and phases
    late in the run.

    Parameters
    ----------
    case : the case
    horizon : s
    start : perturbations of the static start by name: u (m), u_velocity (m/s), f (rad/s)
    evaluation_time : s, length of the last stretch, over which ranges and shares of the phases are taken
    after_separation : s, simulated after the first separation, so that the stretch shows the motion it leads to
    early_end : whether the simulation ends once a stable cycle or steady sliding is shown to be reached
    tol : as in `simulate`

    Returns
    -------
    xarray.Dataset
        `outcome`, `first_separation` (s), and the stretch: P_min, P_max (N), u_min, u_max (m), stick_fraction, ...

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> reached = dm.outcome(dm.Parameters(N=385, Omega=15.1), 100)
    >>> print(reached["outcome"].item(), f"{reached['first_separation'].item():.1f} s")
    separation 54.4 s
    """
    options = {
        "horizon": horizon,
        "evaluation_time": evaluation_time,
        "after_separation": after_separation,
        "early_end": early_end,
        "tol": tol,
    }
    return _quantity("outcome", case, options, start)


def critical_speed(
    case: Parameters,
    scan: tuple[float, float] = (5.0, 30.0),
    horizon: float | Sequence[float] = 1000.0,
    *,
    step: float = 1.0,
    precision: float = 0.1,
    early_end: bool = True,
    tol: float = 1e-10,
) -> xr.Dataset:
    """The lowest speed of a scan with separation within a horizon, and all speeds where separation
    begins or ends.

    Separation in a range of speeds narrower than `step` can be overlooked.

    Parameters
    ----------
    case : the case; its own speed is not used
    scan : rad/s, the lowest and the highest speed
    horizon : s, or several, each with a critical speed of its own
    step : rad/s, of the scan
    precision : rad/s, to which crossings are bisected; `step` must be a multiple
    early_end, tol : as in `outcome`

    Returns
    -------
    xarray.Dataset
        `critical_speed` (rad/s, nan if there is none) and crossings by horizon; first separations along the scan

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> speeds = dm.critical_speed(dm.Parameters(N=385, Omega=15), (15, 16), 100, step=0.5)
    >>> speeds["critical_speed"].values
    array([15.1])
    """
    options: dict[str, Any] = {
        "horizons": np.atleast_1d(horizon).tolist(),
        "scan": _scan(scan, step),
        "precision": precision,
        "early_end": early_end,
        "tol": tol,
    }
    return _quantity("critical_speed", case, options)


def basins(  # noqa: PLR0913
    case: Parameters,
    energies: Sequence[float] = (0.0,),
    n_starts: int = 1,
    *,
    start: Mapping[str, float] | None = None,
    horizon: float | str = 200.0,
    seed: int = 1,
    attractor_tol: float = 0.1,
    n_bisection_directions: int = 1,
    tol: float = 1e-10,
) -> xr.Dataset:
    """Attractors of a case, the share of starts that comes to each, and the least energy that leads
    to separation.

    Parameters
    ----------
    case : the case
    energies : J, of perturbations of the start in random directions, ascending
    n_starts : number of starts at each energy
    start : as in `outcome`
    horizon : s, longest simulated time of a motion
    seed : whole number that determines the directions
    attractor_tol : relative difference of ranges at which a motion counts as having come to a known attractor; 0 to
        follow each to the horizon
    n_bisection_directions : number of directions in which the critical energy is bisected
    tol : as in `simulate`

    Returns
    -------
    xarray.Dataset
        `basin_fraction` by class of attractor with its confidence interval, `critical_energy` (J), and the attractors

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> found = dm.basins(dm.Parameters(N=385, Omega=14), [1e-4, 0.1], 3, horizon=60)
    >>> found["kind"].values.tolist()
    [['quiet', 'quiet', 'quiet'], ['separating', 'separating', 'separating']]
    >>> axes = dm.plot_sweep(found)
    """
    options: dict[str, Any] = {
        "energies": np.atleast_1d(energies).tolist(),
        "n_starts": n_starts,
        "horizon": horizon,
        "seed": seed,
        "attractor_tol": attractor_tol,
        "n_bisection_directions": n_bisection_directions,
        "tol": tol,
    }
    return _quantity("basins", case, options, start)


def hysteresis(
    case: Parameters,
    scan: tuple[float, float],
    dwell: float | str,
    *,
    step: float = 1.0,
    max_dwell: float | str = 480.0,
    evaluation_time: float = 5.0,
    tol: float = 1e-10,
) -> xr.Dataset:
    """Sweep the speed up and down, continuing the same motion, and describe it at each speed.

    Parameters
    ----------
    case : the case; its own speed is not used
    scan : rad/s, the lowest and the highest speed
    dwell : s at each speed; doubled until the motion has settled, up to `max_dwell`
    step : rad/s, between speeds
    evaluation_time : s, the last stretch of a stay, which is described
    tol : as in `simulate`

    Returns
    -------
    xarray.Dataset
        `onset_speed`, `offset_speed` (rad/s), and `separation_rate` (1/s) and others by direction and speed

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> sweep = dm.hysteresis(dm.Parameters(N=385, Omega=14), (14, 16), dwell=20, max_dwell=80)
    >>> sweep["onset_speed"].item(), sweep["separation_rate"].dims
    (16.0, ('direction', 'sweep_Omega'))
    """
    options = {
        "scan": _scan(scan, step),
        "dwell": dwell,
        "max_dwell": max_dwell,
        "evaluation_time": evaluation_time,
        "tol": tol,
    }
    return _quantity("hysteresis", case, options)


# ---- Sweeps


def sweep(
    function: Callable[..., Any],
    case: Parameters,
    *,
    workers: int = 1,
    processes: bool = False,
    **named: Any,
) -> xr.Dataset:
    """Call a function for each combination of values of parameters, and gather the results.

    Parameters
    ----------
    function : one that takes a case first, such as `floquet`, `simulate`, `outcome` or a function of your own
    case : values of all parameters that do not vary
    workers : number of calls at a time; compiled code runs beside other threads
    processes : whether they are processes instead of threads: the function must then be importable
    **named : values of numbers of the case, each of which becomes a dimension; other names are passed to the function

    Returns
    -------
    xarray.Dataset
        Numbers, words and arrays of the results along the dimensions in their order. `status` is "ok", the result's own
        status, or "failed" where the function raised an error of this package; `message` then says which

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
    """
    call = _checked_call(function, case, named)
    points = [dict(zip(call.axes, values, strict=True)) for values in product(*call.axes.values())]
    row = partial(_row, partial(function, **call.options), case, call.arguments)
    rows = _in_parallel(row, [*enumerate(points)], workers, processes)

    coordinates: dict[str, Any] = {}
    for name, values in call.axes.items():
        attrs = describe(name) if name in (*Parameters.model_fields, *RATIOS) else {}
        floats = [float(value) if isinstance(value, int) else value for value in values]
        coordinates[name] = (name, floats, attrs)
    sizes = {name: len(values) for name, values in call.axes.items()}
    variables, fixed = _stacked(rows, sizes)
    base = canonical_json({**case.stated, "disc": case.canonical.get("disc")})
    attrs = {"function": call.title, "parameters": case.canonical_json, "base": base}
    return xr.Dataset(variables, {**fixed, **coordinates}, attrs)


class _Call(NamedTuple):
    """What a sweep calls.

    Attributes
    ----------
    title : name of the function
    axes : values of numbers of the case, by name
    options : arguments of the function that do not vary
    arguments : names of all arguments of the function beside the case
    """

    title: str
    axes: Mapping[str, list[Any]]
    options: Mapping[str, Any]
    arguments: frozenset[str]


def _checked_call(function: Any, case: Any, named: Mapping[str, Any]) -> _Call:
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
    axes = {}
    options = {}
    for name, value in named.items():
        if name in numbers and name not in parameters:
            axes[name] = _values(name, value, faults)
        else:
            options[name] = value

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
    return _Call(title, axes, options, frozenset(arguments))


def _values(name: str, values: Any, faults: list[str]) -> list[Any]:
    """The values of an axis in SI units; what is wrong with them, each by itself, is added to the
    faults."""
    several = np.iterable(values) and not isinstance(values, str | Mapping | Disc)
    raw = list(values) if several else [values]
    if not raw:
        faults.append(Fault.of((name,), values, "must have one value or more"))
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
            faults += [Fault((name,), fault.value, fault.rule) for fault in error.faults]
    return checked


def _in_parallel(
    call: Callable[[Any], Any], arguments: Sequence[Any], workers: int, processes: bool
) -> list[Any]:
    """The results of the calls, in order."""
    require(
        (is_whole(workers) and workers >= 1, "workers", workers, "must be a whole number >= 1"),
        (isinstance(processes, bool), "processes", processes, "must be True or False"),
    )
    kind = ProcessPoolExecutor if processes else ThreadPoolExecutor
    if workers == 1:
        return [call(argument) for argument in arguments]
    with kind(workers) as pool:
        return list(pool.map(call, arguments))


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
    return {**words, **_variables(result)}


@cache
def _common() -> dict[str, dict[str, Any]]:
    """Units and names that all quantities and simulations give a variable of this name; what they
    disagree about is left out, since such a name says nothing of another result's variable."""
    tables = [quantity_of(name).COLUMNS for name in quantity_names()]
    found: dict[str, list[dict[str, Any]]] = {}
    for table in (*tables, SCALARS):
        for name, column in table.items():
            if column.units and not column.flags:
                found.setdefault(name, []).append(column.attributes)
    common = {}
    for name, several in found.items():
        first = several[0]
        common[name] = {
            key: first[key] for key in first if all(each[key] == first[key] for each in several)
        }
    return common


@cache
def _of_class(name: str) -> dict[str, dict[str, Any]]:
    """Units and names of the variables of a result of a class, which has names of its own: a cycle
    and steady sliding both have a growth rate."""
    of_cycle = quantity_of("floquet").COLUMNS
    columns: Mapping[str, Variable] = {}
    if name == "FloquetResult":
        counted = {
            "releases": Variable("1", "number of stick releases in its period"),
            "separations": Variable("1", "number of separations in its period"),
        }
        columns = {**of_cycle, **counted}
    elif name == "SteadySliding":
        columns = {
            "growth_rate": of_cycle["sliding_growth_rate"],
            "psi": Variable("rad", "angle of the drive point ahead of the slider"),
        }
    elif name == "Lyapunov":
        columns = {
            "exponents": Variable("s-1", "Lyapunov exponent"),
            "errors": Variable("s-1", "uncertainty of the Lyapunov exponent"),
            "duration": Variable("s", "time over which exponents are taken"),
            "separations": Variable("1", "number of separations in that time"),
        }
    return {
        name: column.attributes
        for name, column in columns.items()
        if column.units and not column.flags
    }


def _attributes_of(result: Any, name: str) -> dict[str, Any]:
    """Unit and name of a variable of a result; empty if they are not known."""
    kind = type(result).__name__
    if (
        kind == "Critical"
        and name == "value"
        and result.name in (*Parameters.model_fields, *RATIOS)
    ):
        parameter = describe(result.name)
        return {**parameter, "long_name": f"critical value of {parameter['long_name']}"}
    return _of_class(kind).get(name) or _common().get(name, {})


def _variables(result: Any) -> dict[str, xr.Variable]:
    """Numbers, words and one-dimensional arrays of a result."""
    if isinstance(result, xr.Dataset):
        return {str(name): variable for name, variable in result.variables.items()}
    variables = {}
    for name, value in _named_values(result).items():
        array = np.array(str(value)) if isinstance(value, str) else np.asarray(value)
        if array.ndim <= 1 and array.dtype.kind in "biufcU":
            variables[name] = xr.Variable(
                (f"{name}_index",)[: array.ndim], array, _attributes_of(result, name)
            )
    return variables


def _named_values(result: Any) -> Mapping[str, Any]:
    """The values of a result by name."""
    if isinstance(result, Result):
        return result.scalars()
    if is_dataclass(result):
        values = {field.name: getattr(result, field.name) for field in fields(result)}
        if hasattr(result, "stable"):
            values["stable"] = result.stable
        if hasattr(result, "sliding"):
            values["sliding_growth_rate"] = result.sliding.growth_rate
        return values
    return result if isinstance(result, Mapping) else {"value": result}


def _stacked(
    rows: Sequence[dict[str, xr.Variable]], sizes: Mapping[str, int]
) -> tuple[dict[str, xr.Variable], dict[str, xr.Variable]]:
    """Variables along the dimensions of a sweep, and the function's own coordinates; nan or ""
    where one is missing."""
    first: dict[str, xr.Variable] = {}
    for row in reversed(rows):
        first.update(row)
    fixed = {}
    stacked = {}
    for name, variable in first.items():
        if variable.dims == (name,):
            fixed[name] = variable
            continue
        values = [row[name].values if name in row else None for row in rows]
        array = _padded(values)
        whole = array.reshape((*sizes.values(), *array.shape[1:]))
        stacked[name] = xr.Variable((*sizes, *variable.dims), whole, variable.attrs)
    return stacked, fixed


def _padded(rows: Sequence[NDArray[Any] | None]) -> NDArray[Any]:
    """Arrays of one number of dimensions as the rows of one array, shape (len(rows), ...); what is
    missing is nan, or "" among words."""
    present = [row for row in rows if row is not None]
    shapes = [row.shape for row in present]
    shape = tuple(max(sizes) for sizes in zip(*shapes, strict=True))
    complete = all(row is not None and row.shape == shape for row in rows)
    kinds = {row.dtype.kind for row in present}
    missing: Any = math.nan
    dtype: Any = float
    if kinds <= {"U"}:
        missing = ""
        dtype = object
    elif "c" in kinds:
        dtype = complex
    elif kinds <= {"b"} and complete:
        missing = False
        dtype = bool
    array = np.full((len(rows), *shape), missing, dtype)
    for i, row in enumerate(rows):
        if row is not None:
            place: Any = (i, *map(slice, row.shape))
            array[place] = row
    return array.astype(str) if dtype is object else array


# ---- Studies


def run_study(
    source: str | Path | Mapping[str, Any], *, workers: int = 1, processes: bool = False
) -> xr.Dataset | xr.DataTree:
    """Compute a study in this process, without files, and return its merged dataset.

    Parameters
    ----------
    source : path of a study file, or the mapping that such a file holds
    workers, processes : as in `sweep`, for its batches

    Returns
    -------
    xarray.Dataset
        The quantity over the grid, with the `status` and `message` of each point. A study of named cases gives a
        DataTree of them, one of several grids a DataTree of their datasets.

    Raises
    ------
    disc_model.studies.study.StudyError
        If the study has faults; it lists all of them.

    Examples
    --------
    >>> import disc_model as dm
    >>> axes = {"mu_s": [0.35, 0.4], "mu_k": [0.2]}
    >>> study = {"study": "growth", "quantity": "floquet", "base": {"N": 385, "Omega": 12}, "axes": axes}
    >>> dm.run_study(study)["growth_rate"].sizes
    Frozen({'mu_s': 2, 'mu_k': 1})
    """
    # needs yaml, of the extra `workflow`
    from disc_model.studies.study import load_study, parse_study

    named = isinstance(source, str | Path | Mapping)
    require((named, "source", source, "must be the path of a study file, or a mapping"))
    if isinstance(source, Mapping):
        folder = Path()
        study = parse_study(source, folder)
    else:
        folder = Path(source).parent
        study = load_study(source)
    grids, names = study.grids([folder])
    datasets: dict[str, Any] = {}
    for grid in (grids[name] for name in names):
        texts = [text for _, text in sorted(grid.batches.items())]
        batches = _in_parallel(run_batch, texts, workers, processes)
        datasets[grid.name] = merge_batches(batches, grid.grid, grid.attrs)
    if study.specs:
        run = partial(run_case, choose=choose_when_run)
        cases = _in_parallel(run, [*study.specs.values()], workers, processes)
        datasets["cases"] = merge_cases(dict(zip(study.specs, cases, strict=True)), study.labels)
    if len(datasets) == 1:
        return next(iter(datasets.values()))
    return xr.DataTree.from_dict(datasets)
