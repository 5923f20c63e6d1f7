"""Kinds of figures: their keys in a study file, the data they need, and what draws them. Imports nothing heavy."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from pydantic import Field

from disc_model.data.variables import PERTURBATIONS, SAMPLE
from disc_model.errors import Fault, suggestion
from disc_model.parameters import RATIOS, Finite, Parameters, Positive, Strict, Title, Unit, Units
from disc_model.simulation.case import Poincare, Window

Values = Mapping[str, Sequence[tuple[Any, ...]]]
"""Values of the parameters along each dimension of a grid."""
NORM = "normalization"
"""The dimension that a study may have beside those that a figure requires."""


class Kind(Strict):
    """A figure: its fields are what a study file may say of it.

    drawn_by : module below `disc_model.figures` and its function, if not ``draw`` of the module of its name in `grids`
    title : stands above the figure
    caption : stands below the figure in report, explorer and gallery; with it, nothing stands above
    """

    drawn_by: ClassVar[str] = ""

    kind: str
    title: Title = ""
    caption: str = ""

    @property
    def function(self) -> str:
        """Module and function that draw it, see `disc_model.figures.drawing.draw`."""
        return f"{__package__}.{self.drawn_by or f'{self.kind}.draw'}"

    @property
    def module(self) -> str:
        """Module that draws it."""
        return self.function.rpartition(".")[0]


# ----------------------------------------------------------------------------------------------------
# Of grid studies


class Role(NamedTuple):
    """Requirements on an overlay: its quantity, or an alternative with the same data; its dimensions except `NORM`, if
    they differ from the figure's; and some options.
    """

    quantity: str
    dims: tuple[str, ...] | None = None
    options: Mapping[str, Any] = {}
    required: bool = False
    instead: str = ""


Roles = Mapping[str, Role]
"""Further studies that a figure can show, by their role."""


class Plot(Kind):
    """A figure of a grid study, drawn by a function ``draw(study, overlays, plot)`` that takes datasets and this.

    overlays : further studies it shows, by the role they play in it
    quantities : those that it can show, the default first
    needs : required dimensions, beside those that the file chooses as x and y
    several : whether it can show several normalizations, or is drawn from the values for one
    roles : the roles that overlays may play
    """

    quantities: ClassVar[tuple[str, ...]] = ()
    needs: ClassVar[tuple[str, ...]] = ()
    several: ClassVar[bool] = False
    roles: ClassVar[Roles] = {}

    overlays: dict[str, str] = Field({})

    @property
    def axes(self) -> dict[str, str]:
        """Dimensions that the file chooses, by axis."""
        return {axis: name for axis in ("x", "y") if (name := getattr(self, axis, None)) is not None}

    @property
    def dims(self) -> tuple[str, ...]:
        """All dimensions that the figure needs."""
        return (*self.needs, *self.axes.values())

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults that keep it from showing a study with these dimensions; those without values have faults already."""
        yield from list(self._wrong_axes(values)) or self._wrong_dims(values)
        yield from self._wrong_overlays()

    def _wrong_overlays(self) -> Iterator[Fault]:
        """Roles that the figure does not have, and lacks."""
        for role, name in self.overlays.items():
            if role not in self.roles:
                yield Fault.of(
                    ("overlays", role),
                    name,
                    "unknown role" + (suggestion(role, self.roles) if self.roles else ", this kind has no overlays"),
                )
        for role, wanted in self.roles.items():
            if wanted.required and role not in self.overlays:
                yield Fault(("overlays", role), "", f"is required: a study of the quantity {wanted.quantity}")

    def _wrong_axes(self, values: Values) -> Iterator[Fault]:
        """Faults of the dimensions that the file chooses."""
        for axis, name in self.axes.items():
            if name not in values:
                yield Fault.of((axis,), name, f"is no dimension of this study{suggestion(name, values)}")
            elif name not in (*PERTURBATIONS, *RATIOS) and not Parameters.unit(name):
                yield Fault.of((axis,), name, "must be one parameter, and a number")
        if len({*self.axes.values()}) < len(self.axes):
            yield Fault.of(("y",), self.axes["y"], "must differ from x")

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Required dimensions that the study lacks, and dimensions of the study that the figure cannot show."""
        allowed = (*self.dims, NORM)
        further = [name for name in values if values[name] and name not in allowed]
        if missing := [name for name in self.dims if name not in values]:
            yield Fault.of(("kind",), self.kind, f"needs the dimension {' and '.join(missing)}")
        elif further:
            yield Fault.of(("kind",), self.kind, f"can show {', '.join(allowed)}, but not {', '.join(further)} as well")
        elif not self.several and len(values.get(NORM, ())) > 1:
            yield Fault.of(("kind",), self.kind, f"can show one {NORM} only")


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it."""

    x: Finite
    y: Finite
    paper_outcome: Literal["quiet", "growing", "separation"]


