"""The questions that methods are compared by, their correct answers, and how a method that integrates replies to them.

``first_separation``
    N = 385 N, Omega = 15.1 rad/s: when contact is lost for the first time after the static start
``separation_rate``, ``disc_range``, ``period``
    N = 300 N, Omega = 20 rad/s, long after contact was first lost: separations per second, how far the disc moves under
    the slider, and after how many releases from stick the motion repeats
``onset``
    N = 385 N: lowest speed from which the static start leads to a separation within `ONSET_HORIZON` s; by
    continuation of the cycle, the fold in which the quiet cycle ends
``growth_rate``
    N = 200 N, Omega = 20 rad/s: how fast a small deviation from the stick-slip cycle grows
``region``
    `SIDE` x `SIDE` cells of speed and preload: share of the cells for which it is said wrongly whether the static
    start leads to a separation within `REGION_HORIZON` s

Correct answers are stored in ``data/answers.json`` with their errors. The script
``tests/references/make_answer_references.py`` computes them with methods that share no code with the engine.
"""

import enum
import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import curve_fit
from scipy.signal import find_peaks

from disc_model.analysis.classify import shortest_period
from disc_model.analysis.sobol import share
from disc_model.benchmarks.methods import Method
from disc_model.benchmarks.methods.base import MethodResult, Problem, RunStatus
from disc_model.benchmarks.scenes import read_state, stored
from disc_model.benchmarks.study import TABLES
from disc_model.parameters import Parameters
from disc_model.simulation.states import State, static_start

SEPARATING = Parameters(N=385.0, Omega=15.1)
SETTLED = Parameters(N=300.0, Omega=20.0)
GROWING = Parameters(N=200.0, Omega=20.0)

SEPARATION_HORIZON = 55.0
"""Simulated time for the first separation, s."""
SETTLED_AT, SETTLED_SPAN = 250.0, 5.0
"""Begin and length of the examined motion after separation, s: slightly more than two periods."""
ONSET_BETWEEN, ONSET_WITHIN = (14.6, 15.6), 0.02
"""Interval in which the onset speed is searched, and precision of the search, rad/s."""
ONSET_HORIZON = 65.0
"""Horizon of the onset, s; at 15.09 rad/s contact is lost after 56 s, at 15.08 rad/s not within 300 s."""
GROWING_AT, GROWING_SPAN = 100.0, 10.0
"""Begin and length of the examined motion, s; by then only a growing deviation is left."""
SIDE = 32
REGION_SPEEDS, REGION_LOADS = (14.0, 34.0), (480.0, 600.0)
REGION_HORIZON = 25.0


class Question(NamedTuple):
    """A question: its name in words, its unit, and the tolerance (in the unit) of a correct answer."""

    title: str
    units: str
    enough: float


QUESTIONS = {name: Question(*entry) for name, entry in TABLES["questions"].items()}


class AnswerStatus(enum.IntEnum):
    """Status of a question."""

    FOUND = 0
    NONE = 1  # the method ended well and says that there is no such thing
    TOO_SLOW = 2
    UNSTABLE = 3
    STALLED = 4
    FAILED = 5


class AnswerVerdict(enum.IntEnum):
    """Verdict on an answer; a wrong one comes without a warning."""

    RIGHT = 0
    WRONG = 1
    NO_ANSWER = 2


class Reply(NamedTuple):
    """An answer: value (nan without one), wall time (s), status, reason, bounds, and number of cells examined."""

    value: float
    seconds: float
    status: AnswerStatus
    message: str = ""
    low: float = math.nan
    high: float = math.nan
    cells: int = 0


def verdict(question: str, reply: Reply, right: float) -> AnswerVerdict:
    """Verdict on an answer: to deny an existing result is wrong, to give up is not."""
    if reply.status is AnswerStatus.NONE:
        return AnswerVerdict.RIGHT if math.isnan(right) else AnswerVerdict.WRONG
    if reply.status is not AnswerStatus.FOUND:
        return AnswerVerdict.NO_ANSWER
    return AnswerVerdict.RIGHT if abs(reply.value - right) <= QUESTIONS[question].enough else AnswerVerdict.WRONG


# ----------------------------------------------------------------------------------------------------
# Stored references


class Reference(NamedTuple):
    """A correct answer, its own error, and the method that computed it."""

    value: float
    error: float
    by: str


def reference(name: str) -> Reference:
    """The correct answer to a question, or ``fold``."""
    return Reference(**stored("answers")["references"][name])


def start_of(name: str) -> State:
    """State of the motion ``settled`` or ``growing``, from the engine at its tightest tolerance."""
    return read_state(stored("answers")["starts"][name])


