"""The ledger: every statement of the paper with a verdict, as a table and as a page with a summary
on top; and the paper's cases and statements under the two normalisations of the modes: as
published, and by Eq. (17)."""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from disc_model.data.dataset import Missing
from disc_model.data.texts import Section, fill
from disc_model.data.variables import values_text
from disc_model.disc.plate import coupled_frequencies, plate_modes
from disc_model.paper import section2, section41, section43, section44
from disc_model.paper.measures import CaseView, or_none, rate_text
from disc_model.paper.model import (
    FALSE,
    NOT_COMPUTED,
    TRUE,
    VERDICTS,
    Row,
    judge,
    read_texts,
    rows_of,
)
from disc_model.parameters import Parameters

MODULES = (section2, section41, section43, section44)
CHECKS = {name: check for module in MODULES for name, check in vars(module).items()}
FILES = (
    "paper/section2.yaml",
    "paper/section41.yaml",
    "paper/section43.yaml",
    "paper/section44.yaml",
)
ROWS = tuple(row for file in (*FILES, "paper/precursor.yaml") for row in rows_of(file, CHECKS))
COLUMNS = ["id", "section", "place", "quote", "verdict", "here", "matters", "notes"]
COLUMNS += ["rule", "figures", "data", "counts"]


def check_claims(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Judge all rows: a table with `COLUMNS`; figures and data are links from the paper's results,
    by their words."""
    return judge(ROWS, {"": cases}).join(pd.DataFrame(map(_stated, ROWS)))[COLUMNS]


def _stated(row: Row) -> dict[str, Any]:
    """The columns of a row that do not depend on what was computed."""
    part = re.sub(r"^(Sec\. 2)\.\d.*", r"\1", row.place.partition(",")[0])
    names = {
        name: f"Fig. {name[3:].lstrip('0')}" if name.startswith("fig") else name
        for name in row.figures
    }
    data = {f"table {name.replace('_', ' ')}": f"tables/{name}.html" for name in row.tables}
    data |= {x: f"cases/{x}.nc" for x in row.cases} | {
        x: f"../{x}/{x}.nc" for x in row.scans + row.beside
    }
    return {name: getattr(row, name) for name in ("place", "quote", "matters", "rule")} | {
        "section": "Conclusions" if part.startswith("Conclusion") else part,
        "figures": {words: _link(name) for name, words in names.items()},
        "data": data,
        "counts": "error in print" if row.print_error else "after the fact" * row.after_the_fact,
    }


def _link(figure: str) -> str:
    return (
        f"figures/{figure}.png" if figure.startswith("fig") else f"../{figure}/figures/{figure}.png"
    )


def summary(table: pd.DataFrame) -> dict[str, Any]:
    """What the page says on top: counts of verdicts, and sentences whose rows have the verdicts
    that they speak of."""
    texts = read_texts("paper/ledger.yaml")
    counted = table[table["counts"] != "error in print"]
    parts = pd.crosstab(counted["section"], counted["verdict"])
    parts = parts.reindex(index=counted["section"].unique(), columns=[*VERDICTS], fill_value=0)
    verdicts = table.set_index("id")["verdict"]
    numbers = table.set_index("id")["here"].str.findall(
        r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
    )
    for name, verdict in (("headline", TRUE), ("stands", TRUE), ("falls", FALSE)):
        items = [(row, text) for row, text in texts[name].items() if verdicts[row] == verdict]
        texts[name] = [{"id": row, "text": fill(text, n=numbers[row])} for row, text in items]
    texts["links"] = {name: _link(name) for name in texts["pictures"]}
    return {
        **texts,
        "counts": parts.sum().to_dict(),
        "parts": parts,
        "errors": len(table) - len(counted),
    }


# ---- The two normalisations
TEXTS: dict[str, str] = read_texts("paper/pages.yaml")["normalisation"]
OLD, NEW = "As published", "With Eq. (17)"
SHOWN = (
    "F02",
    "F07",
    "F09",
    "F13",
    "F17",
    "F18",
    "F22",
    "F23",
)  # cases of the paper's figures with a separation


def compare(
    published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]
) -> dict[str, Section]:
    """What changes with orthonormal modes; cases of the second set alone are "instead", if there
    are any."""
    shared: dict[Parameters, str] = {}  # without repetitions at another tolerance
    for name, case in published.items():
        if name in orthonormal and case.from_rest:
            shared.setdefault(case.parameters, name)
    pairs = [(published[name], orthonormal[name]) for name in shared.values()]
    whole = [(case, other) for case, other in pairs if "failed" not in (case.status, other.status)]
    failed = [case.name for case, other in pairs if "failed" in (case.status, other.status)]
    verdicts = _verdicts(published, orthonormal)
    before, after = (sum(case.separates for case in column) for column in zip(*whole, strict=True))
    text = fill(TEXTS["brief"], cases=len(whole), before=before, after=after, failed=failed)
    parts = {
        "brief": ("", text, _brief(whole, verdicts)),
        "modes": ("The modes", TEXTS["modes"], _modes()),
        "cases": ("The cases of the paper", TEXTS["cases"], _cases(*zip(*pairs, strict=True))),
    }
    if new := [case for name, case in orthonormal.items() if name not in published]:
        parts["instead"] = ("Where instability goes instead", TEXTS["instead"], _cases(new))
    changed = verdicts[(verdicts[OLD] != verdicts[NEW]) & (verdicts[OLD] != NOT_COMPUTED)]
    return parts | {
        "verdicts": ("Statements of the paper whose verdict changes", TEXTS["verdicts"], changed)
    }


def _brief(pairs: Sequence[tuple[CaseView, CaseView]], verdicts: pd.DataFrame) -> pd.DataFrame:
    """How many cases separate, grow and agree with the paper under both; first separations of the
    paper's figures."""
    known = [pair for pair in pairs if not any(math.isnan(case.growth_rate) for case in pair)]
    judged = [verdicts[name] for name in (OLD, NEW)]
    grow = f"cases whose stick-slip cycle grows, of {len(known)} that have one under both"
    rows: dict[str, list[Any]] = {
        f"cases that separate, of {len(pairs)}": [
            sum(pair[i].separates for pair in pairs) for i in (0, 1)
        ],
        grow: [sum(pair[i].growth_rate > 0 for pair in known) for i in (0, 1)],
        f"statements that are true, of {len(verdicts)} that are judged by cases": [
            sum(of == TRUE) for of in judged
        ],
        "statements that are false": [sum(of == FALSE) for of in judged],
        "statements that no motion decides": [sum(of == NOT_COMPUTED) for of in judged],
    }
    rows |= {
        f"first separation, {pair[0].place}": [*map(_first, pair)]
        for pair in pairs
        if pair[0].name in SHOWN
    }
    return pd.DataFrame(
        [(name, *map(str, values)) for name, values in rows.items()], columns=["", OLD, NEW]
    )


def _modes() -> pd.DataFrame:
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
    """Results of the cases, beside those of the same cases with orthonormal modes if these are
    given."""
    models = {", as published": cases, ", Eq. (17)": new} if new else {"": cases}
    values = [
        values_text(dict(case.parameters)) + (", separation ignored" if case.bonded else "")
        for case in cases
    ]
    columns = {"Case": [case.name for case in cases], "Parameters": values}
    columns |= {
        f"First separation{which}": [*map(_first, those)] for which, those in models.items()
    }
    for which, those in models.items():
        columns[f"Growth{which} (1/s)"] = [
            rate_text(case.growth_rate, without="–") for case in those
        ]
    return pd.DataFrame(columns | {f"P in the end{[*models][-1]} (N)": [*map(_late, new or cases)]})


def _verdicts(
    published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]
) -> pd.DataFrame:
    """The rows of the ledger that are judged by cases, as they come out for both."""
    table = judge(
        [row for row in ROWS if row.cases], {"published": published, "orthonormal": orthonormal}
    )
    old, new = (part.set_index("id") for _, part in table.groupby("model", sort=False))
    by_model = new.index.isin(
        [row.get("also") for row in read_texts("paper/survival.yaml").values()]
    )
    columns = {
        "Place": pd.Series({row.id: row.place for row in ROWS}),
        "Statement": pd.Series({row.id: f"“{row.quote}”" for row in ROWS}),
        OLD: old["verdict"],
        NEW: new["verdict"].mask(by_model, "see model sensitivity"),
        f"Found {NEW[0].lower()}{NEW[1:]}": new["here"],
    }
    return pd.DataFrame(columns).loc[old.index]


def _first(case: CaseView) -> str:
    if case.status == "failed" or case.bonded:
        return "failed" if case.status == "failed" else "ignored"
    return or_none(case["first_separation"], ".2f", " s", f"none in {case['time_reached']:g} s")


def _late(case: CaseView) -> str:
    try:
        return f"{case.late:.1f}"
    except Missing:
        return "–"
