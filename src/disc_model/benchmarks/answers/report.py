"""Tables of the measured answers."""

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
    """The cheapest correct point of every line, cheapest line first; models are left out."""
    right = [p for p in found if p.verdict is AnswerVerdict.RIGHT and p.line not in MODELS]
    best: dict[str, Row] = {}
    for point in sorted(right, key=lambda p: p.seconds):
        best.setdefault(point.line, point)
    return [*best.values()]


def right_numbers(model: Sequence[Row]) -> str:
    """Numbers of nodal diameters with which a reduced model answers correctly."""
    return ", ".join(f"{p.setting:.0f}" for p in model if p.verdict is AnswerVerdict.RIGHT)


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
        table = "\n".join(markdown_table(head, map(_row, points(dataset, question))))
        said = {
            "title": own["title"].capitalize(),
            "within": within(own["enough"], own["units"]),
            "error": own["error"],
        }
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


def _unit(units: str) -> str:
    return units.replace("rad s-1", "rad/s").replace("s-1", "1/s")
