"""eomgen schema: the JSON Schema of a model file."""

from __future__ import annotations

import json

from eomgen.documents import Document, lines_document
from eomgen.model import json_schema


def schema_document() -> Document:
    """The JSON Schema of a model file."""
    found = json_schema()
    return lines_document(lambda: found, json.dumps(found, indent=2))
