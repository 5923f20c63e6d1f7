"""What a study file may say of a figure: the signature of a drawing function is its schema.

`grid_figure` and `case_figure` mark the functions that draw; their parameters after the first are
the keys of a figure in a study file.
"""

import inspect
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, cast, get_type_hints

from pydantic import AfterValidator, Field, create_model

from disc_model.errors import Fault, as_text, require, suggestion, violations
from disc_model.figures.looks import Options
from disc_model.figures.shown import key_of, si_unit
from disc_model.simulation.case import Window
from disc_model.units import UNITS, Finite, Strict, Unit, in_si

NORM = "normalization"
NOTHING: Options = {}
"""The default of a key that is a mapping."""
Function = Callable[..., Any]
Values = Mapping[str, Sequence[Any]]
"""Values along each dimension of a grid; tuples where it varies several parameters, and none where
these have faults."""
MOST_VALUES = 12
"""Greatest number of values of a dimension that has a panel or a line for each."""
Sampled = Literal["P", "u", "u_velocity", "w", "w_point", "w_point_velocity", "psi", "psi_velocity"]


# ---- Marks of drawing functions and of their parameters


class Role(NamedTuple):
    """What a further study that a parameter takes must be: its quantity, and whether the figure
    needs it."""

    quantity: str
    required: bool = False


class Recorded(NamedTuple):
    """The rule of a window that a parameter names; "" for any window or section."""

    rule: str = ""
    holds: Callable[[Any], object] = bool

    def broken(self, window: Any) -> str:
        """The rule if a window, or a section, breaks it, else ""."""
        if isinstance(window, Window) and self.holds(window):
            return ""
        return self.rule


class Shows(NamedTuple):
    """What a function draws.

    quantities : of the study; none for any
    needs : dimensions of the study, beside those that its keys name
    takes : whether it takes dimensions beyond these, too
    windows : of each case, by name, with the rules that they must keep
    """

    quantities: tuple[str, ...] = ()
    needs: Sequence[str] = ()
    takes: bool = False
    windows: Mapping[str, Any] = {}

    def __call__(self, function: Function) -> Function:
        """Mark a function."""
        function.shows = self  # type: ignore[attr-defined]
        return function


def grid_figure(*quantities: str, needs: Sequence[str] = (), takes: bool = False) -> Shows:
    """Mark a function that draws a study, its first argument.

    Parameters with the type ``Annotated[Dataset | None, Role(...)]`` take further studies; `x`, `y`,
    `by` and `starts` name dimensions.
    """
    return Shows(quantities, needs, takes)


def case_figure(windows: Mapping[str, Any] = NOTHING) -> Shows:
    """Mark a function that draws a case, its first argument.

    Parameters of the types `Case` and `Cases` take further cases; those of a type with a rule, such as
    `Samples`, name a window.
    """
    return Shows(windows=windows)


# what study files have in place of cases
Case = Annotated[Any, str]
Cases = Annotated[Any, tuple[str, ...]]

IN_FULL = Recorded("must be a window without an envelope", lambda w: not w.envelope)
IN_TIME = Recorded(
    "must be a window without an envelope, of 1.1 s or more",
    lambda w: not w.envelope and w.stop - w.start >= 1.1,
)
Samples = Annotated[str, IN_FULL]
InTime = Annotated[str, IN_TIME]


def _has_two(window: Window) -> bool:
    """Whether a window has two samples, or envelopes, or more."""
    return window.count >= 2 * (window.envelope or 1)


Ranges = Annotated[
    str,
    Recorded(
        "must be a window that has an envelope, and two envelopes or more",
        lambda w: w.envelope and _has_two(w),
    ),
]
Either = Annotated[
    str, Recorded("must be a window of two samples, or two envelopes, or more", _has_two)
]


# ---- Figures


def known_units(units: dict[str, str]) -> dict[str, str]:
    """The units, if each is one of its parameter or variable; raises `ParameterError`."""
    for name, unit in units.items():
        none = "no parameter or variable with a unit"
        require((si_unit(name) not in ("", "1"), name, unit, none))
        in_si(f"1 {unit}", si_unit(name), name)
    return units


