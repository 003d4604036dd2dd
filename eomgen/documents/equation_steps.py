"""Both sides of each equation -> the last steps: equations of motion, divided and printed, and solved where small."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.documents.bounded import elsewhere
from eomgen.documents.coefficient_names import with_coefficients_named
from eomgen.documents.friction_steps import friction_of
from eomgen.documents.reading import (
    LARGEST_DIVISOR,
    LONGEST,
    NAMED_LENGTH,
    NAMED_PART,
    Reader,
    Shortened,
    conditions_in,
    free_names,
    length_in_print,
    readable_value,
    shortened,
)
from eomgen.documents.setting_steps import moved_coordinates
from eomgen.documents.statements import Equation, Formula, Meaning, Omitted, Piece, Prose, Statement, Step, prose
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.exact.book_form import book_form
from eomgen.symbolic.exact.normal_form import common_factor, readable, simple_constants
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted
from eomgen.symbolic.expression.graph import Graph, Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ROOT_OF_SUM, holds_op
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.decimals import number_text
from eomgen.symbolic.print.layout import Factor, factors, products_of
from eomgen.symbolic.print.length import length_of
from eomgen.symbolic.print.text import text_size

SOLVED = 3  # accelerations that are solved for by hand, at most
SOLVED_LENGTH = 700  # characters of the equations that are solved by hand, at most
SHORTEST = "In their shortest form, what does not accelerate on the right"
SIMPLER = (1, 0.5)  # the share of their operations that constants keep at most where they are multiplied out one by one
QUOTIENT = 200  # characters of a solved acceleration in one line, numerator over denominator


@dataclass(frozen=True)
class Sides:
    """Inertia and forces of one equation: left = M a + c, right = Q + J^T lam."""

    left: Scalar
    right: Scalar


@dataclass(frozen=True)
class EquationSteps:
    """The equations as printed, and the steps that print them.

    Args:
        definitions: (name, what it stands for) of what has a name in them; those of coefficients no step states yet.
        meanings: of names of coefficients, for the table of symbols.
    """

    equations: tuple[Equation, ...]
    definitions: tuple[tuple[Node, Scalar], ...]
    steps: tuple[Step, ...]
    meanings: tuple[Meaning, ...] = ()

    @property
    def coefficients(self) -> dict[Node, Scalar]:
        """What the names of coefficients stand for."""
        return {symbol: x for symbol, x in self.definitions if any(row.symbol is symbol for row in self.meanings)}


def multiplier_forces(equations: EquationsOfMotion) -> tuple[Scalar, ...]:
    """J^T lam, one entry a speed."""
    size = len(equations.symbols.u)
    return tuple(
        sum((row[k] * lam for row, lam in zip(equations.J, equations.symbols.lam, strict=True)), start=0)
        for k in range(size)
    )


def sides_of(
    equations: EquationsOfMotion, M: Sequence[Sequence[Scalar]], c: Sequence[Scalar], Q: Sequence[Scalar]
) -> list[Sides]:
    """M a + c = Q + J^T lam, row by row."""
    rows = []
    for k, force in enumerate(multiplier_forces(equations)):
        inertia = sum((m * a for m, a in zip(M[k], equations.symbols.a, strict=True)), start=c[k])
        rows.append(Sides(inertia, Q[k] + force))
    return rows


def equations_of(
    equations: EquationsOfMotion, reader: Reader, sides: Sequence[Sides], rule: tuple[Piece, ...]
) -> EquationSteps:
    """The equations of motion, divided by what is common, and the accelerations where that is short.

    Args:
        sides: of each equation, as the method gave them.
        rule: the law by which they come, in words.
    """
    if not sides:
        return EquationSteps((), (), (Step("equations", "Equations of motion", (prose("Nothing is free to move."),)),))
    if equations.friction:
        friction = friction_of(equations, reader)
        sides = [Sides(row.left, row.right + force) for row, force in zip(sides, friction.forces, strict=True)]
        result = _equations(equations, reader, sides, rule)
        steps = (friction.step, *result.steps, *friction.solved)
        definitions = (*friction.definitions, *result.definitions)
        return EquationSteps(result.equations, definitions, steps, result.meanings)
    return _equations(equations, reader, sides, rule)


def _equations(
    equations: EquationsOfMotion, reader: Reader, sides: Sequence[Sides], rule: tuple[Piece, ...]
) -> EquationSteps:
    written = readable_equations(reader, equations, sides)
    if written is not None:
        named = with_coefficients_named(equations.system.scope, written, taken_in(equations))
        lines = (*printed(equations.system, named.equations), *closing(reader, equations))
        first = Step("equations", "Equations of motion", (Prose(rule), *lines))
        steps = (first, *_solved(reader, equations, named.equations))
        return EquationSteps(named.equations, named.definitions, steps, named.meanings)
    found = _whole(reader, equations) if reader.full else _named(reader, equations)
    if found is None:
        count = operations((*(x for row in equations.M for x in row), *equations.forcing)).total
        return EquationSteps((), (), (Step("equations", "Equations of motion", (Prose(rule), elsewhere(count))),))
    written, definitions = found
    statements = (
        Prose(rule),
        prose(f"{SHORTEST}{', with names for parts' if definitions else ''}:"),
        *map(Formula, definitions),
        *printed(equations.system, written),
        *closing(reader, equations),
    )
    return EquationSteps(tuple(written), definitions, (Step("equations", "Equations of motion", statements),))


def readable_equations(reader: Reader, equations: EquationsOfMotion, sides: Sequence[Sides]) -> list[Equation] | None:
    """Each equation in readable form, divided by what both sides have in common; None where one is too long."""
    written = []
    for u, row in zip(equations.symbols.u, sides, strict=True):
        left, right = reader.shown(row.left), reader.shown(row.right)
        if isinstance(left, Omitted) or isinstance(right, Omitted) or text_size(left) + text_size(right) > LONGEST:
            return None
        written.append(Equation(u, *reader.divided(left, right)))
    return written


def _whole(reader: Reader, equations: EquationsOfMotion) -> tuple[list[Equation], tuple[tuple[Node, Scalar], ...]]:
    """The shortest form of the equations, no names given yet."""
    sides = iter(_shortest_sides(reader, equations))
    return [Equation(u, next(sides), next(sides)) for u in equations.symbols.u], ()


def _shortest_sides(reader: Reader, equations: EquationsOfMotion) -> tuple[Scalar, ...]:
    """Left and right of M a = forcing + J^T lam, row after row."""
    rows = sides_of(equations, equations.M, [0] * len(equations.M), equations.forcing)
    sides = [x for row in rows for x in (row.left, row.right)]
    simple = simple_constants(sides, equations.symbols.parameters.values())
    sizes = {x: (operations((x,)).total, operations((found,)).total) for x, found in simple.items() if found is not x}
    forms: list[Sequence[Scalar]] = [sides]
    if not sizes:
        return reader.with_symbols(sides)
    kept = [tuple(x for x, (was, now) in sizes.items() if now <= share * was) for share in SIMPLER]
    forms += [substituted(sides, {x: simple[x] for x in some}) for some in dict.fromkeys(kept) if some]
    return reader.with_symbols(min(forms, key=lambda form: operations(form).total))


def _named(
    reader: Reader, equations: EquationsOfMotion
) -> tuple[list[Equation], tuple[tuple[Node, Scalar], ...]] | None:
    """The shortest form of the equations with named sub-expressions; None where even that is too long."""
    graph = equations.symbols.graph
    if _is_beyond_names(equations):
        return None
    taken = {node.name for node in _symbols(equations)}
    found: Shortened | None = shortened(graph, _shortest_sides(reader, equations), NAMED_PART, taken)
    if found is None:
        return None
    texts = iter(found.expressions)
    return [Equation(u, next(texts), next(texts)) for u in equations.symbols.u], found.definitions


def _is_beyond_names(equations: EquationsOfMotion) -> bool:
    """Whether no form is short enough: every operation on what moves is written at least once, an operand beside it.

    Roots of sums are not: a symbol stands for each.
    """
    sides = (*(x for row in equations.M for x in row), *equations.forcing)
    moving = operations(sides, equations.symbols.parameters.values()).total
    return 2 * moving > NAMED_LENGTH and not any(holds_op(x, ROOT_OF_SUM) for x in sides)


def taken_in(equations: EquationsOfMotion) -> set[str]:
    """The names that stand in the equations, and those of the model."""
    return {*equations.system.scope.names, *(node.name for node in _symbols(equations))}


def _symbols(equations: EquationsOfMotion) -> tuple[Node, ...]:
    s = equations.symbols
    return (s.t, *s.parameters.values(), *s.inputs.values(), *s.q, *s.u, *s.a, *s.lam)


def printed(system: System, equations: Sequence[Equation]) -> list[Statement]:
    """Each equation on a line of its own, and by what it was divided."""
    statements: list[Statement] = []
    coordinates = dict(zip(system.symbols.u, moved_coordinates(system), strict=True))
    for equation in equations:
        if type(equation.divisor) is Node or equation.divisor != 1:
            q = coordinates[equation.speed]
            statements.append(prose("For ", q, ", ", *_divided(system, equation.divisor), ":"))
        statements.append(Formula((equation.left, equation.right)))
    return statements


def _divided(system: System, divisor: Scalar) -> tuple[Piece, ...]:
    """By what both sides were multiplied and divided, and that the divisor must not vanish where it can."""
    found = factors(divisor)
    number, graph = found.coefficient, system.scope.graph
    above, below = (_product(graph, part) for part in (found.numerator, found.denominator))
    if number.numerator == 1:
        below, number = number.denominator * below, 1
    divided = number * above
    words: list[Piece] = [] if below == 1 else ["multiplied by ", _piece(below)]
    if divided != 1 or not words:
        moving = depends_on(divided, system.symbols.q)
        words += [" and "] if words else []
        words += ["divided by ", _piece(divided), " (where that is not zero)" if moving else ""]
    return tuple(words)


def _product(graph: Graph, found: Sequence[Factor]) -> Scalar:
    total: Scalar = 1
    for base, e in found:
        total = total * graph.pow(base, e)
    return total


def _piece(x: Scalar) -> Piece:
    return x if isinstance(x, Node) else number_text(x)


def closing(reader: Reader, equations: EquationsOfMotion) -> list[Statement]:
    """J a + gamma = 0, for each closing row."""
    rows = []
    for row, gamma in zip(equations.J, equations.gamma, strict=True):
        rows.append(sum((j * a for j, a in zip(row, equations.symbols.a, strict=True)), start=gamma))
    if not rows:
        return []
    words = "The constraints, differentiated until accelerations stand in them:"
    return [prose(words), *(Formula((reader.shown(row), 0)) for row in rows)]


def _solved(reader: Reader, equations: EquationsOfMotion, written: Sequence[Equation]) -> list[Step]:
    """The accelerations, where there are few and their formulas short: by Cramer's rule."""
    a = equations.symbols.a
    length = sum(text_size(x) for e in written for x in (e.left, e.right))
    if equations.friction or equations.J or len(written) > SOLVED or length > SOLVED_LENGTH:
        return []
    if any(depends_on(root, a) for root in reader.roots.values()):
        return []
    determinant, numerators = _by_cramer([_in_whole_numbers(e.left, e.right) for e in written], a)
    if is_zero(determinant):
        return []
    quotients = [_quotient(reader, equations.symbols.graph, x, determinant) for x in numerators]
    apart = len(products_of(determinant)) == 1  # each equation has its own acceleration
    if all(length_in_print(x) <= (LONGEST if apart else QUOTIENT) for x in quotients):
        return [Step("solved", "Accelerations", tuple(map(Formula, zip(a, quotients, strict=True))))]
    if max(text_size(x) for x in (*numerators, determinant)) > LONGEST // 2:
        return []
    taken = {node.name for node in _symbols(equations)}
    symbol = equations.symbols.graph.symbol("D" if "D" not in taken else next(free_names("D", taken)))
    formulas = [Formula((symbol, determinant))]
    formulas += [Formula((symbol * x, n)) for x, n in zip(a, numerators, strict=True)]
    words = prose("By Cramer's rule, with the determinant of the equations")
    return [Step("solved", "Accelerations", (words, *formulas))]


