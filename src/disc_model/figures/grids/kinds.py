"""The kinds of figures of grid studies, and what a study file may say of each. Imports nothing heavy."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Protocol

from pydantic import Field

from disc_model.data.variables import KICKS, SAMPLE
from disc_model.errors import suggestion
from disc_model.parameters import Parameters, Real, Strict, Title

Number = Annotated[Real, Field(allow_inf_nan=False)]
Values = Mapping[str, Sequence[tuple[Any, ...]]]
"""Values of the parameters along each dimension of a grid."""
NORM = "normalization"
"""The dimension that a study may have beside those that a figure needs."""


class Fault(NamedTuple):
    """What is wrong with a figure: where below its name, the value there, and the rule."""

    place: tuple[str, ...]
    value: Any
    rule: str


class Role(NamedTuple):
    """What a further study must be to be shown: its quantity, or another instead that has as much; its dimensions but
    for `NORM`, if they are not those of the figure itself; and some options."""

    quantity: str
    dims: tuple[str, ...] | None = None
    options: Mapping[str, Any] = {}
    required: bool = False
    instead: str = ""


Roles = Mapping[str, Role]
"""What further studies a figure can show, by the role that they play in it."""


class Grid(Protocol):
    """What there is to know of a study: a `disc_model.studies.grids.schema.GridStudy` is one."""

    @property
    def quantity(self) -> str: ...

    @property
    def options(self) -> Any: ...

    @property
    def base(self) -> Mapping[str, Any]: ...

    @property
    def values(self) -> Values: ...


class Plot(Strict):
    """A figure of a grid study, drawn by the module beside this one that its kind names.

    That module's ``draw(study, others, plot)`` takes datasets and this.

    others : further studies it shows, by the role they play in it
    quantities : those that it can show, the usual one first
    needs : dimensions that it needs, beside those that the file chooses as x and y
    several : whether it has a panel for each normalization, and not room for one only
    roles : what others it can show
    """

    quantities: ClassVar[tuple[str, ...]] = ()
    needs: ClassVar[tuple[str, ...]] = ()
    several: ClassVar[bool] = False
    roles: ClassVar[Roles] = {}

    kind: str
    title: Title = ""
    others: dict[str, str] = Field({})

    @property
    def module(self) -> str:
        """Module that draws it."""
        return f"{__package__}.{self.kind}"

    @property
    def axes(self) -> dict[str, str]:
        """Dimensions that the file chooses, by the axis that they lie along."""
        return {axis: name for axis in ("x", "y") if (name := getattr(self, axis, None)) is not None}

    @property
    def dims(self) -> tuple[str, ...]:
        """All dimensions that it needs."""
        return (*self.needs, *self.axes.values())

    def faults(self, values: Values) -> Iterator[Fault]:
        """What keeps it from showing a study with these dimensions; one without values is only meant to be there."""
        yield from list(self._wrong_axes(values)) or self._wrong_dims(values)
        for role, name in self.others.items():
            if role not in self.roles:
                yield Fault(("others", role), name, f"unknown role{suggestion(role, self.roles)}")
        for role, wanted in self.roles.items():
            if wanted.required and role not in self.others:
                yield Fault(("others", role), "", f"is required: a study of the quantity {wanted.quantity}")

    def _wrong_axes(self, values: Values) -> Iterator[Fault]:
        """Of those that the file chooses."""
        for axis, name in self.axes.items():
            if name not in values:
                yield Fault((axis,), name, f"is no dimension of this study{suggestion(name, values)}")
            elif name not in KICKS and (name not in Parameters.model_fields or not Parameters.unit(name)):
                yield Fault((axis,), name, "must be one parameter, and a number")
        if len({*self.axes.values()}) < len(self.axes):
            yield Fault(("y",), self.axes["y"], "must differ from x")

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Dimensions that it needs and the study has not, and the other way round."""
        allowed = (*self.dims, NORM)
        further = [name for name in values if values[name] and name not in allowed]
        if missing := [name for name in self.dims if name not in values]:
            yield Fault(("kind",), self.kind, f"needs the dimension {' and '.join(missing)}")
        elif further:
            yield Fault(("kind",), self.kind, f"can show {', '.join(allowed)}, but not {', '.join(further)} as well")
        elif not self.several and len(values.get(NORM, ())) > 1:
            yield Fault(("kind",), self.kind, f"can show one {NORM} only")

    def misfits_of(self, role: str, study: Grid, other: Grid) -> Iterator[str]:
        """Rules that a further study breaks, if it is to play a role in this figure of a study."""
        wanted = self.roles[role]
        if other.quantity not in (wanted.quantity, wanted.instead):
            good = " or ".join(filter(None, (wanted.quantity, wanted.instead)))
            yield f"must be a study of the quantity {good}, and not {other.quantity}"
            return
        for name, value in wanted.options.items():
            if (found := getattr(other.options, name)) != value:
                yield f"must have options.{name} = {value!r}, and not {found!r}"
        needs = self.dims if wanted.dims is None else wanted.dims
        if (dims := other.values.keys() - {NORM}) != set(needs):
            needed, found = (", ".join(sorted(names)) or "nothing" for names in (needs, dims))
            yield f"must vary {needed} beside {NORM}, and not {found}"
        elif lacking := _normalizations(study) - _normalizations(other):
            yield f"must be computed for the same {NORM}: {', '.join(sorted(lacking))}"


