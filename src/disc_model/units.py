"""Numbers and their units, and strict bases of all schemas."""

from __future__ import annotations

import functools
import inspect
import json
import math
import numbers
import re
import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Literal,
    Self,
    TypeGuard,
    Union,
    get_args,
    get_origin,
)

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    model_validator,
)

from disc_model.errors import Fault, ParameterError, as_text, faults_of, raise_faults, suggestion

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)  # which pydantic does not make public

# Least and greatest tolerance
TOLERANCES = (1e-15, 1e-2)  # of a simulation: error of event times after a second of motion, s
CYCLE_TOLERANCES = (1e-14, 1e-6)  # of the search for a cycle: relative residual of the return map

# ---- Numbers


def is_missing(value: Any) -> bool:
    """Whether this is what a table has for a missing number or word: None, nan, or pandas.NA."""
    is_nan = isinstance(value, float) and math.isnan(value)
    return value is None or is_nan or type(value).__name__ == "NAType"


Units = str | Mapping[str, "Units"]  # a unit; or, for values by name, those that have one


@dataclass(frozen=True, eq=False)
class Unit:
    """The SI unit of numbers, which marks their type; or the field `of` that names the parameter
    with this unit."""

    name: Units = ""
    of: str = ""

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        described = dict(handler(schema))
        if self.name and isinstance(self.name, str):
            described["unit"] = self.name
        return described


UNITS: dict[str, str] = {}  # units of parameters by their names, filled by `disc_model.parameters`

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?+"
"""A number in a text; its exponent is not taken for a unit."""
_PLAIN_NUMBER = re.compile(rf"\s*{NUMBER}\s*")
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s*((?:1/)?[A-Za-zµΩ°%].*)")
_POWER = r"[A-Za-zµΩ°%]+(?:\*\*-?\d)?"
_UNIT = re.compile(rf"(?:1/)?{_POWER}(?:(?:\s*[*/]\s*|\s+){_POWER}){{0,5}}\s*")
"""A product of units to small powers; longer expressions could take arbitrarily long to evaluate."""
_ANGLES = ("rad", "deg", "gon", "turn", "revolution", "rpm", "rps", "cycle", "°")
_SPELLINGS = str.maketrans(
    {"\u03bc": "µ", "\u2126": "Ω", "·": "*", "⋅": "*", "∙": "*"}
    | {sign: f"^{digit}" for sign, digit in zip("²³⁴⁵⁶⁷⁸⁹", "23456789", strict=True)}
    | {"⁻": "^-", "¹": "^1"}
)
"""The Greek mu, the sign of the ohm, dots of products and superscripts, as the parser of units has
them."""
_OTHER_WORDS = {"rev": "turn", "revs": "turn", "RPM": "rpm", "Rpm": "rpm"}
_PER_MINUTE = ("1/min", "min**-1", "1/minute", "minute**-1")  # of a speed of rotation: turns
_MISLEADING = {"gr": "g", "grad": "deg", "ton": "t", "Nm": "N m", "Ns": "N s", "Kg": "kg"}
"""Words for other units than they seem to be (grain, a hundredth of a right angle, short ton,
nanometre) or for none, and what is meant."""
_EXAMPLES = {"N": "kN", "Pa": "GPa", "m": "mm", "N/m": "kN/m", "kg": "g", "s": "ms"}
"""Units of the kind of others that readers often use."""


@functools.lru_cache(maxsize=1)
def _units() -> Any:
    import pint  # the import takes a second, and few callers need it

    return pint.UnitRegistry()


def _plain_unit(text: str) -> str:
    """The text of a unit in the spelling of its parser: powers with **, and turns for
    revolutions."""
    text = text.translate(_SPELLINGS).replace("^-^", "^-").replace("**", "^").strip()
    text = re.sub(r"(?<=[A-Za-zµΩ])(?=-?\d)", "^", text)  # kg/m3, kg m-3
    text = re.sub(r"[A-Za-z]+", lambda word: _OTHER_WORDS.get(word[0], word[0]), text)
    return text.replace("^", "**")


@functools.lru_cache(maxsize=1024)
def converted(magnitude: float, text: str, unit: str) -> float:
    """A number with a unit, as the number in another unit; raises ValueError, or an error of pint
    or of Python's tokenizer, which have no common base."""
    if text.strip() == unit:  # needs no parser, whose import takes a second
        return magnitude
    text = _checked_unit(text, unit)
    return _in_unit(_units().Quantity(magnitude, text), unit)


