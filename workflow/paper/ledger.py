"""The ledger: every statement of the paper with a verdict, as a table and as a page with a summary."""

import re
from collections.abc import Callable, Mapping, Sequence
from inspect import ismodule
from typing import Any

import numpy as np
import pandas as pd

from disc_model.data.dataset import Missing
from disc_model.data.texts import Section, fill
from disc_model.data.variables import values_text
from workflow.paper import (
    JUDGING_TABLES,
    TABLE_CASES,
    paper_tables,
    section2,
    section41,
    section43,
    section44,
    stretching,
)
from workflow.paper.measures import CaseView, extent, or_none, place, rate_text, repeats
from workflow.paper.model import FALSE, TRUE, VERDICTS, Row, read_texts, rows_of

FILES = ("section2.yaml", "section41.yaml", "section43.yaml", "section44.yaml", "precursor.yaml")
ROWS = rows_of(*FILES)
FUNCTIONS: dict[str, Callable[..., Any]] = {}
"""What rows measure by: functions and constants of the modules on the sections, and some others."""
for _module in (paper_tables, section2, section41, section43, section44):
    FUNCTIONS |= {name: each for name, each in vars(_module).items() if not ismodule(each)}
FUNCTIONS |= {"extent": extent, "repeats": repeats, "named": place}
COLUMNS = ["id", "section", "place", "quote", "verdict", "here", "stretched", "matters", "notes"]
COLUMNS += ["rule", "figures", "data", "computed", "counts"]
NUMBER = r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"


def check_claims(
    cases: Mapping[str, CaseView], tables: Mapping[str, pd.DataFrame] | None = None
) -> pd.DataFrame:
    """Judge all rows by cases and grid studies, by name.

    Parameters
    ----------
    cases : cases and grid studies
    tables : those of `JUDGING_TABLES` that have been made of these cases; others are made

    Returns
    -------
    table : with `COLUMNS`; ``stretched`` says what the row's motions come to if the plate stretches,
        ``figures`` and ``data`` are links from the paper's results, by their words
    """
    made = dict(tables or {})
    for name in JUDGING_TABLES:
        needed = TABLE_CASES[name]
        if name not in made and cases.keys() >= {*needed}:
            made[name] = paper_tables.TABLES[name]({each: cases[each] for each in needed})
    motions = cases[stretching.STUDY].node.to_dataset() if stretching.STUDY in cases else None
    rows = []
    for row in ROWS:
        judged = row.judge(cases, made, FUNCTIONS)._asdict()
        own = [cases[name] for name in row.cases if name in cases]
        stretched = "" if motions is None else stretching.with_stretching(own, motions)
        rows.append({**_stated(row), **judged, "stretched": stretched})
    return pd.DataFrame(rows)[COLUMNS]


def _stated(row: Row) -> dict[str, Any]:
    """Return the columns of a row that do not depend on what was computed."""
    section = re.sub(r"^(Sec\. 2)\.\d.*", r"\1", row.place.partition(",")[0])
    if section.startswith("Conclusion"):
        section = "Conclusions"
    figures = {re.sub("^fig0?", "Fig. ", name): _link(name) for name in row.figures}
    data = {}
    for name in row.tables + row.from_tables:
        data[f"table {name.replace('_', ' ')}"] = f"tables/{name}.html"
    for name in row.cases:
        data[name] = f"cases/{name}.nc"
    for name in row.scans + row.optional_scans:
        data[name] = f"../{name}/{name}.nc"
    same = ("id", "place", "quote", "matters", "rule", "computed", "counts")
    stated = {name: getattr(row, name) for name in same}
    return {**stated, "section": section, "figures": figures, "data": data}


def _link(figure: str) -> str:
    """Return the path of a figure from the paper's results."""
    folder = "" if figure.startswith("fig") else f"../{figure}/"
    return f"{folder}figures/{figure}.png"


