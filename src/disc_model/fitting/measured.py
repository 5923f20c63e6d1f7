"""What was measured: the values that `fit` compares with those of a case."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

from disc_model.arrays import Array
from disc_model.errors import Fault, ParameterError, raise_faults, violations
from disc_model.fitting.prediction import unit_of, unknown_quantity
from disc_model.parameters import Parameters
from disc_model.units import in_si, is_number, si_unit_of


@dataclass(frozen=True)
class Measurement:
    """A measured value of a quantity, with its uncertainty, and what was set when it was measured.

    Parameters
    ----------
    quantity : name of a quantity of a case: ``period``, ``growth_rate``, ``stick_fraction``, ``stick_time``,
        ``slip_time``, ``slip_length``, ``sliding_growth_rate``, ``sliding_frequency``; of the disc's mode with two
        nodal diameters and no circle ``frequency_2_0`` (Hz) and ``damping_ratio_2_0``; of disc and attached slider
        ``coupled_frequency_1`` (Hz), the lowest; or a function of a case that returns a number
    value : what was measured, in SI units (frequencies in Hz), or a text with a unit; of a function, the unit's SI
        unit is that of its numbers
    uncertainty : its standard deviation, > 0
    at : values of parameters that differ from those of the fitted case, such as ``{"Omega": 12}``

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.Measurement("period", "14.8 ms", 1e-5, at={"Omega": 15}).value
    0.0148
    """

    quantity: str | Callable[[Parameters], float]
    value: float
    uncertainty: float
    at: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        faults: list[str] = []
        if not callable(self.quantity) and not self.unit:
            faults.append(Fault.of(("quantity",), self.quantity, unknown_quantity(self.quantity)))
        if faults:  # values of what is unknown mean nothing
            raise_faults(faults)
        value = _number(self.value, self._unit_of_value, "value", faults)
        uncertainty = _number(self.uncertainty, self._unit_of_value, "uncertainty", faults)
        named = isinstance(self.at, Mapping) and all(isinstance(name, str) for name in self.at)
        faults += violations(
            (not uncertainty <= 0, "uncertainty", uncertainty, "must be a standard deviation > 0"),
            (named, "at", self.at, "must give values by names of parameters"),
        )
        raise_faults(faults)
        # the class is frozen, and texts become numbers
        object.__setattr__(self, "value", value)
        object.__setattr__(self, "uncertainty", uncertainty)

    @property
    def name(self) -> str:
        """The quantity's name, and what was set."""
        settings = ", ".join(f"{key}={_short(value)}" for key, value in self.at.items())
        return f"{self.quantity_name} ({settings})" if settings else self.quantity_name

    @property
    def quantity_name(self) -> str:
        """The quantity's name; of a function, its own."""
        if isinstance(self.quantity, str):
            return self.quantity
        return getattr(self.quantity, "__name__", "quantity")

    @property
    def _unit_of_value(self) -> str:
        """Unit in which the value is read: of a quantity of one's own, the SI unit of its text."""
        return self.unit or si_unit_of(self.value) or si_unit_of(self.uncertainty)

    @property
    def unit(self) -> str:
        """Unit of the value; "" for a quantity of one's own."""
        return unit_of(self.quantity) if isinstance(self.quantity, str) else ""


def _number(value: object, unit: str, name: str, faults: list[str]) -> float:
    """Return a finite number in a unit; nan for anything else, which becomes a fault."""
    wrong: list[Fault] = []
    number = in_si(value, unit, wrong, (name,))
    if not wrong and not is_finite(number):
        rule = "must be a finite number"
        if isinstance(value, str) and unit:
            rule = f"must be a number with its unit, such as '3 {unit}'"
        wrong.append(Fault.of((name,), value, rule))
    faults += wrong
    return math.nan if wrong else float(number)


def is_finite(value: object) -> bool:
    """Return whether a value is a finite number."""
    return is_number(value) and math.isfinite(value)  # type: ignore[arg-type]


def _short(value: object) -> str:
    """Return a value for a name: a number with six digits."""
    return f"{value:.6g}" if is_number(value) else str(value)


def measurements_of(measured: object, faults: list[str]) -> tuple[Measurement, ...]:
    """Return what was measured as objects; wrong input becomes a fault."""
    if isinstance(measured, Mapping):
        found = []
        for name, pair in measured.items():
            if not (isinstance(pair, tuple | list) and len(pair) == 2):
                rule = "must be a value and its standard deviation"
                faults.append(Fault.of(("measured", str(name)), pair, rule))
                continue
            try:
                found.append(Measurement(name, *pair))
            except ParameterError as error:
                faults += [
                    fault.inside(("measured", str(name)))
                    for fault in error.faults
                    if isinstance(fault, Fault)
                ]
        return tuple(found)
    good = isinstance(measured, Sequence) and not isinstance(measured, str)
    if good and all(isinstance(each, Measurement) for each in measured):  # type: ignore[attr-defined]
        return tuple(measured)  # type: ignore[arg-type]
    rule = "must be values with standard deviations by quantity, a list of Measurement, or a pandas.DataFrame"
    faults.append(Fault.of(("measured",), measured, rule))
    return ()


LARGE = 0.1
"""Deviation in standard deviations from which its sign counts: below, it may be one of rounding."""
RARE = 0.01
"""Share of fits of the right model that have as few changes of sign, below which these are a pattern."""


class SignPattern(NamedTuple):
    """Changes of sign between neighbouring deviations, and the steps between these."""

    changes: int
    steps: int

    @property
    def chance(self) -> float:
        """Share of fits of the right model with so few changes of sign: errors that are independent
        change it at each step with even odds."""
        from scipy import stats

        return float(stats.binom.cdf(self.changes, self.steps, 0.5))

    @property
    def is_systematic(self) -> bool:
        """Whether scatter hardly ever changes signs so rarely."""
        return self.steps > 0 and self.chance < RARE


def sign_pattern(measurements: Sequence[Measurement], deviations: Array) -> SignPattern:
    """Return the changes of sign of the deviations of each quantity, in the order of what was set.

    Parameters
    ----------
    measurements : the measurements
    deviations : computed minus measured values, in standard deviations, (m,)
    """
    changes = 0
    steps = 0
    for signs in _signs_by_quantity(measurements, deviations):
        changes += sum(before != after for before, after in pairwise(signs))
        steps += len(signs) - 1
    return SignPattern(changes, steps)


def _signs_by_quantity(measurements: Sequence[Measurement], deviations: Array) -> list[list[bool]]:
    """Whether deviations are positive, for each quantity measured under several settings, in their order."""
    groups: dict[tuple[str, ...], list[tuple[tuple[float, ...], bool]]] = {}
    for each, deviation in zip(measurements, deviations.tolist(), strict=True):
        if abs(deviation) < LARGE or not _are_numbers(each):
            continue
        names = sorted(each.at)
        settings = tuple(float(each.at[name]) for name in names)
        group = groups.setdefault((each.quantity_name, *names), [])
        group.append((settings, deviation > 0))
    return [[sign for _, sign in sorted(group)] for group in groups.values()]


def _are_numbers(measurement: Measurement) -> bool:
    """Whether something was set, and all of it by numbers, which have an order."""
    return bool(measurement.at) and all(map(is_number, measurement.at.values()))
