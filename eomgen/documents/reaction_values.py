"""Every reaction by its name: a symbol, its shortest readable form, and its JSON entries.

System -> every reaction in its shortest readable form, with the accelerations in it and without them.

A body held by more equations than it has unknowns gives a reaction in several ways that agree on every motion: from as
few equations as can be, or by all of them, projected on the reaction. The shorter one is read.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

from eomgen.documents.reading import (
    LONGEST,
    TRIED,
    Reader,
    conditions_in,
    length_in_print,
    readable_value,
    without_cases,
)
from eomgen.documents.statements import Meaning, Table
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.dynamics import EquationsOfMotion, Explicit, System
from eomgen.mechanics.free_bodies import (
    Balance,
    Component,
    FrictionContact,
    Indeterminate,
    NamedReaction,
    Reactions,
    SystemFriction,
    reactions_by_sides,
)
from eomgen.model import PointForce, ReactionSymbols
from eomgen.symbolic.exact import book_form, never_vanishes
from eomgen.symbolic.expression import (
    AS_WRITTEN,
    Matrix,
    Node,
    Scalar,
    Vector,
    depends_on,
    holds_op,
    is_zero,
    operations,
    order,
    parse,
    substituted,
)
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import Symbol, index_latex, length_of, text_size, to_text, with_definitions

LONGEST_REACTION = 3000  # characters of accelerations that are put into reactions
TOO_MANY = 2000  # components times equations, from which on one way must do


@dataclass(frozen=True)
class Readings:
    """The reactions of a system for a reader.

    Args:
        system: over its independent speeds.
        shown: the same, or with its dependent coordinates free: shorter, with their accelerations.
        reader: of formulas.
        accelerations: of the independent speeds as functions of q and u, {} where they are long.
    """

    system: System
    shown: System
    reader: Reader
    accelerations: Mapping[Node, Scalar]

    @property
    def ways(self) -> tuple[Reactions, ...]:
        """Solutions for the reactions of the shown system, the one from few equations first."""
        return _ways(self.shown)

    @cached_property
    def sides(self) -> dict[int, Scalar]:
        """Components of the shown system that follow from the balance of one side of their joint."""
        return reactions_by_sides(self.ways[0].balance)

    @cached_property
    def own_sides(self) -> dict[int, Scalar]:
        return self.sides if self.shown is self.system else reactions_by_sides(self.own_ways[0].balance)

    @property
    def own_ways(self) -> tuple[Reactions, ...]:
        return self.ways if self.shown is self.system else _ways(self.system)

    def with_accelerations(self, combination: dict[int, Scalar], given: Scalar = 0) -> Scalar:
        """sum of combination * components + given, linear in the accelerations.

        Raises:
            Indeterminate: it has no single value.
        """
        by_side = _by_sides(self.sides, combination)
        values = [*([] if by_side is None else [by_side]), *(way.combined(combination, "") for way in self.ways)]
        return self._shortest([x + given for x in values])

    def without(self, combination: dict[int, Scalar], given: Scalar = 0) -> Scalar | None:
        """The same by the equations of motion; None where nothing accelerates in it, or that is long."""
        by_side = _by_sides(self.own_sides, combination)
        found_ways = [*([] if by_side is None else [by_side]), *(w.combined(combination, "") for w in self.own_ways)]
        values = [x + given for x in found_ways]
        if not self.accelerations or not all(depends_on(x, tuple(self.accelerations)) for x in values):
            return None
        found = self.replaced(values, lambda x: substituted((x,), self.accelerations)[0])
        return None if found is None or text_size(found) > TRIED else found

    def replaced(self, values: list[Scalar], by: Callable[[Scalar], Scalar]) -> Scalar | None:
        """The shortest of the values after a replacement; None where all of them are long."""
        short = [
            book_form(y, Work.ENTRY, self.system.scope.positive) if not conditions_in(y) else y
            for x in values
            if text_size(x) <= TRIED and text_size(y := by(x)) <= TRIED
        ]
        return self._shortest(short) if short else None

    def _shortest(self, values: list[Scalar]) -> Scalar:
        """The shortest; of those, where there are any, that divide by nothing that may vanish but as the loads do."""
        forms = list(dict.fromkeys(self.forms(values)))
        if len(forms) == 1:
            return forms[0]
        divisors = {x: vanishing_divisors(x) for x in forms}
        own = self._divisors_of_loads if all(divisors.values()) else frozenset()
        return min(forms, key=lambda x: (not divisors[x] <= own, length_of(x)))

    @cached_property
    def _divisors_of_loads(self) -> frozenset[Node]:
        """Divisors in the applied forces themselves, as the length of a spring."""
        loads = [e.needed for e in self.ways[0].balance.equations if holds_op(e.needed, "div")]
        return frozenset().union(*(vanishing_divisors(x) for x in self.forms(loads)))

    def forms(self, values: Sequence[Scalar]) -> list[Scalar]:
        """The values in readable form; without those that divide by zero in one of their cases.

        Raises:
            DerivationError: all of them do.
        """
        found: list[Scalar] = []
        failed: DerivationError | None = None
        for x in values:
            try:
                found.append(readable_value(self.reader, x, self.system.scope.positive))
            except DerivationError as error:
                failed = error
        if failed is not None and not found:
            raise failed
        return found


def readings_of(equations: EquationsOfMotion, reader: Reader, *, free: bool = False) -> Readings:
    """The reactions of a system for a reader.

    Args:
        free: dependent coordinates have accelerations of their own in the form with accelerations.
    Raises:
        DerivationError: a body is unsupported; a force acts at no place.
    """
    system = equations.system
    found = Explicit(equations).short
    long = found is None or sum(map(text_size, found)) > LONGEST_REACTION
    accelerations = {} if found is None or long else dict(zip(equations.symbols.a, found, strict=True))
    return Readings(system, shown_system(system) if free else system, reader, accelerations)


def shown_system(system: System) -> System:
    """The system whose reactions are shown: dependent coordinates free, which is shorter; declared speeds stay."""
    return system if system.free is None or system.scope.model.speeds else system.free


def _by_sides(sides: Mapping[int, Scalar], combination: dict[int, Scalar]) -> Scalar | None:
    """sum of combination * components; None where one of them is not known by its side."""
    if not combination.keys() <= sides.keys():
        return None
    total: Scalar = 0
    for j, k in combination.items():
        total = total + k * sides[j]
    return total


def vanishing_divisors(x: Scalar) -> frozenset[Node]:
    """The factors that x divides by and that vanish for some angles or at some places: sin(alpha)."""
    if not holds_op(x, "div"):
        return frozenset()
    pending = [node.args[1] for node in order((x,)) if node.op == "div"]
    factors = set()
    while pending:
        d = pending.pop()
        if type(d) is Node and d.op == "mul":
            pending += d.args
        elif type(d) is Node:
            factors.add(d)
    return frozenset(d for d in factors if not never_vanishes(d))


def _ways(system: System) -> tuple[Reactions, ...]:
    few = Reactions.of(system, short=True)
    size = len(few.balance.equations) * len(few.components)
    return (few,) if size > TOO_MANY else (few, Reactions.of(system))


# -------- reaction names --------------------------------------------------------------------------------------
# Balance -> a symbol and its meaning for every reaction: B_x, R_stick_x, N_wall, F_floor, T_rope, M_E.


LETTERS = {
    "n": "N",
    "t": "F",
    "s": "S",
    "tension": "T",
    "couple": "M",
    "drive": "D",
    "friction": "F",
    "wrench": "W",
    "": "L",
}
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
        declared: LaTeX symbols of the joints and constraints that declare some, by name.
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
        """Table of the meanings of the symbols, all or those that are shown, in the order of the components."""
        rows = []
        named = {contact.component: symbols for contact, symbols in zip(self.contacts, self.frictions, strict=True)}
        for j, (component, symbol) in enumerate(zip(self.balance.components, self.symbols, strict=True)):
            if shown is None or symbol in shown:
                rows.append(Meaning(symbol, meaning(self.balance, component), component.unit))
            for share, friction in zip(component.friction, named.get(j, ()), strict=True):
                if shown is None or friction in shown:
                    rows.append(Meaning(friction, _friction(self.balance, component, share.label), "N"))
        return Table(HEAD, tuple(rows))

    def of_row(self, row: Row) -> Scalar | None:
        """The multiplier of a row as a reaction, sign included; None where no reaction belongs to it."""
        for component, symbol in zip(self.balance.components, self.symbols, strict=True):
            if component.kind == "constraint" and (component.owner, component.number) == (row.constraint, row.number):
                return -symbol if _is_turned(row, component) else symbol
        return None


def lettered(reactions: Reactions, taken: Container[str]) -> Lettered:
    """A symbol for every reaction, none of them a name of the model."""
    balance = reactions.balance
    graph = balance.system.scope.graph
    contacts = tuple(SystemFriction(balance.system).contacts(reactions.components))
    names = names_of_components(balance, taken)
    used = {*names}
    declared: dict[str, Symbol] = {}
    for name, c in zip(names, balance.components, strict=True):
        given = _declared(balance, c, c.label, _more(balance, c))
        declared |= {} if given is None else {name: given}

    def friction(label: str, owner: str, given: Symbol | None) -> Node:
        name = _unused(reaction_name(label, owner), taken, used)
        declared.update({} if given is None else {name: given})
        return graph.symbol(name)

    frictions = [(contact.name, reactions.components[contact.component]) for contact in contacts]
    named = tuple(
        tuple(friction(x.label, name, _declared(balance, c, x.label, ())) for x in c.friction) for name, c in frictions
    )
    return Lettered(reactions, tuple(map(graph.symbol, names)), contacts, named, declared)


def names_of_components(balance: Balance, taken: Container[str]) -> tuple[str, ...]:
    """The name of every component in a derivation, none of them a name of the model."""
    used: set[str] = set()
    return tuple(
        _unused(reaction_name(c.label, _owner(balance, c), *_more(balance, c)), taken, used) for c in balance.components
    )


def _unused(name: str, taken: Container[str], used: set[str]) -> str:
    while name in taken or name in used:
        name += "_r"
    used.add(name)
    return name


def reaction_name(label: str, owner: str, *more: str) -> str:
    """Name of a reaction: B_x, R_stick_x, N_wall, T_rope_2, M_E.

    A force along an axis of an owner that is no letter has R before it: stick_x would be a position of the stick.
    """
    if label in AXES:
        pieces = ("" if _LETTER.fullmatch(owner) else "R", owner, *more, label)
    else:
        pieces = (LETTERS[label.partition(" ")[0]], owner, *more)
    return "_".join(filter(None, pieces))


def reaction_symbol(given: ReactionSymbols | None, label: str, more: Sequence[str], *, alone: bool) -> Symbol | None:
    """Symbol that a joint or a constraint declares for a reaction in LaTeX; None where it declares none.

    Args:
        more: the parts of its name after the owner: a side, a number.
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
    """The symbol that a joint or a constraint gives a reaction of its own; None of sums, and where it gives none."""
    if len(named.combination) != 1 or not is_zero(named.given):
        return None
    ((j, factor),) = named.combination.items()
    component = balance.components[j]
    if type(factor) is Node or factor != 1:
        return None
    return _declared(balance, component, component.label, _more(balance, component))


