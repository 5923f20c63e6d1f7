"""Print the JSON Schema of study files, with which editors complete and check them: `make
schema`."""

import json
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, NoDefault, models_json_schema

from disc_model.figures.kinds import KINDS
from disc_model.studies.quantity import HOMES, quantity_of
from disc_model.studies.study import Study


class _Plain(GenerateJsonSchema):
    """JSON Schema without redundant text: titles that repeat a name, and paragraphs of docstrings
    after the first."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def float_schema(self, schema: Any) -> Any:
        """Numbers may be given as text: with a unit, or because YAML reads 1e-3 as text."""
        return super().float_schema(schema) | {
            "type": ["number", "string"],
            "pattern": r"^\s*[-+.]*\d",
        }

    def get_default_value(self, schema: Any) -> Any:
        default = super().get_default_value(schema)
        return default if isinstance(default, str | int | float) else NoDefault

    def model_schema(self, schema: Any) -> Any:
        described = super().model_schema(schema)
        described.pop("title", None)
        if "description" in described:
            described["description"] = described["description"].split("\n\n")[0].replace("\n", " ")
        return described


def schema_text() -> str:
    """The JSON Schema of study files, as shipped; it describes the values of each key, but no rules
    between keys."""
    options = {name: quantity_of(name).options for name in HOMES}
    models: tuple[type[BaseModel], ...] = (Study, *options.values(), *KINDS.values())
    refs, content = models_json_schema(
        [(model, "validation") for model in models], schema_generator=_Plain
    )
    study = content["$defs"].pop(Study.__name__)
    of_kinds = [refs[kind, "validation"] for _, kind in sorted(KINDS.items())]
    others = {"type": "object", "properties": {"kind": {"pattern": r"^\w+\.\w+$"}}}
    of_any = {"anyOf": [*of_kinds, others, {"type": "null"}]}
    study["properties"]["figures"] = {"type": "object", "additionalProperties": of_any}
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A study of disc_model",
        **study,
        "anyOf": [{"required": [key]} for key in ("cases", "quantity", "studies")],
        "allOf": [
            {
                "if": {"properties": {"quantity": {"const": name}}, "required": ["quantity"]},
                "then": {"properties": {"options": refs[model, "validation"]}},
            }
            for name, model in options.items()
        ],
        **content,
    }
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    print(schema_text(), end="")
