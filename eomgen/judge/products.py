"""Values that a formula has, and should have, at many states -> the simple change that makes the one the other.

What is meant is the formula times a simple product of names, or such a product beside it or in its place, or the
formula's square, root or reciprocal.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import combinations

import numpy as np

from eomgen.judge.diagnosis import MINUS, PLAINEST, UNUSUAL, USUAL, WELL_KNOWN, simple_factor
from eomgen.judge.edits import power
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.tolerances import CARRIED, COMPUTED

SIGN, NUMBER, PRODUCT, LONGER = 2.5, 2.7, 3.0, 4.5  # how much less than the plainest mistake each is believed
ELSEWHERE, BESIDE, A_RATE = 0.5, 0.7, 1.0  # of a product in its place; beside it; of a rate that is left out
SQUARES = (Fraction(9), Fraction(16), Fraction(1, 9), Fraction(1, 16))  # numbers of which people take twice a power
_EXPONENTS = (  # of two names: powers, how much less they are believed
    *(((k, -k), PRODUCT) for k in (1, -1)),
    *(((k, -k), PRODUCT + ELSEWHERE) for k in (2, -2)),
    *(((k, k), LONGER) for k in (1, -1)),
    *(((k, n), LONGER) for k, n in ((2, -1), (-2, 1), (1, -2), (-1, 2))),
)


@dataclass(frozen=True)
class Amended:
    """What is meant in the place of a formula.

    Args:
        cost: how much less it is believed than the plainest mistake.
        to: what is meant.
        kind: of the cause.
    """

    cost: float
    to: Scalar
    kind: str


@dataclass(frozen=True)
class Products:
    """Products of names with simple powers.

    Args:
        atoms: the names, and waves of angles.
        values: of each at every state.
    """

    atoms: tuple[Node, ...]
    values: np.ndarray

    @cached_property
    def _known(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of each product the powers of the atoms, how much less it is believed, and its values."""
        n = len(self.atoms)
        unit = np.eye(n)
        rows = [np.zeros(n), *(k * unit[i] for k in (1, -1, 2, -2, 0.5, -0.5) for i in range(n))]
        dear = [x.op == "symbol" and x.name.endswith("'") for x in self.atoms]
        costs = [0.0, *(PRODUCT + A_RATE * each for _ in range(2) for each in dear), *[PRODUCT + ELSEWHERE] * 4 * n]
        for i, j in combinations(range(n), 2):
            rows += [k * unit[i] + m * unit[j] for (k, m), _ in _EXPONENTS]
            costs += [cost for _, cost in _EXPONENTS]
        powers = np.array(rows)
        with np.errstate(all="ignore"):
            sizes = np.exp(powers @ np.log(np.abs(self.values)))
            negative = (powers % 2 == 1).astype(int) @ (self.values < 0).astype(int)
        return powers, np.array(costs), np.where(negative % 2 == 1, -sizes, sizes)

    def changes(self, node: Node, own: np.ndarray, needed: np.ndarray, *, inner: bool, forced: bool) -> list[Amended]:
        """Those by which a node gets the value that is needed.

        Args:
            inner: it is a factor of a product: a number is one of that.
            forced: it holds accelerations, of which nobody takes the wrong sign.
        """
        if np.all(np.abs(needed) <= COMPUTED * np.abs(own)):
            return [Amended(PRODUCT, 0, "extra_term")]
        with np.errstate(all="ignore"):
            found = list(other_forms(node, own, needed))
            ratios = list(self._fits(needed / own))
            for k, c in ratios:
                if not (c < 0 and forced) and (k or (c != 1 and not inner)):
                    number = SIGN if c == -1 else NUMBER + _of_number(c)
                    cost = self._cost(k, c) if k else number
                    found.append(Amended(cost, self._product(k, c) * node, self._kind(k, c)))
            if any(k == 0 for k, _ in ratios):
                return found
            for k, c in self._fits(needed):
                if k and self._known[1][k] < LONGER:
                    found.append(Amended(self._cost(k, c) + ELSEWHERE, self._product(k, c), "wrong_quantity"))
            for k, c in self._fits(needed - own) if node.op not in ("mul", "div") else ():
                if k and self._known[1][k] < LONGER:
                    cost = float(self._known[1][k]) + BESIDE + _of_number(abs(c))
                    found.append(Amended(cost, node + self._product(k, c), "missing_term"))
        return found

    def _fits(self, values: np.ndarray) -> Iterator[tuple[int, Fraction]]:
        """(which product, how often) the values are at every state."""
        ratios = values / self._known[2]
        first = ratios[:, :1]
        good = np.all(np.abs(ratios - first) <= CARRIED * np.abs(first), axis=1) & (np.abs(first[:, 0]) > 0)
        for k in np.flatnonzero(good):
            c = simple_factor(float(first[k, 0]), WELL_KNOWN**2)
            if c and (max(abs(c.numerator), c.denominator) <= WELL_KNOWN or c in SQUARES):
                yield int(k), c

    def _cost(self, k: int, c: Fraction) -> float:
        """Of a product; a wrong sign beside it is a mistake of its own."""
        return float(self._known[1][k]) + _of_number(abs(c)) + (PLAINEST if c < 0 else 0.0)

    def _product(self, k: int, c: Fraction) -> Scalar:
        found: Scalar = c
        for i in np.flatnonzero(self._known[0][k]):
            found = found * power(self.atoms[i], Fraction(float(self._known[0][k][i])))
        return found

    def _kind(self, k: int, c: Fraction) -> str:
        held = [self.atoms[i] for i in np.flatnonzero(self._known[0][k])]
        if len(held) == 2:
            return "wrong_axis" if {x.op for x in held} == {"sin", "cos"} else "wrong_quantity"
        return "sign" if not held and c == -1 else "factor"


def other_forms(node: Node, own: np.ndarray, needed: np.ndarray) -> Iterator[Amended]:
    """Its square, its root, its reciprocal."""
    for value, k in ((own * own, Fraction(2)), (np.sqrt(np.abs(own)), Fraction(1, 2)), (1 / own, Fraction(-1))):
        if np.all(np.abs(value - needed) <= CARRIED * np.abs(needed)):
            yield Amended(NUMBER, power(node, k), "factor")


def _of_number(c: Fraction) -> float:
    """How much less a number is believed than none."""
    size = next((more / 2 for known, more in USUAL if abs(c) in known), UNUSUAL)
    return size + (MINUS if c < 0 else 0.0)
