"""A place of rest of one freedom at which V'' = 0 -> whether it is stable, by the next derivatives of V.

The force along the way that the ties leave is P = Q . w with J w = 0; V' = -P, and d/ds is w . d/dq.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import readable
from eomgen.symbolic.expression.derivative import gradient
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import AT_A_MULTIPLE_ROOT, BESIDE_A_PLACE, COMPUTED, ZERO_AT_50
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve import cramer

HIGHEST = 8  # derivative of V that is looked at
MULTIPLE = 4  # from this derivative on a place where the lower ones vanish is known to a part of its digits only
AWAY = (-0.3, 0.2, 0.4)  # [SI] where what vanishes at the place has its usual size
MOST_COORDINATES = 6  # of ties along which derivatives are taken

STABLE, UNSTABLE, INDIFFERENT = "stable", "unstable", "indifferent"


def by_higher_derivatives(statics: StaticEquations, state: Mapping[Node, Any]) -> tuple[str, str]:
    """(whether it is stable, why).

    Args:
        state: values of everything at the place, with 50 digits.
    """
    return _Way(statics, state).verdict()


def states_beside(state: Mapping[Node, Any], coordinates: Sequence[Node]) -> Iterator[dict[Node, Any]]:
    """States so near that what does not vanish at a place is hardly other there, and what vanishes is not 0.

    Args:
        state: values of everything, with 50 digits.
    """
    for share in (-BESIDE_A_PLACE, 0.7 * BESIDE_A_PLACE):
        yield {**state, **{q: state[q] + share * max(1, abs(state[q])) for q in coordinates}}


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
        for order in range(1, HIGHEST + 1):
            if order > 1 and (value := self._value(P, order)):
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

    def _value(self, P: Scalar, order: int) -> float:
        """P there; 0 where it vanishes against what it is beside the place, and against its terms further away."""
        value = self._at(P, self.state)
        near = max(self._at(P, state, 0.0) for state in states_beside(self.state, self.statics.q))
        away = ({**self.state, **{q: self.state[q] + shift for q in self.statics.q}} for shift in AWAY)
        far = max(self._at(P, state, 0.0) for state in away)
        share = COMPUTED if order < MULTIPLE else AT_A_MULTIPLE_ROOT
        return value if abs(value) > max(share * near, ZERO_AT_50 * far) else 0.0

    def _at(self, P: Scalar, state: Mapping[Node, Any], otherwise: float | None = None) -> float:
        """P; its size, or this where it has none."""
        try:
            value = float(evaluate((P,), state, fifty_digits())[0])
        except NoValue:
            if otherwise is None:
                raise
            return otherwise
        return value if otherwise is None else abs(value)
