"""What each answer costs: questions that methods are compared by, their correct answers, and
replies to them.

Of a method the tolerance or step varies. The line ``cycle`` finds onset and growth rate without a
simulation. In the lines ``rigid`` and ``residual`` the number of nodal diameters varies, and errors
are distances from the `RICHEST`.
"""

import enum
import math
import time as clock
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache, partial
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from scipy.optimize import curve_fit
from scipy.signal import find_peaks

from disc_model.analysis.classify import share, shortest_period
from disc_model.benchmarks.methods import METHODS, Method
from disc_model.benchmarks.methods.integrators import Array, MethodResult, Problem, RunStatus
from disc_model.benchmarks.scenes import read_state, stored
from disc_model.benchmarks.study import CONTACTS, TABLES, Flags, Row, run
from disc_model.benchmarks.work_precision import (
    DEFAULT,
    REFERENCE_TOL,
    MapSettings,
    map_settings,
    with_facts,
)
from disc_model.data.dataset import json_attribute
from disc_model.data.variables import CycleStatus, flag_names
from disc_model.errors import ParameterError
from disc_model.mode_choice import real_modes
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import State, static_start
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import floquet

SEPARATING = Parameters(N=385.0, Omega=15.1)
SETTLED = Parameters(N=300.0, Omega=20.0)
GROWING = Parameters(N=200.0, Omega=20.0)
SEPARATION_HORIZON = 55.0  # simulated time for the first separation, s
SETTLED_AT, SETTLED_SPAN = (
    250.0,
    5.0,
)  # begin and length of the examined motion, s: a little more than two periods
ONSET_BETWEEN, ONSET_WITHIN = (
    (14.6, 15.6),
    0.02,
)  # interval and precision of the search for the onset, rad/s
ONSET_HORIZON = (
    65.0  # s; at 15.09 rad/s contact is lost after 56 s, at 15.08 rad/s not within 300 s
)
GROWING_AT, GROWING_SPAN = (
    100.0,
    10.0,
)  # the same of a motion from a cycle; by then one deviation is left that grows
SIDE = 32  # number of cells of the region along each axis
REGION_SPEEDS, REGION_LOADS = (14.0, 34.0), (480.0, 600.0)  # rad/s, N
REGION_HORIZON = 25.0  # s
QUESTIONS: dict[str, dict[str, Any]] = TABLES["questions"]
"""Name in words, unit, and the tolerance (in the unit) of a correct answer."""


AnswerStatus = enum.IntEnum("AnswerStatus", "FOUND NONE TOO_SLOW UNSTABLE STALLED FAILED", start=0)
"""NONE: the method ended well and says that there is no such thing."""
AnswerVerdict = enum.IntEnum("AnswerVerdict", "RIGHT WRONG NO_ANSWER", start=0)
FLAGS: Flags = {"status": AnswerStatus, "verdict": AnswerVerdict}


class Reply(NamedTuple):
    """An answer: value (nan without one), wall time (s), status, reason, bounds, and number of
    cells examined."""

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
    return (
        AnswerVerdict.RIGHT
        if abs(reply.value - right) <= QUESTIONS[question]["enough"]
        else AnswerVerdict.WRONG
    )


def reference(name: str) -> SimpleNamespace:
    """The correct answer to a question, or ``fold``: its ``value``, its ``error``, and ``by`` which
    other method."""
    return SimpleNamespace(**stored("answers")["references"][name])


# ---- Replies of a method that integrates, by the name of the answer, from the events that it finds
# within a budget (s)
Solve = Callable[[Problem, float], MethodResult]
Replies = dict[str, Reply]
AFTER_SEPARATION = (
    "separation_rate",
    "disc_range",
    "period",
)  # names of the answers of `after_separation`
REPEATS = 3  # number of repeated quick runs; the fastest counts, since disturbances only add time
QUICK = 0.3  # longest time of a run that is repeated, s
TRIED = 4  # number of cells from which the affordable number is estimated


def setting_of(method: Method, value: float) -> Solve:
    return lambda problem, budget: method.solve(problem, value, budget)


class Broken(Exception):
    """The result of a run on which an answer depends, and which did not reach its end."""


