"""What answers cost: questions to methods, their replies at several settings, and verdicts on them."""

import math
import time as clock
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import curve_fit
from scipy.signal import find_peaks

from benchmarks.machine import stamped
from benchmarks.methods import METHODS
from benchmarks.methods.integrators import Array, MethodResult, Problem, RunStatus
from benchmarks.scenes import read_state, stored
from disc_model.analysis import classify
from disc_model.parameters import Parameters
from disc_model.simulation.states import static_start
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import floquet

Solve = Callable[[Problem, float], MethodResult]
"""A method at a setting: integrates a problem within a budget in s."""
Values = Mapping[str, float]
"""Answers by the name of the question, nan if there is none."""


class Question(NamedTuple):
    """What is asked."""

    title: str
    unit: str
    enough: float
    """Greatest error of a correct answer, in the unit."""


QUESTIONS = {
    # the paper gives the first separation to 0.1 s and its critical speed to 0.1 rad/s
    "first_separation": Question("first separation", "s", 0.1),
    "separation_rate": Question("separations per second", "1/s", 1.0),
    "period": Question("period in releases", "1", 0.5),
    "onset": Question("speed of onset", "rad/s", 0.1),
    "growth_rate": Question("growth rate", "1/s", 1e-3),
}
SEPARATING = Parameters(N=385.0, Omega=15.1)
SEPARATION_HORIZON = 55.0
"""Simulated time for the first separation, s."""
SETTLED = Parameters(N=300.0, Omega=20.0)
SETTLED_SPAN = 5.0
"""Length of the motion that is examined long after a separation, s: a little over two periods."""
GROWING = Parameters(N=200.0, Omega=20.0)
GROWING_SPAN = 10.0
"""Length of the motion from which a growth rate is found, s; only one deviation is left that grows."""
FEWEST_RELEASES = 64
ONSET_BETWEEN = (14.6, 15.6)
"""Interval of the search for the onset, rad/s."""
ONSET_WITHIN = 0.02
"""Its precision, rad/s."""
ONSET_HORIZON = 65.0
"""Simulated time, s: at 15.09 rad/s contact is lost after 56 s, at 15.08 not within 300 s."""
CYCLE_SETTINGS = (1e-6, 1e-8, 1e-10, 1e-12)
"""Tolerances of the search for a cycle."""
FOLD_FROM = 14.8
"""Speed at which the quiet cycle is followed from, rad/s."""
FOLD_BETWEEN = (14.5, 16.0)
"""Speeds between which it is followed, rad/s."""
QUICK = 0.3
"""Longest time of a question that is asked twice, s."""
PADDED = 8
"""Factor by which a spectrum is finer than the number of its samples."""


class Broken(Exception):
    """A run on which an answer depends did not reach its end; the argument is its result."""


def answers(method: str, settings: Sequence[float] | None = None) -> pd.DataFrame:
    """Ask a method all questions, and judge its replies.

    To deny an existing result is wrong, to give up is not. A question for which a method is too slow
    is not asked at finer settings.

    Parameters
    ----------
    method : its name, or ``cycle``, which finds onset and growth rate without a simulation
    settings : from coarse to fine; those of the scene ``stick_slip`` if None

    Returns
    -------
    table : a row for each answer: ``found`` and ``right`` in the question's unit, ``error``, processor
        ``seconds``, the ``verdict`` right, wrong or no answer, and why there is none
    """
    asked = CYCLE_ASKED if method == "cycle" else ASKED
    if settings is None:
        settings = CYCLE_SETTINGS if method == "cycle" else METHODS[method].settings["stick_slip"]
    rows = []
    hopeless = set()
    for value in settings:
        for ask, (names, budget) in asked.items():
            if ask in hopeless:
                continue
            reason = ""
            try:
                found, seconds = ask(_setting_of(method, value), budget)
                if seconds < QUICK:  # the first run may have compiled, disturbances only add time
                    _, again = ask(_setting_of(method, value), budget)
                    seconds = min(seconds, again)
            except Broken as broken:
                result: MethodResult = broken.args[0]
                found = {}
                seconds = result.seconds
                reason = f"{result.outcome}"
                if result.outcome is RunStatus.TOO_SLOW:
                    hopeless.add(ask)
            for name in names:
                answer = found.get(name, math.nan)
                row = {"question": name, "line": method, "setting": value, "found": answer}
                row |= {"seconds": seconds, "reason": reason}
                rows.append({**row, **judged(name, answer, reason)})
    return stamped(pd.DataFrame(rows))


def judged(question: str, found: float, reason: str = "") -> dict[str, float | str]:
    """Return the right answer to a question, the error of an answer, and the verdict on it.

    Parameters
    ----------
    question : its name
    found : the answer, nan if it is that there is none
    reason : why there is no answer
    """
    right = stored("answers")["references"][question]["value"]
    error = abs(found - right)
    verdict = "right" if error <= QUESTIONS[question].enough else "wrong"
    return {"right": right, "error": error, "verdict": "no answer" if reason else verdict}


def _setting_of(method: str, value: float) -> Solve | float:
    """Return a method at a value of its setting, or the tolerance of the search for a cycle."""
    if method == "cycle":
        return value
    return lambda problem, budget: METHODS[method].solve(problem, value, budget)


def _finished(result: MethodResult) -> MethodResult:
    """Return the result of a run; raises `Broken` if it did not reach its end."""
    if result.outcome is not RunStatus.FINISHED:
        raise Broken(result)
    return result


def _separates(result: MethodResult) -> bool:
    """Return whether contact is lost; raises `Broken` if the motion ended before it could be."""
    return "separation" in result.kinds or "separation" in _finished(result).kinds


