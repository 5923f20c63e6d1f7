"""What all kinds of figures have in common: fields for study files, rules (`faults`) and a drawing (`draw`). None of
their modules imports matplotlib before something is drawn, as that would double the time in which a study is checked.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from itertools import chain
from pkgutil import iter_modules
from textwrap import fill
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import xarray as xr
from pydantic import AfterValidator, BeforeValidator, Field

from disc_model.data.dataset import Missing
from disc_model.data.variables import PERTURBATIONS, SERIES, SHOWN
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion
from disc_model.figures import drawing
from disc_model.parameters import RATIOS, Parameters
from disc_model.simulation.case import Poincare, Window
from disc_model.units import Strict, in_si

Values = Mapping[str, Sequence[tuple[Any, ...]]]  # values of the parameters along each dimension of a grid
NORM = "normalization"  # the dimension that a study may have beside those that a figure requires


def kind_of(name: Any) -> type[Kind]:
    """The kind of a name, such as ``heat_map``, or ``paper.light_slider``; raises `ParameterError`."""
    try:
        return kinds_in(str(name).rpartition(".")[0])[name]
    except (ModuleNotFoundError, KeyError, TypeError) as error:
        if isinstance(error, ModuleNotFoundError) and not str(error.name).startswith("disc_model"):
            raise  # a kind's own import, such as that of a library which is not installed
        fault = Fault.of(("kind",), name, f"unknown kind of figure{suggestion(name, kinds_in(''))}")
        raise ParameterError(fault) from None


@cache
def kinds_in(part: str) -> dict[str, type[Kind]]:
    """All kinds by their names: of a part of the package such as ``paper``, or of this one, whose name is ""."""
    figures = import_module(".".join(filter(None, ["disc_model", part, "figures"])))
    modules = [import_module(f"{figures.__name__}.{x.name}") for x in iter_modules(getattr(figures, "__path__", []))]
    classes = [x for module in modules for x in vars(module).values() if isinstance(x, type) and issubclass(x, Kind)]
    return {name: x for x in classes if isinstance(name := x.model_fields["kind"].default, str)}


def _joined(caption: Any) -> Any:
    of_parts = isinstance(caption, list) and all(isinstance(part, str) for part in caption)
    return " ".join(caption) if of_parts else caption


def _si_unit(name: str) -> str:
    return Parameters.unit(name) or (SERIES[name].units.replace(" s-1", "/s") if name in SERIES else "")


def _known_units(units: dict[str, str]) -> dict[str, str]:
    """The units, if each is one of its parameter or variable; raises `ParameterError`."""
    faults: list[Fault] = []
    known = [name for name in SHOWN if _si_unit(name) not in ("", "1")]
    for name, unit in units.items():
        wrong: list[Fault] = []
        if name in known:
            in_si(f"1 {unit}", _si_unit(name), wrong, ())
        else:
            wrong.append(Fault((), "", f"no parameter or variable with a unit{suggestion(name, known)}"))
        faults += (Fault.of((name,), unit, fault.rule.replace("a number", "a unit", 1)) for fault in wrong)
    raise_faults(faults)
    return units


class Kind(Strict):
    """A figure: its fields are what a study file may say of it."""

    kind: str
    title: str = ""  # stands above the figure, and in lists
    # stands below the figure in report, explorer and gallery, and then nothing above; as a text or its parts
    caption: Annotated[str, BeforeValidator(_joined, json_schema_input_type=str | list[str])] = ""
    section: str = ""  # heading under which report and explorer show it
    units: Annotated[dict[str, str], AfterValidator(_known_units)] = Field({})  # by parameter or sampled variable

    @contextmanager
    def in_its_style(self) -> Iterator[None]:
        """The common style, and the units of its readers."""
        factors = {name: (unit, 1 / in_si(f"1 {unit}", _si_unit(name), [], ())) for name, unit in self.units.items()}
        token = drawing.UNITS.set(factors)
        try:
            with drawing.styled():
                yield
        finally:
            drawing.UNITS.reset(token)

    def draw(self, *inputs: Any, **options: Any) -> drawing.Figure:
        """Draw the cases, or the study and further ones by their roles; raises `Missing` where a case lacks data."""
        raise NotImplementedError

    def write_head(self, figure: drawing.Figure, title: str, values: str) -> None:
        """Write title and values above the figure, unless a caption says both; give axes the units of the reader."""
        drawing.restate_axes(figure)
        text = drawing.head_text(figure.get_figwidth(), self.title or title, values)
        if text and not self.caption:
            self.place_title(figure, text)

    def place_title(self, figure: drawing.Figure, text: str) -> None:
        """Write a title where it covers nothing."""
        figure.suptitle(text, fontsize=8)


# ---- Of grid studies


class Role(NamedTuple):
    """An overlay: quantity, or one with the same data; dimensions except `NORM`, if not the figure's; options."""

    quantity: str
    dims: tuple[str, ...] | None = None
    options: Mapping[str, Any] = {}
    required: bool = False
    instead: str = ""


