"""Balance, state -> whether reactions are what their names say, in numbers.

    reaction_x|y|z(owner) = R f,   reaction_couple_x|y|z(owner) = R n,      R and the sums of f and n of one body
    drive(q) = (M a + c - Q - J^T lam)_q,   by the free bodies, once q is let go

Components take random values: a name is linear in them. R is that of the pose of the body at the state; what a
component does to a body stands in the axes of its equations, which the balance of the whole in ground axes looks at.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from random import Random
from typing import Any

from eomgen.mechanics.balance.balance import Balance
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.balance.friction import frictions
from eomgen.mechanics.balance.named_reactions import NamedReaction, named_reactions
from eomgen.mechanics.balance.unit_wrenches import Effect, efforts_of
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.proof.free_bodies import drive_demanded
from eomgen.proof.in_numbers import InNumbers
from eomgen.records import dataclass
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, ZERO_AT_50

ALONG = {f"reaction_{couple}{axis}": (couple, k) for couple in ("", "couple_") for k, axis in enumerate("xyz")}


def named_otherwise(balance: Balance, state: State) -> str:
    """Which reaction is not along the axis of the ground by which it is called; "" where all are.

    Raises:
        NoValue: something has no value there.
    """
    proof = _Named(balance.system, state, balance)
    for named in named_reactions(balance):
        function, _, rest = named.name.partition("(")
        if function in ALONG and named.combination:
            couple, k = ALONG[function]
            stated, size = proof.stated(named)
            due = proof.due(named.owner, rest.removesuffix(")"), couple)
            if due is not None and abs(stated - due[k]) > ZERO_AT_50 * (1 + size + sum(map(abs, due))):
                return f"{named.name} is not along the ground's {'xyz'[k]}"
    return ""


def drives_beside(reactions: Reactions) -> dict[str, str]:
    """{name of a drive: the coordinate} of those that have another way: driven by the model, and no friction beside."""
    system = reactions.balance.system
    if frictions(system):
        return {}
    driven = system.scope.model.coordinates
    return {c.name: c.side for c in reactions.components if c.kind == "drive" and c.side and driven[c.side].driven}


def driven_otherwise(reactions: Reactions, state: State) -> str:
    """Which drive is not what the free bodies ask for along its coordinate once that is let go; "" where all are.

    Raises:
        NoValue: none is determinate with another way.
    """
    sides, found = drives_beside(reactions), 0
    for named in (named for named in named_reactions(reactions.balance) if named.name in sides):
        try:
            due, size = drive_demanded(reactions.balance.system, sides[named.name], state)
            value = reactions.combined(named.combination, named.name) + named.given
        except (NoValue, Indeterminate):
            continue
        (stated,) = evaluate((value,), state, fifty_digits())
        if abs(stated - due) > COMPUTED * (size + abs(stated)):
            return f"{named.name} = {float(stated):.10g}, and the bodies ask for {float(due):.10g}"
        found += 1
    if not found:
        raise NoValue("no drive is determinate, or ties follow from others only while it drives")
    return ""


@dataclass(frozen=True)
class _Named(InNumbers):
    balance: Balance

    @cached_property
    def values(self) -> list[Any]:
        """Of every component, at random."""
        rng = Random(17)
        return [fifty_digits().number(rng.randint(20, 90)) / 7 for _ in self.balance.components]

    def stated(self, named: NamedReaction) -> tuple[Any, Any]:
        """(what it comes to, of terms of which size)"""
        *factors, given = self.at((*named.combination.values(), named.given))
        x = self.values
        terms = [given, *(k * x[j] for j, k in zip(named.combination, factors, strict=True))]
        return sum(terms, start=0), sum(map(abs, terms))

    def due(self, owner: str, place: str, couple: str) -> Any:
        """The force, or couple, on the body of which the name speaks, ground axes; None where it speaks of none."""
        mine = [(j, c) for j, c in enumerate(self.balance.components) if c.owner == owner]
        held = [c for _, c in mine if c.kind != "drive"]
        side = place.removeprefix(owner).removeprefix(".")
        if not held:
            return None
        links = self.motion.index
        on = links[side] if side else held[0].effects[0].link
        total: Any = (0, 0, 0)
        for j, component in mine:
            effects = (*component.effects, *component.friction_effects)
            total = tuple(x + y for x, y in zip(total, self._turned(on, effects, couple, self.values[j]), strict=True))
        efforts = efforts_of(self.system, owner) if owner in links and not side else []
        return tuple(x + y for x, y in zip(total, self._turned(on, efforts, couple, 1), strict=True))

    def _turned(self, on: int, effects: Iterable[Effect], couple: str, share: Any) -> Any:
        """A share of what effects do to one body together, turned by the pose of the body."""
        total = [0 * fifty_digits().number(1)] * 3
        for effect in (each for each in effects if each.link == on):
            own = self.at(effect.couple if couple else effect.force)
            total = [x + share * y for x, y in zip(total, own, strict=True)]
        if self.system.scope.model.space == "plane":
            return tuple(total)
        return self.carried(self.motion.links[on].name, (total[0], total[1], total[2]), direction=True)
