"""The options of quantities as tables, for pages and messages."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from disc_model.studies.quantity import Quantity
from disc_model.units import Unit


class Option(NamedTuple):
    """One option of a quantity, in texts.

    Attributes
    ----------
    name : its key under `options`
    form : what is given, such as "whole number from 1 to 100"
    unit : SI unit, "" without one
    default : as a study file has it; "required" without one
    meaning : what it is
    """

    name: str
    form: str
    unit: str
    default: str
    meaning: str


def options_of(quantity: type[Quantity]) -> list[Option]:
    """The options of a quantity, required ones first."""
    properties = quantity.model_json_schema()["properties"]
    options = []
    for name, field in quantity.model_fields.items():
        schema = properties[name]
        default = "required" if field.is_required() else value_text(field.get_default())
        meaning = " ".join(str(field.description).split())
        options.append(Option(name, _form(schema), _unit(field, schema), default, meaning))
    return sorted(options, key=lambda option: option.default != "required")


def value_text(value: Any) -> str:
    """A value of an option as a study file has it, "" for none."""
    match value:
        case None:
            return ""
        case bool():
            return str(value).lower()
        case float():
            return f"{value:g}"
        case list() | tuple():
            return f"[{', '.join(map(value_text, value))}]"
        case Mapping():
            entries = [f"{key}: {value_text(part)}" for key, part in value.items()]
            return "{" + ", ".join(entries) + "}"
        case _:
            return str(value)


def _form(schema: Mapping[str, Any]) -> str:
    """What may be given, by a property of a JSON schema."""
    alternatives = [each for each in schema.get("anyOf", ()) if each.get("type") != "null"]
    if alternatives:
        return _form(alternatives[0])
    if "enum" in schema:
        return " or ".join(f"`{word}`" for word in schema["enum"])
    if schema.get("$ref", "").endswith("/Range"):
        return "range {start, stop, count or step}"
    kind = schema.get("type", "object")
    if kind == "array":
        return "two numbers" if schema.get("maxItems") == 2 else "list of numbers"
    words = {"integer": "whole number", "boolean": "true or false", "object": "mapping"}
    words["string"] = "name of a number of the case"
    return words.get(kind, "number") + _limits(schema)


def _limits(schema: Mapping[str, Any]) -> str:
    """The limits of a number, with the space before."""
    if "ge" in schema and "le" in schema:
        return f" from {schema['ge']:g} to {schema['le']:g}"
    signs = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
    given = [key for key in signs if key in schema]
    limits = [f"{signs[key]} {schema[key]:g}" for key in given]
    return " " + " and ".join(limits) if limits else ""


def _unit(field: Any, schema: Mapping[str, Any]) -> str:
    """The unit of a number, or of the numbers in a list or mapping."""
    mark = next((part for part in field.metadata if isinstance(part, Unit)), None)
    if mark is not None and mark.of:
        return f"that of `{mark.of}`"
    if mark is not None and isinstance(mark.name, Mapping):
        return ", ".join(map(str, mark.name.values()))
    unit = schema.get("unit") or schema.get("items", {}).get("unit") or ""
    return str(unit)
