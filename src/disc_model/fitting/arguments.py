"""Checks of the arguments of `fit`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import compress
from typing import Any

from disc_model.data.variables import unit_of_parameter
from disc_model.disc.plausibility import doubt_of_measured, warn_of_measured
from disc_model.errors import Fault, ParameterError, raise_faults, suggestion, violations
from disc_model.fitting.measured import Measurement, is_finite, measurements_of
from disc_model.fitting.prediction import is_of_steady_cycle
from disc_model.fitting.table import in_row, is_table, measurements_in
from disc_model.mode_units import column_of, mode_number_in_si, si_unit_of_mode
from disc_model.parameters import Parameters, foreign_case
from disc_model.units import in_si, is_number, mixed_units, number

Interval = tuple[float, float]


def checked_measurements(
    p: object, vary: object, measured: object, bounds: object, confidence: object
) -> tuple[Measurement, ...]:
    """Return the measurements, after all checks that need no computation."""
    raise_faults(foreign_case(p))
    assert isinstance(p, Parameters)
    faults = _vary_faults(p, vary)
    good = is_number(confidence) and 0 < confidence < 1  # type: ignore[operator]
    faults += violations((good, "confidence", confidence, "must lie between 0 and 1"))
    in_rows = is_table(measured)
    if in_rows:
        measurements = measurements_in(measured, p.numbers, vary, faults)
    else:
        measurements = measurements_of(measured, faults)
    if not faults:
        assert isinstance(vary, Sequence)
        faults += _settings_faults(p, vary, measurements, in_rows)
        faults += _bounds_faults(p, vary, bounds)
        enough = len(measurements) >= len(vary)
        rule = f"must be at least as many as the varied parameters, {len(vary)}"
        faults += violations((enough, "measured", f"{len(measurements)} values", rule))
    raise_faults(faults)
    return measurements


def check_progress(progress: object) -> None:
    """Raise `ParameterError` unless it is said whether a bar is shown."""
    told = isinstance(progress, bool)
    raise_faults(violations((told, "progress", progress, "must be True or False")))


def _vary_faults(p: Parameters, vary: object) -> list[str]:
    """Return faults of the names of varied parameters."""
    if isinstance(vary, str) or not isinstance(vary, Sequence) or not vary:
        rule = "must be a list of names of parameters"
        return [Fault.of(("vary",), vary, rule)]
    faults: list[str] = []
    of_disc = p.disc.numbers if p.disc is not None else {}
    for i, name in enumerate(vary):
        if isinstance(name, str) and name in of_disc and name not in p.numbers:
            rule = "acts only where friction does on the surface: friction_offset must be 'surface'"
            faults.append(Fault.of(("vary", str(i)), name, rule))
        elif not isinstance(name, str) or name not in p.numbers:
            rule = "is no number of this case" + suggestion(name, list(p.numbers))
            faults.append(Fault.of(("vary", str(i)), name, rule))
        elif name in vary[:i]:
            faults.append(Fault.of(("vary", str(i)), name, "must not be given twice"))
    return faults


def _settings_faults(
    p: Parameters, vary: Sequence[str], measurements: Sequence[Measurement], in_rows: bool
) -> list[str]:
    """Return faults of what was set at measurements, which may be the rows of a table: values of varied
    parameters, and wrong ones."""
    faults: list[str] = []
    for i, each in enumerate(measurements):
        path = ("measured", str(i), "at")
        both = [name for name in each.at if name in vary]
        if both:
            value = {name: each.at[name] for name in both}
            faults.append(Fault.of(path, value, "must not set what is varied"))
            continue
        try:
            p.replace(**each.at)
        except ParameterError as error:
            told = [fault for fault in error.faults if isinstance(fault, Fault)]
            faults += [in_row(x, i) if in_rows else x.inside(path) for x in told]
    return faults


def _bounds_faults(p: Parameters, vary: Sequence[str], bounds: object) -> list[str]:
    """Return faults of bounds: of unknown names, in a wrong order, or without the start."""
    if bounds is None:
        bounds = {}
    if not isinstance(bounds, Mapping):
        return [Fault.of(("bounds",), bounds, "must give two values by parameter")]
    faults: list[str] = []
    for name, pair in bounds.items():
        path = ("bounds", str(name))
        if name not in vary:
            faults.append(Fault.of(path, pair, "must be of a parameter that is varied"))
            continue
        value = p.numbers[name]
        of_units: list[Fault] = []
        ends = _ends_in_si(name, pair, of_units)
        if of_units:
            faults += of_units
            continue
        good = isinstance(ends, tuple | list) and len(ends) == 2 and all(map(is_finite, ends))
        if not (good and ends[0] < ends[1] and ends[0] <= value <= ends[1]):
            rule = f"must be two ascending values around the start, {value:.6g}"
            faults.append(Fault.of(path, pair, rule))
    for name in vary:
        if p.numbers[name] == 0 and name not in bounds:
            rule = "must have bounds, because its start is 0, which gives it no scale"
            faults.append(Fault.of(("vary", name), 0.0, rule))
    return faults


def doubt_far_measurements(measurements: Sequence[Measurement], computed: Sequence[float]) -> None:
    """Warn of measured frequencies that are far from what the case gives at the start.

    computed : what the case gives of each measurement

    Raises
    ------
    ParameterError
        If a time or length of a cycle is as far away. Its search would lead to cases in which no cycle is known, or
        each takes minutes.
    """
    named = [(each.name, each.value, each.unit) for each in measurements]
    of_cycles = [is_of_steady_cycle(each.quantity) for each in measurements]
    far = doubt_of_measured([*compress(named, of_cycles)], [*compress(computed, of_cycles)])
    if far:
        remedy = "; if it is right, start from a case that gives a value nearer to it"
        raise ParameterError(Fault(("measured",), "", far + remedy))
    others = [not is_of_cycle for is_of_cycle in of_cycles]
    warn_of_measured([*compress(named, others)], [*compress(computed, others)])


def limits_in_si(vary: Sequence[str], bounds: Mapping[str, tuple[Any, Any]]) -> dict[str, Interval]:
    """Return the bounds in SI units."""
    found = {}
    for name in vary:
        if name in bounds:
            low, high = _ends_in_si(name, bounds[name], [])
            found[name] = (float(low), float(high))
    return found


def _ends_in_si(name: str, pair: Any, faults: list[Fault]) -> Any:
    """Return the bounds of a parameter with texts as numbers in its unit; texts that are none, or have
    a unit of another kind, become faults."""
    path = ("bounds", name)
    if column_of(name) and isinstance(pair, tuple | list):
        return _ends_of_mode_number(name, pair, faults)
    unit = unit_of_parameter(name) or "1"
    ends = in_si(pair, unit, faults, path)
    if not isinstance(ends, tuple | list):
        return ends
    found = []
    for i, end in enumerate(ends):
        try:
            found.append(number(end) if isinstance(end, str) else end)
        except ValueError as error:
            if not faults:
                faults.append(Fault.of((*path, str(i)), end, str(error)))
            found.append(end)
    return found


def _ends_of_mode_number(name: str, pair: Sequence[Any], faults: list[Fault]) -> list[Any]:
    """Return the bounds of a number of one mode of a disc in SI units; units of another kind become
    faults."""
    faults += mixed_units(pair, si_unit_of_mode(name), ("bounds", name))
    found = []
    for i, end in enumerate(pair):
        of_end: list[Fault] = []
        found.append(mode_number_in_si(name, end, of_end))
        faults += [Fault.of(("bounds", name, str(i)), end, fault.rule) for fault in of_end]
    return found