def _declared(balance: Balance, component: Component, label: str, more: tuple[str, ...]) -> Symbol | None:
    """The symbol of a component, or of its friction along a direction, where its joint or constraint gives one."""
    model = balance.system.scope.model
    part = model.constraints.get(component.owner) or getattr(model.bodies.get(component.owner), "joint", None)
    mine = [c for c in balance.components if c.owner == component.owner and c.kind == component.kind]
    alone = len(mine) == 1 and not component.friction
    return None if part is None else reaction_symbol(part.symbol, label, more, alone=alone)


def _owner(balance: Balance, component: Component) -> str:
    """Owner in the name of a reaction; "" for members of the only truss."""
    if component.label != "tension" or not component.side:
        return component.owner
    return component.owner if len(balance.system.scope.model.trusses_in_parts) > 1 else ""


def _more(balance: Balance, component: Component) -> tuple[str, ...]:
    """Parts of the name after its owner: the side of a hinge, the ends of a member, the driven coordinate, a number."""
    if component.label in AXES:
        return (component.side,) if component.side else ()
    kind, _, number = component.label.partition(" ")
    if kind == "tension" and component.side:
        return tuple(component.side.split("-"))
    if kind == "drive":
        drives = [c for c in balance.components if c.kind == "drive" and c.owner == component.owner]
        return (component.side,) if len(drives) > 1 else ()
    number = number or _strand(balance, component) or _couple(balance, component)
    return (number,) if number else ()


