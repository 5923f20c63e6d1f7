"""What all kinds of figures have in common: fields for study files, rules (`faults`) and a drawing
(`draw`). None of their modules imports matplotlib before something is drawn, as that would double
the time in which a study is checked.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from itertools import chain, product
from pkgutil import iter_modules
from textwrap import fill
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import xarray as xr
from pydantic import AfterValidator, BeforeValidator, Field

from disc_model.data.dataset import Missing
from disc_model.data.variables import SERIES, SHOWN
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion
from disc_model.figures import drawing
from disc_model.figures.labels import break_labels
from disc_model.parameters import Parameters
from disc_model.simulation.case import Poincare, Window
from disc_model.units import Strict, in_si

Values = Mapping[
    str, Sequence[Any]
]  # along each dimension of a grid; tuples where it varies several parameters
NORM = "normalization"  # the dimension that a study may have beside those that a figure requires


def kind_of(name: Any) -> type[Kind]:
    """The kind of a name, such as ``heat_map``, or ``paper.light_slider``; raises
    `ParameterError`."""
    try:
        return kinds_in(str(name).rpartition(".")[0])[name]
    except (
        ModuleNotFoundError,
        KeyError,
        TypeError,
    ) as error:  # no such part, no such kind, no name
        fault = Fault.of(("kind",), name, f"unknown kind of figure{suggestion(name, kinds_in(''))}")
        raise ParameterError(fault) from error


@cache
def kinds_in(part: str) -> dict[str, type[Kind]]:
    """All kinds by their names: of a part of the package such as ``paper``, or of this one, whose
    name is ""."""
    figures = import_module(".".join(filter(None, ["disc_model", part, "figures"])))
    modules = [
        import_module(f"{figures.__name__}.{x.name}")
        for x in iter_modules(getattr(figures, "__path__", []))
    ]
    classes = [
        x
        for module in modules
        for x in vars(module).values()
        if isinstance(x, type) and issubclass(x, Kind)
    ]
    return {name: x for x in classes if isinstance(name := x.model_fields["kind"].default, str)}


def _si_unit(name: str) -> str:
    return Parameters.unit(name) or (
        SERIES[name].units.replace(" s-1", "/s") if name in SERIES else ""
    )


def _known_units(units: dict[str, str]) -> dict[str, str]:
    """The units, if each is one of its parameter or variable; raises `ParameterError`."""
    faults: list[Fault] = []
    known = [name for name in SHOWN if _si_unit(name) not in ("", "1")]
    for name, unit in units.items():
        if name in known:
            in_si(f"1 {unit}", _si_unit(name), faults, (name,))
        else:
            faults.append(
                Fault.of(
                    (name,), unit, f"no parameter or variable with a unit{suggestion(name, known)}"
                )
            )
    raise_faults(faults)
    return units


def _joined(caption: Any) -> Any:
    return " ".join(map(str, caption)) if isinstance(caption, list) else caption


class Kind(Strict):
    """A figure: its fields are what a study file may say of it."""

    kind: str
    title: str = ""  # stands above the figure, and in lists
    # stands below the figure in report, explorer and gallery, and then nothing above; as a text or
    # its parts
    caption: Annotated[str, BeforeValidator(_joined, json_schema_input_type=str | list[str])] = ""
    section: str = ""  # heading under which report and explorer show it
    units: Annotated[dict[str, str], AfterValidator(_known_units)] = Field(
        {}
    )  # by parameter or sampled variable

    def draw(self, *inputs: Any, **options: Any) -> drawing.Figure:
        """Draw the cases, or the study and further ones by their roles; raises `Missing` where a
        case lacks data."""
        raise NotImplementedError

    def drawn_with_head(self, inputs: Mapping[str, xr.DataTree]) -> tuple[drawing.Figure, str, str]:
        """The figure, its title unless the file gives one, and values for its head."""
        raise NotImplementedError

    def render(self, inputs: Mapping[str, xr.DataTree]) -> drawing.Figure:
        """Draw it from its inputs by name, in the common style and its readers' units, below a
        title unless a caption says the same."""
        factors = {
            name: (unit, 1 / in_si(f"1 {unit}", _si_unit(name), [], ()))
            for name, unit in self.units.items()
        }
        token = drawing.UNITS.set(factors)
        try:
            with drawing.styled():
                figure, title, values = self.drawn_with_head(inputs)
                drawing.restate_axes(figure)
                break_labels(figure)
                text = drawing.head_text(figure.get_figwidth(), self.title or title, values)
                if text and not self.caption:
                    self.place_title(figure, text)
                return figure
        finally:
            drawing.UNITS.reset(token)

    def place_title(self, figure: drawing.Figure, text: str) -> None:
        """Write a title where it covers nothing."""
        figure.suptitle(text, fontsize=8)


# ---- Of grid studies


class Role(NamedTuple):
    """An overlay: quantity; dimensions except `NORM`, if not the figure's; options."""

    quantity: str
    dims: tuple[str, ...] | None = None
    options: Mapping[str, Any] = {}
    required: bool = False


