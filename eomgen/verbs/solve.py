"""eomgen solve: the outputs that the file requests in [outputs]."""

from __future__ import annotations

from dataclasses import replace

from eomgen.documents import Document, proven, with_start_reported
from eomgen.model import Model
from eomgen.questions import solve

LATE = "there was no time left"


def solve_document(model: Model, *, certify: bool = True) -> Document:
    """Every entry of [outputs]."""
    found = solve(model)
    document = with_start_reported(found.document, model)
    if found.stopped:
        note = f"Nothing of it is proven: {'it was interrupted' if found.stopped == 'interrupted' else LATE}."
        document = proven(document, None)
        return replace(document, interrupted=found.stopped == "interrupted", notes=(*document.notes, note))
    return proven(document, found.certify() if certify and found else None)
