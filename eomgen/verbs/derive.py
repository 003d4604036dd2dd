"""eomgen derive: the derivation, step by step, with its certificate."""

from __future__ import annotations

from eomgen import pipeline
from eomgen.model.parts import Model
from eomgen.report.document import Document


def derive_document(model: Model, *, method: str, certify: bool, full: bool = False) -> Document:
    """The derivation, and its certificate.

    Args:
        full: everything is printed, however long.
    """
    equations = pipeline.derive(model, method)
    document = equations.written(full=full)
    return document.proven(equations.certify() if certify else None)