CYCLE = Role("floquet", ("N", "Omega"), instead="regions")
CURVES = Role("stability_curves", (), {"x": "Omega", "y": "N"})


class StabilityMap(Plot):
    """What becomes of the static start over two parameters, one panel for each normalization."""

    quantities = ("outcome",)
    several = True
    roles: ClassVar[Roles] = {"growth": Role("floquet")}

    kind: Literal["stability_map"] = "stability_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        axes = {axis: Parameters.unit(str(data.get(axis))) for axis in ("x", "y")}
        marks = data.get("marks")
        return super()._units(data) | {"marks": dict.fromkeys(marks, axes) if isinstance(marks, dict) else ""}

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults as of any figure; in addition, each marked case must be a computed point, not between points."""
        yield from super().faults(values)
        for name, mark in self.marks.items():
            for axis, dim, value in (("x", self.x, mark.x), ("y", self.y, mark.y)):
                along = [float(one) for one, *more in values.get(dim, ()) if not more and not isinstance(one, str)]
                if along and not any(math.isclose(value, one, rel_tol=1e-12) for one in along):
                    yield Fault.of(("marks", name, axis), value, f"must be a value of {dim}, such as an extra one")


class RegionMap(StabilityMap):
    """Regions of outcomes over two parameters, and the growth rate of the cycle below."""

    drawn_by = "stability_map.draw_regions"
    quantities = ("regions",)
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["region_map"] = "region_map"  # type: ignore[assignment]

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults as of any map; in addition, curves over speed and preload need that plane."""
        yield from super().faults(values)
        if "curves" in self.overlays and (self.x, self.y) != ("Omega", "N"):
            yield Fault.of(("overlays", "curves"), self.overlays["curves"], "needs x: Omega and y: N")


class CriticalSpeed(Plot):
    """Speeds at which separation begins or ends against the preload, for several horizons."""

    quantities = ("critical_speed",)
    needs = ("N",)
    roles: ClassVar[Roles] = {
        "hysteresis": Role("hysteresis", ("N",)),
        "cycle": CYCLE,
        "curves": CURVES,
        "basins": Role("basins", ("Omega",)),
    }

    kind: Literal["critical_speed"] = "critical_speed"
    paper_points: dict[str, tuple[Finite, Finite]] = Field({})


class Thresholds(CriticalSpeed):
    """Where the cycle becomes unstable and where separation follows, on one chart."""

    drawn_by = "critical_speed.draw"
    roles: ClassVar[Roles] = {"curves": CURVES._replace(required=True), "cycle": CYCLE}

    kind: Literal["thresholds"] = "thresholds"  # type: ignore[assignment]


class GrowthMap(Plot):
    """Growth rate of the stick-slip cycle over speed and preload, a panel for each normalization.

    Of the quantity `regions` it is that of the cycle that the static start follows.
    """

    quantities = ("floquet", "regions")
    needs = ("N", "Omega")
    several = True
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["growth_map"] = "growth_map"


