"""Exceptions, the wording of faults in the input, and the statuses with which computations end."""

from __future__ import annotations

import difflib
import enum
import logging
import math
import re
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import wraps
from inspect import signature
from typing import Any, Self, TypeVar, cast

from pydantic import BaseModel, ValidationError

Function = TypeVar("Function", bound=Callable[..., Any])


class DiscModelError(Exception):
    """Base class of the exceptions of this package."""


def script(main: Callable[..., None]) -> Callable[..., None]:
    """Call a script's main function, unless it is only imported; own errors and Ctrl-C end it
    without a traceback."""
    if main.__module__ == "__main__":
        logging.basicConfig(level=logging.INFO, format="%(name)s: %(message)s")
        try:
            main(*sys.argv[1:])
        except (DiscModelError, KeyboardInterrupt) as error:
            raise SystemExit(str(error) or "interrupted") from None
    return main


def renamed(**names: str) -> Callable[[Function], Function]:
    """Have a function refuse former names of its arguments, and say how they are called now."""

    def wrap(function: Function) -> Function:
        @wraps(function)
        def checked(*args: Any, **named: Any) -> Any:
            for before in names.keys() & named.keys():
                raise ParameterError(
                    Fault.of((before,), named[before], f"is called {names[before]}")
                )
            return function(*args, **named)

        return cast("Function", checked)

    return wrap


def with_known_names(function: Function) -> Function:
    """Have a function say which argument may be meant by a name that none of its arguments has."""
    known = [*signature(function).parameters]

    @wraps(function)
    def checked(*args: Any, **named: Any) -> Any:
        unknown = [name for name in named if name not in known]
        rule = f"is no argument of {function.__name__}"
        raise_faults(
            [Fault.of((name,), named[name], rule + suggestion(name, known)) for name in unknown]
        )
        return function(*args, **named)

    return cast("Function", checked)


class Fault(str):
    """A fault of one value, as ``path=value: rule``; of the whole input without a path; a value ""
    is not shown."""

    path: tuple[str, ...]
    value: str
    rule: str

    def __new__(cls, path: tuple[str, ...], value: str, rule: str) -> Fault:
        head = ".".join(path) + (f"={value}" if value and path else "")
        fault = super().__new__(cls, f"{head}: {rule}" if head else rule)
        fault.path = path
        fault.value = value
        fault.rule = rule
        return fault

    def __getnewargs__(self) -> tuple[tuple[str, ...], str, str]:  # type: ignore[override]
        return (self.path, self.value, self.rule)

    @classmethod
    def of(cls, path: tuple[str, ...], value: Any, rule: str) -> Fault:
        """A fault with the value in the form that messages show."""
        return cls(path, as_text(value), rule)

    def inside(self, path: tuple[str, ...]) -> Fault:
        """The same fault of the whole, of which the part has this path."""
        return Fault((*path, *self.path), self.value, self.rule)


class ParameterError(DiscModelError, ValueError):
    """Input that breaks a rule. One error lists every fault, each as ``name=value: rule``.

    Attributes
    ----------
    faults : tuple of str
        The individual faults, in the order of the message.
    """

    def __init__(self, *faults: str) -> None:
        self.faults = tuple(
            fault if isinstance(fault, Fault) else Fault((), "", fault) for fault in faults
        )
        super().__init__("; ".join(faults))

    def __reduce__(self) -> tuple[type[ParameterError], tuple[str, ...]]:
        return (type(self), self.faults)


def raise_faults(faults: Collection[str]) -> None:
    """Raise one `ParameterError` that lists all faults, if there are any."""
    if faults:
        raise ParameterError(*faults)


def violations(*rules: tuple[object, str, object, str]) -> list[str]:
    """Faults of those rules ``(holds, name, value, rule)`` that do not hold; dots in a name join a
    path."""
    return [
        Fault.of(tuple(name.split(".")), value, rule)
        for holds, name, value, rule in rules
        if not holds
    ]


def require(*rules: tuple[object, str, object, str]) -> None:
    """Raise the `violations` of rules, if there are any."""
    raise_faults(violations(*rules))


class ModeError(DiscModelError):
    """The plate's modes could not be computed to the promised accuracy."""


class SimulationError(DiscModelError):
    """A simulation ended early; the subclass says why."""


class PainleveParadox(SimulationError):
    """The slip denominator 1 + m S2 + sgn(f) mu_k B/r_0 reached 0, beyond which there is no
    solution, or two."""


class StepLimit(SimulationError):
    """The allowed number of steps was used up."""


class Stalled(SimulationError):
    """Time no longer advances, because events accumulate (Zeno behaviour)."""


class NonFinite(SimulationError):
    """The state overflowed or became nan."""


# ---- Wording of faults


