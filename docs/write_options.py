"""The page of all options of quantities, from the functions that check them: made with the site."""

from collections.abc import Iterable, Mapping
from typing import Any

from numpydoc.docscrape import NumpyDocString
from pydantic_core import PydanticUndefined

from disc_model.studies.quantity import HOMES, Quantity, quantity_of
from disc_model.units import Unit

HEAD = """\
# Options of quantities

All keys under `options` of a study file, by [quantity](study_reference.md#quantities), and arguments of the function of
this name in Python. *Required* ones have no default. Numbers may have [units](study_reference.md#axes).
`lines` and `rates` are lists of numbers and of ranges such as `{start: 5, stop: 50, count: 10}`, or one range.
"""
HEADS = ("option", "type", "unit", "default", "meaning")
KINDS = {
    "float": "number",
    "int": "whole number",
    "bool": "true or false",
    "str": "name",
    "tuple": "numbers",
    "dict": "mapping",
    "Start": "mapping",
}


def page_text() -> str:
    """The page: a table of the options of each quantity, as Markdown."""
    sections = []
    for name in HOMES:
        lines = [HEADS, ["---"] * len(HEADS), *_rows(quantity_of(name))]
        table = "".join(f"| {' | '.join(cells)} |\n" for cells in lines)
        sections.append(f"\n## {name}\n\n{table}")
    return HEAD + "".join(sections)


def _rows(quantity: Quantity) -> Iterable[list[str]]:
    """The cells of each option, required ones first."""
    meanings = _meanings(quantity.function.__doc__ or "")
    fields = quantity.options.model_fields.items()
    for name, field in sorted(fields, key=lambda item: not item[1].is_required()):
        parts = [*field.metadata, field.annotation]
        default = _text(field.default) if field.default is not PydanticUndefined else "*required*"
        kind = KINDS.get(str(getattr(field.annotation, "__name__", "")), "")
        yield [f"`{name}`", kind, _unit(parts), default, meanings[name]]


def _meanings(docstring: str) -> Mapping[str, str]:
    """What each option is, by its entry in the section of parameters, which begins where numpydoc has a type."""
    entries = NumpyDocString(docstring)["Parameters"]
    return {entry.name: " ".join([entry.type, *entry.desc]) for entry in entries}


def _unit(parts: list[Any]) -> str:
    """The unit of a number, or of the numbers in a list."""
    for part in parts:
        if isinstance(part, Unit):
            if part.of:
                return f"that of `{part.of}`"
            return part.name if isinstance(part.name, str) else "that of the parameter"
        parts += getattr(part, "__args__", ())
        parts += getattr(part, "__metadata__", ())
    return ""


def _text(value: Any) -> str:
    """A default as a study file has it, "" for none and for the static start."""
    if isinstance(value, bool):
        return f"`{value}`".lower()
    if isinstance(value, tuple):
        return f"`{[*value]}`"
    return f"`{value}`" if isinstance(value, int | float | str) else ""
