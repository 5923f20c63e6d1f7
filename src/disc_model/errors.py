"""Exceptions, faults of the input, and the statuses with which computations end."""

from __future__ import annotations

import difflib
import enum
import logging
import re
import reprlib
import sys
from collections.abc import Callable, Collection
from typing import Any, NamedTuple, Self

from pydantic import BaseModel, ValidationError


class DiscModelError(Exception):
    """Base class of the exceptions of this package."""


class Fault(NamedTuple):
    """A fault of one value, as ``path=value: rule``; of the whole input without a path."""

    path: tuple[str, ...]
    value: str
    rule: str

    def __str__(self) -> str:
        place = "=".join(filter(None, [".".join(self.path), self.value]))
        return ": ".join(filter(None, [place, self.rule]))

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
    faults : tuple
        The individual faults, in the order of the message, each with its path, value and rule.
    """

    def __init__(self, *faults: Fault | str) -> None:
        self.faults = tuple(Fault((), "", x) if isinstance(x, str) else x for x in faults)
        super().__init__("; ".join(map(str, faults)))

    def __reduce__(self) -> tuple[type[ParameterError], tuple[Fault, ...]]:
        return (type(self), self.faults)


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


# ---- Rules


Check = tuple[object, str, object, str]
"""Whether a rule holds, and if not: the name, in which dots join a path, the value and the rule."""


def raise_faults(faults: Collection[Fault]) -> None:
    """Raise one `ParameterError` that lists all faults, if there are any."""
    if faults:
        raise ParameterError(*faults)


def violations(*checks: Check) -> list[Fault]:
    """Faults of those rules that do not hold."""
    faults = []
    for holds, name, value, rule in checks:
        if not holds:
            faults.append(Fault.of(tuple(name.split(".")), value, rule))
    return faults


def require(*checks: Check) -> None:
    """Raise the `violations` of rules, if there are any."""
    raise_faults(violations(*checks))


# ---- Wording

LONGEST_VALUE = 60  # characters of a value in a message
_SHORT = reprlib.Repr()
_SHORT.maxother = _SHORT.maxstring = _SHORT.maxlong = LONGEST_VALUE
_SHORT.maxlist = _SHORT.maxtuple = _SHORT.maxdict = 10


def as_text(value: Any) -> str:
    """The text of a value in messages: shortened, in one line, and a float without noise of
    rounding."""
    if isinstance(value, float):
        return repr(float(f"{value:.15g}")).removesuffix(".0")
    text = " ".join(_SHORT.repr(value).split("\n"))
    if len(text) > LONGEST_VALUE:
        return text[: LONGEST_VALUE - 3] + "..."
    return text


def suggestion(name: object, known: Collection[str], all_of_them: bool = True) -> str:
    """Text with the most similar known name and the known names; with `all_of_them` false, only one
    of the two."""
    folded = {each.lower(): each for each in known}
    close = difflib.get_close_matches(str(name).lower(), folded, n=1)
    meant = ""
    if close:
        meant = f", did you mean {folded[close[0]]}?"
    if known and (all_of_them or not close):
        return f"{meant} (known: {', '.join(known)})"
    return meant


def rule_of_choice(known: Collection[str]) -> str:
    """The rule of a name that must be one of those known."""
    return f"must be one of {', '.join(known)}"


# ---- Faults that pydantic finds

_RULES = {  # by pydantic's kind of fault, whose context fills the braces; others have its words
    "greater_than_equal": "must be >= {ge:g}",
    "greater_than": "must be > {gt:g}",
    "less_than_equal": "must be <= {le:g}",
    "less_than": "must be < {lt:g}",
    "too_short": "must not be empty",
    "model_type": "must be a mapping",
    "dict_type": "must be a mapping",
}


def faults_of(error: ValidationError, raw: Any, model: type[BaseModel]) -> list[Fault]:
    """The faults that pydantic found in an input. The model's ``_unknown`` is the rule for names
    that it does not know. A value that may be of several kinds breaks a rule of each."""
    faults: dict[object, Fault] = {}
    for item in error.errors(include_url=False):
        kind = item["type"]
        context = item.get("ctx", {})
        path = _path(item["loc"], raw)
        if isinstance(context.get("error"), ParameterError):  # of a part that is a model of its own
            faults |= {each: each.inside(path) for each in context["error"].faults}
            continue
        rule = re.sub("^[A-Z][a-z]+ should", "must", item["msg"].removeprefix("Value error, "))
        if kind == "extra_forbidden":
            rule = getattr(model, "_unknown", "unknown key") + suggestion(
                path[-1], model.model_fields, all_of_them=False
            )
        elif kind == "missing":
            path = (*path, str(item["loc"][-1]))
            rule = "is required"
        elif kind in _RULES:
            rule = _RULES[kind].format(**context)
        if path in faults:
            rule = f"{faults[path].rule} or {rule.removeprefix('must be ')}"
        faults[path] = Fault(path, "" if kind == "missing" else as_text(item["input"]), rule)
    return [*faults.values()]


def _path(place: tuple[int | str, ...], raw: Any) -> tuple[str, ...]:
    """Path of a fault in the input: the steps of pydantic's that the input has, so not the branches
    of a union."""
    path: list[str] = []
    part = raw
    for step in place:
        try:
            part = part[step]
        except (TypeError, KeyError, IndexError):
            continue
        path.append(str(step))
    return tuple(path)


# ---- Ends of scripts and computations


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
