"""Numbers of modes that are left to a quantity of the motion: said when a study is read, chosen when a job runs.

What chooses is imported by its name, so that only the results that it decides depend on its sources: their texts hold
the hash of these.
"""

from __future__ import annotations

import importlib
import json
from typing import Any

from disc_model.data.provenance import source_hash
from disc_model.parameters import Parameters
from disc_model.truncation import FREQUENCIES, Asked, ModeChoice, by_frequencies

CHOOSER = "disc_model.mode_choice"


def chosen(p: Parameters, asked: Asked) -> ModeChoice:
    """The choice that was asked for; raises `disc_model.DiscModelError` where there is none."""
    if asked.quantity == FREQUENCIES:
        return by_frequencies(p, asked.tolerance)
    choice: ModeChoice = importlib.import_module(CHOOSER).by_motion(p, asked)
    return choice


def chooser(asked: Asked | None) -> tuple[str, ...]:
    """The module, if any, whose sources a choice depends on besides those of what reads it."""
    return () if asked is None or asked.quantity == FREQUENCIES else (CHOOSER,)


def to_text(asked: Asked) -> str:
    """What is asked for, for a case's text; another one where the sources of what chooses are others."""
    return json.dumps({**asked._asdict(), "sources": source_hash(CHOOSER)}, sort_keys=True)


def choose(p: Parameters, text: str) -> tuple[Parameters, str]:
    """A case with the modes that its text asks for, and how they were chosen, as JSON; raises as `chosen`."""
    asked: dict[str, Any] = json.loads(text)
    choice = chosen(p, Asked(asked["quantity"], asked["tolerance"]))
    return choice.parameters, choice.to_json()
