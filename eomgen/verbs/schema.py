"""eomgen schema: the JSON Schema of a model file."""

from __future__ import annotations

import json

from eomgen.documents import Document, lines_document
from eomgen.model import Model


def schema_document() -> Document:
    """The JSON Schema of a model file."""
    found = Model.schema()
    return lines_document(lambda: found, json.dumps(found, indent=2))
