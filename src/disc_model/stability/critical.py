"""Values of one parameter at which the motion near the static start, or steady sliding, gains or loses
stability."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from pydantic import Field
from scipy.optimize import brentq

from disc_model.arrays import Array, EqualByValue, Mask
from disc_model.data.variables import (
    OF_RESULTS,
    STABLE_CYCLES,
    attributes,
    unit_of_parameter,
    value_with_unit,
)
from disc_model.display import Bar, counted, drawings, progress_bar
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
from disc_model.stability.cycle import STICK_SLIP, find_cycle
from disc_model.stability.sliding import steady_sliding
from disc_model.units import Count, CycleTolerance, checked

SLIDING = "sliding"
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
    """Values of a parameter at which a motion gains or loses stability: the one near the static
    start, or steady sliding.

    Attributes
    ----------
    parameters, name : the case, and the parameter
    value : the least value computed at which the motion is unstable, or no cycle is found and stick-slip goes on; nan
        if there is none. The lower bound, where that motion is unstable there already: it may be so below, too
    border : the value above which the motion stays unstable up to the upper bound, the last crossing; nan if it is
        stable there, or unstable at all values. Tongues of instability may lie below it
    at_lower_bound : whether `value` is the lower bound, so that it is only known to be there or below
    message : says so if `value` is the lower bound or nan; where steady sliding is unstable instead of a cycle; and
        where the cycle near the static start jumps to another one; else ""
    kind : the motion: "stick_slip", the cycle near the static start, or steady sliding or rest if there is no cycle;
        or "sliding", steady sliding
    crossings : shape (n,), all values at which stability was seen to change, ascending
    unstable_above : bool, (n,), whether that motion is unstable just above each
    jumps : those of the crossings at which the cycle near the static start becomes another one, whose period differs
    values, growth_rate : shape (m,), the values computed, ascending, and growth rates of the cycle, or of steady
        sliding (1/s; nan without). Where steady sliding takes the place of a cycle, `sliding_growth_rate` has its own
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
    crossings: Array
    unstable_above: Mask
    jumps: Array
    values: Array
    growth_rate: Array
    sliding_growth_rate: Array
    value: float
    kind: str = STICK_SLIP

    @property
    def resolution(self) -> float:
        return float(np.diff(self.values).max())

    @property
    def at_lower_bound(self) -> bool:
        return bool(self.value == self.values[0])

    @property
    def border(self) -> float:
        stays = len(self.crossings) and self.unstable_above[-1]
        if stays:
            return float(self.crossings[-1])
        return math.nan

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
        if math.isnan(self.value):
            of = "it is stable"
            if self.kind == SLIDING:
                of = "steady sliding has no growing mode"
            said.append(f"{of} at all {len(self.values)} values computed")
        elif self.at_lower_bound:
            at_bound = value_with_unit(self.name, self.value)
            said.append(f"already unstable at the lower bound, {at_bound}")
        slides = self.values[self.sliding_growth_rate > 0]
        if self.kind == STICK_SLIP and slides.size:
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
        return (
            f"Critical({self.name}, {self.kind}: {first}, {crossings}, {len(self.values)} values)"
        )

    def to_dataset(self) -> xr.Dataset:
        """All values computed, and the crossings, as a dataset, to save, or to handle by xarray and pandas.

        Along the parameter, by its name: `growth_rate` and `sliding_growth_rate` (1/s). Along `crossing`:
        `crossings` and `unstable_above`. Alone: `value`, `border`, `at_lower_bound` and `resolution`. Attributes:
        `kind`, `message`, and the case's `parameters` in JSON.

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
            "kind": self.kind,
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
    kind: Literal["stick_slip", "sliding"] = "stick_slip",
    progress: bool = False,
) -> Critical:
    """The least parameter value with unstable motion near the static start, and all stability
    changes above it; or those of steady sliding.

    The motion near the static start is the stick-slip cycle that `floquet` finds, or steady sliding
    or rest if there is no cycle. Beside a fold that search may find no cycle, or the unstable one,
    where a stable one exists: `continue_cycle` follows it to its fold, and `outcome` simulates the
    motion. Where no cycle is found and stick-slip goes on, the motion counts as unstable.

    It is computed at equal steps. Instability often lies in much narrower tongues, where multipliers meet
    on the unit circle: the branch of cycles is followed from each value to the next, and the places where
    its stability changes are computed as well. Of steady sliding nothing is computed between the
    values: growth in narrower windows is missed.

    Parameters
    ----------
    case : the case; its value of the parameter is not used
    name : one of `Parameters.numbers`, such as "mu_s"
    bounds : lowest and highest value; SI units, or texts with units
    points : number of evenly spaced values, which determines the `resolution`. With nine modes,
        the scan takes one or two seconds by default
    tol : as in `floquet`
    kind : "stick_slip" for the motion near the static start; "sliding" for steady sliding, which is unstable if a mode
        grows, and counts as unstable where it does not exist
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
    Critical(mu_s, stick_slip: 1 jump to another cycle, from 0.414... to 0.414..., 3 crossings, ... values)

    Steady sliding of a block on a rigid disc is unstable while friction falls too steeply with the speed:

    >>> block = dm.Parameters(n_diameters=-1, m=0.5, k=0, k_p=7e3, c_p=6, N=10, mu_s=0.6, mu_k=0.2,
    ...     friction_decay=10, r_0=0.1, Omega=2)
    >>> sliding = dm.critical(block, "c_p", (0.1, 6), points=11, kind="sliding")
    >>> sliding.crossings.round(2).tolist(), sliding.unstable_above.tolist()
    ([4.44], [False])
    """
    require_interval(case, name, bounds)
    low, high = bounds
    values = np.linspace(low, high, points).tolist()
    for value in values:
        case.replace(**{name: value})  # must be a case, which is found before any work is done
    with progress_bar("critical", None, progress) as bar:
        scan = Scan(case, name, tol, kind, bar)
        for value in values:
            scan.at(value)
        shortest = SHORTEST * (high - low)
        if kind != SLIDING:
            look_for_tongues(scan, values, shortest / 2)
        scan.locate(shortest)
        changes = [(above, scan.at(below)) for below, above in scan.changes()]
        jumps = [
            x for x, _ in changes if scan.jumps(max(x - shortest, low), min(x + shortest, high))
        ]
    known = sorted(scan.motions.items())
    return Critical(
        parameters=case,
        name=name,
        crossings=np.array([x for x, _ in changes]),
        unstable_above=np.array([below.stable for _, below in changes], dtype=bool),
        jumps=np.array(jumps),
        values=np.array([x for x, _ in known]),
        growth_rate=np.array([motion.growth_rate for _, motion in known]),
        sliding_growth_rate=np.array([motion.sliding_growth_rate for _, motion in known]),
        value=next((x for x, motion in known if not motion.stable), math.nan),
        kind=kind,
    )


class Motion(NamedTuple):
    """A motion: whether small disturbances die out, its growth rate, that of steady sliding if it is
    this motion (1/s, nan without one), and its period (s)."""

    stable: bool
    growth_rate: float
    sliding_growth_rate: float
    period: float


class Scan:
    """Motions by the value of one parameter, each computed once: cycles near the static start, as
    `find_cycle` finds them, or steady sliding."""

    def __init__(self, p: Parameters, name: str, tol: float, kind: str, bar: Bar) -> None:
        self.p = p
        self.name = name
        self.tol = tol
        self.kind = kind
        self.bar = bar
        self.motions: dict[float, Motion] = {}

    def at(self, x: float) -> Motion:
        """The motion at a value."""
        if x not in self.motions:
            self.motions[x] = self._motion(self.p.replace(**{self.name: x}))
            self.bar.advance()
        return self.motions[x]

    def _motion(self, case: Parameters) -> Motion:
        if self.kind == SLIDING:
            found = steady_sliding(case)
            stable = found.status.exists and not found.growing.size
            rate = found.growth_rate
            return Motion(stable, rate, rate, math.nan)
        cycle = find_cycle(case, self.tol)
        slides = cycle.motion in ("steady_sliding", "unstable_sliding")
        rate = math.nan
        if slides:
            rate = cycle.sliding_growth_rate
        stable = cycle.motion in STABLE_CYCLES
        return Motion(stable, cycle.growth_rate, rate, cycle.period)

    def jumps(self, low: float, high: float) -> bool:
        """Whether cycles at two values are none of one branch, by their periods."""
        return abs(self.at(high).period / self.at(low).period - 1) > JUMP

    def changes(self) -> list[tuple[float, float]]:
        """Neighbouring values between which stability changes."""
        pairs = pairwise(sorted(self.motions))
        return [pair for pair in pairs if self.at(pair[0]).stable != self.at(pair[1]).stable]

    def locate(self, shortest: float) -> None:
        """Compute values up to where each change of stability lies between two that are `shortest`
        apart."""

        def rate(x: float) -> float:
            """A number that has the sign of growth: its rate, 1/s; that of a motion without one, or
            of another stability than its own rate, is 1 or -1."""
            stable, own, *_ = self.at(x)
            if math.isfinite(own) and (own < 0) == stable:
                return own
            return 1.0 - 2.0 * stable

        wide = True
        while wide:
            wide = False
            for low, high in self.changes():
                if high - low > shortest * (1 + 1e-9) and low < 0.5 * (low + high) < high:
                    brentq(rate, low, high, xtol=shortest / 2, rtol=1e-15)
                    wide = True


def look_for_tongues(scan: Scan, values: Sequence[float], aside: float) -> None:
    """Compute further values on both sides of where the branch of cycles from one value to the next
    changes its stability."""
    for low, high in pairwise(values):
        try:
            problem, course = follow_between(scan.p, scan.name, low, high, scan.tol, LONGEST)
        except (ParameterError, Rejected):  # there is none, or it cannot be followed
            continue
        for entry in course.entries:
            if entry.kind in CHANGES:
                place = float(problem.values(entry.point.z)[0])
                scan.at(max(place - aside, low))
                scan.at(min(place + aside, high))
