"""Answers of a method that integrates, from the events that it finds.

Each function receives ``solve(problem, budget)``, a method at one setting, and a budget in seconds for everything. It
returns the answers by name.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import curve_fit
from scipy.signal import find_peaks

from disc_model.analysis.classify import shortest_period
from disc_model.analysis.sobol import share
from disc_model.benchmarks.answers import questions
from disc_model.benchmarks.answers.questions import SIDE, AnswerStatus, Found
from disc_model.benchmarks.methods import MethodResult, Problem, RunStatus
from disc_model.benchmarks.registry import Method
from disc_model.parameters import Parameters
from disc_model.simulation.api import static_start
from disc_model.simulation.result import State

Array = NDArray[np.float64]
Solve = Callable[[Problem, float], MethodResult]
Answers = dict[str, Found]

AFTER_SEPARATION = ("separation_rate", "disc_range", "period")
"""Names of the answers of `after_separation`."""
REPEATS = 3
"""Number of repeated quick runs; the fastest counts, since disturbances only add time."""
QUICK = 0.3
"""Longest time of a run that is repeated, s."""
TRIED = 4
"""Number of cells from which the affordable number is estimated."""


def by(method: Method, value: float) -> Solve:
    """A method at one setting."""
    return lambda problem, budget: method.solve(problem, value, budget)


class Broken(Exception):
    """A run on which an answer depends did not reach its end."""

    def __init__(self, result: MethodResult) -> None:
        super().__init__(result.message or f"{result.outcome}")
        name = result.outcome.name
        self.status = AnswerStatus["UNSTABLE" if name == "NON_FINITE" else name]

    def found(self, seconds: float) -> Found:
        """An answer without a value, and the reason."""
        return Found(math.nan, seconds, self.status, str(self))


def first_separation(
    solve: Solve,
    budget: float,
    p: Parameters = questions.SEPARATING,
    horizon: float = questions.SEPARATION_HORIZON,
) -> Answers:
    """Time of the first loss of contact after the static start."""
    problem = Problem(p, static_start(p), horizon, stop=True)
    result, seconds = _timed(solve, problem, budget)
    try:
        time = _separation(result)
    except Broken as broken:
        return {"first_separation": broken.found(seconds)}
    return {"first_separation": found(time, seconds, f"no separation within {horizon:g} s")}


def after_separation(
    solve: Solve, budget: float, p: Parameters = questions.SETTLED, start: State | None = None
) -> Answers:
    """Separations per second, the disc's range and the period, long after contact was first lost.

    The time leaves out the disc's range, for which some methods make a call per step.
    """
    start = questions.start("settled") if start is None else start
    problem = Problem(p, start, start.time + questions.SETTLED_SPAN, watched=True)
    result = solve(problem, budget)
    seconds = result.seconds
    if seconds < 3.0:
        _, seconds = _timed(solve, Problem(p, start, problem.t_end), budget)
    if result.outcome is not RunStatus.FINISHED:
        return dict.fromkeys(AFTER_SEPARATION, Broken(result).found(seconds))
    low, high = result.heights
    values = (result.separations / problem.span, high - low, period(_times(result, "stick_to_slip")))
    missing = "the motion does not repeat"
    return {name: found(value, seconds, missing) for name, value in zip(AFTER_SEPARATION, values, strict=True)}


def period(releases: Array) -> float:
    """Number of releases after which a motion repeats; nan if it does not within half of them.

    releases : times of the releases from stick, s
    """
    gaps = np.diff(releases)  # equal if they differ by less than a thousandth of the largest
    return float(shortest_period(gaps, 1e-3 * np.max(gaps, initial=0.0), near_return=np.inf) or np.nan)


def onset(solve: Solve, budget: float, within: float = questions.ONSET_WITHIN) -> Answers:
    """Lowest speed that leads to a separation, by bisection; the answer is the middle of the final bracket.

    within : rad/s, width of that bracket
    """
    used = 0.0

    def separates(speed: float) -> bool:
        nonlocal used
        p = questions.SEPARATING.replace(Omega=speed)
        result = solve(Problem(p, static_start(p), questions.ONSET_HORIZON, stop=True), max(budget - used, 0.1))
        used += result.seconds
        return math.isfinite(_separation(result))

    low, high = questions.ONSET_BETWEEN
    try:
        if not separates(high):
            return {"onset": Found(math.nan, used, AnswerStatus.NONE, f"no separation at {high:g} rad/s")}
        if separates(low):
            return {"onset": Found(math.nan, used, AnswerStatus.NONE, f"a separation already at {low:g} rad/s")}
        while high - low > within:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if separates(middle) else (middle, high)
    except Broken as broken:
        return {"onset": broken.found(used)._replace(low=low, high=high)}
    return {"onset": Found(0.5 * (low + high), used, AnswerStatus.FOUND, "", low, high)}


def growth_rate(solve: Solve, budget: float) -> Answers:
    """Rate at which a deviation from the cycle grows, from the stretches between releases."""
    start = questions.start("growing")
    problem = Problem(questions.GROWING, start, start.time + questions.GROWING_SPAN)
    result, seconds = _timed(solve, problem, budget)
    if result.outcome is not RunStatus.FINISHED:
        return {"growth_rate": Broken(result).found(seconds)}
    rate = growth(_times(result, "stick_to_slip"))
    return {"growth_rate": found(rate, seconds, "no oscillation that grows or dies out steadily")}


def growth(releases: Array) -> float:
    """Rate (1/s) of an oscillation in the stretches between releases (s), by least squares; nan if there is none."""
    if len(releases) < 64:
        return math.nan
    gaps, times = np.diff(releases), 0.5 * (releases[1:] + releases[:-1])
    times = times - times.mean()
    size = float(np.std(gaps))
    if size == 0.0:
        return math.nan
    y = (gaps - gaps.mean()) / size
    spectrum = np.abs(np.fft.rfft(y * np.hanning(len(y)), 8 * len(y)))
    # of the whole spectrum: a slow drift stands highest where it would be cut off
    peaks = find_peaks(spectrum)[0]
    peaks = peaks[peaks >= 8]
    if not peaks.size:
        return math.nan
    line = peaks[np.argmax(spectrum[peaks])]
    omega = 2.0 * math.pi * line / (8 * len(y)) * (len(times) - 1) / float(np.ptp(times))

    def model(t: Array, rate: float, omega: float, cosine: float, sine: float, rest: float) -> Array:
        return np.asarray(np.exp(rate * t) * (cosine * np.cos(omega * t) + sine * np.sin(omega * t)) + rest)

    basis = np.column_stack([np.cos(omega * times), np.sin(omega * times), np.ones_like(times)])
    first = np.linalg.lstsq(basis, y, rcond=None)[0]
    try:
        fitted = curve_fit(model, times, y, p0=[0.0, omega, *first])[0]
    except RuntimeError:
        return math.nan
    return float(fitted[0])


def region(solve: Solve, budget: float) -> Answers:
    """Fraction of the cells with a wrong verdict.

    If the budget is too small for all cells, a power of two of them is drawn at random with a fixed seed. The answer
    then has Wilson's interval of 95 %.  The time is extrapolated to all cells.
    """
    right = questions.region().ravel()
    return {"region": judged(lambda place: cell(solve, questions.cell(place), budget), right.__getitem__, budget)}


def drawn() -> NDArray[np.int64]:
    """Indices of the cells, in the order of examination: random, with a fixed seed."""
    return np.random.default_rng(20).permutation(SIDE * SIDE)


def judged(
    judge: Callable[[int], tuple[bool, float]], right: Callable[[int], bool], budget: float, most: int = SIDE * SIDE
) -> Found:
    """The answer as of `region`, for any function that judges a cell by its index: separation, and seconds taken.

    right : whether a cell separates, by its index
    most : number of cells to examine
    """
    places = drawn()
    verdicts: list[tuple[bool, float]] = []
    try:
        verdicts += [judge(int(place)) for place in places[:TRIED]]
        each = sum(seconds for _, seconds in verdicts) / TRIED
        count = min(most, 2 ** int(math.log2(max(1.0, budget / max(each, 1e-9)))))
        if count < 16:  # too few for an answer
            why = f"{each:.3g} s a cell"
            return Found(math.nan, each * len(places), AnswerStatus.TOO_SLOW, why, cells=TRIED)
        verdicts += [judge(int(place)) for place in places[TRIED:count]]
    except Broken as broken:
        return broken.found(sum(s for _, s in verdicts))._replace(cells=len(verdicts))
    wrong = sum(apart != right(int(place)) for (apart, _), place in zip(verdicts, places, strict=False))
    part = float(wrong) / count
    low = high = part
    if count < len(places):
        _, low, high = share(int(wrong), count)
    seconds = sum(s for _, s in verdicts) / count * len(places)
    return Found(part, seconds, AnswerStatus.FOUND, "", low, high, count)


def cell(solve: Solve, p: Parameters, budget: float) -> tuple[bool, float]:
    """Whether a case separates within the region's horizon, and the seconds that took."""
    result = solve(Problem(p, static_start(p), questions.REGION_HORIZON, stop=True), budget)
    return math.isfinite(_separation(result)), result.seconds


