"""Numbers of modes that are left to a quantity of the motion: said when a study is read, chosen when a job runs."""

from __future__ import annotations

import json
from typing import Any

from disc_model.parameters import Parameters
from disc_model.truncation import FREQUENCIES, Asked, ModeChoice, by_frequencies


def chosen(p: Parameters, asked: Asked) -> ModeChoice:
    """The choice that was asked for; raises `disc_model.DiscModelError` where there is none."""
    if asked.quantity == FREQUENCIES:
        return by_frequencies(p, asked.tolerance)
    # not above: it simulates, and who reads a study does not
    from disc_model.mode_choice import by_motion

    return by_motion(p, asked)


def to_text(asked: Asked) -> str:
    """What is requested, for a case's text."""
    return json.dumps(asked._asdict(), sort_keys=True)


def choose(p: Parameters, text: str) -> tuple[Parameters, str]:
    """A case with the modes that its text asks for, and how they were chosen, as JSON; raises as `chosen`."""
    asked: dict[str, Any] = json.loads(text)
    choice = chosen(p, Asked(asked["quantity"], asked["tolerance"]))
    return choice.parameters, choice.to_json()
