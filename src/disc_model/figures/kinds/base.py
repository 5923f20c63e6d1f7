"""Kinds of figures: what a study file may say of one, and the rules for it.

A kind is a class that checks the keys of a figure against a grid (`Plot`) or against recorded cases
(`CasePlot`). Its drawing is a module of `disc_model.figures`, found in the table of
`disc_model.figures.drawings`. No module of this folder imports matplotlib: that would add half to the
time in which a study is checked.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from disc_model.data.variables import SERIES, SHOWN, ranged_variable
from disc_model.errors import Fault, raise_faults, require, suggestion
from disc_model.figures.sizes import WIDTHS
from disc_model.parameters import Parameters
from disc_model.simulation.case import Poincare, Window
from disc_model.units import Strict, in_si

NORM = "normalization"  # the dimension that a study may have beside those that a figure requires
Width = Literal["column", "page"]
Values = Mapping[str, Sequence[Any]]
"""Values along each dimension of a grid; tuples where it varies several parameters."""


def si_unit(name: str) -> str:
    """The SI unit of a parameter or of a sampled variable, "" without one."""
    unit = Parameters.unit(name)
    if not unit and name in SERIES:
        unit = SERIES[name].units.replace(" s-1", "/s")
    return unit


def known_units(units: dict[str, str]) -> dict[str, str]:
    """The units, if each is one of its parameter or variable; raises `ParameterError`."""
    faults: list[Fault] = []
    known = [name for name in SHOWN if si_unit(name) not in ("", "1")]
    for name, unit in units.items():
        if name in known:
            in_si(f"1 {unit}", si_unit(name), faults, (name,))
        else:
            base = ranged_variable(name)
            meant = f", did you mean {base}?" if base in known else suggestion(name, known)
            rule = f"no parameter or variable with a unit{meant}"
            faults.append(Fault.of((name,), unit, rule))
    raise_faults(faults)
    return units


def _joined(caption: Any) -> Any:
    return " ".join(map(str, caption)) if isinstance(caption, list) else caption


def key_of(value: object) -> str:
    """The text by which a value along a dimension is known, the same for all ways to write a number."""
    try:
        return f"{float(str(value)):.12g}"
    except ValueError:
        return str(value)


def _by_key(names: Any) -> Any:
    """Names for values along a dimension by the texts of these values, however the file writes them."""
    if not isinstance(names, dict):
        return names
    return {key_of(value): name for value, name in names.items()}


Names = Annotated[dict[str, str], BeforeValidator(_by_key)]
"""Words for values along a dimension, by the keys of these."""


class Kind(Strict):
    """A figure: its fields are what a study file may say of it.

    title : stands above the figure, and in lists
    caption : stands below the figure in report, explorer and gallery, and then nothing above; a
        text or its parts
    section : heading under which report and explorer show it
    units : of the reader, by parameter or sampled variable
    width : of one column (84 mm) or of a page (174 mm), if not the usual one of the kind
    """

    titled_by_legend: ClassVar[bool] = False
    """Whether the title is that of the first legend, which lies above the panels."""

    is_map: ClassVar[bool] = False
    """Whether the figure grows so that its panels keep their height beside the legend."""

    usual: ClassVar[Width] = "page"
    """Its width, unless the file gives one."""
    widths: ClassVar[tuple[Width, ...]] = ("column", "page")
    """Widths in which it can be drawn."""

    kind: str
    title: str = ""
    caption: Annotated[str, BeforeValidator(_joined, json_schema_input_type=str | list[str])] = ""
    section: str = ""
    units: Annotated[dict[str, str], AfterValidator(known_units)] = Field({})
    width: Width | None = None

    @property
    def inches(self) -> float:
        """Width of the figure, inch."""
        return WIDTHS[self.width or self.usual]

    def inches_of(self, panels: int) -> float:
        """Width of a figure that has a number of panels, inch: a column for one."""
        usual = "page" if panels > 1 else "column"
        return WIDTHS[self.width or usual]

    @model_validator(mode="after")
    def _wide_enough(self) -> Self:
        fits = self.width is None or self.width in self.widths
        require((fits, "width", self.width, f"must be {' or '.join(self.widths)}"))
        return self


# ---- Figures of grid studies


class Role(NamedTuple):
    """What a further study must be to play a role in a figure.

    quantity : its quantity
    dims : its dimensions beside normalization; None for those of the figure
    options : options of its quantity that it must have
    required : whether the figure needs it
    """

    quantity: str
    dims: tuple[str, ...] | None = None
    options: Mapping[str, Any] = {}
    required: bool = False


Roles = Mapping[str, Role]
"""Further studies that a figure can show, by their role."""
CURVES = Role("stability_curves", (), {"x": "Omega", "y": "N"})


class Plot(Kind):
    """A figure of a grid study.

    study : the grid study that it shows, if not the file's own
    overlays : further studies by the roles that they play
    """

    quantities: ClassVar[tuple[str, ...]] = ()
    """Those that it can show, the default first; the one of its name if there are none."""
    needs: ClassVar[tuple[str, ...]] = ()
    """Dimensions, beside those that the file chooses as x and y."""
    several: ClassVar[bool] = False
    """Whether it shows several normalizations, or is drawn from the values for one."""
    roles: ClassVar[Roles] = {}

    study: str = ""
    overlays: dict[str, str] = Field({})

    @property
    def axes(self) -> dict[str, str]:
        """Dimensions that the file chooses, by axis."""
        chosen = {axis: getattr(self, axis, None) for axis in ("x", "y")}
        return {axis: name for axis, name in chosen.items() if name is not None}

    @property
    def dims(self) -> tuple[str, ...]:
        """All dimensions that the figure needs."""
        return (*self.needs, *self.axes.values())

    @property
    def allowed(self) -> tuple[str, ...]:
        """All dimensions that a study may have for the figure."""
        return (*self.dims, NORM)

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults that keep it from showing a study with these dimensions; those without values have
        faults already."""
        wrong = [*self.wrong_axes(values, "this study")]
        yield from wrong or self.wrong_dims(values)
        yield from self.wrong_overlays()

    def wrong_axes(self, values: Values, shown: str) -> Iterator[Fault]:
        """Axes that are none of the dimensions of what is shown, or cannot be drawn."""
        for axis, name in self.axes.items():
            if name not in values:
                rule = f"is no dimension of {shown}{suggestion(name, values)}"
                yield Fault.of((axis,), name, rule)
            elif any(isinstance(value, str | tuple) for value in values[name]):
                yield Fault.of((axis,), name, "must be one parameter, and a number")
            elif axis == "y" and name == self.axes["x"]:
                yield Fault.of((axis,), name, "must differ from x")

    def wrong_overlays(self) -> Iterator[Fault]:
        """Roles that the figure does not have, and lacks."""
        for role in self.overlays.keys() - self.roles.keys():
            rule = f"unknown role{suggestion(role, self.roles)}"
            yield Fault.of(("overlays", role), self.overlays[role], rule)
        for role, wanted in self.roles.items():
            if wanted.required and role not in self.overlays:
                rule = f"is required: a study of the quantity {wanted.quantity}"
                yield Fault(("overlays", role), "", rule)

    def wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Required dimensions that the study lacks, and dimensions of the study that the figure
        cannot show.

        A kind that replaces this rule sets `several`, or refuses several normalizations as this one
        does: of those, the others would be left out of the drawing without a word.
        """
        missing = [name for name in self.dims if name not in values]
        further = [name for name in values if values[name] and name not in self.allowed]
        hint = self._hint_of_by(values, missing, further)
        if missing:
            rule = f"needs the dimension {' and '.join(missing)}{hint}"
            yield Fault.of(("kind",), self.kind, rule)
        elif further:
            shown = ", ".join(self.allowed)
            rule = f"can show {shown}, but not {', '.join(further)} as well{hint}"
            yield Fault.of(("kind",), self.kind, rule)
        elif not self.several and NORM not in self.dims and len(values.get(NORM, ())) > 1:
            yield Fault.of(("kind",), self.kind, f"can show one {NORM} only")

    def _hint_of_by(self, values: Values, missing: Sequence[str], further: Sequence[str]) -> str:
        """What to write for a single further dimension, where the key `by` may name it: it names one
        that the study lacks, or normalizations of which there are not several."""
        by = getattr(self, "by", None)
        is_unused = by == NORM and not missing and len(values.get(NORM, ())) <= 1
        if len(further) != 1 or not (is_unused or missing == [by]):
            return ""
        return f"; to show each value of {further[0]}, write by: {further[0]}"


class Compared(Plot):
    """A figure with panels for each value of a dimension, such as two models of one thing.

    by : this dimension; normalization, where the study has several
    names : words for values of `by`
    """

    several = True
    room: ClassVar[int] = 4
    """Greatest number of values of `by`."""

    by: str = NORM
    names: Names = Field({})

    @property
    def allowed(self) -> tuple[str, ...]:
        return (*self.dims, *dict.fromkeys([self.by, NORM]))

    def wrong_dims(self, values: Values) -> Iterator[Fault]:
        found = [*super().wrong_dims(values)]
        yield from found
        along = values.get(self.by, ())
        if found:
            return
        if self.by != NORM and self.by not in values:
            yield Fault.of(
                ("by",), self.by, f"is no dimension of this study{suggestion(self.by, values)}"
            )
        elif self.by in self.dims:
            yield Fault.of(("by",), self.by, "must differ from the other dimensions")
        elif len(along) > self.room:
            rule = f"has {len(along)} values, and there is room for {self.room}"
            yield Fault.of(("by",), self.by, rule)
        elif self.by != NORM and len(values.get(NORM, ())) > 1:
            yield Fault.of(
                ("by",), self.by, f"leaves several values of {NORM}, of which it can show one"
            )
        else:
            yield from unknown("names", self.names, self.by, along)


def unknown(
    key: str, words: Iterator[Any] | Any, of: str, values: Sequence[Any]
) -> Iterator[Fault]:
    """Faults of words of a figure's key that are none of the values along a dimension."""
    known = [str(value) for value in values]
    keys = {key_of(value) for value in values}
    for word in words:
        if key_of(word) not in keys:
            yield Fault.of((key,), word, f"is no value of {of}{suggestion(word, known)}")