Roles = Mapping[str, Role]  # further studies that a figure can show, by their role
CYCLE = Role("floquet", ("N", "Omega"), instead="regions")
CURVES = Role("stability_curves", (), {"x": "Omega", "y": "N"})


class Plot(Kind):
    """A figure of a grid study."""

    quantities: ClassVar[tuple[str, ...]] = ()  # those that it can show, the default first; if none, that of its name
    needs: ClassVar[tuple[str, ...]] = ()  # dimensions, beside those that the file chooses as x and y
    several: ClassVar[bool] = False  # whether it shows several normalizations, or is drawn from the values for one
    named_above: ClassVar[bool] = False  # whether its panels name their normalizations
    roles: ClassVar[Roles] = {}

    study: str = ""  # the grid study that it shows, if not the file's own
    overlays: dict[str, str] = Field({})  # further studies by the roles they play

    def render(self, inputs: Mapping[str, xr.DataTree]) -> drawing.Figure:
        """Draw it in the common style from its study, the first input, and further ones by their roles."""
        study, *others = (tree.to_dataset() for tree in inputs.values())
        if not self.several:
            norm = getattr(self, NORM, None) or drawing.normalizations(study)[0]
            study, *others = (drawing.of(dataset, norm) for dataset in (study, *others))
        with self.in_its_style():
            figure = self.draw(study, dict(zip([*inputs][1:], others, strict=True)))
            base = json.loads(study.attrs.get("base", "{}"))
            # 0 stands for N or Omega if the quantity varies it by itself
            varied = {*study.coords, *(name for name in ("N", "Omega") if not base.get(name))}
            modes = drawing.normalizations(study) if NORM in study.coords and not self.named_above else []
            if self.named_above:
                varied.add(NORM)
            fixed = drawing.what_case({name: value for name, value in base.items() if name not in varied})
            texts = [*self.chosen(study), fixed, *(drawing.MODES[mode] for mode in modes if len(modes) == 1)]
            self.write_head(figure, study.attrs.get("title", ""), ", ".join(filter(None, texts)))
        return figure

    def chosen(self, study: xr.Dataset) -> list[str]:
        """Values along dimensions of the study that the figure takes at one place."""
        return []

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
        wrong = []
        for axis, name in self.axes.items():
            if name not in values:
                wrong.append(Fault.of((axis,), name, f"is no dimension of this study{suggestion(name, values)}"))
            elif name not in (*PERTURBATIONS, *RATIOS) and not Parameters.unit(name):
                wrong.append(Fault.of((axis,), name, "must be one parameter, and a number"))
        if len({*self.axes.values()}) < len(self.axes):
            wrong.append(Fault.of(("y",), self.axes["y"], "must differ from x"))
        yield from wrong or self._wrong_dims(values)
        yield from self._wrong_overlays()

    def _wrong_overlays(self) -> Iterator[Fault]:
        """Roles that the figure does not have, and lacks."""
        for role, name in self.overlays.items():
            if role not in self.roles:
                rule = suggestion(role, self.roles) if self.roles else ", this kind has no overlays"
                yield Fault.of(("overlays", role), name, f"unknown role{rule}")
        for role, wanted in self.roles.items():
            if wanted.required and role not in self.overlays:
                yield Fault(("overlays", role), "", f"is required: a study of the quantity {wanted.quantity}")

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


