"""The texts of pages and passages, read from ``texts.yaml``."""

from __future__ import annotations

from pathlib import Path

from disc_model.data.texts import read_passages

TEXTS = read_passages(Path(__file__).with_name("texts.yaml"))


def plain(number: float) -> str:
    """A number with two digits, without a power of ten."""
    return f"{float(f'{number:.2g}'):,.10g}"