# ---- Figures of named cases

Sampled = Literal["P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity"]
Recorded = Mapping[str, Window | Poincare]
"""Records of a case: windows by name, and the section as ``poincare``."""
Rule = Callable[[Window], str]
"""The rule that a window breaks, as the end of a sentence, or ""."""
SHORTEST_SPECTRUM = 1.1
"""Least length of a window for a spectrum in time, s: one window of the transform and two steps."""
HIGHEST = 1000.0
"""Highest frequency of a spectrum in time, Hz."""


class Need(NamedTuple):
    """A record that a figure shows: the figure's key that names it, its case and name, and its rule
    if it is a window."""

    key: str
    case: str
    name: str
    rule: Rule | None = None


def as_samples(window: Window) -> str:
    """The rule of a window that is drawn sample by sample."""
    return "" if window.envelope is None else "must have no envelope"


def as_ranges(window: Window) -> str:
    """The rule of a window that is drawn as ranges."""
    if window.envelope is None:
        return "needs an envelope"
    return "" if window.count >= 2 * window.envelope else "must be two envelopes long or more"


def as_either(window: Window) -> str:
    """The rule of a window that is drawn as samples or as ranges."""
    enough = window.count >= 2 * (window.envelope or 1)
    return "" if enough else "must be two samples, or two envelopes, long or more"


