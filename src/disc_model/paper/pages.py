"""Pages of the ledger and other tables: Markdown, and self-contained HTML for light and dark backgrounds."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from string import Template
from typing import Any

import pandas as pd
import yaml

from disc_model.data.dataset import markdown_table
from disc_model.paper.model import FAILS, FOLDER, HOLDS, NOT_COMPUTED, NOT_TESTABLE, REMARK, UNDECIDED

TEXTS: dict[str, dict[str, Any]] = yaml.safe_load((FOLDER / "pages.yaml").read_text(encoding="utf-8"))
"""The texts of each page."""
CLASSES = {HOLDS: "good", REMARK: "note", FAILS: "bad", UNDECIDED: "note"}
CLASSES |= dict.fromkeys((NOT_TESTABLE, NOT_COMPUTED), "none")
CLAIM_WIDTHS = (5, 11, 18, 13, 30, 9, 14)
"""Widths of the ledger's columns, in per cent."""


def page(title: str, *body: str) -> str:
    """A whole HTML document."""
    template = Template((FOLDER / "page.html").read_text(encoding="utf-8"))
    return template.substitute(title=escape(title), body="\n".join(body))


def to_markdown(table: pd.DataFrame) -> str:
    """The table as a Markdown document, with a count of the verdicts above it."""
    header = [name.replace("_", " ").replace("ours", "computed") for name in map(str, table.columns)]
    lines = ["# The paper's claims", "", f"{len(table)} claims; {_counts(table)}.", ""]
    lines += markdown_table(header, table.itertuples(index=False))
    return "\n".join(lines) + "\n"


def ledger(table: pd.DataFrame) -> str:
    """The table of claims as a page, with the counts of the verdicts above it."""
    texts, summary = TEXTS["ledger"], f"{len(table)} statements; {_counts(table)}"
    rows = [_claim(row) for row in table.to_dict("records")]
    return page(texts["title"], f"<p>{escape(summary)}.</p>", _table(texts["head"], rows, CLAIM_WIDTHS))


def _counts(table: pd.DataFrame) -> str:
    """Counts of the verdicts, and of the rows that these leave out."""
    counted = table["apart"] == ""
    count = table.loc[counted, "verdict"].str.partition(":")[0].value_counts()
    phrase = ", ".join(f"{verdict}: {number}" for verdict, number in count.items())
    return (
        phrase if counted.all() else f"{phrase}; not counted, for they repeat others or are misprints: {sum(~counted)}"
    )


def _claim(row: Mapping[Any, Any]) -> list[str]:
    shown, _, missing = row["verdict"].partition(":")
    cells = (
        escape(row["id"]),
        escape(row["location"]),
        escape(row["claim"]),
        escape(row["paper_value"]),
        escape(row["ours"]) + "".join(_small(row[name]) for name in ("remark", "apart") if row[name]),
        f'<span class="verdict {CLASSES.get(shown, "")}">{escape(shown)}</span>{_small(missing)}',
        escape(row["tolerance"]) + "".join(_small(row[name]) for name in ("reason", "robust") if row[name]),
    )
    return [f"<td>{cell}</td>" for cell in cells]


def _small(text: str) -> str:
    return f'<div class="small">{escape(text)}</div>'


@dataclass(frozen=True)
class Comparison:
    """Sections of a page: heading, text, table."""

    title: str
    sections: tuple[tuple[str, str, pd.DataFrame], ...]

    def markdown(self) -> str:
        lines = [f"# {self.title}", ""]
        for heading, text, table in self.sections:
            lines += [f"## {heading}", "", text, "", *markdown_table(table.columns, table.itertuples(index=False)), ""]
        return "\n".join(lines)

    def html(self) -> str:
        body = [f"<h2>{escape(h)}</h2><p>{escape(text)}</p>{table_html(table)}" for h, text, table in self.sections]
        return page(self.title, *body)


def table_page(title: str, note: str, table: pd.DataFrame) -> str:
    """A table as a page, with a note above it."""
    return page(title, f"<p>{escape(note)}</p>", table_html(table))


def table_html(table: pd.DataFrame) -> str:
    """The table as HTML, without a page."""
    rows = [[_cell(value) for value in row] for row in table.itertuples(index=False)]
    return _table([str(name) for name in table.columns], rows)


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f'<td class="number">{"" if math.isnan(value) else f"{value:g}"}</td>'
    return f"<td>{escape(str(value))}</td>"


def _table(head: Sequence[str], rows: Iterable[Iterable[str]], widths: Sequence[int] = ()) -> str:
    styles = [f' style="width: {width}%"' for width in widths] or [""] * len(head)
    top = "".join(f"<th{style}>{escape(name)}</th>" for name, style in zip(head, styles, strict=True))
    body = "\n".join(f"<tr>{''.join(cells)}</tr>" for cells in rows)
    return f"<table><thead><tr>{top}</tr></thead><tbody>\n{body}\n</tbody></table>"
