"""eomgen derive: the derivation, step by step, with its certificate."""

from __future__ import annotations

from eomgen import pipeline
from eomgen.model.parts import Model
from eomgen.verbs.outcome import Outcome, proven


def derive_outcome(model: Model, *, method: str, certify: bool, full: bool = False) -> Outcome:
    """The derivation, and its certificate.

    Args:
        full: everything is printed, however long.
    """
    equations = pipeline.derive(model, method)
    document = equations.written(full=full)
    return proven(Outcome(document), equations.certify() if certify else None)
