"""The ledger: every statement of the paper with a verdict.

It is a table, and a page with a summary on top. A second page sets the paper's cases and statements
under the two normalisations of the modes beside each other: as published, and by Eq. (17).
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from disc_model.data.dataset import Missing
from disc_model.data.texts import Section, fill
from disc_model.data.variables import values_text
from disc_model.disc.modes import plate_modes
from disc_model.disc.plate import coupled_frequencies
from disc_model.parameters import Parameters
from workflow.paper import JUDGING_TABLES, TABLE_CASES, section2, section41, section43, section44
from workflow.paper.measures import CaseView, or_none, rate_text
from workflow.paper.model import (
    FALSE,
    NOT_COMPUTED,
    TRUE,
    VERDICTS,
    Row,
    judge,
    read_texts,
    rows_of,
)
from workflow.paper.paper_tables import TABLES

MODULES = (section2, section41, section43, section44)
CHECKS = {name: check for module in MODULES for name, check in vars(module).items()}
FILES = ("section2.yaml", "section41.yaml", "section43.yaml", "section44.yaml", "precursor.yaml")
ROWS = tuple(row for file in FILES for row in rows_of(file, CHECKS))
COLUMNS = [
    "id",
    "section",
    "place",
    "quote",
    "verdict",
    "here",
    "matters",
    "notes",
    "rule",
    "figures",
    "data",
    "computed",
    "counts",
]

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
    table : with `COLUMNS`; ``figures`` and ``data`` are links from the paper's results, by their words
    """
    known = tables_of(cases, tables)
    judged = judge(ROWS, {"": cases}, {"": known})
    stated = pd.DataFrame([_stated(row) for row in ROWS])
    return judged.join(stated)[COLUMNS]


def tables_of(
    cases: Mapping[str, CaseView], made: Mapping[str, pd.DataFrame] | None = None
) -> dict[str, pd.DataFrame]:
    """Return the `JUDGING_TABLES` of cases: those that are made, and others if their cases are there."""
    tables = dict(made or {})
    for name in JUDGING_TABLES:
        needed = TABLE_CASES[name]
        if name not in tables and cases.keys() >= {*needed}:
            tables[name] = TABLES[name]({each: cases[each] for each in needed})
    return tables


def _stated(row: Row) -> dict[str, Any]:
    """Return the columns of a row that do not depend on what was computed."""
    section = re.sub(r"^(Sec\. 2)\.\d.*", r"\1", row.place.partition(",")[0])
    if section.startswith("Conclusion"):
        section = "Conclusions"

    figures = {}
    for name in row.figures:
        words = name
        if name.startswith("fig"):
            number = name.removeprefix("fig").lstrip("0")
            words = f"Fig. {number}"
        figures[words] = _link(name)

    data = {}
    for name in row.tables + row.from_tables:
        words = name.replace("_", " ")
        data[f"table {words}"] = f"tables/{name}.html"
    for name in row.cases:
        data[name] = f"cases/{name}.nc"
    for name in row.scans + row.optional_scans:
        data[name] = f"../{name}/{name}.nc"

    counts = ""
    if row.print_error:
        counts = "error in print"
    elif row.after_the_fact:
        counts = "after the fact"
    return {
        "place": row.place,
        "quote": row.quote,
        "matters": row.matters,
        "rule": row.rule,
        "section": section,
        "figures": figures,
        "data": data,
        "computed": row.computed,
        "counts": counts,
    }


def _link(figure: str) -> str:
    """Return the path of a figure from the paper's results."""
    if figure.startswith("fig"):
        return f"figures/{figure}.png"
    return f"../{figure}/figures/{figure}.png"


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
        items = []
        for row, text in texts[name].items():
            if by_row.loc[row, "verdict"] == verdict:
                sentence = fill(text, n=numbers[row])
                items.append({"id": row, "text": sentence})
        texts[name] = items
    return {
        **texts,
        "links": {name: _link(name) for name in texts["pictures"]},
        "counts": parts.sum().to_dict(),
        "parts": parts,
        "errors": len(table) - len(counted),
    }


# ---- The two normalisations

TEXTS: dict[str, str] = read_texts("pages.yaml")["normalisation"]
OLD = "As published"
NEW = "With Eq. (17)"
SHOWN = ("F02", "F07", "F09", "F13", "F17", "F18", "F22", "F23")
"""Cases of the paper's figures with a separation."""


def compare(
    published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]
) -> dict[str, Section]:
    """Return what changes with orthonormal modes, as sections of a page.

    Parameters
    ----------
    published, orthonormal : cases by name under the two normalisations; those of the second alone
        get a section ``instead``, if there are any
    """
    pairs = _pairs(published, orthonormal)
    whole = []
    failed = []
    for case, other in pairs:
        if "failed" in (case.status, other.status):
            failed.append(case.name)
        else:
            whole.append((case, other))
    verdicts = _verdicts(published, orthonormal)
    brief = fill(
        TEXTS["brief"],
        cases=len(whole),
        before=sum(case.separates for case, _ in whole),
        after=sum(other.separates for _, other in whole),
        failed=failed,
    )
    old_cases = [case for case, _ in pairs]
    new_cases = [other for _, other in pairs]
    parts = {
        "brief": ("", brief, _brief(whole, verdicts)),
        "modes": ("The modes", TEXTS["modes"], _modes()),
        "cases": ("The cases of the paper", TEXTS["cases"], _cases(old_cases, new_cases)),
    }
    additional = [case for name, case in orthonormal.items() if name not in published]
    if additional:
        table = _cases(additional)
        parts["instead"] = ("Where instability goes instead", TEXTS["instead"], table)
    changes = verdicts[OLD] != verdicts[NEW]
    changed = verdicts[changes & (verdicts[OLD] != NOT_COMPUTED)]
    heading = "Statements of the paper whose verdict changes"
    parts["verdicts"] = (heading, TEXTS["verdicts"], changed)
    return parts


