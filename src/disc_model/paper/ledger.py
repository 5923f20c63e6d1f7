"""The ledger: every statement of the paper with a verdict, as a table and as a page with a summary on top."""

import re
from collections.abc import Mapping
from typing import Any

import pandas as pd

from disc_model.data.texts import fill
from disc_model.paper import section2, section41, section43, section44
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FALSE, TRUE, VERDICTS, Row, judge, read_texts, rows_of

MODULES = (section2, section41, section43, section44)
CHECKS = {name: check for module in MODULES for name, check in vars(module).items()}
FILES = ("paper/section2.yaml", "paper/section41.yaml", "paper/section43.yaml", "paper/section44.yaml")
ROWS = tuple(row for file in (*FILES, "paper/precursor.yaml") for row in rows_of(file, CHECKS))
COLUMNS = ["id", "section", "place", "quote", "verdict", "here", "matters", "notes"]
COLUMNS += ["rule", "figures", "data", "counts"]


def check_claims(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Judge all rows: a table with `COLUMNS`; figures and data are links from the paper's results, by their words."""
    return judge(ROWS, {"": cases}).join(pd.DataFrame(map(_stated, ROWS)))[COLUMNS]


def _stated(row: Row) -> dict[str, Any]:
    """The columns of a row that do not depend on what was computed."""
    part = re.sub(r"^(Sec\. 2)\.\d.*", r"\1", row.place.partition(",")[0])
    names = {name: f"Fig. {name[3:].lstrip('0')}" if name.startswith("fig") else name for name in row.figures}
    data = {f"table {name.replace('_', ' ')}": f"tables/{name}.html" for name in row.tables}
    data |= {x: f"cases/{x}.nc" for x in row.cases} | {x: f"../{x}/{x}.nc" for x in row.scans + row.beside}
    return {name: getattr(row, name) for name in ("place", "quote", "matters", "rule")} | {
        "section": "Conclusions" if part.startswith("Conclusion") else part,
        "figures": {words: _link(name) for name, words in names.items()},
        "data": data,
        "counts": "error in print" if row.print_error else "after the fact" * row.after_the_fact,
    }


def _link(figure: str) -> str:
    return f"figures/{figure}.png" if figure.startswith("fig") else f"../{figure}/figures/{figure}.png"


def summary(table: pd.DataFrame) -> dict[str, Any]:
    """What the page says on top: counts of verdicts, and sentences whose rows have the verdicts that they speak of."""
    texts = read_texts("paper/ledger.yaml")
    counted = table[table["counts"] != "error in print"]
    parts = pd.crosstab(counted["section"], counted["verdict"])
    parts = parts.reindex(index=counted["section"].unique(), columns=[*VERDICTS], fill_value=0)
    verdicts = table.set_index("id")["verdict"]
    numbers = table.set_index("id")["here"].str.findall(r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
    for name, verdict in (("headline", TRUE), ("stands", TRUE), ("falls", FALSE)):
        items = [(row, text) for row, text in texts[name].items() if verdicts[row] == verdict]
        texts[name] = [{"id": row, "text": fill(text, n=numbers[row])} for row, text in items]
    links = {name: _link(name) for name in texts["pictures"]}
    counts = {"counts": parts.sum().to_dict(), "parts": parts, "errors": len(table) - len(counted)}
    return {**texts, **counts, "links": links}
