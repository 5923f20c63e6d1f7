"""Sentences with placeholders, kept as data, and the numbers that they are filled with."""

from __future__ import annotations

import string
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict


class Part(BaseModel):
    """What is said of a value that is a list of rows: ``each`` of every row, ``around`` all if there are any."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    each: str
    between: str = "; "
    around: str = "{}"
    empty: str = ""


def _part(raw: Any) -> Any:
    return {"each": raw} if isinstance(raw, str) else raw


Parts = dict[str, Annotated[Part, BeforeValidator(_part)]]
"""By the name of the value; a text stands for its ``each``."""


class Sentences(string.Formatter):
    """`str.format` for lists as well: of numbers, ``{values:.2f}``, and of rows, each said by the part of its name."""

    def __init__(self, parts: Mapping[str, Part], values: Mapping[str, Any]) -> None:
        self.parts, self.values = parts, values

    def fill(self, template: str) -> str:
        """The template with the values; raises KeyError for a value that is not there."""
        return self.vformat(template, (), self.values)

    def get_value(self, key: int | str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        value = kwargs[str(key)]
        if key not in self.parts:
            return value
        part, rows = self.parts[str(key)], value if isinstance(value, list) else [value]
        said = part.between.join(self.vformat(part.each, (), {**kwargs, **row}) for row in rows)
        return part.around.format(said) if rows else part.empty

    def format_field(self, value: Any, spec: str) -> str:
        if isinstance(value, list | np.ndarray):
            return ", ".join(format(each, spec) for each in value)
        return format(value, spec)


class Passage(BaseModel):
    """A text with its parts."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    text: str
    parts: Parts = {}

    def fill(self, **values: Any) -> str:
        return Sentences(self.parts, values).fill(self.text)


def read_passages(path: Path) -> dict[str, Passage]:
    """The passages of a YAML file by name."""
    import yaml

    raw = yaml.safe_load(path.read_text(encoding="utf-8"))
    return {name: Passage.model_validate(_text(passage)) for name, passage in raw.items()}


def _text(raw: Any) -> Any:
    return {"text": raw} if isinstance(raw, str) else raw
