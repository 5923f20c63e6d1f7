"""How a computation ended, and the package's own exceptions, which say what was wrong, where, and what is right."""

from __future__ import annotations

import enum
from collections.abc import Callable
from typing import Self

# ----------------------------------------------------------------------------------------------------
# Exceptions


class DiscModelError(Exception):
    """Base class of everything this package raises on purpose."""


def exit_on_error(main: Callable[[], None]) -> None:
    """Run a script's main function; an error of this package ends the script with its message alone, no traceback."""
    try:
        main()
    except DiscModelError as error:
        raise SystemExit(str(error)) from None


class Fault(str):
    """What is wrong with one value: the text ``path=value: rule``, which knows its parts.

    Attributes
    ----------
    path : names and indices that lead to the value; empty if it is the whole
    value : as messages show it; "" if it is not shown
    rule : that it breaks
    """

    __slots__ = ("path", "rule", "value")
    path: tuple[str, ...]
    value: str
    rule: str

    def __new__(cls, path: tuple[str, ...], value: str, rule: str) -> Fault:
        place = ".".join(path) + (f"={value}" if value and path else "")
        fault = super().__new__(cls, f"{place}: {rule}" if place else rule)
        fault.path, fault.value, fault.rule = path, value, rule
        return fault

    def __getnewargs__(self) -> tuple[tuple[str, ...], str, str]:  # type: ignore[override]
        return (self.path, self.value, self.rule)


class ParameterError(DiscModelError, ValueError):
    """Input that breaks a rule. One error lists every fault, each as ``name=value: rule``.

    Attributes
    ----------
    faults : tuple of str
        The single faults, in the order in which the message lists them.
    """

    def __init__(self, *faults: str) -> None:
        self.faults = faults
        super().__init__("; ".join(faults))

    def __reduce__(self) -> tuple[type[ParameterError], tuple[str, ...]]:
        return (type(self), self.faults)


class ModeError(DiscModelError):
    """The plate's modes could not be computed to the promised accuracy."""


class SimulationError(DiscModelError):
    """A simulation that ended before its time. See the subclasses."""


class PainleveParadox(SimulationError):
    """The slip denominator 1 + m S2 + sgn(f) mu_k B/r_0 reached 0: no solution beyond, or two."""


class StepLimit(SimulationError):
    """The allowed number of steps was used up."""


class Stalled(SimulationError):
    """Time no longer advances: switches follow each other without end."""


class NonFinite(SimulationError):
    """The state overflowed or became nan."""


# ----------------------------------------------------------------------------------------------------
# Statuses: words that carry their sentence


class StatusBase(enum.StrEnum):
    """Base of all statuses.  A member is given as ``NAME = word, advice``; its value is the word.

    Attributes
    ----------
    advice : what the outcome means and what to change, in a sentence
    """

    advice: str

    def __new__(cls, word: str, advice: str = "") -> Self:
        if not advice:
            raise TypeError(f"{word}: a status needs its advice")
        member = str.__new__(cls, word)
        member._value_ = word
        member.advice = advice
        return member


class Status(StatusBase):
    """How a simulation ended; `advice` says what to do."""

    OK = "ok", "The simulation reached t_end."
    STOPPED = "stopped", "The simulation stopped where stop_at asked it to."
    STEP_LIMIT = "step_limit", "The allowed number of steps was used up: raise max_steps, or shorten t_end."
    PARADOX = (
        "paradox",
        "Painleve's paradox: rigid Coulomb friction on this slope has no solution, or two; lower mu_k or N.",
    )
    STALLED = (
        "stalled",
        "Switches follow each other without the clock moving: tighten tol, or perturb the initial state.",
    )
    NON_FINITE = (
        "non_finite",
        "The state overflowed: check the parameters' magnitudes; tighten tol if they are as meant.",
    )

    @property
    def complete(self) -> bool:
        """Whether the simulation did what was asked."""
        return self in (Status.OK, Status.STOPPED)