def _quotient(reader: Reader, graph: Graph, above: Scalar, below: Scalar) -> Scalar:
    """above / below in its shorter form: as one quotient without common factors, or as a sum."""
    if conditions_in(above):
        return readable_value(reader, graph.div(above, below))
    one = book_form(graph.div(above, below))
    several = reader.shown(one) if reader.roots else one
    return one if isinstance(several, Omitted) or length_of(one) <= length_of(several) else several


def _in_whole_numbers(left: Scalar, right: Scalar) -> tuple[Scalar, Scalar]:
    """Both sides multiplied so that no fractions are left in them, where that number is small."""
    number, _ = common_factor((left, right), Work.ENTRY)
    if number.denominator > LARGEST_DIVISOR:
        return left, right
    return number.denominator * left, number.denominator * right


def _by_cramer(sides: Sequence[tuple[Scalar, Scalar]], a: Sequence[Node]) -> tuple[Scalar, list[Scalar]]:
    """(determinant, numerators) of left = right, which is linear in a."""
    M = [[_coefficient(left, x) for x in a] for left, _ in sides]
    rest = [readable(right - _without(left, a), Work.ENTRY) for left, right in sides]
    return book_form(_determinant(M)), [book_form(_determinant(_replaced(M, k, rest))) for k in range(len(a))]


def _coefficient(x: Scalar, a: Node) -> Scalar:
    return derivative(x, a)


def _without(x: Scalar, accelerations: Sequence[Node]) -> Scalar:
    return substituted((x,), dict.fromkeys(accelerations, 0))[0]


def _determinant(M: Sequence[Sequence[Scalar]]) -> Scalar:
    """By the first row; for the few rows that are solved here."""
    if not M:
        return 1
    total: Scalar = 0
    for k, x in enumerate(M[0]):
        minor = [[*row[:k], *row[k + 1 :]] for row in M[1:]]
        total = total + (-1) ** k * x * _determinant(minor)
    return total


def _replaced(M: Sequence[Sequence[Scalar]], column: int, by: Sequence[Scalar]) -> list[list[Scalar]]:
    return [[*row[:column], x, *row[column + 1 :]] for row, x in zip(M, by, strict=True)]