def _joined(caption: str | list[str]) -> str:
    if isinstance(caption, str):
        return caption
    return " ".join(caption)


def _by_key(names: dict[Any, Any]) -> Any:
    return {key_of(x): name for x, name in names.items()}


class Kind(Strict):
    """A figure: its fields are what a study file may say of it.

    title : stands above the figure, and in lists
    caption : stands below the figure in report and gallery, and then nothing above; a text or its parts
    section : heading under which the report shows it
    units : of the reader, by parameter or sampled variable
    width : of one column (84 mm) or of a page (174 mm), if not the usual one of the kind
    """

    function: ClassVar[Function]
    shows: ClassVar[Shows]
    keys: ClassVar[Sequence[str]]

    kind: str
    title: str = ""
    caption: Annotated[str | list[str], AfterValidator(_joined)] = ""
    section: str = ""
    units: Annotated[dict[str, str], AfterValidator(known_units)] = Field({})
    width: Literal["column", "page"] | None = None

    @property
    def options(self) -> Options:
        """Arguments of the drawing function, without studies and cases."""
        return {key: getattr(self, key) for key in self.keys}


class Plot(Kind):
    """A figure of a grid study.

    study : the grid study that it shows, if not the file's own
    overlays : further studies by the parameters that take them
    at : values along dimensions that are not shown
    names : words for values of `by`
    """

    roles: ClassVar[Mapping[str, Role]] = {}

    study: str = ""
    overlays: dict[str, str] = Field({})
    at: Annotated[dict[str, Finite | str], Unit(UNITS)] = Field({})
    names: Annotated[dict[Any, str], AfterValidator(_by_key)] = Field({})

    @property
    def axes(self) -> dict[str, str]:
        """Dimensions of the grid by the keys that name them."""
        chosen = {key: getattr(self, key, None) for key in ("x", "y", "by", "starts")}
        return {key: name for key, name in chosen.items() if name}

    def faults(self, dims: Values, variables: Mapping[str, Values]) -> list[Any]:
        """What keeps it from showing a study, each a `Fault`.

        dims : values along the dimensions of the study
        variables : the same of each of its variables, with the dimensions of its own
        """
        own = dims
        name = getattr(self, "variable", None)
        if name is not None:
            if name not in variables:
                return [
                    Fault.of(("variable",), name, f"unknown variable{suggestion(name, variables)}")
                ]
            own = variables[name]
        faults = violations(*self._rules_of_axes(own)) or violations(*self._rules_of_rest(own))
        return [*faults, *violations(*self._rules_of_overlays())]

    def _rules_of_axes(self, own: Values) -> Iterator[Any]:
        """That the study has the dimensions that the figure names, and that these can be axes."""
        taken: list[str] = []
        for key, name in (*(("kind", name) for name in self.shows.needs), *self.axes.items()):
            along = own.get(name, ())
            number = not any(isinstance(x, str | tuple) or x == math.inf for x in along)
            lacking = f"needs the dimension {name}{suggestion(name, own)}"
            finite = "must be one parameter, and a number that is finite"
            many = f"has {len(along)} values, and there is room for {MOST_VALUES}"
            yield name in {NORM, *own}, key, name, lacking
            yield name not in taken, key, name, "must differ from the other dimensions"
            yield number or key not in ("x", "y"), key, name, finite
            yield len(along) <= MOST_VALUES or key != "by", key, name, many
            taken.append(name)
        named = [*own.get(self.axes.get("by", ""), ())]
        for value in self.names if named else ():
            rule = f"must be one of {as_text(named)}"
            yield value in map(key_of, named), "names", value, rule

    def _rules_of_rest(self, own: Values) -> Iterator[Any]:
        """That dimensions that are left over have one value, or are chosen by `at` or `by`."""
        taken = {*self.axes.values(), *self.shows.needs}
        free = {name: along for name, along in own.items() if name not in taken}
        for name, value in self.at.items():
            values = [*free.get(name, ())]
            known = not values or key_of(value) in map(key_of, values)
            none = f"is no dimension that remains{suggestion(name, free)}"
            yield name in free, f"at.{name}", value, none
            yield known, f"at.{name}", value, f"must be one of {as_text(values)}"
        for name, along in free.items():
            chosen = len(along) < 2 or name in self.at or self.shows.takes
            rule = f"is required, one of {as_text([*along])}"
            if "by" in self.keys:
                rule += f"; or by: {name}"
            yield chosen, f"at.{name}", "", rule

    def _rules_of_overlays(self) -> Iterator[Any]:
        """That further studies are those that the figure takes."""
        for role, wanted in self.roles.items():
            given = role in self.overlays or not wanted.required
            rule = f"is required: a study of the quantity {wanted.quantity}"
            yield given, f"overlays.{role}", "", rule
        for role, study in self.overlays.items():
            rule = f"unknown role{suggestion(role, self.roles)}"
            yield role in self.roles, f"overlays.{role}", study, rule


