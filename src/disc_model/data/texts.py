"""Sentences and pages: jinja2 templates that are stored as data, and completed with numbers."""

import math
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
import pandas as pd

from disc_model.data.dataset import markdown_table

UNITS = {"%": 100, "mm": 1e3, "ms": 1e3, "GPa": 1e-9}
"""Units that a format may name after a space, by how many of them are one of the number's own."""
Section = tuple[str, str, pd.DataFrame]  # part of a page: its heading, or "", a text and a table


def number_text(value: Any, form: str) -> Any:
    """A number, or each of a list, in a format such as ``.1f`` or ``.1f mm``: ``{{ width|as('.1f
    mm') }}``."""
    if isinstance(value, list | np.ndarray):
        return [number_text(each, form) for each in value]
    digits, _, unit = form.partition(" ")
    if not unit:
        return format(value, form)
    return f"{UNITS[unit] * value:{digits}} {unit}"


def _listed(value: Any) -> Any:
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    return value


def _cell(value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    if math.isnan(value):
        return ""
    return f"{value:g}"


_TEMPLATES = jinja2.Environment(
    autoescape=jinja2.select_autoescape(["html"], default_for_string=False),
    undefined=jinja2.StrictUndefined,
    finalize=_listed,
    trim_blocks=True,
    keep_trailing_newline=True,
)
_TEMPLATES.filters |= {
    "as": number_text,
    "cell": _cell,
    "markdown": lambda table: "\n".join(
        markdown_table(table.columns, table.map(_cell).itertuples(index=False))
    ),
}
_template_of = cache(_TEMPLATES.from_string)


def fill(template: str, **values: Any) -> str:
    """A template filled with values; raises `jinja2.UndefinedError` if one is missing."""
    return _template_of(template).render(values)


def write_page(
    path: str | Path, title: str, *sections: Section, template: Path = Path(__file__)
) -> None:
    """Write a page as Markdown or as self-contained HTML, by the ending of the file; template: its
    path, whatever its ending."""
    path = Path(path)
    templates = _TEMPLATES.overlay(loader=jinja2.FileSystemLoader(template.parent))
    page = templates.get_template(f"{template.stem}{path.suffix}").render(
        title=title, sections=sections
    )
    path.write_text(page.rstrip() + "\n", encoding="utf-8")
