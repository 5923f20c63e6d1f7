"""What all schemas of this package share: kinds of numbers, strict bases, and how pydantic's faults are said."""

from __future__ import annotations

import difflib
import json
import math
import numbers
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Self, get_args

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from disc_model.errors import Fault, ParameterError

# ----------------------------------------------------------------------------------------------------
# Numbers

TOLERANCES = (1e-15, 1e-2)
"""Least and greatest tolerance of a simulation: relative truncation error of a step."""
CYCLE_TOLERANCES = (1e-14, 1e-6)
"""Those of the search for a cycle: relative residual of the return map."""


def number(value: Any) -> Any:
    """Turn what stands for a number into a float; leave the rest for pydantic to refuse.

    Strings are accepted because YAML reads ``1e-3`` as one. A bool is no number here, although Python says
    so.
    """
    if isinstance(value, bool) or not isinstance(value, str | int | float | numbers.Real):
        raise ValueError("must be a number")
    try:
        return float(value) + 0.0  # adding zero turns -0.0 into 0.0
    except OverflowError:  # a whole number beyond the range of floats
        return math.inf if str(value)[0] != "-" else -math.inf
    except ValueError:
        raise ValueError("must be a number") from None


def whole(value: Any) -> Any:
    """Like `number`, for counts: 4, 4.0 and "4" are the same, 4.5 is refused."""
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    found = number(value)
    if not found.is_integer():
        raise ValueError("must be a whole number")
    return int(found)


def is_number(value: object) -> bool:
    """Whether a value is a number already, and not what `number` would make one of."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def limits_rule(limits: tuple[float, float]) -> str:
    """What a number within limits, such as `TOLERANCES`, has to be."""
    return f"must be within {limits[0]:g} and {limits[1]:g}"


def limits_faults(name: str, value: Any, limits: tuple[float, float]) -> list[str]:
    """What is wrong with an argument that must be a number within limits."""
    good = is_number(value) and limits[0] <= value <= limits[1]
    return [] if good else [Fault((name,), shown(value), limits_rule(limits))]


def _within(limits: tuple[float, float]) -> AfterValidator:
    def checked(value: float) -> float:
        if not limits[0] <= value <= limits[1]:
            raise ValueError(limits_rule(limits))
        return value

    return AfterValidator(checked)


Real = Annotated[float, BeforeValidator(number)]
Finite = Annotated[Real, Field(allow_inf_nan=False)]
Positive = Annotated[Real, Field(gt=0, allow_inf_nan=False, json_schema_extra={"exclusiveMinimum": 0})]
Count = Annotated[int, BeforeValidator(whole)]
Tolerance = Annotated[Real, _within(TOLERANCES)]
CycleTolerance = Annotated[Real, _within(CYCLE_TOLERANCES)]


# ----------------------------------------------------------------------------------------------------
# Bases


class Strict(BaseModel):
    """What a file says: immutable, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Checked(Strict):
    """What a caller says: as `Strict`, but its faults come as one `ParameterError`, whichever way it is made."""

    _word: ClassVar[str] = "key"

    def __init__(self, /, **data: Any) -> None:
        faults: list[str] = []
        try:
            super().__init__(**data)
        except ValidationError as error:
            faults += faults_of(error, data, type(self), self._word)
        faults += self._more_faults(data)
        if faults:
            raise ParameterError(*faults) from None

    @classmethod
    def _more_faults(cls, data: Mapping[str, Any]) -> list[str]:
        """Rules that pydantic does not check, for `data` as it was given."""
        return []

    @classmethod
    def model_validate(cls, obj: Any, **kwargs: Any) -> Self:
        """From a mapping, with the same errors as the constructor."""
        if isinstance(obj, Mapping):
            if unnamed := [key for key in obj if not isinstance(key, str)]:
                rule = f"a {cls._word}'s name must be text"
                raise ParameterError(*(Fault((repr(key),), shown(obj[key]), rule) for key in unnamed))
            return cls(**obj)
        if isinstance(obj, cls):
            return obj
        raise ParameterError(Fault((cls.__name__.lower(),), shown(obj), "must be a mapping of names to values"))

    @classmethod
    def model_validate_json(cls, json_data: str | bytes | bytearray, **kwargs: Any) -> Self:
        """From JSON text, with the same errors as the constructor."""
        try:
            values = json.loads(json_data)
        except (ValueError, TypeError, RecursionError) as error:
            raise ParameterError(Fault(("json_data",), shown(json_data), f"must be JSON ({error})")) from None
        return cls.model_validate(values)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy; unlike pydantic's, what `update` changes is validated."""
        return self.replace(**(update or {}))

    def replace(self, **changes: Any) -> Self:
        """A validated copy with some values changed."""
        return type(self)(**{**{name: getattr(self, name) for name in type(self).model_fields}, **changes})


# ----------------------------------------------------------------------------------------------------
# Faults