def _normalizations(study: Grid) -> set[str]:
    return {str(value) for (value,) in study.values.get(NORM, [(study.base.get(NORM),)])}


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it."""

    x: Number
    y: Number
    paper: Literal["stable", "unstable", "separation"]


CYCLE = Role("floquet", ("N", "Omega"), instead="regions")
CURVES = Role("stability_curves", (), {"x": "Omega", "y": "N"})


class StabilityMap(Plot):
    """What becomes of the published start over two parameters, one panel for each normalization."""

    quantities = ("outcome",)
    several = True
    roles: ClassVar[Roles] = {"growth": Role("floquet")}

    kind: Literal["stability_map"] = "stability_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    def faults(self, values: Values) -> Iterator[Fault]:
        """As of any figure; and what is marked must be computed, and not only lie between points that are."""
        yield from super().faults(values)
        for name, mark in self.marks.items():
            for axis, dim, value in (("x", self.x, mark.x), ("y", self.y, mark.y)):
                along = [float(one) for one, *more in values.get(dim, ()) if not more and not isinstance(one, str)]
                if along and not any(math.isclose(value, one, rel_tol=1e-12) for one in along):
                    yield Fault(("marks", name, axis), value, f"must be a value of {dim}, such as an extra one")


class RegionMap(StabilityMap):
    """Regions of outcomes over two parameters, and the growth rate of the cycle below."""

    quantities = ("regions",)
    roles: ClassVar[Roles] = {}

    kind: Literal["region_map"] = "region_map"  # type: ignore[assignment]


class CriticalSpeed(Plot):
    """Speeds at which separation begins or ends against the preload, for several horizons."""

    quantities = ("critical_speed",)
    needs = ("N",)
    roles: ClassVar[Roles] = {
        "hysteresis": Role("hysteresis", ("N",)),
        "cycle": CYCLE,
        "basins": Role("basins", ("Omega",)),
    }

    kind: Literal["critical_speed"] = "critical_speed"
    claim: dict[str, tuple[Number, Number]] = Field({})


class Thresholds(CriticalSpeed):
    """Where the cycle becomes unstable and where separation follows, on one chart."""

    roles: ClassVar[Roles] = {"curves": CURVES._replace(required=True), "cycle": CYCLE}

    kind: Literal["thresholds"] = "thresholds"  # type: ignore[assignment]


class GrowthMap(Plot):
    """Growth rate of the stick-slip cycle over speed and preload, a panel for each normalization.

    Of the quantity `regions` it is that of the cycle that the published start follows.
    """

    quantities = ("floquet", "regions")
    needs = ("N", "Omega")
    several = True
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["growth_map"] = "growth_map"


class Bifurcation(Plot):
    """Samples once a turn against a parameter.

    scale : of the variable, 1e3 for mrad or mm
    """

    quantities = ("bifurcation",)
    roles: ClassVar[Roles] = {"lyapunov": Role("lyapunov")}

    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    variable: Literal["psi", "psi_velocity", "P", "u", "w_point"] = "psi"
    scale: Number = 1.0e3


class BasinShares(Plot):
    """Shares of what many starts come to, the attractors, and the least kick that separates, against a parameter."""

    quantities = ("basins",)

    kind: Literal["basins"] = "basins"
    x: str


class RampedSpeeds(Plot):
    """Where separation begins on the way up and ends on the way down, against the rate of the speed's ramps."""

    quantities = ("ramps",)
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["ramps"] = "ramps"


MOST_PANELS, MOST_LINES = 4, 12
"""Values of a dimension that a general figure has room for."""


class Sensitivity(Plot):
    """Probabilities with their intervals, and Sobol indices of each distributed parameter; for up to four points."""

    quantities = ("sensitivity",)

    kind: Literal["sensitivity"] = "sensitivity"

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_PANELS:
            yield Fault(("kind",), self.kind, f"has room for {MOST_PANELS} points beside their samples, not {points}")


