"""Motions by the value of one parameter: where their stability may change, and where it does."""

import math
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment, minimize_scalar

from disc_model.arrays import Array, ComplexArray
from disc_model.data.variables import STABLE_CYCLES
from disc_model.display import Bar
from disc_model.parameters import Parameters
from disc_model.stability.continuation import spectrum
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.stability.sliding import SteadySliding, growth_rates, steady_sliding

SLIDING = "sliding"
# times that places of suspected instability are predicted anew, from the cycles beside them
ROUNDS = 8
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


class Scan:
    """Motions near the static start by the value of one parameter, each computed once."""

    def __init__(self, p: Parameters, name: str, tol: float) -> None:
        self.p = p
        self.name = name
        self.tol = tol
        self.motions: dict[float, Any] = {}

    def is_stable(self, x: float) -> bool:
        """Whether the motion is stable at a value, where it is known then."""
        if x not in self.motions:
            self.motions[x] = self.motion_of(self.p.replace(**{self.name: x}))
        return self.settles(self.motions[x])

    def motion_of(self, case: Parameters) -> Any:
        """The motion of a case."""
        return find_cycle(case, self.tol)

    def settles(self, motion: Any) -> bool:
        """Whether small disturbances of a motion die out."""
        return motion.motion in STABLE_CYCLES

    def refine(self, narrowest: float, bar: Bar) -> None:
        """Compute further values where the cycles beside them leave a change of stability in doubt,
        none closer than `narrowest` to another one."""
        examined = set[tuple[float, float]]()
        for _ in range(ROUNDS):
            gaps = set(pairwise(sorted(self.motions))) - examined
            examined |= gaps
            places = []
            for low, high in sorted(gaps):
                length = high - low
                for share in _doubtful_shares(self.motions[low], self.motions[high]):
                    if min(share, 1 - share) * length > narrowest:
                        places.append(low + share * length)
            bar.expect(len(places))
            for place in places:
                self.is_stable(place)
                bar.advance()

    def located_changes(self, shortest: float) -> tuple[list[float], list[bool]]:
        """The values at which stability changes, located to an interval of length `shortest`, and
        whether the motion is unstable above each."""
        crossings = list[float]()
        unstable_above = list[bool]()
        for low, high in list(pairwise(sorted(self.motions))):
            stable_below = self.is_stable(low)
            if stable_below != self.is_stable(high):
                crossings.append(self._bisect(low, high, shortest))
                unstable_above.append(stable_below)
        return crossings, unstable_above

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


class SlidingScan(Scan):
    """Steady sliding by the value of one parameter."""

    def motion_of(self, case: Parameters) -> SteadySliding:
        return steady_sliding(case)

    def settles(self, motion: SteadySliding) -> bool:
        return motion.status.exists and not motion.growing.size

    def refine(self, narrowest: float, bar: Bar) -> None:
        """Compute the greatest growth rates among stable neighbours, and the least ones among
        unstable ones: of modes that meet, only one may grow for a stretch."""
        known = sorted(self.motions)
        for low, middle, high in zip(known, known[1:], known[2:], strict=False):
            stable = {self.is_stable(x) for x in (low, middle, high)}
            if len(stable) > 1:
                continue
            sign = -1.0 if stable == {True} else 1.0
            ends = sign * np.array([self._rate(x) for x in (low, middle, high)])
            is_flat = ends[0] == ends[1] == ends[2]  # neutral at all three: there is no extreme
            if ends[1] <= min(ends[0], ends[2]) and not is_flat:
                search = partial(self._signed_rate, sign)
                minimize_scalar(
                    search, bounds=(low, high), method="bounded", options={"xatol": narrowest}
                )

    def _rate(self, x: float) -> float:
        """The growth rate at a value, 1/s, of modes that are not neutral, which hide what happens to
        others; 0 if all are, nan without steady sliding."""
        self.is_stable(x)
        sliding = self.motions[x]
        rates = growth_rates(sliding.eigenvalues)
        if not rates.any():
            return float(sliding.growth_rate)
        return float(rates[rates != 0].max())

    def _signed_rate(self, sign: float, x: float) -> float:
        return sign * self._rate(float(x))


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
