"""The validated parameters of the model, in SI units."""

from __future__ import annotations

import inspect
import math
import operator
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, get_args

import pydantic
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from disc_model.errors import Fault, ImplausibleValue, as_text, raise_faults
from disc_model.hashing import canonical_json, content_key
from disc_model.modal_disc import Disc, Quantity
from disc_model.units import UNITS, Count, Finite, Real, Strict, in_si, is_number, must, number

RESIDUAL = "residual"  # value of ``contact_compliance`` that stands for the static flexibility of the modes left out
NUMBER_OR_WORD = ("contact_compliance", "friction_offset")  # parameters that are one or the other
SURFACE = "surface"  # value of ``friction_offset`` by which friction acts on the disc's surface

# parameters in rules that relate several
RELATED = ("mu_s", "mu_k", "a", "b", "r_0", "E", "h", "nu", "disc")
# parameters of the plate, which have no meaning for a disc that is given by its modes
PLATE = (
    *("D_star", "E", "a", "b", "h", "nu", "rho"),
    *("n_diameters", "n_circles", "normalization", "stretching"),
)
PLATE_NAME = "plate"
"""What a disc is called that is given by its sizes and material, beside discs given by their modes."""
RATIOS = {  # of two parameters, which may stand for the first one
    "mu_k_over_mu_s": ("mu_k", "mu_s"),
    "k_p_over_k": ("k_p", "k"),
    "c_p_over_c": ("c_p", "c"),
    "a_over_b": ("a", "b"),
    "r_0_over_b": ("r_0", "b"),
    "h_over_b": ("h", "b"),
}
CONTACTS = {"separable": "unilateral", "bonded": "bilateral"}  # old words of files, still read
FORMAT: Literal[1] = (
    1  # of the texts that identify cases and batches; another number makes other hashes
)


MOST_DAMPED = 0.05  # damping ratio above which it is doubted: discs of metal have 0.0001 to 0.01
SOFTEST = 1e9  # Pa, Young's modulus below which it is doubted
READER = 4  # frames from a warning to the line that makes a case

_ORDER: tuple[tuple[str, str, Callable[[Any, Any], bool], str], ...] = (
    ("mu_k", "<=", operator.le, "mu_s"),
    ("a", "<", operator.lt, "r_0"),
    ("r_0", "<=", operator.le, "b"),
)
_ORDER_BESIDE_DISC = _ORDER[:1]  # a disc that is given by its modes has other radii than the plate
# values of parameters at which the model is without the law that they belong to
_WITHOUT_LAW = {
    "contact_compliance": 0,
    "contact_arc": 0,
    "friction_offset": 0,
    "friction_decay": math.inf,
    "viscous_friction": 0,
}
_Distance = Annotated[
    Real, AfterValidator(must(lambda value: 0 <= value < math.inf, "must be a finite number >= 0"))
]
# Beyond, the start of slip is lost in rounding.
_DECAY = must(lambda value: value <= 1e12 or value == math.inf, "must be at most 1e12 s/m, or inf")
# What only files and the command line accept is refused with the name of the function to use
# instead.
_READ = must(
    lambda value: not isinstance(value, str),
    "must be a Disc: disc_model.Disc.from_csv reads a table of modes",
)


def _field(default: Any, unit: str, description: str, **rules: Any) -> Any:
    """A field with a unit, "" for a choice; `rules` are pydantic's keywords such as `ge`, `gt`,
    `lt` and `le`."""
    return Field(default, description=description, json_schema_extra={"unit": unit}, **rules)


