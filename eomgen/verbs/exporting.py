"""eomgen export: a model as a robot's file of other programs."""

from __future__ import annotations

from dataclasses import replace

from eomgen import files
from eomgen.documents import Document, Lines, plain_document
from eomgen.exported import urdf_of
from eomgen.model import Model
from eomgen.proof import imported_otherwise, unsaid_otherwise


def export_document(model: Model, *, output: str) -> Document:
    """The URDF, written, and read again by another program; with the features that URDF lacks.

    Raises:
        DerivationError: a joint that URDF does not have.
        WriteFailed: it cannot be written.
    """
    found = urdf_of(model)
    files.write(output, found.text)
    left_out = [each.as_dict() for each in found.left_out]
    document = plain_document(model, lambda: {"file": output, "left_out": left_out}, Lines((output,)))
    left = {each.what: each.where for each in found.left_out}
    wrong = imported_otherwise(found.text, model) or unsaid_otherwise(found.text, model, left)
    return replace(document, failed=wrong, notes=tuple(f"left out: {each}" for each in found.left_out))
