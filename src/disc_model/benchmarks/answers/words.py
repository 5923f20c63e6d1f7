"""What the measured answers come to: a sentence a question, and tables."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence

import xarray as xr

from disc_model.benchmarks.answers.measure import Row
from disc_model.benchmarks.answers.questions import AnswerStatus, AnswerVerdict
from disc_model.benchmarks.texts import TEXTS
from disc_model.data.dataset import markdown_table

MODELS = ("rigid", "residual")


def points(dataset: xr.Dataset, question: str) -> list[Row]:
    """The rows of a question, in the order in which they were measured."""
    part = dataset[[*Row._fields]].isel(row=dataset["answer"].values == question)
    rows = [Row(*row) for row in part.to_dataframe().itertuples(index=False)]
    return [row._replace(status=AnswerStatus(row.status), verdict=AnswerVerdict(row.verdict)) for row in rows]


def cheapest_right(found: Sequence[Row]) -> list[Row]:
    """Of every line the point that is right and costs least, cheapest line first; models are left out."""
    right = [p for p in found if p.verdict is AnswerVerdict.RIGHT and p.line not in MODELS]
    best: dict[str, Row] = {}
    for point in sorted(right, key=lambda p: p.seconds):
        best.setdefault(point.line, point)
    return [*best.values()]


def sentence(dataset: xr.Dataset, question: str) -> str:
    """Which method answers a question rightly at what price, which wrongly, and which not at all."""
    own, found = json.loads(dataset.attrs["questions"])[question], points(dataset, question)
    methods = [p for p in found if p.line not in MODELS]
    answered = {p.line for p in methods if p.verdict is not AnswerVerdict.NO_ANSWER}
    return TEXTS["answer"].fill(
        enough=own["enough"],
        unit="" if own["units"] == "1" else f" {_unit(own['units'])}",
        right=[{"label": p.label, "at": p.at, "time": _time(p)} for p in cheapest_right(found)],
        wrong=[{"label": p.label, "at": p.at, "says": p.says} for p in methods if p.verdict is AnswerVerdict.WRONG],
        silent=[{"label": label} for label in dict.fromkeys(p.label for p in methods if p.line not in answered)],
        models=[
            {"model": model, "which": _enough(line)}
            for model in MODELS
            if (line := [p for p in found if p.line == model])
        ],
    )


def _enough(model: Sequence[Row]) -> str:
    """How many nodal diameters of a model do."""
    right = "; ".join(f"{p.setting:.0f}" for p in model if p.verdict is AnswerVerdict.RIGHT)
    most = max(p.setting for p in model)
    return f"right with {right} nodal diameters" if right else f"with no number of nodal diameters up to {most:.0f}"


def to_markdown(dataset: xr.Dataset) -> str:
    """A section a question: its sentence, its right answer, its table; the machine above."""
    about = json.loads(dataset.attrs["questions"])
    rows = []
    for question in dict.fromkeys(map(str, dataset["answer"].values)):
        own = about[question]
        head = ("line", "setting", f"found ({_unit(own['units'])})", "error", "time (s)", "verdict", "status")
        table = "\n".join(markdown_table(head, map(_row, points(dataset, question))))
        said = {"title": own["title"].capitalize(), "sentence": sentence(dataset, question), "error": own["error"]}
        rows.append({**said, "table": table})
    return TEXTS["answers"].fill(machine=dataset.attrs["machine"], questions=rows)


def _row(p: Row) -> tuple[str, ...]:
    value = _short(p.found)
    if math.isfinite(p.low) and math.isfinite(p.found) and p.low < p.high:
        value += f" ({_short(p.low)} to {_short(p.high)})"
    if p.cells:
        value += f", {p.cells} cells"
    verdict, why = p.verdict.name.lower().replace("_", " "), f"{p.became}{': ' + p.message if p.message else ''}"
    return p.label, p.at, value, _short(p.error, 3), _short(p.seconds, 3), verdict, why


def _short(number: float, digits: int = 8) -> str:
    return f"{number:.{digits}g}" if math.isfinite(number) else "-"


def _time(p: Row) -> str:
    if p.seconds < 0.1:
        return f"{1e3 * p.seconds:.2g} ms"
    return f"{p.seconds:.2g} s" if p.seconds < 100.0 else f"{p.seconds:.0f} s"


def _unit(units: str) -> str:
    return units.replace("rad s-1", "rad/s").replace("s-1", "1/s")