def _checked_unit(text: str, unit: str) -> str:
    """The text of a unit for its parser, if it can only mean one of the kind of another one; raises
    ValueError."""
    text = _plain_unit(text)
    if not _UNIT.fullmatch(text):
        raise ValueError("no unit")
    if any(word in _MISLEADING for word in re.findall(r"\w+", text)):
        raise ValueError("another unit than it seems to be")
    if unit.startswith("rad") and not _has_angle(text):
        if text not in _PER_MINUTE:
            raise ValueError("Hz may mean turns or radians")
        return "rpm"
    return text


def _has_angle(text: str) -> bool:
    """Whether the text of a unit names an angle."""
    return any(word in text for word in _ANGLES)


def _in_unit(quantity: Any, unit: str) -> float:
    """A quantity of pint as the number in a unit of the same kind; raises ValueError, or an error
    of pint. Angles, which have no dimension, count: a frequency in Hz is one of turns, and what has
    a unit without an angle is given in none with one."""
    registry = quantity._REGISTRY
    text = str(quantity.units)
    if unit == "Hz" and _has_angle(text):
        return float(f"{quantity.to(registry.Unit('rad/s')).magnitude / math.tau:.15g}")
    if not unit.startswith("rad") and _has_angle(text):
        raise ValueError("an angle where the unit has none")
    if unit == "1/s" and "hertz" in text:
        raise ValueError("Hz may mean turns")
    return _rounded(quantity, registry.Unit("" if unit == "1" else unit))


def _rounded(quantity: Any, target: Any) -> float:
    """A quantity of pint as the number in a unit, with 15 digits, so that equal decimal numbers are
    equal in any unit; as it is in the same unit."""
    if quantity.units == target:
        return float(quantity.magnitude)
    return float(f"{quantity.to(target).magnitude:.15g}")


def size_of_unit(unit: str, target: str) -> float:
    """One of a unit in another one; 0 if it is not of its kind."""
    faults: list[Fault] = []
    size = in_si(f"1 {unit}", target, faults, ())
    return size if isinstance(size, float) and not faults else 0.0


def is_quantity(value: object) -> bool:
    """Whether a value is a quantity of pint."""
    return hasattr(value, "magnitude") and hasattr(value, "units") and hasattr(value, "to")


def _quantity_in_si(value: Any, unit: str) -> Any:
    """A quantity of pint, or an array of them as a list, in SI; raises as `converted`."""
    if getattr(value.magnitude, "ndim", 0):
        return [_quantity_in_si(part, unit) for part in value]
    text = format(value.units, "C")
    if unit.startswith("rad") and not _has_angle(text):
        return converted(float(value.magnitude), text, unit)
    return _in_unit(value, unit)


def _data_in_si(value: Any, text: str, unit: str) -> Any:
    """Numbers of xarray with the text of their unit, in SI; raises as `converted`."""
    if text == unit == "1":
        return value
    if value.ndim == 0:
        return converted(number(value), text, unit)
    factor = converted(1.0, text, unit)
    return value if factor == 1.0 else factor * value.values


def _unit_fault(path: tuple[str, ...], value: Any, text: str, unit: str) -> Fault:
    """The fault of a number whose unit is unknown, ambiguous or of another kind."""
    rule = f"must be a number in {unit}, or with a unit of its kind"
    if unit == "1":
        rule = "must be a number without a unit"
    if unit == "rad/s":
        rule += ", such as rpm; Hz may mean turns or radians"
    if unit == "1/s":
        rule += ", such as 1/min; Hz and rpm may mean turns"
    meant = [_MISLEADING[word] for word in re.findall(r"\w+", text) if word in _MISLEADING]
    if meant:
        rule += f", did you mean {meant[0]}?"
    elif unit in _EXAMPLES:
        rule += f", such as {_EXAMPLES[unit]}"
    return Fault.of(path, value, rule)


def in_si(value: Any, unit: Units, faults: list[Fault], path: tuple[str, ...]) -> Any:
    """A value with all texts within it that have a unit, such as ``"150 GPa"``, and all quantities
    of pint and single numbers of xarray with a unit, as numbers in the given unit. A unit of
    another kind is a fault at its `path`."""
    if not unit or type(value) is float:
        return value
    if isinstance(value, dict):
        units = dict.fromkeys(value, unit) if isinstance(unit, str) else unit
        return {x: in_si(value[x], units.get(x, ""), faults, (*path, str(x))) for x in value}
    if type(value) in (list, tuple):
        parts = enumerate(value)
        return type(value)(in_si(part, unit, faults, (*path, str(i))) for i, part in parts)
    if not isinstance(unit, str):
        return value
    return _single_in_si(value, unit, faults, path)


