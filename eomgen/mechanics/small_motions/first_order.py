"""System -> FirstOrder: its equations of motion with their first derivatives, and what may stay independent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.closed_instant import position_equations
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.loads import start_value
from eomgen.mechanics.small_motions.field import Matrix, Numbers, at
from eomgen.mechanics.small_motions.reference import Reference
from eomgen.mechanics.system import System
from eomgen.mechanics.wellposed import refuse_massless
from eomgen.symbolic import dense
from eomgen.symbolic.derivative import depends_on, jacobian
from eomgen.symbolic.functions import inner
from eomgen.symbolic.graph import Scalar

RANK = 1e-9  # of balanced rows, below which one follows from others

Rows = Sequence[Sequence[Scalar]]


@dataclass(frozen=True)
class Choice:
    """What stays independent, and which rows are solved for the rest.

    Args:
        q, dq: coordinates that stay, and those that follow by the rows `relations`.
        u, du: speeds that stay, and those that follow by the closing rows `ties`.
    """

    q: tuple[int, ...]
    dq: tuple[int, ...]
    relations: tuple[int, ...]
    u: tuple[int, ...]
    du: tuple[int, ...]
    ties: tuple[int, ...]


@dataclass(frozen=True)
class FirstOrder:
    """The equations of motion of a system, and their first derivatives, as graph scalars.

    Args:
        system: the system.
        relations: what is known between positions: they vanish.
    """

    system: System
    relations: tuple[Scalar, ...]

    @cached_property
    def assembly(self) -> Assembly:
        assembly = with_friction(self.system, recursive.assemble(self.system))
        refuse_massless(assembly)
        return assembly

    @cached_property
    def residual(self) -> tuple[Scalar, ...]:
        """M a - forcing - J^T lam."""
        graph, symbols = self.assembly, self.system.symbols
        pushes = list(zip(*graph.J, strict=True)) if graph.J else [()] * len(graph.M)
        return tuple(
            inner(row, symbols.a) - force - inner(push, symbols.lam)
            for row, force, push in zip(graph.M, graph.forcing, pushes, strict=True)
        )

    @cached_property
    def rows(self) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """(J u + sigma, J a + gamma)."""
        graph, symbols = self.assembly, self.system.symbols
        velocities = tuple(inner(row, symbols.u) + bias for row, bias in zip(graph.J, graph.sigma, strict=True))
        return velocities, tuple(inner(row, symbols.a) + bias for row, bias in zip(graph.J, graph.gamma, strict=True))

    @cached_property
    def derivatives(self) -> Mapping[str, Rows]:
        """R_q, R_u, S_q, V_q, A_q, A_u, G, W by name."""
        symbols = self.system.symbols
        q, u, w = symbols.q, symbols.u, tuple(symbols.inputs.values())
        velocities, accelerations = self.rows
        return {
            "R_q": jacobian(self.residual, q), "R_u": jacobian(self.residual, u),
            "S_q": jacobian(self.system.scope.rates, q), "V_q": jacobian(velocities, q),
            "A_q": jacobian(accelerations, q), "A_u": jacobian(accelerations, u),
            "G": (*jacobian(self.relations, q), *_held(self.system)),
            "W": [[-x for x in row] for row in jacobian(self.residual, w)],
        }  # fmt: skip


def first_order_of(system: System) -> FirstOrder:
    """The equations of a system to first order."""
    scope = system.scope
    start = {q: start_value(scope, scope.model.coordinates[q.name]) for q in scope.symbols.q}
    relations = [x for x in position_equations(system, start) if depends_on(x, scope.symbols.q)]
    return FirstOrder(system, tuple(relations))


def _held(system: System) -> list[list[Scalar]]:
    """A row for each driven coordinate: it moves as given, and not otherwise."""
    q, coordinates = system.symbols.q, system.scope.model.coordinates
    return [[int(x is y) for y in q] for x in q if coordinates[x.name].driven]


# -- what stays independent --------------------------------------------------------------------------------


def choice_of(first: FirstOrder, reference: Reference, wanted: Sequence[str]) -> Choice:
    """Coordinates and speeds that stay: those wanted, then the model's own, then the others.

    Args:
        wanted: names of coordinates that are to stay where they can.
    """
    field = Numbers(reference.numbers)
    symbols, coordinates = first.system.symbols, reference.system.scope.model.coordinates
    dependent = {name for name, part in coordinates.items() if part.dependent}

    def late(name: str, rows: Rows, k: int) -> tuple[int, bool]:
        """Of what is solved first: of the model's dependent ones; of others those with coefficients that stay."""
        stays = not any(depends_on(row[k], symbols.q) for row in rows)
        return 0 if name in wanted else 2 if name in dependent else 1, stays

    G, J = first.derivatives["G"], first.assembly.J
    relations, dq = _determined(_floats(at(field, G), len(symbols.q)),
                                [late(q.name, G, k) for k, q in enumerate(symbols.q)])  # fmt: skip
    ties, du = _determined(_floats(at(field, J), len(symbols.u)),
                           [late(u.name.removesuffix("'"), J, k) for k, u in enumerate(symbols.u)])  # fmt: skip
    q = tuple(k for k in range(len(symbols.q)) if k not in dq)
    u = tuple(k for k in range(len(symbols.u)) if k not in du)
    return Choice(q, dq, relations, u, du, ties)


def _floats(A: Matrix, columns: int) -> np.ndarray:
    return np.array(A, dtype=float).reshape(len(A), columns)


def _determined(A: np.ndarray, late: Sequence[tuple[int, bool]]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """(independent rows, columns that they determine): of those first that are late, the last of them first."""
    if not len(A):
        return (), ()
    scaled = dense.balanced(A)[0]
    rows = dense.independent_rows(scaled, RANK)
    chosen: list[int] = []
    for k in sorted(range(A.shape[1]), key=lambda k: (late[k], k), reverse=True):
        if len(chosen) < len(rows) and dense.rank(scaled[rows][:, [*chosen, k]].T, smallest=RANK) > len(chosen):
            chosen.append(k)
    return tuple(rows), tuple(sorted(chosen))
