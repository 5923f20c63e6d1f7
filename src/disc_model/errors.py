"""The package's own exceptions. Each message says what was wrong, where, and what would be right."""

from __future__ import annotations

from collections.abc import Callable


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
