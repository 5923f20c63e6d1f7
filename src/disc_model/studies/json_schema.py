"""The JSON Schema of study files, made from the models that check them: editors complete and check by it as one types.

``python -m disc_model.studies.json_schema`` prints it; what is shipped is ``workflow/schemas/study.schema.json``. It
knows what each key may hold, and not the rules between several: those are checked when the file is read.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from disc_model.figures.kinds import CASE_PLOTS, PLOTS
from disc_model.figures.paper.catalogue import CATALOGUE
from disc_model.parameters import AUTO, Parameters
from disc_model.simulation.case import Start
from disc_model.studies.grids.dimensions import VARIED, Range
from disc_model.studies.grids.quantities.schema import QUANTITIES
from disc_model.studies.grids.schema import BatchSpec
from disc_model.studies.schema import Case, Document, RecordSpec
from disc_model.truncation import QUANTITIES as CHOSEN_BY

Schema = dict[str, Any]

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def study_schema() -> Schema:
    """The schema of a study file."""
    defs: Schema = {}
    whole = _of(Document, defs)
    properties = whole["properties"]
    parameters = _parameters(defs)
    case, start, record = _of(Case, defs), _of(Start, defs), _partial(_of(RecordSpec, defs), defs)
    case["properties"] |= {"parameters": parameters, "record": record, "start": start}
    properties["base"] = parameters
    properties["tol"] = case["properties"]["tol"]
    properties["record"] = record
    properties["cases"] = {"type": "object", "minProperties": 1, "additionalProperties": case}
    properties["resolution"] = {"type": "integer", "minimum": 1}
    properties["figures"] = _figures(defs)
    properties["quantity"] = {"enum": list(QUANTITIES)}
    properties["options"] = {"type": "object"}
    axis = {"$ref": "#/$defs/Axis"}
    columns = {"type": "object", "properties": dict.fromkeys(VARIED, axis), "additionalProperties": False}
    properties["axes"] = {**columns, "minProperties": 1}
    properties["zip"] = {"anyOf": [columns, {"type": "array", "items": columns}]}
    properties["batch"] = _of(BatchSpec, defs)
    properties["starts"] = {"type": "object", "additionalProperties": start}
    defs["Axis"] = _axis(defs)
    options = {name: _of(quantity.options, defs) for name, quantity in QUANTITIES.items()}
    whole |= {
        "$schema": DIALECT,
        "title": "A study of disc_model",
        "description": "A grid, named cases, or both, and figures of either: docs/studies.md.",
        "anyOf": [{"required": [key]} for key in ("cases", "quantity", "studies")],
        "allOf": [_where("quantity", name, {"properties": {"options": said}}) for name, said in options.items()],
        "$defs": dict(sorted(defs.items())),
    }
    return whole


def text() -> str:
    """The schema as the file that is shipped holds it."""
    return json.dumps(study_schema(), indent=1, ensure_ascii=False) + "\n"


# ----------------------------------------------------------------------------------------------------
# Parts


def _of(model: type[BaseModel], defs: Schema) -> Schema:
    """A model's schema; what it refers to is added to `defs`."""
    found = model.model_json_schema()
    defs |= found.pop("$defs", {})
    return _plain(found)


def _plain(schema: Schema) -> Schema:
    """Without what says nothing: titles that repeat a name, and docstrings of more than their first line."""
    schema = dict(schema)
    schema.pop("title", None)
    if "description" in schema:
        schema["description"] = schema["description"].split("\n\n")[0].replace("\n", " ")
    if isinstance(schema.get("properties"), Mapping):
        schema["properties"] = {name: _plain(value) for name, value in schema["properties"].items()}
    return schema


def _parameters(defs: Schema) -> Schema:
    """Parameters, any of which may be left out; the number of modes may be left to each case."""
    found = _of(Parameters, defs)
    properties = found["properties"]
    properties["n_diameters"] = {"anyOf": [properties["n_diameters"], {"const": AUTO}]}
    properties["truncation_quantity"] = {"enum": list(CHOSEN_BY)}
    properties["truncation_tolerance"] = {"type": "number", "exclusiveMinimum": 0}
    found.pop("required", None)
    return found


def _partial(schema: Schema, defs: Schema) -> Schema:
    """What may be said in part, since the rest is inherited, and as null, which drops what is inherited."""
    if "$ref" in schema:
        return _partial(_plain(defs[schema["$ref"].rpartition("/")[2]]), defs)
    schema = {key: value for key, value in schema.items() if key != "required"}
    for key, inner in schema.items():
        if key in ("anyOf", "oneOf"):
            schema[key] = [_partial(part, defs) for part in inner]
        elif key in ("properties", "patternProperties"):
            schema[key] = {name: _or_null(_partial(part, defs)) for name, part in inner.items()}
        elif key == "additionalProperties" and isinstance(inner, Mapping):
            schema[key] = _or_null(_partial(dict(inner), defs))
    return schema


def _or_null(schema: Schema) -> Schema:
    return {"anyOf": [schema, {"type": "null"}]}


def _axis(defs: Schema) -> Schema:
    """Values along an axis: a list, a range, or blocks of these."""
    values = {"type": "array", "minItems": 1, "items": {"type": ["number", "string"]}}
    range_ = _of(Range, defs)
    range_["properties"]["extra"] = values
    blocks = {
        "type": "object",
        "properties": {"blocks": {"type": "array", "minItems": 1, "items": {"anyOf": [values, range_]}}},
        "required": ["blocks"],
        "additionalProperties": False,
    }
    return {"anyOf": [values, range_, blocks]}


def _figures(defs: Schema) -> Schema:
    """The paper's by their names, or each by its own name as one of the kinds."""
    kinds = {}
    for name, model in {**CASE_PLOTS, **PLOTS}.items():
        kinds[name] = _of(model, defs)
        kinds[name]["required"] = sorted({"kind", *kinds[name].get("required", ())})
    one = {
        "type": "object",
        "properties": {"kind": {"enum": list(kinds)}},
        "required": ["kind"],
        "allOf": [_where("kind", name, schema) for name, schema in kinds.items()],
    }
    return {
        "anyOf": [
            {"type": "array", "items": {"enum": list(CATALOGUE)}},
            {"type": "object", "additionalProperties": one},
        ]
    }


def _where(key: str, word: str, schema: Schema) -> Schema:
    """What holds where a key says this word."""
    return {"if": {"properties": {key: {"const": word}}, "required": [key]}, "then": schema}


if __name__ == "__main__":
    print(text(), end="")
