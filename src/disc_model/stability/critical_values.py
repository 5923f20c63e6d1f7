"""Values of one parameter at which a motion gains or loses stability, as `critical` finds them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from disc_model.arrays import Array, EqualByValue, Mask
from disc_model.data.variables import (
    OF_RESULTS,
    attributes_of_number,
    unit_of_parameter,
    value_with_unit,
)
from disc_model.display import counted, drawings
from disc_model.parameters import Parameters
from disc_model.provenance import versions_text
from disc_model.stability.cycle import STICK_SLIP
from disc_model.stability.parameter_scan import SLIDING

MOTIONS = {STICK_SLIP: "motion near the static start", SLIDING: "steady sliding"}
"""Kinds of motion whose stability is followed, and what texts call them."""
UNSTABLE = {STICK_SLIP: "the stick-slip cycle", SLIDING: "steady sliding"}
"""What names of variables call the kinds of motion whose stability is followed."""
OF_PARAMETER = ("value", "border", "crossings", "values", "resolution")
"""Variables in the unit of the parameter."""
SAVED = ("value", "border", "crossings", "resolution")
"""Those of them in a dataset, along which the values are a coordinate."""


@dataclass(frozen=True, eq=False, repr=False)
class Critical(EqualByValue):
    """Values of a parameter at which a motion gains or loses stability: the one near the static
    start, or steady sliding.

    `to_dataset` makes a dataset, which `disc_model.save` writes.

    Attributes
    ----------
    parameters, name : the case, and the parameter
    value : the least value computed at which the motion is unstable, or no cycle is found and stick-slip goes on; if
        there is a lower one, it is stable there, less than `precision` away; nan if there is none. The lower bound,
        where that motion is unstable there already: it may be so below, too
    border : the value above which the motion stays unstable up to the upper bound, the last crossing; nan if it is
        stable there, or unstable at all values. Tongues of instability may lie below it
    at_lower_bound : whether `value` is the lower bound, so that it is only known to be there or below
    message : says so if `value` is the lower bound or nan, or where steady sliding is unstable instead of a cycle;
        else ""
    kind : the motion: "stick_slip", the cycle near the static start, or steady sliding or rest if there is no cycle;
        or "sliding", steady sliding
    crossings : shape (n,), all values at which stability was seen to change, ascending
    unstable_above : bool, (n,), whether that motion is unstable just above each
    values, growth_rate : shape (m,), the values computed, ascending, and growth rates of the cycle, or of steady
        sliding (1/s; nan without). Where steady sliding takes the place of a cycle, `sliding_growth_rate` has its own
    resolution : the largest step between neighbouring values computed. Narrower stretches of stability or of
        instability may be missed, though they are looked for where multipliers meet

    Examples
    --------
    The least unstable value may lie in a narrow tongue; from the border on, the motion stays unstable:

    >>> import disc_model as dm
    >>> light = dm.Parameters(N=385, Omega=15, mu_s=0.44, mu_k=0.24, m=0.1)
    >>> found = dm.critical(light, "Omega", (12, 22), points=9)
    >>> print(f"{found.value:.2f} and {found.border:.2f} rad/s")
    12.00 and 18.79 rad/s
    """

    parameters: Parameters
    name: str
    value: float
    crossings: Array
    unstable_above: Mask
    values: Array
    growth_rate: Array
    resolution: float
    kind: str = STICK_SLIP
    _sliding_growth_rate: Array = field(default_factory=lambda: np.zeros(0))

    def __repr__(self) -> str:
        unit = unit_of_parameter(self.name)
        found = self._without_loss or f"unstable from {self.value:.6g} {unit}".rstrip()
        first = "; ".join(filter(None, (found, self._in_sliding)))
        crossings = counted(len(self.crossings), "crossing")
        steps = f"{self.resolution:.2g} {unit}".rstrip()
        seen = f"{len(self.values)} values, steps of at most {steps}"
        return f"Critical({self.name}, {self.kind}: {first}, {crossings}, {seen})"

    @property
    def message(self) -> str:
        """Why `value` is no value at which the motion loses stability, in words; "" where it is one."""
        said = (self._without_loss, self._in_sliding)
        return "; ".join(filter(None, said))

    @property
    def sliding_growth_rate(self) -> Array:
        """Growth rates of steady sliding (1/s) at the `values` where it is the motion near the static start,
        as there is no cycle; nan elsewhere. With ``kind="sliding"``, all of them."""
        if self.kind == SLIDING:
            return self.growth_rate
        if not self._sliding_growth_rate.size:
            return np.full(self.values.shape, math.nan)
        return self._sliding_growth_rate

    @property
    def _in_sliding(self) -> str:
        """Between which values it is steady sliding that is unstable, as no cycle exists, in words; "" of a
        cycle."""
        places = self.values[self.sliding_growth_rate > 0]
        if self.kind == SLIDING or not places.size:
            return ""
        lowest, highest = (value_with_unit(self.name, each) for each in (places[0], places[-1]))
        said = "no cycle exists, and steady sliding is unstable"
        if places.size == 1:
            return f"at {lowest} {said}"
        return f"at values from {lowest} to {highest.partition(' = ')[2]} {said}"

    def to_dataset(self) -> xr.Dataset:
        """All values computed, and the crossings, as a dataset, to save, or to handle by xarray and pandas.

        Along the parameter, by its name: `growth_rate` and `sliding_growth_rate` (1/s). Along `crossing`:
        `crossings` and `unstable_above`. Alone: `value`, `border` and `resolution`. Attributes:
        `kind`, `message`, and the case's `parameters` in JSON.

        Examples
        --------
        >>> import disc_model as dm
        >>> found = dm.critical(dm.Parameters(N=385, Omega=12), "mu_s", (0.3, 0.42), points=7)
        >>> dm.save(found, "critical.nc")
        >>> dm.load("critical.nc")["growth_rate"].dims
        ('mu_s',)
        """
        return _dataset_of(self)

    @property
    def _without_loss(self) -> str:
        """Why stability is not lost at `value`, in words; "" where it is."""
        if math.isnan(self.value):
            computed = f"{len(self.values)} values computed {self._range_searched}"
            if self.kind == SLIDING:  # which may be neutral
                return f"steady sliding has no growing mode at any of the {computed}"
            message = f"{MOTIONS[self.kind]} is stable at all {computed}"
            return f"{message}; steady sliding is asked for by kind='sliding'"
        if not self.at_lower_bound:
            return ""
        return f"already unstable at the lower bound, {value_with_unit(self.name, self.value)}"

    @property
    def _range_searched(self) -> str:
        """The bounds of the search, in the unit of the parameter."""
        unit = unit_of_parameter(self.name)
        return f"from {self.values[0]:.6g} to {self.values[-1]:.6g} {unit}".rstrip()

    @property
    def at_lower_bound(self) -> bool:
        """Whether the motion is unstable at the lower bound already, which is the `value` then."""
        return bool(self.value == self.values[0])

    @property
    def border(self) -> float:
        """The value above which the motion stays unstable up to the upper bound; nan if it is stable
        there, or unstable at all values."""
        if len(self.crossings) and self.unstable_above[-1]:
            return float(self.crossings[-1])
        return math.nan

    @property
    def unstable(self) -> Array:
        """The intervals in which that motion is unstable, shape (n_intervals, 2). Another one may
        be stable there."""
        edges = np.array([self.values[0], *self.crossings, self.values[-1]])
        unstable_at_first = math.isfinite(self.value)
        if len(self.crossings):
            unstable_at_first = not self.unstable_above[0]
        grows = np.array([unstable_at_first, *self.unstable_above])
        return np.column_stack([edges[:-1], edges[1:]])[grows]

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the growth rate over the parameter, shaded where the motion is unstable, on axes or in a
        new figure; returns the axes. `look` is as in `FloquetResult.plot`."""
        return drawings().critical(ax, self, **look)


