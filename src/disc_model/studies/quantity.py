"""What a study can compute: public functions of one case, and what studies know of them.

A quantity imports the engine only where it computes, so that reading a study file does not wait for it.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from importlib import import_module
from types import MappingProxyType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ClassVar,
    Concatenate,
    Literal,
    NamedTuple,
    ParamSpec,
    Self,
    get_type_hints,
)

import numpy as np
import xarray as xr
from pydantic import AfterValidator, BeforeValidator, Field, create_model, model_validator

from disc_model.data.coded import words
from disc_model.data.described import described
from disc_model.data.variables import OF_QUANTITIES, Variable
from disc_model.errors import DiscModelError, Fault, ParameterError, raise_faults, suggestion
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.case import Start
from disc_model.units import Count, Finite, Positive, Strict, must

if TYPE_CHECKING:
    from disc_model.simulation.states import State

P = ParamSpec("P")
Function = Callable[..., xr.Dataset]
Row = Mapping[str, Any]
Rules = tuple[tuple[Callable[[Any], Any], str], ...]
NUMERICAL = (DiscModelError, ArithmeticError, np.linalg.LinAlgError)
"""Errors that make a point fail."""
MOST = 100_000
"""Most values along one axis; a slip of the pen can ask for more than fit into memory."""
FREE_NUMBERS = re.compile(
    "|".join(
        [
            *(
                name
                for name in Parameters.model_fields
                if Parameters.unit(name) and not name.startswith("n_")
            ),
            r"(omega|amplitude|damping_ratio|tangential)_\d+_\d+",
        ]
    )
)
Free = Annotated[
    str,
    AfterValidator(
        must(lambda name: bool(FREE_NUMBERS.fullmatch(name)), "must be a number of the case")
    ),
]
"""A number along which a function goes: a parameter, or one of a disc's modes."""


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
    count: Annotated[Count, Field(ge=2)] | None = None
    step: Positive | None = None
    scale: Literal["linear", "log"] = "linear"  # log: the ratio of neighbours is constant

    _rules = (
        (lambda r: r.start < r.stop, "start={0.start:g} must be < stop={0.stop:g}"),
        (lambda r: math.isfinite(r.stop - r.start), "stop - start must be finite"),
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
        intervals = round(self.steps)
        inside = [self._value_at(place / intervals) for place in range(1, intervals)]
        return [self.start, *inside, self.stop]

    def _value_at(self, share: float) -> float:
        """The value at a share of the way."""
        if self.scale == "log":
            return float(f"{self.start * (self.stop / self.start) ** share:.12g}")
        return float(f"{self.start + share * (self.stop - self.start):.12g}")


def values_between(bounds: tuple[float, float], step: float) -> list[float]:
    """Evenly spaced values from the first to the last of two bounds."""
    return Range(start=bounds[0], stop=bounds[1], step=step).values


BETWEEN: Rules = (
    (lambda o: o.bounds[0] < o.bounds[1], "bounds={0.bounds} must ascend"),
    (lambda o: o.bounds[1] - o.bounds[0] < (MOST - 0.5) * o.step, f"must be at most {MOST} values"),
    (
        lambda o: math.isclose(x := (o.bounds[1] - o.bounds[0]) / o.step, round(x)),
        "highest - lowest of bounds={0.bounds} must be a multiple of step={0.step:g}",
    ),
)
"""Rules of the options `bounds` and `step`."""


def _listed(given: Any) -> Any:
    """A list of values, in which ranges are replaced by theirs."""
    parts = [given] if isinstance(given, Mapping | int | float | str) else given
    if not isinstance(parts, list | tuple | np.ndarray):
        return given
    values: list[Any] = []
    for part in parts:
        values += Range.model_validate(part).values if isinstance(part, Mapping) else [part]
    return values


Values = Annotated[
    tuple[Finite, ...],
    BeforeValidator(_listed, json_schema_input_type=list[Finite | Range] | Range | Finite),
    Field(min_length=1),
]
"""Numbers: a list of them and of ranges {start, stop, count or step, scale}, or one range."""


def _started(given: Any) -> Any:
    """A start of a motion: perturbations by name, and what `Start` has."""
    if not isinstance(given, Mapping):
        return given
    kicks = {name: x for name, x in given.items() if name in ("u", "u_velocity", "f")}
    others = {name: value for name, value in given.items() if name not in kicks}
    return {**others, "perturbation": kicks} if kicks else others


Starting = Annotated[Start, BeforeValidator(_started)]
"""A start: perturbations {u, u_velocity, f} of the static start, or {prerun: {parameters, time}}."""
STATIC = Start()
COME_TO = (
    "What the motion has come to: a while after the first separation, on the cycle it settled to, "
    "or at the horizon."
)
_ON_CYCLE = "The motion on the cycle that it has settled to."
_AT_HORIZON = "The motion at the horizon."
COME_TO_BY: Mapping[str, str] = MappingProxyType(
    {
        "separation": "The motion a while after the first separation.",
        "stick_slip": _ON_CYCLE,
        "other_cycle": _ON_CYCLE,
        "separating": _ON_CYCLE,
        "steady_sliding": "The steady sliding that the motion has settled to.",
        "at_rest": "The rest to which the motion has come.",
        "undecided": _AT_HORIZON,
        "growing": _AT_HORIZON,
    }
)
"""What a motion has come to, by its outcome."""


class Motion(NamedTuple):
    """Motions that the explorer stores: of so many values of each axis, what they are, by the class of
    their point, and the state at which they begin, of a case and options."""

    number: int
    text: str
    by: Mapping[str, str]
    state: Callable[..., State]


@dataclass(frozen=True)
class Quantity:
    """A quantity of studies.

    Attributes
    ----------
    name, function : of a case, with `options` as keywords; it returns codes for words, as files have them
    points_per_job : most points of a job, some 20 s of work with nine modes
    own : numbers of the case that it varies by itself, or the options that name them
    plane : whether it takes all values along two numeric axes at once, as `axes`
    motion : what the explorer stores
    """

    name: str
    function: Function
    options: type[Ruled]
    points_per_job: int
    own: tuple[str, ...]
    plane: bool
    motion: Motion | None

    @property
    def columns(self) -> Mapping[str, Variable]:
        return OF_QUANTITIES[self.name]["columns"]

    def varied(self, options: Any) -> tuple[str, ...]:
        """Numbers of the case that it varies by itself, for given options."""
        return tuple(str(getattr(options, name, name)) for name in self.own)


QUANTITIES: dict[str, Quantity] = {}
"""All quantities by name; `quantity_of` fills it."""
HOMES = {
    "basins": "basins",
    "bifurcation": "bifurcation",
    "branches": "branches",
    "campbell": "campbell",
    "critical_speed": "critical_speed",
    "floquet": "cycles",
    "hysteresis": "hysteresis",
    "locking": "locking",
    "lyapunov_exponents": "cycles",
    "neutral_curves": "cycles",
    "outcome": "outcome",
    "ramps": "ramps",
    "range_law": "range_law",
    "regions": "regions",
    "sensitivity": "sensitivity",
    "sliding_modes": "sliding",
}
"""Modules of `disc_model.studies.quantities`; a new quantity is added here."""


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
    plane: bool = False,
    motion: Motion | None = None,
) -> Callable[
    [Callable[Concatenate[Parameters, P], xr.Dataset]],
    Callable[Concatenate[Parameters, P], xr.Dataset],
]:
    """Mark a function of a case as a quantity: its keywords become options of study files, and calls of it
    check them, by their types and by the rules between them.

    A call returns words; studies call the function itself, for codes.
    """

    def mark(
        function: Callable[Concatenate[Parameters, P], xr.Dataset],
    ) -> Callable[Concatenate[Parameters, P], xr.Dataset]:
        name = function.__name__
        options = options_of(function, rules)
        _, *parameters = inspect.signature(function).parameters.values()
        named = [x.name for x in parameters]
        defaults = {x.name: x.default for x in parameters if x.default is not x.empty}
        QUANTITIES[name] = Quantity(
            name, function, options, points_per_job, tuple(own), plane, motion
        )

        @wraps(function)
        def checked(case: Parameters, *args: P.args, **given: P.kwargs) -> xr.Dataset:
            raise_faults(foreign_case(case))
            asked = {**defaults, **dict(zip(named, args, strict=False)), **given}
            beside = {"axes": asked.pop("axes")} if plane else {}
            chosen = options.model_validate(asked)
            found = function(case, **beside, **dict(chosen))  # type: ignore[call-arg]
            if found["message"].ndim == 0:
                found = found.assign_attrs(message=str(found["message"].values)).drop_vars(
                    "message"
                )
            single = [
                dim for dim in found.dims if isinstance(asked.get(str(dim)), int | float | str)
            ]
            found = found.squeeze(single, drop=True)
            found = found.assign_attrs(
                parameters=case.canonical_json, options=chosen.model_dump_json()
            )
            return words(described(found, name, dict(chosen)))

        function.__qualname__ += ".__wrapped__"  # by which pickle finds it
        checked.__doc__ = _documented(function)
        return checked

    return mark


