"""eomgen solve: what the file asks in [outputs]."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.questions import answers
from eomgen.report.document import Document


def solve_document(model: Model, *, certify: bool = True) -> Document:
    """Every entry of [outputs]."""
    found = answers.solve(model)
    return found.document.proven(found.certify() if certify and found else None)
