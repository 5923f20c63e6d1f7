"""Results of `contact_study` in the docs: tables, and statements on convergence made from the numbers.

`summary` extracts the numbers from the dataset of one run, which are stored as ``docs/contact_truncation.json``.  All
texts are written from that file.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import xarray as xr

from disc_model.benchmarks.texts import TEXTS
from disc_model.data.dataset import markdown_table

Summary = Mapping[str, Any]
Line = tuple[list[int], list[float | None]]
"""Numbers of modes, and values of a quantity."""


class Asked(NamedTuple):
    """A quantity of the tables.

    title : title of a row; head : head of a column
    tolerance : relative tolerance within which models agree
    scale, digits : factor and digits for display
    """

    title: str
    head: str
    tolerance: float
    scale: float
    digits: int


TABLED = {
    "lowest_coupled": Asked("lowest coupled frequency", "lowest frequency, rad/s", 1e-3, 1.0, 6),
    "growth_rate": Asked("growth rate", "growth, 1/s", 1e-2, 1.0, 3),
    "first_separation": Asked("first separation", "first separation, s", 1e-2, 1.0, 5),
    "separations": Asked("rate of separations", "separations per s", 1e-1, 1.0, 3),
    "separated_share": Asked("time in separation", "time in separation", 1e-1, 1.0, 2),
    "u_range": Asked("range of the slider's height", "range, mm", 1e-1, 1e3, 3),
    "force_max_separating": Asked("largest force", "largest force, N", 1e-1, 1.0, 3),
}
"""Tolerances: 1 % or better for the motion in contact, 10 % for values from ten seconds of an irregular motion."""
COSTS = {"cost": "cost in contact, ms/s", "cost_separating": "cost after it, ms/s"}
LATE = ("separations", "separated_share", "u_range", "force_max_separating")
"""Quantities after the first separation."""
OPEN = ("case", "contact", "quantity", "values", "with so many modes")
"""Head of the table of quantities that have not converged."""
FEWEST = 3
"""Number of models that must agree: one, and two larger ones."""


def summary(study: xr.Dataset) -> dict[str, Any]:
    """Numbers of a run for the pages: by case and contact, a list along the models for each quantity, None if missing.

    The list of growth rates ends with the largest model for which a cycle was searched.
    """
    counts = [int(count) for count in study["modes"].isel(case=0, contact=0).values]
    looked = sum(count <= study.attrs["most_growth"] for count in counts)
    ends = {name: looked if name == "growth_rate" else len(counts) for name in (*TABLED, *COSTS)}
    return {
        "machine": study.attrs["machine"],
        "late": json.loads(study.attrs["late"]),
        "horizon": float(study.attrs["horizon"]),
        "models": [str(model) for model in study["model"].values],
        "modes": counts,
        "values": {
            str(case): {
                str(contact): {
                    name: [
                        float(f"{value:.5g}") if math.isfinite(value) else None
                        for value in study[name].sel(case=case, contact=contact).values[:end]
                    ]
                    for name, end in ends.items()
                }
                for contact in study["contact"].values
            }
            for case in study["case"].values
        },
    }


def settled(values: Sequence[float | None], tolerance: float) -> int | None:
    """The first model from which on all agree with the largest within a relative tolerance, or like it have no value.

    Parameters
    ----------
    values : by size of the model, None where a model has no such quantity

    Returns
    -------
    int or None
        Its index in the list; None if it would not have two larger ones.
    """
    first = len(values)
    while first and _alike(values[first - 1], values[-1], tolerance):
        first -= 1
    return first if len(values) - first >= FEWEST else None


def _alike(value: float | None, last: float | None, tolerance: float) -> bool:
    if value is None or last is None:
        return value is last
    return abs(value - last) <= tolerance * abs(last)


def passages(run: Summary) -> dict[str, str]:
    """Texts by the name that pages refer to."""
    start, length = run["late"]
    tables = [{"title": _upper(case), "table": _table(run, contacts)} for case, contacts in run["values"].items()]
    settled_of: dict[str, list[bool]] = {}
    rows, open_rows = [], []
    for case, contact, values in _each(run):
        found = {name: _known(run, values, name) for name in TABLED}
        places = {name: settled(found[name][1], asked.tolerance) for name, asked in TABLED.items()}
        settled_of.setdefault(contact, []).extend(place is not None for place in places.values())
        rows.append([case, contact, *(_from_where(found[name], place) for name, place in places.items())])
        open_rows += [
            [_upper(case), contact, TABLED[name].title, *_moves(found[name], TABLED[name])]
            for name, place in places.items()
            if place is None
        ]
    columns = [f"{asked.head.split(',')[0]}, to {100 * asked.tolerance:g} %" for asked in TABLED.values()]
    counts = [{"contact": name, "settled": sum(all_), "count": len(all_)} for name, all_ in settled_of.items()]
    return {
        "truncation_tables": TEXTS["truncation_tables"].fill(
            horizon=run["horizon"], start=start, stop=start + length, machine=run["machine"], tables=tables
        ),
        "truncation_settled": TEXTS["truncation_settled"].fill(
            table="\n".join(markdown_table(["case", "contact", *columns], rows)), most=run["modes"][-1], contacts=counts
        ),
        "truncation_open": TEXTS["truncation_open"].fill(table="\n".join(markdown_table(OPEN, open_rows))),
    }


def _each(run: Summary) -> Iterator[tuple[str, str, Mapping[str, Sequence[float | None]]]]:
    """Case, contact and the values of the models."""
    for case, contacts in run["values"].items():
        for contact, values in contacts.items():
            yield case, contact, values


def _table(run: Summary, contacts: Mapping[str, Mapping[str, Sequence[float | None]]]) -> str:
    """The table of a case: a row for each model, with rigid and residual values in each cell."""
    head = ["diameters, circles", "modes", *(asked.head for asked in TABLED.values()), *COSTS.values()]
    shown = [(name, asked.scale, asked.digits) for name, asked in TABLED.items()]
    shown += [(name, 1e3, 2) for name in COSTS]
    rows = []
    for i, (model, modes) in enumerate(zip(run["models"], run["modes"], strict=True)):
        cells = [
            " / ".join(_number(_at(contacts[contact][name], i), scale, digits) for contact in contacts)
            for name, scale, digits in shown
        ]
        rows.append([model.replace(",", ", "), modes, *cells])
    return "\n".join(markdown_table(head, rows))


def _at(values: Sequence[float | None], i: int) -> float | None:
    return values[i] if i < len(values) else None


def _known(run: Summary, values: Mapping[str, Sequence[float | None]], name: str) -> Line:
    """Numbers of modes and values of a quantity, without models that lose contact and could then not be followed."""
    pairs = [
        (modes, value)
        for modes, value, first in zip(run["modes"], values[name], values["first_separation"], strict=False)
        if name not in LATE or value is not None or first is None
    ]
    return [modes for modes, _ in pairs], [value for _, value in pairs]


def _from_where(line: Line, place: int | None) -> str:
    modes, values = line
    if place is None:
        return "**not**"
    none = "none" if values[place] is None else ""
    return none if place == 0 and none else f"{none} from {modes[place]}".strip()


def _moves(line: Line, asked: Asked) -> tuple[str, str]:
    """The values of the three largest models, and their numbers of modes."""
    modes, values = line
    listed = ", ".join(_number(value, asked.scale, asked.digits) for value in values[-FEWEST:])
    return listed, ", ".join(map(str, modes[-FEWEST:]))


def _number(value: float | None, scale: float, digits: int) -> str:
    """A number with the given digits, without a power of ten; a dash if missing."""
    return "-" if value is None else f"{float(f'{value * scale:.{digits}g}'):.10g}"


def _upper(case: str) -> str:
    return case[:1].upper() + case[1:]


def text(study: xr.Dataset) -> str:
    """All texts as one page: the table beside the figures of ``make bench``."""
    known = {name.removeprefix("truncation_"): phrase.strip("\n") for name, phrase in passages(summary(study)).items()}
    return TEXTS["truncation_page"].fill(**known)
