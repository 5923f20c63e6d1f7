"""Arguments of a function that vary along a sweep: their values, units and meanings."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from disc_model.data.variables import OF_ARGUMENTS
from disc_model.errors import Fault, suggestion
from disc_model.studies.options import Option, options_of
from disc_model.studies.registry import quantity_names, quantity_of
from disc_model.studies.swept_values import as_list, faults_along_axis
from disc_model.units import in_si, number

QUANTITIES = {"lyapunov_exponents": "lyapunov"}
"""Quantities that have the options of a function of another name."""
OPTIONS = {"horizon": "horizons"}
"""Options of quantities that are arguments of another name."""
SEVERAL = re.compile("tuple|list|Sequence|Mapping|dict|Iterable|[Aa]rray", re.ASCII)
"""What the annotation of an argument says that takes several values at once."""
KINDS = ((bool,), (int, float), (str,), (Mapping,), (list, tuple, np.ndarray))
"""Types of values along one axis."""


@dataclass(frozen=True)
class Arguments:
    """The arguments of a function.

    Attributes
    ----------
    title : name of the function
    ours : the same if it is one of this package, else ""
    parameters : what its signature states, its case first
    """

    title: str
    ours: str
    parameters: Mapping[str, inspect.Parameter]

    @property
    def names(self) -> list[str]:
        """Names of all that can be given beside the case."""
        besides = [*self.parameters.values()][1:]
        unnamed = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
        return [each.name for each in besides if each.kind not in unnamed]

    @property
    def takes_any(self) -> bool:
        """Whether the function takes arguments of any name."""
        return any(each.kind is each.VAR_KEYWORD for each in self.parameters.values())

    def listed(self, options: Mapping[str, Any]) -> dict[str, Any]:
        """Those of the options that are several values, though the function may take one."""
        found = {}
        for name, value in options.items():
            is_list = isinstance(value, list) or getattr(value, "ndim", 0) == 1
            if is_list and not SEVERAL.search(self._annotation(name)):
                found[name] = value
        return found

    def _annotation(self, name: str) -> str:
        """What the function says that an argument takes, "" if nothing."""
        if name not in self.parameters:
            return ""
        annotation = self.parameters[name].annotation
        return "" if annotation is inspect.Parameter.empty else str(annotation)

    def unit_and_meaning(self, name: str) -> tuple[str, str]:
        """The SI unit of an argument, "1" of a plain number, and what it is, as far as this package
        knows them."""
        known = OF_ARGUMENTS.get(self.ours, {})
        if name in known:
            return known[name].units, known[name].long_name
        quantity = QUANTITIES.get(self.ours, self.ours)
        if quantity in quantity_names():
            for option in options_of(quantity_of(quantity)):
                if option.name in (name, OPTIONS.get(name)):
                    # remarks follow
                    return _unit_of(option), re.split("[,:;] ", option.meaning)[0]
        return "", ""

    def attributes(self, name: str) -> dict[str, str]:
        """The unit and the meaning of an argument as attributes of a coordinate."""
        unit, meaning = self.unit_and_meaning(name)
        unit = re.sub(r"/(\w+?)\^?(\d?)$", lambda below: f" {below[1]}-{below[2] or 1}", unit)
        attributes = {"units": unit, "long_name": meaning}
        return {key: text for key, text in attributes.items() if text}


def _unit_of(option: Option) -> str:
    """The SI unit of an option, "1" of a plain number, "" of words and of what has the unit of
    another option."""
    if "`" in option.unit:
        return ""
    if not option.unit and option.form.startswith(("number", "whole number", "list of numbers")):
        return "1"
    return option.unit


def values_over(
    over: Any,
    arguments: Arguments,
    numbers: Collection[str],
    taken: Collection[str],
    faults: list[str],
) -> dict[str, list[Any]]:
    """The values of arguments of a function that vary, by name, in SI units where these are known.

    Parameters
    ----------
    over : what the user gave
    arguments : of the function
    numbers : names of numbers of the case
    taken : names of all else that is given
    faults : gets what is wrong
    """
    if not isinstance(over, Mapping) or not over:
        rule = "must be values by the names of arguments of the function, such as horizon"
        faults.append(Fault.of(("over",), over, rule))
        return {}
    found = {}
    for name, given in over.items():
        wrong = _fault_of_name(name, arguments, numbers)
        if name in taken:
            wrong = "must not be given twice"
        if wrong:
            faults.append(Fault(("over", str(name)), "", wrong))
            continue
        unit, _ = arguments.unit_and_meaning(name)
        values = [_in_unit(value, unit) for value in as_list(given)]
        wrong = _fault_of_values(values)
        if wrong:
            faults.append(Fault.of(("over", name), given, wrong))
            continue
        shown = values_along(values)
        faults += [fault.inside(("over",)) for fault in faults_along_axis(name, shown)]
        found[name] = values
    return found


def _fault_of_name(name: Any, arguments: Arguments, numbers: Collection[str]) -> str:
    """The rule that a name breaks, "" if it is that of an argument."""
    known = arguments.names
    if name in known or (arguments.takes_any and isinstance(name, str)):
        return ""
    if name in numbers:
        return f"is a number of the case: give it beside over, as in {name}=[...]"
    return f"is no argument of {arguments.title}{suggestion(name, known)}"


def _fault_of_values(values: Sequence[Any]) -> str:
    """The rule that values along an axis break, "" if none."""
    if not values:
        return "must have one value or more"
    if any(all(isinstance(value, kind) for value in values) for kind in KINDS):
        return ""
    return (
        "must be all numbers, all words, all mappings such as starts, or all lists such as bounds"
    )


def values_along(values: Sequence[Any]) -> list[Any]:
    """What stands for values along an axis: words for mappings and lists, and else themselves."""
    return [_words_for(value) for value in values]


def _words_for(value: Any) -> Any:
    """A mapping or a list in words, any other value as it is."""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {_text_of(each)}" for name, each in value.items()) or "none"
    if isinstance(value, list | tuple | np.ndarray):
        return ", ".join(map(_text_of, value)) or "none"
    return value


def _text_of(value: Any) -> str:
    """A value in a list in words."""
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def _in_unit(value: Any, unit: str) -> Any:
    """A value in an SI unit, as a number where it is one; as it is without a unit, or if it is none,
    which the function then says."""
    if getattr(value, "ndim", None) == 0 and hasattr(value, "item"):
        value = value.item()
    if unit in ("", "1"):
        return value
    try:
        return number(in_si(value, unit, [], ()))
    except ValueError:
        return value


def hint_of_lists(listed: Mapping[str, Any]) -> str:
    """What to do where several values were meant to vary."""
    names = ", ".join(listed)
    example = ", ".join(f'"{name}": [...]' for name in listed)
    return f"to vary {names}, give over={{{example}}}"
