"""A place of rest of one freedom at which V'' = 0 -> whether it is stable, by the next derivatives of V.

The force along the way that the ties leave is P = Q . w with J w = 0; V' = -P, and d/ds is w . d/dq.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.symbolic.exact.normal_form import readable
from eomgen.symbolic.expression.derivative import gradient
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve import cramer

HIGHEST = 8  # derivative of V that is looked at
MOST_COORDINATES = 6  # of ties along which derivatives are taken

STABLE, UNSTABLE, INDIFFERENT = "stable", "unstable", "indifferent"


def by_higher_derivatives(statics: StaticEquations, state: Mapping[Node, Any]) -> tuple[str, str]:
    """(whether it is stable, why).

    Args:
        state: values of everything at the place, with 50 digits.
    """
    return _Way(statics, state).verdict()


@dataclass(frozen=True)
class _Way:
    statics: StaticEquations
    state: Mapping[Node, Any]

    def verdict(self) -> tuple[str, str]:
        """The first derivative of V along the way that does not vanish."""
        w = self._way()
        if w is None:
            return "undecided", "the second variation of V vanishes"
        P = readable(sum((a * b for a, b in zip(self.statics.Q, w, strict=True)), start=0), Work.VALUE)
        sizes: list[float] = []
        for order in range(1, HIGHEST + 1):
            value, size = self._value_and_size(P)
            sizes.append(size)
            if abs(value) > COMPUTED * max(sizes) and order > 1:
                kind = STABLE if order % 2 == 0 and value < 0 else UNSTABLE
                return kind, f"the first derivative of V that does not vanish is number {order}"
            P = sum((a * b for a, b in zip(gradient(P, self.statics.q), w, strict=True)), start=0)
        return INDIFFERENT, f"the first {HIGHEST} derivatives of V vanish"

    def _way(self) -> tuple[Scalar, ...] | None:
        """A vector along the ties: its entries are the minors of J, with signs; 1 without ties."""
        J, n = self.statics.J, len(self.statics.q)
        if n == 1:
            return (1,)
        if len(J) != n - 1 or n > MOST_COORDINATES:
            return None
        return tuple(
            (-1) ** k * cramer.determinant([[row[j] for j in range(n) if j != k] for row in J]) for k in range(n)
        )

    def _value_and_size(self, P: Scalar) -> tuple[float, float]:
        """P there, and how large it is nearby."""
        found = []
        for shift in (0.0, -0.3, 0.2, 0.4):
            state = dict(self.state) | {q: self.state[q] + shift for q in self.statics.q}
            try:
                found.append(abs(float(evaluate((P,), state, fifty_digits())[0])))
            except NoValue:
                found.append(0.0)
        return float(evaluate((P,), self.state, fifty_digits())[0]), max(found)
