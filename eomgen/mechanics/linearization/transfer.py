"""LinearEquations with inputs -> state space and transfer functions."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.errors import UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.linearization.linearization import SmallMotions
from eomgen.mechanics.linearization.reduction import LinearEquations
from eomgen.mechanics.state import Entries, Exact
from eomgen.symbolic.exact import Expansion, Polynomial, TooLarge, cramer, reduced
from eomgen.symbolic.expression import Node, is_zero, operations, over
from eomgen.symbolic.numeric import Work, evaluate, fifty_digits, tolerances

# -------- transfer --------------------------------------------------------------------------------------------
# LinearEquations with inputs -> transfer functions, exact by Cramer's rule, or in floats.


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
    """Transfer functions from every input to every coordinate, by Cramer's rule; () where it is too much work.

    Args:
        trial: values of the parameters, at which the leading coefficient below is positive, as det M is.
    """
    s = e.laplace_variable
    pencil = e.pencil(s) if e.inputs else None
    if pencil is None:
        return ()
    below = Polynomial.of(cramer.determinant(pencil), s, positive)
    right = [*(e.D if len(pencil) > len(e.B) else ()), *e.B]
    found = []
    for k, w in enumerate(e.inputs):
        for j, q in enumerate(e.coordinates):
            column = [[right[i][k] if m == j else x for m, x in enumerate(row)] for i, row in enumerate(pencil)]
            above = Polynomial.of(cramer.determinant(column), s, positive)
            if above is None or below is None:
                return ()
            found.append(TransferFunction(q, w, *_shortened(above, below, s, positive, trial)))
    return tuple(found)


def _shortened(
    above: Polynomial, below: Polynomial, s: Node, positive: Collection[Node], trial: Mapping[Node, Any]
) -> tuple[Polynomial, Polynomial]:
    """Numerator and denominator without common factors; only powers of s are cancelled where it is too much work."""
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
    upper, lower = (Polynomial.of(node(part), s, positive) for part in parts)
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
            above = np.where(
                abs(closed - below) > tolerances.ITERATED * (abs(closed) + abs(below)), closed - below, 0.0
            )
            found.append(TransferFunction(q, w, *map(_of_floats, (np.trim_zeros(above, "f"), below))))
    return tuple(found)


def _of_floats(highest_first: np.ndarray) -> Polynomial:
    return Polynomial(tuple(float(c) for c in reversed(highest_first)) or (0.0,))


# -------- state space -----------------------------------------------------------------------------------------
# Small motions -> their state space, x' = A x + B w, y = C_y x + D_y w, exact where that is little work.
#
# x = (dq_i, du_i),   A = [F, E; -M^-1 K, -M^-1 C],   B = [D; M^-1 B_w];   for users x = (dq_i, du_i, dz)


MOST = 4  # speeds of a state space that is written exactly
MOST_OPERATIONS = 120  # of the entries of M, C, K and B before they are solved


@dataclass(frozen=True)
class StateMatrices:
    """A, B, C_y, D_y as rows, of scalars of the parameters or of floats.

    Args:
        states, inputs, outputs: what their rows and columns belong to.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: Entries
    B: Entries
    C_y: Entries
    D_y: Entries

    @staticmethod
    def exact(small: SmallMotions, outputs: Sequence[str]) -> StateMatrices | None:
        """State-space matrices in scalars of the parameters; None where unknown in closed form, or too much work."""
        e = small.exact
        if e is None or len(e.speeds) > MOST:
            return None
        right = [[*k, *c, *b] for k, c, b in zip(e.K, e.C, e.B, strict=True)]
        if operations(x for row in (*e.M, *right) for x in row).total > MOST_OPERATIONS:
            return None
        reference = small.reference
        field = Exact({}, reference.system.scope.positive, reference.trial)
        solved = field.solution(e.M, right)
        width = len(e.coordinates) + len(e.speeds)
        A = [[*f, *g] for f, g in zip(e.F, e.E, strict=True)] + [
            [field.tidy(-x) for x in row[:width]] for row in solved
        ]
        B: Entries = [*([*row] for row in e.D), *(row[width:] for row in solved)]
        return StateMatrices.of(e, A, B, outputs)

    @staticmethod
    def of(e: LinearEquations, A: Entries, B: Entries, outputs: Sequence[str]) -> StateMatrices:
        """The state space whose outputs are states, or rates of them.

        Args:
            A, B: rows and columns in the order of the coordinates, states and speeds of the equations.
            outputs: names of coordinates, speeds, or their derivatives: theta, theta', theta''.
        Raises:
            UsageError: another name.
        """
        A = [[A[i][j] for j in e.order] for i in e.order]
        B = [B[i] for i in e.order]
        states = tuple(x.name for x in e.moving)
        rows = [_output(name, states, A, B) for name in outputs]
        C_y, D_y = [row for row, _ in rows], [through for _, through in rows]
        return StateMatrices(states, tuple(w.name for w in e.inputs), tuple(outputs), A, B, C_y, D_y)


def _output(name: str, states: tuple[str, ...], A: Entries, B: Entries) -> tuple[list[object], list[object]]:
    """(its row of C_y, its row of D_y): a state by itself, the rate of one by the equations."""
    if name in states:
        return [int(x == name) for x in states], [0 for _ in B[0]] if B else []
    if name.endswith("'") and name[:-1] in states:
        k = states.index(name[:-1])
        return list(A[k]), list(B[k])
    raise UsageError(f"no output '{name}' of small motions", fix=f"{', '.join(states)}, or the rate of one of them")