# ---- As a dataset


def attributes_of_critical(found: Critical) -> dict[str, dict[str, Any]]:
    """Attributes of critical values by name; those in the unit of the parameter name it, and say in the
    comment what it and the kind of motion are."""
    number = attributes_of_number(found.name)
    meant = {"parameter": number["long_name"], "motion": UNSTABLE[found.kind]}
    attributes = {name: known.texts() for name, known in OF_RESULTS["Critical"].items()}
    for name in OF_PARAMETER:
        own = attributes[name]
        own["units"] = number["units"]
        own["long_name"] = f"{own['long_name']} of {found.name}"
        own["comment"] = own["comment"].format(**meant)
    return attributes


def _dataset_of(found: Critical) -> xr.Dataset:
    """Critical values as a dataset, as `Critical.to_dataset` describes it."""
    described = attributes_of_critical(found)
    along = {"growth_rate": found.name, "sliding_growth_rate": found.name}
    variables: dict[str, xr.Variable] = {}
    for name in (*SAVED, *along, "unstable_above"):
        values = np.asarray(getattr(found, name))
        dims = (along.get(name, "crossing"),)[: values.ndim]
        variables[name] = xr.Variable(dims, values, described[name])
    attrs = {
        "kind": found.kind,
        "message": found.message,
        "name": found.name,
        "parameters": found.parameters.canonical_json,
        "versions": versions_text(),
    }
    along_name = xr.Variable(found.name, found.values, attributes_of_number(found.name))
    return xr.Dataset(variables, {found.name: along_name}, attrs)
