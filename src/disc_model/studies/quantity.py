"""What a study can compute: public functions of one case, and what studies know of them.

A quantity imports the engine only where it computes, so that reading a study file does not wait for it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from importlib import import_module
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self, TypeVar, cast

import numpy as np
import xarray as xr
from pydantic import AfterValidator, BeforeValidator, Field, model_validator
from xarray import Dataset

from disc_model.data.coded import words
from disc_model.data.variables import OF_QUANTITIES, Variable, described
from disc_model.errors import DiscModelError, Fault, ParameterError, suggestion
from disc_model.parameters import Parameters, require_case
from disc_model.simulation.case import Start
from disc_model.units import Finite, Positive, Several, Strict, Unit, arguments_of, must

if TYPE_CHECKING:
    from disc_model.simulation.states import State

Function = Callable[..., Dataset]
F = TypeVar("F", bound=Function)
Row = dict[str, Any]
"""Values of variables, by name."""
Rules = tuple[tuple[Callable[[Any], Any], str], ...]
NUMERICAL = (DiscModelError, ArithmeticError, np.linalg.LinAlgError)
"""Errors that make a point fail."""
MOST = 100_000
"""Most values along one axis; a slip of the pen can ask for more than fit into memory."""


def _is_free(name: str) -> bool:
    """Whether a name is that of a number that varies continuously."""
    return Parameters.unit(name) != "" and not name.startswith("n_")


Free = Annotated[str, AfterValidator(must(_is_free, "must be a number of the case"))]
"""A number along which a function goes."""


# ---- Options and their rules


class Ruled(Strict):
    """A part of a file with conditions between its fields."""

    _rules: ClassVar[Rules] = ()  # each with its message, which may show values of the part

    @model_validator(mode="after")
    def _keep_rules(self) -> Self:
        for holds, stated in self._rules:
            if not holds(self):
                raise ValueError(stated.format(self))
        return self


class Range(Ruled):
    """Evenly spaced values from `start` to `stop`, both included: `count` of them, or one each `step`."""

    start: Finite
    stop: Finite
    count: Several | None = None
    step: Positive | None = None
    scale: Literal["linear", "log"] = "linear"  # log: the ratio of neighbours is constant

    _rules = (
        (lambda r: r.start < r.stop, "start={0.start:g} must be < stop={0.stop:g}"),
        (lambda r: (r.count is None) != (r.step is None), "must give either count or step"),
        (
            lambda r: r.scale == "linear" or (r.count and r.start > 0),
            "a logarithmic range needs count and start > 0",
        ),
        (lambda r: r.steps < MOST - 0.5, f"must be at most {MOST} values"),
        (
            lambda r: math.isclose(r.steps, round(r.steps)),
            "stop - start must be a multiple of step={0.step:g}",
        ),
    )

    @property
    def steps(self) -> float:
        """The number of intervals, which rounding may have changed."""
        if self.step:
            return (self.stop - self.start) / self.step
        return (self.count or 2) - 1

    @property
    def values(self) -> list[float]:
        """All values, those inside rounded to 12 digits, so that ranges and lists agree on 0.3."""
        spaced: Any = {"linear": np.linspace, "log": np.geomspace}[self.scale]
        inside = spaced(self.start, self.stop, round(self.steps) + 1)[1:-1]
        return [self.start, *(float(f"{value:.12g}") for value in inside), self.stop]


def values_between(bounds: tuple[float, float], step: float) -> list[float]:
    """Evenly spaced values from the first to the last of two bounds; raises `ParameterError`."""
    return Range(start=bounds[0], stop=bounds[1], step=step).values


Speeds = Annotated[tuple[Finite, Finite], Unit("rad/s")]
"""A lowest and a highest speed."""
Bounds = Annotated[tuple[Finite, Finite], Unit(of="name")]
"""The least and the greatest value of the number that the option `name` names."""
Step = Annotated[Positive, Unit(of="name")]
BETWEEN: Rules = ((lambda o: values_between(o.bounds, o.step), ""),)
"""The rule of the options `bounds` and `step`."""


def listed_values(given: Any) -> Any:
    """A list of values, in which ranges are replaced by theirs."""
    if isinstance(given, Mapping | int | float | str):
        given = [given]
    if not isinstance(given, list | tuple | np.ndarray):
        return given
    values: list[Any] = []
    for part in given:
        if isinstance(part, Mapping):
            values += Range.model_validate(part).values
        else:
            values.append(part)
    return values


Values = Annotated[
    tuple[Finite, ...],
    BeforeValidator(listed_values, json_schema_input_type=list[Finite | Range] | Range | Finite),
    Field(min_length=1),
]
"""Numbers: a list of them and of ranges {start, stop, count or step, scale}, or one range."""


STATIC = Start()
RETURNED = """\
    Returns
    -------
    xarray.Dataset
        The variables of a study of this quantity, with words as words; attributes are the case (`parameters`), the
        `options`, and in `message` what went wrong or is missing

