"""Questions that methods are compared by, and verdicts on replies to them."""

import enum
import math
from typing import Any, NamedTuple

from benchmarks.methods.integrators import MethodResult, RunStatus
from benchmarks.scenes import stored
from benchmarks.study import TABLES, Flags

QUESTIONS: dict[str, dict[str, Any]] = TABLES["questions"]
"""Name in words, unit, and the tolerance (in the unit) of a correct answer."""

AnswerStatus = enum.IntEnum("AnswerStatus", "FOUND NONE TOO_SLOW UNSTABLE STALLED FAILED", start=0)
"""NONE: the method ended well and says that there is no such thing."""
AnswerVerdict = enum.IntEnum("AnswerVerdict", "RIGHT WRONG NO_ANSWER", start=0)
FLAGS: Flags = {"status": AnswerStatus, "verdict": AnswerVerdict}


class Reply(NamedTuple):
    """A reply to a question."""

    value: float
    """The answer, nan without one."""
    seconds: float
    status: AnswerStatus
    message: str = ""
    """Why there is no answer."""
    low: float = math.nan
    """Lower bound of the answer, where it has one."""
    high: float = math.nan
    """Upper bound."""
    cells: int = 0
    """Number of cells of a region that were examined."""


Replies = dict[str, Reply]
"""Replies by the name of the answer."""


class Reference(NamedTuple):
    """The correct answer to a question."""

    value: float
    error: float
    by: str
    """The other method by which it was found."""


def reference(name: str) -> Reference:
    """Return the correct answer to a question, or to ``fold``."""
    found = stored("answers")["references"][name]
    return Reference(found["value"], found["error"], found["by"])


def verdict(question: str, reply: Reply, right: float) -> AnswerVerdict:
    """Return the verdict on a reply: to deny an existing result is wrong, to give up is not.

    Parameters
    ----------
    question : its name
    reply : of a method
    right : the correct answer, nan if there is none
    """
    if reply.status not in (AnswerStatus.FOUND, AnswerStatus.NONE):
        return AnswerVerdict.NO_ANSWER
    holds = math.isnan(right)
    if reply.status is AnswerStatus.FOUND:
        holds = abs(reply.value - right) <= QUESTIONS[question]["enough"]
    return AnswerVerdict.RIGHT if holds else AnswerVerdict.WRONG


def reply_of(
    value: float, seconds: float, missing: str, result: MethodResult | None = None
) -> Reply:
    """Return a reply.

    Parameters
    ----------
    value : the answer, nan if there is none
    seconds : that it took
    missing : the reason for nan
    result : of the run that gave the answer; if it did not end, that is the reason
    """
    if math.isfinite(value):
        return Reply(float(value), seconds, AnswerStatus.FOUND)
    if result is None or result.outcome is RunStatus.FINISHED:
        return Reply(math.nan, seconds, AnswerStatus.NONE, missing)
    name = result.outcome.name
    if result.outcome is RunStatus.NON_FINITE:
        name = "UNSTABLE"
    return Reply(math.nan, seconds, AnswerStatus[name], result.message or f"{result.outcome}")
