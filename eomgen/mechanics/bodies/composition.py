"""Scope -> Composite: the mass properties of a body made of parts, short."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.mechanics.bodies.scope import Scope
from eomgen.model.composite import Composite, PlacedPiece, composite_of
from eomgen.model.shapes import MassProperties
from eomgen.symbolic.exact.normal_form import readable_all
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.spatial import matrix_of, vector_of
from eomgen.symbolic.numeric.work import Work


def made_of(scope: Scope, body: str) -> Composite:
    """The pieces of a body and the whole of them, each formula in readable form; made once for a scope."""
    if body not in scope.composites:
        scope.composites[body] = _put_together(scope, body)
    return scope.composites[body]


def _put_together(scope: Scope, body: str) -> Composite:
    part = scope.model.bodies[body]
    composite = composite_of(part.parts or (), part.mass, scope.value)
    everything = [composite.whole, *(placed.mass for placed in composite.pieces)]
    flat = readable_all([x for mass in everything for x in _flat(mass)], Work.VALUE, scope.positive)
    whole, *masses = (_unflat(flat[k : k + 13]) for k in range(0, len(flat), 13))
    pieces = tuple(PlacedPiece(p.piece, mass) for p, mass in zip(composite.pieces, masses, strict=True))
    return Composite(pieces, whole)


def _flat(mass: MassProperties) -> list[Scalar]:
    return [mass.m, *mass.com, *(x for row in mass.I for x in row)]


def _unflat(entries: Sequence[Scalar]) -> MassProperties:
    m, *others = entries
    return MassProperties(m, vector_of(others[:3]), matrix_of((others[3:6], others[6:9], others[9:12])))
