"""Sentences of README, docs and captions whose numbers come from results.

``docs/statements.yaml`` has them, each with an expression in the place of a number; the values of
the expressions are stored as ``docs/numbers.json``.
"""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from string import Formatter, Template
from typing import Any, NamedTuple

import numpy as np
import yaml

ROOT = Path(__file__).parents[1]
STORED = ROOT / "docs" / "numbers.json"
STATEMENTS = yaml.safe_load((ROOT / "docs" / "statements.yaml").read_text(encoding="utf-8"))
PAGES = ["README.md", "docs/**/*.md", "config/**/*.yaml"]
"""Texts in which statements are looked for."""
NUMBER = r"[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?"
COUNTS = [
    "none",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
]
"""Counts in words, by their number."""
NOISE = 1e-6
"""Relative difference to which results of two processors agree (docs/verification.md).

Where a last bit decides, `tolerances` of statements.yaml says so.
"""
Value = float | str


# ---- Numbers in texts


def numbers_of(text: str) -> list[float]:
    """Return the numbers of a text that are no part of a word."""
    found = re.findall(rf"(?<![A-Za-z\d]){NUMBER}", text)
    return [float(number.replace(",", "")) for number in found]


def shown(value: Value, spec: str) -> str:
    """Return a value as a page shows it.

    Parameters
    ----------
    value : a number or a text
    spec : its format; ``w`` stands for a count in words
    """
    if isinstance(value, str):
        return value
    if spec == "w":
        return COUNTS[round(value)]
    return format(value, spec or ".0f").replace("e-0", "e-")


def agrees(text: str, value: Value, spec: str) -> bool:
    """Return whether a text shows a value.

    Where noise decides how the last digit is rounded, both ways are right.
    """
    values: list[Value] = [value]
    if not isinstance(value, str):
        values = [value * (1 - NOISE), value * (1 + NOISE)]
    return text.lower() in {shown(each, spec).lower() for each in values}


def reproduced(expression: str, text: str, value: Value, spec: str) -> bool:
    """Return whether a value that was computed anew is that of a text, on any processor.

    Parameters
    ----------
    expression : of the value
    text : that shows the stored value
    value : the new value
    spec : its format
    """
    if agrees(text, value, spec):
        return True
    for tolerance in STATEMENTS["tolerances"]:
        if re.match(tolerance["expression"], expression):
            old_words, old = _parts(text)
            new_words, new = _parts(shown(value, spec))
            relative = tolerance.get("relative", 0.0)
            absolute = tolerance.get("absolute", 0.0) * (1 + 1e-9)
            return old_words == new_words and np.allclose(old, new, rtol=relative, atol=absolute)
    return False


def _parts(text: str) -> tuple[list[str], list[float]]:
    """Return a text without its numbers, and these; counts in words are numbers as well."""
    if text in COUNTS:
        text = str(COUNTS.index(text))
    return re.split(NUMBER, text), numbers_of(text)


# ---- Statements


class Statement(NamedTuple):
    """A sentence with expressions in the place of numbers.

    Attributes
    ----------
    text : the sentence
    page : end of the paths of the pages that say it
    fields : expressions of its numbers, with their formats
    pattern : finds it on a page, with links or without
    """

    text: str
    page: str
    fields: list[tuple[str, str]]
    pattern: re.Pattern[str]

    @classmethod
    def parse(cls, text: str, page: str = "") -> Statement:
        """Return the statement of a sentence."""
        fields = []
        pattern = ""
        for literal, expression, spec, _ in Formatter().parse(text):
            for token in re.findall(r"\s+|\w+|[^\s\w]", literal):
                pattern += _token_pattern(token)
            if expression is not None:
                fields.append((expression, spec or ""))
                pattern += r"([^|\n]*?)" if spec == "s" else rf"({NUMBER}|\w+)"
        return cls(text, page, fields, re.compile(pattern))


def _token_pattern(token: str) -> str:
    """Return the pattern of a word, of a sign or of space, before which a link may end."""
    link = r"(?:\]\([^)]*\))?"
    if token.isspace():
        return rf"{link}\s+\[?"
    if token[0].isalnum():
        return re.escape(token)
    return link + re.escape(token)


@cache
def statements() -> tuple[Statement, ...]:
    """Return all statements; one with `each` stands for as many as its lists have values."""
    found = []
    for entry in STATEMENTS["statements"]:
        if isinstance(entry, str):
            found.append(Statement.parse(entry))
            continue
        for names in _replacements(entry):
            text = Template(entry["text"]).substitute(names)
            page = Template(entry.get("page", "")).substitute(names)
            found.append(Statement.parse(text, page))
    return tuple(found)


def _replacements(entry: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the names of an entry with their texts, one mapping for each of its statements."""
    common = entry.get("with", {})
    each = entry.get("each")
    if not each:
        return [common]
    rows = zip(*each.values(), strict=True)
    return [{**common, **dict(zip(each, row, strict=True))} for row in rows]


@cache
def expressions() -> tuple[tuple[str, str], ...]:
    """Return the expressions of all statements with their formats, sorted."""
    return tuple(sorted({field for statement in statements() for field in statement.fields}))


# ---- Pages


@cache
def pages() -> dict[str, str]:
    """Return texts in which statements are looked for, by path."""
    texts = {}
    for pattern in PAGES:
        for path in sorted(ROOT.glob(pattern)):
            if "_build" not in path.parts:
                texts[str(path.relative_to(ROOT))] = path.read_text(encoding="utf-8")
    return texts


class Fault(NamedTuple):
    """A number of a page that is not that of a statement."""

    page: str
    match: re.Match[str]
    """The sentence on the page."""
    group: int
    """Which of its numbers it is."""
    number: str
    """What has to stand there."""


def faults(
    statement: Statement, texts: dict[str, str], values: dict[str, Value]
) -> tuple[int, list[Fault]]:
    """Return how often texts say a statement, and what is wrong in them.

    Parameters
    ----------
    statement : the statement
    texts : by page
    values : by expression
    """
    count = 0
    wrong = []
    for page, text in texts.items():
        if not page.endswith(statement.page):
            continue
        for match in statement.pattern.finditer(text):
            count += 1
            for i, (expression, spec) in enumerate(statement.fields, 1):
                if not agrees(match[i], values[expression], spec):
                    wrong.append(Fault(page, match, i, shown(values[expression], spec)))
    return count, wrong


def corrected(texts: dict[str, str], values: dict[str, Value]) -> dict[str, str]:
    """Return texts with the numbers of all statements.

    Parameters
    ----------
    texts : by page
    values : by expression
    """
    texts = dict(texts)
    for statement in statements():
        _, wrong = faults(statement, texts, values)
        for fault in reversed(wrong):  # from the end, so that places before stay
            text = texts[fault.page]
            before = text[: fault.match.start(fault.group)]
            after = text[fault.match.end(fault.group) :]
            texts[fault.page] = before + fault.number + after
    return texts


def stored() -> dict[str, Value]:
    """Return the stored values of the expressions."""
    values: dict[str, Value] = json.loads(STORED.read_text(encoding="utf-8"))
    return values


def store(values: dict[str, Value]) -> None:
    """Write values of the expressions."""
    text = json.dumps(values, indent=0, ensure_ascii=False)
    STORED.write_text(text + "\n", encoding="utf-8")
