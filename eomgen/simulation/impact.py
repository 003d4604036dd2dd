"""The model with every contact that can end removed: the gaps of its contacts, and the effect of an impact.

    M (u+ - u-) = J^T Lam,   J u+ + sigma = 0 where Lam > 0,   0 <= Lam,   0 <= J u+ + sigma   (contacts that can end)

The impact is wholly plastic and without friction: a contact that closes does not rebound.
Source: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988), with restitution 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field
from itertools import combinations
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide, compiled, program_of
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row, rows_of_constraint
from eomgen.mechanics.dynamics import System, assembled_by_recursion
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.symbolic.expression import Scalar, jacobian, substituted
from eomgen.symbolic.numeric import tolerances


@dataclass(frozen=True)
class WithoutContacts:
    """A model without the contacts that can end.

    Args:
        system: it; the coordinates are those of every phase.
        contacts: the names of the constraints taken away.
        p: the parameters' values.
        made: objects that were made of it, which do not depend on these.
    """

    system: System
    contacts: tuple[str, ...]
    p: np.ndarray
    made: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    def gaps(self, t: float, values: Values) -> dict[str, tuple[float, float]]:
        """(gap, its rate) of every contact that can end; positive where it is open, and opening."""
        found = iter(self._gaps.many(t, self._x(values)[None, :], self.p)[0].tolist())
        gaps = {}
        for name, rows in self._rows.items():
            gap = values.get(PhaseModel.slack_name(name), 0.0) if rows[0].gap is None else next(found)
            gaps[name] = (gap, next(found))
        return gaps

    def after_impact(self, t: float, values: Values, touching: Sequence[str]) -> dict[str, float]:
        """The values after an impact of all contacts that touch: rates changed, places as they were.

        Raises:
            DerivationError: no impulses satisfy the law, which rounding alone can cause.
        """
        x, nu = self._x(values), len(self.system.symbols.u)
        found = self._matrices.many(t, x[None, :], self.p)[0]
        M, rows = found[: nu * nu].reshape(nu, nu), found[nu * nu :].reshape(-1, nu + 1)
        k = len(self.system.constraints.closing)
        of_contact, first = {}, k
        for name, own in self._rows.items():
            of_contact[name], first = rows[first : first + len(own)], first + len(own)
        u = _plastic(M, rows[:k], [of_contact[name] for name in touching], x[len(x) - nu :])
        rates = self._rates.many(t, np.concatenate([x[: len(x) - nu], u])[None, :], self.p)[0]
        changed = {f"{q.name}'": float(v) for q, v in zip(self.system.symbols.q, rates, strict=True)}
        return {**values, **changed, **{node.name: float(v) for node, v in zip(self.system.symbols.u, u, strict=True)}}

    def _x(self, values: Values) -> np.ndarray:
        symbols = self.system.symbols
        return np.array([values.get(node.name, 0.0) for node in (*symbols.q, *symbols.u)])

    def _once(self, key: str, make: Callable[[], Any]) -> Any:
        if key not in self.made:
            self.made[key] = make()
        return self.made[key]

    @property
    def _rows(self) -> dict[str, tuple[Row, ...]]:
        """The rows of every contact that can end, the one that can end first."""
        found: dict[str, tuple[Row, ...]] = self._once(
            "rows", lambda: {name: rows_of_constraint(self.system.motion, name) for name in self.contacts}
        )
        return found

    @property
    def _gaps(self) -> RightHandSide:
        return self._function("gaps", self._open)

    @property
    def _rates(self) -> RightHandSide:
        return self._function("rates", lambda: self.system.scope.rates)

    @property
    def _matrices(self) -> RightHandSide:
        return self._function("matrices", self._entries)

    def _open(self) -> tuple[Scalar, ...]:
        requested: list[Scalar] = []
        for first, *_ in self._rows.values():
            requested += [first.velocity] if first.gap is None else [first.gap, first.velocity]
        return tuple(requested)

    def _entries(self) -> tuple[Scalar, ...]:
        """M, the rows (J, sigma) of the constraints that stay, and those of the contacts."""
        M = tuple(x for row in assembled_by_recursion(self.system).M for x in row)
        rows = (*self.system.constraints.closing, *(row for own in self._rows.values() for row in own))
        return (*M, *self._with_bias([row.velocity for row in rows]))

    def _with_bias(self, velocities: Sequence[Scalar]) -> list[Scalar]:
        """(J, sigma) of each row, J u + sigma its velocity."""
        u = self.system.symbols.u
        J = jacobian(tuple(velocities), u) if velocities else ()
        sigma = substituted(tuple(velocities), {node: 0 for node in u})
        return [x for row, bias in zip(J, sigma, strict=True) for x in (*row, bias)]

    def _function(self, key: str, scalars: Callable[[], tuple[Scalar, ...]]) -> RightHandSide:
        found: RightHandSide = self._once(
            key, lambda: compiled(program_of(scalars(), self.system.symbols, inputs=self.system.inputs), "numpy")
        )
        return found


def _plastic(M: np.ndarray, held: np.ndarray, contacts: Sequence[np.ndarray], u: np.ndarray) -> np.ndarray:
    """u+ for the first set of contacts, the largest before smaller ones, that satisfies the law of impact.

    Args:
        held: rows (J, sigma) of the constraints.
        contacts: those of each contact; the first of them can only push.
    """
    size = tolerances.COMPUTED * max(1.0, float(np.max(np.abs(u), initial=0.0)))
    for count in range(len(contacts), -1, -1):
        for active in combinations(range(len(contacts)), count):
            after, impulses = _bordered(M, np.vstack([held, *(contacts[i] for i in active)]), u)
            starts = np.cumsum([len(held), *(len(contacts[i]) for i in active)])[:-1]
            apart = [contacts[i][0] for i in range(len(contacts)) if i not in active]
            opening = [row[:-1] @ after + row[-1] for row in apart]
            if np.all(impulses[starts] >= -size * np.max(np.abs(M))) and all(v >= -size for v in opening):
                return after
    raise DerivationError(
        "no impulses of the contacts satisfy the law of impact",
        fix="other restitutions, or let the contacts close one after the other",
    )


def _bordered(M: np.ndarray, J: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(u+, impulses) with M (u+ - u) = J^T Lam and J u+ + sigma = 0; J holds sigma in its last column."""
    J, sigma = J[:, :-1], J[:, -1]
    columns = np.linalg.solve(M, J.T) if len(J) else np.zeros((len(u), 0))
    impulses = (
        np.linalg.lstsq(J @ columns, -(J @ u + sigma), rcond=tolerances.LEAST_CHANGE)[0] if len(J) else np.zeros(0)
    )
    return u + columns @ impulses, impulses