class Campbell(Plot):
    """Frequencies and growth rates against the speed, and where modes meet multiples of the stick-slip frequency.

    normalization : the one that is shown, where the study has several
    """

    quantities = ("campbell",)
    needs = ("Omega",)

    kind: Literal["campbell"] = "campbell"
    normalization: Literal["as_published", "orthonormal"] | None = None

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        """There may be several normalizations if the file says which is shown."""
        yield from super()._wrong_dims(values if self.normalization is None else {**values, NORM: ()})
        known = [str(one) for (one,) in values.get(NORM, ())]
        if self.normalization is not None and known and self.normalization not in known:
            yield Fault((NORM,), self.normalization, f"is not computed (known: {', '.join(known)})")


class General(Plot):
    """Any variable of any quantity over dimensions of the study, those of the quantity's own included.

    at : values at which the dimensions that are not shown are taken; those of one value need none
    by : a dimension with a panel, or a line, for each of its values; normalization if it varies
    log : whether the scale of the variable is logarithmic
    """

    room: ClassVar[int] = MOST_PANELS
    """How many values `by` may have."""

    variable: str
    x: str
    at: dict[str, Number | str] = Field({})
    by: str | None = None
    log: bool = False

    def faults_among(
        self, dims: Mapping[str, Sequence[Any]], variables: Mapping[str, Sequence[str]]
    ) -> Iterator[Fault]:
        """What keeps it from being drawn.

        Parameters
        ----------
        dims : values along each dimension, the quantity's own included; of a zip, tuples; none if it has faults
        variables : dimensions of each variable
        """
        if self.variable not in variables:
            yield Fault(("variable",), self.variable, f"unknown variable{suggestion(self.variable, variables)}")
            return
        own = {name: dims[name] for name in variables[self.variable] if name in dims}
        places = self.axes | ({"by": self.by} if self.by is not None else {})
        for place, name in places.items():
            yield from self._wrong_place(place, name, own)
        used = [*places.values()]
        for name in sorted({name for name in used if used.count(name) > 1}):
            place = "y" if self.axes.get("y") == name else "by"
            yield Fault((place,), name, "must differ from the other dimensions shown")
        left = {name: values for name, values in own.items() if name not in used}
        for name, value in self.at.items():
            if name not in left:
                yield Fault(("at", name), value, f"is no dimension that remains (known: {', '.join(left) or 'none'})")
            elif left[name] and not any(_same(value, one) for one in left[name]):
                yield Fault(("at", name), value, f"must be one of {_listed(left[name])}")
        for name, values in left.items():
            panels = self.by is None and name == NORM and len(values) <= self.room
            if name not in self.at and len(values) > 1 and not panels:
                yield Fault(("at", name), "", f"is required, or by: {name}; one of {_listed(values)}")

    def _wrong_place(self, place: str, name: str, own: Mapping[str, Sequence[Any]]) -> Iterator[Fault]:
        if name not in own:
            yield Fault((place,), name, f"is no dimension of {self.variable}{suggestion(name, own)}")
        elif place == "by":
            if len(own[name]) > self.room:
                yield Fault((place,), name, f"has {len(own[name])} values, and there is room for {self.room}")
        elif any(isinstance(value, str | tuple) for value in own[name]):
            yield Fault((place,), name, "must be one parameter, and a number")
        elif len(own[name]) == 1:
            yield Fault((place,), name, "must have two values or more")


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, str) or isinstance(other, str | tuple):
        return bool(one == other)
    return math.isclose(one, other, rel_tol=1e-12)


def _listed(values: Sequence[Any]) -> str:
    """A few values as messages show them."""
    said = [str(value) if isinstance(value, str | tuple) else f"{value:g}" for value in values]
    return ", ".join(said if len(said) <= 12 else [*said[:6], "...", said[-1]])


class HeatMap(General):
    """A variable in colour over two dimensions; a panel for each value of a third, if wanted."""

    kind: Literal["heat_map"] = "heat_map"
    y: str


class CurvePlot(General):
    """A variable against one dimension; a line for each value of a second, if wanted."""

    room = MOST_LINES

    kind: Literal["curve"] = "curve"


PLOTS: dict[str, type[Plot]] = {
    "heat_map": HeatMap,
    "curve": CurvePlot,
    "stability_map": StabilityMap,
    "region_map": RegionMap,
    "critical_speed": CriticalSpeed,
    "thresholds": Thresholds,
    "growth_map": GrowthMap,
    "bifurcation": Bifurcation,
    "ramps": RampedSpeeds,
    "basins": BasinShares,
    "sensitivity": Sensitivity,
    "campbell": Campbell,
}
