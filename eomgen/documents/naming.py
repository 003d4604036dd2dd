"""Steps -> the same steps, in which the roots of long sums, and long and repeated parts, have names of their own.

Each is defined once, right before the first formula that holds it: r1 = sqrt(...), z1 = ...
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeGuard

from eomgen.documents.coefficient_names import LARGE
from eomgen.documents.reading import LONGEST, NAMED_PART, free_names
from eomgen.documents.statements import Equation, Formula, Side, Statement, Step
from eomgen.records import dataclass
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.exact.roots import is_root_of_sum
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Graph, Node, Scalar
from eomgen.symbolic.expression.node import Owner
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.print.layout import Product, products_of
from eomgen.symbolic.print.length import length_of
from eomgen.symbolic.print.text import named_parts, text_size

LONGEST_ROOT = 24  # characters of a root without a name


@dataclass(frozen=True)
class Written:
    """What a derivation prints, while parts of it get names.

    Args:
        steps: in order.
        equations: the equations of motion, printed in the steps too.
        definitions: (symbol, what it stands for), printed in the steps too, each before its use.
    """

    steps: tuple[Step, ...]
    equations: tuple[Equation, ...]
    definitions: tuple[tuple[Node, Scalar], ...]


def with_roots_named(written: Written, graph: Graph, taken: Container[str], roots: Mapping[Node, Scalar]) -> Written:
    """r1, r2, ... for the roots of long sums, the lengths of springs, and v1, v2, ... for their rates.

    Args:
        roots: what the symbols stand for that the formulas hold; in place of short ones that is written.
    """
    whole: dict[Node, Scalar] = {}
    for symbol, value in roots.items():
        value = substituted((value,), whole)[0]
        if text_size(value) <= LONGEST_ROOT:
            whole[symbol] = value
    written = _substituted(written, whole)
    parts = {symbol: substituted((value,), whole)[0] for symbol, value in roots.items() if symbol not in whole}
    names = {letter: map(graph.symbol, free_names(letter, taken)) for letter in "rv"}
    return _introduced(written, parts, lambda part: next(names["r" if is_root_of_sum(parts[part]) else "v"]), _always)


def with_coefficients_throughout(written: Written, coefficients: Mapping[Node, Scalar]) -> Written:
    """The names of coefficients in the equations of motion wherever a multiple of one stands, T = 1/2*I_1*u^2."""
    found = {x: _with_multiples(x, coefficients) for x in _scalars(written.steps) if type(x) is Node and coefficients}
    return _introduced(_substituted(written, found), coefficients, lambda symbol: symbol, _always)


def _with_multiples(x: Node, coefficients: Mapping[Node, Scalar]) -> Scalar:
    """The sum, in terms that hold a multiple of a coefficient its name; the same where none does."""
    total: Scalar = 0
    named = False
    for term in products_of(x):
        still, moving = _product(x.graph, term, still=True), _product(x.graph, term, still=False)
        for symbol, value in coefficients.items() if type(still) is Node and length_of(still) >= LARGE else ():
            if type(ratio := book_form(x.graph.div(still, value))) is not Node:
                still, named = x.graph.mul(ratio, symbol), True
                break
        total = x.graph.add(total, x.graph.mul(still, moving))
    return total if named else x


def _product(graph: Owner, term: Product, *, still: bool) -> Scalar:
    """What of a term is made of parameters alone, with its number; or the rest."""
    total: Scalar = term.coefficient if still else 1
    for base, e in term.numerator:
        total = graph.mul(total, graph.pow(base, e)) if graph.is_constant(base) == still else total
    for base, e in term.denominator:
        total = graph.div(total, graph.pow(base, e)) if graph.is_constant(base) == still else total
    return total


def _always(x: Scalar) -> bool:
    return True


def with_parts_named(written: Written, graph: Graph, taken: Container[str], raw: Container[Scalar]) -> Written:
    """z1, z2, ... for the long and the repeated parts of what is too long for one formula.

    Args:
        raw: scalars that are not in readable form, and too long to be printed whole.
    """

    def is_long(x: Scalar) -> bool:
        return x in raw or text_size(x) > LONGEST

    names = map(graph.symbol, free_names("z", taken))
    parts = named_parts([x for x in _scalars(written.steps) if is_long(x)], NAMED_PART)
    return _introduced(written, {part: part for part in parts}, lambda part: next(names), is_long)


def _substituted(written: Written, known: Mapping[Node, Scalar]) -> Written:
    """Every scalar with the symbols replaced."""
    return _introduced(written, {}, lambda part: part, _always, known) if known else written


def _introduced(
    written: Written,
    parts: Mapping[Node, Scalar],
    named: Callable[[Node], Node],
    applies: Callable[[Scalar], bool],
    given: Mapping[Node, Scalar] | None = None,
) -> Written:
    """The formulas to which it applies with a symbol for each of the parts.

    Args:
        parts: what each part stands for.
        named: a new symbol for a part.
        given: what is replaced without a definition.
    """
    known: dict[Node, Scalar] = dict(given or {})
    new: dict[Scalar, Scalar] = {}

    def renamed(statement: Statement) -> Iterator[Statement]:
        """The statement with the new names, after the definitions that it needs."""
        if isinstance(statement, Formula):
            for x in filter(applies, _scalars_of(statement)):
                yield from map(Formula, _definitions(x, parts, known, named))
                new[x] = substituted((x,), known)[0]
            statement = Formula(tuple(new.get(side, side) if _is_scalar(side) else side for side in statement.sides))
        yield statement

    steps = tuple(
        Step(step.key, step.title, tuple(new_one for statement in step.statements for new_one in renamed(statement)))
        for step in written.steps
    )
    equations = tuple(
        replace(e, left=new.get(e.left, e.left), right=new.get(e.right, e.right)) for e in written.equations
    )
    symbols = {*(symbol for symbol, _ in written.definitions), *(known[part] for part in parts if part in known)}
    return Written(steps, equations, tuple(_defined(steps, symbols)))


def _definitions(
    x: Scalar, parts: Mapping[Node, Scalar], known: dict[Node, Scalar], named: Callable[[Node], Node]
) -> Iterator[tuple[Node, Scalar]]:
    """(symbol, what it stands for): the definitions that x needs and that do not stand yet; `known` grows by them."""
    for part in order((x,), known):
        if part in parts and part not in known:
            if parts[part] is not part:
                yield from _definitions(parts[part], parts, known, named)
            value = substituted((parts[part],), known)[0]
            known[part] = symbol = named(part)
            yield symbol, value


def _defined(steps: Sequence[Step], symbols: Container[Scalar]) -> Iterator[tuple[Node, Scalar]]:
    """symbol = value of every symbol, in the order of the steps."""
    for step in steps:
        for statement in step.statements:
            if isinstance(statement, Formula) and len(found := _scalars_of(statement)) == 2:
                symbol, value = found
                if type(symbol) is Node and symbol in symbols:
                    yield symbol, value


def _scalars(steps: Sequence[Step]) -> list[Scalar]:
    statements = (statement for step in steps for statement in step.statements)
    return [x for statement in statements if isinstance(statement, Formula) for x in _scalars_of(statement)]


def _scalars_of(formula: Formula) -> list[Scalar]:
    return [side for side in formula.sides if _is_scalar(side)]


def _is_scalar(side: Side) -> TypeGuard[Scalar]:
    return isinstance(side, (Node, int, Fraction))