def _strand(balance: Balance, component: Component) -> str:
    """The number of the first strand that has this tension, of a string that has several; else ""."""
    constraint = balance.system.scope.model.constraints.get(component.owner)
    rows = () if constraint is None or component.label != "tension" else constraint.strand_rows()
    return str(rows.index(component.number) + 1) if max(rows, default=1) > 1 else ""


def _couple(balance: Balance, component: Component) -> str:
    """Index of a couple of a constraint: x, y, z where all are along body axes, else its number; "" of a single one."""
    if component.label != "couple" or component.kind != "constraint":
        return ""
    couples = [
        c for c in balance.components if c.kind == "constraint" and c.owner == component.owner and c.label == "couple"
    ]
    if len(couples) == 1:
        return ""
    axes = [axis for c in couples for axis, e in zip(AXES, Matrix.IDENTITY, strict=True) if c.effects[0].couple == e]
    where = couples.index(component)
    return axes[where] if len(axes) == len(couples) else str(where + 1)


def meaning(balance: Balance, component: Component) -> str:
    """Meaning of a component in words: its kind, its body and its sense."""
    kind = component.label.partition(" ")[0]
    on = _on(balance, component)
    if kind == "tension" and component.side:
        return f"tension of member {component.side} of {component.owner}"
    if kind == "tension":
        strand = _strand(balance, component)
        if balance.system.scope.model.constraints[component.owner].exponent is not None:
            return f"mean tension of both sides of {component.owner}"
        return f"tension of {component.owner}" + (f", strand {strand}" if strand else "")
    if kind == "drive":
        return f"drive of {component.side or component.owner}, {on}"
    if kind in AXES:
        return f"force {on}, along {_axis(balance, component, kind)}"
    if kind == "couple":
        return f"couple {on}, {_sense(balance, component)}"
    constraint = balance.system.scope.model.constraints.get(component.owner)
    if kind == "t" and constraint is not None and constraint.exponent is not None:
        return f"tension of side 2 of {component.owner} less that of side 1"
    if kind in ("t", "s"):
        return _friction(balance, component, kind) + (
            ", without sliding" if component.bilateral_friction is None else ""
        )
    if kind == "friction":
        return f"friction {on}"
    if kind == "n":
        return f"normal force {on}{_direction(balance, component)}"
    return f"wrench {on}" if kind == "wrench" else f"reaction {on}"