def right_region() -> NDArray[np.bool_]:
    """Separation in each cell, shape (`SIDE`, `SIDE`), loads along the first axis."""
    return np.array([[letter == "1" for letter in row] for row in stored("answers")["region"]])


def cell_parameters(index: int) -> Parameters:
    """Parameters of a cell by its index in the region, 0 to `SIDE`^2 - 1."""
    load, speed = np.linspace(*REGION_LOADS, SIDE), np.linspace(*REGION_SPEEDS, SIDE)
    return Parameters(N=float(load[index // SIDE]), Omega=float(speed[index % SIDE]))


# ----------------------------------------------------------------------------------------------------
# Replies of a method that integrates, from the events that it finds. Each function receives a method at one setting,
# ``solve(problem, budget)``, and a budget in seconds for everything; it returns the replies by the name of the answer.

Array = NDArray[np.float64]
Solve = Callable[[Problem, float], MethodResult]
Replies = dict[str, Reply]

AFTER_SEPARATION = ("separation_rate", "disc_range", "period")
"""Names of the answers of `after_separation`."""
REPEATS = 3
"""Number of repeated quick runs; the fastest counts, since disturbances only add time."""
QUICK = 0.3
"""Longest time of a run that is repeated, s."""
TRIED = 4
"""Number of cells from which the affordable number is estimated."""


def setting_of(method: Method, value: float) -> Solve:
    """A method at one setting."""
    return lambda problem, budget: method.solve(problem, value, budget)


class Broken(Exception):
    """A run on which an answer depends did not reach its end."""

    def reply(self, seconds: float) -> Reply:
        """A reply without a value, and the reason."""
        (result,) = self.args
        name = "UNSTABLE" if result.outcome is RunStatus.NON_FINITE else result.outcome.name
        return Reply(math.nan, seconds, AnswerStatus[name], result.message or f"{result.outcome}")


def first_separation(
    solve: Solve,
    budget: float,
    p: Parameters = SEPARATING,
    horizon: float = SEPARATION_HORIZON,
) -> Replies:
    """Time of the first loss of contact after the static start."""
    problem = Problem(p, static_start(p), horizon, stop=True)
    result, seconds = _timed(solve, problem, budget)
    try:
        time = _separation(result)
    except Broken as broken:
        return {"first_separation": broken.reply(seconds)}
    return {"first_separation": reply_of(time, seconds, f"no separation within {horizon:g} s")}


def after_separation(solve: Solve, budget: float, p: Parameters = SETTLED, start: State | None = None) -> Replies:
    """Separations per second, the disc's range and the period, long after contact was first lost.

    The time leaves out the disc's range, for which some methods make a call per step.
    """
    start = start_of("settled") if start is None else start
    problem = Problem(p, start, start.time + SETTLED_SPAN, watched=True)
    result = solve(problem, budget)
    seconds = result.seconds
    if seconds < 3.0:
        _, seconds = _timed(solve, Problem(p, start, problem.t_end), budget)
    if result.outcome is not RunStatus.FINISHED:
        return dict.fromkeys(AFTER_SEPARATION, Broken(result).reply(seconds))
    low, high = result.heights
    values = (result.separations / problem.span, high - low, period(_times(result, "stick_to_slip")))
    missing = "the motion does not repeat"
    return {name: reply_of(value, seconds, missing) for name, value in zip(AFTER_SEPARATION, values, strict=True)}


def period(releases: Array) -> float:
    """Number of releases after which a motion repeats; nan if it does not within half of them.

    releases : times of the releases from stick, s
    """
    gaps = np.diff(releases)  # equal if they differ by less than a thousandth of the largest
    return float(shortest_period(gaps, 1e-3 * np.max(gaps, initial=0.0), near_return=np.inf) or np.nan)


def onset(solve: Solve, budget: float, within: float = ONSET_WITHIN) -> Replies:
    """Lowest speed that leads to a separation, by bisection; the answer is the middle of the final bracket.

    within : rad/s, width of that bracket
    """
    used = 0.0

    def separates(speed: float) -> bool:
        nonlocal used
        p = SEPARATING.replace(Omega=speed)
        result = solve(Problem(p, static_start(p), ONSET_HORIZON, stop=True), max(budget - used, 0.1))
        used += result.seconds
        return math.isfinite(_separation(result))

    low, high = ONSET_BETWEEN
    try:
        if not separates(high):
            return {"onset": Reply(math.nan, used, AnswerStatus.NONE, f"no separation at {high:g} rad/s")}
        if separates(low):
            return {"onset": Reply(math.nan, used, AnswerStatus.NONE, f"a separation already at {low:g} rad/s")}
        while high - low > within:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if separates(middle) else (middle, high)
    except Broken as broken:
        return {"onset": broken.reply(used)._replace(low=low, high=high)}
    return {"onset": Reply(0.5 * (low + high), used, AnswerStatus.FOUND, "", low, high)}


def growth_rate(solve: Solve, budget: float) -> Replies:
    """Rate at which a deviation from the cycle grows, from the stretches between releases."""
    start = start_of("growing")
    problem = Problem(GROWING, start, start.time + GROWING_SPAN)
    result, seconds = _timed(solve, problem, budget)
    if result.outcome is not RunStatus.FINISHED:
        return {"growth_rate": Broken(result).reply(seconds)}
    rate = growth(_times(result, "stick_to_slip"))
    return {"growth_rate": reply_of(rate, seconds, "no oscillation that grows or dies out steadily")}


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


def region(solve: Solve, budget: float) -> Replies:
    """Fraction of the cells with a wrong verdict.

    If the budget is too small for all cells, a power of two of them is drawn at random with a fixed seed. The answer
    then has Wilson's interval of 95 %.  The time is extrapolated to all cells.
    """
    right = right_region().ravel()
    return {"region": judged(lambda index: cell(solve, cell_parameters(index), budget), right.__getitem__, budget)}


def drawn() -> NDArray[np.int64]:
    """Indices of the cells, in the order of examination: random, with a fixed seed."""
    return np.random.default_rng(20).permutation(SIDE * SIDE)


def judged(
    judge: Callable[[int], tuple[bool, float]], right: Callable[[int], bool], budget: float, most: int = SIDE * SIDE
) -> Reply:
    """The answer as of `region`, for any function that judges a cell by its index: separation, and seconds taken.

    right : whether a cell separates, by its index
    most : number of cells to examine
    """
    indices = drawn()
    verdicts: list[tuple[bool, float]] = []
    try:
        verdicts += [judge(int(index)) for index in indices[:TRIED]]
        each = sum(seconds for _, seconds in verdicts) / TRIED
        count = min(most, 2 ** int(math.log2(max(1.0, budget / max(each, 1e-9)))))
        if count < 16:  # too few for an answer
            why = f"{each:.3g} s a cell"
            return Reply(math.nan, each * len(indices), AnswerStatus.TOO_SLOW, why, cells=TRIED)
        verdicts += [judge(int(index)) for index in indices[TRIED:count]]
    except Broken as broken:
        return broken.reply(sum(s for _, s in verdicts))._replace(cells=len(verdicts))
    wrong = sum(apart != right(int(index)) for (apart, _), index in zip(verdicts, indices, strict=False))
    part = float(wrong) / count
    low = high = part
    if count < len(indices):
        _, low, high = share(int(wrong), count)
    seconds = sum(s for _, s in verdicts) / count * len(indices)
    return Reply(part, seconds, AnswerStatus.FOUND, "", low, high, count)


def cell(solve: Solve, p: Parameters, budget: float) -> tuple[bool, float]:
    """Whether a case separates within the region's horizon, and the seconds that took."""
    result = solve(Problem(p, static_start(p), REGION_HORIZON, stop=True), budget)
    return math.isfinite(_separation(result)), result.seconds


ASKED: Mapping[str, tuple[Callable[[Solve, float], Replies], float]] = {
    "first_separation": (first_separation, 10.0),
    "after_separation": (after_separation, 6.0),
    "onset": (onset, 12.0),
    "growth_rate": (growth_rate, 6.0),
    "region": (region, 8.0),
}
"""By name: the function that answers, and the budget in s of a method at one setting."""


def ask(solve: Solve, name: str) -> Replies:
    """The replies to one of these questions."""
    function, budget = ASKED[name]
    return function(solve, budget)


def _timed(solve: Solve, problem: Problem, budget: float) -> tuple[MethodResult, float]:
    """A result and the least wall time (s); quick runs are repeated, since the first may have compiled."""
    results = [solve(problem, budget)]
    while results[-1].seconds < QUICK and len(results) <= REPEATS:
        results.append(solve(problem, budget))
    return results[0], min(result.seconds for result in results)


def reply_of(value: float, seconds: float, missing: str) -> Reply:
    """An answer; ``missing`` is the reason if it is nan."""
    if math.isfinite(value):
        return Reply(float(value), seconds, AnswerStatus.FOUND)
    return Reply(math.nan, seconds, AnswerStatus.NONE, missing)


def _times(result: MethodResult, kind: str) -> Array:
    return result.times[[event == kind for event in result.kinds]]


def _separation(result: MethodResult) -> float:
    """Time of the first separation (s), nan if the motion ended without one; raises `Broken` if it did not end."""
    times = _times(result, "separation")
    if len(times):
        return float(times[0])
    if result.outcome is not RunStatus.FINISHED:
        raise Broken(result)
    return math.nan