ASKED: Mapping[str, tuple[Callable[[Solve, float], Answers], float]] = {
    "first_separation": (first_separation, 10.0),
    "after_separation": (after_separation, 6.0),
    "onset": (onset, 12.0),
    "growth_rate": (growth_rate, 6.0),
    "region": (region, 8.0),
}
"""By name: the function that answers, and the budget in s of a method at one setting."""


def ask(solve: Solve, name: str) -> Answers:
    """The answers to one of these questions."""
    question, budget = ASKED[name]
    return question(solve, budget)


def _timed(solve: Solve, problem: Problem, budget: float) -> tuple[MethodResult, float]:
    """A result and the least wall time (s); quick runs are repeated, since the first may have compiled."""
    results = [solve(problem, budget)]
    while results[-1].seconds < QUICK and len(results) <= REPEATS:
        results.append(solve(problem, budget))
    return results[0], min(result.seconds for result in results)


def found(value: float, seconds: float, missing: str) -> Found:
    """An answer; ``missing`` is the reason if it is nan."""
    if math.isfinite(value):
        return Found(float(value), seconds, AnswerStatus.FOUND)
    return Found(math.nan, seconds, AnswerStatus.NONE, missing)


def _times(result: MethodResult, kind: str) -> Array:
    return result.times[[one == kind for one in result.kinds]]


def _separation(result: MethodResult) -> float:
    """Time of the first separation (s), nan if the motion ended without one; raises `Broken` if it did not end."""
    times = _times(result, "separation")
    if len(times):
        return float(times[0])
    if result.outcome is not RunStatus.FINISHED:
        raise Broken(result)
    return math.nan