def said(balance: Balance, named: NamedReaction) -> str:
    """Meaning in words of a reaction that an output names."""
    kind, _, rest = named.name.removeprefix("reaction_").partition("(")
    axis = kind.removeprefix("couple_")
    constraint = balance.system.scope.model.constraints.get(named.owner)
    if kind == "tension" and "," in rest and constraint is not None and constraint.exponent is not None:
        return f"tension of {named.owner}, side {rest.rstrip(')').rpartition(' ')[2]}"
    of_one = [j for j, k in named.combination.items() if type(k) is int and k == 1]
    if axis not in AXES and of_one and not balance.components[of_one[0]].is_wrench:
        return meaning(balance, balance.components[of_one[0]])
    if kind == "friction":
        force = balance.system.scope.model.forces.get(named.owner)
        return f"friction {'in the joint' if force is None else f'of the {force.kind}'} {named.owner}"
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
    if component.kind != "constraint":
        where = "place" if links[first].is_placed else "joint"
        return f"on {body} in its {where}, from {other}"
    if component.side:
        return f"on {component.side} in the hinge {component.owner}, from the others"
    return f"on {body} at {component.owner}, from {other}"


def _axis(balance: Balance, component: Component, label: str) -> str:
    """Ground axes in the plane and of constraints, else those of the body whose joint it is."""
    own = balance.system.scope.model.space != "plane" and component.kind == "joint"
    return f"{label} of its own axes" if own else label


