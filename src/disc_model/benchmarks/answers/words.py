"""What the measured answers come to: a sentence a question, and tables."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence

import xarray as xr

from disc_model.benchmarks.answers.measure import Row
from disc_model.benchmarks.answers.questions import Status, Verdict
from disc_model.data.dataset import markdown_table

MODELS = ("rigid", "residual")


def points(dataset: xr.Dataset, question: str) -> list[Row]:
    """The rows of a question, in the order in which they were measured."""
    part = dataset[[*Row._fields]].isel(row=dataset["answer"].values == question)
    rows = [Row(*row) for row in part.to_dataframe().itertuples(index=False)]
    return [row._replace(status=Status(row.status), verdict=Verdict(row.verdict)) for row in rows]


def cheapest_right(found: Sequence[Row]) -> list[Row]:
    """Of every line the point that is right and costs least, cheapest line first; models are left out."""
    right = [p for p in found if p.verdict is Verdict.RIGHT and p.line not in MODELS]
    best: dict[str, Row] = {}
    for point in sorted(right, key=lambda p: p.seconds):
        best.setdefault(point.line, point)
    return [*best.values()]


def sentences(dataset: xr.Dataset, question: str) -> str:
    """Which method answers a question rightly at what price, which wrongly, and which not at all."""
    own, found = json.loads(dataset.attrs["questions"])[question], points(dataset, question)
    right = cheapest_right(found)
    unit = "" if own["units"] == "1" else f" {_unit(own['units'])}"
    priced = _listed(f"{p.label} ({p.at}, {_time(p)})" for p in right)
    text = [f"Right to {own['enough']:g}{unit}, cheapest first: {priced}."]
    wrong = [p for p in found if p.verdict is Verdict.WRONG and p.line not in MODELS]
    if wrong:
        text.append(f"Wrong without a warning: {_listed(f'{p.label} at {p.at} ({p.says})' for p in wrong)}.")
    answered = {p.line for p in found if p.verdict is not Verdict.NO_ANSWER}
    silent = dict.fromkeys(p.label for p in found if p.line not in answered and p.line not in MODELS)
    if silent:
        text.append(f"No answer in the time given: {_listed(silent)}.")
    for model in MODELS:
        own_points = [p for p in found if p.line == model]
        enough = [p.setting for p in own_points if p.verdict is Verdict.RIGHT]
        if enough:
            text.append(f"Modes, {model} contact: right with {_listed(f'{n:.0f}' for n in enough)} nodal diameters.")
        elif own_points:
            most = own_points[-1].setting
            text.append(f"Modes, {model} contact: with no number of nodal diameters up to {most:.0f}.")
    return " ".join(text)


def to_markdown(dataset: xr.Dataset) -> str:
    """A section a question: its sentence, its right answer, its table; the machine above."""
    text = ["# What each answer costs", "", f"Machine: {dataset.attrs['machine']}, one core.", ""]
    text += [
        "The error of the lines of modes is that of the model, against the richest disc; that of the others is of the",
        "numbers, with nine modes. A dash: no answer.",
        "",
    ]
    about = json.loads(dataset.attrs["questions"])
    for question in dict.fromkeys(map(str, dataset["answer"].values)):
        own, found = about[question], points(dataset, question)
        text += [f"## {own['title'].capitalize()}", "", sentences(dataset, question), ""]
        text += [f"Right answer: error {own['error']}.", ""]
        head = ("line", "setting", f"found ({_unit(own['units'])})", "error", "time (s)", "verdict", "status")
        text += [*markdown_table(head, map(_row, found)), ""]
    return "\n".join(text)


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


def _listed(parts: Iterable[str]) -> str:
    return "; ".join(parts) or "none"