def faults_of(error: ValidationError, raw: Any, model: type[BaseModel], word: str = "key") -> Iterator[Fault]:
    """Pydantic's faults as this package says them.

    Parameters
    ----------
    raw : what was validated
    model : as what; an unknown name is told with those that its fields have
    word : what the names name
    """
    for item in error.errors(include_url=False):
        path, kind, value = _path(item, raw), item["type"], item["input"]
        reason = item.get("ctx", {}).get("error")
        if isinstance(reason, ParameterError):  # of a `Checked` inside
            for fault in reason.faults:
                inner = fault if isinstance(fault, Fault) else Fault((), "", fault)
                yield Fault((*path, *inner.path), inner.value, inner.rule)
        elif kind == "missing":
            yield Fault(path, "", "is required")
        elif kind == "extra_forbidden":
            known = _fields_at(model, item["loc"][:-1])
            yield Fault(path, shown(value), f"unknown {word}{suggestion(path[-1], known, all_of_them=word == 'key')}")
        else:
            yield Fault(path, _shown_faulty(kind, value), _rule(item))


_BOUNDS: dict[str, Callable[[dict[str, Any]], str]] = {
    "greater_than_equal": lambda ctx: f"must be >= {ctx['ge']:g}",
    "greater_than": lambda ctx: f"must be > {ctx['gt']:g}",
    "less_than": lambda ctx: f"must be < {ctx['lt']:g}",
    "less_than_equal": lambda ctx: f"must be <= {ctx['le']:g}",
    "finite_number": lambda ctx: "must be finite",
}
_RULES: dict[str, Callable[[dict[str, Any]], str]] = _BOUNDS | {
    "literal_error": lambda ctx: f"must be {ctx['expected']}",
    "value_error": lambda ctx: str(ctx["error"]),
    "string_pattern_mismatch": lambda ctx: f"must match {ctx['pattern']}",
    "too_short": lambda ctx: f"must have {ctx['min_length']} or more",
    **dict.fromkeys(("bool_type", "bool_parsing"), lambda ctx: "must be true or false"),
    **dict.fromkeys(("dict_type", "mapping_type", "model_type"), lambda ctx: "must be a mapping"),
    **dict.fromkeys(("list_type", "tuple_type"), lambda ctx: "must be a list"),
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float"), lambda ctx: "must be a whole number"),
    "string_type": lambda ctx: "must be text",
}


def _rule(item: Any) -> str:
    say = _RULES.get(item["type"])
    return say(item.get("ctx", {})) if say else item["msg"].replace("Input should be", "must be")


def _shown_faulty(kind: str, value: Any) -> str:
    """A value that breaks a rule; a mapping says nothing that its path does not."""
    if isinstance(value, Mapping | BaseModel):
        return ""
    try:
        return shown(number(value) if kind in _BOUNDS else value)
    except ValueError:  # pydantic counts False, which is no number here
        return shown(value)


def shown(value: Any) -> str:
    """A value as messages show it: short, and numbers as -1 whether they were written -1, -1.0 or "-1"."""
    text = repr(value)
    if isinstance(value, float):
        return text.removesuffix(".0")
    return text if len(text) <= 60 else text[:57] + "..."


def suggestion(name: str, known: Collection[str], all_of_them: bool) -> str:
    """What may have been meant, and what there is; of many names only the one that comes close, if one does."""
    folded = {field.lower(): field for field in known}
    close = difflib.get_close_matches(name.lower(), folded, n=1, cutoff=0.6)
    meant = f", did you mean {folded[close[0]]}?" if close else ""
    return meant + (f" (known: {', '.join(known)})" if known and (all_of_them or not close) else "")


def _fields_at(model: type[BaseModel], place: Sequence[Any]) -> list[str]:
    """Names of the fields of the models that lie at a place inside a model; names of branches are passed over."""
    here = [model]
    for step in place:
        inside = [
            each for one in here if step in one.model_fields for each in _models(one.model_fields[step].annotation)
        ]
        here = inside or here
    return list(dict.fromkeys(name for one in here for name in one.model_fields))


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Models that a type mentions."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in get_args(annotation) for model in _models(part)]


def _path(item: Any, raw: Any) -> tuple[str, ...]:
    """Where a fault lies in the input: pydantic's place also has names of a union's branches, which are not there."""
    place: tuple[Any, ...] = item["loc"]
    value, absent = item["input"], ()
    if item["type"] == "missing":
        place, absent = place[:-1], place[-1:]
    elif place[-1:] == ("[key]",) and place[-2:-1] == (value,):  # the key itself is at fault
        return tuple(map(str, place[:-1]))
    found = list(_readings(place, raw))
    path = next((path for path, end in found if end is value), found[0][0] if found else place)
    return tuple(map(str, (*path, *absent)))


def _readings(place: Sequence[Any], here: Any) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """Ways through the input along `place`, and where they end: a step leads on where there is such a key or index."""
    if not place:
        yield (), here
        return
    step, rest = place[0], place[1:]
    if (step in here) if isinstance(here, Mapping) else isinstance(here, list | tuple) and isinstance(step, int):
        for path, end in _readings(rest, here[step]):
            yield (step, *path), end
    if isinstance(step, str):
        yield from _readings(rest, here)