Roles = Mapping[str, Role]  # further studies that a figure can show, by their role
CURVES = Role("stability_curves", (), {"x": "Omega", "y": "N"})


class Plot(Kind):
    """A figure of a grid study."""

    quantities: ClassVar[
        tuple[str, ...]
    ] = ()  # those that it can show, the default first; if none, that of its name
    needs: ClassVar[
        tuple[str, ...]
    ] = ()  # dimensions, beside those that the file chooses as x and y
    several: ClassVar[bool] = (
        False  # whether it shows several normalizations, or is drawn from the values for one
    )
    roles: ClassVar[Roles] = {}

    study: str = ""  # the grid study that it shows, if not the file's own
    overlays: dict[str, str] = Field({})  # further studies by the roles they play

    def drawn_with_head(self, inputs: Mapping[str, xr.DataTree]) -> tuple[drawing.Figure, str, str]:
        """Draw its study, the first input, and further ones by their roles."""
        study, *others = (tree.to_dataset() for tree in inputs.values())
        if not self.several:
            norm = getattr(self, NORM, None) or drawing.normalizations(study)[0]
            study, *others = (drawing.of(dataset, norm) for dataset in (study, *others))
        figure = self.draw(study, dict(zip([*inputs][1:], others, strict=True)))
        base = json.loads(study.attrs.get("base", "{}"))
        # 0 stands for N or Omega if the quantity varies it by itself
        varied = {*study.coords, *(name for name in ("N", "Omega") if not base.get(name))}
        modes = drawing.normalizations(study) if NORM in study.coords else []
        fixed = drawing.what_case(
            {name: value for name, value in base.items() if name not in varied}
        )
        texts = [
            *self.chosen(study),
            fixed,
            *(drawing.MODES[mode] for mode in modes if len(modes) == 1),
        ]
        return figure, study.attrs.get("title", ""), ", ".join(filter(None, texts))

    def chosen(self, study: xr.Dataset) -> list[str]:
        """Values along dimensions of the study that the figure takes at one place."""
        return []

    @property
    def axes(self) -> dict[str, str]:
        """Dimensions that the file chooses, by axis."""
        return {
            axis: name for axis in ("x", "y") if (name := getattr(self, axis, None)) is not None
        }

    @property
    def dims(self) -> tuple[str, ...]:
        """All dimensions that the figure needs."""
        return (*self.needs, *self.axes.values())

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults that keep it from showing a study with these dimensions; those without values have
        faults already."""
        yield from [*self._wrong_axes(values, "this study")] or self._wrong_dims(values)
        yield from self._wrong_overlays()

    def _wrong_axes(self, values: Values, shown: str) -> Iterator[Fault]:
        """Axes that are none of the dimensions of what is shown, or cannot be drawn."""
        for axis, name in self.axes.items():
            if name not in values:
                yield Fault.of(
                    (axis,), name, f"is no dimension of {shown}{suggestion(name, values)}"
                )
            elif any(isinstance(value, str | tuple) for value in values[name]):
                yield Fault.of((axis,), name, "must be one parameter, and a number")
            elif axis == "y" and name == self.axes["x"]:
                yield Fault.of((axis,), name, "must differ from x")

    def _wrong_overlays(self) -> Iterator[Fault]:
        """Roles that the figure does not have, and lacks."""
        for role in self.overlays.keys() - self.roles.keys():
            yield Fault.of(
                ("overlays", role),
                self.overlays[role],
                f"unknown role{suggestion(role, self.roles)}",
            )
        for role, wanted in self.roles.items():
            if wanted.required and role not in self.overlays:
                yield Fault(
                    ("overlays", role),
                    "",
                    f"is required: a study of the quantity {wanted.quantity}",
                )

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        """Required dimensions that the study lacks, and dimensions of the study that the figure
        cannot show."""
        allowed = (*self.dims, NORM)
        further = [name for name in values if values[name] and name not in allowed]
        if missing := [name for name in self.dims if name not in values]:
            yield Fault.of(("kind",), self.kind, f"needs the dimension {' and '.join(missing)}")
        elif further:
            yield Fault.of(
                ("kind",),
                self.kind,
                f"can show {', '.join(allowed)}, but not {', '.join(further)} as well",
            )
        elif not self.several and len(values.get(NORM, ())) > 1:
            yield Fault.of(("kind",), self.kind, f"can show one {NORM} only")


# ---- Of named cases
Sampled = Literal["P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity"]
Recorded = Mapping[
    str, Window | Poincare
]  # of a case: windows by name, and the section as ``poincare``
Rule = Callable[[Window], str]  # the rule that a window breaks, as the end of a sentence, or ""
SHORTEST_SPECTRUM = 1.1  # least length of a window for a spectrum in time, s: one window of the transform and two steps
HIGHEST = 1000.0  # highest frequency of a spectrum in time, Hz


class Need(NamedTuple):
    """A record that a figure shows: the figure's key that names it, its case and name, and its rule
    if a window."""

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


def as_spectrum(window: Window, highest: float = HIGHEST) -> str:
    """The rule of a window whose spectrum in time is drawn up to a frequency in Hz."""
    enough = window.stop - window.start >= SHORTEST_SPECTRUM and window.rate >= 2 * highest
    rule = f"must be {SHORTEST_SPECTRUM:g} s long or more, at a rate of {2 * highest:g} Hz or more"
    return as_samples(window) or ("" if enough else rule)


Samples = Annotated[str, as_samples]  # names of windows, by the rules for what is shown of them
Ranges = Annotated[str, as_ranges]
InTime = Annotated[str, as_spectrum]


class CasePlot(Kind):
    """A figure of one or several named cases."""

    further: ClassVar[tuple[str, ...]] = ()  # keys that name further cases

    case: str  # the first one if there are several

    def needs(self) -> Iterator[Need]:
        """The records that the figure shows: by default, of each case the windows whose names have
        a rule."""
        for case, (key, field) in product(self.cases, type(self).model_fields.items()):
            yield from (
                Need(key, case, getattr(self, key), rule)
                for rule in field.metadata
                if callable(rule)
            )

    @property
    def cases(self) -> tuple[str, ...]:
        """All cases that the figure shows."""
        named = [getattr(self, key) for key in self.further]
        further = chain.from_iterable(
            [names] if isinstance(names, str) else names for names in named
        )
        return (self.case, *filter(None, further))

    def drawn_with_head(self, inputs: Mapping[str, xr.DataTree]) -> tuple[drawing.Figure, str, str]:
        """Draw cases by their names; the reason instead, if one lacks what is needed."""
        first = next(iter(inputs.values()))
        try:
            figure = self.draw(*inputs.values())
        except Missing as reason:
            figure, [ax] = drawing.panels(drawing.COLUMN, 2)
            ax.set_axis_off()
            ax.text(
                0.5,
                0.5,
                fill(f"not shown: the case {reason}", 24),
                ha="center",
                va="center",
                in_layout=False,
            )
        return figure, "", drawing.what_case(json.loads(first.attrs.get("parameters", "{}")))

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        """Faults that keep it from being drawn; a case that is None has faults of its own."""
        for case in self.cases:
            if case not in cases:
                yield Fault.of(
                    ("case",), case, f"no such case (known: {', '.join(cases) or 'none'})"
                )
        for key, case, name, rule in self.needs():
            if (recorded := cases.get(case)) is None:
                continue
            if (window := recorded.get(name)) is None:
                broken = f"is not recorded by case {case}{suggestion(name, recorded)}"
            elif rule is not None:
                broken = (
                    rule(window)
                    if isinstance(window, Window)
                    else "must be a window, not the Poincaré section"
                )
            else:
                continue
            if broken:
                yield Fault.of((key,), name, broken)
