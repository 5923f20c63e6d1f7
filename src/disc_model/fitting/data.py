"""A fit as a dataset: its parameters along `parameter`, its measurements along `measurement`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.data.missing import explained
from disc_model.data.variables import Variable, attributes, attributes_of_mode, unit_of_parameter
from disc_model.mode_units import column_of
from disc_model.parameters import RATIOS, Disc, Parameters
from disc_model.sources import versions_text
from disc_model.units import is_number

if TYPE_CHECKING:
    from disc_model.fitting.result import Fit

OF_PARAMETERS = {
    "unit": Variable("", "unit of the parameter"),
    "value": Variable("", "fitted value, in the unit of the parameter"),
    "deviation": Variable("", "standard deviation of the fitted value"),
    "low": Variable("", "low end of the confidence interval"),
    "high": Variable("", "high end of the confidence interval"),
    "at_bound": Variable("", "bound at which the parameter lies, or that no case can pass"),
    "passed_low": Variable("", "lower bound that the confidence interval passes"),
    "passed_high": Variable("", "upper bound that the confidence interval passes"),
    "limit": Variable("", "value that the parameter is below, or above, with the confidence"),
    "indistinct": Variable("1", "whether the measurements do not determine the parameter"),
    "gap": Variable("", "value in front of which the search has stopped"),
}
"""What is known of each parameter, in its own unit,"""
OF_PAIRS = {
    "covariance": Variable("", "covariance of two fitted values, in the product of their units"),
    "correlation": Variable("1", "correlation of two fitted values"),
}
"""of each two of them,"""
OF_MEASUREMENTS = {
    "quantity": Variable("", "measured quantity"),
    "measured_unit": Variable("", "unit of the measured quantity"),
    "measured": Variable("", "measured value, in the unit of the quantity"),
    "uncertainty": Variable("", "standard deviation of the measured value"),
    "predicted": Variable("", "value that the fitted case predicts"),
    "unstable": Variable(
        "1/s", "growth rate of the measured cycle in the fitted case, if above 0.01/s"
    ),
}
"""and of each measurement, in the unit of its quantity but for the growth rate."""
COORDINATES = {
    "parameter": Variable("", "fitted parameter"),
    "other_parameter": Variable("", "other fitted parameter"),
    "measurement": Variable("1", "number of the measurement"),
}


def dataset_of(fit: Fit) -> xr.Dataset:
    """A fit as a dataset, as `Fit.to_dataset` describes it."""
    names = list(fit.parameters)
    numbers = {
        "parameter": names,
        "other_parameter": names,
        "measurement": np.arange(len(fit.measurements)),
    }
    coordinates = {}
    for name, values in numbers.items():
        coordinates[name] = xr.Variable(name, values, COORDINATES[name].attributes)
    variables = {
        **_variables(OF_PARAMETERS, ("parameter",), _values_of_parameters(fit)),
        **_variables(OF_PAIRS, ("parameter", "other_parameter"), _values_of_pairs(fit)),
        **_variables(OF_MEASUREMENTS, ("measurement",), _values_of_measurements(fit)),
    }
    attrs: dict[str, Any] = {
        "chi_squared": fit.chi_squared,
        "freedom": fit.freedom,
        "confidence": fit.confidence,
        "converged": int(fit.converged),  # files have no True and False as attributes
        "message": fit.message,
        "doubt": fit.doubt,
        "note": fit.note,
        "case": fit.case.canonical_json,
        "versions": versions_text(),
    }
    data = xr.Dataset(variables, {**coordinates, **_settings(fit)}, attrs)
    return explained(data, "Fit")


def _variables(
    known: Mapping[str, Variable], dims: tuple[str, ...], values: Mapping[str, Any]
) -> dict[str, xr.Variable]:
    """Variables along some dimensions."""
    return {name: xr.Variable(dims, values[name], known[name].attributes) for name in known}


def _values_of_parameters(fit: Fit) -> dict[str, Sequence[Any]]:
    """What is known of each parameter."""
    names = list(fit.parameters)
    fitted = list(fit.parameters.values())
    gap = fit.gap.values if fit.gap else {}
    return {
        "unit": [unit_of_parameter(name) or "1" for name in names],
        "value": [each.value for each in fitted],
        "deviation": [each.deviation for each in fitted],
        "low": [each.low for each in fitted],
        "high": [each.high for each in fitted],
        "at_bound": [fit.at_bounds.get(name, math.nan) for name in names],
        "passed_low": [_passed(fit, name, below=True) for name in names],
        "passed_high": [_passed(fit, name, below=False) for name in names],
        "limit": [fit.limits.get(name, math.nan) for name in names],
        "indistinct": [name in fit.indistinct for name in names],
        "gap": [gap.get(name, math.nan) for name in names],
    }


def _passed(fit: Fit, name: str, *, below: bool) -> float:
    """The bound below or above the value of a parameter that its interval passes, nan if none."""
    for bound in fit.passed_bounds.get(name, ()):
        if (bound < fit.parameters[name].value) == below:
            return bound
    return math.nan


def _values_of_pairs(fit: Fit) -> dict[str, Any]:
    """What is known of each two parameters."""
    return {"covariance": fit.covariance, "correlation": fit.correlation}


def _values_of_measurements(fit: Fit) -> dict[str, Any]:
    """What is known of each measurement."""
    return {
        "quantity": [each.quantity_name for each in fit.measurements],
        "measured_unit": [each.unit for each in fit.measurements],
        "measured": [each.value for each in fit.measurements],
        "uncertainty": [each.uncertainty for each in fit.measurements],
        "predicted": fit.computed,
        "unstable": [fit.unstable.get(each.name, math.nan) for each in fit.measurements],
    }


def _settings(fit: Fit) -> dict[str, xr.Variable]:
    """What was set at some measurements, by its name: its value at each of them."""
    names: dict[str, None] = {}  # in the order in which they are given
    for each in fit.measurements:
        names.update(dict.fromkeys(each.at))
    cases = [fit.case.replace(**each.at) for each in fit.measurements]
    return {name: _setting(name, cases) for name in names}


def _setting(name: str, cases: Sequence[Parameters]) -> xr.Variable:
    """The value of a parameter of each of several cases."""
    attrs: dict[str, Any] = {"long_name": name}
    if name in (*Parameters.model_fields, *RATIOS):
        attrs = attributes(name)
    elif column_of(name):
        attrs = attributes_of_mode(name)
    values = [case.numbers.get(name, getattr(case, name, math.nan)) for case in cases]
    if not all(map(is_number, values)):
        values = [_word(value) for value in values]
    return xr.Variable("measurement", values, attrs)


def _word(value: object) -> str:
    """A value that is no number as text: discs in JSON."""
    if isinstance(value, Disc):
        return value.model_dump_json()
    return "" if value is None else str(value)
