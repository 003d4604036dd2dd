"""Reactions -> the step that gives them: each as an expression, indeterminate ones with what they leave open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice

from eomgen.documents.integral_steps import while_words
from eomgen.documents.reaction_names import Lettered, lettered
from eomgen.documents.reaction_values import Readings, readings_of, shown_system
from eomgen.documents.reading import LONGEST, TRIED, Reader, free_names, length_in_print
from eomgen.documents.setting_steps import count, listed_symbols
from eomgen.documents.statements import Code, Formula, Meaning, Name, Omitted, Prose, Statement, Step, Table, prose
from eomgen.errors import DerivationError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.speeds import rates_and_extent
from eomgen.mechanics.initial_state.exact_start import known_start
from eomgen.mechanics.reactions.reactions import Reactions, reactions_of
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size

PAGE = 6000  # characters of all reactions in print
CLEARER = 1.5  # times as long as without accelerations: then the form with them is left out
SHORT = 240  # characters of a reaction in which no acceleration is left
VERB = Code("eomgen reactions MODEL")


def letters_of(system: System) -> Lettered | str:
    """The reactions of a system with their symbols, or why they cannot be derived."""
    try:
        return lettered(reactions_of(shown_system(system), short=True), system.scope.names)
    except DerivationError as error:
        return f"{error.what}; {error.mend}" if error.mend else error.what


def reactions_step(
    equations: EquationsOfMotion, reader: Reader, letters: Lettered | str, *, table: bool
) -> tuple[Step, ...]:
    """Every reaction; no step where nothing is held.

    Args:
        table: what the symbols mean stands here, and not in a step before.
    """
    if isinstance(letters, str):
        return (Step("reactions", "Reactions", (prose(f"The reactions do not follow: {letters}."),)),)
    if not letters.symbols:
        return ()
    formulas, left_out = _formulas(readings_of(equations, reader, free=True), letters)
    shown = {formula.sides[0] for formula in formulas} | {
        symbol
        for c, symbol in zip(letters.balance.components, letters.symbols, strict=True)
        if c in letters.reactions.indeterminate
    }
    statements: list[Statement] = [letters.table(shown)] if table and shown else []
    if formulas:
        statements += [prose("From the balance of forces and moments of every body:"), *formulas]
    if left_out:
        statements.append(_too_long(left_out, bool(formulas)))
    statements += _open(reader, letters)
    return (Step("reactions", "Reactions", tuple(statements)),) if statements else ()


def _too_long(number: int, after: bool) -> Prose:
    more = f"{number} more" if after else "All of them" if number > 1 else "It"
    return prose(
        f"{more} {'are' if number > 1 else 'is'} too long to print here: ",
        VERB,
        " evaluates them, ",
        Code("eomgen codegen MODEL"),
        " gives them as code.",
    )


def _formulas(readings: Readings, letters: Lettered) -> tuple[list[Formula], int]:
    """(the formulas of as many reactions as a reader can take, how many more there are)."""
    kept: list[Formula] = []
    length, left_out = 0, 0
    with_friction = {contact.component for contact in letters.contacts}  # these stand in the step of friction
    for j, symbol in enumerate(letters.symbols):
        if j in with_friction or not letters.reactions.solution.determined(j):
            continue
        sides = _sides(readings, j) if readings.reader.full or length < PAGE else []
        if sides:
            kept.append(Formula((symbol, *sides)))
            length += sum(map(text_size, sides))
        else:
            left_out += 1
    return kept, left_out


def _sides(readings: Readings, j: int) -> list[Scalar]:
    """A reaction with accelerations, and without them where that is short; [] where both are too long."""
    with_a, without = readings.with_accelerations({j: 1}), readings.without({j: 1})
    too_long = not readings.reader.full and text_size(with_a) > LONGEST
    if without is None or length_in_print(without) > SHORT:
        return [] if too_long else [with_a]
    if too_long or length_in_print(with_a) > CLEARER * length_in_print(without) + SHORT // 4:
        return [without]
    return [without] if with_a is without else [with_a, without]


# -- along the motion from the start ----------------------------------------------------------------


def along_the_motion(equations: EquationsOfMotion, reader: Reader, letters: Lettered) -> tuple[Step, ...]:
    """The reactions as functions of the coordinates alone, where first integrals give the speeds and that is short."""
    if equations.system.free is not None:
        return ()
    readings = readings_of(equations, reader)
    accelerations, positive = readings.accelerations, readings.system.scope.positive
    start = _start(equations.system) if accelerations else None
    if start is None:
        return ()
    by_integrals = rates_and_extent(equations, start, accelerations=tuple(accelerations.values()))
    if by_integrals is None or sum(text_size(x) for x in by_integrals[0].values()) > TRIED:
        return ()
    rates, held = by_integrals
    known, u = rates, tuple(rates)
    squares = [(u * u, book_form(x * x, Work.ENTRY, positive)) for u, x in rates.items()]
    formulas: list[Statement] = []
    with_friction = {contact.component for contact in letters.contacts}  # these stand in the step of friction
    for j, symbol in enumerate(letters.symbols):
        if j in with_friction or not letters.reactions.solution.determined(j):
            continue
        values = [x for way in readings.own_ways if depends_on(x := way.value(j), u)]
        found = readings.replaced(values, lambda x: substituted(substituted((x,), accelerations), known)[0])
        if found is not None and not depends_on(found, u) and _is_clear(found):
            formulas.append(Formula((symbol, found)))
    if not formulas:
        return ()
    words = prose("The motion from the start has, by its first integrals", *while_words(held), ",")
    then = prose("so that along it the reactions are functions of the coordinates:")
    statements = (words, *map(Formula, squares), then, *formulas)
    return (Step("along", "Reactions along the motion from the start", statements),)


def _is_clear(x: Scalar) -> bool:
    """Whether it is short, and the sense of the motion, which is open, does not stand in it by a root."""
    return length_in_print(x) <= SHORT and all(node.op != "sqrt" for node in order((x,)))


def _start(system: System) -> dict[Node, Scalar] | None:
    """q and u at the start, as every verb takes them; None where it is not known, or a coordinate is driven."""
    driven = any(part.driven for part in system.scope.model.coordinates.values())
    return None if driven else known_start(system)


# -- what is indeterminate -------------------------------------------------------------------------


def _open(reader: Reader, letters: Lettered) -> list[Statement]:
    """The reactions that rigid bodies leave open, and what may be added to them without a trace."""
    reactions = letters.reactions
    if not reactions.indeterminate:
        return []
    symbol = dict(zip((c.name for c in reactions.components), letters.symbols, strict=True))
    names = listed_symbols(tuple(symbol[c.name] for c in reactions.indeterminate))
    one = len(reactions.indeterminate) == 1
    words = (
        *names,
        f" {'is' if one else 'are'} statically indeterminate: rigid bodies in balance leave ",
        f"{'it' if one else 'them'} open. To all of these at once may be added, with any number k, without a trace:",
    )
    statements: list[Statement] = [Prose(words)]
    spaces = reactions.null_space
    factors = _factors(reactions, letters, len(spaces))
    statements.append(
        Table(
            ("symbol", "meaning", "unit", ""),
            tuple(Meaning(k, "any number: an inner stress that rigid bodies do not show") for k in factors),
        )
    )
    for k, space in zip(factors, spaces, strict=True):
        statements += _shares(reader, symbol, k, space)
    return statements


def _factors(reactions: Reactions, letters: Lettered, number: int) -> list[Node]:
    """k, or k1, k2, ..."""
    scope = reactions.balance.system.scope
    names = free_names("k", scope.names, letters.names)
    if number == 1 and "k" not in scope.names and "k" not in letters.names:
        names = iter(["k"])
    return [scope.graph.symbol(name) for name in islice(names, number)]


def _shares(reader: Reader, symbol: Mapping[str, Node], k: Node, space: Mapping[str, Scalar]) -> Sequence[Statement]:
    """Delta of each reaction = coefficient * k."""
    formulas: list[Statement] = []
    left_out = 0
    for name, coefficient in space.items():
        if is_zero(coefficient):
            continue
        shown = reader.shown(coefficient)
        if isinstance(shown, Omitted):
            left_out += 1
        else:
            formulas.append(Formula((Name("Delta", by=symbol[name]), shown * k)))
    if left_out:
        formulas.append(prose(f"{count(left_out, 'more share')} with {k.name} too long to print here."))
    return formulas
