"""A coordinate, or its rate, as a function of time -> whether the equations of motion hold with it, and the start."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.judge.case import Case
from eomgen.judge.decision import is_zero_everywhere
from eomgen.judge.reading import HandEquation
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, derivative, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import ScalarRow


@dataclass(frozen=True)
class Course:
    """A coordinate q = f(t) put into the equations of motion.

    Args:
        known: q and its rates as functions of time.
        left: what is left of the equations of motion that know nothing else.
        holds: whether that is nothing; None: undecided, or they do not decide it alone.
        begins: whether it starts as the model does.
    """

    known: Mapping[Node, Scalar]
    left: ScalarRow
    holds: bool | None
    begins: bool


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
    symbols, scope = case.system.symbols, case.system.scope
    x, known = case.value(written.right, constants), dict[Node, Scalar]()
    for rate in (name, f"{name}'", f"{name}''")[: 3 - name.count("'")]:
        node = scope.names[rate]
        if type(node) is Node and node.op == "symbol":
            known[node] = x
        x = derivative(x, symbols.t)
    given = tuple(scope.names[x.name] - value for x, value in known.items() if not x.name.endswith("''"))
    start = substituted(given, {**case.start, symbols.t: 0})
    begins = bool(constants or not case.start or is_zero_everywhere(case.system, *start).holds)
    others = [x for x in (*symbols.q, *symbols.u) if x not in known]
    if not case.rows:
        return None
    left = [row for row in substituted(case.rows, known) if not depends_on(row, (*others, *case.forced))]
    a = scope.names[name.removesuffix("'") + "''"]
    if not left and type(a) is Node and a in known:  # the others move with it: what is left of all equations together
        (found,) = substituted((known[a] - case.phase.eliminated(a),), known)
        left = [] if depends_on(found, others) else [found]
    inputs = {node: case.system.inputs[n] for n, node in symbols.inputs.items()}
    mine = substituted(tuple(left), inputs)
    if not mine and name.endswith("'"):
        return None  # its coordinate stands in the equations: this is no course
    return Course(known, mine, is_zero_everywhere(case.system, *mine).holds if mine else None, begins)
