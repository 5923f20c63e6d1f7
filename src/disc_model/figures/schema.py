"""What a study file may say of a figure: the signature of a drawing function is its schema.

`grid_figure` and `case_figure` mark the functions that draw; their parameters after the first are
the keys of a figure in a study file.
"""

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, cast, get_args, get_type_hints

from pydantic import AfterValidator, BeforeValidator, Field, create_model

from disc_model.errors import Fault, as_text, raise_faults, suggestion
from disc_model.figures.shown import key_of, si_unit
from disc_model.simulation.case import Poincare, Window
from disc_model.units import UNITS, Finite, Strict, Unit, in_si

NORM = "normalization"
NOTHING: dict[str, Any] = {}
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


class Shows(NamedTuple):
    """What a function draws.

    quantities : of the study; none for any
    needs : dimensions of the study, beside those that its keys name
    takes : whether it takes dimensions beyond these, too
    windows : of each case, by name, with the rules that they must keep
    """

    quantities: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    takes: bool = False
    windows: Mapping[str, Any] = {}


def grid_figure(
    *quantities: str, needs: Sequence[str] = (), takes: bool = False
) -> Callable[[Function], Function]:
    """Mark a function that draws a study, its first argument.

    Parameters with the type ``Annotated[xr.Dataset | None, Role(...)]`` take further studies; `x`, `y`,
    `by` and `starts` name dimensions.
    """
    return _marked(Shows(quantities, tuple(needs), takes))


def case_figure(windows: Mapping[str, Any] | None = None) -> Callable[[Function], Function]:
    """Mark a function that draws a case, its first argument.

    Parameters of the types `Case` and `Cases` take further cases; those with a rule, such as `Samples`,
    name a window.
    """
    return _marked(Shows(windows=windows or {}))


def _marked(shows: Shows) -> Callable[[Function], Function]:
    def mark(function: Function) -> Function:
        function.shows = shows  # type: ignore[attr-defined]
        return function

    return mark


Case = Annotated[Any, "case"]
Cases = Annotated[Any, "cases"]


# ---- Rules of windows: each returns the rule that a window breaks, or ""


def as_samples(window: Any) -> str:
    """The rule of a window that is drawn sample by sample."""
    is_plain = isinstance(window, Window) and window.envelope is None
    return "" if is_plain else "must be a window without an envelope"


def as_ranges(window: Any) -> str:
    """The rule of a window that is drawn as ranges."""
    has_ranges = isinstance(window, Window) and window.envelope is not None
    return as_either(window) if has_ranges else "must be a window that has an envelope"


def as_either(window: Any) -> str:
    """The rule of a window that is drawn as samples or as ranges."""
    enough = isinstance(window, Window) and window.count >= 2 * (window.envelope or 1)
    return "" if enough else "must be a window of two samples, or two envelopes, or more"


def as_spectrum(window: Any) -> str:
    """The rule of a window whose spectrum in time is drawn."""
    long_enough = as_samples(window) or window.stop - window.start >= 1.1
    return as_samples(window) if long_enough else "must be 1.1 s long or more"


Samples = Annotated[str, as_samples]
Ranges = Annotated[str, as_ranges]
Either = Annotated[str, as_either]
InTime = Annotated[str, as_spectrum]


# ---- Figures


def known_units(units: dict[str, str]) -> dict[str, str]:
    """The units, if each is one of its parameter or variable; raises `ParameterError`."""
    faults: list[Fault] = []
    for name, unit in units.items():
        if si_unit(name) in ("", "1"):
            faults.append(Fault.of((name,), unit, "no parameter or variable with a unit"))
        else:
            in_si(f"1 {unit}", si_unit(name), faults, (name,))
    raise_faults(faults)
    return units


def _joined(caption: Any) -> Any:
    return " ".join(map(str, caption)) if isinstance(caption, list) else caption