RETURNS = """
Returns
-------
xarray.Dataset
    The variables that a study of this quantity has, with words as words; attributes are the case (`parameters`), the
    `options`, and in `message` what went wrong or is missing
"""
RAISES = """
Raises
------
ParameterError
    If an argument breaks a rule; the message names the argument, its value and the rule.
"""


def _documented(function: Callable[..., Any]) -> str:
    """The docstring of a quantity, with what holds of all of them."""
    before, heading, examples = (inspect.getdoc(function) or "").partition("\nExamples\n--------")
    for section, text in (("Returns", RETURNS), ("Raises", RAISES)):
        if f"\n{section}\n---" not in before:
            before = f"{before.rstrip()}\n{text}"
    return before + heading + examples


def options_of(function: Callable[..., Any], rules: Rules) -> type[Ruled]:
    """The options of a function: its keywords after the case, with their types and defaults."""
    hints = get_type_hints(function, include_extras=True)
    _, *parameters = inspect.signature(function).parameters.values()
    fields: dict[str, Any] = {}
    for parameter in parameters:
        if parameter.name != "axes":  # which a plane is given by the study
            default = ... if parameter.default is parameter.empty else parameter.default
            fields[parameter.name] = (hints[parameter.name], default)
    model = create_model(function.__name__, __base__=Ruled, **fields)
    model._rules = rules
    return model