# ---- Of named cases
Sampled = Literal["P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity"]
Recorded = Mapping[str, Window | Poincare]  # of a case: windows by name, and the section as ``poincare``
Rule = Callable[[Window], Iterator[str]]  # rules that a window breaks, as ends of sentences
SHORTEST_SPECTRUM = 1.1  # least length of a window for a spectrum in time, s: one window of the transform and two steps
HIGHEST = 1000.0  # highest frequency of a spectrum in time, Hz


class Need(NamedTuple):
    """A record that a figure shows: the figure's key that names it, its case and name, and rules if it is a window."""

    key: str
    case: str
    name: str
    rules: Sequence[Rule] = ()


def as_samples(window: Window) -> Iterator[str]:
    """Rules for a window that is drawn sample by sample."""
    if window.envelope is not None:
        yield "must have no envelope"


def as_ranges(window: Window) -> Iterator[str]:
    """Rules for a window that is drawn as ranges."""
    if window.envelope is None:
        yield "needs an envelope"
    elif window.count < 2 * window.envelope:
        yield "must be two envelopes long or more"


def as_spectrum(window: Window, highest: float = HIGHEST) -> Iterator[str]:
    """Rules for a window whose spectrum in time is drawn up to a frequency in Hz."""
    yield from as_samples(window)
    if window.stop - window.start < SHORTEST_SPECTRUM:
        yield f"must be {SHORTEST_SPECTRUM:g} s long or more"
    if window.rate < 2 * highest:
        yield f"needs a rate of {2 * highest:g} Hz or more"


class CasePlot(Kind):
    """A figure of one or several named cases."""

    shows: ClassVar[tuple[tuple[str, Rule], ...]] = ()  # keys that name the windows shown of each case, and their rules
    further: ClassVar[tuple[str, ...]] = ()  # keys that name further cases

    case: str  # the first one if there are several

    def needs(self) -> Iterator[Need]:
        """The records that the figure shows."""
        for case in self.cases:
            for key, rule in self.shows:
                named = getattr(self, key)
                yield from (Need(key, case, name, [rule]) for name in ([named] if isinstance(named, str) else named))

    @property
    def cases(self) -> tuple[str, ...]:
        """All cases that the figure shows."""
        named = [getattr(self, key) for key in self.further]
        further = chain.from_iterable([names] if isinstance(names, str) else names for names in named)
        return (self.case, *filter(None, further))

    def render(self, inputs: Mapping[str, xr.DataTree]) -> drawing.Figure:
        """Draw it in the common style from cases by their names; the reason instead, if one lacks what it needs."""
        first = next(iter(inputs.values()))
        with self.in_its_style():
            try:
                figure = self.draw(*inputs.values())
            except Missing as reason:
                figure, [ax] = drawing.panels(drawing.COLUMN, 2)
                ax.set_axis_off()
                ax.text(0.5, 0.5, fill(f"not shown: the case {reason}", 24), ha="center", va="center", in_layout=False)
            self.write_head(figure, "", drawing.what_case(json.loads(first.attrs.get("parameters", "{}"))))
        return figure

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        """Faults that keep it from being drawn; a case that is None has faults of its own."""
        for case in self.cases:
            if case not in cases:
                yield Fault.of(("case",), case, f"no such case (known: {', '.join(cases) or 'none'})")
        for key, case, name, rules in self.needs():
            if (recorded := cases.get(case)) is None:
                continue
            if name not in recorded:
                broken = [f"is not recorded by case {case} (known: {', '.join(recorded) or 'none'})"]
            elif isinstance(window := recorded[name], Window):
                broken = [text for rule in rules for text in rule(window)]
            else:
                broken = ["must be a window, not the Poincaré section"] if rules else []
            yield from (Fault.of((key,), name, text) for text in broken)