class Parameters(Strict):
    """One case of disc and slider, in SI units. Defaults are the paper's Table 1.

    The radii of the plate must ascend, a < r_0 <= b, and mu_k must not be above mu_s.
    `disc_model.choose_modes` finds how many modes a tolerance asks for. A ratio may stand for its
    first one: mu_k_over_mu_s, k_p_over_k, c_p_over_c, a_over_b, r_0_over_b, h_over_b; it stays what
    it is in changed copies.

    Raises
    ------
    ParameterError
        Naming every parameter that breaks a rule, its value and the rule, in one message. Rules between parameters are
        checked where each value by itself is right.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N="385 N", Omega="145 rpm", mu_k_over_mu_s=0.5)
    >>> round(case.Omega, 3), case.mu_k, case.replace(mu_s=0.5).mu_k
    (15.184, 0.2, 0.25)
    >>> dm.Parameters(N=-1, Omga=3)
    Traceback (most recent call last):
        ...
    disc_model.errors.ParameterError: N=-1: must be >= 0; Omega: is required; ... did you mean Omega?
    """

    _word: ClassVar[str] = "parameter"
    _ratios: dict[str, float] = pydantic.PrivateAttr(default_factory=dict)

    N: Finite = _field(..., "N", "preload pressing the slider onto the disc", ge=0)
    Omega: Finite = _field(..., "rad/s", "speed of the drive point", ge=0)
    D_star: Finite = _field(1e-5, "N m s", "Kelvin-Voigt damping of the disc", ge=0)
    c: Finite = _field(0.0, "N s/m", "damper of the slider, normal to the disc", ge=0)
    c_p: Finite = _field(0.0, "N s/m", "damper of the slider, in the disc's plane", ge=0)
    k: Finite = _field(5e4, "N/m", "spring of the slider, normal to the disc", ge=0)
    k_p: Finite = _field(2e4, "N/m", "spring of the slider, in the disc's plane", ge=0)
    E: Finite = _field(150e9, "Pa", "Young's modulus of the disc", gt=0)
    m: Finite = _field(0.1, "kg", "mass of the slider", gt=0)
    mu_s: Finite = _field(0.4, "1", "coefficient of static friction", ge=0)
    mu_k: Finite = _field(0.24, "1", "coefficient of kinetic friction", ge=0)
    a: Finite = _field(0.044, "m", "inner radius of the disc, clamped", gt=0)
    b: Finite = _field(0.12, "m", "outer radius of the disc, free", gt=0)
    r_0: Finite = _field(0.1, "m", "radius at which the slider runs", gt=0)
    h: Finite = _field(0.002, "m", "thickness of the disc", gt=0)
    nu: Finite = _field(0.211, "1", "Poisson's ratio of the disc", gt=-1, lt=0.5)
    rho: Finite = _field(7200.0, "kg/m^3", "density of the disc", gt=0)
    n_diameters: Count = _field(
        4, "1", "highest number of nodal diameters, -1 for a rigid disc", ge=-1, le=60
    )
    n_circles: Count = _field(0, "1", "highest number of nodal circles", ge=0, le=20)
    normalization: Literal["as_published", "orthonormal"] = _field(
        "as_published", "", "scale of the mode shapes: coefficient of J_l equal to 1, or Eq. (17)"
    )
    contact: Annotated[
        Literal["unilateral", "bilateral"],
        BeforeValidator(lambda word: CONTACTS.get(word, word) if isinstance(word, str) else word),
    ] = _field(
        "unilateral",
        "",
        "whether the slider may leave the disc: bilateral contact holds it, but lets it slide",
    )
    contact_compliance: _Distance | Literal["residual"] = _field(
        0.0,
        "m/N",
        "compliance of the contact, 0 if it is rigid; residual: that of the modes left out",
    )
    contact_arc: Finite = _field(
        0.0,
        "rad",
        "arc at r_0 over which the slider presses evenly, as a pad; 0: at a point",
        ge=0,
        lt=math.tau,
    )
    contact_force: Literal["vertical", "normal"] = _field(
        "vertical",
        "",
        "direction of the contact force: vertical as in the paper, or normal to the bent disc",
    )
    friction_offset: _Distance | Literal["surface"] = _field(
        0.0,
        "m",
        "height above the disc's middle plane at which friction acts; surface: h/2, or by the table of a disc",
    )
    friction_decay: Annotated[Real, AfterValidator(_DECAY)] = _field(
        math.inf,
        "s/m",
        "d, by which friction falls from mu_s to mu_k with the slip speed; inf: mu_k at any speed",
        ge=0,
    )
    friction_law: Literal["hyperbolic", "exponential"] = _field(
        "hyperbolic",
        "",
        "how friction falls with the slip speed v: as 1/(1 + d v), or as exp(-d v)",
    )
    viscous_friction: Finite = _field(
        0.0, "s/m", "increase of the coefficient of friction with the slip speed", ge=0
    )
    damping_ratio: Annotated[Real, Field(ge=0, lt=1, allow_inf_nan=False)] | None = _field(
        None, "1", "damping ratio of every mode of the plate, from 0 to below 1, instead of D_star"
    )
    stretching: Literal["none", "clamped", "free"] = _field(
        "none",
        "",
        "whether the plate stretches as it bends, with its inner edge clamped or free in its plane",
    )
    disc: Annotated[Disc, BeforeValidator(_READ, json_schema_input_type=str)] | None = _field(
        None, "", "a disc given by its modes, instead of the plate"
    )

    if TYPE_CHECKING:  # for type checkers, which know no texts with units from the fields

        def __init__(  # noqa: PLR0913
            self, *, N: Quantity, Omega: Quantity, D_star: Quantity = ..., c: Quantity = ..., c_p: Quantity = ...,
            k: Quantity = ..., k_p: Quantity = ..., E: Quantity = ..., m: Quantity = ..., mu_s: Quantity = ...,
            mu_k: Quantity = ..., a: Quantity = ..., b: Quantity = ..., r_0: Quantity = ..., h: Quantity = ...,
            nu: Quantity = ..., rho: Quantity = ..., n_diameters: Quantity = ..., n_circles: Quantity = ...,
            normalization: str = ..., contact: str = ..., contact_compliance: Quantity = ...,
            contact_arc: Quantity = ..., contact_force: str = ..., friction_offset: Quantity = ...,
            friction_decay: Quantity = ..., friction_law: str = ..., viscous_friction: Quantity = ...,
            damping_ratio: Quantity | None = ..., stretching: str = ..., disc: Disc | None = ...,
            mu_k_over_mu_s: float = ..., k_p_over_k: float = ..., c_p_over_c: float = ...,
            a_over_b: float = ..., r_0_over_b: float = ..., h_over_b: float = ...,
        ) -> None: ...  # fmt: skip

    @model_validator(mode="wrap")
    @classmethod
    def _with_ratios(cls, data: Any, handler: Any) -> Any:
        """Find the parameters that follow from ratios, and remember these."""
        if cls is not Parameters or not isinstance(data, dict) or not (data.keys() & RATIOS.keys()):
            return handler(data)
        faults: list[Fault] = []
        ratios = in_si({name: data[name] for name in RATIOS if name in data}, "1", faults, ())
        faults += _ratio_faults(ratios, data)
        others = {name: value for name, value in data.items() if name not in ratios}
        values = in_si(others, UNITS, faults, ())
        raise_faults(faults)
        with suppress(ValueError):  # of a wrong value, which the fields report
            values |= _followed(ratios, values)
        p = handler(values)
        p.__pydantic_private__["_ratios"] = {name: float(value) for name, value in ratios.items()}
        return p

    @pydantic.model_serializer(mode="wrap")
    def _with_ratios_in_json(
        self, handler: Any, info: pydantic.SerializationInfo
    ) -> dict[str, Any]:
        """In JSON, have the ratios by which the case was given, and not what follows from them.
        Leave out a plate that does not stretch, so that older content addresses stay valid."""
        values = handler(self)
        if values.get("stretching") == "none":
            del values["stretching"]
        if info.mode == "json":
            return _as_stated(values, self._ratios)
        return values

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between parameters, what a disc excludes, and that the plate has one
        damping. A rule on a parameter that is absent, as in `SomeParameters`, does not count."""
        raise_faults([*self._surface_faults(), *self._pad_faults()])
        raise_faults([*self._unused_faults(), *self._order_faults(), *self._rigidity_faults()])
        for text in self._doubts():
            warnings.warn(text, ImplausibleValue, stacklevel=READER)
        return self

    def _doubts(self) -> Iterator[str]:
        """Yield what is implausible of the plate and the damping, which mistaken units make so."""
        damping = [self.damping_ratio or 0.0]
        if self.disc is not None:
            damping = [*self.disc.damping_ratio]
        if max(damping) > MOST_DAMPED:
            yield f"damping ratio above {MOST_DAMPED:g}: it is a fraction of critical damping, not per cent"
        if self.disc is not None or None in (self.a, self.b, self.h, self.E):
            return
        if self.h > 0.2 * (self.b - self.a):
            yield "h is more than a fifth of b - a: the disc is modelled as a thin plate"
        if self.E < SOFTEST:
            yield f"E is below {SOFTEST:g} Pa: Young's modulus is a number in Pa, or has a unit, as in '150 GPa'"

    def _surface_faults(self) -> Iterator[Fault]:
        """Yield the fault of friction on the surface of a disc whose motion there is not known."""
        on_surface = self.friction_offset == SURFACE
        if on_surface and self.disc is not None and not self.disc.tangential:
            need = "must be a number for a disc whose table has no column tangential_per_sqrt_kg"
            yield Fault.of(("friction_offset",), SURFACE, need)

    def _pad_faults(self) -> Iterator[Fault]:
        """Yield the fault of residual flexibility under a pad on a disc given by its modes, of
        which only that under a point is known."""
        if self.disc is not None and self.contact_arc and self.contact_compliance == RESIDUAL:
            need = "must be a number beside contact_arc for a disc given by its modes: "
            need += "its static_compliance is that at a point"
            yield Fault.of(("contact_compliance",), RESIDUAL, need)

    def _unused_faults(self) -> Iterator[Fault]:
        """Yield faults of given parameters that a disc or a damping ratio replaces."""
        unused: list[str] = []
        rule = ""
        if self.disc is not None:
            unused = sorted([*PLATE, "damping_ratio"])
            rule = "must be left out where a disc is given: it is a parameter of the plate"
        elif self.damping_ratio is not None:
            unused = ["D_star"]
            rule = "must be left out where damping_ratio is given"
        for name in unused:
            value = getattr(self, name)
            if value != type(self).model_fields[name].default:
                yield Fault.of((name,), value, rule)

    def _order_faults(self) -> Iterator[Fault]:
        """Yield faults of parameters that must not exceed another one."""
        order = _ORDER
        if self.disc is not None:
            order = _ORDER_BESIDE_DISC
        for low, sign, holds, high in order:
            lower = getattr(self, low)
            upper = getattr(self, high)
            if lower is not None and upper is not None and not holds(lower, upper):
                yield Fault.of((low,), lower, f"must be {sign} {high}={as_text(upper)}")

    def _rigidity_faults(self) -> Iterator[Fault]:
        """Yield the fault of a flexural rigidity beyond the range of floats."""
        E = self.E
        h = self.h
        nu = self.nu
        if E is not None and h is not None and nu is not None:
            # unlike a power, a product overflows to inf
            rigidity = E * (h * h * h) / 12 / (1 - nu**2)
            if not 0 < rigidity < math.inf:
                rule = f"must give a finite, positive E h^3/12/(1-nu^2), not {as_text(rigidity)}"
                yield Fault.of(("h",), h, rule)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some values changed; for a disc given by its modes also its
        `Disc.numbers`.

        A ratio by which the case was given, such as mu_k_over_mu_s, stays what it is, unless its
        first one changes. Raises `ParameterError` as the constructor.
        """
        if self.disc is not None and "disc" not in changes:
            of_disc = self.disc.numbers.keys() & changes.keys()
            numbers = {name: changes.pop(name) for name in of_disc}
            if numbers:
                changes["disc"] = self.disc.with_numbers(**numbers)

        ratios: dict[str, Any] = {}
        for name, value in self._ratios.items():
            if RATIOS[name][0] not in changes:
                ratios[name] = value
        for name, value in changes.items():
            if name in RATIOS:
                ratios[name] = value
        follow = _first_ones(ratios)
        values = {name: getattr(self, name) for name in self.model_fields_set if name not in follow}
        return type(self)(**{**values, **changes, **ratios})

    @property
    def numbers(self) -> dict[str, float]:
        """All numbers of the case that may change continuously, by name: parameters, ratios and
        `Disc.numbers`, tangential ones where friction acts on the surface."""
        unused: set[str] = set()
        if self.damping_ratio is not None:
            unused = {"D_star"}
        elif self.disc is not None:
            unused = {*PLATE}
        for name, without in _WITHOUT_LAW.items():
            if getattr(self, name) == without:
                unused.add(name)

        numbers: dict[str, float] = {}
        for name, value in self:
            if isinstance(value, float) and name not in unused:
                numbers[name] = value
        ratios: dict[str, float] = {}
        for name, (upper, lower) in RATIOS.items():
            if upper in numbers and numbers.get(lower):
                ratios[name] = numbers[upper] / numbers[lower]
        numbers |= ratios
        if self.disc is not None:
            for name, value in self.disc.numbers.items():
                if self.friction_offset == SURFACE or not name.startswith("tangential"):
                    numbers[name] = value
        return numbers

    @property
    def stated(self) -> dict[str, Any]:
        """The values by name, with the ratios by which the case was given instead of the numbers
        that follow them."""
        return _as_stated(dict(self), self._ratios)

    def __repr_args__(self) -> Iterator[tuple[str, Any]]:
        """What is given, and not as in Table 1."""
        for name, value in self.stated.items():
            if DEFAULTS.get(name, ...) != value:
                yield name, value

    @property
    def D(self) -> float:
        """Flexural rigidity E h^3/12/(1 - nu^2), N m."""
        return self.E * self.h**3 / 12 / (1 - self.nu**2)

    @property
    def canonical(self) -> dict[str, Any]:
        """The values that identify a case: all of them, but for those of the plate if the disc is
        given by its modes."""
        return self.model_dump(exclude={*PLATE} if self.disc is not None else None)

    @property
    def canonical_json(self) -> str:
        """The values as JSON with sorted keys, equal for equal parameters however they were
        written."""
        return canonical_json(self.canonical)

    @property
    def key(self) -> str:
        """Stable content hash: the first 12 hexadecimal digits of the sha256 of
        `canonical_json` with the format of these texts."""
        return content_key(canonical_json({"format": FORMAT, **self.canonical}))

    @classmethod
    def unit(cls, name: str) -> str:
        """SI unit of a parameter: "1" for a dimensionless one, "" for a choice or an unknown
        name."""
        return UNITS.get(name, "")


