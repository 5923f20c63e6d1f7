"""How objects show themselves: as tables in notebooks, and as pictures."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape
from importlib import import_module
from typing import Any


def html_table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """A table for notebooks."""
    lines = [("th", head), *(("td", row) for row in rows)]
    cells = ("".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in row) for tag, row in lines)
    return f"<table>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"


class Summarised:
    """An object that a notebook shows as the table of its `_summary`, whose pairs without a value are left out."""

    def _summary(self) -> Iterable[tuple[str, object]]:
        raise NotImplementedError

    def _repr_html_(self) -> str:
        rows = [(name, value) for name, value in self._summary() if value not in ("", None)]
        return html_table((type(self).__name__, ""), rows)


def number_text(value: float, unit: str = "", digits: int = 6) -> str:
    """A number with its unit; empty if there is none."""
    return "" if math.isnan(value) else f"{value:.{digits}g} {unit}".strip()


def draw(picture: str, *inputs: Any, **options: Any) -> Any:
    """Draw by a function of `disc_model.figures.results`, which is above all that it draws.

    It is imported by its name, so that no result depends on how it is drawn.  Raises ModuleNotFoundError without
    matplotlib; the message names the extra that brings it.
    """
    try:
        return getattr(import_module("disc_model.figures.results"), picture)(*inputs, **options)
    except ModuleNotFoundError as error:
        if str(error.name).startswith("disc_model"):
            raise
        text = f"pictures need {error.name}: pip install 'disc_model[plot]' brings it"
        raise ModuleNotFoundError(text, name=error.name) from None