def summary(table: pd.DataFrame) -> dict[str, Any]:
    """Return what the page says on top of a table of `check_claims`.

    These are counts of verdicts, and sentences whose rows have the verdicts that they speak of.
    """
    texts = read_texts("ledger.yaml")
    counted = table[table["counts"] != "error in print"]
    parts = pd.crosstab(counted["section"], counted["verdict"])
    parts = parts.reindex(index=counted["section"].unique(), columns=[*VERDICTS], fill_value=0)
    by_row = table.set_index("id")
    numbers = by_row["here"].str.findall(NUMBER)
    for name, verdict in (("headline", TRUE), ("stands", TRUE), ("falls", FALSE)):
        texts[name] = [
            {"id": row, "text": fill(text, n=numbers[row])}
            for row, text in texts[name].items()
            if by_row.loc[row, "verdict"] == verdict
        ]
    return {
        **texts,
        "links": {name: _link(name) for name in texts["pictures"]},
        "counts": parts.sum().to_dict(),
        "parts": parts,
        "errors": len(table) - len(counted),
    }


# ---- The two normalisations

TEXTS: dict[str, str] = read_texts("pages.yaml")["normalisation"]
NAMES = {"published": "as published", "orthonormal": "Eq. (17)"}


def compare(models: Mapping[str, Mapping[str, CaseView]]) -> list[Section]:
    """Return what changes with orthonormal modes, as sections of a page.

    Parameters
    ----------
    models : cases by name, under the names of the two normalisations in `NAMES`
    """
    names: dict[
        Any, str
    ] = {}  # each set of parameters once, without repetitions at another tolerance
    for name, case in models["published"].items():
        of_paper = case.parameters.normalization == "as_published"
        if of_paper and name in models["orthonormal"] and case.from_rest:
            names.setdefault(case.parameters, name)
    old, new = ([models[model][name] for name in names.values()] for model in NAMES)
    failed = np.array([[case.status == "failed" for case in cases] for cases in (old, new)])
    separate = np.array([[case.separates for case in cases] for cases in (old, new)])
    before, after = separate[:, ~failed.any(axis=0)].sum(axis=1)
    brief = fill(TEXTS["brief"], cases=int((~failed.any(axis=0)).sum()), before=before, after=after)
    claims = _verdicts(models)
    both = claims[[*NAMES.values()]]
    counts = both.apply(pd.Series.value_counts).reindex([*VERDICTS]).fillna(0).astype(int)
    changed = claims[both.nunique(axis=1) > 1]
    return [
        ("", brief, counts.rename_axis("verdict").reset_index()),
        ("The cases of the paper", TEXTS["cases"], _cases(old, new)),
        ("Statements of the paper whose verdict changes", TEXTS["verdicts"], changed),
    ]


def _cases(old: Sequence[CaseView], new: Sequence[CaseView]) -> pd.DataFrame:
    """Return results of cases as published, and of the same with orthonormal modes."""
    columns = {
        "Case": [case.name for case in old],
        "Parameters": [_parameters_text(case) for case in old],
        "First separation, as published": [_first_separation(case) for case in old],
        "First separation, Eq. (17)": [_first_separation(case) for case in new],
        "Growth, as published (1/s)": [rate_text(case.growth_rate, "", "–") for case in old],
        "Growth, Eq. (17) (1/s)": [rate_text(case.growth_rate, "", "–") for case in new],
        "P in the end, Eq. (17) (N)": [_late_force(case) for case in new],
    }
    return pd.DataFrame(columns)


def _verdicts(models: Mapping[str, Mapping[str, CaseView]]) -> pd.DataFrame:
    """Return the rows that are judged by cases, with their verdicts under both normalisations."""
    by_cases = [bool(row.cases) for row in ROWS]
    old, new = (check_claims(models[model])[by_cases] for model in NAMES)
    verdicts = {"as published": old["verdict"], "Eq. (17)": new["verdict"]}
    return old[["place", "quote"]].assign(**verdicts, Found=new["here"])


def _parameters_text(case: CaseView) -> str:
    """Return preload, speed and what else differs from Table 1, and whether separation is ignored."""
    text = values_text(dict(case.parameters))
    return f"{text}, separation ignored" if case.bilateral else text


def _first_separation(case: CaseView) -> str:
    """Return the time of the first separation as text, or why there is none."""
    if case.status == "failed":
        return "failed"
    if case.bilateral:
        return "ignored"
    return or_none(case["first_separation"], ".2f", " s", f"none in {case['time_reached']:g} s")


def _late_force(case: CaseView) -> str:
    """Return the late range of the contact force as text, or a dash if it was not recorded."""
    try:
        return f"{case.late:.1f}"
    except Missing:
        return "–"