def first_separation(
    solve: Solve, budget: float, p: Parameters = SEPARATING, horizon: float = SEPARATION_HORIZON
) -> Replies:
    """Time of the first loss of contact after the static start."""
    result, seconds = _timed(solve, Problem(p, static_start(p), horizon, stop=True), budget)
    times = _times(result, "separation")
    missing = f"no separation within {horizon:g} s"
    return {
        "first_separation": reply_of(times[0] if len(times) else math.nan, seconds, missing, result)
    }


def after_separation(
    solve: Solve, budget: float, p: Parameters = SETTLED, start: State | None = None
) -> Replies:
    """Separations per second, the disc's range and the period in releases, long after contact was
    first lost."""
    start = start or read_state(stored("answers")["starts"]["settled"])
    problem = Problem(p, start, start.time + SETTLED_SPAN, watched=True)
    result = solve(problem, budget)
    seconds = result.seconds
    if seconds < 3.0:  # without the disc's range, for which some methods make a call per step
        _, seconds = _timed(solve, Problem(p, start, problem.t_end), budget)
    if result.outcome is not RunStatus.FINISHED:
        return dict.fromkeys(AFTER_SEPARATION, reply_of(math.nan, seconds, "", result))
    low, high = result.heights
    gaps = np.diff(
        _times(result, "stick_to_slip")
    )  # equal if they differ by less than a thousandth of the largest
    repeats = (
        shortest_period(gaps, 1e-3 * np.max(gaps, initial=0.0), near_return=np.inf) or math.nan
    )
    values = (result.kinds.count("separation") / problem.span, high - low, repeats)
    missing = "the motion does not repeat"
    return {
        name: reply_of(value, seconds, missing)
        for name, value in zip(AFTER_SEPARATION, values, strict=True)
    }


def onset(solve: Solve, budget: float, within: float = ONSET_WITHIN) -> Replies:
    """Lowest speed that leads to a separation, by bisection: the middle of a final bracket of this
    width (rad/s)."""
    used = 0.0

    def separates(speed: float) -> bool:
        nonlocal used
        p = SEPARATING.replace(Omega=speed)
        result = solve(
            Problem(p, static_start(p), ONSET_HORIZON, stop=True), max(budget - used, 0.1)
        )
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
            low, high = (low, middle) if separates(middle) else (middle, high)
        reply = reply_of(0.5 * (low + high), used, "")
    except Broken as broken:
        reply = reply_of(math.nan, used, "", *broken.args)
    return {"onset": reply._replace(low=low, high=high)}


def growth_rate(solve: Solve, budget: float) -> Replies:
    """Rate at which a deviation from the cycle grows, from the stretches between releases."""
    start = read_state(stored("answers")["starts"]["growing"])
    result, seconds = _timed(solve, Problem(GROWING, start, start.time + GROWING_SPAN), budget)
    rate = (
        growth(_times(result, "stick_to_slip"))
        if result.outcome is RunStatus.FINISHED
        else math.nan
    )
    return {
        "growth_rate": reply_of(
            rate, seconds, "no oscillation that grows or dies out steadily", result
        )
    }


def growth(releases: Array) -> float:
    """Rate (1/s) of an oscillation in the stretches between releases (s), by least squares; nan if
    there is none."""
    if len(releases) < 64:
        return math.nan
    gaps, times = np.diff(releases), 0.5 * (releases[1:] + releases[:-1])
    times = times - times.mean()
    if (size := float(np.std(gaps))) == 0.0:
        return math.nan
    y = (gaps - gaps.mean()) / size
    spectrum = np.abs(np.fft.rfft(y * np.hanning(len(y)), 8 * len(y)))
    peaks = find_peaks(spectrum)[
        0
    ]  # of the whole spectrum: a slow drift stands highest where it would be cut off
    peaks = peaks[peaks >= 8]
    line = peaks[np.argmax(spectrum[peaks])]
    omega = 2.0 * math.pi * line / (8 * len(y)) * (len(times) - 1) / float(np.ptp(times))

    def model(
        t: Array, rate: float, omega: float, cosine: float, sine: float, rest: float
    ) -> Array:
        return np.asarray(
            np.exp(rate * t) * (cosine * np.cos(omega * t) + sine * np.sin(omega * t)) + rest
        )

    basis = np.column_stack([np.cos(omega * times), np.sin(omega * times), np.ones_like(times)])
    first = np.linalg.lstsq(basis, y, rcond=None)[0]
    try:
        fitted = curve_fit(model, times, y, p0=[0.0, omega, *first])[0]
    except RuntimeError:
        return math.nan
    return float(fitted[0])


