"""The ledger and other tables for readers: Markdown, and self-contained HTML pages for light and dark backgrounds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

import pandas as pd

from disc_model.claims.model import FAILS, HOLDS, NOT_COMPUTED, REMARK, UNDECIDED
from disc_model.data.dataset import markdown_table

STYLE = """
:root { color-scheme: light dark; --text: #1b1b1b; --back: #ffffff; --line: #cccccc; --head: #f2f2f2; --soft: #555555;
  --good: #00684b; --note: #7a4f00; --bad: #a63c00; }
@media (prefers-color-scheme: dark) { :root { --text: #e6e6e6; --back: #16181b; --line: #444444; --head: #24272b;
  --soft: #a8a8a8; --good: #4fd0a5; --note: #f0b54a; --bad: #ff9459; } }
body { font: 14px/1.45 system-ui, sans-serif; color: var(--text); background: var(--back); margin: 1.5rem; }
h1 { font-size: 1.3rem; margin: 0 0 .5rem; } p { max-width: 60rem; }
table { border-collapse: collapse; width: 100%; } td.number { text-align: right; white-space: nowrap; }
th, td { border-bottom: 1px solid var(--line); padding: .35rem .5rem; text-align: left; vertical-align: top; }
th { background: var(--head); position: sticky; top: 0; }
.small { color: var(--soft); font-size: 12px; } .verdict { font-weight: 600; }
.good { color: var(--good); } .note { color: var(--note); } .bad { color: var(--bad); } .none { color: var(--soft); }
"""
CLASSES = {HOLDS: "good", REMARK: "note", FAILS: "bad", UNDECIDED: "note", NOT_COMPUTED: "none"}


def page(title: str, *body: str) -> str:
    """A whole HTML document."""
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{STYLE}</style>'
    return f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body><h1>{escape(title)}</h1>\n' + "\n".join(
        [*body, "</body></html>\n"]
    )


def to_markdown(table: pd.DataFrame) -> str:
    """The table as a Markdown document, with a count of the verdicts above it."""
    header = [name.replace("_", " ").replace("ours", "computed") for name in map(str, table.columns)]
    lines = ["# The paper's claims", "", f"{len(table)} claims; {_counts(table)}.", ""]
    lines += markdown_table(header, table.itertuples(index=False))
    return "\n".join(lines) + "\n"


def ledger(table: pd.DataFrame) -> str:
    """The table of claims as a page, with the counts of the verdicts above it."""
    summary = f"{len(table)} statements; {_counts(table)}"
    rows = [_claim(row) for row in table.to_dict("records")]
    head = ("", "Place", "Statement, in our words", "Paper", "Computed", "Verdict", "Tolerance")
    return page("The paper's claims, checked", f"<p>{escape(summary)}.</p>", _table(head, rows, CLAIM_WIDTHS))


def _counts(table: pd.DataFrame) -> str:
    """How often each verdict was given."""
    count = table["verdict"].str.partition(":")[0].value_counts()
    return ", ".join(f"{verdict}: {number}" for verdict, number in count.items())


def _claim(row: Mapping[Any, Any]) -> list[str]:
    shown, _, missing = row["verdict"].partition(":")
    cells = (
        escape(row["id"]),
        escape(row["location"]),
        escape(row["claim"]),
        escape(row["paper_value"]),
        escape(row["ours"]) + (_small(row["remark"]) if row["remark"] else ""),
        f'<span class="verdict {CLASSES.get(shown, "")}">{escape(shown)}</span>{_small(missing)}',
        escape(row["tolerance"]) + (_small(row["reason"]) if row["reason"] else ""),
    )
    return [f"<td>{cell}</td>" for cell in cells]


def _small(text: str) -> str:
    return f'<div class="small">{escape(text)}</div>'


def table_page(title: str, note: str, table: pd.DataFrame, names: Mapping[str, str] | None = None) -> str:
    """Any table as a page; `names` are headings by column."""
    return page(title, f"<p>{escape(note)}</p>" if note else "", table_html(table.rename(columns=names or {})))


def table_html(table: pd.DataFrame) -> str:
    """The table alone."""
    rows = [[_cell(value) for value in row] for row in table.itertuples(index=False)]
    return _table([str(name) for name in table.columns], rows)


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f'<td class="number">{"" if math.isnan(value) else f"{value:g}"}</td>'
    return f"<td>{escape(str(value))}</td>"


CLAIM_WIDTHS = (5, 11, 18, 13, 30, 9, 14)
"""Of the columns of the ledger, in hundredths."""


def _table(head: Sequence[str], rows: Iterable[Iterable[str]], widths: Sequence[int] = ()) -> str:
    styles = [f' style="width: {width}%"' for width in widths] or [""] * len(head)
    top = "".join(f"<th{style}>{escape(name)}</th>" for name, style in zip(head, styles, strict=True))
    body = "\n".join(f"<tr>{''.join(cells)}</tr>" for cells in rows)
    return f"<table><thead><tr>{top}</tr></thead><tbody>\n{body}\n</tbody></table>"
