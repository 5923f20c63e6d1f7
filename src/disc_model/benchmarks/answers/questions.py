"""The questions, their correct answers, and the verdict on an answer.

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
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.benchmarks.grid import TABLES
from disc_model.benchmarks.scenes import read_state, stored
from disc_model.parameters import Parameters
from disc_model.simulation.result import State

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


QUESTIONS = {name: Question(*given) for name, given in TABLES["questions"].items()}


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


class Found(NamedTuple):
    """An answer: value (nan without one), wall time (s), status, reason, bounds, and number of cells examined."""

    value: float
    seconds: float
    status: AnswerStatus
    message: str = ""
    low: float = math.nan
    high: float = math.nan
    cells: int = 0


def verdict(question: str, found: Found, right: float) -> AnswerVerdict:
    """Verdict on an answer: to deny an existing result is wrong, to give up is not."""
    if found.status is AnswerStatus.NONE:
        return AnswerVerdict.RIGHT if math.isnan(right) else AnswerVerdict.WRONG
    if found.status is not AnswerStatus.FOUND:
        return AnswerVerdict.NO_ANSWER
    return AnswerVerdict.RIGHT if abs(found.value - right) <= QUESTIONS[question].enough else AnswerVerdict.WRONG


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


def start(name: str) -> State:
    """State of the motion ``settled`` or ``growing``, from the engine at its tightest tolerance."""
    return read_state(stored("answers")["starts"][name])


def region() -> NDArray[np.bool_]:
    """Separation in each cell, shape (`SIDE`, `SIDE`), loads along the first axis."""
    return np.array([[letter == "1" for letter in row] for row in stored("answers")["region"]])


def cell(place: int) -> Parameters:
    """Parameters of a cell by its index in the region, 0 to `SIDE`^2 - 1."""
    load, speed = np.linspace(*REGION_LOADS, SIDE), np.linspace(*REGION_SPEEDS, SIDE)
    return Parameters(N=float(load[place // SIDE]), Omega=float(speed[place % SIDE]))