class CasePlot(Kind):
    """A figure of one or several named cases.

    case : the first one if there are several
    """

    further: ClassVar[Sequence[str]] = ()
    rules: ClassVar[Mapping[str, Any]] = {}

    case: str

    @property
    def cases(self) -> tuple[str, ...]:
        """All cases that the figure shows."""
        found = [self.case]
        for key in self.further:
            named = getattr(self, key)
            found += [named] if isinstance(named, str) else named
        return tuple(filter(None, found))

    def faults(self, cases: Mapping[str, Any]) -> list[Any]:
        """What keeps it from being drawn, by the windows of each case; those of a case that has faults
        of its own are None."""
        return violations(*self._rules(cases))

    def _rules(self, cases: Mapping[str, Any]) -> Iterator[Any]:
        """That each case is known, and has recorded the windows that the figure shows."""
        windows = [(key, getattr(self, key), rule) for key, rule in self.rules.items()]
        windows += [("case", name, rule) for name, rule in self.shows.windows.items()]
        for case in self.cases:
            none = f"no such case (known: {', '.join(cases) or 'none'})"
            yield case in cases, "case", case, none
            recorded = cases.get(case)
            if recorded is None:
                continue
            for key, name, wanted in windows:
                rule = f"is not recorded by case {case}{suggestion(name, recorded)}"
                if name in recorded:
                    rule = wanted.broken(recorded[name])
                yield not rule, key, name, rule


# ---- From signatures to models


def kind_of_function(function: Function, name: str) -> type[Kind]:
    """The model of the figures that a marked function draws."""
    hints = get_type_hints(function, include_extras=True)
    first, *parameters = inspect.signature(function).parameters.values()
    fields: Options = {"kind": (Literal[name], name)}
    roles = {}
    rules = {}
    further = []
    for parameter in parameters:
        key = parameter.name
        hint = hints[key]
        default = parameter.default
        mark = next(iter(getattr(hint, "__metadata__", ())), None)
        if isinstance(mark, Role):
            roles[key] = mark
            continue
        if isinstance(mark, Recorded):
            rules[key] = mark
        elif mark in (str, tuple[str, ...]):
            hint = mark
            default = default or mark()
            further.append(key)
        fields[key] = (hint, ... if default is parameter.empty else default)
    base: Any = Plot if first.name == "study" else CasePlot
    doc = inspect.getdoc(function)
    created = create_model(name, __base__=base, __doc__=doc, __module__=__name__, **fields)
    model = cast(Any, created)
    model.function = staticmethod(function)
    model.shows = vars(function)["shows"]
    model.keys = [*fields][1:]
    model.roles = roles
    model.rules = rules
    model.further = further
    return cast(type[Kind], model)


def kinds_in(module: Any, part: str = "") -> dict[str, type[Kind]]:
    """Models of all marked functions that a module defines, by their names, those of a part of the
    workflow with its name before."""
    found = {}
    for name, function in vars(module).items():
        if hasattr(function, "shows") and function.__module__ == module.__name__:
            whole = f"{part}.{name}".removeprefix(".")
            found[whole] = kind_of_function(function, whole)
    return found
