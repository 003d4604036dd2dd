"""Balance -> a symbol and its meaning for every reaction: B_x, R_stick_x, N_wall, F_floor, T_rope, M_E."""

from __future__ import annotations

import re
from collections.abc import Container, Mapping, Sequence

from eomgen.documents.statements import Meaning, Table
from eomgen.mechanics.balance.balance import Balance
from eomgen.mechanics.balance.components import EACH_AXIS, Component
from eomgen.mechanics.balance.friction import FrictionContact, friction_contacts
from eomgen.mechanics.balance.named_reactions import NamedReaction, unit_of
from eomgen.mechanics.constraints.ties import Row
from eomgen.mechanics.constraints.ways_of_bodies import is_placed
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.model.constraints.members import trusses_of
from eomgen.model.forces.load import PointForce
from eomgen.model.symbols import ReactionSymbols
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import Vector
from eomgen.symbolic.print.symbols import Symbol, index_latex

LETTERS = {"n": "N", "t": "F", "s": "S", "tension": "T", "couple": "M", "drive": "D", "wrench": "W", "": "L"}
"""label -> the letter of a symbol whose owner stands behind it."""

AXES = ("x", "y", "z")
_LETTER = re.compile(r"[A-Z]+\d*")
HEAD = ("reaction", "meaning", "unit", "")


@dataclass(frozen=True)
class Lettered:
    """The reactions of a system with a symbol for each.

    Args:
        reactions: solved.
        symbols: one for each component, in order.
        contacts: those with friction.
        frictions: a symbol for the friction of each, along each direction in which it slides.
        declared: how they are set in LaTeX, of joints and ties that say so, by name.
    """

    reactions: Reactions
    symbols: tuple[Node, ...]
    contacts: tuple[FrictionContact, ...]
    frictions: tuple[tuple[Node, ...], ...]
    declared: Mapping[str, Symbol]

    @property
    def balance(self) -> Balance:
        return self.reactions.balance

    @property
    def names(self) -> frozenset[str]:
        return frozenset(symbol.name for symbol in (*self.symbols, *(x for each in self.frictions for x in each)))

    def table(self, shown: Container[object] | None = None) -> Table:
        """What the symbols stand for, all or those that are shown, in the order of the components."""
        rows = []
        named = {contact.component: symbols for contact, symbols in zip(self.contacts, self.frictions, strict=True)}
        for j, (component, symbol) in enumerate(zip(self.balance.components, self.symbols, strict=True)):
            if shown is None or symbol in shown:
                rows.append(Meaning(symbol, meaning(self.balance, component), unit_of(component)))
            for share, friction in zip(component.friction, named.get(j, ()), strict=True):
                if shown is None or friction in shown:
                    rows.append(Meaning(friction, _friction(self.balance, component, share.label), "N"))
        return Table(HEAD, tuple(rows))

    def of_row(self, row: Row) -> Scalar | None:
        """The multiplier of a row as a reaction, sign included; None where no reaction belongs to it."""
        for component, symbol in zip(self.balance.components, self.symbols, strict=True):
            if component.kind == "tie" and (component.owner, component.number) == (row.tie, row.number):
                return -symbol if _is_turned(row, component) else symbol
        return None


def lettered(reactions: Reactions, taken: Container[str]) -> Lettered:
    """A symbol for every reaction, none of them a name of the model."""
    balance = reactions.balance
    graph = balance.system.scope.graph
    contacts = tuple(friction_contacts(balance.system, reactions.components))
    used: set[str] = set()
    declared: dict[str, Symbol] = {}

    def symbol(label: str, owner: str, more: tuple[str, ...], given: Symbol | None) -> Node:
        name = reaction_name(label, owner, *more)
        while name in taken or name in used:
            name += "_r"
        used.add(name)
        declared.update({} if given is None else {name: given})
        return graph.symbol(name)

    symbols = tuple(
        symbol(c.label, _owner(balance, c), more := _more(balance, c), _declared(balance, c, c.label, more))
        for c in reactions.components
    )
    frictions = [(contact.name, reactions.components[contact.component]) for contact in contacts]
    named = tuple(
        tuple(symbol(x.label, name, (), _declared(balance, c, x.label, ())) for x in c.friction)
        for name, c in frictions
    )
    return Lettered(reactions, symbols, contacts, named, declared)