def _sense(balance: Balance, component: Component) -> str:
    if balance.system.scope.model.space == "plane":
        return "counter-clockwise"
    return f"about {_named(component.effects[0].couple)}"


def _direction(balance: Balance, component: Component) -> str:
    """Direction of a component in words: along the constraint's normal, or across the way of a sliding joint."""
    if component.kind == "constraint":
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
    """True if the component is minus the multiplier: the force on another body than the row's first one."""
    first = row.pushes[0]
    if row.component not in AXES or not isinstance(first, PointForce):
        return False
    return bool(component.side) or first.place[0] is None


# -------- reaction payload ------------------------------------------------------------------------------------
# System -> every reaction by its name, for machines: with accelerations, without them where that is short.


LONGEST_SUM = 200  # characters of a sum of reactions that is reported
LARGEST = 2_000_000  # characters of all reactions together that are written out in full
NAMED_PART = 200  # characters of a text in which long parts have names


def reactions_payload(equations: EquationsOfMotion, taken: frozenset[str]) -> dict[str, Any]:
    """`reactions` {name: text, null where it is indeterminate}, `reaction_null_space` [{name: coefficient}, ...].

    Texts hold q, u, and accelerations as `theta''`. Long ones share parts, under `reaction_definitions`; where there
    are no reactions, `reactions_message` says why.

    Args:
        taken: names that no shared part may have.
    """
    try:
        readings = readings_of(equations, Reader(positive=equations.system.scope.positive))
        names = NamedReaction.all_of(readings.ways[0].balance)
    except DerivationError as error:
        message = f"{error.what}; {error.fix}" if error.fix else error.what
        return {"reactions": {}, "reaction_null_space": [], "reactions_message": message}
    values = [_value(readings, named) for named in names]
    spaces = _null_space(readings, names)
    flat = [x for x in values if x is not None] + [x for space in spaces for x in space.values()]
    definitions, texts = _texts(readings, flat, taken)
    rest = iter(texts)
    found = {
        "reactions": {n.name: None if x is None else next(rest) for n, x in zip(names, values, strict=True)},
        "reaction_null_space": [{name: next(rest) for name in space} for space in spaces],
    }
    return {**found, **({"reaction_definitions": [list(pair) for pair in definitions]} if definitions else {})}


def _value(readings: Readings, named: NamedReaction) -> Scalar | None:
    try:
        return readings.with_accelerations(named.combination, named.given)
    except Indeterminate:
        return None


def _null_space(readings: Readings, names: Sequence[NamedReaction]) -> list[dict[str, Scalar]]:
    solution = readings.ways[0].solution
    return [_share(readings, names, f) for f in solution.free]


def _share(readings: Readings, names: Sequence[NamedReaction], free: int) -> dict[str, Scalar]:
    """Change of each reaction by a unit of one free component; reactions without a change are left out."""
    shares = readings.ways[0].solution.shares
    found = {}
    for named in names:
        total: Scalar = 0
        for j, k in named.combination.items():
            if j == free:
                total = total + k
            elif free in shares.get(j, {}):
                total = total - k * shares[j][free]
        total = readable_value(readings.reader, total, readings.system.scope.positive)
        if not is_zero(total):
            found[named.name] = total
    return found


