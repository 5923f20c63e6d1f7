"""Whether a motion that sticks now and then repeats after a whole number of releases, and the map
from the phase of one release of stick, in the vibration, to that of the next.

docs/model.md, Why separated motions lock, has the argument.
"""

import math
from typing import NamedTuple

import numpy as np

from disc_model.analysis.classify import shortest_period
from disc_model.arrays import Array, Indices
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability.cycle import run_through_once
from disc_model.stability.return_map import Orbit, ReturnMap, newton

FEWEST_SEPARATIONS = 3  # in a record, whose mean interval is that of vibrations


class Releases(NamedTuple):
    """The releases of stick in a record of a motion that separates once per vibration.

    Attributes
    ----------
    times : s, shape (n,)
    phases : shape (n,), time since the last separation over the mean interval of separations
    vibrations : shape (n - 1,), number of separations between a release and the next
    vibration : s, mean interval of separations
    """

    times: Array
    phases: Array
    vibrations: Indices
    vibration: float


class Lock(NamedTuple):
    """A motion that repeats: number of releases and of separations in a period, and its duration (s)."""

    releases: int
    vibrations: int
    period: float


def releases_of(run: Result, since: tuple[float, float] | None = None) -> Releases | None:
    """The releases of a run that was recorded with its events; None with fewer than two of them.
    Those before the first separation do not count.

    Parameters
    ----------
    run : with its events
    since : time (s) of a separation before the run, and the interval of separations (s); the run's
        own unless given
    """
    events = run.events
    kinds = events["kind"].to_numpy()
    times = events["time"].to_numpy(dtype=float)
    separations = times[kinds == "separation"]
    if since is not None:
        separations = np.concatenate([[since[0]], separations])
    released = kinds == "stick_to_slip"
    if separations.size:
        released &= times > separations[0]
    if separations.size < FEWEST_SEPARATIONS or released.sum() < 2:
        return None
    instants = times[released]
    vibration = float(np.mean(np.diff(separations))) if since is None else since[1]
    before = np.searchsorted(separations, instants)
    phases = (instants - separations[before - 1]) / vibration
    return Releases(instants, phases, np.diff(before), vibration)


def lock_of(releases: Releases) -> Lock | None:
    """The period of a motion; None unless intervals between releases repeat, to a hundredth of a
    microsecond, throughout a record of two periods or more, with the same numbers of vibrations."""
    intervals = np.diff(releases.times)
    n = shortest_period(intervals)
    if not n or not np.array_equal(releases.vibrations[n:], releases.vibrations[:-n]):
        return None
    vibrations = int(releases.vibrations[:n].sum())
    period = float(releases.times[n] - releases.times[0])
    return Lock(n, vibrations, period)


def locked_cycle(p: Parameters, state: State, lock: Lock) -> Orbit | None:
    """The cycle that a locked motion is on, with its shortest period: while the motion still settles,
    its record may repeat only after several of these. None if Newton's method finds no cycle at the
    motion that repeats after as many releases and separations."""
    map_ = ReturnMap(p, patient=True)
    release = map_.next_release(state)
    if not release.reached:
        return None
    orbit = newton(map_, release.x, releases=lock.releases)
    if orbit is None or orbit.counts.separations != lock.vibrations:
        return None
    return run_through_once(map_, orbit)


class PhaseMap(NamedTuple):
    """The map of release phases at n places: phases (n,), that of the next release (n,), the number
    of vibrations between both (n,), and the derivative of the second by the first (n,), nan next to
    a jump."""

    phases: Array
    following: Array
    vibrations: Indices
    slopes: Array


HELD = 0.5
"""Vibrations after a loss of contact at which the slider is held: about where the force is largest."""
NUDGE = 1e-6  # change of the spring's stretch, over the largest, from which slopes follow
LONGEST_WAY = 100  # vibrations within which the release after that has to come


def phase_map(p: Parameters, run: Result, count: int, tol: float) -> PhaseMap:
    """The map of release phases of the vibration at the end of a run, from sticks that are begun
    anew.

    The slider is held half a vibration after a loss of contact, with the in-plane spring stretched
    by `count` different amounts that friction can hold. It is released as the contact force falls,
    the later the less the spring is stretched, and then moves freely to its next release.
    """
    nothing = PhaseMap(np.empty(0), np.empty(0), np.empty(0, dtype=np.int64), np.empty(0))
    found = releases_of(run)
    if found is None:
        return nothing
    vibration = found.vibration

    # the instant at which the slider is held, and the largest stretch
    start = run.final_state
    ahead = simulate(p, start.time + 2 * vibration, tol=tol, initial_state=start).events
    lost = float(ahead["time"][ahead["kind"] == "separation"].iloc[0])
    begin = lost + HELD * vibration
    windows = {"force": Window(start=start.time, stop=begin, rate=100 / (begin - start.time))}
    before = simulate(p, begin, windows, tol=tol, initial_state=start)
    largest = p.mu_s * float(before["force"]["P"].values[-1]) / (p.r_0 * p.k_p)
    held = before.final_state.replace(f=0.0, direction=0, phase="stick")

    def follow(stretch: float) -> Releases | None:
        """The releases after the slider has been held with the spring stretched by an angle; None
        if the first one is backward."""
        end = begin + LONGEST_WAY * vibration
        after = simulate(p, end, tol=tol, initial_state=held.replace(psi=stretch))
        is_release = after.events["kind"] == "stick_to_slip"
        is_forward = (after.events["psi"][is_release].iloc[:1] > 0).all()
        if is_forward:
            return releases_of(after, since=(lost, vibration))
        return None

    rows = []
    for stretch in (largest * np.linspace(-1, 1, count + 2)[1:-1]).tolist():
        first, second = follow(stretch), follow(stretch + NUDGE * largest)
        if first is None or second is None:
            continue
        slope = math.nan
        if first.vibrations[0] == second.vibrations[0]:
            change = second.phases[:2] - first.phases[:2]
            slope = float(change[1] / change[0])
        rows.append((*first.phases[:2], first.vibrations[0], slope))
    if not rows:
        return nothing
    phases, following, vibrations, slopes = np.array(sorted(rows), dtype=float).T
    return PhaseMap(phases, following, vibrations.astype(np.int64), slopes)
