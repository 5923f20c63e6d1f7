"""The model's parameters: immutable, validated, in SI units, with a stable content hash."""

from __future__ import annotations

import difflib
import hashlib
import json
import math
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from disc_model.errors import ParameterError
from disc_model.schema import Count, Real, number, shown


def _diameters(value: Any) -> Any:
    """Refuse a word that only files and command lines understand, and say who does."""
    if value == "auto":
        raise ValueError("must be a whole number; disc_model.choose_modes finds one")
    return value


def _field(default: Any, unit: str, description: str, **rules: Any) -> Any:
    """A finite number with a unit; pydantic's rule keywords (`ge`, `gt`, `lt`, `le`) pass through."""
    return Field(default, description=description, json_schema_extra={"unit": unit}, allow_inf_nan=False, **rules)


def _count(default: int, highest: int, description: str) -> Any:
    return Field(default, description=description, json_schema_extra={"unit": "1"}, ge=0, le=highest)


def _choice(default: str, description: str) -> Any:
    return Field(default, description=description, json_schema_extra={"unit": ""})


class Parameters(BaseModel):
    """One case of the disc and slider. Base values are the paper's Table 1; `N` and `Omega` have none.

    A plain value. `disc_model.choose_modes` finds how many modes a tolerance asks for.

    Raises
    ------
    ParameterError
        Naming every parameter that breaks a rule, its value and the rule, in one message.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=False)

    N: Real = _field(..., "N", "preload pressing the slider onto the disc", ge=0)
    Omega: Real = _field(..., "rad/s", "speed of the drive point", ge=0)
    D_star: Real = _field(1e-5, "N m s", "Kelvin-Voigt damping of the disc", ge=0)
    c: Real = _field(0.0, "N s/m", "damper of the slider, normal to the disc", ge=0)
    c_p: Real = _field(0.0, "N s/m", "damper of the slider, in the disc's plane", ge=0)
    k: Real = _field(5e4, "N/m", "spring of the slider, normal to the disc", ge=0)
    k_p: Real = _field(2e4, "N/m", "spring of the slider, in the disc's plane", ge=0)
    E: Real = _field(150e9, "Pa", "Young's modulus of the disc", gt=0)
    m: Real = _field(0.1, "kg", "mass of the slider", gt=0)
    mu_s: Real = _field(0.4, "1", "coefficient of static friction", ge=0)
    mu_k: Real = _field(0.24, "1", "coefficient of kinetic friction", ge=0)
    a: Real = _field(0.044, "m", "inner radius of the disc, clamped", gt=0)
    b: Real = _field(0.12, "m", "outer radius of the disc, free", gt=0)
    r_0: Real = _field(0.1, "m", "radius at which the slider runs", gt=0)
    h: Real = _field(0.002, "m", "thickness of the disc", gt=0)
    nu: Real = _field(0.211, "1", "Poisson's ratio of the disc", gt=-1, lt=0.5)
    rho: Real = _field(7200.0, "kg/m^3", "density of the disc", gt=0)
    n_diameters: Annotated[Count, BeforeValidator(_diameters)] = _count(4, 60, "highest number of nodal diameters")
    n_circles: Count = _count(0, 20, "highest number of nodal circles")
    normalization: Literal["as_published", "orthonormal"] = _choice(
        "as_published", "scale of the mode shapes: coefficient of J_l equal to 1, or Eq. (17)"
    )
    contact: Literal["separable", "bonded"] = _choice("separable", "whether the slider may leave the disc")

    def __init__(self, /, **data: Any) -> None:
        faults: list[str] = []
        try:
            super().__init__(**data)
        except ValidationError as error:
            faults += [_fault(type(self), item) for item in error.errors(include_url=False)]
        faults += _cross_faults(type(self), data)
        if faults:
            raise ParameterError(*faults) from None

    @classmethod
    def model_validate(cls, obj: Any, **kwargs: Any) -> Self:
        """As pydantic's, but a mapping's faults come as one `ParameterError`, as everywhere."""
        if isinstance(obj, Mapping):
            if unnamed := [key for key in obj if not isinstance(key, str)]:
                raise ParameterError(*(f"{key!r}={obj[key]!r}: a parameter's name must be text" for key in unnamed))
            return cls(**obj)
        if isinstance(obj, cls):
            return obj
        raise ParameterError(f"parameters={obj!r}: must be a mapping of names to values")

    @classmethod
    def model_validate_json(cls, json_data: str | bytes | bytearray, **kwargs: Any) -> Self:
        """Parameters from JSON text, with the same errors as the constructor."""
        return cls.model_validate(json.loads(json_data))

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy; unlike pydantic's, what `update` changes is validated."""
        return self.replace(**(update or {}))

    def replace(self, **changes: Any) -> Self:
        """A validated copy with some values changed."""
        return type(self)(**{**self.model_dump(), **changes})

    @property
    def D(self) -> float:
        """Flexural rigidity E h^3/12/(1 - nu^2), N m."""
        return _rigidity(self.E, self.h, self.nu)

    @property
    def canonical_json(self) -> str:
        """The values as JSON with sorted keys: equal for equal parameters, however they were written."""
        return json.dumps(self.model_dump(), sort_keys=True, separators=(",", ":"))

    @property
    def key(self) -> str:
        """Stable content hash: the first 12 hexadecimal digits of the sha256 of `canonical_json`."""
        return hashlib.sha256(self.canonical_json.encode()).hexdigest()[:12]

    @classmethod
    def unit(cls, name: str) -> str:
        """SI unit of a parameter; "1" if it has no dimension, "" if it is a choice."""
        extra = cls.model_fields[name].json_schema_extra
        return str(extra["unit"]) if isinstance(extra, dict) else ""