def faults_of(error: ValidationError, raw: Any, model: type[BaseModel]) -> list[Fault]:
    """The faults that pydantic found in an input. Where a name is unknown, the model's ``_word`` is
    the word for names, and its ``_unknown`` replaces the rule. A value that may be of several kinds
    breaks a rule of each: one fault names them all."""
    faults: list[Fault] = []
    places: dict[tuple[tuple[str, ...], str], int] = {}  # of faults by path and value
    for item in error.errors(include_url=False):
        path = _path(item, raw)
        kind = item["type"]
        value = item["input"]
        context = item.get("ctx", {})
        reason = context.get("error")
        if isinstance(reason, ParameterError):  # raised by a part that is a model of its own
            faults += [fault.inside(path) for fault in reason.faults]
        elif kind == "missing":
            faults.append(Fault(path, "", "is required"))
        elif kind == "too_short" and len(value) >= context["min_length"]:
            continue  # only valid items were counted, and the others are faults by themselves
        elif kind == "extra_forbidden":
            faults.append(_unknown_name(path, value, model))
        else:
            fault = Fault.of(path, value, _rule(kind, value, context, item["msg"]))
            place = places.setdefault((path, fault.value), len(faults))
            if place < len(faults):
                other = fault.rule.removeprefix("must be ")
                faults[place] = Fault(path, fault.value, f"{faults[place].rule} or {other}")
            else:
                faults.append(fault)
    return faults


def _unknown_name(path: tuple[str, ...], value: Any, model: type[BaseModel]) -> Fault:
    """The fault of a name that a model does not know."""
    word = getattr(model, "_word", "")
    rule = getattr(model, "_unknown", "")
    known = [name for name, field in model.model_fields.items() if field.repr]
    more = suggestion(path[-1], known, all_of_them=not (word or rule))
    if rule:
        return Fault(path, "", rule + more)
    if value is None and path[-1][:1].isdigit():  # the rest of a number that YAML ends at its comma
        return Fault(path, "", "is no key: decimals have a point in place of a comma")
    return Fault(path, as_text(value), f"unknown {word or 'key'}{more}")


def _rule(kind: str, value: Any, context: Mapping[str, Any], message: str) -> str:
    """The rule that a value breaks, from pydantic's kind of fault and message."""
    if kind in _BOUNDS and isinstance(value, float) and math.isnan(value):
        return "must be a finite number"
    if kind in _RULES:
        return _RULES[kind].format(**context)
    return re.sub("^[A-Z][a-z]+ should", "must", message.removeprefix("Value error, "))


_BOUNDS = ("greater_than_equal", "greater_than", "less_than", "less_than_equal")
"""Kinds of faults that pydantic finds in numbers, nan among them."""
_RULES = {  # by pydantic's kind of fault, whose context fills the braces; other kinds have pydantic's words
    "greater_than_equal": "must be >= {ge:g}",
    "greater_than": "must be > {gt:g}",
    "less_than": "must be < {lt:g}",
    "less_than_equal": "must be <= {le:g}",
    "too_short": "must not be empty",
    **dict.fromkeys(
        ("dict_type", "mapping_type", "model_type", "model_attributes_type"), "must be a mapping"
    ),
}


LONGEST_VALUE = 60  # characters of a value in a message


def as_text(value: Any) -> str:
    """The text of a value in messages: shortened, in one line; a float without a final ".0" and
    without noise of rounding."""
    if isinstance(value, float):
        return repr(float(f"{value:.15g}")).removesuffix(".0")
    if hasattr(value, "data_vars"):  # the text of a dataset is a table
        noun = "variable" if len(value.data_vars) == 1 else "variables"
        return f"a dataset of {len(value.data_vars)} {noun}"
    text = ""
    for piece in _pieces(value):
        text += piece
        if len(text) > LONGEST_VALUE:
            return text[: LONGEST_VALUE - 3] + "..."
    return text


def _pieces(value: Any) -> Iterator[str]:
    """The text of a value, piece by piece: that of lists within lists may not end."""
    if type(value) is dict:
        yield "{"
        for i, (name, part) in enumerate(value.items()):
            yield f"{', ' * (i > 0)}{name!r}: "
            yield from _pieces(part)
        yield "}"
    elif type(value) in (list, tuple):
        begin, end = "[]" if type(value) is list else "()"
        yield begin
        for i, part in enumerate(value):
            yield ", " * (i > 0)
            yield from _pieces(part)
        yield "," * (end == ")" and len(value) == 1) + end
    else:
        yield " ".join(repr(value).split("\n"))


