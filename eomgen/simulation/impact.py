"""The model with every contact that can end taken away: how far its contacts are open, and what an impact does.

    M (u+ - u-) = J^T Lam,   J u+ + sigma = 0 where Lam > 0,   0 <= Lam,   0 <= J u+ + sigma   (contacts that can end)

The impact is wholly plastic and without friction: a contact that closes does not rebound.
Source: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988), with restitution 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import DerivationError
from eomgen.mechanics.contacts import Mode
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import rows_of
from eomgen.model.parts import Model
from eomgen.simulation.contacts import contacts_of
from eomgen.simulation.stage import RATE, Values, opened
from eomgen.symbolic.derivative import jacobian
from eomgen.symbolic.graph import Scalar


@dataclass(frozen=True)
class Loose:
    """A model without the contacts that can end.

    Args:
        system: it; the coordinates are those of every phase.
        contacts: the names of the ties taken away.
        p: the parameters' values.
    """

    system: System
    contacts: tuple[str, ...]
    p: np.ndarray

    def gaps(self, t: float, values: Values) -> dict[str, tuple[float, float]]:
        """(gap, its rate) of every contact that can end; positive where it is open, and opening."""
        found = self._gaps.many(t, self._x(values)[None, :], self.p)[0]
        return dict(zip(self.contacts, found.reshape(-1, 2).tolist(), strict=True))

    def after_impact(self, t: float, values: Values, touching: Sequence[str]) -> dict[str, float]:
        """The values after an impact of all contacts that touch: rates changed, places as they were.

        Raises:
            DerivationError: no impulses satisfy the law, which rounding alone can cause.
        """
        x = self._x(values)
        nu, k = len(self.system.symbols.u), len(self.system.ties.closing)
        found = self._matrices.many(t, x[None, :], self.p)[0]
        M = found[: nu * nu].reshape(nu, nu)
        held = found[nu * nu : nu * nu + k * (nu + 1)].reshape(k, nu + 1)
        rows = found[nu * nu + k * (nu + 1) :].reshape(-1, nu + 1)[[self.contacts.index(name) for name in touching]]
        u = _plastic(M, held, rows, x[len(x) - nu :])
        rates = self._rates.many(t, np.concatenate([x[: len(x) - nu], u])[None, :], self.p)[0]
        return {**values, **{f"{q.name}'": float(v) for q, v in zip(self.system.symbols.q, rates, strict=True)}}

    def _x(self, values: Values) -> np.ndarray:
        symbols = self.system.symbols
        return np.array([values.get(node.name, 0.0) for node in (*symbols.q, *symbols.u)])

    @cached_property
    def _rows(self) -> tuple[tuple[Scalar, Scalar], ...]:
        """(gap, velocity) of every contact that can end."""
        found = []
        for name in self.contacts:
            row = rows_of(self.system.motion, name)[0]
            if row.gap is None:
                raise DerivationError(f"'{name}' can end, and when it holds again cannot be told from where it is",
                                      f"constraints.{name}", "leave out `unilateral`")  # fmt: skip
            found.append((row.gap, row.velocity))
        return tuple(found)

    @cached_property
    def _gaps(self) -> RightHandSide:
        return self._compiled(tuple(x for pair in self._rows for x in pair))

    @cached_property
    def _rates(self) -> RightHandSide:
        return self._compiled(self.system.scope.rates)

    @cached_property
    def _matrices(self) -> RightHandSide:
        """M, the rows (J, sigma) of the ties that stay, and those of the contacts."""
        ties, u = self.system.ties, self.system.symbols.u
        velocities = tuple(velocity for _, velocity in self._rows)
        contacts = self._with_bias(jacobian(velocities, u) if velocities else (), velocities)
        M = tuple(x for row in recursive.assemble(self.system).M for x in row)
        return self._compiled((*M, *self._with_bias(ties.J, [row.velocity for row in ties.closing]), *contacts))

    def _with_bias(self, J: Sequence[Sequence[Scalar]], velocities: Sequence[Scalar]) -> list[Scalar]:
        from eomgen.symbolic.derivative import substituted

        sigma = substituted(tuple(velocities), {u: 0 for u in self.system.symbols.u})
        return [x for row, bias in zip(J, sigma, strict=True) for x in (*row, bias)]

    def _compiled(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        return compiled(program_of(scalars, self.system.symbols, inputs=self.system.inputs), "numpy")


def loose(model: Model, p: np.ndarray) -> Loose:
    """The model without the contacts that can end; what rubs slides without it."""
    contacts = contacts_of(model)
    ends = tuple(contact.name for contact in contacts if contact.unilateral)
    return Loose(opened(model, {name: Mode(closed=False) for name in ends}), ends, p)


def _plastic(M: np.ndarray, held: np.ndarray, rows: np.ndarray, u: np.ndarray) -> np.ndarray:
    """u+ for the first set of contacts, the largest before smaller ones, that satisfies the law of impact."""
    k, size = len(held), max(1.0, float(np.max(np.abs(u), initial=0.0)))
    for count in range(len(rows), -1, -1):
        for active in combinations(range(len(rows)), count):
            J = np.vstack([held, rows[list(active)]])
            after, impulses = _bordered(M, J, u)
            free = [i for i in range(len(rows)) if i not in active]
            opening = rows[free, :-1] @ after + rows[free, -1]
            if np.all(impulses[k:] >= -RATE * size * np.max(np.abs(M))) and np.all(opening >= -RATE * size):
                return after
    raise DerivationError("no impulses of the contacts satisfy the law of impact")


def _bordered(M: np.ndarray, J: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(u+, impulses) with M (u+ - u) = J^T Lam and J u+ + sigma = 0; J holds sigma in its last column."""
    J, sigma = J[:, :-1], J[:, -1]
    columns = np.linalg.solve(M, J.T) if len(J) else np.zeros((len(u), 0))
    impulses = np.linalg.lstsq(J @ columns, -(J @ u + sigma), rcond=1e-11)[0] if len(J) else np.zeros(0)
    return u + columns @ impulses, impulses
