"""eomgen schema: the JSON Schema of a model file."""

from __future__ import annotations

import json

from eomgen.model.schema import json_schema
from eomgen.report.document import lines_document
from eomgen.verbs.outcome import Outcome


def schema_outcome() -> Outcome:
    """The JSON Schema of a model file."""
    found = json_schema()
    return Outcome(lines_document(lambda: found, json.dumps(found, ensure_ascii=False, indent=2)))