def _times(result: MethodResult, kind: str) -> Array:
    """Return the times of one kind of event, s."""
    return result.times[[event == kind for event in result.kinds]]


# ---- Questions


def first_separation(solve: Solve, budget: float) -> tuple[Values, float]:
    """Return when contact is first lost after the static start, s, and the seconds that took."""
    problem = Problem(SEPARATING, static_start(SEPARATING), SEPARATION_HORIZON, stop=True)
    result = solve(problem, budget)
    first = _times(result, "separation")[0] if _separates(result) else math.nan
    return {"first_separation": float(first)}, result.seconds


def after_separation(solve: Solve, budget: float) -> tuple[Values, float]:
    """Return what the motion is like long after contact was first lost.

    The answers are separations per second, and the period in releases.
    """
    start = read_state(stored("answers")["starts"]["settled"])
    problem = Problem(SETTLED, start, start.time + SETTLED_SPAN)
    result = _finished(solve(problem, budget))
    gaps = np.diff(_times(result, "stick_to_slip"))
    # equal if they differ by less than a thousandth of the largest
    same = 1e-3 * np.max(gaps, initial=0.0)
    period = classify.shortest_period(gaps, same, near_return=np.inf) or math.nan
    rate = result.kinds.count("separation") / problem.span
    return {"separation_rate": rate, "period": float(period)}, result.seconds


def onset(solve: Solve, budget: float, within: float = ONSET_WITHIN) -> tuple[Values, float]:
    """Return the lowest speed that leads to a separation, rad/s, by bisection.

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
        result = solve(problem, max(budget - used, 0.1))
        used += result.seconds
        return _separates(result)

    low, high = ONSET_BETWEEN
    if not separates(high) or separates(low):
        return {"onset": math.nan}, used
    while high - low > within:
        middle = 0.5 * (low + high)
        if separates(middle):
            high = middle
        else:
            low = middle
    return {"onset": 0.5 * (low + high)}, used


def growth_rate(solve: Solve, budget: float) -> tuple[Values, float]:
    """Return at which rate a deviation from the cycle grows, 1/s, from the stretches of releases."""
    start = read_state(stored("answers")["starts"]["growing"])
    problem = Problem(GROWING, start, start.time + GROWING_SPAN)
    result = _finished(solve(problem, budget))
    return {"growth_rate": growth(_times(result, "stick_to_slip"))}, result.seconds


def growth(releases: Array) -> float:
    """Return the growth rate of an oscillation in the stretches between releases, 1/s.

    It is fitted by least squares, and nan if there is no oscillation.

    Parameters
    ----------
    releases : their times, s
    """
    gaps = np.diff(releases)
    if len(releases) < FEWEST_RELEASES or np.ptp(gaps) == 0.0:
        return math.nan
    times = 0.5 * (releases[1:] + releases[:-1])
    times = times - times.mean()
    y = (gaps - gaps.mean()) / gaps.std()

    # the strongest oscillation begins the fit; a slow drift stands highest where it is cut off
    points = PADDED * len(y)
    spectrum = np.abs(np.fft.rfft(y * np.hanning(len(y)), points))
    peaks, _ = find_peaks(spectrum)
    peaks = peaks[peaks >= PADDED]
    turns = peaks[np.argmax(spectrum[peaks])] / points * (len(y) - 1)
    omega = 2.0 * math.pi * turns / float(np.ptp(times))

    def oscillation(t: Array, rate: float, omega: float, *amplitudes: float) -> Array:
        cosine, sine, rest = amplitudes
        swing = cosine * np.cos(omega * t) + sine * np.sin(omega * t)
        return np.asarray(np.exp(rate * t) * swing + rest)

    basis = np.column_stack([np.cos(omega * times), np.sin(omega * times), np.ones_like(times)])
    amplitudes = np.linalg.lstsq(basis, y, rcond=None)[0]
    try:
        fitted, _ = curve_fit(oscillation, times, y, p0=[0.0, omega, *amplitudes])
    except RuntimeError:
        return math.nan
    return float(fitted[0])


def cycle_onset(tol: float, _: float) -> tuple[Values, float]:
    """Return at which speed the first fold of the quiet cycle is, rad/s, above 14.5 rad/s."""
    began = clock.thread_time()
    start = SEPARATING.replace(Omega=FOLD_FROM)
    folds = continue_cycle(start, "Omega", FOLD_BETWEEN, direction=1, tol=tol).folds
    speed = float(folds[0]) if len(folds) else math.nan
    return {"onset": speed}, clock.thread_time() - began


def cycle_growth(tol: float, _: float) -> tuple[Values, float]:
    """Return the growth rate of disturbances of the stick-slip cycle, 1/s, by its multipliers."""
    floquet(GROWING, tol=tol)  # may compile
    began = clock.thread_time()
    rate = float(floquet(GROWING, tol=tol).growth_rate)
    return {"growth_rate": rate}, clock.thread_time() - began


ASKED: Mapping[Callable[..., tuple[Values, float]], tuple[Sequence[str], float]] = {
    first_separation: (("first_separation",), 10.0),
    after_separation: (("separation_rate", "period"), 6.0),
    onset: (("onset",), 12.0),
    growth_rate: (("growth_rate",), 6.0),
}
"""Questions to a method, with the names of their answers, and the budget at one setting, s."""
CYCLE_ASKED: Mapping[Callable[..., tuple[Values, float]], tuple[Sequence[str], float]] = {
    cycle_onset: (("onset",), math.inf),
    cycle_growth: (("growth_rate",), math.inf),
}
"""Questions that the cycle itself answers."""
