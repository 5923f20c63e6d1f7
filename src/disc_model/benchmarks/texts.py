"""The texts of passages and reports, read from ``texts.yaml``, and what stands in them."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from disc_model.data.dataset import markdown_table
from disc_model.data.texts import read_passages

TEXTS = read_passages(Path(__file__).with_name("texts.yaml"))


def plain(number: float) -> str:
    """A number with two digits, without a power of ten."""
    return f"{float(f'{number:.2g}'):,.10g}"


def as_markdown(frame: pd.DataFrame) -> str:
    """A table in Markdown."""
    return "\n".join(markdown_table(frame.columns, frame.itertuples(index=False)))
