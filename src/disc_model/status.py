"""How a computation ended: words that carry their sentence."""

from __future__ import annotations

import enum
from typing import Self


class StatusBase(enum.StrEnum):
    """Base of all statuses.  A member is given as ``NAME = word, advice``; its value is the word.

    Attributes
    ----------
    advice : what the outcome means and what to change, in a sentence
    """

    advice: str

    def __new__(cls, word: str, advice: str = "") -> Self:
        if not advice:
            raise TypeError(f"{word}: a status needs its advice")
        member = str.__new__(cls, word)
        member._value_ = word
        member.advice = advice
        return member


class Status(StatusBase):
    """How a simulation ended; `advice` says what to do."""

    OK = "ok", "The simulation reached t_end."
    STOPPED = "stopped", "The simulation stopped where stop_at asked it to."
    STEP_LIMIT = "step_limit", "The allowed number of steps was used up: raise max_steps, or shorten t_end."
    PARADOX = (
        "paradox",
        "Painleve's paradox: rigid Coulomb friction on this slope has no solution, or two; lower mu_k or N.",
    )
    STALLED = (
        "stalled",
        "Switches follow each other without the clock moving: tighten tol, or perturb the initial state.",
    )
    NON_FINITE = (
        "non_finite",
        "The state overflowed: check the parameters' magnitudes; tighten tol if they are as meant.",
    )

    @property
    def complete(self) -> bool:
        """Whether the simulation did what was asked."""
        return self in (Status.OK, Status.STOPPED)
