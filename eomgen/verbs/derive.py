"""eomgen derive: the derivation, step by step, with its certificate."""

from __future__ import annotations

from dataclasses import replace

from eomgen import pipeline
from eomgen.documents import Document, Grid, Step, proven, with_constraints_closed
from eomgen.equations import Equations
from eomgen.errors import DerivationError
from eomgen.mechanics.free_bodies import Balance, NamedReaction, named_reactions
from eomgen.model import Model, model_at

HEADS = {"names": "name", "equations": "equation of motion along", "reactions": "reaction", "outputs": "output"}


def derive_document(
    model: Model,
    *,
    method: str,
    certify: bool,
    full: bool = False,
    units: bool = False,
    diff: str | None = None,
    data: bool = False,
) -> Document:
    """The derivation, and its certificate.

    Args:
        full: everything is printed, however long.
        units: those of names, equations, reactions and outputs too.
        diff: the file of another model: the differences from it are reported instead.
        data: the texts for machines are proven, too.
    """
    if diff is not None:
        from eomgen.verbs.derive_difference import difference_document

        return difference_document(model, model_at(diff), method=method, certify=certify)
    equations = pipeline.derive(model, method)
    document = equations.written(full=full)
    document = _with_units(equations, document) if units else document
    document = with_constraints_closed(document, equations.system)
    return equations.proven(document, data=data) if certify else proven(document, None)


def _with_units(equations: Equations, document: Document) -> Document:
    """Adds a section of units to a document, for people and for machines."""
    found = equations.model.units_of_everything(equations.speeds)
    found = {**found, "reactions": {named.name: named.unit for named in _reacting(equations)}}
    grids = tuple(Grid((HEADS[key], "unit"), tuple(found[key].items())) for key in HEADS if found[key])
    entries = document.entries
    steps = (*document.steps, Step("units", "Units", grids))
    return replace(document, steps=steps, entries=lambda: {**entries(), "units": found})


def _reacting(equations: Equations) -> tuple[NamedReaction, ...]:
    """The reactions; () where forces act at no place, or a body is unsupported."""
    try:
        return tuple(named_reactions(Balance.of(equations.system)))
    except DerivationError:
        return ()
