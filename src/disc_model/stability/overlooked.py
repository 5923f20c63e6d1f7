"""Stable cycles that the search from the static start overlooks, followed from neighbouring values.

Beside a fold, Newton's method from the static start may find no cycle, or only the unstable one, while
the stable one still exists and the motion from the static start settles on it.
"""

from itertools import pairwise

import numpy as np

from disc_model.errors import ParameterError
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.stability.parameter_scan import Scan
from disc_model.stability.return_map import ReturnMap

# motions besides which there may be a stable cycle: the search has found none, or another one
OVERLOOKED = ("no_cycle", "unstable")
# difference of two cycles, over the norm of the disc's displacement, beyond which one is not the other
# a short step further
JUMP = 1e-4
ROUNDED = 1e-6  # rounding of a short step, over it
SETTLED = 0.05  # distance of a motion from the stable one of two cycles, over their distance
MOST_RETURNS = 10_000  # within which it is to settle: some two minutes of it, half a second of work


def follow_stable_cycles(scan: Scan, shortest: float) -> None:
    """Follow each stable cycle that is gone from one value of a scan to the next, less than `shortest`
    away, to where it ends or loses stability; it is the motion at all values on the way."""
    pursued = set[tuple[float, float]]()
    while True:
        known = sorted(scan.motions)
        pairs = [*pairwise(known), *((high, low) for low, high in pairwise(known))]
        jumps = (pair for pair in pairs if pair not in pursued and _jumps(scan, *pair, shortest))
        jump = next(jumps, None)
        if jump is None:
            return
        pursued.add(jump)
        begin, end = jump
        ahead = [x for x in known if (x > begin) == (end > begin) and x != begin]
        _Pursuit(scan, begin).run(sorted(ahead, key=lambda x: abs(x - begin)), shortest)


def _jumps(scan: Scan, begin: float, end: float, shortest: float) -> bool:
    """Whether a stable cycle at one value is gone at the next one, a short step further."""
    stable = scan.motions[begin]
    other = scan.motions[end]
    if stable.motion != "stable" or other.motion not in OVERLOOKED:
        return False
    short = abs(end - begin) <= shortest * (1 + ROUNDED)
    return short and (other.state is None or _difference(stable, other) > JUMP)


def _difference(one: FloquetResult, other: FloquetResult) -> float:
    """Difference of two cycles at their release, over the norm of the disc's displacement."""
    assert one.state is not None
    assert other.state is not None
    size = float(np.linalg.norm(one.state.a))
    return float(np.linalg.norm(one.state.a - other.state.a)) / size if size else 0.0


class _Pursuit:
    """A stable cycle that is followed from a value of a scan on.

    at : the last value at which it is known to be stable
    """

    def __init__(self, scan: Scan, begin: float) -> None:
        self.scan = scan
        self.at = begin

    def run(self, ahead: list[float], shortest: float) -> None:
        """Follow the cycle through the values ahead, until there is a stable motion again, or the cycle
        ends or loses stability; that place is located. Only at the values ahead it is asked where the
        motion from the static start goes: close to a fold that takes too long."""
        for end in ahead:
            if self.scan.is_stable(end):
                return
            if not self._goes_on(end, ask_motion=True):
                self._locate_end(end, shortest)
                return

    def _locate_end(self, end: float, shortest: float) -> None:
        """Follow the cycle to less than `shortest` from where it ends, before a value."""
        while abs(end - self.at) > shortest:
            middle = 0.5 * (self.at + end)
            if middle in (self.at, end):
                return
            if not self._goes_on(middle, ask_motion=False):
                end = middle

    def _goes_on(self, end: float, *, ask_motion: bool) -> bool:
        """Whether the cycle, or another stable one, is the motion at a value, and is known there
        then."""
        scan = self.scan
        if not scan.is_stable(end):
            followed = self._followed(end)
            found = scan.motions[end]
            if followed is None or not followed.stable or found.motion not in OVERLOOKED:
                return False
            if ask_motion and found.state is not None and not _settles_on(followed, found):
                return False
            scan.motions[end] = followed
        is_cycle = bool(scan.motions[end].motion == "stable")
        if is_cycle:
            self.at = end
        return is_cycle

    def _followed(self, end: float) -> FloquetResult | None:
        """The cycle at another value; None if it ends before."""
        scan = self.scan
        cycle = scan.motions[self.at]
        try:
            branch = continue_cycle(
                scan.p.replace(**{scan.name: self.at}),
                scan.name,
                (min(self.at, end), max(self.at, end)),
                direction=1 if end > self.at else -1,
                guess=cycle.state,
                releases=cycle.releases,
                tol=scan.tol,
            )
        except ParameterError:
            return None
        if branch.values[-1, 0] != end or branch.separations[-1]:
            return None
        return find_cycle(branch.case_at(-1), scan.tol, branch.state(-1), cycle.releases)


def _settles_on(followed: FloquetResult, found: FloquetResult) -> bool:
    """Whether the motion from the static start settles on a stable cycle that was followed, and does
    not stay near the unstable one that was found."""
    map_ = ReturnMap(followed.parameters, followed.tol)
    assert followed.state is not None
    assert found.state is not None
    wanted = map_.point(followed.state)
    near = SETTLED * float(np.linalg.norm(map_.point(found.state) - wanted))
    start = map_.first_release
    if not start.reached:
        return False
    points = map_.returns(start.x, MOST_RETURNS)
    return any(np.linalg.norm(x - wanted) < near for x in points)