# ---- What a function has found, as a dataset


def failed(name: str, error: Exception) -> xr.Dataset:
    """The dataset of a point of a quantity that an error has ended."""
    return found(name, {"status": "failed"}, f"{type(error).__name__}: {error}")


def found(
    name: str, values: Row, message: str | Sequence[str] = "", **own: Iterable[Any]
) -> xr.Dataset:
    """A dataset of what a quantity has found at a point.

    Parameters
    ----------
    name : of the quantity, whose variables the table has
    values : numbers, words, arrays, or lists of these along the first own dimension, by variable; those that
        are not given, and the ends of too short lists, are missing
    message : what there is to say; that something was cut is added. Several are along the first own dimension
    own : values along the dimensions of its own; without them, only variables without dimensions are returned
    """
    coords = {dim: xr.Variable(dim, np.array([*along])) for dim, along in own.items()}
    variables: dict[str, Any] = {}
    cuts: dict[str, str] = {}
    for key, column in OF_QUANTITIES[name]["columns"].items():
        if not coords.keys() >= {*column.dims}:
            continue
        array = column.empty(tuple(coords[dim].size for dim in column.dims))
        value = values.get(key)
        _store(value, array[...], column)
        variables[key] = xr.Variable(column.dims, array, column.codes)
        for dim, length in zip(column.dims, _shape(value), strict=False):
            if length > coords[dim].size:
                room = f"which has room for {coords[dim].size}"
                cuts[dim] = f"{length} were found along {dim}, {room}"
    texts = []
    for text in [message] if isinstance(message, str) else message:
        texts.append(
            "; ".join(filter(None, [text.removesuffix(".") if cuts else text, *cuts.values()]))
        )
    said = ((), texts[0]) if isinstance(message, str) else (next(iter(coords)), texts)
    return xr.Dataset({**variables, "message": said}, coords)


def _shape(value: Any) -> tuple[int, ...]:
    """The shape of an array, or of a list of arrays or lists with the longest of them."""
    if not isinstance(value, list):
        return np.shape(value)
    inside = [shape for shape in map(_shape, value) if shape]
    return (len(value), *map(max, zip(*inside, strict=False)))


def _store(value: Any, cell: np.ndarray, column: Variable) -> None:
    """Store a value in a view of an array: flags as numbers; lists and arrays are cut to fit."""
    if isinstance(value, list):
        for i, item in enumerate(value[: len(cell)]):
            _store(item, cell[i, ...], column)
    elif isinstance(value, np.ndarray) and value.ndim:
        part = value[tuple(map(slice, cell.shape))]
        cell[tuple(map(slice, part.shape))] = part
    elif isinstance(value, str):
        cell[...] = column.flags.index(value)
    elif value is not None:
        cell[...] = value


def listed(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Columns of the rows along a dimension; None, which is missing, where rows lack a value."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: [row.get(name) for row in rows] for name in names}


def with_ends(name: str, values: Iterable[Any]) -> dict[str, Any]:
    """Three columns by name: a share, and the ends of its confidence interval."""
    return dict(zip((name, f"{name}_low", f"{name}_high"), values, strict=True))