def region(solve: Solve, budget: float) -> Replies:
    """Share of the cells for which it is said wrongly whether the static start leads to a
    separation."""
    right = [letter == "1" for row in stored("answers")["region"] for letter in row]
    return {"region": judged(partial(cell, solve, budget), right.__getitem__, budget)}


def judged(
    judge: Callable[[int], tuple[bool, float]],
    right: Callable[[int], bool],
    budget: float,
    most: int = SIDE * SIDE,
) -> Reply:
    """The answer as of `region`, from functions of a cell's index: separation and seconds, and the
    right answer. If the budget is too small for all cells, a power of two of them is drawn at
    random with a fixed seed. The answer then has Wilson's interval of 95 %. The time is
    extrapolated to all cells."""
    indices = np.random.default_rng(20).permutation(SIDE * SIDE)
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
        return reply_of(math.nan, sum(s for _, s in verdicts), "", *broken.args)._replace(
            cells=len(verdicts)
        )
    wrong = sum(
        apart != right(int(index)) for (apart, _), index in zip(verdicts, indices, strict=False)
    )
    part = float(wrong) / count
    low, high = share(int(wrong), count)[1:] if count < len(indices) else (part, part)
    seconds = sum(s for _, s in verdicts) / count * len(indices)
    return Reply(part, seconds, AnswerStatus.FOUND, "", low, high, count)


