"""The validated parameters of the model, in SI units."""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, cast

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from disc_model.errors import ImplausibleValue, as_text, require
from disc_model.modal_disc import Disc
from disc_model.provenance import content_key
from disc_model.units import UNITS, Count, Finite, Real, Strict, in_si, must

RESIDUAL = "residual"  # value of ``contact_compliance`` that stands for the static flexibility of the modes left out
NUMBER_OR_WORD = ("contact_compliance", "friction_offset")  # parameters that are one or the other
SURFACE = "surface"  # value of ``friction_offset`` by which friction acts on the disc's surface

# parameters in rules that relate several
RELATED = ("mu_s", "mu_k", "a", "b", "r_0", "E", "h", "nu")
# parameters of the plate, which have no meaning for a disc that is given by its modes
PLATE = (
    *("D_star", "E", "a", "b", "h", "nu", "rho"),
    *("n_diameters", "n_circles", "normalization", "stretching"),
)

MOST_DAMPED = 0.05  # damping ratio above which it is doubted: discs of metal have 0.0001 to 0.01
SOFTEST = 1e9  # Pa, Young's modulus below which it is doubted
READER = 4  # frames from a warning to the line that makes a case

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
    `disc_model.choose_modes` finds how many modes a tolerance asks for.

    Parameters
    ----------
    N : preload that presses the slider onto the disc (N, >= 0)
    Omega : speed of the drive point (rad/s, >= 0)
    m : mass of the slider (kg, > 0)
    k, c : spring and damper of the slider, normal to the disc (N/m and N s/m, >= 0)
    k_p, c_p : the same in the disc's plane
    mu_s, mu_k : coefficients of static and of kinetic friction (>= 0)
    friction_decay, friction_law : d, by which friction falls from mu_s to mu_k with the slip speed v (s/m; inf: at
        once): "hyperbolic", as 1/(1 + d v), or "exponential", as exp(-d v)
    viscous_friction : increase of the coefficient of friction with the slip speed (s/m, >= 0)
    friction_offset : height above the disc's middle plane at which friction acts (m, >= 0), or "surface": h/2, or by
        the table of a disc
    contact : "unilateral", or "bilateral": the slider cannot leave the disc, but slides
    contact_compliance : of the contact (m/N, >= 0; 0 if it is rigid), or "residual": that of the modes left out
    contact_arc : arc at r_0 over which the slider presses evenly, as a pad (rad, 0 to 2 pi; 0: at a point)
    contact_force : "vertical" as in the paper, or "normal" to the bent disc
    a, b, r_0, h : inner (clamped) and outer (free) radius of the plate, radius of the slider, thickness (m, > 0)
    E, nu, rho : Young's modulus (Pa, > 0), Poisson's ratio (-1 to 0.5) and density (kg/m^3, > 0) of the plate
    D_star : Kelvin-Voigt damping of the plate (N m s, >= 0)
    damping_ratio : of every mode of the plate (0 to 1), instead of D_star
    n_diameters, n_circles : highest numbers of nodal diameters (-1 to 60; -1: a rigid disc) and circles (0 to 20)
    normalization : scale of the mode shapes, "as_published" (coefficient of J_l equal to 1) or "orthonormal", Eq. (17)
    stretching : whether the plate stretches as it bends: "none", or its inner edge is "clamped" or "free" in its plane
    disc : a `Disc` given by its modes, instead of the plate

    Raises
    ------
    ParameterError
        Naming every parameter that breaks a rule, its value and the rule, in one message. Rules between parameters are
        checked where each value by itself is right.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N="385 N", Omega="145 rpm")
    >>> round(case.Omega, 3), case.replace(mu_s=0.5).mu_k
    (15.184, 0.24)
    >>> dm.Parameters(N=-1, Omga=3)
    Traceback (most recent call last):
        ...
    disc_model.errors.ParameterError: N=-1: must be >= 0; Omega: is required; ... did you mean Omega?
    """

    _unknown: ClassVar[str] = "unknown parameter"

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
    contact: Literal["unilateral", "bilateral"] = _field(
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

    if TYPE_CHECKING:  # type checkers, which know no texts with units from the fields

        def __init__(self, **values: Any) -> None: ...

    @field_validator("*", mode="before")
    @classmethod
    def _in_si(cls, value: Any, info: ValidationInfo) -> Any:
        return in_si(value, cls.unit(str(info.field_name)))

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between parameters, what a disc excludes, and that the plate has one
        damping. A rule on a parameter that is absent, as in `SomeParameters`, does not count."""
        self._check_disc()
        self._check_related()
        for text in self._doubts():
            warnings.warn(text, ImplausibleValue, stacklevel=READER)
        return self

    def _doubts(self) -> Iterator[str]:
        """Yield what is implausible of the plate and the damping, which mistaken units make so."""
        damping: tuple[float, ...] = (self.damping_ratio or 0.0,)
        if self.disc is not None:
            damping = self.disc.damping_ratio
        if max(damping) > MOST_DAMPED:
            yield f"damping ratio above {MOST_DAMPED:g}: it is a fraction of critical damping, not per cent"
        if self.disc is not None or None in (self.a, self.b, self.h, self.E):
            return
        if self.h > 0.2 * (self.b - self.a):
            yield "h is more than a fifth of b - a: a thin plate is too stiff, Disc.from_section is not"
        if self.E < SOFTEST:
            yield f"E is below {SOFTEST:g} Pa: Young's modulus is a number in Pa, or has a unit, as in '150 GPa'"

    @property
    def _replaced(self) -> tuple[str, ...]:
        """Parameters that a disc given by its modes, or a damping ratio, replaces."""
        if self.disc is not None:
            return (*PLATE, "damping_ratio")
        if self.damping_ratio is not None:
            return ("D_star",)
        return ()

    def _check_disc(self) -> None:
        """Refuse parameters that are replaced, and laws of contact that need to know more of a disc
        given by its modes."""
        disc = self.disc
        by = "damping_ratio is given" if disc is None else "a disc is given: it is of the plate"
        rule = f"must be left out where {by}"
        fields = type(self).model_fields
        replaced = {name: getattr(self, name) for name in self._replaced}
        need = "must be a number for a disc whose table has no column tangential_per_sqrt_kg"
        point = "must be a number beside contact_arc for a disc given by its modes: "
        point += "its static_compliance is that at a point"
        surface = disc is None or disc.tangential or self.friction_offset != SURFACE
        known = disc is None or not self.contact_arc or self.contact_compliance != RESIDUAL
        require(
            *((value == fields[x].default, x, value, rule) for x, value in replaced.items()),
            (surface, "friction_offset", SURFACE, need),
            (known, "contact_compliance", RESIDUAL, point),
        )

    def _check_related(self) -> None:
        """Refuse parameters that exceed another one, and a flexural rigidity beyond the range of
        floats."""
        values = [getattr(self, name) for name in RELATED]
        if None in values:
            return
        mu_s, mu_k, a, b, r_0, E, h, nu = values
        rigidity = E * (h * h * h) / 12 / (1 - nu**2)  # a power would not overflow to inf
        finite = f"must give a finite, positive E h^3/12/(1-nu^2), not {as_text(rigidity)}"
        plate = self.disc is None  # a disc given by its modes has other radii
        require(
            (mu_k <= mu_s, "mu_k", mu_k, f"must be <= mu_s={as_text(mu_s)}"),
            (a < r_0 or not plate, "a", a, f"must be < r_0={as_text(r_0)}"),
            (r_0 <= b or not plate, "r_0", r_0, f"must be <= b={as_text(b)}"),
            (0 < rigidity < math.inf, "h", h, finite),
        )

    @property
    def numbers(self) -> dict[str, float]:
        """All numbers of the case that may change continuously, by name."""
        without = [name for name, value in _WITHOUT_LAW.items() if getattr(self, name) == value]
        unused = (*self._replaced, *without)
        return {x: y for x, y in self if isinstance(y, float) and x not in unused}

    def __repr_args__(self) -> Iterator[tuple[str, Any]]:
        """What is given, and not as in Table 1."""
        for name, value in self:
            if DEFAULTS.get(name, ...) != value:
                yield name, value

    @property
    def D(self) -> float:
        """Flexural rigidity E h^3/12/(1 - nu^2), N m."""
        return self.E * self.h**3 / 12 / (1 - self.nu**2)

    @property
    def canonical(self) -> dict[str, Any]:
        """The values that identify a case, as JSON has them: all of them, but for those of the plate if the
        disc is given by its modes."""
        return self.model_dump(mode="json", exclude={*PLATE} if self.disc is not None else None)

    @property
    def canonical_json(self) -> str:
        """The values as JSON with sorted keys, equal for equal parameters however they were
        written."""
        return json.dumps(self.canonical, sort_keys=True)

    @property
    def key(self) -> str:
        """Content hash: the first 12 hexadecimal digits of the sha256 of `canonical_json`."""
        return content_key(self.canonical_json)

    @classmethod
    def unit(cls, name: str) -> str:
        """SI unit of a parameter: "1" for a dimensionless one, "" for a choice or an unknown
        name."""
        return UNITS.get(name, "")


for _name, _each in Parameters.model_fields.items():
    UNITS[_name] = cast(dict[str, str], _each.json_schema_extra)["unit"]

DEFAULTS = {
    name: field.default
    for name, field in Parameters.model_fields.items()
    if not field.is_required()
}


def require_case(case: object) -> None:
    """Raise `ParameterError` for an argument `case` that is no `Parameters`."""
    require((isinstance(case, Parameters), "case", case, "must be Parameters"))
