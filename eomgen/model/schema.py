"""Model -> JSON Schema (draft 2020-12) of the model file, from the same rules that read it."""

from typing import Any

from eomgen.model.part import part_schema
from eomgen.model.parts import Model

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """The JSON Schema of a model file, for editors: what `check` finds beyond it needs the whole model."""
    definitions: dict[str, Any] = {
        "expression": {
            "description": "a number, or the text of an expression",
            "anyOf": [{"type": "number"}, {"type": "string", "minLength": 1}],
        },
        "quantity": {
            "description": "a number, an expression, or a value with its unit",
            "anyOf": [
                {"$ref": "#/$defs/expression"},
                {
                    "type": "object",
                    "properties": {"value": {"$ref": "#/$defs/expression"}, "unit": {"type": "string"}},
                    "required": ["value"],
                    "additionalProperties": False,
                },
            ],
        },
    }
    part_schema(Model, definitions)
    table = definitions.pop("Model")
    version = {"eomgen": {"const": 1, "description": "version of the model file"}}
    return {
        "$schema": DIALECT,
        **table,
        "title": "eomgen model file",
        "properties": {**version, **table["properties"]},
        "required": ["eomgen", *table["required"]],
        "$defs": definitions,
    }
