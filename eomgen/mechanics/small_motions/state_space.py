"""Small motions -> their state space, x' = A x + B w, y = C_y x + D_y w, exact where that is little work.

x = (dq_i, du_i),   A = [F, E; -M^-1 K, -M^-1 C],   B = [0; M^-1 B_w]
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.errors import UsageError
from eomgen.mechanics.small_motions.field import Entries, Exact, matrix_solution
from eomgen.mechanics.small_motions.linearization import SmallMotions
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.records import dataclass
from eomgen.symbolic.expression.traversal import operations

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


def state_names(e: LinearEquations) -> tuple[str, ...]:
    """x: the coordinates, then the speeds."""
    return tuple(x.name for x in (*e.coordinates, *e.speeds))


def exact_state_space(small: SmallMotions, outputs: Sequence[str]) -> StateMatrices | None:
    """In scalars of the parameters; None where they are not known so, or it is too much work."""
    e = small.exact
    if e is None or len(e.speeds) > MOST:
        return None
    right = [[*k, *c, *b] for k, c, b in zip(e.K, e.C, e.B, strict=True)]
    if operations(x for row in (*e.M, *right) for x in row).total > MOST_OPERATIONS:
        return None
    reference = small.reference
    field = Exact({}, reference.system.scope.positive, reference.trial)
    solved = matrix_solution(field, e.M, right)
    n, width = len(e.coordinates), len(e.coordinates) + len(e.speeds)
    A = [[*f, *g] for f, g in zip(e.F, e.E, strict=True)] + [[field.tidy(-x) for x in row[:width]] for row in solved]
    B: Entries = [[0] * len(e.inputs) for _ in range(n)] + [row[width:] for row in solved]
    return with_outputs(e, A, B, outputs)


def with_outputs(e: LinearEquations, A: Entries, B: Entries, outputs: Sequence[str]) -> StateMatrices:
    """The state space whose outputs are states, or rates of them.

    Args:
        outputs: names of coordinates, speeds, or their derivatives: theta, theta', theta''.
    Raises:
        UsageError: another name.
    """
    states = state_names(e)
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
    raise UsageError(f"no output '{name}' of small motions", mend=f"{', '.join(states)}, or the rate of one of them")
