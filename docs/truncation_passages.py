"""Passages on the number of modes: tables, and statements on convergence made from the numbers.

`summary` extracts the numbers from the dataset of one run, that of `disc_model.benchmarks.truncation.contact_study`.
They are stored as ``docs/contact_truncation.json``, and all texts are written from that file.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
import yaml
from pydantic import BaseModel, ConfigDict

from disc_model.data.dataset import markdown_table
from disc_model.data.texts import Part, Sentences


class Passage(BaseModel):
    """A template with the parts for its lists, by the name of the value."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    text: str
    parts: dict[str, Part] = {}

    def fill(self, **values: Any) -> str:
        return Sentences(self.parts, values).fill(self.text)


_RAW = yaml.safe_load(Path(__file__).with_name("benchmark_texts.yaml").read_text(encoding="utf-8"))
TEXTS = {name: Passage.model_validate(passage) for name, passage in _RAW.items()}


class Column(NamedTuple):
    """A quantity of the tables.

    title : of a row; costs have none
    head : of a column
    tolerance : relative, within which models agree: 1 % or better for the motion in contact, and 10 % for values from
        ten seconds of an irregular motion
    scale, digits : for display
    """

    title: str
    head: str
    tolerance: float
    scale: float
    digits: int

    def shown(self, value: float) -> str:
        """A value as text; a dash if missing."""
        return "-" if math.isnan(value) else f"{float(f'{value * self.scale:.{self.digits}g}'):.10g}"


ALL = {
    "lowest_coupled": Column("lowest coupled frequency", "lowest frequency, rad/s", 1e-3, 1.0, 6),
    "growth_rate": Column("growth rate", "growth, 1/s", 1e-2, 1.0, 3),
    "first_separation": Column("first separation", "first separation, s", 1e-2, 1.0, 5),
    "separations": Column("rate of separations", "separations per s", 1e-1, 1.0, 3),
    "separated_share": Column("time in separation", "time in separation", 1e-1, 1.0, 2),
    "u_range": Column("range of the slider's height", "range, mm", 1e-1, 1e3, 3),
    "force_max_separating": Column("largest force", "largest force, N", 1e-1, 1.0, 3),
    "cost": Column("", "cost in contact, ms/s", math.nan, 1e3, 2),
    "cost_separating": Column("", "cost after it, ms/s", math.nan, 1e3, 2),
}
TABLED = {name: column for name, column in ALL.items() if column.title}
LATE = ("separations", "separated_share", "u_range", "force_max_separating")
"""Quantities after the first separation."""
FEWEST = 3
"""Number of models that must agree: one, and two larger ones."""
NOT = "**not**"


def summary(study: xr.Dataset) -> dict[str, Any]:
    """Numbers of a run for the pages: a row for each case, contact and model, None where there is no value."""
    frame = study[["modes", *ALL]].to_dataframe(dim_order=["case", "contact", "model"])
    rounded = frame.map(lambda value: float(f"{value:.5g}")).astype(object)
    return {
        "machine": study.attrs["machine"],
        "horizon": float(study.attrs["horizon"]),
        "most_growth": float(study.attrs["most_growth"]),
        "late": json.loads(study.attrs["late"]),
        "values": rounded.where(frame.notna(), None).reset_index().to_dict("split", index=False),
    }


def settled(values: Sequence[float | None], tolerance: float) -> int | None:
    """The first model from which on all agree with the largest within a relative tolerance, or like it have no value.

    Parameters
    ----------
    values : by size of the model, None or nan where a model has no such quantity

    Returns
    -------
    int or None
        Its index in the list; None if it would not have two larger ones.
    """
    line = np.array(values, float)
    off = np.flatnonzero(~np.isclose(line, line[-1], rtol=tolerance, atol=0.0, equal_nan=True))
    first = int(off[-1]) + 1 if off.size else 0
    return first if len(line) - first >= FEWEST else None


def passages(run: Mapping[str, Any]) -> dict[str, str]:
    """Texts by the name that pages refer to."""
    study = pd.DataFrame(**run["values"]).set_index(["case", "contact", "model"]).astype(float)
    start, length = run["late"]
    tables = [
        {"title": _upper(str(case)), "table": _of_all_models(part)} for case, part in study.groupby("case", sort=False)
    ]
    rows, open_rows = [], []
    for (case, contact), models in study.groupby(["case", "contact"], sort=False):
        row = {"case": case, "contact": contact}
        for name, column in TABLED.items():
            line = _known(models, name, run["most_growth"])
            place, last = settled(line.tolist(), column.tolerance), line[-FEWEST:]
            row[f"{column.head.split(',')[0]}, to {100 * column.tolerance:g} %"] = _from_where(line, place)
            if place is None:
                modes = ", ".join(f"{modes:g}" for modes in last.index)
                open_rows.append((_upper(str(case)), contact, column.title, ", ".join(map(column.shown, last)), modes))
        rows.append(row)
    table = pd.DataFrame(rows)
    undecided = pd.DataFrame(open_rows, columns=("case", "contact", "quantity", "values", "with so many modes"))
    found = (table.set_index(["case", "contact"]) != NOT).stack().groupby("contact", sort=False).agg(["sum", "size"])
    counts = [{"contact": contact, "settled": part["sum"], "count": part["size"]} for contact, part in found.iterrows()]
    most = f"{study['modes'].iloc[-1]:g}"
    return {
        "truncation_tables": TEXTS["truncation_tables"].fill(
            horizon=run["horizon"], start=start, stop=start + length, machine=run["machine"], tables=tables
        ),
        "truncation_settled": TEXTS["truncation_settled"].fill(table=as_markdown(table), most=most, contacts=counts),
        "truncation_open": f"\n\n{as_markdown(undecided)}\n",
    }


def _of_all_models(study: pd.DataFrame) -> str:
    """The table of a case: a row for each model, with rigid and residual values in each cell."""
    cells = {column.head: study[name].map(column.shown) for name, column in ALL.items()}
    table = pd.DataFrame(cells).groupby("model", sort=False).agg(" / ".join)
    table.insert(0, "modes", study["modes"].groupby("model", sort=False).first().astype(int))
    table.insert(0, "diameters, circles", table.index.str.replace(",", ", "))
    return as_markdown(table)


def _known(models: pd.DataFrame, name: str, most_growth: float) -> pd.Series[float]:
    """A quantity by the number of modes, without models for which it was not looked for.

    These have too many modes for a growth rate, or lose contact and could then not be followed.
    """
    line = models.set_index("modes")
    if name == "growth_rate":
        return line[name][line.index <= most_growth]
    return line[name][line[name].notna() | line["first_separation"].isna() | (name not in LATE)]


def _from_where(line: pd.Series[float], place: int | None) -> str:
    if place is None:
        return NOT
    where = f"from {line.index[place]:g}"
    if not math.isnan(line.iloc[place]):
        return where
    return f"none {where}" if place else "none"


def _upper(case: str) -> str:
    return case[:1].upper() + case[1:]


def as_markdown(frame: pd.DataFrame) -> str:
    """A table in Markdown."""
    return "\n".join(markdown_table(frame.columns, frame.itertuples(index=False)))
