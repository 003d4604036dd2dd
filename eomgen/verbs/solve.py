"""eomgen solve: what the file asks in [outputs]."""

from __future__ import annotations

from eomgen.model.parts import Model
from eomgen.questions import answers
from eomgen.report.document import Document, plain_document
from eomgen.report.statements import Found, Listing
from eomgen.verbs.outcome import listed


def solve_document(model: Model, *, certify: bool = True) -> Document:
    """Every entry of [outputs]."""
    found = answers.solve(model)
    unanswered = [name for name, answer in found.items() if not answer.answered]
    document = plain_document(
        model,
        lambda: {"name": model.name, "outputs": found},
        Listing(tuple(Found(name, answer) for name, answer in found.items())),
        failed=f"not answered: {listed(unanswered)}" if unanswered else "",
        notes=() if found else ("the model asks nothing: it has no [outputs]",),
    )
    return document.proven(found.certify() if certify and found else None)
