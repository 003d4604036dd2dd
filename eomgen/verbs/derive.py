"""eomgen derive: the derivation, step by step, with its certificate."""

from __future__ import annotations

from eomgen import pipeline
from eomgen.model.parts import Model
from eomgen.report import rendered
from eomgen.report.derivation import derivation_of
from eomgen.report.payload import equations_payload
from eomgen.verbs.outcome import Outcome, proven


def derive(model: Model, *, method: str, format: str, certify: bool, full: bool = False) -> Outcome:
    """The derivation, and its certificate.

    Args:
        full: everything is printed, however long.
    """
    equations = pipeline.derive(model, method)
    derivation = derivation_of(equations.system, equations.graph, method, full=full)
    certificate = equations.certify() if certify else None
    if format == "json":
        return proven(Outcome("", equations_payload(equations, None, derivation)), certificate, format)
    return proven(Outcome(rendered(derivation, format)), certificate, format)
