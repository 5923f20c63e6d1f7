"""Values of one parameter at which the motion near the static start, or steady sliding, gains or loses
stability."""

import math
from collections.abc import Sequence

import numpy as np

from disc_model.display import progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.errors import Fault, raise_faults, violations, with_known_names
from disc_model.parameters import Parameters, Quantity, foreign_case
from disc_model.stability.continuation import free_faults, interval_in_si
from disc_model.stability.critical_values import MOTIONS, Critical
from disc_model.stability.cycle import SLIPPING, STICK_SLIP, FloquetResult
from disc_model.stability.parameter_scan import SLIDING, Scan, SlidingScan
from disc_model.stability.sliding import SteadySliding
from disc_model.units import CYCLE_TOLERANCES, is_number, is_whole, limits_faults

MOST_POINTS = 100_000  # largest number of values: an hour of work
SHORTEST = 1e-6  # of the range, to which crossings are bisected
NARROWEST = 1e-5  # of the range: between values closer than that no further ones are computed
SLIDING_MOTIONS = ("steady_sliding", "unstable_sliding")
RULE_OF_KIND = (
    f"must be {STICK_SLIP!r}, the motion near the static start, or {SLIDING!r}, steady sliding"
)


@compiling()
@with_known_names
def critical(
    case: Parameters,
    name: str,
    bounds: tuple[Quantity, Quantity],
    *,
    points: int = 201,
    precision: float | None = None,
    tol: float = 1e-12,
    kind: str = STICK_SLIP,
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
    these places are predicted from neighbouring values, and computed as well. Of steady sliding, the
    greatest growth rates between values are looked for.

    Parameters
    ----------
    case : the case; its value of the parameter is not used
    name : one of `Parameters.numbers`, such as "mu_s"
    bounds : lowest and highest value; SI units, or texts with units
    points : number of evenly spaced values, which determines the `resolution`. With nine modes,
        the scan takes one or two seconds by default
    precision : to which crossings are bisected; a millionth of the range if not given
    tol : as in `floquet`
    kind : "stick_slip" for the motion near the static start; "sliding" for steady sliding, which is unstable if a mode
        grows, and counts as unstable where it does not exist
    progress : whether a bar on standard error shows how many values are done; those between the `points` are added to
        their number as they are found to be needed

    Returns
    -------
    Critical
        `value`, `border`, `crossings`, and `resolution`, the largest step between values; a `message` where
        the motion is unstable at the lower bound already, or nowhere.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does at a value within the bounds.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=12)
    >>> dm.critical(case, "mu_s", (0.3, 0.42), points=7)
    Critical(mu_s, stick_slip: already unstable at the lower bound, mu_s = 0.3, 1 crossing, ... values, steps ...)

    Steady sliding of a block on a rigid disc is unstable while friction falls too steeply with the speed:

    >>> block = dm.Parameters(n_diameters=-1, m=0.5, k=0, k_p=7e3, c_p=6, N=10, mu_s=0.6, mu_k=0.2,
    ...     friction_decay=10, r_0=0.1, Omega=2)
    >>> sliding = dm.critical(block, "c_p", (0.1, 6), points=11, kind="sliding")
    >>> sliding.crossings.round(2).tolist(), sliding.unstable_above.tolist()
    ([4.44], [False])
    """
    of_bounds: list[Fault] = []
    ends = interval_in_si(name, bounds, of_bounds)
    counts = is_whole(points) and 2 <= points <= MOST_POINTS
    known = isinstance(kind, str) and kind in MOTIONS
    good = precision is None or (is_number(precision) and precision > 0)
    wrong = limits_faults("tol", tol, CYCLE_TOLERANCES) + violations(
        (
            ends is not None or bool(of_bounds),
            "bounds",
            bounds,
            "must be two ascending finite numbers",
        ),
        (counts, "points", points, f"must be a whole number from 2 to {MOST_POINTS}"),
        (good, "precision", precision, "must be a number > 0"),
        (known, "kind", kind, _rule_of_kind(kind)),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
    )
    raise_faults(foreign_case(case) or of_bounds + wrong + free_faults(case, [name]))
    low, high = ends
    values = np.linspace(low, high, points).tolist()
    for value in values:
        case.replace(**{name: value})  # must be a case, which is found before any work is done

    shortest = SHORTEST * (high - low)
    if precision is not None:
        shortest = float(precision)
    scan = Scan(case, name, float(tol))
    if kind == SLIDING:
        scan = SlidingScan(case, name, float(tol))
    _search(scan, values, shortest, progress)
    return _result(scan, kind, shortest)


def _search(scan: Scan, values: Sequence[float], shortest: float, progress: bool) -> None:
    """Compute ascending values, and further ones where stability may change in between; changes are located
    to an interval of length `shortest`."""
    narrowest = max(shortest, NARROWEST * (values[-1] - values[0]))
    with progress_bar("critical", len(values), progress) as bar:
        for value in values:
            scan.is_stable(value)
            bar.advance()
        scan.refine(narrowest, bar)
        if not isinstance(scan, SlidingScan):
            scan.located_changes(shortest)


def _rule_of_kind(kind: object) -> str:
    """The rule that an unknown kind of motion breaks, and what to call for one of `floquet`."""
    if isinstance(kind, str) and kind == SLIPPING:
        return f"{RULE_OF_KIND}; cycles that never stick are followed by continue_cycle(..., kind='slipping')"
    return RULE_OF_KIND


def _result(scan: Scan, kind: str, shortest: float) -> Critical:
    """What a scan has found, with changes of stability located to an interval of length
    `shortest`."""
    crossings, unstable_above = scan.located_changes(shortest)
    computed = sorted(scan.motions)
    first = next((value for value in computed if not scan.is_stable(value)), math.nan)
    return Critical(
        parameters=scan.p,
        name=scan.name,
        value=first,
        crossings=np.array(crossings),
        unstable_above=np.array(unstable_above, dtype=bool),
        values=np.array(computed),
        growth_rate=np.array([scan.motions[value].growth_rate for value in computed]),
        resolution=float(np.diff(computed).max()),
        kind=kind,
        _sliding_growth_rate=np.array(
            [_rate_of_sliding(scan.motions[value]) for value in computed]
        ),
    )


def _rate_of_sliding(motion: FloquetResult | SteadySliding) -> float:
    """The growth rate of steady sliding, 1/s, if this takes the place of a cycle; else nan."""
    if isinstance(motion, FloquetResult) and motion.motion in SLIDING_MOTIONS:
        return float(motion.sliding.growth_rate)
    return math.nan