def _texts(
    readings: Readings, scalars: Sequence[Scalar], taken: frozenset[str]
) -> tuple[list[tuple[str, str]], list[str]]:
    written = without_cases([readings.reader.whole(x) for x in scalars])
    if sum(map(text_size, written)) <= LARGEST:
        return [], [to_text(x) for x in written]
    return with_definitions(written, NAMED_PART, taken)


SHORT = 600  # characters of a formula in which accelerations were replaced
CLEARER = 3  # times as long as with accelerations: longer ones keep them


@dataclass(frozen=True)
class ReactionFormula:
    """One reaction.

    Args:
        text: of q, u and t, of accelerations as `theta''` where these are left in it; None where it is too long, or
            has no single value.
        accelerated: True if the formula holds accelerations.
        message: the reason if there is no text, or None.
    """

    text: str | None
    accelerated: bool = False
    message: str | None = None


@dataclass(frozen=True)
class PrintedReactions:
    """The reactions of equations of motion as they are printed.

    Raises:
        DerivationError: a body is unsupported; a force acts at no place.
    """

    equations: EquationsOfMotion

    @cached_property
    def _readings(self) -> Readings:
        return readings_of(self.equations, Reader(positive=self.equations.system.scope.positive))

    @cached_property
    def _names(self) -> tuple[NamedReaction, ...]:
        return tuple(NamedReaction.all_of(self._readings.ways[0].balance))

    @property
    def formulas(self) -> dict[str, ReactionFormula]:
        """The formula of every reaction."""
        return {named.name: _formula(self._readings, named) for named in self._names}

    @property
    def null_space(self) -> list[dict[str, str]]:
        """Self-stresses, which may be added to indeterminate reactions: for each free component {name: coefficient}."""
        spaces = _null_space(self._readings, self._names)
        texts = iter(_texts(self._readings, [x for space in spaces for x in space.values()], frozenset())[1])
        return [{name: next(texts) for name in space} for space in spaces]

    @property
    def sums(self) -> dict[str, str]:
        """{text as in an output: unit} of sums of indeterminate reactions that have one value, as far as short."""
        system, readings = self.equations.system, self._readings
        units = {named.name: named.unit for named in self._names}
        found = {}
        for combination in Reactions.determinate_sums(_null_space(readings, self._names)):
            terms = [
                readable_value(readings.reader, k, system.scope.positive) * system.scope.graph.symbol(name)
                for name, k in combination.items()
            ]
            text = to_text(sum(terms, start=0))
            if len(text) <= LONGEST_SUM:
                found[text] = units[next(iter(combination))]
        return found

    def laws_in(self, texts: Iterable[str]) -> dict[str, str]:
        """{psi': law, psi'': law} of the names of driven rates and accelerations that stand in formulas."""
        names = {
            name
            for text in texts
            for kind, name in parse(text, longest=len(text), tables=AS_WRITTEN).code
            if kind == "name"
        }
        return {
            x.name: to_text(book_form(law)) for x, law in self.equations.system.scope.laws.items() if x.name in names
        }


def _formula(readings: Readings, named: NamedReaction) -> ReactionFormula:
    try:
        readings.ways[0].combined(named.combination, named.name)
    except Indeterminate as error:
        return ReactionFormula(None, message=f"{error.what}; {error.fix}")
    with_a = readings.with_accelerations(named.combination, named.given)
    without = readings.without(named.combination, named.given)
    if without is not None and length_in_print(without) <= min(SHORT, CLEARER * length_in_print(with_a)):
        return ReactionFormula(_text(readings.reader, without))
    if text_size(with_a) <= LONGEST:
        return ReactionFormula(_text(readings.reader, with_a), depends_on(with_a, readings.system.symbols.a))
    number = operations((with_a,)).total
    return ReactionFormula(None, message=f"its formula takes {number} operations and is not printed")


def _text(reader: Reader, x: Scalar) -> str:
    return to_text(without_cases((reader.whole(x),))[0])
