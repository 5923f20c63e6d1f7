"""Numbers of modes chosen by a tolerance: stated when a study is read, determined when a job runs."""

from __future__ import annotations

import json
from typing import Any

from disc_model.parameters import Parameters
from disc_model.truncation import FREQUENCIES, Asked, ModeChoice, by_frequencies


def chosen(p: Parameters, asked: Asked) -> ModeChoice:
    """The requested choice of modes; raises `disc_model.DiscModelError` if there is none."""
    if asked.quantity == FREQUENCIES:
        return by_frequencies(p, asked.tolerance)
    # imported here: it loads the simulation, which reading a study does not need
    from disc_model.mode_choice import by_motion

    return by_motion(p, asked)


def to_text(asked: Asked) -> str:
    """The requested choice as text, for a case's text."""
    return json.dumps(asked._asdict(), sort_keys=True)


def choose(p: Parameters, text: str) -> tuple[Parameters, str]:
    """A case with the modes that its text requests, and how they were chosen, as JSON; raises as `chosen` does."""
    asked: dict[str, Any] = json.loads(text)
    choice = chosen(p, Asked(asked["quantity"], asked["tolerance"]))
    return choice.parameters, choice.to_json()
