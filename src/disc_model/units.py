"""Numbers and their units, and the base of all schemas."""

from __future__ import annotations

import functools
import inspect
import numbers
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, ParamSpec, Self, TypeVar, get_type_hints

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    create_model,
)
from pydantic_core.core_schema import with_info_before_validator_function

from disc_model.errors import Fault, ParameterError, faults_of

# Least and greatest tolerance
TOLERANCES = (1e-15, 1e-2)  # of a simulation: error of event times after a second of motion, s
CYCLE_TOLERANCES = (1e-14, 1e-6)  # of the search for a cycle: relative residual of the return map

# ---- Units

Units = str | Mapping[str, str]  # a unit; or, for values by name, those that have one
UNITS: dict[str, str] = {}  # units of parameters by their names, filled by `disc_model.parameters`


@dataclass(frozen=True, eq=False)
class Unit:
    """The SI unit of numbers, which marks their type: those with a unit are converted; or the field `of`
    that names the parameter with this unit."""

    name: Units = ""
    of: str = ""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        def converted(value: Any, info: ValidationInfo) -> Any:
            if self.of:
                return in_si(value, UNITS.get(str(info.data.get(self.of)), ""))
            return in_si(value, self.name)

        return with_info_before_validator_function(converted, handler(source))


NUMBER = r"[-+]?(?:\d++\.?+\d*+|\.\d++)(?:[eE][-+]?\d++)?+"
"""A number in a text; its exponent is not taken for a unit."""
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s*(\S.*)")


@functools.cache
def _registry() -> Any:
    import pint  # 0.2 s, and few callers need it

    # "kg m-3", as datasets have units
    powers = functools.partial(re.sub, r"(?<=[A-Za-z])(?=-?\d)", "**")
    registry: Any = pint.UnitRegistry(preprocessors=[powers])
    registry.define("@alias turn = rev")
    return registry


@functools.lru_cache(maxsize=1024)
def converted(magnitude: float, text: str, unit: str) -> float:
    """A number with a unit, as the number in another unit; raises ValueError, or an error of pint.

    Radians count as a unit of their own: rad/s and Hz do not stand for each other. Rounded to 15
    digits, equal decimal numbers are equal in any unit.
    """
    if text.strip() == unit:
        return magnitude
    quantity = _registry().Quantity(magnitude, text)
    target = _registry().Unit(unit)
    if quantity.to_root_units().units != (1 * target).to_root_units().units:
        raise ValueError("units of different kinds")
    if quantity.units == target:
        return magnitude
    return float(f"{quantity.to(target).magnitude:.15g}")


def size_of_unit(unit: str, target: str) -> float:
    """One of a unit in another one; 0 if it is not of its kind."""
    try:
        return converted(1.0, unit, target)
    except Exception:  # of pint and of Python's tokenizer, which have no common base
        return 0.0


def in_si(value: Any, unit: Units, *path: str) -> Any:
    """A value with all texts within it that have a unit, such as ``"150 GPa"``, and all quantities
    of pint and numbers of xarray with a unit, as numbers in the given unit; raises `ParameterError`
    for a unit of another kind, at its `path`."""
    if not unit or type(value) is float:
        return value
    if type(value) in (list, tuple):
        return type(value)(in_si(part, unit, *path, str(i)) for i, part in enumerate(value))
    if type(value) is dict:
        units = dict.fromkeys(value, unit) if isinstance(unit, str) else unit
        return {x: in_si(part, units.get(x, ""), *path, str(x)) for x, part in value.items()}
    text, numbers = _with_unit(value)
    if not text or not isinstance(unit, str):
        return value
    try:
        return _all_converted(numbers, text, unit)
    except Exception:  # of pint and of Python's tokenizer, which have no common base
        raise ParameterError(Fault.of(path, value, _rule_of(unit))) from None


def _with_unit(value: Any) -> tuple[str, Any]:
    """The text of a value's unit, "" without one, and the number, or an array of numbers."""
    if isinstance(value, str):
        if match := _WITH_UNIT.fullmatch(value):
            return match[2], match[1]
    elif is_quantity(value):
        return format(value.units, "C") or "1", value.magnitude
    elif "units" in getattr(value, "attrs", {}):
        return str(value.attrs["units"]), value.values
    return "", value


def _all_converted(numbers: Any, text: str, unit: str) -> Any:
    """A number, or an array of numbers as a list, in another unit; raises as `converted`."""
    if getattr(numbers, "ndim", 0):
        return [_all_converted(part, text, unit) for part in numbers]
    return converted(float(numbers), text, unit)


def _rule_of(unit: str) -> str:
    """The rule that a unit of another kind breaks."""
    if unit == "1":
        return "must be a number without a unit"
    rule = f"must be a number in {unit}, or with a unit of its kind"
    if unit == "rad/s":
        rule += ", such as rpm; Hz may mean turns or radians"
    return rule


# ---- Numbers


def is_quantity(value: object) -> bool:
    """Whether a value is a quantity of pint."""
    return hasattr(value, "magnitude") and hasattr(value, "units")


def _scalar(value: Any) -> Any:
    """The single number of a numpy or xarray object without dimensions; all else as it is."""
    if getattr(value, "ndim", None) == 0 and hasattr(value, "item") and not is_quantity(value):
        return value.item()
    return value


