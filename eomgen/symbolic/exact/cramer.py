"""Square linear equations over the graph -> their solution by determinants.

Elimination by pivots divides by expressions that vanish at states where the equations are regular; Cramer's rule
divides by the determinant alone. So plain numbers are taken as pivots, what is left is put into block triangular form,
and each block is solved by its own determinant:

    A_b x_b = r_b,   x_b = adj(A_b) r_b / det A_b
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Node, Scalar, SparseRow, inner, is_zero, over

Minors = dict[tuple[tuple[int, ...], tuple[int, ...]], Scalar]
LARGEST_BLOCK = 10  # unknowns in one determinant; its minors are 2^n


@dataclass
class SparseEquation:
    """One equation: sum of entries[j] x_j = right, one right side for each of several systems."""

    number: int
    entries: SparseRow
    right: list[Scalar]


@dataclass(frozen=True)
class Block:
    """Unknowns that equations determine together.

    Args:
        unknowns, equations: their numbers.
        matrix: the equations' coefficients of these unknowns, once numbers were eliminated.
    """

    unknowns: tuple[int, ...]
    equations: tuple[int, ...]
    matrix: tuple[tuple[Scalar, ...], ...]


def solution_by_minors(
    rows: Sequence[Mapping[int, Scalar]],
    right: Sequence[Sequence[Scalar]],
    *,
    vanishes: Callable[[Scalar], bool] = is_zero,
    shorter: Callable[[Scalar], Scalar] | None = None,
) -> tuple[tuple[tuple[Scalar, ...], ...], tuple[Block, ...]]:
    """X of A X = right, n x m, and the blocks whose determinants must not vanish.

    Args:
        rows: of A, {column: entry}, n of them; A is regular at almost every state.
        right: n rows of m.
        vanishes: says if an entry that came up on the way is zero at all states.
        shorter: puts an unknown into a shorter form before it is used further.
    Raises:
        DerivationError: more than LARGEST_BLOCK unknowns hang together.
    """
    pairs = zip(rows, right, strict=True)
    lines = [
        SparseEquation(i, {j: x for j, x in row.items() if not is_zero(x)}, list(r)) for i, (row, r) in enumerate(pairs)
    ]
    written = shorter or (lambda x: x)
    by_numbers = _numbers_eliminated(lines, vanishes)
    known: dict[int, list[Scalar]] = {}
    blocks = []
    for group, unknowns in triangular(lines):
        block = Block(unknowns, tuple(line.number for line in group), _matrix(group, unknowns))
        blocks.append(block)
        found = _by_determinants(block, [_without(line, known) for line in group])
        known |= {j: [written(x) for x in row] for j, row in found.items()}
    for j, line in reversed(by_numbers):
        known[j] = [written(over(x, line.entries[j])) for x in _without(line, known)]
    return tuple(tuple(known[j]) for j in range(len(rows))), tuple(blocks)


def _numbers_eliminated(
    lines: list[SparseEquation], vanishes: Callable[[Scalar], bool]
) -> list[tuple[int, SparseEquation]]:
    """(unknown, equation) wherever a plain number can be the pivot; these equations leave `lines`."""
    order = []
    while (found := _number(lines)) is not None:
        j, line = found
        lines.remove(line)
        order.append(found)
        for other in lines:
            if j in other.entries:
                _subtract(other, line, j, vanishes)
    return order


def _number(lines: Iterable[SparseEquation]) -> tuple[int, SparseEquation] | None:
    """The plain number whose elimination fills in least."""
    lines = list(lines)
    candidates = [(j, line) for line in lines for j, x in line.entries.items() if type(x) is not Node]

    def fill(found: tuple[int, SparseEquation]) -> int:
        j, line = found
        return (len(line.entries) - 1) * (sum(j in other.entries for other in lines) - 1)

    return min(candidates, key=fill, default=None)


def _subtract(other: SparseEquation, line: SparseEquation, j: int, vanishes: Callable[[Scalar], bool]) -> None:
    """other - factor * line, in which the unknown j has gone."""
    factor = over(other.entries.pop(j), line.entries[j])
    for k, x in line.entries.items():
        if k != j:
            rest = other.entries.pop(k, 0) - factor * x
            if not vanishes(rest):
                other.entries[k] = rest
    other.right = [a - factor * b for a, b in zip(other.right, line.right, strict=True)]


def _without(line: SparseEquation, known: Mapping[int, Sequence[Scalar]]) -> list[Scalar]:
    """The right side less what the known unknowns make up."""
    rest = list(line.right)
    for j, x in line.entries.items():
        if j in known:
            rest = [a - x * b for a, b in zip(rest, known[j], strict=True)]
    return rest


def _matrix(lines: Sequence[SparseEquation], unknowns: Sequence[int]) -> tuple[tuple[Scalar, ...], ...]:
    return tuple(tuple(line.entries.get(j, 0) for j in unknowns) for line in lines)


# -- one block ---------------------------------------------------------------------------------------


def _by_determinants(block: Block, right: Sequence[Sequence[Scalar]]) -> dict[int, list[Scalar]]:
    """x_j = sum over i of cofactor_ij right_i / det."""
    A, n = block.matrix, len(block.matrix)
    if n > LARGEST_BLOCK:
        raise DerivationError(
            f"{n} unknowns hang together: they are not written out one by one",
            fix="ask for numbers: give every parameter a value",
        )
    minors: Minors = {}
    everything = tuple(range(n))
    whole = _minor(A, everything, everything, minors)
    found = {}
    for j, unknown in enumerate(block.unknowns):
        others = everything[:j] + everything[j + 1 :]
        cofactors = [
            (-1) ** (i + j) * _minor(A, everything[:i] + everything[i + 1 :], others, minors) for i in range(n)
        ]
        found[unknown] = [over(inner(cofactors, column), whole) for column in zip(*right, strict=True)]
    return found


def determinant(matrix: Sequence[Sequence[Scalar]]) -> Scalar:
    """det of a small matrix, by its minors."""
    every = tuple(range(len(matrix)))
    return _minor(matrix, every, every, {})


def _minor(A: Sequence[Sequence[Scalar]], rows: tuple[int, ...], columns: tuple[int, ...], known: Minors) -> Scalar:
    """The determinant of some rows and columns, by the first row; each one once."""
    if not rows:
        return 1
    if (rows, columns) not in known:
        total: Scalar = 0
        for k, j in enumerate(columns):
            if not is_zero(A[rows[0]][j]):
                rest = _minor(A, rows[1:], columns[:k] + columns[k + 1 :], known)
                total = total + (-1) ** k * A[rows[0]][j] * rest
        known[rows, columns] = total
    return known[rows, columns]


# -- block triangular form ---------------------------------------------------------------------------


def triangular(lines: Sequence[SparseEquation]) -> list[tuple[list[SparseEquation], tuple[int, ...]]]:
    """(equations, unknowns) of the smallest square blocks, each after those whose unknowns stand in it.

    Source: Duff & Reid, An implementation of Tarjan's algorithm for the block triangularization of a matrix (1978).
    """
    matched = matching([line.entries for line in lines])
    of_unknown = {j: i for i, j in matched.items()}
    needs = [[of_unknown[j] for j in line.entries if of_unknown.get(j, i) != i] for i, line in enumerate(lines)]
    return [([lines[i] for i in group], tuple(sorted(matched[i] for i in group))) for group in components(needs)]


def matching(rows: Sequence[Iterable[int]]) -> dict[int, int]:
    """{equation: an unknown of its own, one of those in its row}, by augmenting paths.

    Raises:
        DerivationError: there are not enough of them.
    """
    taken: dict[int, int] = {}

    def placed(i: int, seen: set[int]) -> bool:
        for j in rows[i]:
            if j not in seen:
                seen.add(j)
                if j not in taken or placed(taken[j], seen):
                    taken[j] = i
                    return True
        return False

    for i in range(len(rows)):
        if not placed(i, set()):
            raise DerivationError("the equations do not determine their unknowns")
    return {i: j for j, i in taken.items()}


def components(needs: Sequence[Sequence[int]]) -> list[list[int]]:
    """Groups that need one another, each after the groups that it needs (Tarjan's strongly connected components)."""
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    found: list[list[int]] = []

    def visit(v: int) -> None:
        index[v] = low[v] = len(index)
        stack.append(v)
        for w in needs[v]:
            if w not in index:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in stack:
                low[v] = min(low[v], index[w])
        if low[v] == index[v]:
            group = stack[stack.index(v) :]
            del stack[stack.index(v) :]
            found.append(sorted(group))

    for v in range(len(needs)):
        if v not in index:
            visit(v)
    return found
