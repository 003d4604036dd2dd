"""A coordinate, or its rate, as a function of time -> whether the equations of motion hold with it, and the start."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from eomgen.errors import DerivationError
from eomgen.judge.case import Case
from eomgen.judge.decision import combination
from eomgen.judge.reading import HandEquation
from eomgen.judge.right import meant_by_numbers
from eomgen.judge.terms import short_text, term_text
from eomgen.judge.verdict import Cause
from eomgen.mechanics.equations.pieces import EVERYWHERE, Extent
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order

MOST_PLACES = 14  # of a course that are changed


@dataclass(frozen=True)
class Course:
    """A coordinate q = f(t) put into the equations of motion.

    Args:
        known: q and its rates as functions of time.
        left: what is left of the equations of motion that know nothing else.
        holds: whether that is nothing; None: undecided, or they do not decide it alone.
        begins: whether it starts as the model does; None: where that starts is not known.
        held: in which pieces it holds.
        values: of the file, that its numbers are: it holds with these.
    """

    known: Mapping[Node, Scalar]
    left: ScalarRow
    holds: bool | None
    begins: bool | None
    held: Extent = EVERYWHERE
    values: Mapping[Node, Scalar] = field(default_factory=dict)


def course_of(case: Case, written: HandEquation, constants: Mapping[str, Scalar]) -> Course | None:
    """The course that an equation gives; None: it gives none.

    Args:
        constants: names of the author's own: where there are some, any start will do.
    """
    name = written.left.code[0][1] if len(written.left.code) == 1 and written.left.code[0][0] == "name" else ""
    coordinates = case.model.coordinates
    moving = {*coordinates, *(f"{q}'" for q in coordinates), *(f"{q}''" for q in coordinates), *case.model.speeds}
    if name.removesuffix("'") not in coordinates or "t" not in written.right.names or written.right.names & moving:
        return None
    if coordinates[name.removesuffix("'")].driven:
        return None
    x = case.value(written.right, constants)
    found = _put_in(case, name, x, any_start=bool(constants))
    if found is None or (found.holds and found.begins is not False):
        return found
    values = meant_by_numbers(case, written, (x, *case.rows, *case.start.values()))
    other = _put_in(case, name, x, any_start=bool(constants), values=values) if values else None
    return other if other is not None and other.holds and other.begins else found


def _put_in(
    case: Case, name: str, x: Scalar, *, any_start: bool, values: Mapping[Node, Scalar] | None = None
) -> Course | None:
    """A coordinate or its rate, by its name, as a function of time put into the equations of motion.

    Args:
        values: of parameters, put in too.
    """
    values = values or {}
    (x,) = substituted((x,), values)
    symbols, scope, known = case.system.symbols, case.system.scope, dict[Node, Scalar]()
    for rate in (name, f"{name}'", f"{name}''")[: 3 - name.count("'")]:
        node = scope.names[rate]
        if type(node) is Node and node.op == "symbol":
            known[node] = x
        x = derivative(x, symbols.t)
    given = tuple(scope.names[x.name] - value for x, value in known.items() if not x.name.endswith("''"))
    given = substituted(substituted(given, case.start), values) if values else given
    begins = True if any_start else case.starts_at_zero(*given)
    others = [x for x in (*symbols.q, *symbols.u) if x not in known]
    if not case.rows:
        return None
    left = [row for row in substituted(case.rows, {**known, **values}) if not depends_on(row, (*others, *case.forced))]
    a = scope.names[name.removesuffix("'") + "''"]
    if not left and type(a) is Node and a in known:  # the others move with it: what is left of all equations together
        (found,) = substituted((known[a] - case.phase.eliminated(a),), {**known, **values})
        left = [] if depends_on(found, others) else [found]
    inputs = {node: case.system.inputs[n] for n, node in symbols.inputs.items()}
    mine = substituted(tuple(left), inputs)
    if not mine and name.endswith("'"):
        return None  # its coordinate stands in the equations: this is no course
    if not mine:
        return Course(known, mine, None, begins, values=values)
    follows = combination(case.system, mine, (), within=True)
    if follows.holds is False and follows.held:  # friction has its direction as long as the body slides on
        return Course(known, mine, True, begins, follows.held, values)
    return Course(known, mine, follows.holds, begins, values=values)


def of_the_start(case: Case, course: Course) -> str:
    """What differs at the start, in words: x is 0 there, and not x0."""
    told, at = [], {case.system.symbols.t: 0}
    for x, value in course.known.items():
        if x in case.start and not x.name.endswith("''"):
            mine, own = substituted((value, case.start[x]), at)
            if not case.starts_at_zero(x - mine):
                texts = (short_text(y, case.system.scope.positive) or "another one" for y in (mine, own))
                told.append("{} is {}, and not {}".format(x.name, *texts))
    return " and ".join(told)


def mended(case: Case, written: HandEquation, constants: Mapping[str, Scalar]) -> Cause | None:
    """The one place of a course that is wrong: with another value there the equations of motion hold, and the start."""
    name, x = written.left.code[0][1], case.value(written.right, constants)
    places = [node for node in order((x,)) if node is not x and depends_on(node, tuple(_constants(case)))]
    for node in [x, *places][:MOST_PLACES] if type(x) is Node else ():
        for to, kind, told in _others(case, node):
            try:
                course = _put_in(case, name, substituted((x,), {node: to})[0], any_start=bool(constants))
            except DerivationError:
                continue
            if course is not None and course.holds and course.begins:
                there, meant = term_text(node), term_text(to)
                text = f"in the course {there} stands where {meant} is meant{told}"
                return Cause(kind, text, there, quantity="the course")
    return None


def _constants(case: Case) -> tuple[Node, ...]:
    return (*case.system.symbols.parameters.values(), case.system.symbols.t)


def _others(case: Case, node: Node) -> Iterator[tuple[Scalar, str, str]]:
    """What may be meant in the place of a node: (that, kind of the cause, more words)."""
    graph = node.graph
    yield graph.sqrt(node), "factor", ": the root is missing"
    yield node * node, "factor", ": a root is too many"
    yield -node, "sign", ": the sign is wrong"
    for k in (Fraction(2), Fraction(1, 2)):
        yield k * node, "factor", ""
    if node.op in ("sin", "cos"):
        yield graph.call("cos" if node.op == "sin" else "sin", node.args[0]), "wrong_axis", ""
    yield over(1, node), "factor", ": it is turned over"
    yield 1 - node, "missing_term", ""
    for p in case.system.symbols.parameters.values():
        yield node * p, "factor", f": a factor {p.name} is missing"
        yield over(node, p), "factor", f": a division by {p.name} is missing"
