"""Tables of the measured answers."""

from __future__ import annotations

import json
import math
from typing import Any

import pandas as pd
import xarray as xr

from disc_model.benchmarks.answers.questions import STATUS_WORDS, VERDICT_WORDS, AnswerVerdict
from disc_model.benchmarks.texts import TEXTS
from disc_model.data.dataset import markdown_table

MODELS = ("rigid", "residual")


def points(dataset: xr.Dataset, question: str) -> pd.DataFrame:
    """The rows of a question, in the order in which they were measured; ``at`` is the setting in words."""
    found = dataset.isel(row=dataset["answer"].values == question).to_dataframe()
    at = [
        f"{x:.0f} diameters" if kind == "diameters" else f"{kind}={x:g}"
        for kind, x in zip(found["varies"], found["setting"], strict=True)
    ]
    return found.assign(
        at=at, correct=found["verdict"] == AnswerVerdict.RIGHT, wrong=found["verdict"] == AnswerVerdict.WRONG
    )


def right_numbers(model: pd.DataFrame) -> str:
    """Numbers of nodal diameters with which a reduced model answers correctly."""
    return ", ".join(f"{count:.0f}" for count in model["setting"][model["correct"]])


def within(enough: float, units: str) -> str:
    """Tolerance of an answer as text."""
    return f"{enough:g}" if units == "1" else f"{enough:g} {_unit(units)}"


def to_markdown(dataset: xr.Dataset) -> str:
    """The tables as Markdown: a section per question, its correct answer and tolerance; the machine stands above."""
    about = json.loads(dataset.attrs["questions"])
    rows = []
    for question in dict.fromkeys(map(str, dataset["answer"].values)):
        own = about[question]
        head = ("line", "setting", f"found ({_unit(own['units'])})", "error", "time (s)", "verdict", "status")
        table = "\n".join(markdown_table(head, map(_row, points(dataset, question).itertuples())))
        passage = {
            "title": own["title"].capitalize(),
            "within": within(own["enough"], own["units"]),
            "error": own["error"],
        }
        rows.append({**passage, "table": table})
    return TEXTS["answers"].fill(machine=dataset.attrs["machine"], questions=rows)


def _row(p: Any) -> tuple[str, ...]:
    value = _short(p.found)
    if math.isfinite(p.low) and math.isfinite(p.found) and p.low < p.high:
        value += f" ({_short(p.low)} to {_short(p.high)})"
    if p.cells:
        value += f", {p.cells} cells"
    verdict, status = (
        words[i].replace("_", " ") for words, i in ((VERDICT_WORDS, p.verdict), (STATUS_WORDS, p.status))
    )
    why = ": ".join(filter(None, (status, p.message)))
    return p.label, p.at, value, _short(p.error, 3), _short(p.seconds, 3), verdict, why


def _short(number: float, digits: int = 8) -> str:
    return f"{number:.{digits}g}" if math.isfinite(number) else "-"


def _unit(units: str) -> str:
    return units.replace("rad s-1", "rad/s").replace("s-1", "1/s")