def reaction_name(label: str, owner: str, *more: str) -> str:
    """B_x, R_stick_x, N_wall, T_rope_2, M_E: what a reaction is called.

    A force along an axis of an owner that is no letter has R before it: stick_x would be a position of the stick.
    """
    if label in AXES:
        pieces = ("" if _LETTER.fullmatch(owner) else "R", owner, *more, label)
    else:
        pieces = (LETTERS[label.partition(" ")[0]], owner, *more)
    return "_".join(filter(None, pieces))


def reaction_symbol(given: ReactionSymbols | None, label: str, more: Sequence[str], *, alone: bool) -> Symbol | None:
    """How a joint or a tie calls a reaction in LaTeX; None where it does not say so.

    Args:
        more: what its name has behind the owner: a side, a number.
        alone: it is the only one there.
    """
    kind = label.partition(" ")[0]
    if given is None or (given.letter is None and kind not in given.each):
        return None
    index = [index_latex(piece) for piece in more]
    if kind in given.each:
        return given.each[kind].with_index(*index)
    assert given.letter is not None
    if alone:
        return given.letter
    if label in AXES:
        return given.letter.with_index(*index, label)
    return Symbol(label, LETTERS[kind], ",".join([given.letter.tex, *index]))


def own_symbol(balance: Balance, named: NamedReaction) -> Symbol | None:
    """The symbol that a joint or a tie gives a reaction of its own; None of sums, and where it gives none."""
    if len(named.combination) != 1 or not is_zero(named.given):
        return None
    ((j, factor),) = named.combination.items()
    component = balance.components[j]
    if type(factor) is Node or factor != 1:
        return None
    return _declared(balance, component, component.label, _more(balance, component))


def _declared(balance: Balance, component: Component, label: str, more: tuple[str, ...]) -> Symbol | None:
    """The symbol of a component, or of its friction along a direction, where its joint or tie gives one."""
    model = balance.system.scope.model
    part = model.constraints.get(component.owner) or getattr(model.bodies.get(component.owner), "joint", None)
    mine = [c for c in balance.components if c.owner == component.owner and c.kind == component.kind]
    alone = len(mine) == 1 and not component.friction
    return None if part is None else reaction_symbol(part.symbol, label, more, alone=alone)


def _owner(balance: Balance, component: Component) -> str:
    """In whose name it is: of the only truss there is nobody's."""
    if component.label != "tension" or not component.side:
        return component.owner
    return component.owner if len(trusses_of(balance.system.scope.model.constraints)) > 1 else ""


def _more(balance: Balance, component: Component) -> tuple[str, ...]:
    """What the name has behind its owner: the side of a hinge, the ends of a member, a number."""
    if component.label in AXES:
        return (component.side,) if component.side else ()
    kind, _, number = component.label.partition(" ")
    if kind == "tension" and component.side:
        return tuple(component.side.split("-"))
    number = number or _strand(balance, component) or _couple(balance, component)
    return (number,) if number else ()


def _strand(balance: Balance, component: Component) -> str:
    """The number of the first strand that has this tension, of a string that has several; else ""."""
    tie = balance.system.scope.model.constraints.get(component.owner)
    rows = () if tie is None or component.label != "tension" else tie.strand_rows()
    return str(rows.index(component.number) + 1) if max(rows, default=1) > 1 else ""


def _couple(balance: Balance, component: Component) -> str:
    """Of a tie with several couples x, y, z where all are along axes of the body, else the number; else ""."""
    if component.label != "couple" or component.kind != "tie":
        return ""
    couples = [c for c in balance.components if c.kind == "tie" and c.owner == component.owner and c.label == "couple"]
    if len(couples) == 1:
        return ""
    axes = [axis for c in couples for axis, e in zip(AXES, EACH_AXIS, strict=True) if c.effects[0].couple == e]
    where = couples.index(component)
    return axes[where] if len(axes) == len(couples) else str(where + 1)


