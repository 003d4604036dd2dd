"""Model -> Statics: a structure at rest: solved, written step by step, as JSON entries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

from eomgen.documents import Document, Picture, Quantity, Result
from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import RigidBlock, VelocityPlan
from eomgen.mechanics.start import shown_numbers
from eomgen.mechanics.statics import InfluenceLine, RestCondition, StaticReaction, StaticReactions, WorkEquation
from eomgen.model import Model, ModelOrPath, Values, model_at
from eomgen.proof import Certificate, Check, DrawnPanel, ReportedWork, certify_structure, diagrams_drawn
from eomgen.resources import doing
from eomgen.results.at_rest.section_steps import (
    Sections,
    influence_payload,
    influence_step,
    reported_sections,
    section_payload,
    section_steps,
    sections_of,
)
from eomgen.results.at_rest.steps import contacts_step, reported_work, statics_derivation, sum_name
from eomgen.study import study_at_rest
from eomgen.symbolic.expression import Scalar
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import to_text

MOST_REPORTED = 8  # reactions whose virtual work is read again

if TYPE_CHECKING:
    from eomgen.results.at_rest.equilibrium import Resting


@dataclass(frozen=True)
class Statics(Result):
    """A structure at rest: every reaction by virtual work and by equilibrium.

    Args:
        model: the structure.
        found: its reactions.
        influence: an influence line, where one was requested.
    """

    model: Model
    found: StaticReactions
    influence: InfluenceLine | None = None

    def __repr__(self) -> str:
        return f"<statics of {self.model.name!r}: {len(self.found.reactions)} reactions>"

    @property
    def ok(self) -> bool:
        """True if virtual work and equilibrium agree."""
        return not self.found.disagreeing

    @property
    def failed(self) -> str:
        """Errors or open questions of the result, in words; "" if there are none."""
        if self.ok:
            return "; ".join((*self._open, *self.broken))
        wrong = ", ".join(reaction.name for reaction in self.found.disagreeing)
        return f"virtual work and equilibrium do not agree: {wrong}"

    @property
    def _open(self) -> tuple[str, ...]:
        """Sentence that names statically indeterminate reactions; () without any."""
        names = [reaction.name for reaction in self.found.open]
        if not names:
            return ()
        degree = self.found.structure.indeterminacy
        return (
            f"the structure is statically indeterminate, to the degree {degree}: the balance of rigid bodies "
            f"leaves {', '.join(names)} open; take a redundant constraint away, or let something give",
        )

    @cached_property
    def conditions(self) -> tuple[RestCondition, ...]:
        """Conditions on contacts that can open or slide."""
        return self.found.conditions

    @cached_property
    def broken(self) -> tuple[str, ...]:
        """Violated conditions of contacts, in words: then the structure is not at rest like this."""
        margins = self._numbers([(c.broken, c.margin) for c in self.conditions])
        return tuple(words for words, margin in margins.items() if margin < -tolerances.COMPUTED)

    @cached_property
    def sections(self) -> Sections:
        """N, V and M of every body that is a beam."""
        return sections_of(self.found.balance)

    @cached_property
    def exact(self) -> dict[str, str | None]:
        """{reaction: its value as text}, None where it is statically indeterminate."""
        return {r.name: None if r.value is None else to_text(r.value) for r in self.found.reactions}

    @cached_property
    def values(self) -> dict[str, float]:
        """{reaction: its number} [N, N m], of those that have one."""
        sums = [(sum_name(self.found, each), each.value) for each in self.found.sums]
        return self._numbers([(r.name, r.value) for r in self.found.reactions if r.value is not None] + sums)

    def _numbers(self, pairs: Sequence[tuple[str, Scalar]]) -> dict[str, float]:
        """The scalars in numbers, those whose parameters have values."""
        names, scalars = zip(*pairs, strict=True) if pairs else ((), ())
        found = shown_numbers(scalars, self.found.system.scope.known_exactly)
        return {name: x for name, x in zip(names, found, strict=True) if x is not None}

    def certify(self) -> Certificate:
        """Check the two ways, every body's balance, section forces from the other end, influence lines by loads."""
        reported = reported_sections(self.sections, self.derivation.steps, section_payload(self.sections))
        return certify_structure(
            self.found, self.sections.found, self.influence, reported=reported, works=self._reported_works()
        )

    def _reported_works(self) -> Iterator[ReportedWork]:
        """Works of some reactions in the plane, evenly spread over all."""
        by_key = {step.key: step for step in self.derivation.steps}
        worked = [(r.name, r.work) for r in self.found.reactions if r.work is not None]
        for name, work in worked[:: 1 + len(worked) // MOST_REPORTED] if self.model.space == "plane" else ():
            reported = reported_work(name, by_key[f"work {name}"], _work(work))
            if reported is not None:
                yield reported

    def drawn_checks(self, panels: Sequence[DrawnPanel]) -> Iterable[Check]:
        """N, V, M and the influence line as they are drawn, from the other end and by unit loads."""
        return diagrams_drawn(self.found, self.sections.found, self.influence, panels) if panels else ()

    @cached_property
    def derivation(self) -> Document:
        """The solution, step by step."""
        contacts = contacts_step(self.conditions, self.broken)
        influence = () if self.influence is None else (influence_step(self.influence),)
        return statics_derivation(self.found, self.values, (*contacts, *section_steps(self.sections), *influence))

    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        structure = self.found.structure
        return {
            "name": self.model.name,
            "structure": {
                "velocities": len(structure.columns),
                "reactions": len(structure.rows),
                "rank": structure.rank,
                "mobility": structure.mobility,
                "indeterminacy": structure.indeterminacy,
                "count": self.found.count[0],
                "formula": self.found.count[1],
            },
            "reactions": {reaction.name: self._reaction(reaction) for reaction in self.found.reactions},
            "self_stresses": [
                {structure.names[j]: to_text(x) for j, x in stress.items()} for stress in structure.stresses
            ],
            "sums": {
                (name := sum_name(self.found, each)): Quantity(
                    to_text(each.value), self.values.get(name), each.unit, "equilibrium"
                )
                for each in self.found.sums
            },
            "sections": section_payload(self.sections),
            "influence": None if self.influence is None else influence_payload(self.influence),
            "contacts": [{"tie": c.constraint, "kind": c.kind, "margin": to_text(c.margin)} for c in self.conditions],
            "broken": list(self.broken),
            "agree": self.ok,
        }

    def _reaction(self, reaction: StaticReaction) -> Quantity:
        beside = {
            "by_equilibrium": _text(reaction.balanced),
            "work": None if reaction.work is None else _work(reaction.work),
            "agree": reaction.agree,
        }
        method = "equilibrium" if reaction.work is None else "virtual work"
        message = None if reaction.value is not None else "statically indeterminate"
        exact, value = self.exact[reaction.name], self.values.get(reaction.name)
        return Quantity(exact, value, reaction.unit, method, message, beside)

    @property
    def picture(self) -> Picture:
        """The structure with its loads and reactions, N, V and M.

        Raises:
            RunFailed: it is in space.
        """
        from eomgen.results.at_rest.pictures import statics_picture

        return statics_picture(self.found, self.sections, self.influence)


def why_not_at_rest(model: Model, system: System) -> str:
    """Message if contacts of bodies without coordinates cannot hold them at rest; "" where they do.

    Raises:
        DerivationError: bodies can move.
    """
    if model.coordinates or not model.contacts:
        return ""
    return "; ".join(Statics(model, StaticReactions.of(system)).broken)


def _text(value: Scalar | None) -> str | None:
    return None if value is None else to_text(value)


def _work(equation: WorkEquation) -> dict[str, Any]:
    """The released mechanism, per unit of its scale, and the equation of virtual work: along * R + sum of terms = 0."""
    return {
        "mechanism": [_block(equation.plan, block) for block in equation.plan.blocks],
        "along": to_text(equation.along),
        "terms": [{"load": term.acting.name, "work": to_text(term.work)} for term in equation.terms],
        "value": to_text(equation.value),
    }


def _block(plan: VelocityPlan, block: RigidBlock) -> dict[str, Any]:
    """JSON entry of a block that moves as one: parts, spin, velocity at the origin; in the plane its centre too."""
    moved = {
        "parts": list(block.parts),
        "rotation": [to_text(x) for x in block.spin],
        "shift_at_origin": [to_text(plan.simple(x)) for x in block.velocity],
    }
    if plan.system.scope.model.space != "plane":
        return moved
    center = block.center(plan)
    found = {"center": center.place, "direction": center.direction}
    return {**moved, **{key: v and [to_text(plan.simple(x)) for x in v[:2]] for key, v in found.items()}}


@doing("the forces at rest")
def statics(
    model: ModelOrPath,
    *,
    reaction: str | None = None,
    influence: str | None = None,
    parameters: Values | None = None,
    start: Values | None = None,
) -> Statics | Resting:
    """A structure at rest; of a system that is free to move, its equilibria.

    Args:
        influence: the reaction, member force or section force whose influence line is requested too.
        reaction: the only one that is found by virtual work too; None: all.
        parameters, start: values that replace the model's, each as `model_at` takes it.
    Raises:
        UsageError: no reaction of that name; one is requested by itself of a system that is free to move.
        DerivationError: bodies can move; a force acts at no place.
    """
    model = model_at(model, parameters, start)
    study = study_at_rest(model)
    if study.system.has_degrees_of_freedom:
        from eomgen.results.at_rest.equilibrium import Resting

        _refuse_for_resting(reaction=reaction, influence=influence)
        return Resting(model, study.equilibria)
    held, _ = study.system.with_drives_held()  # what the model drives is held where it starts
    found = StaticReactions.of(held, only=reaction)
    line = None if influence is None else InfluenceLine.of(found.structure, influence)
    return Statics(model, found, line)


def _refuse_for_resting(**requested: str | None) -> None:
    """Refuses options that only structures have.

    Raises:
        UsageError: it is named.
    """
    for name, value in requested.items():
        if value is not None:
            raise UsageError(
                f"--{name} is of structures that stand, and this system is free to move",
                fix="without it the equilibria are given",
            )