def _single_in_si(value: Any, unit: str, faults: list[Fault], path: tuple[str, ...]) -> Any:
    """A text, a quantity or a number of xarray in a unit; as it is if it has no unit."""
    text = ""
    try:
        if isinstance(value, str):
            if match := _WITH_UNIT.fullmatch(value.translate(_SPELLINGS)):
                text = match[2]
                return converted(float(match[1]), text, unit)
        elif is_quantity(value):
            text = str(value.units)
            return _quantity_in_si(value, unit)
        elif "units" in getattr(value, "attrs", {}):
            text = str(value.attrs["units"])
            return _data_in_si(value, text, unit)
    except Exception:  # of pint and of Python's tokenizer, which have no common base
        faults.append(_unit_fault(path, value, text, unit))
    return value


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
    if isinstance(value, bool) or not isinstance(value, str | int | float | numbers.Real):
        raise ValueError("must be a number")
    try:
        return float(value) + 0.0
    except OverflowError:  # a whole number beyond the range of floats
        return math.inf if value > 0 else -math.inf  # type: ignore[operator]
    except ValueError:
        raise ValueError(f"must be a number{_of_comma(value)}") from None


def _of_comma(value: Any) -> str:
    """What to say of a text with a comma in place of a decimal point; "" of others."""
    if isinstance(value, str) and re.match(r"\s*[-+]?\d+,\d", value):
        return ": decimals have a point in place of a comma"
    return ""


def whole(value: Any) -> Any:
    """A count by the rules of `number`: 4, 4.0 and "4" are the same, 4.5 is refused."""
    value = _scalar(value)
    if not is_whole(value) and not (value := number(value)).is_integer():
        raise ValueError("must be a whole number")
    return int(value)


def is_number(value: object) -> bool:
    """Whether a value is a number within the range of floats, or an array of one without
    dimensions; a text or a bool is not."""
    # the usual types first: the test for the abstract one takes several times as long
    if isinstance(value, bool | float):
        return isinstance(value, float)
    value = _scalar(value)
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return False
    try:
        float(value)
    except OverflowError:
        return False
    return True


def is_whole(value: object) -> TypeGuard[int]:
    """Whether a value is a whole number by its type, Python's or numpy's; a bool is not."""
    return isinstance(value, numbers.Integral) and not isinstance(value, bool)


def _limits_rule(limits: tuple[float, float]) -> str:
    return f"must be within {limits[0]:g} and {limits[1]:g}"


def limits_faults(name: str, value: Any, limits: tuple[float, float]) -> list[str]:
    """Faults of an argument that must be a number within limits."""
    good = is_number(value) and limits[0] <= value <= limits[1]
    return [] if good else [Fault.of((name,), value, _limits_rule(limits))]


def must(holds: Callable[[Any], bool], rule: str) -> Callable[[Any], Any]:
    """A validator for pydantic, which refuses values by a rule."""

    def checked(value: Any) -> Any:
        if not holds(value):
            raise ValueError(rule)
        return value

    return checked


def within(limits: tuple[float, float]) -> AfterValidator:
    """A validator for pydantic, which refuses numbers outside of limits."""
    return AfterValidator(must(lambda value: limits[0] <= value <= limits[1], _limits_rule(limits)))


Real = Annotated[float, BeforeValidator(number)]
Finite = Annotated[Real, Field(allow_inf_nan=False)]
Positive = Annotated[
    Real, Field(gt=0, allow_inf_nan=False, json_schema_extra={"exclusiveMinimum": 0})
]
Count = Annotated[int, BeforeValidator(whole)]
Seconds = Annotated[Positive, Unit("s")]
Speed = Annotated[Positive, Unit("rad/s")]
Tolerance = Annotated[Real, Unit("s"), within(TOLERANCES)]
CycleTolerance = Annotated[Real, within(CYCLE_TOLERANCES)]


# ---- Bases


@functools.cache
def _marks(model: type[BaseModel]) -> dict[str, Unit]:
    """Units of the fields of a model, from their schema or from their type."""
    marks = {}
    for name, field in model.model_fields.items():
        extra = field.json_schema_extra
        parts = [*field.metadata]
        if isinstance(extra, dict) and "unit" in extra:
            parts = [Unit(str(extra["unit"]))]
        parts.append(field.annotation)
        for part in parts:
            parts += get_args(part)
        if mark := next((part for part in parts if isinstance(part, Unit)), None):
            marks[name] = mark
    return marks