OTHER_NAMES: Mapping[str, tuple[str, ...]] = {
    "bounds": ("scan",),
    "count": ("exponents",),
    "exponents": ("count",),
    "horizon": ("horizons",),
    "horizons": ("horizon",),
    "initial_state": ("perturbation",),
    "name": ("parameter",),
    "parameter": ("name",),
    "perturbation": ("start", "initial_state"),
    "prerun": ("initial_state",),
    "scan": ("bounds",),
    "start": ("perturbation", "initial_state"),
    "step": ("scan", "points"),
    "f": ("perturbation",),
    "u": ("perturbation",),
    "u_velocity": ("perturbation",),
}
"""What studies call arguments of functions, and functions the options of studies, if otherwise."""
OF_FUNCTIONS: Mapping[str, str] = {
    "bounds": "bounds=(5, 30)",
    "initial_state": "initial_state=dm.initial_state(case, {'u': 1e-4})",
    "start": "start={'u': 1e-4}",
}
"""How functions are given what studies give by another name, by argument."""
OF_STUDIES: Mapping[str, str] = {
    "perturbation": "perturbation: {u: 1e-4}",
    "scan": "scan: {start: 5, stop: 30, step: 1}",
}
"""How studies are given what functions have by another name, by option."""


def suggestion(name: object, known: Collection[str], all_of_them: bool = True) -> str:
    """Text with the most similar known name and the known names; with `all_of_them` false, only one
    of the two."""
    folded = {field.lower(): field for field in known}
    begin = [
        field for field in folded if len(str(name)) > 1 and field.startswith(str(name).lower())
    ]
    close = begin or difflib.get_close_matches(str(name).lower(), folded, n=1, cutoff=0.6)
    others = [other for other in OTHER_NAMES.get(str(name), ()) if other in folded]
    close = others or close
    meant = f", did you mean {folded[close[0]]}?" if close else ""
    if others:
        meant += form_of(others[0])
    if known and (all_of_them or not close):
        return f"{meant} (known: {', '.join(known)})"
    return meant


def rule_of_choice(name: object, known: Collection[str]) -> str:
    """The rule that a name breaks which is none of those known, with the most similar one."""
    rule = f"must be one of {', '.join(known)}"
    like = suggestion(name, known, all_of_them=False)
    return f"{rule}{like}" if like.startswith(",") else rule


def form_of(name: str) -> str:
    """How functions, or else study files, are given what the other calls otherwise, with the space
    before; "" where the name says all."""
    if name in OF_FUNCTIONS:
        return f" In functions it is {OF_FUNCTIONS[name]}"
    if name in OF_STUDIES:
        return f" In study files it is {OF_STUDIES[name]}"
    return ""


def _path(item: Any, raw: Any) -> tuple[str, ...]:
    """Path of a fault in the input: the steps of pydantic's path that the input has, so not a
    union's branches."""
    path = list[str]()
    part = raw
    for step in item["loc"]:
        steps: Collection[object] = ()
        if isinstance(part, Mapping):
            steps = part
        elif isinstance(part, list | tuple):
            steps = range(len(part))
        if step in steps:
            path.append(str(step))
            part = part[step]
    if item["type"] == "missing":
        path.append(str(item["loc"][-1]))
    return tuple(path)


# ---- Statuses


class StatusBase(enum.StrEnum):
    """A word, and `advice`: a sentence that says what the status means and what to change."""

    advice: str

    def __new__(cls, word: str, advice: str = "") -> Self:
        member = str.__new__(cls, word)
        member._value_ = word
        member.advice = advice
        return member


class ImplausibleValue(UserWarning):
    """A value is allowed but implausible.

    Examples
    --------
    >>> import disc_model as dm
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     case = dm.Parameters(N=385, Omega=15, E=150)
    >>> print(caught[0].category.__name__, caught[0].message)
    ImplausibleValue E is below 1e+09 Pa: Young's modulus is a number in Pa, or has a unit, as in '150 GPa'
    """


class Status(StatusBase):
    """How a simulation ended; `advice` says what to do.

    Examples
    --------
    >>> import disc_model as dm
    >>> status = dm.simulate(dm.Parameters(N=385, Omega=15.1), 60, execution=dm.Execution(max_steps=100)).status
    >>> status.complete, status.advice
    (False, 'The allowed number of steps was used up: raise max_steps, or shorten t_end.')
    """

    OK = "ok", "The simulation reached t_end."
    STOPPED = "stopped", "The simulation stopped where stop_at asked it to."
    STEP_LIMIT = (
        "step_limit",
        "The allowed number of steps was used up: raise max_steps, or shorten t_end.",
    )
    PARADOX = (
        "paradox",
        "Painleve's paradox: rigid friction on this slope has no solution, or two; lower mu_k or N.",
    )
    STALLED = (
        "stalled",
        "Switches follow each other without the clock moving: tighten tol, or perturb initial_state.",
    )
    NON_FINITE = (
        "non_finite",
        "The state overflowed: check the parameters' magnitudes; tighten tol if they are meant.",
    )
    AT_REST = (
        "at_rest",
        "The simulation reached t_end, where the drive stands still and the slider sticks.",
    )

    @property
    def complete(self) -> bool:
        """Whether the simulation reached ``t_end`` or the event at which it had to stop."""
        return self in (Status.OK, Status.STOPPED, Status.AT_REST)
