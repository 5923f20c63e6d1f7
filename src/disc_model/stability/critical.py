"""Values of one parameter at which the motion near the static start, or steady sliding, gains or loses
stability."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from pydantic import Field
from scipy.optimize import brentq, linear_sum_assignment

from disc_model.arrays import Array, ComplexArray, EqualByValue, Mask
from disc_model.data.variables import (
    OF_RESULTS,
    STABLE_CYCLES,
    attributes,
    unit_of_parameter,
    value_with_unit,
)
from disc_model.display import Bar, counted, drawings, progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.parameters import Parameters
from disc_model.provenance import versions_text
from disc_model.stability.continuation import Bounds, are_slow, passings, require_interval, turns_of
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
NARROWEST = 1e-5  # of the range: between values closer than that no further ones are computed
ROUNDS = 8  # times that places of suspected instability are predicted anew
# rad, of a multiplier from one value to the next: beyond, it may be taken for another
LONGEST_TURN = 0.3
# the angles of a pair at two values, from the real axis, over the longest turn of any multiplier:
# up to this, the pair may have met the axis in between, and have left it again on the same side
MAY_HAVE_MET = 1.5
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
        return float(self.crossings[-1]) if stays else math.nan

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
            of = "steady sliding has no growing mode" if self.kind == SLIDING else "it is stable"
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

    It is computed at equal steps, between which a window may be missed. Instability often lies in much
    narrower tongues, where multipliers meet on the unit circle. Their angles change smoothly, so that
    these places are predicted from neighbouring values, and computed as well. Of steady sliding
    nothing is computed between the values: growth in narrower windows is missed.

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
        if kind != SLIDING:
            look_for_tongues(scan, NARROWEST * (high - low))
        shortest = SHORTEST * (high - low)
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
    this motion (1/s, nan without one), its period (s), and its multipliers or eigenvalues."""

    stable: bool
    growth_rate: float
    sliding_growth_rate: float
    period: float
    spectrum: ComplexArray


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
            return Motion(stable, rate, rate, math.nan, found.eigenvalues)
        cycle = find_cycle(case, self.tol)
        slides = cycle.motion in ("steady_sliding", "unstable_sliding")
        rate = cycle.sliding_growth_rate if slides else math.nan
        stable = cycle.motion in STABLE_CYCLES
        return Motion(stable, cycle.growth_rate, rate, cycle.period, cycle.multipliers)

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
            return own if math.isfinite(own) and (own < 0) == stable else 1.0 - 2.0 * stable

        wide = True
        while wide:
            wide = False
            for low, high in self.changes():
                if high - low > shortest * (1 + 1e-9) and low < 0.5 * (low + high) < high:
                    brentq(rate, low, high, xtol=shortest / 2, rtol=1e-15)
                    wide = True


def look_for_tongues(scan: Scan, narrowest: float) -> None:
    """Compute further values where the cycles beside them leave a change of stability in doubt, none
    closer than `narrowest` to another one."""
    examined = set[tuple[float, float]]()
    for _ in range(ROUNDS):
        gaps = set(pairwise(sorted(scan.motions))) - examined
        examined |= gaps
        for low, high in sorted(gaps):
            for share in _doubtful_shares(scan.at(low).spectrum, scan.at(high).spectrum):
                if min(share, 1 - share) * (high - low) > narrowest:
                    scan.at(low + share * (high - low))


def _doubtful_shares(first: ComplexArray, second: ComplexArray) -> list[float]:
    """Shares of the way from one cycle to another at which stability may change, or the cycle
    end, by their multipliers."""
    if not (len(first) and len(second)):
        return [0.5] if len(first) != len(second) else []
    rows, columns = linear_sum_assignment(np.abs(first[:, None] - second[None, :]))
    before, after = first[rows], second[columns]
    between = turns_of(before, after)
    shares = {each.share for each in passings(between) if 0 < each.share < 1}
    longest = float(np.abs(between.turns).max(initial=0))
    # a pair that passes through the real axis looks like one that has turned back
    angles = np.array([between.angles, between.angles + between.turns])
    for ends in (angles, math.pi - angles):
        way = ends.sum(axis=0)
        may_have_met = (ends > 0).all(axis=0) & (way <= MAY_HAVE_MET * longest)
        shares.update((ends[0][may_have_met] / way[may_have_met]).tolist())
    slow = are_slow(before, after)
    on_axis = [np.sum(slow & (each.imag == 0)) for each in (before, after)]
    if longest > LONGEST_TURN or on_axis[0] != on_axis[1]:
        shares.add(0.5)
    return sorted(shares)