def as_spectrum(window: Window, highest: float = HIGHEST) -> str:
    """The rule of a window whose spectrum in time is drawn up to a frequency in Hz."""
    wrong = as_samples(window)
    long_enough = window.stop - window.start >= SHORTEST_SPECTRUM
    if wrong or (long_enough and window.rate >= 2 * highest):
        return wrong
    return f"must be {SHORTEST_SPECTRUM:g} s long or more, at a rate of {2 * highest:g} Hz or more"


Samples = Annotated[str, as_samples]  # names of windows, by the rules for what is shown of them
Ranges = Annotated[str, as_ranges]
InTime = Annotated[str, as_spectrum]


class CasePlot(Kind):
    """A figure of one or several named cases.

    case : the first one if there are several
    """

    further: ClassVar[tuple[str, ...]] = ()
    """Keys that name further cases."""

    case: str

    def needs(self) -> Iterator[Need]:
        """The records that the figure shows: by default, of each case the windows whose names have
        a rule."""
        for case, (key, field) in product(self.cases, type(self).model_fields.items()):
            for rule in field.metadata:
                if callable(rule):
                    yield Need(key, case, getattr(self, key), rule)

    @property
    def cases(self) -> tuple[str, ...]:
        """All cases that the figure shows."""
        found = [self.case]
        for key in self.further:
            named = getattr(self, key)
            found += [named] if isinstance(named, str) else named
        return tuple(filter(None, found))

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        """Faults that keep it from being drawn; a case that is None has faults of its own."""
        for case in self.cases:
            if case not in cases:
                rule = f"no such case (known: {', '.join(cases) or 'none'})"
                yield Fault.of(("case",), case, rule)
        for need in self.needs():
            recorded = cases.get(need.case)
            if recorded is None:
                continue
            broken = _broken(need, recorded)
            if broken:
                yield Fault.of((need.key,), need.name, broken)


def _broken(need: Need, recorded: Recorded) -> str:
    """The rule that a record of a case breaks, as the end of a sentence; "" for none."""
    window = recorded.get(need.name)
    if window is None:
        return f"is not recorded by case {need.case}{suggestion(need.name, recorded)}"
    if need.rule is None:
        return ""
    if not isinstance(window, Window):
        return "must be a window, not the Poincaré section"
    return need.rule(window)
