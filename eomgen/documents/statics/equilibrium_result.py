"""Model -> Resting: where a system with freedoms is at rest, as a user gets it: step by step, and for machines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any

from eomgen.certificate import certify
from eomgen.documents.document import Document, document_of
from eomgen.documents.drawing import Sketch, draw_model
from eomgen.documents.figures import Picture
from eomgen.documents.quantity import Quantity
from eomgen.documents.result import Result
from eomgen.documents.setting_steps import data_step
from eomgen.documents.statics.equilibrium_steps import equilibrium_steps
from eomgen.errors import DerivationError, ModelError, RunFailed
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equilibria.families import Curve
from eomgen.mechanics.equilibria.resting_reactions import ReactionsOrWhy, reactions_or_why
from eomgen.mechanics.equilibria.search import Equilibria, Equilibrium, all_equilibria
from eomgen.mechanics.equilibria.stability import Stability
from eomgen.mechanics.equilibria.standing import standing_system
from eomgen.mechanics.initial_state.numeric_value import known_exactly, known_parameters, shown_numbers
from eomgen.mechanics.small_motions.first_order import first_order_of
from eomgen.model.parts import Model
from eomgen.proof.check import Certificate, unchecked
from eomgen.proof.resting import BY_MOTION, NOTHING_ACCELERATED, balance_check, pushes_check, resting_checks
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.print.text import to_text

METHOD = "equilibrium"


@dataclass(frozen=True)
class Resting(Result):
    """The places of rest of a system with freedoms.

    Args:
        model: the system.
        found: every place, the nearest to the start first.
    """

    model: Model
    found: Equilibria

    def __repr__(self) -> str:
        return f"<statics of {self.model.name!r}: {len(self.places)} places of rest>"

    @property
    def places(self) -> tuple[Equilibrium, ...]:
        return self.found.found

    @cached_property
    def reactions(self) -> ReactionsOrWhy | None:
        """Those at the first place; None without any."""
        return reactions_or_why(self.places[0]) if self.places else None

    def certify(self) -> Certificate:
        """Check the places by the balance of forces, and by the equations of motion: nothing is accelerated there."""
        if not self.places:
            return Certificate(())
        balanced = (balance_check(self.places), pushes_check(self.places))
        first = first_order_of(standing_system(self.places[0].statics.system))
        try:
            base = certify(first.equations, begins=False)
        except (ModelError, DerivationError) as error:  # a massless coordinate, say: there is rest, and no motion
            return Certificate((*balanced, unchecked(NOTHING_ACCELERATED, error.what, BY_MOTION)))
        return Certificate((*base.checks, *balanced, *resting_checks(first, self.places)))

    @cached_property
    def derivation(self) -> Document:
        """The way to them, step by step."""
        model = self.model
        steps = (data_step(self.found.statics.system), *equilibrium_steps(self.found, self.reactions))
        return document_of(model, METHOD, steps)

    def entries(self) -> dict[str, Any]:
        """For machines."""
        return {
            "name": self.model.name,
            "equilibria": [_place(place) for place in self.places],
            **(_reactions(self.places[0], self.reactions) if self.reactions else {}),
            "complete": self.found.complete,
            "where": self.found.where,
            "indifferent": [q.name for q in self.found.indifferent],
            "chosen": [q.name for q in self.found.chosen],
            "held": list(self.found.statics.held),
        }

    @property
    def picture(self) -> Picture:
        """The system in each place of rest.

        Raises:
            RunFailed: there is none; the system is in space; parameters have no values.
        """
        return resting_picture(self.places)


def resting_places(model: Model, system: System) -> Resting:
    """The places of rest of a model.

    Args:
        system: of the model, contacts as they are at the start.
    Raises:
        DerivationError: dry friction; a drive that moves on steadily; forces that hold an unknown.
    """
    return Resting(model, all_equilibria(system))


def _place(place: Equilibrium) -> dict[str, Any]:
    return {
        "coordinates": {q.name: _of(place, q) for q in place.statics.system.symbols.q},
        "multipliers": {lam.name: _of(place, lam) for lam in place.statics.lam},
        "stability": _stability(place.stability),
        "pulling": list(place.pulling),
        "family": None if place.curve is None else _family(place, place.curve),
    }


def _family(place: Equilibrium, curve: Curve) -> dict[str, Any]:
    """The places of the curve that were met along it, by coordinate [SI]."""
    columns = {q.name: curve.points[:, k].tolist() for k, q in enumerate(place.statics.q)}
    return {"closed": curve.closed, "places": columns}


def _reactions(place: Equilibrium, those: ReactionsOrWhy) -> dict[str, Any]:
    """Those at the first place."""
    _, reactions, why = those
    numbers = shown_numbers([each.value for each in reactions], known_exactly(place.statics.system.scope))
    return {
        "reactions": {
            each.named.name: Quantity(
                to_text(each.value) if place.is_exact and each.value is not None else None,
                number,
                each.named.unit,
                "balance of the bodies at rest",
                None if each.value is not None else "statically indeterminate",
            )
            for each, number in zip(reactions, numbers, strict=True)
        },
        "message": why or None,
    }


def _of(place: Equilibrium, node: Node) -> Quantity:
    exact = to_text(place.exact[node]) if node in place.exact else None
    return Quantity(exact, place.numbers.get(node), unit=None)


def _stability(stability: Stability) -> dict[str, Any]:
    return {
        "kind": stability.kind,
        "why": stability.why,
        "along": [q.name for q in stability.along],
        "K": [[_entry(x) for x in row] for row in stability.K],
        "minors": [to_text(x) for x in stability.minors],
    }


def _entry(x: Scalar | float) -> str | float:
    return x if isinstance(x, float) else to_text(x)


MOST = 6  # places that are drawn
SIDE = 3.4  # of one panel [inches]


def resting_picture(places: Sequence[Equilibrium]) -> Picture:
    """The first places of rest of a plane system.

    Raises:
        RunFailed: there is none; the system is not plane; parameters have no values.
    """
    places = places[:MOST]
    if not places:
        raise RunFailed("there is no place of rest to be drawn", mend="give a start near one")
    model = places[0].statics.system.scope.model
    if model.space != "plane":
        raise RunFailed("pictures of places of rest are drawn of plane systems", mend="take them by value: .places")
    if not all(place.numbers for place in places):
        raise RunFailed("a picture needs values of all parameters", mend="give them values in [parameters]")
    columns = math.ceil(math.sqrt(len(places)))
    rows = math.ceil(len(places) / columns)

    def fill(figure: Any) -> None:
        for k, place in enumerate(places, start=1):
            panel = figure.add_subplot(rows, columns, k)
            draw_model(panel, _sketch(place), names=k == 1)
            panel.set_title(f"{k}: {place.stability.kind}", fontsize=10)

    return Picture((SIDE * columns, SIDE * rows), fill, model.name)


def _sketch(place: Equilibrium) -> Sketch:
    symbols = place.statics.system.symbols
    plain = Sketch(place.statics.system, known_parameters(place.statics.system.scope))
    inputs = {node: plain.numbers((place.statics.given[node],))[0] for node in symbols.inputs.values()}
    still = dict.fromkeys((symbols.t, *symbols.u), 0.0)
    return Sketch(place.statics.system, {**plain.values, **inputs, **still, **place.numbers})
