"""LinearEquations with inputs -> transfer functions, exact by Cramer's rule, or in floats."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from eomgen.mechanics.small_motions.polynomial import Polynomial, laplace_variable, pencil_of, polynomial_in
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.records import dataclass
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.quotient import reduced
from eomgen.symbolic.exact.terms import TooLarge
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, is_zero
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ITERATED
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.solve import cramer


@dataclass(frozen=True)
class TransferFunction:
    """q/w = above(s)/below(s), of one coordinate and one input."""

    coordinate: Node
    input: Node
    above: Polynomial
    below: Polynomial


def transfer_functions(
    e: LinearEquations, positive: Collection[Node], trial: Mapping[Node, Any]
) -> tuple[TransferFunction, ...]:
    """From every input to every coordinate, by Cramer's rule; () where it is too much work.

    Args:
        trial: values of the parameters, at which the leading coefficient below is positive, as det M is.
    """
    s = laplace_variable(e)
    pencil = pencil_of(e, s) if e.inputs else None
    if pencil is None:
        return ()
    below = polynomial_in(cramer.determinant(pencil), s, positive)
    right = [[0] * len(e.inputs)] * (len(pencil) - len(e.B)) + e.B
    found = []
    for k, w in enumerate(e.inputs):
        for j, q in enumerate(e.coordinates):
            column = [[right[i][k] if m == j else x for m, x in enumerate(row)] for i, row in enumerate(pencil)]
            above = polynomial_in(cramer.determinant(column), s, positive)
            if above is None or below is None:
                return ()
            found.append(TransferFunction(q, w, *_shortened(above, below, s, positive, trial)))
    return tuple(found)


def _shortened(
    above: Polynomial, below: Polynomial, s: Node, positive: Collection[Node], trial: Mapping[Node, Any]
) -> tuple[Polynomial, Polynomial]:
    """Without the factors that they have in common; powers of s alone where that is too much work."""
    a, b = list(above.coefficients), list(below.coefficients)
    while len(a) > 1 and len(b) > 1 and is_zero(a[0]) and is_zero(b[0]):
        a, b = a[1:], b[1:]
    plain = Polynomial(tuple(a)), Polynomial(tuple(b))
    expansion = Expansion(s.graph, Work.ANSWER, positive)
    expansion.of(s)
    try:
        parts = reduced(expansion, expansion.of(over(plain[0].at(s), plain[1].at(s))))
    except TooLarge:
        return plain
    node = expansion.atoms.node
    upper, lower = (polynomial_in(node(part), s, positive) for part in parts)
    if upper is None or lower is None:
        return plain
    leading = evaluate((lower.coefficients[-1],), trial, fifty_digits())[0]
    return (upper, lower) if leading > 0 else (upper.negative(positive), lower.negative(positive))


def transfers_in_numbers(e: LinearEquations, A: np.ndarray, B: np.ndarray) -> tuple[TransferFunction, ...]:
    """The same of x' = A x + B w in floats, x = (q, ...): det(s 1 - A + b c) = det(s 1 - A) (1 + c (s 1 - A)^-1 b)."""
    below = np.poly(A)
    found = []
    for k, w in enumerate(e.inputs):
        for j, q in enumerate(e.coordinates):
            coupled = A.copy()
            coupled[:, j] -= B[:, k]
            closed = np.poly(coupled)
            above = np.where(abs(closed - below) > ITERATED * (abs(closed) + abs(below)), closed - below, 0.0)
            found.append(TransferFunction(q, w, *map(_of_floats, (np.trim_zeros(above, "f"), below))))
    return tuple(found)


def _of_floats(highest_first: np.ndarray) -> Polynomial:
    return Polynomial(tuple(float(c) for c in reversed(highest_first)) or (0.0,))
