"""The reason for which a branch ends, found by simulating the motion just beyond its last cycle.

Where the return map is discontinuous, no cycle continues the branch.  A switch is grazed there:
just beyond, the motion has an event that the cycle lacks, or lacks one of the cycle's, and the
first event that differs tells which.
"""

from __future__ import annotations

from itertools import zip_longest
from typing import NamedTuple

import numpy as np

from disc_model.display import counted
from disc_model.errors import DiscModelError, ParameterError
from disc_model.simulation.api import simulate
from disc_model.stability.continuation.curve import CurvePoint, Rejected
from disc_model.stability.continuation.problem import (
    WITHOUT_RETURN,
    CycleProblem,
    has_own_vibration,
)

BOUND = "bound"
CLOSED = "closed"
MOST_POINTS = "max_points"
STOPPED = "stopped"
GRAZED = "grazing"
HOPF = "hopf"
LIMIT = "limit"
LOST = "lost"
DOUBLED = "period_doubling"
# Arclengths beyond the last cycle, which is within the shortest step of a discontinuity; events of
# a motion without one move by about as much, over the period.
BEYOND = (1e-6, 1e-5, 1e-4)
# Such arclengths for motions, at last back along the branch: beside a grazing release a leading
# multiplier of a million leaves it to chance on which side a motion goes.
TRIED = (*BEYOND, 2e-6, 5e-6, 2e-5, 5e-5, 2e-4, 5e-4, 1e-3, -1e-6, -1e-5, -1e-4)
SAME_TIME = 5e-3  # largest difference of two times of one event, over the period
# A stiff contact's vibration makes a motion farther away differ without a grazing, and may graze
# friction's limit within a vibration of the release.
TRIED_STIFF = (1e-6, 1e-5)
SAME_TIME_STIFF = 1e-3

GRAZINGS = {
    ("stick_to_slip", True): "a grazing release: during stick the pull touches friction's limit",
    (
        "stick_to_slip",
        False,
    ): "a grazing release: the pull touches friction's limit where stick ends",
    ("slip_to_stick", True): "a grazing stop: the cycle touches zero slip speed during slip",
    ("slip_to_stick", False): "stick vanishes: the cycle touches zero slip speed",
    ("slip_reversal", True): "a slip reversal appears: the pull touches friction's limit at a stop",
    ("slip_reversal", False): "a slip reversal vanishes: the cycle touches zero slip speed",
    ("separation", True): "contact is lost: the contact force touches zero",
    ("separation", False): "a separation vanishes: the contact force touches zero",
    ("reattachment", True): "a grazing impact: the slider touches the disc during separation",
    ("reattachment", False): "a grazing impact: the slider touches the disc without an impact",
}
"""Words for the kind of the first event that differs, and whether it appears beyond the branch."""
TURNED = (
    "a release turns round: the contact force and the pull touch zero together where stick ends"
)


class End(NamedTuple):
    """Why a branch ends: one of the kinds above, and a sentence."""

    kind: str
    text: str


def at_most_points(most: int) -> End:
    """The end of a curve that has as many points as are allowed."""
    return End(MOST_POINTS, f"max_points={most} were computed")


class Event(NamedTuple):
    """An event of a motion: its kind and its time, over the period of the cycle."""

    kind: str
    time: float


def reason_of_loss(problem: CycleProblem, last: CurvePoint, rejected: Rejected) -> End:
    """Why a curve cannot be followed beyond a point at which even the shortest step was
    rejected."""
    if str(rejected) == WITHOUT_RETURN["vanished"]:
        return End(HOPF, f"a Hopf point: {rejected}")
    for distance in BEYOND:
        z = last.z + distance * last.tangent
        try:
            problem.case(z)
        except ParameterError as fault:
            return End(LIMIT, f"beyond it the case is not valid: {fault}")
    stiff = has_own_vibration(problem.base)
    tried = TRIED_STIFF if stiff else TRIED
    same_time = SAME_TIME_STIFF if stiff else SAME_TIME
    until = (1 - same_time) * last.orbit.period
    cycle = _events(problem, last.z, last.orbit.period, until)
    for distance in tried:
        motion = _events(problem, last.z + distance * last.tangent, last.orbit.period, until)
        text = _first_difference(cycle, motion, same_time)
        if text:
            return End(GRAZED, text)
    if str(rejected) == WITHOUT_RETURN["time_over"] and _slips_on(problem, last):
        return End(GRAZED, GRAZINGS["slip_to_stick", False])
    releases = _releases_beyond_turn(problem, last, same_time)
    if releases:
        advice = f"the cycle beyond has {counted(releases, 'release')}: start again there with releases={releases}"
        return End(GRAZED, f"{TURNED}; {advice}")
    text = f"no step from {problem.words(last)} succeeds: {rejected}"
    if str(rejected) not in WITHOUT_RETURN.values():
        text += "; start again beyond it"
    return End(LOST, text)


def _events(problem: CycleProblem, z: np.ndarray, period: float, until: float) -> list[Event]:
    """The events of the motion from a point of the section until a time before the last release of
    the period, which a leading multiplier of a million, as beside a grazing release, displaces."""
    section_map = problem.map_at(z)
    start = section_map.state(problem.section_point(z))
    try:
        run = simulate(problem.case(z), duration=period, initial_state=start, tol=problem.tol)
    except DiscModelError:
        return []
    table = run.events
    early = table[table["time"] < until]
    return [
        Event(str(kind), float(time) / period)
        for kind, time in zip(early["kind"], early["time"], strict=True)
    ]


def _slips_on(problem: CycleProblem, last: CurvePoint) -> bool:
    """Whether the motion just beyond a point never comes to stick in its period. The cycle may do so
    shortly before its release, which is no event that is compared."""
    period = last.orbit.period
    motion = _events(problem, last.z + BEYOND[0] * last.tangent, period, period)
    return all(event.kind != "slip_to_stick" for event in motion)


def _releases_beyond_turn(problem: CycleProblem, last: CurvePoint, same_time: float) -> int:
    """The number of releases in a period just beyond a point where a release turns round: as a
    backward one it is not counted, and the other way about. 0 if none does."""
    if problem.order is None:
        return 0
    z = last.z + BEYOND[0] * last.tangent
    counts = last.orbit.counts
    for turned in (1, -1):
        releases = counts.releases - turned
        if releases == 0:  # without one, no motion comes to the section
            continue
        motion = problem.follow(z, tangent=False, releases=releases)
        same_period = abs(motion.period / last.orbit.period - 1) < same_time
        backward = motion.counts.backward_releases - counts.backward_releases
        if motion.returned and same_period and backward == turned:
            return releases
    return 0


def _are_same(one: Event | None, other: Event | None, same_time: float) -> bool:
    """Whether two motions have the same event, or neither has one."""
    if one is None or other is None:
        return one is other
    return one.kind == other.kind and abs(one.time - other.time) < same_time


def _first_difference(cycle: list[Event], motion: list[Event], same_time: float = SAME_TIME) -> str:
    """Words for the first event that only one of two motions has; none if they have the same."""
    for ours, theirs in zip_longest(cycle, motion):
        if _are_same(ours, theirs, same_time):
            continue
        appears = ours is None or (theirs is not None and theirs.time < ours.time)
        kind = theirs.kind if appears else ours.kind
        return GRAZINGS.get((kind, appears), "")
    return ""
