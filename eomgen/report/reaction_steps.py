"""Reactions -> the step that gives them: each as an expression, indeterminate ones with what they leave open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.explicit import short_accelerations
from eomgen.mechanics.integrals import rates_of
from eomgen.mechanics.loads import start_value
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.reactions import Reactions, reactions_of
from eomgen.mechanics.system import System
from eomgen.report.reaction_names import Lettered, lettered
from eomgen.report.reading import LONGEST, TRIED, Reader, length_in_print, omitted, readable_value
from eomgen.report.setting_steps import count, listed
from eomgen.report.statements import Code, Formula, Meaning, Name, Omitted, Prose, Statement, Step, Table
from eomgen.symbolic.derivative import depends_on, substituted
from eomgen.symbolic.evaluation import order
from eomgen.symbolic.graph import Node, Scalar, is_zero
from eomgen.symbolic.normal_form import simplest
from eomgen.symbolic.text import text_size

PAGE = 6000  # characters of all reactions in print
CLEARER = 1.5  # times as long as without accelerations: then the form with them is left out
SHORT = 240  # characters of a reaction in which no acceleration is left
WORK = 2000  # products of terms for one of them
VERB = Code("eomgen reactions MODEL")


def letters_of(system: System) -> Lettered | str:
    """The reactions of a system with their symbols; of dependent coordinates as if they were free, which is shorter.

    Where they cannot be derived, why not.
    """
    try:
        return lettered(reactions_of(system.free or system, short=True), system.scope.names)
    except DerivationError as error:
        return f"{error.what}; {error.mend}" if error.mend else error.what


def reactions_step(
    system: System, reader: Reader, assembly: Assembly, letters: Lettered | str, *, table: bool
) -> tuple[Step, ...]:
    """Every reaction; no step where nothing is held.

    Args:
        table: what the symbols mean stands here, and not in a step before.
    """
    if isinstance(letters, str):
        return (Step("reactions", "Reactions", (Prose((f"The reactions do not follow: {letters}.",)),)),)
    if not letters.symbols:
        return ()
    writer = _Writer(system, reader, letters, _accelerations(system, assembly))
    formulas, left_out = writer.formulas()
    shown = {formula.sides[0] for formula in formulas} | {
        symbol for c, symbol in zip(letters.balance.components, letters.symbols, strict=True)
        if c in letters.reactions.indeterminate
    }  # fmt: skip
    statements: list[Statement] = [letters.table(shown)] if table and shown else []
    if formulas:
        statements += [Prose(("From the balance of forces and moments of every body:",)), *formulas]
    if left_out:
        statements.append(_too_long(left_out, bool(formulas)))
    statements += _open(reader, letters)
    return (Step("reactions", "Reactions", tuple(statements)),) if statements else ()


def _accelerations(system: System, assembly: Assembly) -> dict[Node, Scalar]:
    found = short_accelerations(system, assembly)
    return {} if found is None else dict(zip(assembly.symbols.a, found, strict=True))


def _too_long(number: int, after: bool) -> Prose:
    more = f"{number} more" if after else "All of them" if number > 1 else "It"
    return Prose((f"{more} {'are' if number > 1 else 'is'} too long to print here: ", VERB,
                  " evaluates them, ", Code("eomgen codegen MODEL"), " gives them as code."))  # fmt: skip


@dataclass(frozen=True)
class _Writer:
    """Puts reactions into readable form, as many as a reader can take.

    Args:
        accelerations: of the independent speeds as functions of q and u, {} where they are long.
    """

    system: System
    reader: Reader
    letters: Lettered
    accelerations: Mapping[Node, Scalar]

    def formulas(self) -> tuple[list[Formula], int]:
        """(the formulas, how many more there are)."""
        kept: list[Formula] = []
        length, left_out = 0, 0
        rubbing = {rub.component for rub in self.letters.rubs}  # these stand in the step of friction
        own = self._own_values()
        for j, symbol in enumerate(self.letters.symbols):
            value = self.letters.reactions.values[j]
            if value is None or j in rubbing:
                continue
            sides = self._sides(value, own.get(self.letters.balance.components[j].name, value), length)
            if not sides:
                left_out += 1
                continue
            kept.append(Formula((symbol, *sides)))
            length += sum(map(text_size, sides))
        return kept, left_out

    def _own_values(self) -> dict[str, Scalar | None]:
        """By name, the reactions of the system over its independent speeds, where that is another."""
        if self.system.free is None or not self.accelerations:
            return {}
        reactions = reactions_of(self.system, short=True)
        return {c.name: x for c, x in zip(reactions.components, reactions.values, strict=True)}

    def _sides(self, value: Scalar, own: Scalar | None, length: int) -> list[Scalar]:
        """The value with accelerations, and without them where that is short; [] where both are too long."""
        full = self.reader.full
        if not full and length >= PAGE:
            return []
        with_a, without = self._short(value), self._without(own)
        if without is None:
            return [] if isinstance(with_a, Omitted) else [with_a]
        if isinstance(with_a, Omitted) or length_in_print(with_a) > CLEARER * length_in_print(without) + SHORT // 4:
            return [without]
        return [without] if with_a is without else [with_a, without]

    def _short(self, value: Scalar) -> Scalar | Omitted:
        """The value in readable form, or how large it is."""
        found = readable_value(self.reader, value, self.positive)
        too_long = not self.reader.full and text_size(found) > LONGEST
        return omitted(value) if too_long else found

    @cached_property
    def positive(self) -> frozenset[Node]:
        return positive_parameters(self.system.scope)

    def _without(self, value: Scalar | None) -> Scalar | None:
        """The value with the accelerations of the equations of motion, where that is short."""
        symbols = tuple(self.accelerations)
        if value is None or not depends_on(value, symbols) or text_size(value) > TRIED:
            return None
        (found,) = substituted((value,), self.accelerations)
        short = self._short(found)
        return None if isinstance(short, Omitted) or length_in_print(short) > SHORT else short


# -- along the motion from the start ----------------------------------------------------------------


def along_the_motion(
    system: System, reader: Reader, assembly: Assembly, letters: Lettered
) -> tuple[Step, ...]:
    """The reactions as functions of the coordinates alone, where first integrals give the speeds and that is short."""
    accelerations = _accelerations(system, assembly)
    start = _start(system)
    if not accelerations or start is None or system.free is not None:
        return ()
    positive = positive_parameters(system.scope)
    rates = rates_of(system, assembly, start, accelerations=tuple(accelerations.values()))
    if rates is None or sum(text_size(x) for x in rates.values()) > TRIED:
        return ()
    squares = [(u * u, simplest(x * x, WORK, positive)) for u, x in rates.items()]
    formulas: list[Statement] = []
    for symbol, value in zip(letters.symbols, letters.reactions.values, strict=True):
        if value is None or not depends_on(value, tuple(rates)) or text_size(value) > TRIED:
            continue
        (found,) = substituted(substituted((value,), accelerations), rates)
        found = simplest(found, WORK, positive)
        if not depends_on(found, tuple(rates)) and length_in_print(found) <= SHORT and not _holds_a_root(found):
            formulas.append(Formula((symbol, found)))
    if not formulas:
        return ()
    words = Prose(("The motion from the start has, by its first integrals,",))
    then = Prose(("so that along it the reactions are functions of the coordinates:",))
    statements = (words, *map(Formula, squares), then, *formulas)
    return (Step("along", "Reactions along the motion from the start", statements),)


def _holds_a_root(x: Scalar) -> bool:
    """Whether the sense of a motion, which is open, stands in it by a root."""
    return any(node.op == "sqrt" for node in order((x,)))


def _start(system: System) -> dict[Node, Scalar] | None:
    """q and u at the start as exact scalars of the parameters; None where a coordinate is driven."""
    scope, model = system.scope, system.scope.model
    if any(part.driven for part in model.coordinates.values()):
        return None
    start = {q: start_value(scope, model.coordinates[q.name]) for q in scope.symbols.q}
    return start | {u: scope.value(model.coordinates[u.name.removesuffix("'")].speed) for u in scope.symbols.u}


# -- what is indeterminate -------------------------------------------------------------------------


def _open(reader: Reader, letters: Lettered) -> list[Statement]:
    """The reactions that rigid bodies leave open, and what may be added to them without a trace."""
    reactions = letters.reactions
    if not reactions.indeterminate:
        return []
    symbol = dict(zip((c.name for c in reactions.components), letters.symbols, strict=True))
    names = listed(tuple(symbol[c.name] for c in reactions.indeterminate))
    one = len(reactions.indeterminate) == 1
    words = (
        *names, f" {'is' if one else 'are'} statically indeterminate: rigid bodies in balance leave ",
        f"{'it' if one else 'them'} open. To all of these at once may be added, with any number k, without a trace:",
    )  # fmt: skip
    statements: list[Statement] = [Prose(words)]
    spaces = reactions.null_space
    factors = _factors(reactions, letters, len(spaces))
    statements.append(Table(("symbol", "meaning", "unit", ""), tuple(
        Meaning(k, "any number: an inner stress that rigid bodies do not show") for k in factors
    )))  # fmt: skip
    for k, space in zip(factors, spaces, strict=True):
        statements += _shares(reader, symbol, k, space)
    return statements


def _factors(reactions: Reactions, letters: Lettered, number: int) -> list[Node]:
    """k, or k1, k2, ..."""
    scope = reactions.balance.system.scope
    found: list[Node] = []
    n = 0
    while len(found) < number:
        name = "k" if number == 1 and n == 0 else f"k{n}"
        n += 1
        if name != "k0" and name not in scope.names and name not in letters.names:
            found.append(scope.graph.symbol(name))
    return found


def _shares(
    reader: Reader, symbol: Mapping[str, Node], k: Node, space: Mapping[str, Scalar]
) -> Sequence[Statement]:
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
        formulas.append(Prose((f"{count(left_out, 'more share')} with {k.name} too long to print here.",)))
    return formulas
