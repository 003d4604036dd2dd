"""Model -> Model: a node that moves no mass follows from the balance of what pushes it.

    0 = Q_k(q, q', t)        of a free coordinate k with M_kj = 0 for all j, in place of M_k a + c_k = Q_k

Between springs it is a tie of places, beside a damper one of rates: the node's rate is that of a first-order state. The
multiplier of such a tie is 0, as nothing else is left along the coordinate; all others keep their equations.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from eomgen.errors import DerivationError, ModelError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import free_system_of
from eomgen.mechanics.formulations.recursive import assembled_by_recursion
from eomgen.model.constraints.equation import NodeBalance
from eomgen.model.parts import Body, Coordinate, Model
from eomgen.model.table import Table
from eomgen.records import recalled
from eomgen.symbolic.expression.derivative import depends_on, derivative
from eomgen.symbolic.expression.expressions import parse
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.print.text import text_size, to_text

PREFIX = "balance_of_"  # of a tie, before its coordinate
LONGEST = 2_000  # characters of a balance that stands as an equation


def with_nodes_balanced(model: Model) -> Model:
    """The model with the balance of every massless node as a tie, from which its coordinate follows; the same where
    there is none, or where what pushes one is no spring or damper."""
    return recalled(model, with_nodes_balanced, lambda: _balanced(model))


def told_of_nodes(model: Model) -> tuple[str, ...]:
    """What such a model assumes, in words."""
    ties = [name for name, tie in model.constraints.items() if isinstance(tie, NodeBalance)]
    follows = "moves no mass: it follows from the balance of what pushes it"
    return tuple(f"{name.removeprefix(PREFIX)} {follows} ({name})" for name in ties)


def _balanced(model: Model) -> Model:
    free = [name for name, q in model.coordinates.items() if not (q.driven or q.dependent)]
    if not free or model.speeds or model.unknowns or not any(map(_is_lean, model.bodies.values())):
        return model
    try:
        equations = assembled_by_recursion(free_system_of(model))
        found = dict(_balances(equations, free))
        if not found:
            return model
        ties = {PREFIX + name: tie for name, tie in found.items()}
        moved = {name: _following(model.coordinates[name], tie) for name, tie in found.items()}
        return replace(
            model,
            coordinates=Table({**model.coordinates, **moved}),
            constraints=Table({**model.constraints, **ties}),
        )
    except (ModelError, DerivationError):  # whoever needs accelerations says what is missing
        return model


def _is_lean(body: Body) -> bool:
    """Whether a body may have no mass."""
    masses = [body.mass, getattr(body.shape, "mass", None)]
    given = [x for x in masses if x is not None]
    return not body.parts and (not given or any(x.literal == 0 for x in given))


def _following(coordinate: Coordinate, tie: NodeBalance) -> Coordinate:
    """The coordinate that follows: of a tie of places its start is a guess."""
    if tie.gap is None:
        return replace(coordinate, dependent=True)
    near = coordinate.start if coordinate.near is None else coordinate.near
    return replace(coordinate, dependent=True, start=None, speed=None, near=near)


def _balances(equations: EquationsOfMotion, free: list[str]) -> Iterator[tuple[str, NodeBalance]]:
    """(coordinate, 0 = Q_k) of those that move no mass, that no tie holds, and that springs or dampers push."""
    symbols = equations.symbols
    q_of: Mapping[str, Node] = {f"{q.name}'": q for q in symbols.q}
    massless = [k for k, row in enumerate(equations.M) if all(is_zero(x) for x in row)]
    for k in massless:
        u, force = symbols.u[k], equations.forcing[k]
        q, held = q_of.get(u.name), any(not is_zero(row[k]) for row in equations.J)
        if q is None or q.name not in free or held or text_size(force) > LONGEST:
            continue
        rates = depends_on(force, symbols.u)
        if rates and _is_linear(force, symbols.u) and not is_zero(derivative(force, u)):
            yield q.name, NodeBalance(rate=parse(to_text(force), longest=LONGEST + 1))
        elif not rates and depends_on(force, (q,)):
            yield q.name, NodeBalance(gap=parse(to_text(force), longest=LONGEST + 1))


def _is_linear(force: Scalar, u: tuple[Node, ...]) -> bool:
    return not any(depends_on(derivative(force, x), u) for x in u)