def meaning(balance: Balance, component: Component) -> str:
    """What a component is, on which body, and in which sense, in words."""
    kind = component.label.partition(" ")[0]
    on = _on(balance, component)
    if kind == "tension" and component.side:
        return f"tension of member {component.side} of {component.owner}"
    if kind == "tension":
        strand = _strand(balance, component)
        return f"tension of {component.owner}" + (f", strand {strand}" if strand else "")
    if kind == "drive":
        return f"what drives {component.side or component.owner}, {on}"
    if kind in AXES:
        return f"force {on}, along {_axis(balance, component, kind)}"
    if kind == "couple":
        return f"couple {on}, {_sense(balance, component)}"
    if kind in ("t", "s"):
        return _friction(balance, component, kind) + (
            ", without sliding" if component.bilateral_friction is None else ""
        )
    if kind == "n":
        return f"normal force {on}{_direction(balance, component)}"
    return f"wrench {on}" if kind == "wrench" else f"reaction {on}"


def said(balance: Balance, named: NamedReaction) -> str:
    """What a reaction is that an output asks for by name, in words."""
    kind, _, rest = named.name.removeprefix("reaction_").partition("(")
    axis = kind.removeprefix("couple_")
    of_one = [j for j, k in named.combination.items() if type(k) is int and k == 1]
    if axis not in AXES and of_one and not balance.components[of_one[0]].is_wrench:
        return meaning(balance, balance.components[of_one[0]])
    place = rest.removesuffix(")")
    side = place.partition(".")[2]
    mine = [c for c in balance.components if c.owner == named.owner and c.kind != "drive"]
    component = next((c for c in mine if c.side == side), mine[0])
    on = _on(balance, component)
    if kind in ("t", "s"):
        return _friction(balance, component, kind)
    if kind == "couple":
        return f"couple {on}, counter-clockwise"
    if kind.startswith("couple_"):
        return f"couple {on}, about {axis}"
    return f"force {on}, along {axis}"


def _friction(balance: Balance, component: Component, label: str) -> str:
    """Friction along the contact; in space along one of its two tangents."""
    along = f"{label} of the contact" if balance.system.scope.model.space == "space" else "the contact"
    return f"friction {_on(balance, component)}, along {along}"


def _on(balance: Balance, component: Component) -> str:
    """on bar in its joint, from the ground; on AB by B, from CB."""
    links = balance.system.motion.links
    first, *others = dict.fromkeys(effect.link for effect in component.effects)
    body, other = (links[first].name, links[others[0]].name if others else "the ground")
    if component.kind != "tie":
        where = "place" if is_placed(links[first]) else "joint"
        return f"on {body} in its {where}, from {other}"
    if component.side:
        return f"on {component.side} in the hinge {component.owner}, from the others"
    return f"on {body} at {component.owner}, from {other}"


def _axis(balance: Balance, component: Component, label: str) -> str:
    """Ground axes in the plane and of ties, else those of the body whose joint it is."""
    own = balance.system.scope.model.space != "plane" and component.kind == "joint"
    return f"{label} of its own axes" if own else label


def _sense(balance: Balance, component: Component) -> str:
    if balance.system.scope.model.space == "plane":
        return "counter-clockwise"
    return f"about {_named(component.effects[0].couple)}"


def _direction(balance: Balance, component: Component) -> str:
    """Along the tie's own normal; of a joint across the way on which it slides."""
    if component.kind == "tie":
        return ", along the normal"
    if balance.system.scope.model.space == "plane":
        return ", to the left of its way"
    return f", along {_named(component.effects[0].force)}"


def _named(direction: Vector) -> str:
    """An axis of the body by its letter, another direction by its components where these are numbers."""
    for axis, x in zip(AXES, direction, strict=True):
        others = sum(not is_zero(y) for y in direction) - (not is_zero(x))
        if type(x) is int and x in (1, -1) and not others:
            return f"{axis if x > 0 else f'-{axis}'} of its own axes"
    if all(type(x) is not Node for x in direction):
        return f"({', '.join(str(x) for x in direction)}) of its own axes"
    return "a direction across its freedom"


def _is_turned(row: Row, component: Component) -> bool:
    """Whether the component is minus the multiplier: the force on another body than the row's first one."""
    first = row.pushes[0]
    if row.component not in AXES or not isinstance(first, PointForce):
        return False
    return bool(component.side) or first.place[0] is None