"""
RAISED = """\
    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

"""
COME_TO = (
    "What the motion has come to: a while after the first separation, on the cycle it settled to, "
    "or at the horizon."
)


class Motion(NamedTuple):
    """Motions that the explorer stores: at how many points of a grid at most, what they are, and the state at
    which they begin, of a case and options."""

    number: int
    text: str
    state: Callable[..., State]


@dataclass(frozen=True)
class Quantity:
    """A quantity of studies.

    Attributes
    ----------
    name, function : of a case, with `options` as keywords; it returns codes for words, as files have them
    points_per_job : most points of a job, some 20 to 40 s of work with nine modes
    own : numbers of the case that it varies by itself, or the options that name them
    motion : what the explorer stores
    """

    name: str
    function: Function
    options: type[Ruled]
    points_per_job: int
    own: tuple[str, ...]
    motion: Motion | None

    @property
    def columns(self) -> Mapping[str, Variable]:
        return OF_QUANTITIES[self.name]["columns"]

    def varied(self, options: Any) -> tuple[str, ...]:
        """Numbers of the case that it varies by itself, for given options."""
        return tuple(str(getattr(options, name, name)) for name in self.own)

    def unset(self, options: Any) -> dict[str, float]:
        """Values of required parameters that it varies by itself, which a case must have."""
        return {name: 0.0 for name in self.varied(options) if name in ("N", "Omega")}


QUANTITIES: dict[str, Quantity] = {}
"""All quantities by name; `quantity_of` fills it."""
HOMES = {name: name for name in sorted(OF_QUANTITIES.keys() - {"motions"})}
HOMES |= dict.fromkeys(("floquet", "lyapunov_exponents", "neutral_curves"), "cycles")
"""Modules of `disc_model.studies.quantities`, by quantities; the table of variables has all."""


def quantity_of(name: str) -> Quantity:
    """The quantity of a name; raises `ParameterError`."""
    if name not in HOMES:
        rule = f"unknown quantity{suggestion(name, [*HOMES])}"
        raise ParameterError(Fault.of(("quantity",), name, rule))
    import_module(f"disc_model.studies.quantities.{HOMES[name]}")
    return QUANTITIES[name]


def quantity(
    *,
    points_per_job: int = 1,
    own: Sequence[str] = (),
    rules: Rules = (),
    motion: Motion | None = None,
) -> Callable[[F], F]:
    """Mark a function of a case as a quantity: its keywords become options of study files, and calls of it
    check them, by their types and by the rules between them.

    A call returns words; studies call the function itself, for codes. What all of them return, unless they say
    otherwise, and raise stands in their docstrings.
    """

    def mark(function: F) -> F:
        name = function.__name__
        options = cast(type[Ruled], arguments_of(function, Ruled))
        options._rules = rules
        QUANTITIES[name] = Quantity(name, function, options, points_per_job, tuple(own), motion)

        @wraps(function)
        def checked(case: Parameters, *args: Any, **given: Any) -> Dataset:
            require_case(case)
            asked = {**dict(zip(options.model_fields, args, strict=False)), **given}
            chosen = options.model_validate(asked)
            found = function(case, **dict(chosen))
            said = {"parameters": case.canonical_json, "options": chosen.model_dump_json()}
            if not found["message"].dims:
                said["message"] = found["message"].item()
                found = found.drop_vars("message")
            fields = options.model_fields.keys()
            scalars = [
                dim for dim in found.dims if dim in fields and np.ndim(asked.get(str(dim), 0)) == 0
            ]
            found = found.squeeze(scalars, drop=True).assign_attrs(said)
            return words(described(found, name, dict(chosen)))

        text, examples, rest = str(function.__doc__).partition("    Examples\n")
        if "    Returns\n" not in text:
            text += RETURNED
        checked.__doc__ = "".join([text, RAISED, examples, rest])
        function.__qualname__ += ".__wrapped__"  # by which pickle finds it
        return cast(F, checked)

    return mark


# ---- What a function has found, as a dataset


def failed(name: str, error: Exception) -> Dataset:
    """The dataset of a point of a quantity that an error has ended; of another function status and message
    alone, in words."""
    from disc_model.simulation.result import STATUS_OF

    if not name:
        return Dataset({"status": "failed", "message": told(error)})
    word = dict[Any, Any](STATUS_OF).get(type(error), "failed")
    if word not in OF_QUANTITIES[name]["columns"]["status"].flags:
        word = "failed"
    return found(name, {"status": word}, told(error))


def found(name: str, values: Row, *remarks: str, **own: Iterable[Any]) -> Dataset:
    """A dataset of what a quantity has found at a point.

    Parameters
    ----------
    name : of the quantity, whose variables the table has
    values : numbers, words, arrays, or lists of these along the first own dimension, by variable; those that
        are not given, and the ends of too short lists, are missing, and the status is ok
    remarks : what the message says; that something was cut is added. Messages along the first own dimension
        stand among the values
    own : values along the dimensions of its own; without them, only variables without dimensions are returned
    """
    coords = {dim: xr.Variable(dim, np.array([*along])) for dim, along in own.items()}
    values = {"status": "ok", "message": joined(*remarks), **values}
    variables: Row = {}
    lengths: dict[str, int] = {}
    for key, column in OF_QUANTITIES[name]["columns"].items():
        if coords.keys() >= {*column.dims}:
            array = column.empty(tuple(coords[dim].size for dim in column.dims))
            _store(values.get(key), array[...], column, lengths)
            variables[key] = xr.Variable(column.dims, array, column.codes)
    cuts = []
    for dim, length in lengths.items():
        room = coords[dim].size
        if length > room:
            cuts.append(f"{length} were found along {dim}, which has room for {room}")
    said = values["message"]
    if isinstance(said, str):
        variables["message"] = ((), joined(said, *cuts))
    else:
        variables["message"] = (next(iter(coords)), [joined(text, *cuts) for text in said])
    return Dataset(variables, coords)


def joined(*remarks: str) -> str:
    """A message of remarks, each once, without those that are ""."""
    return "; ".join(dict.fromkeys(filter(None, remarks)))


def _store(value: Any, cell: np.ndarray, column: Variable, lengths: dict[str, int]) -> None:
    """Store a value in a view of an array, words as numbers; lists and arrays are cut to fit, and their
    greatest lengths kept by dimension."""
    if isinstance(value, list | np.ndarray):
        dim = column.dims[-cell.ndim]
        lengths[dim] = max(len(value), lengths.get(dim, 0))
        for i, item in enumerate(value[: len(cell)]):
            _store(item, cell[i, ...], column, lengths)
    elif isinstance(value, str):
        cell[...] = column.flags.index(value)
    elif value is not None:
        cell[...] = value


def listed(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Columns of the rows along a dimension; None, which is missing, where rows lack a value."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: [row.get(name) for row in rows] for name in names}


def attempted(rows: Sequence[Row], fill: Callable[[Row], Iterable[str]]) -> dict[str, list[Any]]:
    """Columns of rows that a function fills in, one by one, while it yields remarks, which become their
    messages; those that end in an error have failed."""
    for row in rows:
        remarks = []
        try:
            for remark in fill(row):
                remarks.append(remark)
        except NUMERICAL as error:
            row["status"] = "failed"
            remarks.append(told(error))
        row["message"] = joined(*remarks)
    return listed(rows)


def told(error: Exception) -> str:
    """What an error says."""
    return f"{type(error).__name__}: {error}"


def with_ends(name: str, values: Iterable[Any]) -> Row:
    """Three columns by name: a share, and the ends of its confidence interval."""
    return dict(zip((name, f"{name}_low", f"{name}_high"), values, strict=True))
