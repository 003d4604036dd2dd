"""System -> FirstOrder: its equations of motion with their first derivatives, and what may stay independent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.balance.friction import equations_of_motion
from eomgen.mechanics.bodies.system_scene import start_values
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.wellposed import refuse_massless
from eomgen.mechanics.first_integrals.closed_instant import position_equations
from eomgen.mechanics.small_motions.field import Entries, Numbers, at
from eomgen.mechanics.small_motions.reference import ReferenceMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, jacobian, substituted, symbols_of
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRows
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.evaluation import fifty_digits
from eomgen.symbolic.numeric.tolerances import RANK, ROUNDING, SOLVED

OWN = 0.2  # of what a column adds to those chosen, against the best


@dataclass(frozen=True)
class Choice:
    """What stays independent, and which rows are solved for the rest.

    Args:
        q, dq: coordinates that stay, and those that follow by the rows `relations`.
        u, du: speeds that stay, and those that follow by the closing rows `ties`.
        standing: whether small turns of bodies that spin are about axes that stand still; else about their own.
    """

    q: tuple[int, ...]
    dq: tuple[int, ...]
    relations: tuple[int, ...]
    u: tuple[int, ...]
    du: tuple[int, ...]
    ties: tuple[int, ...]
    standing: bool = False


@dataclass(frozen=True)
class FirstOrder:
    """The equations of motion of a system, and their first derivatives, as graph scalars.

    Args:
        system: the system.
        relations: what is known between positions: they vanish.
        at_rest: whether it is looked at where all speeds are 0 alone: what holds none of them is far shorter.
    """

    system: System
    relations: tuple[Scalar, ...]
    at_rest: bool = False

    @cached_property
    def equations(self) -> EquationsOfMotion:
        equations = equations_of_motion(self.system)
        refuse_massless(equations)
        return equations

    def looked_at(self, *, at_rest: bool) -> FirstOrder:
        """The same, looked at there; its equations are not derived anew."""
        if at_rest == self.at_rest:
            return self
        found = replace(self, at_rest=at_rest)
        found.__dict__["equations"] = self.equations
        return found

    @cached_property
    def residual(self) -> tuple[Scalar, ...]:
        """M a - forcing - J^T lam."""
        return self.equations.residual[0]

    @cached_property
    def seen(self) -> frozenset[str]:
        """The names of what stands in the equations of motion."""
        e = self.equations
        rows = (*e.M, e.forcing, *e.J, e.sigma, e.gamma)
        return frozenset(x.name for x in symbols_of(x for row in rows for x in row))

    @cached_property
    def held(self) -> frozenset[Node]:
        """What stands in the equations of motion, in the rates and in the relations."""
        scope, rows = self.system.scope, (*self.equations.M, *self.equations.J, *self.rows)
        entries = (x for row in (*rows, *scope.N) for x in row)
        return frozenset(symbols_of((*entries, *self.residual, *scope.rates, *self.relations)))

    @cached_property
    def rows(self) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """(J u + sigma, J a + gamma)."""
        graph, symbols = self.equations, self.system.symbols
        velocities = tuple(inner(row, symbols.u) + bias for row, bias in zip(graph.J, graph.sigma, strict=True))
        return velocities, self.equations.residual[1]

    @cached_property
    def derivatives(self) -> Mapping[str, ScalarRows]:
        """R_q, R_u, S_q, V_q, A_q, A_u, G, W by name."""
        symbols = self.system.symbols
        q, u, w = symbols.q, symbols.u, tuple(symbols.inputs.values())
        velocities, accelerations = self.rows
        unmoved, still = self._unmoved, dict.fromkeys(u, 0) if self.at_rest else {}

        def by_places(rows: Sequence[Scalar]) -> ScalarRows:
            return jacobian(substituted(rows, unmoved | still), q)

        return {
            "R_q": by_places(self.residual),
            "R_u": jacobian(substituted(self.residual, unmoved), u),
            "S_q": by_places(self.system.scope.rates),
            "V_q": by_places(velocities),
            "A_q": by_places(accelerations),
            "A_u": jacobian(substituted(accelerations, unmoved), u),
            "G": (*jacobian(self.relations, q), *_held(self.system)),
            "W": [[-x for x in row] for row in jacobian(self.residual, w)],
        }

    @cached_property
    def _unmoved(self) -> dict[Node, Scalar]:
        """Accelerations that are 0 in every state that is looked at: all of them at rest, where no tie asks for one."""
        e, s = self.equations, self.system.symbols
        asked = substituted(e.gamma, dict.fromkeys(s.u, 0))
        return dict.fromkeys(s.a, 0) if self.at_rest and all(map(is_zero, asked)) else {}


def first_order_of(system: System) -> FirstOrder:
    """The equations of a system to first order."""
    scope = system.scope
    relations = [x for x in position_equations(system, start_values(scope)) if depends_on(x, scope.symbols.q)]
    relations += [sum((e * e for e in four), start=-1) for four in scope.quaternions]
    return FirstOrder(system, tuple(relations))


def _held(system: System) -> list[list[Scalar]]:
    """A row for each driven coordinate: it moves as given, and not otherwise."""
    q, coordinates = system.symbols.q, system.scope.model.coordinates
    return [[int(x is y) for y in q] for x in q if coordinates[x.name].driven]


# -- what stays independent --------------------------------------------------------------------------------


def choice_of(first: FirstOrder, reference: ReferenceMotion, wanted: Sequence[str]) -> Choice:
    """Coordinates and speeds that stay: those wanted, then the model's own, then the others.

    Args:
        wanted: names of coordinates that are to stay where they can.
    """
    field = Numbers(reference.numbers)
    symbols, coordinates = first.system.symbols, reference.system.scope.model.coordinates
    dependent = {name for name, part in coordinates.items() if part.dependent}

    turning = {e.name: abs(float(reference.numbers[e])) for four in first.system.scope.quaternions for e in four}

    def late(name: str, stays: bool) -> tuple[int, float]:
        """Of what is solved first: of the model's dependent ones; of others those with coefficients that stay, then
        those of coordinates on which nothing depends, as the place of a wheel, of which the speeds turn with it.

        Of a quaternion the largest of its four.
        """
        usual = float(stays) + 0.5 * (name in coordinates and name not in first.seen)
        return 0 if name in wanted else 2 if name in dependent else 1, turning.get(name, usual)

    G, J = (_floats(at(field, rows), len(columns)) for rows, columns in _rows(first))
    elsewhere = Numbers(_elsewhere(reference))
    G_there, J_there = (_floats(at(elsewhere, rows), len(columns)) for rows, columns in _rows(first))
    relations, dq = determined(G, [late(q.name, stays) for q, stays in zip(symbols.q, _same(G, G_there), strict=True)])
    ties, du = determined(
        J, [late(u.name.removesuffix("'"), stays) for u, stays in zip(symbols.u, _same(J, J_there), strict=True)]
    )
    q = tuple(k for k in range(len(symbols.q)) if k not in dq)
    u = tuple(k for k in range(len(symbols.u)) if k not in du)
    return Choice(q, dq, relations, u, du, ties)


def _rows(first: FirstOrder) -> tuple[tuple[ScalarRows, Sequence[Node]], ...]:
    """The rows between positions, and those between speeds, with what their columns stand for."""
    symbols = first.system.symbols
    return (first.derivatives["G"], symbols.q), (first.equations.J, symbols.u)


def _elsewhere(reference: ReferenceMotion) -> dict[Node, Any]:
    """The state with other coordinates."""
    rng, number = Random(4), fifty_digits().number(1)
    return {
        **reference.numbers,
        **{q: reference.numbers[q] + number * rng.uniform(0.01, 0.1) for q in reference.system.symbols.q},
    }


def _same(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Of each column whether it is the same in both."""
    return np.asarray(np.all(abs(A - B) <= SOLVED * abs(A).max(initial=0), axis=0))


def _floats(A: Entries, columns: int) -> np.ndarray:
    return np.array(A, dtype=float).reshape(len(A), columns)


def determined(A: np.ndarray, late: Sequence[tuple[int, float]]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """(independent rows, columns that they determine): of those first that are late, the last of them first.

    A column that the others nearly make up, against the best of those as late, waits for these.
    """
    if not len(A):
        return (), ()
    scaled = dense.balanced(dense.without_noise(A, ROUNDING, axis=1))[0]
    rows = dense.independent_rows(scaled, RANK)
    left = scaled[rows].copy()
    chosen: list[int] = []
    for rank in sorted({*late}, reverse=True):
        waiting = [k for k in reversed(range(A.shape[1])) if late[k] == rank]
        while waiting and len(chosen) < len(rows):
            sizes = np.linalg.norm(left[:, waiting], axis=0)
            if max(sizes) <= RANK:
                break
            k = next(k for k, size in zip(waiting, sizes, strict=True) if size >= OWN * max(sizes))
            waiting.remove(k)
            chosen.append(k)
            direction = left[:, k] / np.linalg.norm(left[:, k])
            left -= np.outer(direction, direction @ left)
    return tuple(rows), tuple(sorted(chosen))