class Bifurcation(Plot):
    """Samples once a turn against a parameter, and after how many switches the motion repeats.

    paper_cases : cases of the paper by name, each with its value of x
    """

    drawn_by = "motions.draw_bifurcation"
    quantities = ("bifurcation",)
    roles: ClassVar[Roles] = {"lyapunov": Role("lyapunov")}

    kind: Literal["bifurcation"] = "bifurcation"
    x: str
    variable: Literal["psi", "psi_velocity", "P", "u", "w_point"] = "psi"
    paper_cases: Annotated[dict[str, Finite], Unit(of="x")] = Field({})


class Branches(Plot):
    """Range of motion of all cycles found against one parameter, stable and unstable, and where a sweep jumps.

    paper_cases : cases of the paper by name, each with its value of the parameter
    """

    drawn_by = "motions.draw_branches"
    quantities = ("branches",)

    kind: Literal["branches"] = "branches"
    paper_cases: dict[str, Finite] = Field({})


class BasinShares(Plot):
    """Outcomes of many starts, the attractors, and the critical energy of separation, against a parameter."""

    drawn_by = "motions.draw_basins"
    quantities = ("basins",)

    kind: Literal["basins"] = "basins"
    x: str


class RampedSpeeds(Plot):
    """Where separation begins on the way up and ends on the way down, against the rate of the speed's ramps."""

    drawn_by = "motions.draw_ramps"
    quantities = ("ramps",)
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["ramps"] = "ramps"


MOST_PANELS, MOST_LINES = 4, 12
"""Greatest number of values of a dimension in a general figure."""


class Sensitivity(Plot):
    """Probabilities with their intervals, and Sobol indices of each distributed parameter; for up to four points."""

    quantities = ("sensitivity",)
    several = True

    kind: Literal["sensitivity"] = "sensitivity"

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_PANELS:
            rule = f"has room for {MOST_PANELS} points beside their samples, not {points}"
            yield Fault.of(("kind",), self.kind, rule)


