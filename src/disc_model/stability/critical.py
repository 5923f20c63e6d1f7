"""Values of one parameter at which the motion near the static start gains or loses stability."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.arrays import Array, EqualByValue, Indices, Mask
from disc_model.data.variables import (
    OF_RESULTS,
    STABLE_CYCLES,
    attributes,
    unit_of_parameter,
    value_with_unit,
)
from disc_model.display import counted, drawings, progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.provenance import versions_text
from disc_model.stability.continuation import (
    CHANGES,
    Bounds,
    Rejected,
    follow_between,
    require_interval,
)
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.units import Count, CycleTolerance, checked

DIMENSIONS: Mapping[str, tuple[str, ...]] = {
    "value": (),
    "border": (),
    "at_lower_bound": (),
    "resolution": (),
    "crossings": ("crossing",),
    "unstable_above": ("crossing",),
    "growth_rate": ("values",),
    "sliding_growth_rate": ("values",),
}
"""Variables of a dataset; "values" stands for the parameter."""
OF_PARAMETER = ("value", "border", "resolution", "crossings")
"""Those in the unit of the parameter."""
MOST_POINTS = 100_000  # largest number of values: an hour of work
SHORTEST = 1e-6  # of the range, to which crossings are located
LONGEST = 0.005  # arclength of a step of the branch between two values
# relative change of the period at a change of stability, of two cycles on no one branch
JUMP = 1e-4


@dataclass(frozen=True, eq=False, repr=False)
class Critical(EqualByValue):
    """Values of a parameter at which the motion near the static start gains or loses stability: its
    cycle, or steady sliding or rest if there is none.

    Attributes
    ----------
    parameters, name : the case, and the parameter
    values, stable : shape (m,), the values computed, ascending, and whether the motion is stable
    growth_rate, period : (m,), of the cycle, 1/s and s; nan without
    sliding_growth_rate : (m,), 1/s, of steady sliding where it takes the place of a cycle
    value : the least value computed at which the motion is unstable, or no cycle is found and stick-slip goes on; nan
        if there is none. The lower bound, where that motion is unstable there already: it may be so below, too
    border : the value above which the motion stays unstable up to the upper bound, the last crossing; nan if it is
        stable there, or unstable at all values. Tongues of instability may lie below it
    at_lower_bound : whether `value` is the lower bound, so that it is only known to be there or below
    message : says so if `value` is the lower bound or nan; where steady sliding is unstable instead of a cycle; and
        where the cycle near the static start jumps to another one; else ""
    crossings : shape (n,), all values at which stability was seen to change, ascending
    unstable_above : bool, (n,), whether that motion is unstable just above each
    jumps : those of the crossings at which the cycle near the static start becomes another one, whose period differs
    resolution : the largest step between neighbouring values computed. Narrower stretches of stability or of
        instability may be missed, though the branch of cycles is followed from each to the next

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
    values: Array
    stable: Mask
    growth_rate: Array
    sliding_growth_rate: Array
    period: Array

    @property
    def _changes(self) -> Indices:
        """Places in `values` just before the changes of stability."""
        return np.flatnonzero(self.stable[1:] != self.stable[:-1])

    @property
    def crossings(self) -> Array:
        return self.values[self._changes + 1]

    @property
    def unstable_above(self) -> Mask:
        return np.asarray(~self.stable[self._changes + 1])

    @property
    def jumps(self) -> Array:
        ratio = self.period[self._changes + 1] / self.period[self._changes]
        return self.crossings[np.abs(ratio - 1) > JUMP]

    @property
    def value(self) -> float:
        return float(next(iter(self.values[~self.stable]), math.nan))

    @property
    def resolution(self) -> float:
        return float(np.diff(self.values).max())

    @property
    def at_lower_bound(self) -> bool:
        return not self.stable[0]

    @property
    def border(self) -> float:
        if self.stable[-1] or not self.crossings.size:
            return math.nan
        return float(self.crossings[-1])

    @property
    def unstable(self) -> Array:
        """The intervals in which that motion is unstable, shape (n_intervals, 2). Another one may
        be stable there."""
        edges = np.array([self.values[0], *self.crossings, self.values[-1]])
        grows = np.array([self.at_lower_bound, *self.unstable_above])
        return np.column_stack([edges[:-1], edges[1:]])[grows]

    @property
    def message(self) -> str:
        said = []
        if self.stable.all():
            said.append(f"it is stable at all {len(self.values)} values computed")
        elif self.at_lower_bound:
            at_bound = value_with_unit(self.name, self.value)
            said.append(f"already unstable at the lower bound, {at_bound}")
        slides = self.values[self.sliding_growth_rate > 0]
        if slides.size:
            said.append(f"steady sliding is unstable, without a cycle, {self._from_to(slides)}")
        if self.jumps.size:
            jumps = counted(len(self.jumps), "jump")
            said.append(f"{jumps} to another cycle, {self._from_to(self.jumps)}")
        return "; ".join(said)

    def _from_to(self, values: Array) -> str:
        unit = unit_of_parameter(self.name)
        return f"from {values[0]:.6g} to {values[-1]:.6g} {unit}".rstrip()

    def __repr__(self) -> str:
        first = self.message or f"unstable from {value_with_unit(self.name, self.value)}"
        crossings = counted(len(self.crossings), "crossing")
        return f"Critical({self.name}: {first}, {crossings}, {len(self.values)} values)"

    def to_dataset(self) -> xr.Dataset:
        """All values computed, and the crossings, as a dataset, to save, or to handle by xarray and pandas.

        Along the parameter, by its name: `growth_rate` and `sliding_growth_rate` (1/s). Along `crossing`:
        `crossings` and `unstable_above`. Alone: `value`, `border`, `at_lower_bound` and `resolution`. Attributes:
        `message`, and the case's `parameters` in JSON.

        Examples
        --------
        >>> import disc_model as dm
        >>> found = dm.critical(dm.Parameters(N=385, Omega=12), "mu_s", (0.3, 0.42), points=7)
        >>> dm.save(found, "critical.nc")
        >>> dm.load("critical.nc")["growth_rate"].dims
        ('mu_s',)
        """
        along = attributes(self.name)
        variables = {}
        for name, dims in DIMENSIONS.items():
            attrs = OF_RESULTS["Critical"][name].texts()
            if name in OF_PARAMETER:
                attrs |= {
                    "units": along["units"],
                    "long_name": f"{attrs['long_name']} of {self.name}",
                }
            variables[name] = xr.Variable(dims, getattr(self, name), attrs)
        attrs = {
            "message": self.message,
            "name": self.name,
            "parameters": self.parameters.canonical_json,
            "versions": versions_text(),
        }
        data = xr.Dataset(variables, {"values": ("values", self.values, along)}, attrs)
        return data.rename(values=self.name)

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the growth rate over the parameter, shaded where the motion is unstable, on axes or in a
        new figure; returns the axes. `look` is as in `FloquetResult.plot`."""
        return drawings().critical(ax, self, **look)


@checked
@compiling()
def critical(
    case: Parameters,
    name: str,
    bounds: Bounds,
    *,
    points: Annotated[Count, Field(ge=2, le=MOST_POINTS)] = 201,
    tol: CycleTolerance = 1e-12,
    progress: bool = False,
) -> Critical:
    """The least parameter value with unstable motion near the static start, and all stability
    changes above it.

    The motion near the static start is the stick-slip cycle that `floquet` finds, or steady sliding
    or rest if there is no cycle. Beside a fold that search may find no cycle, or the unstable one,
    where a stable one exists: `continue_cycle` follows it to its fold, and `outcome` simulates the
    motion. Where no cycle is found and stick-slip goes on, the motion counts as unstable.

    It is computed at equal steps. Instability often lies in much narrower tongues, where multipliers meet
    on the unit circle: the branch of cycles is followed from each value to the next, and the places where
    its stability changes are computed as well. `squeal` has the values at which modes of steady sliding grow.

    Parameters
    ----------
    case : the case; its value of the parameter is not used
    name : one of `Parameters.numbers`, such as "mu_s"
    bounds : lowest and highest value; SI units, or texts with units
    points : number of evenly spaced values, which determines the `resolution`. With nine modes,
        the scan takes one or two seconds by default
    tol : as in `floquet`
    progress : whether a bar on standard error counts the values that are done

    Returns
    -------
    Critical
        `value`, `border`, `crossings`, and `resolution`, the largest step between values; a `message` where
        the motion is unstable at the lower bound already, or nowhere, or where the cycle jumps.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does at a value within the bounds.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=12)
    >>> dm.critical(case, "mu_s", (0.38, 0.42), points=5)
    Critical(mu_s: 1 jump to another cycle, from 0.414... to 0.414..., 3 crossings, ... values)
    """
    require_interval(case, name, bounds)
    low, high = bounds
    values = np.linspace(low, high, points).tolist()
    for value in values:
        case.replace(**{name: value})  # must be a case, which is found before any work is done
    cycles: dict[float, FloquetResult] = {}
    shortest = SHORTEST * (high - low)
    with progress_bar("critical", None, progress) as done:

        def look(value: float) -> None:
            if value not in cycles:
                cycles[value] = find_cycle(case.replace(**{name: value}), tol)
                done("critical")

        for value in values:
            look(value)
        for place in changes_between(case, name, values, tol):
            look(max(place - shortest / 2, low))
            look(min(place + shortest / 2, high))
        while middles := middles_of_changes(cycles, shortest * (1 + 1e-9)):
            for middle in middles:
                look(middle)
    known = [cycles[value] for value in sorted(cycles)]
    return Critical(
        case,
        name,
        values=np.array(sorted(cycles)),
        stable=np.array([_is_stable(cycle) for cycle in known]),
        growth_rate=np.array([cycle.growth_rate for cycle in known]),
        sliding_growth_rate=np.array([_rate_in_its_place(cycle) for cycle in known]),
        period=np.array([cycle.period for cycle in known]),
    )


def _is_stable(cycle: FloquetResult) -> bool:
    """Whether small disturbances of the motion near the static start die out."""
    return cycle.motion in STABLE_CYCLES


def _rate_in_its_place(cycle: FloquetResult) -> float:
    """The growth rate of steady sliding where it takes the place of a cycle, 1/s; else nan."""
    if cycle.motion in ("steady_sliding", "unstable_sliding"):
        return cycle.sliding_growth_rate
    return math.nan


def middles_of_changes(cycles: Mapping[float, FloquetResult], shortest: float) -> list[float]:
    """The middles of neighbouring values between which stability changes, unless they are the
    `shortest` step apart."""
    changes = [
        (low, high)
        for low, high in pairwise(sorted(cycles))
        if _is_stable(cycles[low]) != _is_stable(cycles[high])
    ]
    middles = [(0.5 * (low + high), low, high) for low, high in changes if high - low > shortest]
    return [middle for middle, low, high in middles if low < middle < high]


def changes_between(
    case: Parameters, name: str, values: Sequence[float], tol: float
) -> Iterator[float]:
    """Yield where the branch of cycles from one value to the next changes its stability."""
    for low, high in pairwise(values):
        try:
            problem, course = follow_between(case, name, low, high, tol, LONGEST)
        except (ParameterError, Rejected):  # there is none, or it cannot be followed
            continue
        for entry in course.entries:
            if entry.kind in CHANGES:
                yield float(problem.values(entry.point.z)[0])