def cell(solve: Solve, budget: float, index: int, **model: Any) -> tuple[bool, float]:
    """Whether a cell of the region (0 to `SIDE`^2 - 1, speeds first) separates, and the seconds
    that took."""
    load, speed = np.linspace(*REGION_LOADS, SIDE), np.linspace(*REGION_SPEEDS, SIDE)
    p = Parameters(N=float(load[index // SIDE]), Omega=float(speed[index % SIDE]), **model)
    result = solve(Problem(p, static_start(p), REGION_HORIZON, stop=True), budget)
    return _separates(result), result.seconds


ASKED: Mapping[
    str, tuple[Callable[[Solve, float], Replies], float]
] = {  # and the budget at one setting, s
    "first_separation": (first_separation, 10.0),
    "after_separation": (after_separation, 6.0),
    "onset": (onset, 12.0),
    "growth_rate": (growth_rate, 6.0),
    "region": (region, 8.0),
}


def _timed(solve: Solve, problem: Problem, budget: float) -> tuple[MethodResult, float]:
    """A result and the least wall time (s); quick runs are repeated, since the first may have
    compiled."""
    results = [solve(problem, budget)]
    while results[-1].seconds < QUICK and len(results) <= REPEATS:
        results.append(solve(problem, budget))
    return results[0], min(result.seconds for result in results)


def reply_of(
    value: float, seconds: float, missing: str, result: MethodResult | None = None
) -> Reply:
    """An answer; if it is nan, the reason is ``missing`` or, if the run that gave it did not end,
    how that failed."""
    if math.isfinite(value):
        return Reply(float(value), seconds, AnswerStatus.FOUND)
    if result is None or result.outcome is RunStatus.FINISHED:
        return Reply(math.nan, seconds, AnswerStatus.NONE, missing)
    name = "UNSTABLE" if result.outcome is RunStatus.NON_FINITE else result.outcome.name
    return Reply(math.nan, seconds, AnswerStatus[name], result.message or f"{result.outcome}")


def _times(result: MethodResult, kind: str) -> Array:
    return result.times[[event == kind for event in result.kinds]]


def _separates(result: MethodResult) -> bool:
    """Whether contact is lost; raises `Broken` if the motion neither lost it nor reached its
    end."""
    separates = "separation" in result.kinds
    if not separates and result.outcome is not RunStatus.FINISHED:
        raise Broken(result)
    return separates


# ---- Costs
CYCLE_SETTINGS = (1e-6, 1e-8, 1e-10, 1e-12)  # tolerances of the search for a cycle
LINES: Mapping[str, tuple[str, str]] = TABLES["lines"]
RICHEST: dict[str, Any] = {"n_diameters": 12, "contact_compliance": "residual"}
CELLS = 64  # number of cells of the region on which models are compared
SETTLES_WITHIN, SETTLES_FOR = (
    400.0,
    100.0,
)  # s: contact is lost within it, and time from then until the examined motion
NEVER = 1e6  # a budget in s that is never used up: models take their time
SERIES = setting_of(METHODS["series"], DEFAULT)


def answers(
    part: str,
    settings: Sequence[float] | None = None,
    *,
    asked: Sequence[str] = tuple(ASKED),
    models: Sequence[int] = (0, 1, 2, 3, 4, 6, 8),
) -> xr.Dataset:
    """Measure a method at settings from coarse to fine, the ``cycle``, or ``models`` by numbers of
    nodal diameters."""
    hopeless: set[str] = (
        set()
    )  # questions for which it is too slow, which are skipped at finer settings

    def measure(line: str, setting: Any, question: str = "") -> Iterator[Row]:
        if question in hopeless:
            return
        if line == "cycle":
            replies = ask_cycle({}, setting)
            right = {
                "onset": reference("fold").value,
                "growth_rate": reference("growth_rate").value,
            }
        elif line in CONTACTS:
            replies = ask_model({"n_diameters": setting} | CONTACTS[line])
            right = {answer: reply.value for answer, reply in _richest().items()}
        else:
            function, budget = ASKED[question]
            replies = function(setting_of(METHODS[line], setting), budget)
            right = {answer: reference(answer).value for answer in replies}
            if any(reply.status is AnswerStatus.TOO_SLOW for reply in replies.values()):
                hopeless.add(question)
        label, varies = (
            LINES[line] if line in LINES else (METHODS[line].label, METHODS[line].setting)
        )
        for answer, reply in replies.items():
            error, judgement = (
                abs(reply.value - right[answer]),
                verdict(answer, reply, right[answer]),
            )
            row = {
                "answer": answer,
                "label": label,
                "varies": varies,
                "right": right[answer],
                "found": reply.value,
            }
            yield row | {"error": error, "verdict": judgement} | reply._asdict()

    if part == "cycle":
        points: list[Row] = [{"line": part, "setting": tol} for tol in CYCLE_SETTINGS]
    elif part == "models":
        points = [{"line": line, "setting": count} for line in CONTACTS for count in models]
    else:
        values = settings or METHODS[part].settings["stick_slip"]
        points = [
            {"line": part, "setting": value, "question": name} for value in values for name in asked
        ]
    known = {name: reference(name) for name in QUESTIONS}
    about = {
        name: QUESTIONS[name] | {"error": f"{right.error:.2g}, {right.by}"}
        for name, right in known.items()
    }
    title = "What each answer costs"
    return run(
        "answers", points, measure, flags=FLAGS, title=title, questions=json_attribute(about)
    )


def in_words(dataset: xr.Dataset) -> pd.DataFrame:
    """All rows, in the order in which they were measured; status, verdict and setting (``at``) in
    words."""
    frame = dataset.to_dataframe()
    counted = frame["varies"] == "diameters"
    settings = [f"{x:.0f} diameters" if count else f"{kind}={x:g}"
          for count, kind, x in zip(counted, frame["varies"], frame["setting"], strict=True)]  # fmt: skip
    return frame.assign(
        at=settings, **{name: flag_names(dataset[name]) for name in ("status", "verdict")}
    )


# ---- Answers of this package with other modes at its default tolerance, and from the cycle itself
def ask_model(model: Mapping[str, Any]) -> Replies:
    """The answers to all questions with these modes, given as fields of the parameters."""
    replies = first_separation(SERIES, NEVER, SEPARATING.replace(**model))
    replies |= settled_after_separation(SETTLED.replace(**model)) | ask_cycle(model, DEFAULT)
    replies["region"] = judged(partial(cell, SERIES, NEVER, **model), _right_cell, NEVER, CELLS)
    return replies


@lru_cache(maxsize=1)
def _richest() -> Replies:
    return ask_model(RICHEST)


def settled_after_separation(p: Parameters) -> Replies:
    """Answers as of `after_separation`, from the state that this model's motion reaches."""
    first = simulate(p, SETTLES_WITHIN, events=False, tol=DEFAULT, stop_at="first_separation")
    if not math.isfinite(first.first_separation):
        missing = f"no separation within {SETTLES_WITHIN:g} s"
        return dict.fromkeys(AFTER_SEPARATION, reply_of(math.nan, math.nan, missing))
    state = first.final_state
    late = simulate(p, state.time + SETTLES_FOR, events=False, tol=DEFAULT, initial_state=state)
    return after_separation(SERIES, NEVER, p, late.final_state)


def ask_cycle(model: Mapping[str, Any], tol: float) -> Replies:
    """Onset and growth rate with these modes from the cycle itself, without a simulation, and the
    least processor time (s) of several runs."""
    replies = {}
    for name, function, case in (
        ("onset", cycle_onset, SEPARATING),
        ("growth_rate", cycle_growth_rate, GROWING),
    ):
        p, seconds = case.replace(**model), math.inf
        reply = function(p, tol)  # may have compiled
        for _ in range(REPEATS):
            began = clock.thread_time()
            function(p, tol)
            seconds = min(seconds, clock.thread_time() - began)
            if seconds > QUICK:
                break
        replies[name] = reply._replace(seconds=seconds)
    return replies


def cycle_onset(p: Parameters, tol: float) -> Reply:
    """Speed (rad/s) of the first fold of the quiet cycle above 14.5 rad/s."""
    low, high = 14.5, 16.0
    try:
        folds = continue_cycle(
            p.replace(Omega=14.8), "Omega", (low, high), direction=1, tol=tol
        ).folds
    except ParameterError as error:
        return reply_of(math.nan, 0.0, f"no cycle to follow: {error}")
    return reply_of(
        folds[0, 0] if len(folds) else math.nan, 0.0, f"no fold from {low:g} to {high:g} rad/s"
    )


def cycle_growth_rate(p: Parameters, tol: float) -> Reply:
    """Growth rate (1/s) of the stick-slip cycle, from its multipliers."""
    cycle = floquet(p, tol=tol)
    return reply_of(
        cycle.growth_rate if cycle.status is CycleStatus.OK else math.nan, 0.0, cycle.message
    )


@lru_cache(maxsize=CELLS)
def _right_cell(index: int) -> bool:
    return cell(SERIES, NEVER, index, **RICHEST)[0]


# ---- Where methods find the first separation
MAP_CASE, MAP_HORIZON = (
    Parameters(N=600.0, Omega=27.0),
    25.0,
)  # a case that loses contact within the horizon (s)
MAP_BUDGET = 3.0  # s for a point; beyond it, finer settings with the same modes are skipped


def answer_map(
    method: str, diameters: Sequence[int] = (1, 2, 4, 8), values: MapSettings = None
) -> xr.Dataset:
    """Verdicts on a method's first separation along (diameters, value), from coarse to fine."""
    judged = METHODS[method].economical()

    def ask(asked: Method, value: float, budget: float, count: int) -> Reply:
        p = MAP_CASE.replace(n_diameters=count)
        return first_separation(setting_of(asked, value), budget, p, MAP_HORIZON)[
            "first_separation"
        ]

    right = {
        count: ask(METHODS["series"], REFERENCE_TOL, math.inf, count).value for count in diameters
    }
    late: set[int] = set()

    def measure(diameters: int, value: float) -> Iterator[Row]:
        reply = Reply(math.nan, math.nan, AnswerStatus.TOO_SLOW)
        if diameters not in late:
            reply = ask(judged, value, MAP_BUDGET, diameters)
        if reply.status is AnswerStatus.TOO_SLOW:
            late.add(diameters)
        judgement = verdict("first_separation", reply, right[diameters])
        errors = {"verdict": judgement, "error": abs(reply.value - right[diameters])}
        yield errors | {"status": reply.status, "found": reply.value, "seconds": reply.seconds}

    def facts(diameters: int) -> Iterator[Row]:
        yield {"modes": real_modes(diameters, 0), "right": right[diameters]}

    if values is None:  # six at most: the first, the last, and some between
        every = map_settings(judged)
        values = [
            every[i] for i in np.linspace(0, len(every) - 1, min(6, len(every))).round().astype(int)
        ]
    about: dict[str, Any] = {
        "budget": MAP_BUDGET,
        "horizon": MAP_HORIZON,
        "parameters": MAP_CASE.canonical_json,
    }
    study = run(
        "answer_map", {"diameters": diameters, "value": values}, measure, flags=FLAGS, **about
    )
    return with_facts(judged, study, facts, "answer_map_facts")
