"""Which attractor of a case each of many motions comes to: the quiet cycle, a known one, or one that is new.

A motion is followed in legs of some seconds.  What these decide is said in docs/algorithms.md, Identifying the outcome.
What stays near an unstable cycle has not settled; what is new and not periodic has to stay to the horizon, for it might
be on its way past an unstable motion.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from disc_model.analysis.classify import CLOSES, FEWEST, SETTLED, closure, shortest_period
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.simulation.api import perturb, simulate, static_start
from disc_model.simulation.case import Record, Window
from disc_model.simulation.result import Result, State
from disc_model.stability.attractor.neighbourhood import (
    CYCLE_TOL,
    LARGEST_PERIOD,
    NEAR,
    SAME_POINT,
    NearCycle,
    cycle_near,
    cycle_of_static_start,
    follows,
    recurrence,
)
from disc_model.stability.attractor.outcome import (
    FIRST_LEG,
    RATE,
    Attractor,
    OutcomeResult,
    Segment,
    at_rest,
    segment_of,
)
from disc_model.stability.cycle import may_stick_and_slip
from disc_model.stability.lyapunov import CLEAR, CONVERGED, lyapunov_exponents
from disc_model.stability.return_map import PATIENT, RETURNED, ReturnMap

NEARING, SETTLING = 4, 8
"""Legs over which a motion has to come closer to a known attractor, and to stay as it is on another one."""
WATCHED = 1.0
"""s, at the end of a leg, over which the range is taken: a hundred oscillations and more."""
STEADY = 1e-3
"""Relative change of the range over those legs that is no drift: samples of a periodic motion vary by a tenth."""
SAME = 0.05
"""Stretches that differ by less are those of one attractor; a drift, going on as it does, may have left half of it."""
SMALLEST = 1e-3
"""Ranges, over the static deflection, below which they are alike: the slider rests in height. And changes over a period
of a motion that is as good as periodic."""
OWN_STARTS = (0.0, 0.25, 0.5, 1.0, 2.0)
"""Downward kicks of the static start from which attractors are looked for, over the static deflection."""


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
        self.map = ReturnMap(p, CYCLE_TOL, patience=PATIENT)
        self.size = float(np.linalg.norm(self.map.static))
        found = cycle_of_static_start(p)
        self.cycle = found if isinstance(found, NearCycle) and found.cycle.stable else None
        self.known: list[Attractor] = []
        if self.cycle is not None:
            assert self.cycle.cycle.state is not None
            self.known.append(self._periodic(self.cycle, segment_of(self._leg(self.cycle.cycle.state, FIRST_LEG))))
        for kick in OWN_STARTS:
            start = static_start(p)
            self.reached(perturb(p, start, u=-kick * self.static) if kick else start)

    def reached(self, state: State) -> OutcomeResult:
        """What the motion from a state at time 0 comes to; an attractor that is new is known from now on."""
        stretches: list[Segment] = []
        first, since, least = math.nan, -1, math.inf
        while True:
            result = self._leg(state, min(state.time + FIRST_LEG, self.horizon))
            state = result.final_state
            first = result.first_separation if math.isnan(first) else first
            if not result.status.complete:
                return OutcomeResult(None, state.time, first_separation=first, failed=result)
            stretches.append(segment_of(result))
            over, found = state.time >= self.horizon, None
            if self.near:
                nears, least = self._nears(stretches, state, least)
                found = self.known[0] if nears else self._found([stretch.range for stretch in stretches[-NEARING:]])
            if not self._settled(stretches):
                since = -1
            elif found is None and (over or (self.near and since < 0)):
                stays = over and self._difference(stretches[since], stretches[-1]) <= SETTLED
                found = self._settled_on(result, stays)
                since = len(stretches) - 1 if since < 0 else since
            if found is not None:
                return OutcomeResult(found.kind, state.time, attractor=found, first_separation=first)
            if over:
                return OutcomeResult(Outcome.UNDECIDED, state.time, first_separation=first)

    def _leg(self, state: State, end: float) -> Result:
        window = Window(start=max(end - WATCHED, state.time), stop=end, rate=RATE)
        record = Record(windows=(window,))
        return simulate(self.p, end, tol=self.tol, initial_state=state, record=record)

    def _difference(self, one: Segment, other: Segment) -> float:
        """Largest relative difference of ranges, shares of the phases and separations per second.

        Shares below `SAME`, and less than two separations in a leg, differ by their difference over these.
        """
        ranges = [max(stretch.range, self.smallest) for stretch in (one, other)]
        compared = [(*ranges, self.smallest), (one.separation_rate, other.separation_rate, 2 / FIRST_LEG)]
        compared += [
            (getattr(one, name), getattr(other, name), SAME) for name in ("stick_fraction", "separation_fraction")
        ]
        return max(abs(a - b) / max(a, b, floor) for a, b, floor in compared)

    def _nears(self, stretches: Sequence[Segment], state: State, least: float) -> tuple[bool, float]:
        """Whether the motion is near the quiet cycle and comes nearer as the multipliers say.

        least : distance at which it did not, given back with it; one that is not less is not tried
        """
        last, near = stretches[-1], self.cycle
        if near is None or last.separation_rate > 0 or last.range > stretches[0].range:
            return False, least
        code, x = self.map.next_release(state)
        if code == RETURNED:
            for at in chain([x], self.map.returns(x, near.cycle.releases - 1)):
                distance = float(np.linalg.norm(at - near.x))
                if distance <= NEAR * self.size:
                    return distance < least and follows(near, at), min(distance, least)
        return False, least

    def _found(self, ranges: Sequence[float]) -> Attractor | None:
        """The known attractor that the motion nears, before it has settled there."""
        others = [attractor for attractor in self.known if attractor.kind is not Outcome.QUIET]
        if len(ranges) < NEARING or not others:
            return None
        apart = [[_apart(value, attractor.segment.range) for value in ranges] for attractor in others]
        nearest = min(range(len(others)), key=lambda i: apart[i][-1])
        if any(distances[-1] <= 2 * self.near for i, distances in enumerate(apart) if i != nearest):
            return None
        last = apart[nearest][-1]
        nearing = all(later < earlier or later <= SETTLED for earlier, later in pairwise(apart[nearest]))
        ends = _left(ranges) <= (2 * last + SETTLED) * ranges[-1]
        return others[nearest] if last <= self.near and nearing and ends else None

    def _settled(self, stretches: Sequence[Segment]) -> bool:
        last = stretches[-SETTLING:]
        if len(last) < SETTLING or any(self._difference(one, last[-1]) > SETTLED for one in last[:-1]):
            return False
        ranges = [max(stretch.range, self.smallest) for stretch in last]
        return abs(ranges[-1] - ranges[0]) <= STEADY * ranges[-1] or _left(ranges) <= SAME / 2 * ranges[-1]

    def _settled_on(self, leg: Result, stays: bool) -> Attractor | None:
        """The attractor of a motion that has settled; None as long as that is not sure.

        stays : whether it has been as it is until the horizon
        """
        found = self._described(leg)
        if found is None:
            return None
        same = next((attractor for attractor in self.known if self._same(found, attractor)), None)
        if same is None and (stays or found.points is not None):
            if found.kind is Outcome.UNDECIDED:
                found = replace(found, kind=regularity(self.p, leg.final_state, self.tol).kind)
            self.known.append(found)
            return found
        return same

    def _described(self, leg: Result) -> Attractor | None:
        """What a motion is on, undecided if that is no cycle nor rest; None near an unstable cycle."""
        stretch = segment_of(leg)
        calm = at_rest(self.p, leg, self.tol)
        if calm is not None:
            return Attractor(calm, stretch)
        near = cycle_reached(self.p, leg, LARGEST_PERIOD)
        if near is not None and not near.cycle.stable and self._stays(near):
            return None
        return (
            self._periodic(near, stretch)
            if near is not None and near.follows_cycle
            else Attractor(Outcome.UNDECIDED, stretch)
        )

    def _stays(self, near: NearCycle) -> bool:
        """Whether a motion hardly moves on the section over a period of the cycle near it, as on a torus it would."""
        at = near.x + near.distance
        return bool(np.linalg.norm(near.moved(at, 1)[0] - at) <= SMALLEST * self.size)

    def _same(self, one: Attractor, other: Attractor) -> bool:
        """Whether two are one: periodic ones by their fixed points, others by their stretches."""
        if one.points is not None and other.points is not None:
            apart = min(float(np.linalg.norm(one.points[0] - point)) for point in other.points)
            return apart <= SAME_POINT * self.size
        return self._difference(one.segment, other.segment) <= SAME

    def _periodic(self, near: NearCycle, stretch: Segment) -> Attractor:
        cycle = near.cycle
        points = [near.x, *near.map.returns(near.x, cycle.releases - 1, may_separate=True)]
        return Attractor(near.kind, stretch, cycle.period, cycle.releases, cycle.growth_rate, np.array(points))


def cycle_reached(p: Parameters, stretch: Result, most: int = sys.maxsize) -> NearCycle | None:
    """The cycle near which a motion is by the end of a stretch with its events; it may lose contact.

    Periods of up to half the releases of the stretch are looked for, and at most of so many.
    """
    releases = int((stretch.events["kind"] == "stick_to_slip").sum())
    if not releases or not may_stick_and_slip(p):
        return None
    map_ = ReturnMap(p, CYCLE_TOL, patience=PATIENT)
    code, x = map_.next_release(stretch.final_state)
    if code != RETURNED:
        return None
    return cycle_near(
        map_, x, recurrence(map_, x, max(1, min(most, releases // 2)), may_separate=True), may_separate=True
    )


class Regularity(NamedTuple):
    """What a motion is; after how many switches it repeats, 0 if that is not shown; how nearly, s; and where its
    cycle is, if that is known."""

    kind: Outcome
    period: int = 0
    closure: float = math.nan
    state: State | None = None


def regularity(p: Parameters, state: State, tol: float) -> Regularity:
    """Of a motion from a state on, by its separations, or by its releases if it has none, and by its largest exponent.

    That is the one but for the exponent along the motion. It is zero on a torus and positive in chaos. Below zero all
    motions nearby come together: they come to one cycle, be its period too long to be seen.
    """
    run = simulate(p, state.time + SETTLING * FIRST_LEG, tol=tol, initial_state=state)
    times, kinds = run.events["time"].to_numpy(dtype=float), run.events["kind"].to_numpy()
    separates = bool((kinds == "separation").any())
    intervals = np.diff(times[kinds == ("separation" if separates else "stick_to_slip")])
    if not run.status.complete or len(intervals) < FEWEST:
        return Regularity(Outcome.UNDECIDED)
    periodic = Outcome.SEPARATING if separates else Outcome.OTHER_CYCLE
    if n := shortest_period(intervals, CLOSES):
        return Regularity(periodic, n, closure(intervals, n))
    duration = SETTLING * FIRST_LEG / 2
    found = lyapunov_exponents(p, duration, count=1, initial_state=state, tol=tol, leave_out_trivial=True)
    rate, error = float(found.exponents[0]), float(found.errors[0])
    if not (math.isfinite(rate) and math.isfinite(error)):
        return Regularity(Outcome.UNDECIDED)
    if abs(rate) <= max(CLEAR * error, CONVERGED[1]):
        return Regularity(Outcome.QUASI_PERIODIC)
    return Regularity(Outcome.IRREGULAR if rate > 0 else periodic)


def random_perturbation(p: Parameters, state: State, energy: float, key: Sequence[int]) -> State:
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
