"""A state with its change -> values of formulas there, and how they change: accelerations and multipliers with them.

R = M a - forcing - J^T lam = 0,   A = J a + gamma = 0:   [M, -J^T; J, 0] [da; dlam] = -[dR; dA] at fixed a, lam
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.initial_state.start_slopes import Seeds
from eomgen.mechanics.small_motions.first_order import FirstOrder
from eomgen.mechanics.small_motions.steadiness import CORNERS
from eomgen.questions.in_phase import PhaseEquations
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, tangent
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of
from eomgen.symbolic.numeric.tolerances import BESIDE, CARRIED, COORDINATE_AT_50, RANK

ROUNDS = 3  # of corrections with 50 digits: each gains those of a double


@dataclass(frozen=True)
class ChangingState:
    """A state of the equations of motion, and how it changes.

    Args:
        phase: the equations.
        numbers: t, parameters, inputs, q and u, with 50 digits.
        seeds: how they change.
    """

    phase: PhaseEquations
    numbers: Mapping[Node, Any]
    seeds: Seeds

    def of(self, scalars: Sequence[Scalar]) -> list[tuple[float, float]]:
        """(value, slope) of scalars in q, u, a, lam, t, the inputs and the parameters.

        Raises:
            DerivationError: one of them, or a force, has a corner or a jump there.
        """
        symbols = self.phase.system.symbols
        numbers, seeds, held = self.numbers, self.seeds, tuple[Scalar, ...]()
        if any(depends_on(x, (*symbols.a, *symbols.lam)) for x in scalars):
            (numbers, seeds), held = self._moving, self._rows
        _refuse_corners((*scalars, *held), numbers, seeds)
        values = evaluate((*scalars, *tangent(tuple(scalars), seeds)), numbers, fifty_digits())
        found = [0.0 if abs(x) < COORDINATE_AT_50 else x for x in floats_of(values)]
        return list(zip(found[: len(scalars)], found[len(scalars) :], strict=True))

    def formula(self, formula: Expression) -> tuple[float, float]:
        """(value, slope) of a formula of the model."""
        equations = self.phase.equations if self.phase.needs_equations(formula) else None
        closed = equations is not None and equations.friction
        return self.of([self.phase.of_state(formula) if closed else self.phase.raw(formula)])[0]

    @cached_property
    def _first(self) -> FirstOrder:
        return FirstOrder(self.phase.system, ())

    @property
    def _rows(self) -> tuple[Scalar, ...]:
        """What the accelerations and multipliers make 0."""
        return *self._first.residual, *self._first.rows[1]

    @cached_property
    def _moving(self) -> tuple[Mapping[Node, Any], Seeds]:
        """The same with accelerations and multipliers."""
        e, symbols = self._first.equations, self.phase.system.symbols
        n, k, graph = len(e.M), len(e.J), self.phase.system.scope.graph
        entries = [*(x for row in e.M for x in row), *(x for row in e.J for x in row)]
        flat = np.array(floats_of(evaluate(entries, self.numbers, fifty_digits())))
        M, J = flat[: n * n].reshape(n, n), flat[n * n :].reshape(k, n)
        inverse = np.linalg.pinv(np.block([[M, -J.T], [J, np.zeros((k, k))]]), rcond=RANK)
        unknowns, rows = (*symbols.a, *symbols.lam), self._rows
        numbers = dict(self.numbers) | dict.fromkeys(unknowns, fifty_digits().number(0))
        for _ in range(ROUNDS):
            numbers |= _corrected(numbers, unknowns, inverse, evaluate(rows, numbers, fifty_digits()))
        changes = {x: graph.symbol(f"d({x.name})") for x in unknowns}
        left = tangent(rows, {**self.seeds, **changes})
        known = numbers | dict.fromkeys(changes.values(), fifty_digits().number(0))
        for _ in range(ROUNDS):
            known |= _corrected(known, tuple(changes.values()), inverse, evaluate(left, known, fifty_digits()))
        return known, {**self.seeds, **changes}


def _corrected(
    known: Mapping[Node, Any], unknowns: Sequence[Node], inverse: np.ndarray, left: Sequence[Any]
) -> dict[Node, Any]:
    """The unknowns after one correction, which gains the digits of a double."""
    step = inverse @ np.array([float(x) for x in left])
    return {x: known[x] - d for x, d in zip(unknowns, step.tolist(), strict=True)}


def _refuse_corners(scalars: Sequence[Scalar], numbers: Mapping[Node, Any], seeds: Seeds) -> None:
    """Close to the state, on both sides, scalars must be what their slopes make of them.

    Raises:
        DerivationError: one is not.
    """
    if not any(node.op in CORNERS for node in order(scalars)):
        return
    digits = fifty_digits()
    rates = dict(zip(seeds, evaluate(tuple(seeds.values()), numbers, digits), strict=True))
    found = evaluate((*scalars, *tangent(tuple(scalars), seeds)), numbers, digits)
    for side in (-1, 1):
        step = side * digits.number(1) * BESIDE
        beside = evaluate(scalars, {**numbers, **{x: numbers[x] + step * rate for x, rate in rates.items()}}, digits)
        for here, there, slope in zip(found, beside, found[len(scalars) :], strict=False):
            if abs((there - here) / step - slope) > CARRIED * (1 + abs(slope)):
                raise DerivationError("it, or a force, has a corner or a jump there", mend="ask beside it")
