"""The ledger: every statement of the paper with a verdict, as a table and as a page with a summary on top."""

import re
from collections.abc import Mapping
from typing import Any

import pandas as pd

from disc_model.data.texts import fill
from disc_model.paper import precursor, section2, section41, section43, section44
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FALSE, TRUE, VERDICTS, Row, judge, read_texts, rows_of

MODULES = (section2, section41, section43, section44, precursor)
ROWS = tuple(row for module in MODULES for row in rows_of(module))  # in the order of the paper
COLUMNS = ["id", "section", "place", "quote", "verdict", "here", "matters", "notes"]
COLUMNS += ["rule", "figures", "data", "counts"]


def check_claims(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Judge all rows: a table with `COLUMNS`.

    figures and data : links from the folder of the paper's results, each with its words
    counts : "error in print" or "after the fact" if the row does not count for or against the paper

    cases : the paper's cases and the grid studies of `disc_model.paper.SCANS`; rows that need missing ones are not
        computed
    """
    table = judge(ROWS, {"": cases})
    parts = [re.sub(r"^(Sec\. 2)\.\d.*", r"\1", row.place.partition(",")[0]) for row in ROWS]
    table["section"] = ["Conclusions" if part.startswith("Conclusion") else part for part in parts]
    table["figures"], table["data"] = pd.Series(map(_figures, ROWS)), pd.Series(map(_data, ROWS))
    late = ["after the fact" if row.after_the_fact else "" for row in ROWS]
    table["counts"] = ["error in print" if row.print_error else word for row, word in zip(ROWS, late, strict=True)]
    for column in ("place", "quote", "matters", "rule"):
        table[column] = [getattr(row, column) for row in ROWS]
    return table[COLUMNS]


def _figures(row: Row) -> dict[str, str]:
    """Links to the pictures of a row, by their names."""
    return {f"Fig. {name[3:].lstrip('0')}" if name.startswith("fig") else name: _link(name) for name in row.figures}


def _link(figure: str) -> str:
    return f"figures/{figure}.png" if figure.startswith("fig") else f"../{figure}/figures/{figure}.png"


def _data(row: Row) -> dict[str, str]:
    """Links to the datasets and tables of a row."""
    links = {x: f"cases/{x}.nc" for x in row.cases} | {x: f"../{x}/{x}.nc" for x in row.scans + row.beside}
    return {f"table {name.replace('_', ' ')}": f"tables/{name}.html" for name in row.tables} | links


def summary(table: pd.DataFrame) -> dict[str, Any]:
    """What the page says on top: counts of verdicts, by part of the paper too, and sentences with their numbers. A
    sentence is said only if its row has the verdict that it speaks of."""
    texts = read_texts("ledger.yaml")
    counted = table[table["counts"] != "error in print"]
    parts = pd.crosstab(counted["section"], counted["verdict"]).reindex(
        index=counted["section"].unique(), columns=[*VERDICTS], fill_value=0
    )
    verdicts, here = (table.set_index("id")[column] for column in ("verdict", "here"))
    for name, verdict in (("headline", TRUE), ("stands", TRUE), ("falls", FALSE)):
        items = [(row, text) for row, text in texts[name].items() if verdicts[row] == verdict]
        texts[name] = [{"id": row, "text": fill(text, n=numbers(here[row]))} for row, text in items]
    links = {name: _link(name) for name in texts["pictures"]}
    counts = {"counts": parts.sum().to_dict(), "parts": parts, "errors": len(table) - len(counted)}
    return {**texts, **counts, "links": links}


def numbers(text: str) -> list[str]:
    """The numbers in a text, in its order."""
    return re.findall(r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)