class Campbell(Plot):
    """Frequencies and growth rates against the speed, and where modes meet multiples of the stick-slip frequency.

    normalization : the one that is shown, where the study has several
    """

    quantities = ("campbell",)
    needs = ("Omega",)

    kind: Literal["campbell"] = "campbell"
    normalization: Literal["as_published", "orthonormal"] | None = None

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Allow several normalizations if the file chooses one."""
        yield from super()._wrong_dims(values if self.normalization is None else {**values, NORM: ()})
        known = [str(one) for (one,) in values.get(NORM, ())]
        if self.normalization is not None and known and self.normalization not in known:
            yield Fault.of((NORM,), self.normalization, f"is not computed (known: {', '.join(known)})")


class General(Plot):
    """Any variable of any quantity over dimensions of the study, those of the quantity's own included.

    at : values at which the dimensions that are not shown are taken; those of one value need none
    by : a dimension with a panel, or a line, for each of its values; normalization if it varies
    log : whether the scale of the variable is logarithmic
    """

    several = True
    room: ClassVar[int] = MOST_PANELS
    """Greatest number of values of `by`."""

    variable: str
    x: str
    at: Annotated[dict[str, Finite | str], Unit({name: Parameters.unit(name) for name in Parameters.model_fields})] = (
        Field({})
    )
    by: str | None = None
    log: bool = False

    def faults_among(
        self, dims: Mapping[str, Sequence[Any]], variables: Mapping[str, Sequence[str]]
    ) -> Iterator[Fault]:
        """Faults that keep it from being drawn.

        Parameters
        ----------
        dims : values along each dimension, the quantity's own included; tuples for a zip; none if it has faults
        variables : dimensions of each variable
        """
        yield from self._wrong_overlays()
        if self.variable not in variables:
            yield Fault.of(("variable",), self.variable, f"unknown variable{suggestion(self.variable, variables)}")
            return
        own = {name: dims[name] for name in variables[self.variable] if name in dims}
        places = self.axes | ({"by": self.by} if self.by is not None else {})
        for place, name in places.items():
            yield from self._wrong_place(place, name, own)
        used = [*places.values()]
        for name in sorted({name for name in used if used.count(name) > 1}):
            place = "y" if self.axes.get("y") == name else "by"
            yield Fault.of((place,), name, "must differ from the other dimensions shown")
        left = {name: values for name, values in own.items() if name not in used}
        for name, value in self.at.items():
            if name not in left:
                rule = f"is no dimension that remains (known: {', '.join(left) or 'none'})"
                yield Fault.of(("at", name), value, rule)
            elif left[name] and not any(_same(value, one) for one in left[name]):
                yield Fault.of(("at", name), value, f"must be one of {_listed(left[name])}")
        for name, values in left.items():
            panels = self.by is None and name == NORM and len(values) <= self.room
            if name not in self.at and len(values) > 1 and not panels:
                yield Fault(("at", name), "", f"is required, or by: {name}; one of {_listed(values)}")

    def _wrong_place(self, place: str, name: str, own: Mapping[str, Sequence[Any]]) -> Iterator[Fault]:
        if name not in own:
            yield Fault.of((place,), name, f"is no dimension of {self.variable}{suggestion(name, own)}")
        elif place == "by":
            if len(own[name]) > self.room:
                yield Fault.of((place,), name, f"has {len(own[name])} values, and there is room for {self.room}")
        elif any(isinstance(value, str | tuple) for value in own[name]):
            yield Fault.of((place,), name, "must be one parameter, and a number")
        elif len(own[name]) == 1:
            yield Fault.of((place,), name, "must have two values or more")


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, str) or isinstance(other, str | tuple):
        return bool(one == other)
    return math.isclose(one, other, rel_tol=1e-12)


def _listed(values: Sequence[Any]) -> str:
    """A few values as messages show them."""
    texts = [str(value) if isinstance(value, str | tuple) else f"{value:g}" for value in values]
    return ", ".join(texts if len(texts) <= 12 else [*texts[:6], "...", texts[-1]])


class HeatMap(General):
    """A variable in colour over two dimensions; a panel for each value of a third, if wanted."""

    drawn_by = "general.draw_heat_map"

    kind: Literal["heat_map"] = "heat_map"
    y: str


class CurvePlot(General):
    """A variable against one dimension; a line for each value of a second, if wanted.

    limits : ends of the variable's axis, so that figures can be compared
    """

    drawn_by = "general.draw_curve"
    room = MOST_LINES

    kind: Literal["curve"] = "curve"
    limits: tuple[Finite, Finite] | None = None


# ----------------------------------------------------------------------------------------------------
# Of named cases

Sampled = Literal["P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity"]
"""Variables of samples beside times and phases."""
RANGES = ("P", "u", "w", "w_point", "psi", "psi_velocity")
"""Those of them that a window with an envelope stores."""
Recorded = Mapping[str, Window | Poincare | None]
"""Records of a case: windows by name, and the Poincaré section as ``poincare``."""
SHORTEST_SPECTRUM = 1.1
"""Least length of a window for a spectrum in time, s: one window of the transform and two steps."""
HIGHEST = 1000.0
"""Highest frequency of a spectrum in time, Hz."""


class CasePlot(Kind):
    """A figure of one named case, from one of its windows; drawn by a function that takes the case and `options`.

    case : name of the case
    window : name of the window under the case's ``record.windows``
    """

    case: str
    window: str

    @property
    def options(self) -> dict[str, Any]:
        """Keyword arguments of the drawing function."""
        return self.model_dump(exclude={"kind", "title", "caption", "case"})

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        """Faults that keep it from being drawn; a case that is None has faults of its own."""
        if self.case not in cases:
            yield Fault.of(("case",), self.case, f"no such case (known: {', '.join(cases) or 'none'})")
        elif (recorded := cases[self.case]) is not None:
            found = recorded.get(self.window)
            if found is None:
                known = ", ".join(name for name, window in recorded.items() if window is not None)
                rule = f"is not recorded by case {self.case} (known: {known or 'none'})"
                yield Fault.of(("window",), self.window, rule)
            elif isinstance(found, Window):
                yield from self._misfits(found)
            elif self.kind != "poincare":
                yield Fault.of(("window",), self.window, "must be a window, not the Poincaré section")

    def _misfits(self, window: Window) -> Iterator[Fault]:
        """Rules that the window breaks."""
        if window.envelope is not None:
            yield Fault.of(("window",), self.window, "must have no envelope")


class History(CasePlot):
    """Variables against time, one above the other; a window with an envelope as ranges."""

    drawn_by = "paper.histories.history"

    kind: Literal["history"] = "history"
    variables: Annotated[tuple[Sampled, ...], Field(min_length=1)] = ("P", "w")

    def _misfits(self, window: Window) -> Iterator[Fault]:
        if window.count < 2 * (window.envelope or 1):
            yield Fault.of(("window",), self.window, "must be two samples, or two envelopes, long or more")
        for i, name in enumerate(self.variables):
            if window.envelope is not None and name not in RANGES:
                yield Fault.of(("variables", str(i)), name, f"is not kept as ranges (known: {', '.join(RANGES)})")


class Section(CasePlot):
    """The Poincaré sections of slider and disc: once a turn of the drive."""

    drawn_by = "paper.sections.sections"

    kind: Literal["poincare"] = "poincare"
    window: Literal["poincare"] = "poincare"


class Spectrogram(CasePlot):
    """Power of a variable over time and frequency, in dB below its strongest line.

    highest : Hz, frequency up to which it is shown
    """

    drawn_by = "paper.spectra.spectrogram_of"

    kind: Literal["spectrogram"] = "spectrogram"
    variable: Sampled = "w_point"
    highest: Annotated[Positive, Unit("Hz")] = HIGHEST

    def _misfits(self, window: Window) -> Iterator[Fault]:
        yield from super()._misfits(window)
        for rule in spectrum_faults(window, self.highest):
            yield Fault.of(("window",), self.window, rule)


class Portrait(CasePlot):
    """One variable over another, coloured by phase."""

    drawn_by = "paper.sections.portrait"

    kind: Literal["portrait"] = "portrait"
    x: Sampled = "psi"
    y: Sampled = "psi_velocity"


def spectrum_faults(window: Window, highest: float) -> Iterator[str]:
    """Faults that keep a window's spectrum in time from being drawn up to a frequency in Hz."""
    if window.stop - window.start < SHORTEST_SPECTRUM:
        yield f"must be {SHORTEST_SPECTRUM:g} s long or more"
    if window.rate < 2 * highest:
        yield f"needs a rate of {2 * highest:g} Hz or more"


# ----------------------------------------------------------------------------------------------------
# All of them


class OwnFigure(Kind):
    """A figure of the paper that no study file asks for: a function with its options."""

    kind: Literal["own"] = "own"
    by: str
    options: dict[str, Any] = Field({})

    @property
    def function(self) -> str:
        return f"{__package__}.{self.by}"


def _by_kind(*classes: type[Kind]) -> dict[str, Any]:
    return {each.model_fields["kind"].default: each for each in classes}


PLOTS: dict[str, type[Plot]] = _by_kind(
    HeatMap, CurvePlot, StabilityMap, RegionMap, CriticalSpeed, Thresholds, GrowthMap, Bifurcation, RampedSpeeds,
    BasinShares, Branches, Sensitivity, Campbell,
)  # fmt: skip
CASE_PLOTS: dict[str, type[CasePlot]] = _by_kind(History, Section, Spectrogram, Portrait)
KINDS: dict[str, type[Plot | CasePlot | OwnFigure]] = {**PLOTS, **CASE_PLOTS, "own": OwnFigure}
