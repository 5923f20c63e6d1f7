"""`floquet`: cycles as fixed points of a return map, and their stability.

Two multipliers of the full system are left out: 1, along the orbit, and of stick-slip 0, of f,
because stick resets f to 0.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any, Final, Literal

import numpy as np
from pydantic import Field, InstanceOf
from scipy.optimize import brentq

from disc_model.arrays import Array, ComplexArray, EqualByValue
from disc_model.data.variables import CycleStatus, with_advice
from disc_model.disc.plate import mode_arrays
from disc_model.display import counted, drawings
from disc_model.engine.jit.cache import compiling
from disc_model.errors import DiscModelError, require
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.return_map import ENDS, Orbit, Passage, ReturnMap, SlippingMap, newton
from disc_model.stability.sliding import SteadySliding, split_rows, steady_sliding
from disc_model.units import Count, CycleTolerance, checked

STICK_SLIP: Final = "stick_slip"
SLIPPING: Final = "slipping"
Kind = Literal["stick_slip", "slipping"]
"""Kinds of cycles, by whether they stick."""
RETURNS_TRIED = (1, 2, 3)  # numbers of releases in a period of the cycles that are sought
SAME_POINT = 1e-7  # distance of two computations of one point, over its norm
# returns simulated before the search is tried again; the latter if the motion then nearly repeats
TRANSIENTS = (60, 300)
NEAR_REPEAT = (
    0.03  # distance after a return, over the static deflection, of a motion that nearly repeats
)
# of cycles in slip: distance from steady sliding at which the search begins, over the deflection, and
# the factor from one distance to the next
SMALLEST, FACTOR = 1e-3, 1.25
NEUTRAL = 1e-9  # growth in a return that may be rounding: without damping all motions return
PRECISION = 1e-6  # of the distance from which Newton's method begins, relative to it


class CycleError(DiscModelError):
    """No cycle was found; the message says what was found instead."""


@dataclass(frozen=True, eq=False)
class FloquetResult(EqualByValue):
    """A cycle of a case.

    Attributes
    ----------
    parameters, tol : as given to `floquet`
    status, message : result of the search; without a cycle numbers are nan, arrays empty and `state` None
    period : s
    multipliers : complex, shape (n,), largest modulus first; n = 4 per pair of modes + 2 per axisymmetric mode, plus 2
        on a compliant contact; a single 0 where that is none, as for a block on a rigid disc; one more of a cycle that
        slips all the time
    exponents : 1/s, complex, log(multipliers) / period
    growth_rate : 1/s, largest real part of the exponents
    stick_fraction : share of the period in stick
    stick_time, slip_time : s, durations of stick and of slip, means of the period's releases; a
        `slip_time` of nan where contact is lost
    state : on the section, at the end of stick; of a cycle that slips all the time, where the spring is longest
    releases, backward_releases, reversals, separations, sticks : numbers of these events in a period
    residual : residual of the return map, relative to the norm of the static deflection
    kind : "stick_slip", or "slipping" for a cycle that slips all the time
    sliding, sliding_growth_rate : steady sliding of the same case, and its growth rate, 1/s, nan without it; computed
        where they are asked for
    """

    parameters: Parameters
    tol: float
    status: CycleStatus
    message: str
    period: float = math.nan
    multipliers: ComplexArray = field(default_factory=lambda: np.zeros(0, complex))
    exponents: ComplexArray = field(default_factory=lambda: np.zeros(0, complex))
    growth_rate: float = math.nan
    stick_fraction: float = math.nan
    state: State | None = None
    releases: int = 0
    backward_releases: int = 0
    reversals: int = 0
    separations: int = 0
    sticks: int = 0
    residual: float = math.nan
    kind: str = STICK_SLIP

    def __repr__(self) -> str:
        p = self.parameters
        summary = self.message
        if self.status is CycleStatus.OK:
            numbers = f"growth rate {self.growth_rate:.6g} 1/s, period {self.period:.9g} s"
            summary = f"{numbers}, {len(self.multipliers)} multipliers"
        return f"FloquetResult(N={p.N:g} N, Omega={p.Omega:g} rad/s: {summary})"

    @cached_property
    def sliding(self) -> SteadySliding:
        """Steady sliding of the same case."""
        return steady_sliding(self.parameters)

    @property
    def sliding_growth_rate(self) -> float:
        """The growth rate of steady sliding of the same case, 1/s; nan without it."""
        return self.sliding.growth_rate

    @property
    def stable(self) -> bool:
        """Whether the cycle exists and small disturbances of it die out."""
        return bool(self.growth_rate < 0)

    @property
    def stick_time(self) -> float:
        """Duration of stick (s), the mean of the period's releases."""
        return self.stick_fraction * self.period / max(self.releases, 1)

    @property
    def slip_time(self) -> float:
        """Duration of slip (s), the mean of the period's releases; nan where contact is lost, since
        the slider does not slip then."""
        if self.separations:
            return math.nan
        return (1 - self.stick_fraction) * self.period / max(self.releases, 1)

    @property
    def motion(self) -> str:
        """What is near the start of the search: a cycle, "stable" or "unstable", "steady_sliding"
        or "unstable_sliding", or else the status."""
        if self.status is CycleStatus.OK:
            if self.stable:
                return "stable"
            return "unstable"
        if self.status is CycleStatus.NO_STICK_SLIP:
            if self.sliding.stable:
                return "steady_sliding"
            return "unstable_sliding"
        return self.status.value

    def raise_for_status(self) -> "FloquetResult":
        """Return self if a cycle was found; otherwise raise `CycleError`."""
        if self.status is not CycleStatus.OK:
            raise CycleError(with_advice(self.message, self.status))
        return self

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the multipliers in the complex plane, with the unit circle and rings around those that
        grow, on axes or in a new figure; returns the axes.

        A second picture on the same axes has the next colour; `look` has options of matplotlib, such
        as ``label="soft spring"``. Raises `CycleError` without a cycle.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.floquet(dm.Parameters(N=385, Omega=15)).plot().get_xlabel()
        'Re κ'
        """
        return drawings().multipliers(ax, self.raise_for_status(), **look)


@checked
@compiling()
def floquet(
    case: Parameters,
    *,
    tol: CycleTolerance = 1e-12,
    guess: InstanceOf[State] | None = None,
    releases: Annotated[Count, Field(ge=1)] = 1,
    kind: Kind = STICK_SLIP,
) -> FloquetResult:
    """Find the stick-slip cycle near the static start, or near a given state, and its multipliers.

    A case may also have a cycle that slips all the time, usually an unstable one, which separates
    the motions that come to stick-slip from those that come to steady sliding.

    Parameters
    ----------
    case : the case
    tol : relative tolerance of the series and of the return map's residual; 1e-14 to 1e-6
    guess : state, such as the last one of a simulation; the cycle is sought near the next release after it and may
        lose contact
    releases : number of releases in a period of the cycle near that state
    kind : "stick_slip"; or "slipping" for the smallest cycle round steady sliding that slips all the time, in contact

    Returns
    -------
    FloquetResult
        It is also returned if no cycle exists: `status` and `message` then say what was found instead. A stable cycle
        need not be that to which the motion from the static start comes, and near an unstable one there may be
        another: `outcome` follows the motion, and the last state of a simulation leads to its cycle as `guess`.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> cycle = dm.floquet(dm.Parameters(N=385, Omega=15))
    >>> cycle
    FloquetResult(N=385 N, Omega=15 rad/s: growth rate -0.105494 1/s, period 0.014821021 s, 18 multipliers)
    >>> cycle.stable
    True

    Where friction falls with the speed, stick-slip and steady sliding may both be stable:

    >>> block = dm.Parameters(n_diameters=-1, m=0.5, k=0, k_p=7e3, c_p=6, N=10, mu_s=0.6, mu_k=0.2,
    ...     friction_decay=10, r_0=0.1, Omega=2)
    >>> cycle = dm.floquet(block)
    >>> cycle.stable, cycle.sliding.stable
    (True, True)
    >>> between = dm.floquet(block, kind="slipping")
    >>> between.stable, between.multipliers.real.round(3)
    (False, array([1.262]))
    """
    require_single(guess, releases, kind)
    return find_cycle(case, tol, guess, releases, kind)


def require_single(guess: State | None, releases: int, kind: str) -> None:
    """Raise `ParameterError` if several releases are asked of a cycle that has one, or a cycle in slip
    is sought near a state."""
    require(
        (kind != SLIPPING or guess is None, "guess", guess, "must be None for a cycle in slip"),
        (
            releases == 1 or guess is not None,
            "releases",
            releases,
            "must be 1 without a state to look near",
        ),
    )


def find_cycle(
    p: Parameters,
    tol: float = 1e-12,
    guess: State | None = None,
    releases: int = 1,
    kind: str = STICK_SLIP,
) -> FloquetResult:
    """The cycle that Newton's method finds from the first release after the static start, or near the
    next one after the state `guess`, where it has `releases` releases, and may lose contact; or the
    one that slips all the time."""
    if kind == SLIPPING:
        return _slipping_cycle(p, tol)
    if not may_stick_and_slip(p):
        if never_pulls(p):
            return no_cycle(p, tol, CycleStatus.AT_REST, "the slider stays where it is on the disc")
        return no_cycle(
            p, tol, CycleStatus.NO_STICK_SLIP, "no friction holds the slider on the disc"
        )
    if guess is None:
        return cycle_from_rest(ReturnMap(p, tol))
    map_ = ReturnMap(p, tol, patient=True)
    release = map_.next_release(guess)
    if not release.reached:
        return _without_return(map_, release, "given state")
    solution = newton(map_, release.x, releases=releases)
    if solution is None:
        without = f"no cycle with {counted(releases, 'release')} near the given state"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, without)
    return cycle_of(map_, solution)


def cycle_from_rest(map_: ReturnMap) -> FloquetResult:
    """The cycle that Newton's method finds from the first release after the static start, or else
    after some returns of that motion; without one, the status is the kind of that motion."""
    p = map_.parameters
    tol = map_.tol
    start = map_.first_release
    x = map_.static
    if start.reached:
        x = start.x
    solution = newton(map_, x)
    if solution is not None:
        return cycle_of(map_, solution)
    if not start.reached:
        return _without_return(map_, start)
    followed = 0
    for transient in TRANSIENTS:
        for _ in range(transient - followed):
            orbit = map_.evaluate(x, tangent=False)
            if not orbit.returned:
                return _without_return(map_, Passage(orbit.outcome, orbit.period, orbit.end))
            x = orbit.end
        followed = transient
        for releases in RETURNS_TRIED:
            solution = newton(map_, x, releases=releases)
            if solution is not None:
                return cycle_of(map_, run_through_once(map_, solution))
        # one that comes slowly to a cycle is followed further
        points = map_.returns(x, RETURNS_TRIED[-1])
        if all(map_.apart(point, x) > NEAR_REPEAT for point in points):
            break
    sought = f"no cycle of up to {RETURNS_TRIED[-1]} releases was found near the static start"
    tried = f"{sought} or {followed} releases later, where stick-slip goes on"
    return no_cycle(p, tol, CycleStatus.NO_CYCLE, tried)


WITHOUT_RETURN = {
    "time_over": CycleStatus.NO_STICK_SLIP,
    "lost_contact": CycleStatus.SEPARATES,
    "off_section": CycleStatus.SEPARATES,
    "non_finite": CycleStatus.NON_FINITE,
    "stalled": CycleStatus.NO_CYCLE,
    "paradox": CycleStatus.PARADOX,
}
"""Status of a search by the end of a motion that does not return to the section."""


def _without_return(
    map_: ReturnMap, passage: Passage, start: str = "static start"
) -> FloquetResult:
    """The result for a motion from a start that does not come to the section."""
    end = ENDS[passage.outcome]
    reason = f"the motion from the {start} does not stick again: {end} after {passage.time:.3g} s"
    return no_cycle(map_.parameters, map_.tol, WITHOUT_RETURN[end], reason)


def _slipping_cycle(p: Parameters, tol: float) -> FloquetResult:
    """The smallest cycle round steady sliding that slips all the time."""
    reason = "there is no steady sliding on a spring"
    if min(p.N, p.k_p) > 0 and steady_sliding(p).status.exists:
        map_ = SlippingMap(p, tol)
        orbit = smallest_in_slip(map_)
        if orbit is not None:
            return cycle_of(map_, orbit, SLIPPING)
        reason = "no cycle round steady sliding slips all the time"
    return no_cycle(p, tol, CycleStatus.NO_CYCLE, reason, SLIPPING)


def smallest_in_slip(map_: SlippingMap) -> Orbit | None:
    """The smallest cycle that slips all the time, found along an oscillation of steady sliding, the
    least damped ones first; None if there is none.

    Motions at growing distances from steady sliding approach it or depart from it; a cycle is
    between two of which one grows, or stops, and one decays.
    """
    sliding = steady_sliding(map_.parameters)
    equilibrium = map_.point_of(sliding.rows)
    values, vectors = np.linalg.eig(sliding.jacobian)
    oscillating = np.flatnonzero(values.imag > 0)
    for i in oscillating[np.argsort(-values[oscillating].real, kind="stable")]:
        _, (_, rate), _ = split_rows(mode_arrays(map_.parameters), vectors[:, i])
        if rate == 0:  # the slider does not take part in it
            continue
        # the phase in which the slider is as fast as the drive, and becomes faster
        away = map_.point_of(np.real(vectors[:, i] * (-1j * np.conj(rate) / abs(rate))))
        away = away / np.linalg.norm(away)

        def growth(distance: float, away: Array = away) -> float:
            """The distance from the equilibrium after a return over that before, along the latter, less
            one; 1 if the motion does not return, 0 where only rounding grows."""
            orbit = map_.evaluate(equilibrium + distance * away, tangent=False)
            if not orbit.returned:
                return 1.0
            grown = float((orbit.end - equilibrium) @ away) / distance - 1
            return 0.0 if abs(grown) <= NEUTRAL else min(grown, 1.0)

        low = SMALLEST * map_.deflection
        before = growth(low)
        while before * (after := growth(FACTOR * low)) >= 0 and after < 1:
            low *= FACTOR
            before = after
        if before * after < 0:
            distance = brentq(growth, low, FACTOR * low, xtol=PRECISION * low)
            orbit = newton(map_, equilibrium + distance * away)
            if orbit is not None:
                return orbit
    return None


def run_through_once(map_: ReturnMap, orbit: Orbit) -> Orbit:
    """A cycle with its shortest period: one that is traversed several times is reduced to a single
    pass."""
    times = orbit.counts.releases
    x = orbit.start
    divisors = [n for n in range(1, times) if times % n == 0]
    for releases in divisors:
        once = newton(map_, x, releases=releases)
        if once is None:
            continue
        if np.linalg.norm(once.start - x) <= SAME_POINT * np.linalg.norm(x):
            return once
    return orbit


def may_stick_and_slip(p: Parameters) -> bool:
    """Whether the case has a drive, a preload, friction and an in-plane spring."""
    return min(p.Omega, p.N, p.mu_s, p.k_p) > 0


def never_pulls(p: Parameters) -> bool:
    """Whether a sticking slider never slips, because spring and damper cannot reach the limit of
    friction."""
    return p.Omega == 0 or (p.k_p == 0 and p.r_0 * p.c_p * p.Omega < p.mu_s * p.N)


def no_cycle(
    p: Parameters, tol: float, status: CycleStatus, reason: str, kind: str = STICK_SLIP
) -> FloquetResult:
    """The result of a search that has found no cycle of a kind."""
    return FloquetResult(p, tol, status, f"{status}: {reason}", kind=kind)


def cycle_of(map_: ReturnMap, orbit: Orbit, kind: str = STICK_SLIP) -> FloquetResult:
    """The result for a cycle of a kind that Newton's method has found to the tolerance."""
    values = multipliers(orbit.jacobian)
    leading = complex(values[0])
    growth_rate = -math.inf
    if leading:
        growth_rate = math.log(abs(leading)) / orbit.period
    with np.errstate(divide="ignore", invalid="ignore"):
        exponents = np.asarray(np.log(values) / orbit.period, dtype=complex)
    counts = orbit.counts
    releases = counted(counts.releases, "release")
    return FloquetResult(
        parameters=map_.parameters,
        tol=map_.tol,
        status=CycleStatus.OK,
        message=f"{CycleStatus.OK}: cycle of {orbit.period:.9g} s with {releases}",
        period=orbit.period,
        multipliers=values,
        exponents=exponents,
        growth_rate=growth_rate,
        stick_fraction=orbit.stick_time / orbit.period,
        state=map_.state(orbit.start),
        **counts._asdict(),
        residual=orbit.residual / map_.deflection,
        kind=kind,
    )


def multipliers(jacobian: Array) -> ComplexArray:
    """Eigenvalues of the return map's Jacobian, largest modulus first; positive imaginary parts
    first in each pair. A section of a single point, as that of a block on a rigid disc, has the
    multiplier 0: stick ends in one state, whatever the motion was before."""
    if not jacobian.size:
        return np.zeros(1, complex)
    values = np.linalg.eigvals(jacobian).astype(complex)
    moduli = np.round(np.abs(values), 14)
    return values[np.lexsort((-values.imag, -values.real, -moduli))]
