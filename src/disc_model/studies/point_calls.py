"""Calls in Python that compute a point of a study, for pages: what stands round the point's case."""

import inspect
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from disc_model.studies.functions import critical_speed, hysteresis
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantities.stability_curves import StabilityCurves
from disc_model.studies.quantity import Quantity

SEARCHES: Mapping[str, Callable[..., Any]] = {
    "critical_speed": critical_speed,
    "hysteresis": hysteresis,
}
"""Functions of quantities that vary the speed by themselves."""


class Call(NamedTuple):
    """A call in Python, in parts.

    Attributes
    ----------
    before, after : texts round the case; empty if the case is all
    begins : parameters of the case that the quantity varies by itself, each where its range begins
    """

    before: str
    after: str
    begins: Mapping[str, float]


def call_of(name: str, quantity: Quantity) -> Call:
    """The call for a point of a study of a quantity.

    Parameters
    ----------
    name : of the quantity
    quantity : with its options
    """
    begins = range_begins(quantity)
    if name not in SEARCHES:
        return Call("", "", begins)
    arguments = _arguments(SEARCHES[name], quantity)
    return Call(f"dm.{name}(", f", {', '.join(arguments)})", begins)


def range_begins(quantity: Quantity) -> dict[str, float]:
    """The least value of each parameter that a quantity varies by itself."""
    match quantity:
        case Ramps():
            return {"Omega": quantity.low}
        case StabilityCurves():
            return {quantity.x: quantity.x_range[0], quantity.y: quantity.y_lines.start}
    if not quantity.scanned:
        return {}
    scanning: Any = quantity
    return dict.fromkeys(quantity.scanned, scanning.scan.start)


def _arguments(function: Callable[..., Any], quantity: Any) -> list[str]:
    """The arguments of a function, after the case, that differ from its defaults, in Python."""
    scan = quantity.scan
    values = {
        **quantity.model_dump(),
        "bounds": (scan.start, scan.stop),
        "step": (scan.stop - scan.start) / scan.intervals,
    }
    if "horizons" in values:
        values["horizon"] = list(values["horizons"])
    _, *parameters = inspect.signature(function).parameters.values()
    arguments = []
    for parameter in parameters:
        if parameter.name not in values:  # such as the bar of its progress
            continue
        value = values[parameter.name]
        if value not in (parameter.default, [parameter.default]):
            arguments.append(f"{parameter.name}={value!r}")
    return arguments