def _pairs(
    published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]
) -> list[tuple[CaseView, CaseView]]:
    """Return the cases from rest under both normalisations, each set of parameters once."""
    names: dict[Parameters, str] = {}  # without repetitions at another tolerance
    for name, case in published.items():
        if name in orthonormal and case.from_rest:
            names.setdefault(case.parameters, name)
    return [(published[name], orthonormal[name]) for name in names.values()]


def _brief(pairs: Sequence[tuple[CaseView, CaseView]], verdicts: pd.DataFrame) -> pd.DataFrame:
    """Return counts under both normalisations, and first separations of the paper's figures.

    Counted are cases that separate or grow, and statements by what becomes of them.

    Parameters
    ----------
    pairs : cases under both normalisations
    verdicts : a table of `_verdicts`
    """
    separate = np.zeros(2, int)
    grow = np.zeros(2, int)
    with_cycles = 0
    for pair in pairs:
        rates = np.array([case.growth_rate for case in pair])
        separate += [case.separates for case in pair]
        if not np.isnan(rates).any():
            with_cycles += 1
            grow += rates > 0
    judged = verdicts[[OLD, NEW]]
    rows: list[tuple[Any, ...]] = [
        (f"cases that separate, of {len(pairs)}", *separate),
        (f"cases whose stick-slip cycle grows, of {with_cycles} that have one under both", *grow),
        (
            f"statements that are true, of {len(verdicts)} that are judged by cases",
            *(judged == TRUE).sum(),
        ),
        ("statements that are false", *(judged == FALSE).sum()),
        ("statements that no motion decides", *(judged == NOT_COMPUTED).sum()),
    ]
    for case, other in pairs:
        if case.name in SHOWN:
            name = f"first separation, {case.place}"
            rows.append((name, _first_separation(case), _first_separation(other)))
    return pd.DataFrame(rows, columns=["", OLD, NEW]).astype(str)


def _modes() -> pd.DataFrame:
    """Return amplitudes and frequencies of the modes under both normalisations."""
    models = {", as published": section2.BASE, ", Eq. (17)": section2.NORMALISED}
    modes = plate_modes(section2.BASE)
    table = pd.DataFrame({"Nodal diameters": modes["diameters"].astype(str)})
    table["Disc alone (rad/s)"] = modes["omega"].map("{:.2f}".format)
    squares = [plate_modes(p)["psi"] ** 2 for p in models.values()]
    for which, square in zip(models, squares, strict=True):
        table[f"psi²{which} (1/kg)"] = square.map("{:.4f}".format)
    table["ratio"] = (squares[0] / squares[1]).map("{:.2f}".format)
    for which, p in models.items():
        table[f"With slider{which} (rad/s)"] = [f"{f:.2f}" for f in coupled_frequencies(p)]
    return table


def _cases(cases: Sequence[CaseView], new: Sequence[CaseView] = ()) -> pd.DataFrame:
    """Return results of cases, and of the same cases with orthonormal modes if these are given."""
    models = {"": cases}
    if new:
        models = {", as published": cases, ", Eq. (17)": new}
    columns = {
        "Case": [case.name for case in cases],
        "Parameters": [_parameters_text(case) for case in cases],
    }
    for which, each in models.items():
        columns[f"First separation{which}"] = [_first_separation(case) for case in each]
    for which, each in models.items():
        columns[f"Growth{which} (1/s)"] = [
            rate_text(case.growth_rate, without="–") for case in each
        ]
    last = [*models][-1]
    columns[f"P in the end{last} (N)"] = [_late_force(case) for case in models[last]]
    return pd.DataFrame(columns)


def _parameters_text(case: CaseView) -> str:
    """Return preload, speed and what else differs from Table 1, and whether separation is ignored."""
    text = values_text(dict(case.parameters))
    return f"{text}, separation ignored" if case.bilateral else text


def _verdicts(
    published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]
) -> pd.DataFrame:
    """Return the rows of the ledger that are judged by cases, as they come out for both."""
    rows = [row for row in ROWS if row.cases]
    models = {"published": published, "orthonormal": orthonormal}
    tables = {name: tables_of(cases) for name, cases in models.items()}
    table = judge(rows, models, tables)
    old, new = (part.set_index("id") for _, part in table.groupby("model", sort=False))
    several_models = [row.get("also") for row in read_texts("survival.yaml").values()]
    columns = {
        "Place": pd.Series({row.id: row.place for row in ROWS}),
        "Statement": pd.Series({row.id: f"“{row.quote}”" for row in ROWS}),
        OLD: old["verdict"],
        NEW: new["verdict"].mask(new.index.isin(several_models), "see model sensitivity"),
        f"Found {NEW[0].lower()}{NEW[1:]}": new["here"],
    }
    return pd.DataFrame(columns).loc[old.index]


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
