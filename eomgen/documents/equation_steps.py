"""The last steps: equations of motion, divided and printed; and the derivation as a whole.

Both sides of each equation -> the last steps: equations of motion, divided and printed, and solved where small.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from eomgen.documents.bounded import elsewhere
from eomgen.documents.motion_steps import moved_coordinates
from eomgen.documents.reaction_values import Lettered, Readings, lettered, readings_of
from eomgen.documents.reading import (
    LARGEST_DIVISOR,
    LONGEST,
    NAMED_LENGTH,
    NAMED_PART,
    TRIED,
    Reader,
    Shortened,
    conditions_in,
    decided,
    free_names,
    length_in_print,
    readable_value,
    shortened,
    with_coefficients_named,
)
from eomgen.documents.statements import Equation, Formula, Meaning, Omitted, Piece, Prose, Statement, Step, prose
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.free_bodies import FrictionContact, SystemFriction
from eomgen.symbolic.exact import book_form, common_factor, readable, simplest
from eomgen.symbolic.expression import (
    ROOT_OF_SUM,
    Fraction,
    Graph,
    Node,
    Scalar,
    ScalarRow,
    depends_on,
    derivative,
    function,
    holds_op,
    is_zero,
    operations,
    order,
    substituted,
)
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import Product, length_of, products_of, text_size, to_text

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
        definitions: (name, expression) of the named parts in them; those of coefficients no step states yet.
        meanings: of names of coefficients, for the table of symbols.
    """

    equations: tuple[Equation, ...]
    definitions: tuple[tuple[Node, Scalar], ...]
    steps: tuple[Step, ...]
    meanings: tuple[Meaning, ...] = ()

    @property
    def coefficients(self) -> dict[Node, Scalar]:
        """Scalars for which the names of coefficients stand."""
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
    """The equations of motion, divided by common factors, and the accelerations where that is short.

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
    """Each equation in readable form, divided by the common factors of both sides; None where one is too long."""
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
    """True if no form is short enough: each operation on moving symbols is written at least once, with an operand.

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
    return (s.t, *s.parameters.values(), *s.inputs.values(), *s.x, *s.a, *s.lam)


def printed(system: System, equations: Sequence[Equation]) -> list[Statement]:
    """Each equation on a line of its own, and the factor by which it was divided."""
    statements: list[Statement] = []
    coordinates = dict(zip(system.symbols.u, moved_coordinates(system), strict=True))
    for equation in equations:
        if type(equation.divisor) is Node or equation.divisor != 1:
            q = coordinates[equation.speed]
            statements.append(prose("For ", q, ", ", *_divided(system, equation.divisor), ":"))
        statements.append(Formula((equation.left, equation.right)))
    return statements


def _divided(system: System, divisor: Scalar) -> tuple[Piece, ...]:
    """Words on the factors by which both sides were multiplied and divided, and that a divisor must not vanish."""
    found = Product.of(divisor)
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


def _product(graph: Graph, found: Sequence[tuple[Node, int]]) -> Scalar:
    total: Scalar = 1
    for base, e in found:
        total = total * graph.pow(base, e)
    return total


def _piece(x: Scalar) -> Piece:
    return x if isinstance(x, Node) else to_text(x)


def closing(reader: Reader, equations: EquationsOfMotion) -> list[Statement]:
    """J a + gamma = 0, for each constraint row."""
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
    """Determinant by expansion along the first row; for the few rows that are solved here."""
    if not M:
        return 1
    total: Scalar = 0
    for k, x in enumerate(M[0]):
        minor = [[*row[:k], *row[k + 1 :]] for row in M[1:]]
        total = total + (-1) ** k * x * _determinant(minor)
    return total


def _replaced(M: Sequence[Sequence[Scalar]], column: int, by: Sequence[Scalar]) -> list[list[Scalar]]:
    return [[*row[:column], x, *row[column + 1 :]] for row, x in zip(M, by, strict=True)]


# -------- friction steps --------------------------------------------------------------------------------------
# Contacts with friction -> their step, and their friction in the equations of motion.
#
# F = -mu |N| sign(v),   M a + c = Q + sum F_r dv_r/du,   N from the balance of the bodies


LONGEST_SLIDING = 240  # characters of an acceleration in print
HALF = Fraction(1, 2)
WORDS = (
    "Friction acts against the sliding and grows with the normal reaction of its own contact, which the balance of the "
    "bodies gives together with the accelerations:"
)
ONE_VALUE = (
    "It has one value while the spectral radius of D is below 1, D the growth of the force of each joint with that of "
    "every other:"
)


