"""`floquet`: a cycle of a case and its stability."""

from typing import Annotated

from pydantic import Field, InstanceOf

from disc_model.engine.jit.cache import compiling
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.cycle import (
    SLIPPING,
    STICK_SLIP,
    FloquetResult,
    Kind,
    find_cycle,
    require_single,
)
from disc_model.stability.slipping import find_slipping_cycle
from disc_model.units import Count, CycleTolerance, checked


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
    kind : "stick_slip"; or "slipping" for the smallest cycle round steady sliding, or near a given state in slip, that
        slips all the time, in contact

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
    if kind == SLIPPING:
        return find_slipping_cycle(case, tol, guess)
    return find_cycle(case, tol, guess, releases)
