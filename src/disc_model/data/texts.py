"""Sentences with placeholders, stored as data, and their completion with numbers."""

import string
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, model_validator


class Part(BaseModel):
    """Templates for a value that is a list of rows: ``each`` for every row, ``around`` for all if there are any.

    A plain text is that for every row.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    each: str
    between: str = "; "
    around: str = "{}"
    empty: str = ""

    @model_validator(mode="before")
    @classmethod
    def _of_every_row(cls, raw: Any) -> Any:
        return {"each": raw} if isinstance(raw, str) else raw


UNITS = {"%": 100, "mm": 1e3, "ms": 1e3, "GPa": 1e-9}
"""Units that a format may name after a space, ``{width:.1f mm}``, by how many of them are one of the number's own."""


class Sentences(string.Formatter):
    """`str.format` that also takes units, see `UNITS`, and lists.

    Lists of numbers are formatted as one, ``{values:.2f}``, or as "none", and lists of rows by the part of their name.
    """

    def __init__(self, parts: Mapping[str, Part], values: Mapping[str, Any]) -> None:
        self.parts, self.values = parts, values

    def fill(self, template: str) -> str:
        """The template filled with the values; raises KeyError for a missing value."""
        return self.vformat(template, (), self.values)

    def get_value(self, key: int | str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        value = kwargs[str(key)]
        if key not in self.parts:
            return value
        part, rows = self.parts[str(key)], value if isinstance(value, list) else [value]
        phrase = part.between.join(self.vformat(part.each, (), {**kwargs, **row}) for row in rows)
        return part.around.format(phrase) if rows else part.empty

    def format_field(self, value: Any, spec: str) -> str:
        if isinstance(value, list | np.ndarray):
            return ", ".join(self.format_field(each, spec) for each in value) or "none"
        own, _, unit = spec.rpartition(" ")
        return f"{format(UNITS[unit] * value, own)} {unit}" if unit in UNITS else format(value, spec)
