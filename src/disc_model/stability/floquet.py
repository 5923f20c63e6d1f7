"""`floquet`: a cycle of a case and its stability."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.engine.jit.cache import compiling
from disc_model.errors import raise_faults, with_known_names
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.states import State
from disc_model.stability.cycle import (
    SAME_POINT,
    SLIPPING,
    STICK_SLIP,
    FloquetResult,
    cycle_from_rest,
    cycle_of,
    find_cycle,
    guess_faults,
    may_stick_and_slip,
)
from disc_model.stability.return_map import Orbit, ReturnMap, newton
from disc_model.stability.sliding import check_modes
from disc_model.stability.slipping_cycle import find_slipping_cycle
from disc_model.units import CYCLE_TOLERANCES, limits_faults

SETTLED = 300
"""Releases after which the motion from the static start is compared with an unstable cycle that was found near
it: after fewer it may still be on its way."""
GROWTH = 37.0
"""Growth rate times the time of these releases, beyond which even a difference by rounding, 1e-16, would have
taken a motion away from the cycle."""


class Search(NamedTuple):
    """What a search near the static start has found, and the return map that it used; None of a case that
    cannot stick and slip."""

    cycle: FloquetResult
    map: ReturnMap | None


@compiling()
@with_known_names
def floquet(
    case: Parameters,
    *,
    tol: float = 1e-12,
    guess: State | None = None,
    releases: int = 1,
    kind: str = STICK_SLIP,
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
    kind : "stick_slip"; or "slipping" for the smallest cycle round steady sliding, or near a given state in slip, that
        slips all the time, in contact

    Returns
    -------
    FloquetResult
        It is also returned if no cycle exists: `status` and `message` then say what was found instead. A stable cycle
        need not be that to which the motion from the static start comes: `outcome` follows the motion. Where the cycle
        is unstable, and the motion from the static start is elsewhere in contact after 300 releases, `message` says so,
        and `near_motion` is False. If it is near another cycle, `other_growth_rate` is that of the other: the last
        state of a simulation leads to it as `guess`.

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
    >>> cycle.stable, cycle.attractors
    (True, ('stick_slip',))

    Where friction falls with the speed, stick-slip and steady sliding may both be stable:

    >>> block = dm.Parameters(n_diameters=-1, m=0.5, k=0, k_p=7e3, c_p=6, N=10, mu_s=0.6, mu_k=0.2,
    ...     friction_decay=10, r_0=0.1, Omega=2)
    >>> dm.floquet(block).attractors
    ('stick_slip', 'steady_sliding')
    >>> between = dm.floquet(block, kind="slipping")
    >>> between.stable, between.multipliers.real.round(3)
    (False, array([1.262]))
    """
    wrong = limits_faults("tol", tol, CYCLE_TOLERANCES) + guess_faults(guess, releases, kind)
    raise_faults(foreign_case(case) + wrong)
    check_modes(case)
    if kind == SLIPPING:
        return find_slipping_cycle(case, float(tol), guess)
    if guess is None:
        return cycle_near_start(case, float(tol))
    return find_cycle(case, float(tol), guess, releases)


def cycle_near_start(case: Parameters, tol: float) -> FloquetResult:
    """The cycle near the static start, and whether the motion from there is near it."""
    return search_near_start(case, tol).cycle


def search_near_start(case: Parameters, tol: float) -> Search:
    """The search for the cycle near the static start, which is compared with the motion from there."""
    if not may_stick_and_slip(case):
        return Search(find_cycle(case, tol), None)
    map_ = ReturnMap(case, tol)
    return Search(beside_motion(cycle_from_rest(map_), map_), map_)


def beside_motion(cycle: FloquetResult, map_: ReturnMap | None = None) -> FloquetResult:
    """The result of the search near the static start. The message of an unstable cycle says so if the
    motion from there is near another one, or cannot be near this one any more.

    map_ : the return map of its case, if there is one already
    """
    if cycle.state is None or cycle.stable or cycle.releases > 1:
        return cycle
    if map_ is None:
        map_ = ReturnMap(cycle.parameters, cycle.tol)
    start = map_.first_release
    near = replace(cycle, near_motion=True)
    if not start.reached:
        return near
    motion = map_.evaluate(start.x, releases=SETTLED, tangent=False)
    if not motion.returned:
        return near

    own = map_.point(cycle.state)
    if np.linalg.norm(motion.end - own) <= SAME_POINT * np.linalg.norm(own):
        return near
    other = newton(map_, motion.end)
    rate = math.nan
    where = "not near it"
    if other is not None and _is_other(other, motion, own):
        rate = cycle_of(map_, other).growth_rate
        where = f"near another cycle, with growth rate {rate:.6g} 1/s"
    elif cycle.growth_rate * motion.period < GROWTH:
        return near
    message = (
        f"{cycle.message}; after {SETTLED} releases the motion from the static start is {where}"
    )
    return replace(cycle, message=message, near_motion=False, other_growth_rate=rate)


def _is_other(other: Orbit, motion: Orbit, own: Array) -> bool:
    """Whether a cycle is another than that of the point `own`, and nearer to a motion's end."""
    apart = np.linalg.norm(other.start - own) > SAME_POINT * np.linalg.norm(own)
    nearer = np.linalg.norm(other.start - motion.end) < np.linalg.norm(motion.end - own)
    return bool(apart and nearer)