def _rigidity(E: float, h: float, nu: float) -> float:
    return E * h**3 / 12 / (1 - nu**2)


def _shown_field(model: type[BaseModel], name: str, value: Any) -> str:
    """Numbers as the float they stand for, so that a message does not depend on the spelling."""
    if model.model_fields[name].annotation is float:
        try:
            return repr(number(value))
        except ValueError:
            pass
    return shown(value)


_RULES: dict[str, Callable[[dict[str, Any]], str]] = {
    "greater_than_equal": lambda ctx: f"must be >= {ctx['ge']:g}",
    "greater_than": lambda ctx: f"must be > {ctx['gt']:g}",
    "less_than": lambda ctx: f"must be < {ctx['lt']:g}",
    "less_than_equal": lambda ctx: f"must be <= {ctx['le']:g}",
    "finite_number": lambda ctx: "must be finite",
    "literal_error": lambda ctx: f"must be {ctx['expected']}",
}


def _fault(model: type[BaseModel], item: Any) -> str:
    """One of pydantic's error items as ``name=value: rule``."""
    name, kind = str(item["loc"][0]), item["type"]
    if kind == "missing":
        return f"{name}: is required"
    if kind == "extra_forbidden":
        return f"{name}={shown(item['input'])}: unknown parameter{_suggestion(name, model)}"
    value = _shown_field(model, name, item["input"])
    if kind in _RULES:
        return f"{name}={value}: {_RULES[kind](item.get('ctx', {}))}"
    reason = str(item.get("ctx", {}).get("error", item["msg"]))
    return f"{name}={value}: {reason if reason.startswith('must') else 'must be a number'}"


def _suggestion(name: str, model: type[BaseModel]) -> str:
    known = list(model.model_fields)
    folded = {field.lower(): field for field in known}
    close = difflib.get_close_matches(name.lower(), folded, n=1, cutoff=0.6)
    return f", did you mean {folded[close[0]]}?" if close else f" (known: {', '.join(known)})"


def _cross_faults(model: type[BaseModel], data: Mapping[str, Any]) -> list[str]:
    """Rules between parameters, checked where both sides are finite numbers: no fault hides another."""
    values: dict[str, float] = {}
    for name in ("mu_s", "mu_k", "a", "b", "r_0", "E", "h", "nu"):
        try:
            value = number(data.get(name, model.model_fields[name].default))
        except ValueError:
            continue
        if math.isfinite(value):
            values[name] = value
    faults = []

    def require(low: str, high: str, holds: Callable[[float, float], bool], rule: str) -> None:
        if low in values and high in values and not holds(values[low], values[high]):
            faults.append(f"{low}={values[low]!r}: must be {rule} {high}={values[high]!r}")

    require("mu_k", "mu_s", lambda x, y: x <= y, "<=")
    require("a", "r_0", lambda x, y: x < y, "<")
    require("r_0", "b", lambda x, y: x <= y, "<=")
    if values.keys() >= {"E", "h", "nu"} and values["E"] > 0 and values["h"] > 0 and abs(values["nu"]) < 1:
        try:
            rigidity = _rigidity(values["E"], values["h"], values["nu"])
        except OverflowError:
            rigidity = math.inf
        if not 0 < rigidity < math.inf:
            faults.append(f"h={values['h']!r}: must give a finite, positive E h^3/12/(1-nu^2), not {rigidity!r}")
    return faults
