"""Replies to questions by a method that integrates, from the events that it finds within a budget."""

import math
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import curve_fit
from scipy.signal import find_peaks

from benchmarks.methods import Method
from benchmarks.methods.integrators import Array, MethodResult, Problem, RunStatus
from benchmarks.questions import AnswerStatus, Replies, Reply, reply_of
from benchmarks.scenes import read_state, stored
from disc_model.analysis import classify
from disc_model.parameters import Parameters
from disc_model.simulation.states import State, static_start

Solve = Callable[[Problem, float], MethodResult]
"""A method at a setting: integrates a problem within a budget in s."""

REPEATS = 3
"""Number of repeated quick runs; the fastest counts, since disturbances only add time."""
QUICK = 0.3
"""Longest time of a run that is repeated, s."""
LEAST_BUDGET = 0.1
"""Budget of a run when that of its question is used up, s."""


def setting_of(method: Method, value: float) -> Solve:
    """Return a method at a value of its setting."""
    return lambda problem, budget: method.solve(problem, value, budget)


class Broken(Exception):
    """A run on which an answer depends did not reach its end; the argument is its result."""


def _timed(solve: Solve, problem: Problem, budget: float) -> tuple[MethodResult, float]:
    """Return the result of a run, and the least time of several, s.

    Quick runs are repeated, since the first may have compiled.

    Parameters
    ----------
    solve, problem : what is run
    budget : of each run, s
    """
    result = solve(problem, budget)
    seconds = result.seconds
    last = result.seconds
    for _ in range(REPEATS):
        if last >= QUICK:
            break
        last = solve(problem, budget).seconds
        seconds = min(seconds, last)
    return result, seconds


def _times(result: MethodResult, kind: str) -> Array:
    """Return the times of one kind of event, s."""
    return result.times[[event == kind for event in result.kinds]]


def _separates(result: MethodResult) -> bool:
    """Return whether contact is lost.

    Raises `Broken` if the motion neither lost it nor reached its end.
    """
    separates = "separation" in result.kinds
    if not separates and result.outcome is not RunStatus.FINISHED:
        raise Broken(result)
    return separates


# ---- The first separation, and the motion after it

SEPARATING = Parameters(N=385.0, Omega=15.1)
SEPARATION_HORIZON = 55.0
"""Simulated time for the first separation, s."""
SETTLED = Parameters(N=300.0, Omega=20.0)
SETTLED_AT = 250.0
"""Begin of the motion that is examined long after a separation, s."""
SETTLED_SPAN = 5.0
"""Its length, s: a little more than two periods."""
AFTER_SEPARATION = ("separation_rate", "disc_range", "period")
"""Names of the answers of `after_separation`."""
WATCHED = 3.0
"""Time of a run from which on it is not repeated without watching the disc, s."""


def first_separation(
    solve: Solve, budget: float, p: Parameters = SEPARATING, horizon: float = SEPARATION_HORIZON
) -> Replies:
    """Reply when contact is first lost after the static start, s.

    Parameters
    ----------
    solve, budget : the method, and its budget, s
    p : the case
    horizon : simulated time, s
    """
    problem = Problem(p, static_start(p), horizon, stop=True)
    result, seconds = _timed(solve, problem, budget)
    times = _times(result, "separation")
    first = times[0] if len(times) else math.nan
    missing = f"no separation within {horizon:g} s"
    return {"first_separation": reply_of(first, seconds, missing, result)}


def after_separation(
    solve: Solve, budget: float, p: Parameters = SETTLED, start: State | None = None
) -> Replies:
    """Reply what the motion is like long after contact was first lost.

    The answers are separations per second, the disc's range, m, and the period in releases.

    Parameters
    ----------
    solve, budget : the method, and its budget, s
    p : the case
    start : state at which the motion begins; the stored one if None
    """
    if start is None:
        start = read_state(stored("answers")["starts"]["settled"])
    problem = Problem(p, start, start.time + SETTLED_SPAN, watched=True)
    result = solve(problem, budget)
    seconds = result.seconds
    if seconds < WATCHED:  # without the disc's range, for which some methods make a call per step
        _, seconds = _timed(solve, Problem(p, start, problem.t_end), budget)
    if result.outcome is not RunStatus.FINISHED:
        return dict.fromkeys(AFTER_SEPARATION, reply_of(math.nan, seconds, "", result))

    low, high = result.heights
    gaps = np.diff(_times(result, "stick_to_slip"))
    # equal if they differ by less than a thousandth of the largest
    same = 1e-3 * np.max(gaps, initial=0.0)
    period = classify.shortest_period(gaps, same, near_return=np.inf) or math.nan
    rate = result.kinds.count("separation") / problem.span
    missing = "the motion does not repeat"
    values = zip(AFTER_SEPARATION, (rate, high - low, period), strict=True)
    return {name: reply_of(value, seconds, missing) for name, value in values}


