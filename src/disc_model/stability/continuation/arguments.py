"""What is asked of a continuation: the free parameters, their bounds and values, in SI units, and where
to stop."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from disc_model.errors import Fault, raise_faults, require, suggestion, violations
from disc_model.mode_units import column_of, mode_number_in_si
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.states import is_finite_array
from disc_model.units import in_si, is_number, is_quantity, number

UNSET = ("damping_ratio",)  # numbers that are None in a case without them
ROUNDING = 1e-9  # of a value, over the scale or the span of its parameter
LABELS: dict[str, str] = {
    "fold": "LP",
    "period_doubling": "PD",
    "neimark_sacker": "TR",
    "branch_point": "BP",
    "grazing": "GR",
    "hopf": "HB",
    "end": "EP",
    "max_points": "EP",
    "lost": "EP",
}
"""Kinds of special points, and their labels in AUTO and COCO."""
CHANGES = ("fold", "period_doubling", "neimark_sacker")
"""Kinds of special points that are located to rounding, and at which a multiplier crosses the unit
circle."""
STOPS = f"must be None, or one or several of {', '.join(CHANGES)}, or of their labels"
"""The rule of the special points at which a branch shall stop."""


def free_faults(p: Parameters, names: Sequence[Any]) -> list[str]:
    """Faults of the names of free parameters."""
    known = p.numbers
    faults = list[str]()
    for name in names:
        if isinstance(name, str) and name in known:
            continue
        rule = f"must be a number of the case{suggestion(name, known)}"
        if isinstance(name, str) and (name in UNSET or isinstance(getattr(p, name, None), float)):
            rule = "does not act in this case; give the case a value with which it does first"
        faults.append(Fault.of(("name",), name, rule))
    return faults


def interval_in_si(name: Any, bounds: Any, faults: list[Fault] | None = None) -> Any:
    """Bounds of a parameter in SI units, from texts with units too; None unless they are two
    ascending numbers. Units of another kind are added to the faults."""
    values = values_in_si(name, bounds, faults, "bounds")
    return values if is_finite_array(values, 2) and values[0] < values[1] else None


def values_in_si(
    name: Any, values: Any, faults: list[Fault] | None = None, argument: str = "values"
) -> Any:
    """Values of a parameter in SI units, from texts with units too. Units of another kind are added
    to the faults of the argument."""
    found = list[Fault]()
    if column_of(name):
        converted = values
        if isinstance(values, list | tuple):
            converted = [mode_number_in_si(name, value, found) for value in values]
    else:
        unit = ""
        if isinstance(name, str):
            unit = Parameters.unit(name)
        converted = _numbers(in_si(values, unit, found, ()))
    if faults is not None:
        faults += [Fault((argument,), each.value, each.rule) for each in found]
    return converted


def _numbers(values: Any) -> Any:
    """Values in which texts that are numbers, such as "0.3", are these."""
    if not isinstance(values, list | tuple):
        return values
    try:
        return [number(value) if isinstance(value, str) else value for value in values]
    except ValueError:
        return values


def read_values(
    case: Any, name: Any, bounds: Any, values: Any, wrong: Sequence[str]
) -> tuple[tuple[float, float], list[float]]:
    """Bounds and values of the free parameter in SI units.

    Raises `ParameterError` with the faults of these, of the case and the name, and others that are
    known to be `wrong`.
    """
    of_bounds = list[Fault]()
    of_values = list[Fault]()
    span = interval_in_si(name, bounds, of_bounds)
    if isinstance(values, str) or is_number(values) or is_quantity(values):
        values = [values]
    listed = isinstance(values, Sequence | np.ndarray)
    wanted: Any = values_in_si(name, list(values), of_values) if listed else None
    ascend = span is not None or bool(of_bounds)
    numbers = wanted == [] or is_finite_array(wanted) or bool(of_values)
    faults = violations(
        (ascend, "bounds", bounds, "must be two ascending finite numbers"),
        (numbers, "values", values, "must be a finite number, or a list of these"),
    )
    faults += [*of_bounds, *of_values, *wrong]
    raise_faults(foreign_case(case) or faults + free_faults(case, [name]))
    _check_within(span, case, name, dict(zip(values, wanted, strict=True)))
    return span, wanted


def _check_within(
    span: tuple[float, float], case: Parameters, name: str, wanted: Mapping[Any, float]
) -> None:
    """Raise `ParameterError` unless the case, and values as given and in SI units, lie within
    bounds."""
    slack = ROUNDING * (span[1] - span[0])  # ratios are rounded
    least, greatest = span[0] - slack, span[1] + slack
    start = case.numbers[name]
    outside = [given for given, value in wanted.items() if not least <= value <= greatest]
    unit = case.unit(name).removeprefix("1")
    rule = f"must lie within the bounds, {span[0]:g} to {span[1]:g} {unit}".strip()
    require(
        (least <= start <= greatest, name, start, f"{rule}, to start from there"),
        (not outside, "values", next(iter(outside), None), rule),
    )


def stop_kinds(stop_at: object) -> frozenset[str] | None:
    """The kinds of special points, given by kinds or labels, at which a branch shall stop; None if
    there is another one among them, or none."""
    if stop_at is None:
        return frozenset()
    known = {kind: kind for kind in CHANGES} | {LABELS[kind]: kind for kind in CHANGES}
    given = [stop_at] if isinstance(stop_at, str) else stop_at
    if not isinstance(given, Sequence) or not all(isinstance(x, str) for x in given):
        return None
    return frozenset(known[x] for x in given) if given and known.keys() >= set(given) else None
