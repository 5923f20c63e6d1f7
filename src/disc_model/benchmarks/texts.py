"""The texts of passages, read from ``texts.yaml``, and tables and reports in Markdown."""

import math
from pathlib import Path

import pandas as pd

from disc_model.data.dataset import markdown_table
from disc_model.data.texts import read_passages

TEXTS = read_passages(Path(__file__).with_name("texts.yaml"))


def as_markdown(frame: pd.DataFrame) -> str:
    """A table in Markdown."""
    return "\n".join(markdown_table(frame.columns, frame.itertuples(index=False)))


def report(title: str, about: str, frame: pd.DataFrame, by: str) -> str:
    """A page in Markdown: the columns of a table, in a section for each value of ``by``."""
    shown = frame.map(_cell).rename(columns=_cell)
    sections = (f"## {name}\n\n{as_markdown(part.drop(columns=by))}" for name, part in shown.groupby(by, sort=False))
    return "\n\n".join([f"# {title}", about, *sections]) + "\n"


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.5g}" if math.isfinite(value) else "-"
    return str(value).replace("_", " ") or "-"