def _by_key(names: Any) -> Any:
    return {key_of(x): name for x, name in names.items()} if isinstance(names, dict) else names


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

    kind: str
    title: str = ""
    caption: Annotated[str, BeforeValidator(_joined, json_schema_input_type=str | list[str])] = ""
    section: str = ""
    units: Annotated[dict[str, str], AfterValidator(known_units)] = Field({})
    width: Literal["column", "page"] | None = None

    @property
    def options(self) -> dict[str, Any]:
        """Arguments of the drawing function, without studies and cases."""
        _, *names = inspect.signature(type(self).function).parameters
        fields = type(self).model_fields
        return {name: getattr(self, name) for name in names if name in fields}


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
    names: Annotated[dict[str, str], BeforeValidator(_by_key)] = Field({})

    @property
    def axes(self) -> dict[str, str]:
        """Dimensions of the grid by the keys that name them."""
        chosen = {key: getattr(self, key, None) for key in ("x", "y", "by", "starts")}
        return {key: name for key, name in chosen.items() if name}

    def faults(
        self, dims: Values, variables: Mapping[str, Values], classes: Sequence[str] = ()
    ) -> Iterator[Fault]:
        """What keeps it from showing a study.

        dims : values along the dimensions of the study
        variables : the same of each of its variables, with the dimensions of its own
        classes : variables that are words
        """
        own = dims
        variable = getattr(self, "variable", None)
        if variable is not None:
            if variable not in variables:
                rule = f"unknown variable{suggestion(variable, variables)}"
                yield Fault.of(("variable",), variable, rule)
                return
            own = variables[variable]
            if variable in classes and getattr(self, "log", False):
                yield Fault.of(("log",), True, f"is for numbers: {variable} has classes")
        wrong = [*self._wrong_axes(own)]
        yield from wrong or self._wrong_rest(own)
        for role, wanted in self.roles.items():
            if wanted.required and role not in self.overlays:
                rule = f"is required: a study of the quantity {wanted.quantity}"
                yield Fault(("overlays", role), "", rule)
        for role in self.overlays.keys() - self.roles.keys():
            rule = f"unknown role{suggestion(role, self.roles)}"
            yield Fault.of(("overlays", role), self.overlays[role], rule)

    def _wrong_axes(self, own: Values) -> Iterator[Fault]:
        """Dimensions that the study lacks, or that cannot be axes."""
        needed = [("kind", name) for name in self.shows.needs]
        seen: set[str] = set()
        for key, name in (*needed, *self.axes.items()):
            along = own.get(name, ())
            rule = ""
            if name not in own:
                if (key, name) != ("by", NORM):
                    rule = f"needs the dimension {name}{suggestion(name, own)}"
            elif name in seen:
                rule = "must differ from the other dimensions"
            elif key in ("x", "y") and any(isinstance(value, str | tuple) for value in along):
                rule = "must be one parameter, and a number"
            elif key == "by" and len(along) > MOST_VALUES:
                rule = f"has {len(along)} values, and there is room for {MOST_VALUES}"
            seen.add(name)
            if rule:
                yield Fault.of((key,), name, rule)
        by = own.get(self.axes.get("by", ""), ())
        for value in self.names if by else ():
            if value not in map(key_of, by):
                yield Fault.of(("names",), value, f"must be one of {as_text([*by])}")

    def _wrong_rest(self, own: Values) -> Iterator[Fault]:
        """Dimensions that are left over must have one value, or be chosen by `at` or `by`."""
        shown = {*self.axes.values(), *self.shows.needs}
        free = {name: along for name, along in own.items() if name not in shown}
        for name in {**free, **self.at}:
            along = free.get(name, ())
            several = len(along) > 1 and not self.shows.takes
            if name not in free:
                rule = f"is no dimension that remains{suggestion(name, free)}"
                yield Fault.of(("at", name), self.at[name], rule)
            elif name not in self.at:
                rule = f"is required, one of {as_text([*along])}"
                if "by" in type(self).model_fields:
                    rule += f"; or by: {name}"
                if several:
                    yield Fault(("at", name), "", rule)
            elif along and key_of(self.at[name]) not in map(key_of, along):
                yield Fault.of(("at", name), self.at[name], f"must be one of {as_text([*along])}")


class CasePlot(Kind):
    """A figure of one or several named cases.

    case : the first one if there are several
    """

    further: ClassVar[tuple[str, ...]] = ()
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

    def faults(
        self, cases: Mapping[str, Mapping[str, Window | Poincare] | None]
    ) -> Iterator[Fault]:
        """What keeps it from being drawn, by the windows of each case; those of a case that has faults
        of its own are None."""
        windows = [(key, getattr(self, key), rule) for key, rule in self.rules.items()]
        windows += [("case", name, rule) for name, rule in self.shows.windows.items()]
        for case in self.cases:
            recorded = cases.get(case, {})
            if case not in cases:
                rule = f"no such case (known: {', '.join(cases) or 'none'})"
                yield Fault.of(("case",), case, rule)
            elif recorded is not None:
                for key, name, broken in windows:
                    rule = f"is not recorded by case {case}{suggestion(name, recorded)}"
                    if name in recorded:
                        rule = broken(recorded[name]) if broken else ""
                    if rule:
                        yield Fault.of((key,), name, rule)


# ---- From signatures to models


def kind_of_function(function: Function, name: str) -> type[Kind]:
    """The model of the figures that a marked function draws."""
    hints = get_type_hints(function, include_extras=True)
    first, *parameters = inspect.signature(function).parameters.values()
    fields: dict[str, Any] = {"kind": (Literal[name], name)}
    roles: dict[str, Role] = {}
    further: list[str] = []
    rules: dict[str, Any] = {}
    for parameter in parameters:
        key, hint, default = parameter.name, hints[parameter.name], parameter.default
        given: Any = ... if default is inspect.Parameter.empty else default
        marks = get_args(hint)[1:] if hasattr(hint, "__metadata__") else ()
        mark = marks[0] if marks else None
        if isinstance(mark, Role):
            roles[key] = mark
        elif mark in ("case", "cases"):
            further.append(key)
            one = mark == "case"
            fields[key] = (str, given or "") if one else (tuple[str, ...], given or ())
        else:
            fields[key] = (hint, given)
            rules.update((key, mark) for mark in marks if inspect.isfunction(mark))
    base: Any = Plot if first.name == "study" else CasePlot
    doc = inspect.getdoc(function)
    created = create_model(name, __base__=base, __doc__=doc, __module__=__name__, **fields)
    model = cast(Any, created)
    model.function, model.shows = staticmethod(function), vars(function)["shows"]
    model.roles, model.further, model.rules = roles, tuple(further), rules
    return cast(type[Kind], model)


def kinds_in(module: Any, part: str = "") -> dict[str, type[Kind]]:
    """Models of all marked functions that a module defines, by their names, those of a part of the
    workflow with its name before."""
    found = {}
    for name, function in vars(module).items():
        if hasattr(function, "shows") and function.__module__ == module.__name__:
            whole = f"{part}.{name}" if part else name
            found[whole] = kind_of_function(function, whole)
    return found