UNITS.update(Parameters._units({}))  # type: ignore[arg-type]

DEFAULTS = {
    name: field.default
    for name, field in Parameters.model_fields.items()
    if not field.is_required()
}


_SIGNS = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}


def _documented() -> str:
    """The docstring with the fields: meaning, unit, range and default of each."""
    lines = ["\nParameters\n----------"]
    for name, field in Parameters.model_fields.items():
        unit = Parameters.unit(name).removeprefix("1")
        limits = []
        for rule in field.metadata:
            limits += [f"{_SIGNS[x]} {getattr(rule, x):g}" for x in _SIGNS if hasattr(rule, x)]
        words = " or ".join(word for word in get_args(field.annotation) if isinstance(word, str))
        default = "required"
        if is_number(field.default):
            default = f"default {field.default:g}"
        elif not field.is_required():
            default = f"default {field.default}"
        phrase = ", ".join(filter(None, [unit, *limits, words, default]))
        lines.append(f"{name} : {field.description} ({phrase})")
    text = inspect.cleandoc(str(Parameters.__doc__))
    return text.replace("\nRaises\n", "\n".join([*lines, "\nRaises\n"]))


Parameters.__doc__ = _documented()


def with_ratios(values: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a case, with the parameters that follow from the `RATIOS` among them."""
    completed = dict(values)
    for ratio in values.keys() & RATIOS.keys():
        name, other = RATIOS[ratio]
        completed[name] = values[ratio] * values.get(other, Parameters.model_fields[other].default)
    return completed


def case_of(values: Mapping[str, Any], discs: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a point that belong to its case, without starts and samples; a disc's name
    becomes its table. Ratios stay ratios, so that they are kept where the case is varied further."""
    known = (*Parameters.model_fields, *RATIOS)
    case = {name: value for name, value in values.items() if name in known}
    if isinstance(case.get("disc"), str):
        case["disc"] = discs[case["disc"]]
    return case


def foreign_case(case: object) -> list[str]:
    """Faults of an argument `case`, which must be `Parameters`."""
    if isinstance(case, Parameters):
        return []
    return [Fault.of(("case",), case, "must be Parameters")]


def _ratio_faults(ratios: Mapping[str, Any], data: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield faults of ratios, and of those that are given beside the parameter they stand for."""
    for name, value in ratios.items():
        first = RATIOS[name][0]
        if first in data:
            yield Fault.of((name,), value, f"must not be given beside {first}")
        elif not (is_number(value) and 0 <= value < math.inf):
            yield Fault.of((name,), value, "must be a finite number >= 0")


def _first_ones(ratios: Iterable[str]) -> set[str]:
    """Return the parameters for which ratios stand."""
    return {RATIOS[name][0] for name in ratios}


def _followed(ratios: Mapping[str, float], values: Mapping[str, Any]) -> dict[str, float]:
    """Return the parameters that follow from ratios and from the values of others; raises
    `ValueError` if one of these is no number."""
    known = dict(ratios)
    for _, lower in RATIOS.values():
        if lower in values:
            known[lower] = number(values[lower])
    completed = with_ratios(known)
    return {name: completed[name] for name in _first_ones(ratios)}


def _as_stated(values: Mapping[str, Any], ratios: Mapping[str, float]) -> dict[str, Any]:
    """Return values of a case with ratios instead of the parameters for which they stand."""
    follow = _first_ones(ratios)
    stated = {name: value for name, value in values.items() if name not in follow}
    stated |= ratios
    return stated
