"""Model -> how its contacts are at rest; reactions -> whether they can be so.

At rest a rough contact keeps from sliding: its friction is a reaction like others, as long as |F| <= mu N. What can
only push, or only pull, needs N >= 0.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.mechanics.bodies.contact_modes import ContactMode, ContactModes
from eomgen.mechanics.statics.two_ways import StaticReaction, StaticReactions
from eomgen.model.contacts import contacts_of, rough_contacts
from eomgen.model.parts import Model
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import function, sqrt
from eomgen.symbolic.expression.graph import Scalar


@dataclass(frozen=True)
class RestCondition:
    """What must hold for a contact to be as it was taken.

    Args:
        tie: the contact, or the body on a path.
        kind: "pushes", "pulls" or "sticks".
        margin: it is not negative where the condition holds [N].
    """

    tie: str
    kind: str
    margin: Scalar

    @property
    def broken(self) -> str:
        """What happens where it is negative."""
        return {
            "pushes": f"contact '{self.tie}' would have to pull",
            "pulls": f"'{self.tie}' would have to push",
            "sticks": f"contact '{self.tie}' slides: it would need more friction than mu N",
        }[self.kind]


def modes_at_rest(model: Model) -> ContactModes:
    """Every contact with dry friction sticks."""
    return {contact.name: ContactMode(sense=0) for contact in rough_contacts(model)}


def conditions_of(statics: StaticReactions) -> tuple[RestCondition, ...]:
    """What must hold of contacts that can end or slide, those whose reactions are determinate."""
    found = []
    for contact in contacts_of(statics.system.scope.model):
        name = contact.name
        normal, pull = (_value(statics, f"{kind}({name})") for kind in ("reaction_n", "tension"))
        along = _resultant([_value(statics, f"reaction_{k}({name})") for k in ("ts" if contact.surface else "t")])
        if contact.round:  # of all that it carries the part across its line
            whole = _resultant([_value(statics, f"reaction_{axis}({name})") for axis in "xyz"])
            normal = None if whole is None or along is None else sqrt(whole * whole - along * along)
        if contact.unilateral and normal is not None:
            found.append(RestCondition(name, "pushes", normal))
        if contact.unilateral and pull is not None:
            found.append(RestCondition(name, "pulls", pull))
        if contact.mu is not None and normal is not None and along is not None:
            most = statics.system.scope.value(contact.mu) * function("abs", normal)
            found.append(RestCondition(name, "sticks", most - function("abs", along)))
    return tuple(found)


def _resultant(components: Sequence[Scalar | None]) -> Scalar | None:
    """The magnitude; of one component with its sign; None where one is not determined."""
    known = [x for x in components if x is not None]
    if len(known) < len(components) or len(known) == 1:
        return known[0] if len(known) == len(components) else None
    return sqrt(sum((x * x for x in known), start=0))


def _value(statics: StaticReactions, name: str) -> Scalar | None:
    reaction: StaticReaction | None = statics.by_name.get(name)
    return None if reaction is None else reaction.value
