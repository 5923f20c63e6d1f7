"""What is asked of a continuation: the free parameter and its bounds."""

from typing import Annotated, Any

from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.parameters import Parameters
from disc_model.units import Finite, Unit

UNSET = ("damping_ratio",)  # numbers that are None in a case without them
CHANGES = ("fold", "period_doubling", "neimark_sacker")
"""Kinds of special points that are located to rounding, and at which a multiplier crosses the unit
circle."""
Bounds = Annotated[tuple[Finite, Finite], Unit(of="name")]
"""Two values of the parameter `name`."""


def require_interval(case: Parameters, name: Any, bounds: tuple[float, float]) -> None:
    """Raise `ParameterError` unless the name is that of a number of a case that may change, and the
    bounds ascend."""
    known = case.numbers
    if name not in known:
        rule = f"must be a number of the case{suggestion(name, known)}"
        if name in UNSET or isinstance(getattr(case, name, None), float):
            rule = "does not act in this case; give the case a value with which it does first"
        raise ParameterError(Fault.of(("name",), name, rule))
    require((bounds[0] < bounds[1], "bounds", bounds, "must be two ascending numbers"))
