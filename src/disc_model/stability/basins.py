"""Which attractor a motion comes to: the quiet cycle, a known one, or one on which it has settled.

A motion is followed in legs of some seconds.  The signature of a leg is the range of the slider over its last second,
separations per second, and the shares of stick and separation.  What these decide is said in docs/studies.md, Many
starts.  What stays near an unstable cycle has not settled; what is new and not periodic has to stay to the horizon, for
it might be on its way past an unstable motion.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.simulation.api import kicked, published_start, simulate
from disc_model.simulation.case import Record, Window
from disc_model.simulation.result import Result, State
from disc_model.stability.cycle import FloquetResult, cycle_of
from disc_model.stability.fate import CYCLE_TOL, NEAR, Near, follows, published_start_near
from disc_model.stability.return_map import RETURNED, Array, ReturnMap, newton
from disc_model.stability.settling import LARGEST_PERIOD, shares

KINDS = ("none", "quiet", "vibrating", "separating", "sliding", "resting", "undecided", "failed")
"""What becomes of a motion: on the stable stick-slip cycle near the published start; in contact, but in another way;
separating again and again; sliding steadily; stuck for good; none of these within the horizon; not computed."""
LEG = 5.0
"""s, between two looks at a motion."""
NEARING, SETTLING = 4, 8
"""Legs over which a motion has to come closer to a known attractor, and to stay as it is on another one."""
WATCHED = 1.0
"""s, at the end of a leg, over which the range is taken: a hundred oscillations and more."""
RATE = 1000.0
"""Sampling rate there, Hz: the samples of a hundred oscillations show them in all phases."""
SETTLED = 0.01
"""Largest relative change of a signature over those legs. Motions that are not periodic vary by half of it. A
disturbance that dies out or grows by 0.00025/s or faster changes by more."""
AGAIN = 0.8
"""Share of its distance from the cycle after which a motion that did not follow the multipliers is tried again."""
STEADY = 1e-3
"""Relative change of the range over those legs that is no drift: samples of a periodic motion vary by a tenth."""
LEFT = 0.025
"""Largest relative change of the range that a drift, going on as it does, may have left."""
SAME = 0.05
"""Signatures that differ by less are those of one attractor: twice what each may have left."""
SAME_POINT = 1e-4
"""Fixed points nearer than this, over the static deflection, are one: a thousand times nearer than those of the cycles
known beside each other, and a million times further apart than their residuals."""
RETURNS = 1e-3
"""Change over a period, relative to the static deflection, from which a settled motion may be periodic."""
SMALLEST = 1e-3
"""Range, over the static deflection, below which the slider rests in height."""
LEAST_SHARE = 0.05
"""Shares of the phases and, for each second, separations below this differ by their difference over it."""
OWN_STARTS = (0.0, 0.25, 0.5, 1.0, 2.0)
"""Downward kicks of the published start from which attractors are looked for, over the static deflection."""


class Signature(NamedTuple):
    """Of a leg of motion: range of the slider (m), separations per second, shares of the phases."""

    range: float
    separation_rate: float
    share_stick: float
    share_separation: float

    def difference(self, other: Signature, smallest: float) -> float:
        """Largest relative difference; ranges below `smallest` (m) count as that."""
        one, two = (signature._replace(range=max(signature.range, smallest)) for signature in (self, other))
        least = Signature(smallest, 2 / LEG, LEAST_SHARE, LEAST_SHARE)
        return max(abs(a - b) / max(a, b, floor) for a, b, floor in zip(one, two, least, strict=True))


@dataclass(frozen=True, eq=False)
class Attractor:
    """What motions come to.

    Attributes
    ----------
    kind : one of `KINDS`
    period, releases, growth_rate : of a periodic one, s, 1 and 1/s; nan, 0 and nan otherwise
    points : shape (releases, n), its points on the section; None if it is not periodic
    """

    kind: str
    signature: Signature
    period: float = math.nan
    releases: int = 0
    growth_rate: float = math.nan
    points: Array | None = None


@dataclass(frozen=True, eq=False)
class Reached:
    """What a motion has come to.

    Attributes
    ----------
    kind : one of `KINDS`
    attractor : None if it is undecided or has failed
    simulated : s
    separated : whether contact was lost on the way
    status, message : of the simulation
    """

    kind: str
    attractor: Attractor | None
    simulated: float
    separated: bool
    status: str = "ok"
    message: str = ""


class Basins:
    """The attractors of a case: the quiet cycle, and those on which motions settle, from `OWN_STARTS` and then others.

    Parameters
    ----------
    horizon : s, for which a motion is followed at most
    near : distance in range from an attractor, relative, within which a motion that comes closer is taken to be on it;
        0: all are followed to the horizon

    Attributes
    ----------
    known : attractors in the order in which they were found
    """

    def __init__(self, p: Parameters, horizon: float, *, near: float = 0.1, tol: float = 1e-10) -> None:
        self.p, self.horizon, self.near, self.tol = p, horizon, near, tol
        modes = mode_arrays(p)
        self.static = p.N * float(np.sum(modes.psi**2 / modes.omega**2))
        self.smallest = max(SMALLEST * self.static, sys.float_info.min)
        self.map = ReturnMap(p, CYCLE_TOL)
        self.size = float(np.linalg.norm(self.map.static))
        found = published_start_near(p)
        self.cycle = found if isinstance(found, Near) and found.cycle.stable else None
        self.known: list[Attractor] = [] if self.cycle is None else [self._quiet(self.cycle)]
        for kick in OWN_STARTS:
            start = published_start(p)
            self.reached(kicked(p, start, u=-kick * self.static) if kick else start)

    def reached(self, state: State) -> Reached:
        """What the motion from a state at time 0 comes to; an attractor that is new is known from now on."""
        signatures: list[Signature] = []
        separated, since, tried = False, -1, [math.inf]
        while True:
            result = self._leg(state, min(state.time + LEG, self.horizon))
            state = result.final_state
            separated = separated or result.statistics["separations"] > 0
            if not result.status.complete:
                return Reached("failed", None, state.time, separated, result.status.value, result.message)
            signatures.append(_signature(result))
            over = state.time >= self.horizon
            found = self._found(signatures, state, tried) if self.near else None
            if not self._settled(signatures):
                since = -1
            elif found is None and (over or (self.near and since < 0)):
                found = self._settled_on(signatures[since:], state, over)
                since = len(signatures) - 1 if since < 0 else since
            if found is not None:
                return Reached(found.kind, found, state.time, separated)
            if over:
                return Reached("undecided", None, state.time, separated)

    def _same(self, one: Attractor, other: Attractor) -> bool:
        """Whether two are one: periodic ones by their fixed points, others by their signatures."""
        if one.points is not None and other.points is not None:
            apart = min(float(np.linalg.norm(one.points[0] - point)) for point in other.points)
            return apart <= SAME_POINT * self.size
        return one.signature.difference(other.signature, self.smallest) <= SAME

    def _leg(self, state: State, end: float) -> Result:
        window = Window(start=max(end - WATCHED, state.time), stop=end, rate=RATE)
        record = Record(windows=(window,), events=False)
        return simulate(self.p, end, tol=self.tol, initial_state=state, record=record)

    def _quiet(self, near: Near) -> Attractor:
        assert near.cycle.state is not None
        return self._periodic("quiet", _signature(self._leg(near.cycle.state, LEG)), near.cycle, near.x)

    def _found(self, signatures: Sequence[Signature], state: State, tried: list[float]) -> Attractor | None:
        """The attractor that the motion nears, before it has settled there; see `_nears` for what was tried."""
        calmer = signatures[-1].separation_rate == 0 and signatures[-1].range <= signatures[0].range
        if self.cycle is not None and calmer and self._nears(self.cycle, state, tried):
            return self.known[0]
        ranges = [signature.range for signature in signatures[-NEARING:]]
        others = [attractor for attractor in self.known if attractor.kind != "quiet"]
        if len(ranges) < NEARING or not others:
            return None
        apart = [[_apart(value, attractor.signature.range) for value in ranges] for attractor in others]
        nearest = min(range(len(others)), key=lambda i: apart[i][-1])
        if any(distances[-1] <= 2 * self.near for i, distances in enumerate(apart) if i != nearest):
            return None
        last = apart[nearest][-1]
        nearing = all(later < earlier or later <= SETTLED for earlier, later in pairwise(apart[nearest]))
        ends = _left(ranges) <= (2 * last + SETTLED) * ranges[-1]
        return others[nearest] if last <= self.near and nearing and ends else None

    def _nears(self, near: Near, state: State, tried: list[float]) -> bool:
        """Whether the motion is near the cycle on the section, and comes nearer as the multipliers say.

        tried : distances at which it did not; one that is hardly less is not tried, and one that is is added
        """
        code, x = self.map.next_release(state)
        if code != RETURNED:
            return False
        for at in chain([x], self.map.returns(x, near.cycle.releases - 1)):
            distance = float(np.linalg.norm(at - near.x))
            if distance <= NEAR * self.size:
                if distance > AGAIN * tried[-1]:
                    return False
                tried.append(distance)
                return follows(near, at)
        return False

    def _settled(self, signatures: Sequence[Signature]) -> bool:
        last = signatures[-SETTLING:]
        if len(last) < SETTLING or any(one.difference(last[-1], self.smallest) > SETTLED for one in last[:-1]):
            return False
        ranges = [max(signature.range, self.smallest) for signature in last]
        return abs(ranges[-1] - ranges[0]) <= STEADY * ranges[-1] or _left(ranges) <= LEFT * ranges[-1]

    def _settled_on(self, signatures: Sequence[Signature], state: State, over: bool) -> Attractor | None:
        """The attractor of a motion that has settled since the first signature; None as long as that is not sure."""
        found = self._described(signatures[-1], state)
        if found is None:
            return None
        same = next((attractor for attractor in self.known if self._same(found, attractor)), None)
        stays = over and signatures[0].difference(signatures[-1], self.smallest) <= SETTLED
        if same is None and (stays or found.points is not None):
            self.known.append(found)
            return found
        return same

    def _described(self, signature: Signature, state: State) -> Attractor | None:
        kind = "vibrating"
        if signature.separation_rate > 0:
            kind = "separating"
        elif signature.range <= self.smallest and signature.share_stick in (0.0, 1.0):
            kind = "resting" if signature.share_stick else "sliding"
        code, x = self.map.next_release(state)
        if code != RETURNED or kind in ("sliding", "resting"):
            return Attractor(kind, signature)
        releases = self._releases(x)
        found = newton(self.map, x, tol=CYCLE_TOL, releases=releases, may_separate=True) if releases else None
        if found is None or np.linalg.norm(found.x - x) > NEAR * self.size:
            return Attractor(kind, signature)
        cycle = cycle_of(self.map, CYCLE_TOL, found)
        return self._periodic(kind, signature, cycle, found.x) if cycle.stable else None

    def _releases(self, x: Array) -> int:
        """After how many releases the motion returns to where it was, 0 if it does not."""
        later = enumerate(self.map.returns(x, LARGEST_PERIOD, may_separate=True), 1)
        return next((releases for releases, at in later if np.linalg.norm(at - x) <= RETURNS * self.size), 0)

    def _periodic(self, kind: str, signature: Signature, cycle: FloquetResult, x: Array) -> Attractor:
        points = [x, *self.map.returns(x, cycle.releases - 1, may_separate=True)]
        return Attractor(kind, signature, cycle.period, cycle.releases, cycle.growth_rate, np.array(points))


def random_kick(p: Parameters, state: State, energy: float, key: Sequence[int]) -> State:
    """A state after a kick of stated energy in a random direction.

    The direction is uniform in the energy of the disc's modes: omega a, omega b, alpha, beta of each.  Slider and disc
    under it go along; f and psi stay.  The energy (J) is that of the kick itself: of the modes, of the slider's mass m
    and of its spring k.

    Parameters
    ----------
    key : whole numbers that make the direction, the same for the same numbers
    """
    if energy == 0:
        return state
    modes = mode_arrays(p)
    draw = np.random.default_rng(list(key)).standard_normal((4, len(modes.omega)))
    draw[2:, modes.diameters == 0] = 0.0
    a, alpha, b, beta = draw[0] / modes.omega, draw[1], draw[2] / modes.omega, draw[3]
    u, velocity = float(modes.psi @ a), float(modes.psi @ alpha)
    own = 0.5 * (float(np.sum(draw**2)) + p.k * u**2 + p.m * velocity**2)
    size = math.sqrt(energy / own)
    slope = float(np.sum(modes.diameters * modes.psi * b))
    return state.replace(
        a=state.a + size * a,
        b=state.b + size * b,
        alpha=state.alpha + size * alpha,
        beta=state.beta + size * beta,
        u=state.u + size * u,
        u_velocity=state.u_velocity + size * (velocity + state.f * slope),
    )


def _left(values: Sequence[float]) -> float:
    """What a drift of the values has left if its changes go on as they did: infinite if they do not become smaller."""
    changes = np.diff(values[-4:])
    before, last = abs(changes[-2]), abs(changes[-1])
    if not (np.all(changes > 0) or np.all(changes < 0)):
        return 0.0
    return float(last**2 / (before - last)) if last < before else math.inf


def _apart(one: float, other: float) -> float:
    """Relative difference of two ranges."""
    return abs(one - other) / max(one, other, sys.float_info.min)


def _signature(result: Result) -> Signature:
    """Of a leg with one window of samples."""
    stick, _, separation, rate = shares(result)
    return Signature(float(np.ptp(result.samples[0]["u"])), rate, stick, separation)