def number(value: Any) -> Any:
    """A number, a text such as ``1e-3`` of YAML, or an array of one number without dimensions, as a
    float; raises ValueError for all else, also for a bool."""
    if type(value) is float:  # as nearly always, and at once
        return value + 0.0  # adding zero turns -0.0 into 0.0
    value = _scalar(value)
    if not isinstance(value, str) and not is_number(value):
        raise ValueError("must be a number")
    try:
        return float(value) + 0.0
    except ValueError:
        raise ValueError("must be a number") from None


def whole(value: Any) -> Any:
    """A count by the rules of `number`: 4, 4.0 and "4" are the same, 4.5 is refused."""
    value = number(value)
    if not value.is_integer():
        raise ValueError("must be a whole number")
    return int(value)


def is_number(value: object) -> bool:
    """Whether a value is a number within the range of floats, or an array of one without
    dimensions; a text or a bool is not."""
    if type(value) is float:  # at once: the test for the abstract type takes longer
        return True
    value = _scalar(value)
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return False
    return not isinstance(value, numbers.Integral) or abs(int(value)) < 1e308


def must(holds: Callable[[Any], bool], rule: str) -> Callable[[Any], Any]:
    """A validator for pydantic, which refuses values by a rule."""

    def checked(value: Any) -> Any:
        if not holds(value):
            raise ValueError(rule)
        return value

    return checked


def between(limits: tuple[float, float]) -> Any:
    """The rule of numbers within limits."""
    return Field(ge=limits[0], le=limits[1])


Real = Annotated[float, BeforeValidator(number)]
Finite = Annotated[Real, Field(allow_inf_nan=False)]
Positive = Annotated[Real, Field(gt=0, allow_inf_nan=False)]
Count = Annotated[int, BeforeValidator(whole)]
NotNegative = Annotated[Finite, Field(ge=0)]
Share = Annotated[Real, Field(ge=0, le=1)]
Natural = Annotated[Count, Field(ge=0)]
Size = Annotated[Count, Field(ge=1)]
Several = Annotated[Count, Field(ge=2)]
Seconds = Annotated[Positive, Unit("s")]
Speed = Annotated[Positive, Unit("rad/s")]
Tolerance = Annotated[Real, Unit("s"), between(TOLERANCES)]
CycleTolerance = Annotated[Real, between(CYCLE_TOLERANCES)]


# ---- Base of schemas


class Strict(BaseModel):
    """Base of all models of input: immutable, no unknown keys. Its `ParameterError` lists all faults,
    those of parts too."""

    # JSON has no infinities: they are texts, which `number` reads
    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings")

    _unknown: ClassVar[str] = "unknown key"  # the rule of names that are no fields

    if not TYPE_CHECKING:  # type checkers have the fields from pydantic

        def __init__(self, /, **data: Any) -> None:
            try:
                super().__init__(**data)
            except ValidationError as error:
                raise ParameterError(*faults_of(error, data, type(self))) from None

    @classmethod
    def model_validate(cls, obj: Any, **kwargs: Any) -> Self:
        """The model from a mapping."""
        try:
            return super().model_validate(dict(obj) if isinstance(obj, Mapping) else obj, **kwargs)
        except ValidationError as error:
            raise ParameterError(*faults_of(error, obj, cls)) from None

    def replace(self, **changes: Any) -> Self:
        """A validated copy with some values changed."""
        return type(self)(**{**dict(self), **changes})


# ---- Arguments of functions

P = ParamSpec("P")
T = TypeVar("T")


def arguments_of(function: Callable[..., Any], base: type[Strict] = Strict) -> type[Strict]:
    """A model of the arguments of a function of a case but for the case, with their types and defaults."""
    hints = get_type_hints(function, include_extras=True)
    fields: dict[str, Any] = {}
    for each in [*inspect.signature(function).parameters.values()][1:]:
        default = each.default
        if default is each.empty:
            default = ...
        fields[each.name] = (hints[each.name], default)
    # what is in the unit of a parameter comes after the name of that
    order = sorted(fields, key=lambda name: _is_of_another(hints[name]))
    return create_model(function.__name__, __base__=base, **{name: fields[name] for name in order})


def _is_of_another(hint: Any) -> bool:
    """Whether another field names the parameter whose unit numbers of a type have."""
    return any(isinstance(mark, Unit) and mark.of for mark in getattr(hint, "__metadata__", ()))


def checked(function: Callable[P, T]) -> Callable[P, T]:
    """A function of a case whose other arguments are read by their types, as the fields of a `Strict`
    model are: numbers with units become those of SI, and wrong ones raise a `ParameterError`.

    Examples
    --------
    >>> from disc_model import Parameters
    >>> from disc_model.units import Seconds, checked
    >>> @checked
    ... def later(case: Parameters, time: Seconds) -> float:
    ...     return 2 * time
    >>> later(Parameters(N=385, Omega=15), "3 ms")
    0.006
    """
    signature = inspect.signature(function)
    first = next(iter(signature.parameters))
    kind = get_type_hints(function)[first]
    model = arguments_of(function)

    @functools.wraps(function)
    def call(*args: P.args, **given: P.kwargs) -> T:
        asked = signature.bind(*args, **given).arguments
        case = asked.pop(first)
        if not isinstance(case, kind):
            raise ParameterError(Fault.of((first,), case, f"must be {kind.__name__}"))
        return function(case, **dict(model(**asked)))  # type: ignore[call-arg, arg-type]

    return call