@dataclass(frozen=True)
class FrictionTerms:
    """Terms that contacts with friction add to a derivation.

    Args:
        forces: generalized force of all friction, written with the normal reactions' symbols, nu.
        definitions: (symbol of a normal reaction, its expression, accelerations in it).
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
        if contact.ends:
            shown_force, formula = _of_round(reader, letters, contact, senses)
            definitions += [] if isinstance(shown_force, Omitted) else [(normal, shown_force)]
            statements.append(formula)
        else:
            value = _normal(readings, contact.component, equations, senses)
            definitions.append((normal, value))
            statements += [Formula((normal, value)), *_along(reader, letters, contact, frictions, senses)]
            statements += _of_rope(system, contact, (normal, *frictions), senses)
        row = contact.along if contact.ends else substituted(contact.force, senses)
        forces = [total + share * normal for total, share in zip(forces, row, strict=True)]
    step = Step("friction", "Friction", (prose(WORDS), *statements, *_uniqueness(system)))
    return FrictionTerms(
        tuple(reader.short_with_symbols(forces)), tuple(definitions), step, _solved_sliding(reader, equations)
    )


def _uniqueness(system: System) -> list[Prose | Formula]:
    """The condition under which friction that depends on the forces of joints has one value."""
    joints = [link.joint for link in system.motion.links if link.joint is not None]
    if not any(law.coulomb is not None for joint in joints for _, _, law in joint.frictions):
        return []
    graph = system.scope.graph
    D = SystemFriction(system).feedback()
    entries = [("_".join(dict.fromkeys(("D", r, s))), x) for r, row in D.items() for s, x in row.items()]
    positive = system.scope.positive
    shown = [
        (graph.symbol(name), simplest(_while_sliding(x), Work.ANSWER, positive))
        for name, x in entries
        if not is_zero(x)
    ]
    return [prose(ONE_VALUE), *map(Formula, shown)] if shown else []


def _while_sliding(x: Scalar) -> Scalar:
    """The scalar where each joint slides: the squares of signs are 1."""
    return substituted((x,), {node: 1 for node in order((x,)) if node.op == "sign"})[0]


def _of_round(
    reader: Reader, letters: Lettered, contact: FrictionContact, senses: Mapping[Node, Node]
) -> tuple[Scalar | Omitted, Formula]:
    """(the friction of bilateral contacts, that as a formula: F = factor sqrt(N_1^2 + N_2^2))."""
    factor, force = substituted((contact.factor, letters.balance.given[contact.component]), senses)
    size = contact.load(letters.symbols)
    shown = reader.shown(force)
    return shown, Formula((letters.symbols[contact.component], readable_value(reader, factor) * size, shown))


def _of_rope(
    system: System, contact: FrictionContact, letters: Sequence[Node], senses: Mapping[Node, Node]
) -> list[Formula]:
    """T + F/2 = e^(-mu phi sign v) (T - F/2) of the sides of a rope on a drum; [] of other contacts."""
    constraint = system.scope.model.constraints.get(contact.name)
    if constraint is None or constraint.exponent is None:
        return []
    T, F = letters
    v = next(row.sliding for row in system.constraints.rows if row.constraint == contact.name and row.tangent)
    (way,) = substituted((function("sign", v),), senses)
    ratio = function("exp", -system.scope.value(constraint.exponent) * way)
    return [Formula((T + HALF * F, ratio * (T - HALF * F)))]


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
    if text_size(x) > TRIED:
        return None
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


def _solved_sliding(reader: Reader, equations: EquationsOfMotion) -> tuple[Step, ...]:
    """The accelerations while one contact slides, where they are short."""
    found = [_sliding(reader, x) for x in equations.accelerations or ()]
    shown = [None if x is None else readable_value(reader, x) for x in found]
    if not shown or any(x is None or length_in_print(x) > LONGEST_SLIDING for x in shown):
        return ()
    formulas = tuple(Formula((a, x)) for a, x in zip(equations.symbols.a, shown, strict=True) if x is not None)
    return (Step("solved", "Accelerations", (prose("While the contact slides:"), *formulas)),)


def _senses(letters: Lettered, system: System) -> dict[Node, Node]:
    """A symbol for each sign of a sliding velocity that is more than one rate, on a surface for its magnitude."""
    found: dict[Node, Node] = {}
    for contact in letters.contacts:
        speed = next(
            (row.sliding for row in system.constraints.rows if row.constraint == contact.name and row.shares), None
        )
        for node in order((contact.factor, *contact.force)):
            sense = node.op == "sign" and node.args[0] not in system.symbols.u
            if node not in found and (sense or (node is speed and node.op == "sqrt")):
                name = f"{'s' if sense else 'v'}_{contact.name}"
                while name in system.scope.names or name in letters.names:
                    name += "_r"
                found[node] = system.scope.graph.symbol(name)
    return found


def simple_constants(scalars: Sequence[Scalar], parameters: Collection[Node]) -> dict[Node, Scalar]:
    """All that is made of parameters alone in the scalars, at its simplest: (2 A + C)/2 - A is C/2."""
    constant = set(parameters)
    nodes = order(tuple(scalars))
    for x in nodes:
        if x.op != "symbol" and x.args and all(type(a) is not Node or a in constant for a in x.args):
            constant.add(x)
    carried = {x for x in scalars if type(x) is Node and x in constant}
    carried |= {a for x in nodes if x not in constant for a in x.args if type(a) is Node and a in constant}
    return {x: simplest(x, Work.PART) for x in carried if x.args}
