"""Fitted values with their uncertainties, and doubts, in words of figures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from disc_model.data.variables import presentation_of, typeset
from disc_model.display import DEVIATION_DIGITS, number_text, rounded_text
from disc_model.figures.words import POWERS, unit_text

if TYPE_CHECKING:
    from disc_model.fitting.result import Fit

WITHOUT_DEVIATION = 4
"""Significant digits of values without one."""

SIGNS = {"+": "+", "-": "−", "*": "·", "/": "/"}
"""What figures have for the signs of a formula."""
UNBROKEN = "\u00a0"
"""A blank at which no line ends."""


def fitted_text(fit: Fit) -> str:
    """The fitted values, with standard deviations unless these mean nothing, and then why not."""
    values = [_fitted(fit, name) for name in fit.parameters]
    known = []
    if not fit.gap:  # where values are not those of a minimum
        known = [_combined(formula, each) for formula, each in fit.determined.items()]
    return ", ".join([*values, *known, *_doubts(fit)])


def _fitted(fit: Fit, name: str) -> str:
    """A fitted value by its symbol, in the unit of figures; an upper or lower limit if it has one."""
    fitted = fit.parameters[name]
    shown = presentation_of(name)
    limit = fit.limits.get(name, math.nan)
    if not math.isnan(limit):
        side = "<" if limit > fitted.value else ">"
        value = _with_deviation(limit * shown.factor, math.nan, shown.unit)
        share = f"{100 * fit.confidence:.3g} %"
        return f"{_symbol(name)} {side} {value} at {share} confidence"
    deviation = math.nan if fit.doubt else fitted.deviation
    number = fit.at_bounds[name] if name in fit.reached else fitted.value
    value = _with_deviation(number * shown.factor, deviation * shown.factor, shown.unit)
    return f"{_symbol(name)} = {value}{_held(fit, name)}"


def _held(fit: Fit, name: str) -> str:
    """That a value is at its bound, or that only its interval passes this."""
    if name in fit.reached:
        return " at its bound"
    if name in fit.at_bounds:
        shown = presentation_of(name)
        bound = number_text(fit.at_bounds[name] * shown.factor, shown.unit, WITHOUT_DEVIATION)
        return f" (interval passes {bound})"
    return ""


def _symbol(name: str) -> str:
    """The symbol of a parameter; its name if it has none."""
    shown = presentation_of(name)
    return typeset(shown.symbol or shown.name)


def _with_deviation(value: float, deviation: float, unit: str) -> str:
    """A value to the digits of its standard deviation, with this and the unit."""
    if not deviation > 0:
        return number_text(value, unit, WITHOUT_DEVIATION)
    digits = DEVIATION_DIGITS
    if value:
        digits += math.floor(math.log10(abs(value))) - math.floor(math.log10(deviation))
    shown = rounded_text(value, max(digits, DEVIATION_DIGITS))
    return f"{shown} ±{UNBROKEN}{number_text(deviation, unit, DEVIATION_DIGITS)}"


def _combined(formula: str, known: Any) -> str:
    """A combination that the measurements determine, by symbols."""
    words = []
    for word in formula.split(" "):
        name, _, power = word.partition("^")
        raised = POWERS.get(power, f"^{power}")
        words.append(SIGNS.get(word) or f"{_symbol(name)}{raised}")
    value = _with_deviation(known.value, known.deviation, unit_text(known.unit))
    return f"{' '.join(words)} = {value}"


def _doubts(fit: Fit) -> Iterator[str]:
    """Yield in few words the reasons why values mean nothing that are not said beside these."""
    if fit.gap:
        yield "the search stopped in front of a gap"
        if len(fit.indistinct) > 1:
            yield _not_apart(fit.indistinct)
        return
    if not fit.converged:
        yield "the search has not converged"
    if fit.converged and fit.misses:
        yield _misfit(fit)
    if fit.indistinct:
        yield _not_apart(fit.indistinct)
    if fit.unpredicted:
        yield f"no such motion at an end of {_intervals(fit.unpredicted)}"
    if fit.outside:
        yield f"no case at an end of {_intervals(fit.outside)}"


def _not_apart(names: Sequence[str]) -> str:
    """That some parameters are not determined, or not apart from each other."""
    symbols = [_symbol(name) for name in names]
    apart = " apart" if len(symbols) > 1 else ""
    return f"{' and '.join(symbols)} not determined{apart}"


def _misfit(fit: Fit) -> str:
    """That chi squared is too large, and in which share of fits of the right model it is as large."""
    if not fit.freedom:
        return "model or uncertainties are wrong"
    return f"model or uncertainties may be wrong ({fit.share_text})"


def _intervals(names: Iterable[str]) -> str:
    """The intervals of some parameters, by their symbols."""
    symbols = [_symbol(name) for name in names]
    if len(symbols) == 1:
        return f"the interval of {symbols[0]}"
    return f"the intervals of {', '.join(symbols[:-1])} and {symbols[-1]}"
