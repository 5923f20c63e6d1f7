"""Values of one parameter at which the motion near the static start gains or loses stability."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import linear_sum_assignment

from disc_model.arrays import Array, ComplexArray, Mask
from disc_model.data.variables import STABLE_CYCLES
from disc_model.display import Drawn, counted, html_table
from disc_model.engine.jit.cache import compiling
from disc_model.errors import raise_faults, violations
from disc_model.parameters import Parameters, Quantity, foreign_case
from disc_model.stability.continuation import free_faults, interval_in_si, spectrum
from disc_model.stability.continuation.problem import value_text
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.units import CYCLE_TOLERANCES, is_number, is_whole, limits_faults

MOST_POINTS = 100_000  # largest number of values: an hour of work
# times that places of suspected instability are predicted anew, from the cycles beside them
ROUNDS = 8
SHORTEST = 1e-6  # of the range, to which crossings are bisected
NARROWEST = 1e-5  # of the range: between values closer than that no further ones are computed
# rad, by which a multiplier may turn from one value to the next; beyond, multipliers cannot be told
# apart by their distances
LONGEST_TURN = 0.3
# the angles of a pair at two values, from the real axis, over the longest turn of any multiplier:
# up to this, the pair may have met the axis in between, and have left it again on the same side
MAY_HAVE_MET = 1.5
# exponents of distances by which multipliers are matched. One that passes another moves as far, in
# sum, as two that follow each other: the first exponent does not tell them apart, the second one
# takes them to have passed
MATCHES = (1.0, 0.5)


@dataclass(frozen=True, eq=False, repr=False)
class Critical(Drawn):
    """Values of a parameter at which the motion near the static start gains or loses stability.

    `plot` draws the growth rate of the cycle over the parameter, with the intervals in which that
    motion is unstable.

    Attributes
    ----------
    parameters, name : the case, and the parameter
    value : the least value computed at which the motion near the static start is unstable; if there is a lower one,
        it is stable there, less than `precision` away; nan if there is none. The lower bound, where that motion is
        unstable there already: it may be so below, too
    message : says so if `value` is the lower bound or nan; else ""
    crossings : shape (n,), all values at which stability was seen to change, ascending
    unstable_above : bool, (n,), whether that motion is unstable just above each
    values, growth_rate : shape (m,), the values computed, ascending, and growth rates of the cycle (1/s; nan without)
    resolution : the largest step between neighbouring values computed. No stretch of stability or
        of instability that is wider has been overlooked. Most narrower ones are seen, because they
        are looked for where multipliers meet
    """

    _picture = "plot_critical"
    parameters: Parameters
    name: str
    value: float
    crossings: Array
    unstable_above: Mask
    values: Array
    growth_rate: Array
    resolution: float

    def __repr__(self) -> str:
        first = self.message or f"unstable from {self.value:.6g}"
        crossings = counted(len(self.crossings), "crossing")
        seen = f"{len(self.values)} values, steps of at most {self.resolution:.2g}"
        return f"Critical({self.name}: {first}, {crossings}, {seen})"

    def _repr_html_(self) -> str:
        """The intervals of one stability in a notebook, and what may have been overlooked."""
        unit = self.parameters.unit(self.name).removeprefix("1")
        edges = [float(self.values[0]), *self.crossings.tolist(), float(self.values[-1])]
        unstable = {float(low) for low, _ in self.unstable}
        rows = []
        for low, high in pairwise(edges):
            stability = "unstable" if low in unstable else "stable"
            rows.append((f"{low:.9g}", f"{high:.9g}", stability))
        if self.message:
            rows.append((self.message, "", ""))
        rows.append(("tongues overlooked", f"below {self.resolution:.2g} {unit}".strip(), ""))
        upper = f"to ({unit})" if unit else "to"
        return html_table((f"{self.name} from", upper, "motion near the static start"), rows)

    @property
    def message(self) -> str:
        """Why `value` is no value at which stability is lost, in words; "" where it is one."""
        if math.isnan(self.value):
            return f"stable at all {len(self.values)} values computed"
        if self.value > self.values[0]:
            return ""
        return f"already unstable at the lower bound, {value_text(self.name, self.value)}"

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


@compiling()
def critical(
    case: Parameters,
    name: str,
    bounds: tuple[Quantity, Quantity],
    *,
    points: int = 201,
    precision: float | None = None,
    tol: float = 1e-12,
) -> Critical:
    """The least parameter value with unstable motion near the static start, and all stability
    changes above it.

    That motion is the stick-slip cycle, or steady sliding or rest if there is no cycle. It is
    computed at equal steps, which alone limit what can be overlooked. Instability often lies in
    much narrower tongues, where multipliers meet on the unit circle. Their angles change smoothly,
    so that these places are predicted from neighbouring values, and computed as well.

    Parameters
    ----------
    case : the case; its value of the parameter is not used
    name : one of `Parameters.numbers`, such as "mu_s"
    bounds : lowest and highest value; SI units, or texts with units
    points : number of evenly spaced values, which determines the `resolution`. With nine modes,
        the scan takes one or two seconds by default
    precision : to which crossings are bisected; a millionth of the range if not given
    tol : as in `floquet`

    Returns
    -------
    Critical
        `value`, `crossings`, and `resolution`, beyond which nothing can have been overlooked; a
        `message` where the motion is unstable at the lower bound already, or nowhere.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does at a value within the bounds.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=12, mu_k_over_mu_s=0.6)
    >>> dm.critical(case, "mu_s", (0.3, 0.42), points=7)
    Critical(mu_s: already unstable at the lower bound, mu_s = 0.3, 1 crossing, ... values, steps of at most ...)
    """
    ends = interval_in_si(name, bounds)
    counts = is_whole(points) and 2 <= points <= MOST_POINTS
    good = precision is None or (is_number(precision) and precision > 0)
    wrong = limits_faults("tol", tol, CYCLE_TOLERANCES) + violations(
        (ends is not None, "bounds", bounds, "must be two ascending finite numbers"),
        (counts, "points", points, f"must be a whole number from 2 to {MOST_POINTS}"),
        (good, "precision", precision, "must be a number > 0"),
    )
    raise_faults(foreign_case(case) or wrong + free_faults(case, [name]))
    low, high = ends
    values = np.linspace(low, high, points).tolist()
    for value in values:
        case.replace(**{name: value})  # must be a case, which is found before any work is done

    shortest = SHORTEST * (high - low)
    if precision is not None:
        shortest = float(precision)
    scan = _Scan(case, name, float(tol))
    for value in values:
        scan.is_stable(value)
    scan.refine(max(shortest, NARROWEST * (high - low)))
    return scan.located_changes(shortest)


class _Scan:
    """Cycles of a case by the value of one parameter, each computed once."""

    def __init__(self, p: Parameters, name: str, tol: float) -> None:
        self.p = p
        self.name = name
        self.tol = tol
        self.cycles: dict[float, FloquetResult] = {}

    def is_stable(self, x: float) -> bool:
        """Whether the motion near the static start is stable at a value, whose cycle is then
        known."""
        if x not in self.cycles:
            self.cycles[x] = find_cycle(self.p.replace(**{self.name: x}), self.tol)
        return self.cycles[x].motion in STABLE_CYCLES

    def refine(self, narrowest: float) -> None:
        """Compute further values where the cycles beside them leave a change of stability in doubt,
        none closer than `narrowest` to another one."""
        examined = set[tuple[float, float]]()
        for _ in range(ROUNDS):
            gaps = set(pairwise(sorted(self.cycles))) - examined
            examined |= gaps
            for low, high in sorted(gaps):
                length = high - low
                for share in _doubtful_shares(self.cycles[low], self.cycles[high]):
                    if min(share, 1 - share) * length > narrowest:
                        self.is_stable(low + share * length)

    def located_changes(self, shortest: float) -> Critical:
        """The result, with changes of stability located to an interval of length `shortest`."""
        crossings = list[float]()
        unstable_above = list[bool]()
        for low, high in list(pairwise(sorted(self.cycles))):
            stable_below = self.is_stable(low)
            if stable_below != self.is_stable(high):
                crossings.append(self._bisect(low, high, shortest))
                unstable_above.append(stable_below)
        computed = sorted(self.cycles)
        first = next((value for value in computed if not self.is_stable(value)), math.nan)
        return Critical(
            parameters=self.p,
            name=self.name,
            value=first,
            crossings=np.array(crossings),
            unstable_above=np.array(unstable_above, dtype=bool),
            values=np.array(computed),
            growth_rate=np.array([self.cycles[value].growth_rate for value in computed]),
            resolution=float(np.diff(computed).max()),
        )

    def _bisect(self, low: float, high: float, shortest: float) -> float:
        """The upper end of a short interval within a longer one, at whose ends stability
        differs."""
        stable_below = self.is_stable(low)
        while high - low > shortest:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            if self.is_stable(middle) == stable_below:
                low = middle
            else:
                high = middle
        return high


def _doubtful_shares(first: FloquetResult, second: FloquetResult) -> list[float]:
    """Shares of the way from one cycle to another at which stability may change, or the cycle
    end."""
    ends_between = len(first.multipliers) != len(second.multipliers)
    if not (len(first.multipliers) and len(second.multipliers)):
        return [0.5] if ends_between else []
    shares = set[float]()
    for exponent in MATCHES:
        before, after = _matched(first.multipliers, second.multipliers, exponent)
        shares |= _shares_of_change(before, after)
    return sorted(shares)


def _matched(
    first: ComplexArray, second: ComplexArray, exponent: float
) -> tuple[ComplexArray, ComplexArray]:
    """Multipliers of two cycles, each beside the one that it becomes: the sum of distances, to the
    power `exponent`, is least."""
    distance = np.abs(first[:, None] - second[None, :])
    rows, columns = linear_sum_assignment(distance**exponent)
    return first[rows], second[columns]


def _shares_of_change(before: ComplexArray, after: ComplexArray) -> set[float]:
    """As `_doubtful_shares`, from multipliers that are matched."""
    slow = spectrum.are_slow(before, after)
    on_axis_before = int(np.sum(slow & (before.imag == 0)))
    on_axis_after = int(np.sum(slow & (after.imag == 0)))
    between = spectrum.turns_of(before, after)
    longest = float(np.abs(between.turns).max(initial=0))
    later = between.angles + between.turns
    shares = {each.share for each in spectrum.passings(between) if 0 < each.share < 1}
    shares.update(_returns_from_axis(between.angles, later, longest))
    if longest > LONGEST_TURN or on_axis_before != on_axis_after:
        shares.add(0.5)
    return shares


def _returns_from_axis(before: Array, after: Array, longest: float) -> list[float]:
    """Shares of the way at which multipliers may have met the real axis, from their angles at both
    ends (rad): a pair that passes through the axis looks like one that has turned back."""
    shares = list[float]()
    for first, second in ((before, after), (math.pi - before, math.pi - after)):
        way = first + second
        may_have_met = (first > 0) & (second > 0) & (way <= MAY_HAVE_MET * longest)
        shares += (first[may_have_met] / way[may_have_met]).tolist()
    return shares