def plain_type(annotation: Any) -> Any:
    """A type as a reader knows it: without validators and units."""
    if get_origin(annotation) is Annotated:
        return plain_type(get_args(annotation)[0])
    parts = get_args(annotation)
    if not parts or get_origin(annotation) is Literal:
        return annotation
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is Union:
        joined = plain_type(parts[0])
        for part in parts[1:]:
            joined = joined | plain_type(part)
        return joined
    if get_origin(annotation) in (tuple, list, dict):
        return types.GenericAlias(get_origin(annotation), tuple(map(plain_type, parts)))
    return annotation


def plain_signature(model: type[BaseModel]) -> inspect.Signature:
    """The arguments of a model as a reader knows them: names, plain types and defaults."""
    arguments = []
    for name, field in model.model_fields.items():
        default = field.get_default(call_default_factory=True, validated_data={})
        arguments.append(
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                default=inspect.Parameter.empty if field.is_required() else default,
                annotation=plain_type(field.annotation),
            )
        )
    return inspect.Signature(arguments)


class _Model(ModelMetaclass):
    """Models of which `dir`, and so help and completion, show their own names, not pydantic's."""

    def __dir__(cls) -> list[str]:
        own = {name for base in cls.__mro__ if base not in BaseModel.__mro__ for name in vars(base)}
        own -= {"model_config", "model_post_init"}
        return sorted(name for name in own if not name.startswith("_"))


class Strict(BaseModel, metaclass=_Model):
    """Base of all models of input: immutable, no unknown keys, numbers converted to SI. Its
    `ParameterError` lists all faults, those of parts too; rules between values are checked where
    each by itself is right."""

    # JSON has no infinities: they are texts, which `number` reads
    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings")

    if not TYPE_CHECKING:  # type checkers have the fields from pydantic

        def __init__(self, /, *unnamed: Any, **data: Any) -> None:
            if unnamed:
                kind = type(self)
                named = f"{next(iter(kind.model_fields))}=..."
                raise TypeError(f"{kind.__name__} takes values by name, such as {named}")
            try:
                super().__init__(**data)
            except ValidationError as error:
                raise ParameterError(*faults_of(error, data, type(self))) from None

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        super().__pydantic_init_subclass__(**kwargs)
        cls.__signature__ = plain_signature(cls)

    @model_validator(mode="wrap")
    @classmethod
    def _in_si(cls, data: Any, handler: Any) -> Any:
        """Refuse names that are not text, on which pydantic would fail, and convert numbers with
        units."""
        if isinstance(data, dict):
            rule = "a name must be text, and a number have a decimal point"
            faults = [Fault.of((repr(x),), data[x], rule) for x in data if not isinstance(x, str)]
            data = in_si(data, cls._units(data), faults, ())
            raise_faults(faults)
        return handler(data)

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        """SI units of the values that have one, by the marks of their types."""
        units = {name: mark.name for name, mark in _marks(cls).items()}
        chosen = {name: mark.of for name, mark in _marks(cls).items() if mark.of}
        return units | {
            x: UNITS.get(str(data.get(by, cls.model_fields[by].default)), "")
            for x, by in chosen.items()
        }

    @classmethod
    def model_validate(cls, obj: Any, **kwargs: Any) -> Self:
        """The model from a mapping."""
        try:
            return super().model_validate(dict(obj) if isinstance(obj, Mapping) else obj, **kwargs)
        except ValidationError as error:
            raise ParameterError(*faults_of(error, obj, cls)) from None

    @classmethod
    def model_validate_json(cls, json_data: str | bytes | bytearray, **kwargs: Any) -> Self:
        """The model from the JSON that `model_dump_json` writes."""
        try:
            return super().model_validate_json(json_data, **kwargs)
        except ValidationError as error:
            raise ParameterError(*faults_of(error, _parsed(json_data), cls)) from None

    if not TYPE_CHECKING:

        def __setattr__(self, name: str, value: Any) -> None:
            kind = type(self)
            if name in kind.model_fields:
                rule = f"is frozen: use replace({name}={as_text(value)}), which returns a copy"
                raise ParameterError(Fault((kind.__name__, name), "", rule))
            if not name.startswith("_"):
                rule = f"has no {name}{suggestion(name, kind.model_fields)}"
                raise ParameterError(Fault((kind.__name__,), "", rule))
            super().__setattr__(name, value)

    def replace(self, **changes: Any) -> Self:
        """A validated copy with some values changed."""
        return type(self)(**{**dict(self), **changes})


def _parsed(text: str | bytes | bytearray) -> Any:
    """What a JSON text holds, of whatever kind; None if it is no JSON."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def given_values(model: Strict) -> dict[str, Any]:
    """The values of a model that were given, in the order of its fields."""
    return {
        name: getattr(model, name)
        for name in type(model).model_fields
        if name in model.model_fields_set
    }