# ---- The speed of onset

ONSET_BETWEEN = (14.6, 15.6)
"""Interval of the search, rad/s."""
ONSET_WITHIN = 0.02
"""Its precision, rad/s."""
ONSET_HORIZON = 65.0
"""Simulated time, s: at 15.09 rad/s contact is lost after 56 s, at 15.08 not within 300 s."""


def onset(solve: Solve, budget: float, within: float = ONSET_WITHIN) -> Replies:
    """Reply which is the lowest speed that leads to a separation, rad/s, by bisection.

    Parameters
    ----------
    solve, budget : the method, and its budget for all runs, s
    within : width of the final bracket, of which the answer is the middle, rad/s
    """
    used = 0.0

    def separates(speed: float) -> bool:
        nonlocal used
        p = SEPARATING.replace(Omega=speed)
        problem = Problem(p, static_start(p), ONSET_HORIZON, stop=True)
        result = solve(problem, max(budget - used, LEAST_BUDGET))
        used += result.seconds
        return _separates(result)

    low, high = ONSET_BETWEEN
    try:
        if not separates(high):
            return {"onset": reply_of(math.nan, used, f"no separation at {high:g} rad/s")}
        if separates(low):
            return {"onset": reply_of(math.nan, used, f"a separation already at {low:g} rad/s")}
        while high - low > within:
            middle = 0.5 * (low + high)
            if separates(middle):
                high = middle
            else:
                low = middle
        reply = reply_of(0.5 * (low + high), used, "")
    except Broken as broken:
        reply = reply_of(math.nan, used, "", *broken.args)
    return {"onset": reply._replace(low=low, high=high)}


# ---- The growth of a deviation from the cycle

GROWING = Parameters(N=200.0, Omega=20.0)
GROWING_AT = 100.0
"""Begin of the motion that is examined, s; by then one deviation is left that grows."""
GROWING_SPAN = 10.0
"""Its length, s."""
FEWEST_RELEASES = 64
PADDED = 8
"""Factor by which the spectrum of the stretches is finer than their number."""


def growth_rate(solve: Solve, budget: float) -> Replies:
    """Reply at which rate a deviation from the cycle grows, 1/s, from the stretches of releases."""
    start = read_state(stored("answers")["starts"]["growing"])
    problem = Problem(GROWING, start, start.time + GROWING_SPAN)
    result, seconds = _timed(solve, problem, budget)
    rate = math.nan
    if result.outcome is RunStatus.FINISHED:
        rate = growth(_times(result, "stick_to_slip"))
    missing = "no oscillation that grows or dies out steadily"
    return {"growth_rate": reply_of(rate, seconds, missing, result)}


def growth(releases: Array) -> float:
    """Return the growth rate of an oscillation in the stretches between releases, 1/s.

    It is fitted by least squares, and nan if there is no oscillation.

    Parameters
    ----------
    releases : their times, s
    """
    if len(releases) < FEWEST_RELEASES:
        return math.nan
    gaps = np.diff(releases)
    times = 0.5 * (releases[1:] + releases[:-1])
    times = times - times.mean()
    size = float(np.std(gaps))
    if size == 0.0:
        return math.nan
    y = (gaps - gaps.mean()) / size

    omega = _strongest_oscillation(y, float(np.ptp(times)))
    basis = np.column_stack([np.cos(omega * times), np.sin(omega * times), np.ones_like(times)])
    coefficients = np.linalg.lstsq(basis, y, rcond=None)[0]
    try:
        fitted, _ = curve_fit(_oscillation, times, y, p0=[0.0, omega, *coefficients])
    except RuntimeError:
        return math.nan
    return float(fitted[0])


def _strongest_oscillation(y: Array, span: float) -> float:
    """Return the circular frequency of the strongest oscillation of a signal, rad/s.

    Parameters
    ----------
    y : samples of the signal, evenly in time
    span : between the first and the last, s
    """
    points = PADDED * len(y)
    spectrum = np.abs(np.fft.rfft(y * np.hanning(len(y)), points))
    # peaks of the whole spectrum: a slow drift stands highest where it would be cut off
    peaks, _ = find_peaks(spectrum)
    peaks = peaks[peaks >= PADDED]
    line = peaks[np.argmax(spectrum[peaks])]
    return 2.0 * math.pi * line / points * (len(y) - 1) / span


