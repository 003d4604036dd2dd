"""eomgen derive: the derivation, step by step, with its certificate."""

from __future__ import annotations

from dataclasses import replace

from eomgen import pipeline
from eomgen.documents import Document, fragment_of, language_of, proven, with_constraints_closed
from eomgen.model import Model
from eomgen.proof import Certificate
from eomgen.results import difference_document
from eomgen.results import impact as impact_of


def derive_document(
    model: Model,
    *,
    method: str,
    certify: bool,
    full: bool = False,
    units: bool = False,
    diff: str | None = None,
    data: bool = False,
    section: str | None = None,
    fragment: bool = False,
    numbered: bool = False,
    language: str = "",
    impact: str | None = None,
) -> Document:
    """The derivation, and its certificate.

    Args:
        full: everything is printed, however long.
        units: those of names, equations, reactions and outputs too.
        diff: the file of another model: the differences from it are reported instead.
        data: the texts for machines are proven, too.
        language: of its words; "" for that of the model.
        impact: contacts that close, with commas between; "": the one that can: their impact instead of the equations.
        section, fragment, numbered: of it only that section; as a part of another document.
    """
    if diff is not None:
        first, second = pipeline.derive(model, method), pipeline.derive(diff, method)
        document = difference_document(first.graph, second.graph)
        return proven(document, _both(first.certify(), second.certify()) if certify else None)
    if impact is not None:
        found = impact_of(model, [name.strip() for name in impact.split(",") if name.strip()], full=full)
        document = fragment_of(found.derivation, section, fragment, numbered).said_in(language_of(model, language))
        document = replace(document, entries=found.entries)
        return proven(document, found.certify() if certify else None)
    equations = pipeline.derive(model, method)
    document = with_constraints_closed(equations.written(full=full, units=units), equations.system)
    document = fragment_of(document, section, fragment, numbered).said_in(language_of(model, language))
    return equations.proven(document, data=data) if certify else proven(document, None)


def _both(first: Certificate, second: Certificate) -> Certificate:
    """Checks of two models, each under the model's own heading."""
    reported = (("this model", first), ("the other", second))
    return Certificate(tuple(replace(c, name=f"{whose}: {c.name}") for whose, each in reported for c in each.checks))
