"""Contacts with friction -> their step, and their friction in the equations of motion.

F = -mu |N| sign(v),   M a + c = Q + sum F_r dv_r/du,   N from the balance of the bodies
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from eomgen.documents.reaction_names import Lettered, lettered
from eomgen.documents.reaction_values import Readings, readings_of
from eomgen.documents.reading import TRIED, Reader, conditions_in, decided, length_in_print, readable_value
from eomgen.documents.statements import Formula, Omitted, Step, prose
from eomgen.mechanics.balance.friction import FrictionContact
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import function, sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.length import length_of
from eomgen.symbolic.print.text import text_size

LONGEST = 240  # characters of an acceleration in print
HALF = Fraction(1, 2)
WORDS = (
    "Friction acts against the sliding and grows with the normal reaction of its own contact, which the balance of the "
    "bodies gives together with the accelerations:"
)


@dataclass(frozen=True)
class FrictionTerms:
    """What contacts with friction add to a derivation.

    Args:
        forces: generalized force of all friction, written with the normal reactions' symbols, nu.
        definitions: (symbol of a normal reaction, what it is, accelerations in it).
        step: that prints them.
        solved: the step of the accelerations, () where they are long.
    """

    forces: ScalarRow
    definitions: tuple[tuple[Node, Scalar], ...]
    step: Step
    solved: tuple[Step, ...]


def friction_of(equations: EquationsOfMotion, reader: Reader) -> FrictionTerms:
    """The friction of every contact by its normal reaction, and that by the bodies' balance."""
    system = equations.system
    readings = readings_of(equations, reader)
    letters = lettered(readings.ways[0], system.scope.names)
    senses = _senses(letters, system)
    forces: list[Scalar] = [0] * len(system.symbols.u)
    shown = {symbol: function(x.op, readable_value(reader, x.args[0])) for x, symbol in senses.items()}
    definitions = [(symbol, book_form(x, Work.ENTRY, readings.system.scope.positive)) for symbol, x in shown.items()]
    statements = [*map(Formula, definitions)]
    for contact, frictions in zip(letters.contacts, letters.frictions, strict=True):
        normal = letters.symbols[contact.component]
        if contact.normals:
            shown_force, formula = _of_round(reader, letters, contact, senses)
            definitions += [] if isinstance(shown_force, Omitted) else [(normal, shown_force)]
            statements.append(formula)
        else:
            value = _normal(readings, contact.component, equations, senses)
            definitions.append((normal, value))
            statements += [Formula((normal, value)), *_along(reader, letters, contact, frictions, senses)]
        row = contact.along if contact.normals else substituted(contact.force, senses)
        forces = [total + share * normal for total, share in zip(forces, row, strict=True)]
    step = Step("friction", "Friction", (prose(WORDS), *statements))
    return FrictionTerms(tuple(reader.short_with_symbols(forces)), tuple(definitions), step, _solved(reader, equations))


def _of_round(
    reader: Reader, letters: Lettered, contact: FrictionContact, senses: Mapping[Node, Node]
) -> tuple[Scalar | Omitted, Formula]:
    """(the friction of bilateral contacts, that as a formula: F = factor sqrt(N_1^2 + N_2^2))."""
    factor, force = substituted((contact.factor, letters.balance.given[contact.component]), senses)
    size = sqrt(sum((letters.symbols[j] * letters.symbols[j] for j in contact.normals), start=0))
    shown = reader.shown(force)
    return shown, Formula((letters.symbols[contact.component], readable_value(reader, factor) * size, shown))


def _along(
    reader: Reader, letters: Lettered, contact: FrictionContact, frictions: Sequence[Node], senses: Mapping[Node, Node]
) -> list[Formula]:
    """F = factor N along each direction in which a contact slides."""
    factors = substituted([x.factor for x in letters.reactions.components[contact.component].friction], senses)
    normal = letters.symbols[contact.component]
    return [
        Formula((friction, readable_value(reader, factor) * normal))
        for friction, factor in zip(frictions, factors, strict=True)
    ]


def _normal(readings: Readings, j: int, equations: EquationsOfMotion, senses: Mapping[Node, Node]) -> Scalar:
    """A normal reaction with its accelerations, or with those of the equations of motion where that is shorter."""
    reader = readings.reader
    values = [way.value(j) for way in readings.ways]
    accelerations = dict(zip(equations.symbols.a, equations.accelerations or (), strict=False))
    moving = [_sliding(reader, substituted((x,), accelerations)[0]) for x in values if text_size(x) <= TRIED]
    forms = readings.forms(substituted(tuple(x for x in (*values, *moving) if x is not None), senses))
    return min(forms, key=length_of)


def _sliding(reader: Reader, x: Scalar) -> Scalar | None:
    """x while the one contact in it slides, sign^2 = 1; None where there are several, or x is long."""
    for condition in conditions_in(x)[:1]:
        if_true, if_false = (_sliding(reader, decided(x, condition, holds)) for holds in (True, False))
        return None if if_true is None or if_false is None else condition.graph.select(condition, if_true, if_false)
    signs = [node for node in order((x,)) if node.op == "sign"]
    if text_size(x) > TRIED or len(signs) > 1:
        return None
    for sign in signs:
        up, down = (readable_value(reader, substituted((x,), {sign: one})[0]) for one in (1, -1))
        x = readable_value(reader, HALF * (up + down) + HALF * sign * (up - down))
    return x


def _solved(reader: Reader, equations: EquationsOfMotion) -> tuple[Step, ...]:
    """The accelerations while one contact slides, where they are short."""
    found = [_sliding(reader, x) for x in equations.accelerations or ()]
    shown = [None if x is None else readable_value(reader, x) for x in found]
    if not shown or any(x is None or length_in_print(x) > LONGEST for x in shown):
        return ()
    formulas = tuple(Formula((a, x)) for a, x in zip(equations.symbols.a, shown, strict=True) if x is not None)
    return (Step("solved", "Accelerations", (prose("While the contact slides:"), *formulas)),)


def _senses(letters: Lettered, system: System) -> dict[Node, Node]:
    """A symbol for each sign of a sliding velocity that is more than one rate, on a surface for its magnitude."""
    found: dict[Node, Node] = {}
    for contact in letters.contacts:
        speed = next((row.sliding for row in system.ties.rows if row.tie == contact.name and row.shares), None)
        for node in order((contact.factor, *contact.force)):
            sense = node.op == "sign" and node.args[0] not in system.symbols.u
            if node not in found and (sense or (node is speed and node.op == "sqrt")):
                name = f"{'s' if sense else 'v'}_{contact.name}"
                while name in system.scope.names or name in letters.names:
                    name += "_r"
                found[node] = system.scope.graph.symbol(name)
    return found
