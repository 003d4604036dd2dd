"""System, values of many runs -> which of these have the equations that were derived at the values of one.

What is derived holds for all values of the parameters, but for what numbers have decided on the way:

    signs        of the parameters, and of what loads and ties asked of the start (`SystemScene.worth`)
    dependence   which rows of the ties follow from others: as before where no parameter in them has another value, and
                 where all rows are independent, rank J = k at a state in which they hold: it is so nearly everywhere
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.mechanics.bodies.system_scene import start_values, with_unit_quaternions
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.constraints.freedom import rank_of_ties
from eomgen.mechanics.constraints.ties import rows_of_tie
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.tolerances import COMPUTED, NEARLY_SINGULAR, ROUNDING


@dataclass(frozen=True)
class DerivedAt:
    """A system that was derived at values of its parameters.

    Args:
        system: it.
        p: the values.
        changes: whether it is but one of the phases of a model.
    """

    system: System
    p: np.ndarray
    changes: bool

    def holds(self, p: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Of n runs whether equations are the same, as far as the ties need not be closed to see it.

        Args:
            p: n x parameters.
            q: where the coordinates are declared to start, n x coordinates.
        """
        found = np.all(np.sign(p) == np.sign(self.p), axis=1)
        if self._decided:
            own = self._signs(self.p[None, :], self.declared.many(0.0, self._still(1), self.p))
            found &= np.all(self._signs(p, q) == own, axis=1)
        return np.asarray(found & (~self.asks(p) | self._is_independent))

    def asks(self, p: np.ndarray) -> np.ndarray:
        """Of n runs whether a parameter that stands in the ties has another value."""
        return np.asarray(np.any((p != self.p)[:, self._in_ties], axis=1))

    def is_regular(self, p: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Of n runs whether the rows are as independent as elsewhere at states (q, u) in which they hold.

        Rows that the coordinates were found to satisfy by themselves must hold there too.
        """
        free, n = self._free, len(x)
        J = self._rows.many(0.0, self._of_free(x), p)
        known = np.all(np.isfinite(J), axis=1)
        gaps, J = np.split(np.where(known[:, None], J, 0.0), [len(self._given)], axis=1)
        J = J.reshape(n, len(free.ties.closing), len(free.symbols.u))
        found = known & np.all(np.abs(gaps) <= COMPUTED, axis=1)
        found &= _singular_value(J, self._rank) > NEARLY_SINGULAR
        rows, speeds = self._determining
        found &= _singular_value(J[:, rows][:, :, speeds], len(rows)) > NEARLY_SINGULAR
        return np.asarray(found)

    @property
    def _free(self) -> System:
        return self.system.free or self.system

    @cached_property
    def _decided(self) -> tuple[Node, ...]:
        found = {**self._free.motion.decided, **self.system.motion.decided}
        symbols = self.system.symbols
        places = {*symbols.q, *symbols.parameters.values(), symbols.t}
        return tuple(x for x in found if set(symbols_of((x,))) <= places)

    @cached_property
    def _in_ties(self) -> list[int]:
        """The places of the parameters that stand in the ties, closed or open."""
        motion = self._free.motion
        rows = [row for name in motion.scope.model.constraints for row in rows_of_tie(motion, name)]
        entries = (*self._free.ties.rows, *rows)
        used = set(symbols_of([x for row in entries for x in (row.velocity, 0 if row.gap is None else row.gap)]))
        return [k for k, x in enumerate(self.system.symbols.parameters.values()) if x in used]

    @cached_property
    def _is_independent(self) -> bool:
        return not self.changes and self._rank == len(self._free.ties.closing)

    @cached_property
    def _rank(self) -> int:
        return rank_of_ties(self._free.ties)

    @cached_property
    def _determining(self) -> tuple[list[int], list[int]]:
        """(the rows by which dependent coordinates are eliminated, their speeds)."""
        used = {} if self.system.elimination is None else self.system.elimination.used
        names = dependent_coordinates(self._free.scope)
        rows = [i for i, row in enumerate(self._free.ties.closing) if used.get((row.tie, row.number))]
        return rows, [k for k, u in enumerate(self._free.symbols.u) if u.name[:-1] in names]

    @cached_property
    def _given(self) -> tuple[Scalar, ...]:
        """The gaps of rows that the coordinates were found to satisfy by themselves."""
        return tuple(row.gap for row in self._free.ties.rows if row.identical and type(row.gap) is Node)

    @cached_property
    def _rows(self) -> RightHandSide:
        return self._of(self._free, (*self._given, *(x for row in self._free.ties.J for x in row)))

    @cached_property
    def declared(self) -> RightHandSide:
        """Where the coordinates are declared to start, by the parameters."""
        scope = self.system.scope
        return self._of(self.system, tuple(with_unit_quaternions(scope, start_values(scope)).values()))

    @cached_property
    def _asked(self) -> RightHandSide:
        return self._of(self.system, self._decided)

    def _signs(self, p: np.ndarray, q: np.ndarray) -> np.ndarray:
        x = self._still(len(q))
        x[:, : q.shape[1]] = q
        return np.asarray(np.sign(self._asked.many(0.0, x, p)))

    def _still(self, n: int) -> np.ndarray:
        return np.zeros((n, len(self.system.symbols.q) + len(self.system.symbols.u)))

    def _of_free(self, x: np.ndarray) -> np.ndarray:
        """States of the free system at the places of these; rows do not depend on its speeds."""
        symbols = self._free.symbols
        found = np.zeros((len(x), len(symbols.q) + len(symbols.u)))
        found[:, : len(symbols.q)] = x[:, : len(symbols.q)]
        return found

    def _of(self, system: System, scalars: tuple[Scalar, ...]) -> RightHandSide:
        return compiled(program_of(scalars, system.symbols, inputs=system.inputs), "numpy")


def _singular_value(J: np.ndarray, rank: int) -> np.ndarray:
    """That number of the singular values of each matrix, its rows of length 1; 1 where nothing is asked."""
    if not rank:
        return np.ones(len(J))
    if rank > min(J.shape[1:]):
        return np.zeros(len(J))
    lengths = np.linalg.norm(J, axis=2, keepdims=True)
    longest = np.max(lengths, axis=1, keepdims=True)
    unit = J / np.where(lengths > ROUNDING * longest, lengths, np.inf)
    return np.asarray(np.linalg.svd(unit, compute_uv=False)[:, rank - 1])