def _oscillation(
    t: Array, rate: float, omega: float, cosine: float, sine: float, rest: float
) -> Array:
    """Return an oscillation that grows, at times.

    Parameters
    ----------
    t : times, s
    rate : growth rate, 1/s
    omega : circular frequency, rad/s
    cosine, sine : amplitudes at time 0
    rest : mean
    """
    swing = cosine * np.cos(omega * t) + sine * np.sin(omega * t)
    return np.asarray(np.exp(rate * t) * swing + rest)


# ---- A region of the map over speed and preload

SIDE = 32
"""Number of cells of the region along each axis."""
REGION_SPEEDS = (14.0, 34.0)
"""rad/s"""
REGION_LOADS = (480.0, 600.0)
"""N"""
REGION_HORIZON = 25.0
"""Simulated time, s."""
TRIED = 4
"""Number of cells from which the affordable number is estimated."""
FEWEST_CELLS = 16
"""Number of cells below which there is no answer."""
SEED = 20


def region(solve: Solve, budget: float) -> Replies:
    """Reply whether cells lead to a separation; the answer is the share that is judged wrongly."""
    right = [letter == "1" for row in stored("answers")["region"] for letter in row]
    return {"region": judged(partial(cell, solve, budget), right.__getitem__, budget)}


def judged(
    judge: Callable[[int], tuple[bool, float]],
    right: Callable[[int], bool],
    budget: float,
    most: int = SIDE * SIDE,
) -> Reply:
    """Return the reply on the region from replies on its cells.

    If the budget is too small for all cells, a power of two of them is drawn at random with a fixed
    seed. The answer then has Wilson's interval of 95 %. The time is extrapolated to all cells.

    Parameters
    ----------
    judge : of a cell's index, whether it separates, and the seconds that took
    right : of a cell's index, the right answer
    budget : seconds
    most : greatest number of cells that are examined
    """
    indices = np.random.default_rng(SEED).permutation(SIDE * SIDE).tolist()
    wrong = 0
    spent = 0.0
    examined = 0

    def examine(some: Iterable[int]) -> None:
        nonlocal wrong, spent, examined
        for index in some:
            separates, seconds = judge(index)
            wrong += separates != right(index)
            spent += seconds
            examined += 1

    try:
        examine(indices[:TRIED])
        each = spent / TRIED
        affordable = budget / max(each, 1e-9)
        count = min(most, 2 ** int(math.log2(max(1.0, affordable))))
        if count < FEWEST_CELLS:
            message = f"{each:.3g} s a cell"
            seconds = each * len(indices)
            return Reply(math.nan, seconds, AnswerStatus.TOO_SLOW, message, cells=TRIED)
        examine(indices[TRIED:count])
    except Broken as broken:
        return reply_of(math.nan, spent, "", *broken.args)._replace(cells=examined)

    part = wrong / count
    low = high = part
    if count < len(indices):
        _, low, high = classify.share(wrong, count)
    seconds = spent / count * len(indices)
    return Reply(part, seconds, AnswerStatus.FOUND, "", low, high, count)


def cell(solve: Solve, budget: float, index: int, **model: Any) -> tuple[bool, float]:
    """Return whether a cell of the region separates, and the seconds that took.

    Parameters
    ----------
    solve, budget : the method, and its budget, s
    index : of the cell, 0 to `SIDE`^2 - 1, speeds first
    model : parameters of the modes
    """
    row, column = divmod(index, SIDE)
    load = float(np.linspace(*REGION_LOADS, SIDE)[row])
    speed = float(np.linspace(*REGION_SPEEDS, SIDE)[column])
    p = Parameters(N=load, Omega=speed, **model)
    problem = Problem(p, static_start(p), REGION_HORIZON, stop=True)
    result = solve(problem, budget)
    return _separates(result), result.seconds


ASKED: Mapping[str, tuple[Callable[[Solve, float], Replies], float]] = {
    "first_separation": (first_separation, 10.0),
    "after_separation": (after_separation, 6.0),
    "onset": (onset, 12.0),
    "growth_rate": (growth_rate, 6.0),
    "region": (region, 8.0),
}
"""Questions to a method, each with the budget at one setting, s."""
