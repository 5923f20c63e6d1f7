"""Tables of the measured answers."""

from __future__ import annotations

import json
import math

import pandas as pd
import xarray as xr

from disc_model.benchmarks.answers.questions import STATUS_WORDS, VERDICT_WORDS, AnswerVerdict
from disc_model.benchmarks.texts import TEXTS, as_markdown

MODELS = ("rigid", "residual")


def points(dataset: xr.Dataset) -> pd.DataFrame:
    """All rows, in the order in which they were measured; ``at`` is the setting in words."""
    found = dataset.to_dataframe()
    counted = found["varies"] == "diameters"
    at = [f"{x:.0f} diameters" if count else f"{kind}={x:g}"
          for count, kind, x in zip(counted, found["varies"], found["setting"], strict=True)]  # fmt: skip
    verdict = found["verdict"]
    return found.assign(at=at, correct=verdict == AnswerVerdict.RIGHT, wrong=verdict == AnswerVerdict.WRONG)


def right_numbers(model: pd.DataFrame) -> str:
    """Numbers of nodal diameters with which a reduced model answers correctly."""
    return ", ".join(f"{count:.0f}" for count in model["setting"][model["correct"]])


def within(enough: float, units: str) -> str:
    """Tolerance of an answer as text."""
    return f"{enough:g}" if units == "1" else f"{enough:g} {_unit(units)}"


def to_markdown(dataset: xr.Dataset) -> str:
    """The tables as Markdown: a section per question, its correct answer and tolerance; the machine stands above."""
    sections = []
    for question, part in points(dataset).groupby("answer", sort=False):
        own = json.loads(dataset.attrs["questions"])[question]
        table = {
            "line": part["label"],
            "setting": part["at"],
            f"found ({_unit(own['units'])})": [*map(_found, part["found"], part["low"], part["high"], part["cells"])],
            "error": [_short(error, 3) for error in part["error"]],
            "time (s)": [_short(seconds, 3) for seconds in part["seconds"]],
            "verdict": [VERDICT_WORDS[verdict].replace("_", " ") for verdict in part["verdict"]],
            "status": [
                ": ".join(filter(None, (STATUS_WORDS[status].replace("_", " "), message)))
                for status, message in zip(part["status"], part["message"], strict=True)
            ],
        }
        passage = {"title": own["title"].capitalize(), "within": within(own["enough"], own["units"])}
        sections.append({**passage, "error": own["error"], "table": as_markdown(pd.DataFrame(table))})
    return TEXTS["answers"].fill(machine=dataset.attrs["machine"], questions=sections)


def _found(value: float, low: float, high: float, cells: int) -> str:
    bounds = f" ({_short(low)} to {_short(high)})" if math.isfinite(value) and low < high else ""
    return _short(value) + bounds + (f", {cells} cells" if cells else "")


def _short(number: float, digits: int = 8) -> str:
    return f"{number:.{digits}g}" if math.isfinite(number) else "-"


def _unit(units: str) -> str:
    return units.replace("rad s-1", "rad/s").replace("s-1", "1/s")
