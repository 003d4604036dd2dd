"""Graph scalars -> the same as a reader wants them: short, with names for what is long.

Graph scalars -> the same scalars as a reader wants them, with bounded work; those that are too long to print are known.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from typing import TypeGuard

from eomgen.documents.statements import Equation, Formula, Meaning, Omitted, Side, Statement, Step
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics import Scope
from eomgen.symbolic.exact import BRACKETS, Rooted, TooLarge, book_form, common_factor, equal_at_random_states, readable
from eomgen.symbolic.expression import (
    SUMS,
    Fraction,
    Graph,
    Node,
    Owner,
    Scalar,
    function,
    holds_op,
    is_zero,
    order,
    parse,
    substituted,
)
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import (
    LONGEST_RESULT,
    Product,
    Symbol,
    length_of,
    named_parts,
    products_of,
    readable_text,
    text_size,
    to_text,
)

LONGEST = 1500  # characters of one formula in print
NESTED = 400  # characters of a formula that is not multiplied out, in print
TRIED = 20_000  # characters: what is longer by far will not become short
WAVES = 100  # terms of a normal form that are written shortly; more of them take long, and are long
POLYNOMIAL = tuple("symbol pi neg add sub mul div sin cos".split())
LARGEST_DIVISOR = 120  # a number by which an equation is divided or multiplied, at most
HALF = Fraction(1, 2)
DIVIDED = 4000  # characters: longer formulas are not tried as one quotient
MOST_CASES = 4  # conditions of one formula, of which each case is put into readable form
NAMED_PART = 160  # characters of a formula in which long parts have names
NAMED = 80  # sub-expressions with a name of their own, at most
NAMED_LENGTH = 8000  # characters of all named sub-expressions together, at most


class Reader:
    """Puts scalars into readable form, each once and with a budget of its own: none depends on those before it.

    Args:
        full: long formulas are printed in full, and not left out.
        gathers: sums of parameters stand in parentheses before what moves, and squares of sums are left, where that
            is shorter: so the equations of bodies that turn in space are written.
        positive: symbols that stand for positive numbers: the length sqrt(l^2) of a rod is l.
    """

    def __init__(self, *, full: bool = False, gathers: bool = False, positive: Collection[Node] = ()) -> None:
        self.full, self.gathers, self.positive = full, gathers, positive
        self.raw: set[Scalar] = set()  # what is too long to print whole
        self.roots: dict[Node, Scalar] = {}  # what the symbols in `shown` stand for
        self._known: dict[Scalar, Scalar | None] = {}

    def _read(self, x: Scalar) -> Scalar | None:
        """x in its readable form, a symbol for each root of a sum; None where it is too long to print."""
        if x not in self._known:
            conditions = conditions_in(x)
            many = len(conditions) > MOST_CASES
            short = self._whole(x) if many or not conditions else self._by_cases(x, conditions[0])
            self._known[x] = short
            if short is not None:
                self._known[short] = short
        return self._known[x]

    def _whole(self, x: Scalar) -> Scalar | None:
        return self._shortened(*self.with_symbols((self._with_sizes(x),)))

    def _with_sizes(self, x: Scalar) -> Scalar:
        """x with every root of a positive parameter's square as what it is: l for sqrt(l^2)."""
        if not self.positive or not holds_op(x, "sqrt", "abs"):
            return x
        sizes = [node for node in order((x,)) if node.op in ("sqrt", "abs") and node.graph.is_constant(node)]
        known = {node: readable(node, Work.ENTRY, self.positive) for node in sizes}
        known = {node: size for node, size in known.items() if not holds_op(size, "sqrt", "abs")}
        return substituted((x,), known)[0] if known else x

    def _by_cases(self, x: Scalar, condition: Node) -> Scalar | None:
        """x where the condition holds, and where it does not, each in readable form."""
        try:
            if_true, if_false = (self._read(decided(x, condition, holds)) for holds in (True, False))
        except DerivationError:  # it has no value where that fails: friction that Newton's steps do not reach
            return self._whole(x)
        if if_true is None or if_false is None:
            return None
        found = condition.graph.select(condition, if_true, if_false) if if_true is not if_false else if_true
        return found if text_size(found) <= LONGEST or self.full else None

    def _shortened(self, x: Scalar) -> Scalar | None:
        size = text_size(x)
        if size <= TRIED:
            short = self._shortest(x)
            if short is not None and text_size(short) <= LONGEST:
                return short
        if size <= NESTED:
            return x
        self.raw.add(x)
        return x if self.full else None

    def _shortest(self, x: Scalar) -> Scalar | None:
        """x multiplied out and written shortly; None where that takes too much work.

        1/2*k*(r - l)^2 with a root r is left alone where that is shorter.
        """
        held = [symbol for symbol in order((x,)) if symbol in self.roots]
        try:
            short = book_form(x, positive=self.positive, most=WAVES, roots=held, squares=self.gathers)
        except TooLarge:
            return None
        left_alone = held or holds_roots(x)
        return x if left_alone and length_of(x) < length_of(short) else short

    def whole(self, x: Scalar) -> Scalar:
        """x with the roots that its symbols stand for."""
        return Rooted((), tuple(self.roots.items())).back((x,))[0]

    def with_symbols(self, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """The scalars as they are, but with a symbol for each root of a sum."""
        over = Rooted.of(scalars, Work.ENTRY)
        self.roots |= dict(over.roots)
        return over.expressions

    def with_names(self, steps: tuple[Step, ...], scope: Scope) -> tuple[Step, ...]:
        """The steps with a name for each root of a long sum that the symbols in them stand for."""
        return with_roots_named(Written(steps, (), ()), scope.graph, scope.names, self.roots).steps

    def shown(self, x: Scalar) -> Scalar | Omitted:
        """x in its readable form with a symbol for each root of a sum, or its size."""
        short = self._read(x)
        return omitted(x) if short is None else short

    def short_with_symbols(self, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Each as shown, or as it is where that is too long."""
        return tuple(x if (short := self._read(x)) is None else short for x in scalars)

    def short(self, scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Each in its readable form, or as it is where that is too long."""
        return tuple(map(self.whole, self.short_with_symbols(scalars)))

    def divided(self, left: Scalar, right: Scalar) -> tuple[Scalar, Scalar, Scalar]:
        """(left / divisor, right / divisor, divisor), all as shown: both sides without the common factor of all terms.

        A number is divided by only where it is small; nothing is where the equation gets longer by it.
        """
        graph = next((x.graph for x in (left, right) if type(x) is Node), None)
        if graph is None or holds_roots(left, right):  # numbers alone: of what moves no mass
            return left, right, 1
        number, product = common_factor((left, right), Work.ENTRY, tuple(self.roots))
        product = product * common_sums(left, right)
        small = max(number.numerator, number.denominator) <= LARGEST_DIVISOR
        found: list[tuple[Scalar, Scalar, Scalar]] = []
        for divisor in (number * product, product) if small else (product,):
            over = self.short_with_symbols((graph.div(left, divisor), graph.div(right, divisor)))
            found.append((over[0], over[1], divisor))
        found.append((left, right, 1))
        return min(found, key=lambda each: length_of(*each[:2]))

    def as_square(self, x: Scalar) -> Scalar:
        """A potential k*(a - b)^2/2 with its parentheses, where that is shorter than multiplied out; else x."""
        product = Product.of(self.with_symbols((x,))[0])
        if type(x) is not Node or not any(base.op in SUMS and e == 2 for base, e in product.numerator):
            return x
        found: Scalar = product.coefficient
        for base, e in product.numerator:
            written = self.shown(base) if e == 2 else base
            if isinstance(written, Omitted):
                return x
            found = found * x.graph.pow(written, e)
        for base, e in product.denominator:
            found = x.graph.div(found, x.graph.pow(base, e))
        short = self._read(x)
        if short is not None and length_of(short) <= length_of(found):
            return x
        self._known[found] = found
        return found

    def as_sum(self, total: Scalar, parts: Sequence[Scalar]) -> Scalar:
        """A total as the sum of its parts, each as shown, where that is shorter than in a form of its own."""
        written = [self.shown(x) for x in parts]
        if type(total) is not Node or any(isinstance(x, Omitted) for x in written):
            return total
        found = sum((x for x in written if not isinstance(x, Omitted)), start=0)
        short = self._read(total)
        if type(found) is not Node or (short is not None and length_of(short) <= length_of(found) + BRACKETS):
            return total
        if not equal_at_random_states([(found, total)]).equal:  # no part is left out
            return total
        self._known[found] = found
        return found


def common_sums(*sides: Scalar) -> Scalar:
    """The product of the sums of parameters that all terms of the sides hold: (a + b) of (a + b)^2*x'' = (a + b)*g."""
    held = [dict(term.numerator) for x in sides if not is_zero(x) for term in products_of(x)]
    total: Scalar = 1
    for base in held[0] if held else ():
        if base.op in SUMS and base.graph.is_constant(base) and (e := min(each.get(base, 0) for each in held)):
            total = total * base.graph.pow(base, e)
    return total


def conditions_in(x: Scalar) -> list[Node]:
    """The conditions of the cases in x, each once; one comes before those that are evaluated only where it fails."""
    if not holds_op(x, "select"):
        return []
    deep: dict[Node, int] = {}
    for node in order((x,)):
        if node.op == "select":
            deep[node.args[0]] = max(deep.get(node.args[0], 0), _chain(node))
    return sorted(deep, key=lambda condition: -deep[condition])


def _chain(node: Scalar) -> int:
    """Number of conditions that are evaluated one after the other."""
    length = 0
    while type(node) is Node and node.op == "select":
        length, node = length + 1, node.args[2]
    return length


def decided(x: Scalar, condition: Node, holds: bool) -> Scalar:
    """x with every choice by the condition made."""
    while chosen := {n: n.args[1 if holds else 2] for n in order((x,)) if n.op == "select" and n.args[0] is condition}:
        (x,) = substituted((x,), chosen)
    return x


def answer_text(scalar: Scalar, positive: Collection[Node]) -> str | None:
    """Text of an exact answer, in the grammar; None where it is too long to read."""
    if text_size(scalar) > LONGEST_RESULT:
        return None
    return readable_text(without_cases((book_form(scalar, Work.FORMULA, positive),))[0])


def without_cases(scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """The same by functions of the grammar: a where x <= y, else b, is (a (1 + s) + b (1 - s))/2, s = sign(y - x).

    Where x = y exactly it is the mean of both. A case that holds only where two sides are equal is left out.
    """
    if not any(holds_op(x, "select") for x in scalars):
        return tuple(scalars)
    known: dict[Node, Scalar] = {}
    for node in order(scalars):
        if node.op == "select":
            condition, if_true, if_false = node.args
            if condition.op == "min":  # x <= y and y <= x
                known[node] = substituted((if_false,), known)[0]
                continue
            low, high = substituted(condition.args, known)
            s = function("sign", high - low)
            if_true, if_false = substituted((if_true, if_false), known)
            known[node] = HALF * (if_true * (1 + s) + if_false * (1 - s))
    return substituted(tuple(scalars), known) if known else tuple(scalars)


def readable_value(reader: Reader, value: Scalar, positive: Collection[Node] = ()) -> Scalar:
    """The value as shown, or as one quotient where that is shorter; as it is where both are too long."""
    conditions = conditions_in(value)
    if 0 < len(conditions) <= MOST_CASES and text_size(value) <= TRIED:
        cases = [readable_value(reader, decided(value, conditions[0], holds), positive) for holds in (True, False)]
        return conditions[0].graph.select(conditions[0], *cases) if cases[0] is not cases[1] else cases[0]
    shown = reader.shown(value)
    if type(value) is not Node or text_size(value) > DIVIDED:
        return value if isinstance(shown, Omitted) else shown
    one = book_form(value, Work.ENTRY, positive)
    return one if isinstance(shown, Omitted) or length_of(one) < length_of(shown) else shown


def holds_roots(*expressions: Scalar) -> bool:
    """True where the expressions hold functions other than sines and cosines."""
    return any(type(x) is Node and not x.is_made_of(*POLYNOMIAL) for x in expressions)


def length_in_print(*expressions: Scalar) -> int:
    """The number of characters; about that where it is large."""
    return sum(len(to_text(x)) if text_size(x) <= 4 * LONGEST else text_size(x) for x in expressions)


def omitted(*expressions: Scalar) -> Omitted:
    """Statement that the expressions are too long to print."""
    return Omitted((expressions,))


@dataclass(frozen=True)
class Shortened:
    """Expressions in which long and repeated parts have names.

    Args:
        definitions: (symbol, its expression), each before its use.
        expressions: written with the symbols.
    """

    definitions: tuple[tuple[Node, Scalar], ...]
    expressions: tuple[Scalar, ...]


def shortened(graph: Graph, expressions: Sequence[Scalar], limit: int, taken: Container[str]) -> Shortened | None:
    """The expressions with named parts z1, z2, ..., so that none is much longer than `limit` characters.

    None where the names would be too many for a reader.
    """
    parts = named_parts(expressions, limit)
    if len(parts) > NAMED:
        return None
    used = {node.name for node in order(expressions) if node.op == "symbol"}
    known: dict[Node, Scalar] = {}
    definitions = []
    for part, name in zip(parts, free_names("z", taken, used), strict=False):
        value = substituted((part,), known)[0]
        known[part] = graph.symbol(name)
        definitions.append((graph.symbol(name), value))
    written = substituted(expressions, known)
    length = sum(text_size(x) for x in (*written, *(value for _, value in definitions)))
    return Shortened(tuple(definitions), written) if length <= NAMED_LENGTH else None


def free_names(letter: str, *taken: Container[str]) -> Iterator[str]:
    """letter1, letter2, ..., without those that are taken."""
    names = (f"{letter}{number}" for number in count(1))
    return (name for name in names if not any(name in each for each in taken))


# -------- coefficient names -----------------------------------------------------------------------------------
# Equations of motion -> the same with names for large coefficients, where these halve an equation.
#
# I_1*theta'' = M,    I_1 = 1/4*m*r_s^2 + I_s + I_p*r_s^2/(4*r_p^2) + I_c*r_s^2/(4*(r_s + r_p)^2)


LARGE = 20  # marks of a coefficient that may have a name
HALF_AS_LONG = 0.5  # of an equation's marks, to which the names must bring it
LETTERS = {"kg*m^2": "I", "kg": "m", "N/m": "k"}  # by the unit; of all other coefficients the next
OTHER = "C"


@dataclass(frozen=True)
class NamedCoefficients:
    """Equations in which large coefficients have names.

    Args:
        equations: with the names.
        definitions: (name, its expression).
        units: of each name, "" where it is not known.
    """

    equations: tuple[Equation, ...]
    definitions: tuple[tuple[Node, Scalar], ...] = ()
    units: tuple[str, ...] = ()

    @property
    def meanings(self) -> tuple[Meaning, ...]:
        """The names for a table of symbols."""
        pairs = zip(self.definitions, self.units, strict=True)
        return tuple(Meaning(name, "coefficient in the equations of motion", unit) for (name, _), unit in pairs)


def with_coefficients_named(scope: Scope, equations: Sequence[Equation], taken: Collection[str]) -> NamedCoefficients:
    """The equations with a name for each large coefficient of those that become half as long by it.

    Args:
        scope: of the model.
        taken: names that no coefficient may have, nor one that is set like them.
    """
    large: dict[Node, None] = {}
    for equation in equations:
        parts = dict.fromkeys(part for side in (equation.left, equation.right) for part in _constants(side))
        named = substituted((equation.left, equation.right), dict.fromkeys(parts, scope.symbols.t))
        if parts and length_of(*named) + len(parts) <= HALF_AS_LONG * length_of(equation.left, equation.right):
            large |= parts
    if not large:
        return NamedCoefficients(tuple(equations))
    units = [_unit(scope, part) for part in large]
    set_as = {Symbol.of(name).tex for name in taken}
    names = {letter: free_names(f"{letter}_") for letter in (*LETTERS.values(), OTHER)}
    known: dict[Node, Node] = {}
    for part, unit in zip(large, units, strict=True):
        name = next(n for n in names[LETTERS.get(unit, OTHER)] if Symbol.of(n).tex not in set_as)
        known[part] = scope.graph.constant(name)
    sides = [substituted((e.left, e.right), known) for e in equations]
    written = tuple(replace(e, left=left, right=right) for e, (left, right) in zip(equations, sides, strict=True))
    return NamedCoefficients(written, tuple((symbol, part) for part, symbol in known.items()), tuple(units))


def _constants(x: Scalar) -> Iterator[Node]:
    """The largest parts made of parameters alone that are sums or quotients, and long."""
    stack = [x]
    while stack:
        node = stack.pop()
        if type(node) is not Node:
            continue
        if node.op in ("add", "sub", "div") and node.graph.is_constant(node):
            if length_of(node) >= LARGE:
                yield node
        elif node.op in ("add", "sub", "neg", "mul", "div"):
            stack += reversed(node.args)


def _unit(scope: Scope, x: Node) -> str:
    """Unit of a coefficient, inferred from the units of the model; "" where they do not determine it."""
    found = scope.model.dimensions.names
    text = to_text(x)
    dimension = found.inference.reduced(found.walk().of(parse(text, longest=len(text))))
    return "" if dimension.unknowns else str(dimension)


# -------- naming ----------------------------------------------------------------------------------------------
# Steps -> the same steps, in which the roots of long sums, and long and repeated parts, have names of their own.
#
# Each is defined once, right before the first formula that holds it: r1 = sqrt(...), z1 = ...


LONGEST_ROOT = 24  # characters of a root without a name


@dataclass(frozen=True)
class Written:
    """Content of a derivation, while parts of it get names.

    Args:
        steps: in order.
        equations: the equations of motion, printed in the steps too.
        definitions: (symbol, its expression), printed in the steps too, each before its use.
    """

    steps: tuple[Step, ...]
    equations: tuple[Equation, ...]
    definitions: tuple[tuple[Node, Scalar], ...]


def with_roots_named(written: Written, graph: Graph, taken: Container[str], roots: Mapping[Node, Scalar]) -> Written:
    """r1, r2, ... for the roots of long sums, the lengths of springs, and v1, v2, ... for their rates.

    Args:
        roots: the expressions of the symbols in the formulas; short ones are written in place of their symbols.
    """
    whole: dict[Node, Scalar] = {}
    for symbol, value in roots.items():
        value = substituted((value,), whole)[0]
        if text_size(value) <= LONGEST_ROOT:
            whole[symbol] = value
    written = _substituted(written, whole)
    parts = {symbol: substituted((value,), whole)[0] for symbol, value in roots.items() if symbol not in whole}
    names = {letter: map(graph.symbol, free_names(letter, taken)) for letter in "rv"}
    return _introduced(written, parts, lambda part: next(names["r" if _is_root(parts[part]) else "v"]), _always)


def _is_root(x: Scalar) -> bool:
    return type(x) is Node and x.op == "sqrt"


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
    """Factors of a term that are made of parameters alone, with its number; or the other factors."""
    total: Scalar = term.coefficient if still else 1
    for base, e in term.numerator:
        total = graph.mul(total, graph.pow(base, e)) if graph.is_constant(base) == still else total
    for base, e in term.denominator:
        total = graph.div(total, graph.pow(base, e)) if graph.is_constant(base) == still else total
    return total


def _always(x: Scalar) -> bool:
    return True


def with_parts_named(written: Written, graph: Graph, taken: Container[str], raw: Container[Scalar]) -> Written:
    """z1, z2, ... for the long and the repeated parts of expressions that are too long for one formula.

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
        parts: the expression of each part.
        named: a new symbol for a part.
        given: expressions that are replaced without a definition.
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
    """(symbol, its expression): the definitions that x needs and that do not stand yet; `known` grows by them."""
    for part in order((x,), known):
        if part in parts and part not in known:
            if parts[part] is not part:
                yield from _definitions(parts[part], parts, known, named)
            value = substituted((parts[part],), known)[0]
            known[part] = symbol = named(part)
            yield symbol, value


def _defined(steps: Sequence[Step], symbols: Container[Scalar]) -> Iterator[tuple[Node, Scalar]]:
    """symbol = value of every symbol, in the order of the steps; of friction also F = -mu sign(s') |N| = value."""
    for step in steps:
        for statement in step.statements:
            sizes = (2, 3) if step.key == "friction" else (2,)
            if isinstance(statement, Formula) and len(found := _scalars_of(statement)) in sizes:
                symbol, value = found[0], found[-1]
                if type(symbol) is Node and symbol in symbols:
                    yield symbol, value


def _scalars(steps: Sequence[Step]) -> list[Scalar]:
    statements = (statement for step in steps for statement in step.statements)
    return [x for statement in statements if isinstance(statement, Formula) for x in _scalars_of(statement)]


def _scalars_of(formula: Formula) -> list[Scalar]:
    return [side for side in formula.sides if _is_scalar(side)]


def _is_scalar(side: Side) -> TypeGuard[Scalar]:
    return isinstance(side, (Node, int, Fraction))
