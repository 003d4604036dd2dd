"""Linear equations over the graph: solved by elimination, or by determinants where these are short.

Sparse linear equations over the graph: solved by elimination, with dependent unknowns and left-over rows.

A pivot must not vanish where the equations hold. Whether an entry does is read off its value at one generic state,
the shadow, which is carried through the elimination with the expressions. What has pivots that vanish at special
states alone (the sine of an angle) is left to the normal equations

    W^T A x = W^T b,   W = A where nothing better is known,

which for equations without contradiction have the same solution, and with W = A no other singular states than A.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from operator import add
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.resources import check_patience
from eomgen.symbolic.exact import cramer
from eomgen.symbolic.exact.equality import equal_at_real_states
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Number,
    Scalar,
    SparseRow,
    holds_op,
    inner,
    is_zero,
    over,
    symbols_of,
)
from eomgen.symbolic.numeric import has_pieces, lengths_of, tolerances

TOGETHER = 4  # unknowns of one set of normal equations
PIECES_TRIED = 8  # states at which something vanishes in every piece: it may stand in any of them

ValuesAt = Callable[[Sequence[Scalar]], list[Any]]


@dataclass(frozen=True)
class Solution:
    """x of  A x = b,  as far as the rows determine it.

    Args:
        constants: of each unknown that was solved for, x_j = constant - sum of coefficient * x_free.
        shares: the coefficients of the free unknowns, {} where x_j is determined.
        free: the unknowns that stay free: as many as the equations leave undetermined.
        left: right sides of the rows in which no unknown is left: they must vanish.
        worst: the largest rank of a pivot; None where some pivots came late, or none was sure.
        unsure: True if a divisor may vanish at some state where the equations are regular.
    """

    constants: dict[int, Scalar]
    shares: dict[int, dict[int, Scalar]]
    free: tuple[int, ...]
    left: tuple[Scalar, ...]
    worst: int | None = None
    unsure: bool = False

    def determined(self, j: int) -> bool:
        """True if unknown j has one value only."""
        return j in self.constants and not self.shares[j]


@dataclass
class _Line:
    """One row under elimination: its entries, their shadows, its right side, and its row of W."""

    entries: SparseRow
    shadow: dict[int, Any]
    right: Scalar
    test: SparseRow


@dataclass(frozen=True)
class LinearSystem:
    """sum over j of rows[i][j] x_j = right[i]

    Args:
        unknowns: how many x there are.
        values: the values of scalars at one generic state, in an arithmetic of many digits.
    """

    rows: Sequence[Mapping[int, Scalar]]
    right: Sequence[Scalar]
    unknowns: int
    values: ValuesAt

    def solution(self, pivots: Pivots | None = None) -> Solution:
        """x as far as the rows determine it, by elimination; named common factors are divided out first."""
        pivots = pivots or Pivots()
        return scaled_solution(self, pivots) if pivots.factors else self.eliminated(pivots)

    def eliminated(self, pivots: Pivots) -> Solution:
        """Solution by elimination: pivots are plain numbers if there are any; least fill-in comes first (Markowitz)."""
        rank, late, sure = pivots.rank, frozenset(pivots.last), pivots.sure

        def tested(line: _Line, j: int) -> bool:
            """True if W has the entry too: friction alone does not determine the normal force that it comes from."""
            return j not in late or not is_zero(line.test.get(j, 0))

        def divides(line: _Line, j: int, x: Scalar) -> int:
            """The rank of an entry as a pivot, no better than that of W's."""
            if not tested(line, j):
                return (sure or 0) + 1
            return max(rank(x), rank(line.test[j])) if j in late else rank(x)

        lines = _lines(self, pivots)
        order: list[tuple[int, _Line]] = []
        if sure is not None:
            _eliminate(
                lines,
                order,
                lambda line, j, x: (divides(line, j, x), j in late),
                pivots,
                worst=(sure, True),
            )
        waits = bool(late) or (sure is not None and any(line.entries for line in lines))
        if sure is not None:
            _normal(lines, order, self.values)
        if pivots.regular:
            _squares(lines, order, late, self.values, pivots.tolerance)
        done = len(order)
        _eliminate(lines, order, lambda line, j, x: ((j in late) + (not tested(line, j)), rank(x)), pivots)
        free = tuple(j for j in range(self.unknowns) if j not in {pivot for pivot, _ in order})
        constants, shares = _substituted(order, free, pivots)
        worst = None if waits else max((rank(line.entries[j]) for j, line in order), default=0)
        unsure = any(divides(line, j, line.entries[j]) > (sure or 0) for j, line in order[done:])
        return Solution(constants, shares, free, tuple(line.right for line in lines), worst, unsure)

    def unique_solution(self, *, vanishes: Callable[[Scalar], bool] | None = None) -> tuple[Scalar, ...]:
        """x of as many rows as unknowns: by minors where the unknowns are few, else by elimination.

        Args:
            vanishes: says if an entry is zero at all states, not only where the values are (None: by these values).
        Raises:
            DerivationError: there is no single solution.
        """
        if self.unknowns <= cramer.LARGEST_BLOCK and len(self.rows) == self.unknowns:
            found, _ = cramer.solution_by_minors(self.rows, [(x,) for x in self.right], vanishes=vanishes or is_zero)
            return tuple(x for (x,) in found)
        solution = self.solution(Pivots(vanishes=vanishes) if vanishes else None)
        if solution.free:
            raise DerivationError("the equations have no single solution")
        return tuple(solution.constants[j] for j in range(self.unknowns))


def _number_first(a: Scalar) -> int:
    return 1 if type(a) is Node else 0


def in_every_piece(a: Scalar) -> bool:
    """True if what vanishes at a state of one piece is zero in all pieces: s + |s| is not, nor s + sqrt(s^2)."""
    with suppress(DerivationError):  # without values at real states
        return not (has_pieces(a) or holds_op(a, "sqrt")) or equal_at_real_states([(a, 0)], states=PIECES_TRIED).equal
    return True


@dataclass(frozen=True)
class Pivots:
    """Rules for pivots: what may be divided by, and in which order.

    Args:
        rank: of a scalar as a pivot, 0 the best: numbers before all else.
        tolerance: of shadows against the largest of their row, below which an entry is zero.
        last: unknowns that are taken as pivots only where there is no other.
        sure: the largest rank of a pivot that vanishes nowhere; the others wait for the normal equations (None: all
            are taken as they come).
        tests: of each row the entries of W that are not those of A (the push of a contact without its friction).
        factors: symbols that may stand in common factors of rows and columns, which are divided out first: parameters
            for which the equations are not singular.
        steady: says if an atom of such symbols vanishes nowhere; rows are divided by no other.
        regular: what waits is solved by normal equations, however many unknowns are coupled or dependent.
        vanishes: says if an entry whose shadow is zero is left out. What stays is no pivot: it is zero in one piece
            only, or, where the equations must hold off the constraints too, on the constraints only.
    """

    rank: Callable[[Scalar], int] = _number_first
    tolerance: float = tolerances.ELIMINATED_AT_50
    last: Collection[int] = ()
    sure: int | None = None
    tests: Sequence[Mapping[int, Scalar]] = ()
    factors: Collection[Node] = ()
    steady: Callable[[Node], bool] = lambda _: True
    regular: bool = False
    vanishes: Callable[[Scalar], bool] = in_every_piece


def _lines(system: LinearSystem, pivots: Pivots) -> list[_Line]:
    tolerance, tests = pivots.tolerance, pivots.tests or [{}] * len(system.rows)
    found = system.values([entry for row in system.rows for entry in row.values()])
    shadows, floor = iter(found), tolerance**2 * max(map(abs, found), default=0)  # a row may be rounding alone
    lines = []
    for row, b, test in zip(system.rows, system.right, tests, strict=True):
        shadow = {j: next(shadows) for j in row}
        largest = max((abs(x) for x in shadow.values()), default=0)
        least = max(tolerance * largest, floor)
        sure = {j for j, x in row.items() if abs(shadow[j]) > least or _is_small(x, system.values, pivots)}
        kept = {j: x for j, x in row.items() if not is_zero(x) and (j in sure or not pivots.vanishes(x))}
        shadow = {j: shadow[j] if j in sure else 0 for j in kept}
        own = {j: x for j, x in {**kept, **test}.items() if not is_zero(x)}
        lines.append(_Line(kept, shadow, b, own))
    return lines


def _is_small(x: Scalar, values: ValuesAt, pivots: Pivots) -> bool:
    """True if an entry is small but not rounding: a product in which only numbers and parameters are small."""
    others: list[Scalar] = []
    left = [x]
    while left:
        factor = left.pop()
        if type(factor) is Node and factor.op in ("mul", "div", "neg", "sqrt"):
            left += factor.args
        elif type(factor) is Node and factor not in pivots.factors:
            others.append(factor)
    simple = all(type(y) is Node and y.op in ("symbol", "sin", "cos") for y in others)
    return simple and all(abs(value) > pivots.tolerance for value in values(others))


def _eliminate(
    lines: list[_Line],
    order: list[tuple[int, _Line]],
    rank: Callable[[_Line, int, Scalar], tuple[int, int]],
    pivots: Pivots,
    worst: tuple[int, int] | None = None,
) -> None:
    """Moves lines, each with the unknown that it is solved for, into `order`, as long as there are pivots."""
    many = Counter(j for line in lines for j in line.entries)  # lines that hold an unknown
    while (found := _pivot(lines, many, rank)) is not None:
        check_patience()
        k, j = found
        line = lines[k]
        if worst is not None and rank(line, j, line.entries[j]) > worst:
            return
        del lines[k]
        order.append((j, line))
        many.subtract(list(line.entries))
        for other in lines if many[j] else ():
            if j in other.entries:
                many.subtract(list(other.entries))
                _subtract(other, line, j, pivots)
                many.update(list(other.entries))


def _pivot(
    lines: list[_Line], many: Mapping[int, int], rank: Callable[[_Line, int, Scalar], tuple[int, int]]
) -> tuple[int, int] | None:
    """(line, unknown) of the entry of least rank, by which the next one is eliminated; of those that fills in least."""
    best, found = None, None
    for k, line in enumerate(lines):
        for j, entry in line.entries.items():
            if line.shadow[j] == 0:
                continue
            this = (*rank(line, j, entry), (len(line.entries) - 1) * (many[j] - 1))
            if best is None or this < best:
                best, found = this, (k, j)
                if this == (0, 0, 0):
                    return found
    return found


def _normal(lines: list[_Line], order: list[tuple[int, _Line]], values: ValuesAt) -> None:
    """Solves the groups of lines that determine a few unknowns by their normal equations; what they leave stays."""
    for group, unknowns in _groups(lines):
        A = np.array([[float(line.shadow.get(j, 0)) for j in unknowns] for line in group])
        if len(unknowns) > min(len(group), TOGETHER) or not _independent(A):
            continue
        rows, right = _tested(group, unknowns, A, values)
        found = cramer.solution_by_minors(rows, [(b,) for b in right])[0]
        for line in group:
            lines.remove(line)
        known = {j: value for j, (value,) in zip(unknowns, found, strict=True)}
        order += [(j, _Line({j: 1}, {j: 1}, value, {})) for j, value in known.items()]
        lines += [_Line({}, {}, _rest(line, known), {}) for line in group[len(unknowns) :]]


def _squares(
    lines: list[_Line], order: list[tuple[int, _Line]], late: Collection[int], values: ValuesAt, tolerance: float
) -> None:
    """Solves what is left without friction by its normal equations; unknowns that depend on those before stay free.

    A_S x_S = b - A_F x_F,    A_S^T A_S x_S = A_S^T (b - A_F x_F)
    """
    for group, unknowns in (each for each in _groups(lines) if not {*late} & {*each[1]}):
        own = [unknowns[k] for k in _spanning([[line.shadow.get(j, 0) for line in group] for j in unknowns])]
        A = [[line.entries.get(j, 0) for line in group] for j in own]
        factors = _factors(A)
        x = _least_squares(A, factors, [line.right for line in group])
        left = [_rest(line, dict(zip(own, x, strict=True))) for line in group]
        known = dict(zip(own, map(add, x, _least_squares(A, factors, left)), strict=True))  # what rounding left
        shares: dict[int, SparseRow] = {j: {} for j in own}
        for f in (j for j in unknowns if j not in known):
            share = _least_squares(A, factors, [line.entries.get(f, 0) for line in group])
            for j, y, shadow in zip(own, share, values(share), strict=True):
                if abs(shadow) > tolerance:
                    shares[j][f] = y
        for line in group:
            lines.remove(line)
        lines += [_Line({}, {}, _rest(line, known), {}) for line in group[len(own) :]]
        for j, share_of in shares.items():
            shadows = dict(zip(share_of, values(list(share_of.values())), strict=True))
            order.append((j, _Line({j: 1, **share_of}, {j: 1, **shadows}, known[j], {})))


def _spanning(columns: Sequence[Sequence[Any]]) -> list[int]:
    """The columns that do not depend on those before them."""
    found: list[int] = []
    basis: list[np.ndarray] = []
    for k, column in enumerate(columns):
        whole = np.array([float(x) for x in column])
        rest = whole / lengths_of(whole)
        for direction in (*basis, *basis):
            rest = rest - direction * (direction @ rest)
        if np.linalg.norm(rest) > tolerances.RANK:
            found.append(k)
            basis.append(rest / np.linalg.norm(rest))
    return found


def _factors(A: Sequence[Sequence[Scalar]]) -> list[list[Scalar]]:
    """A^T A = L D L^T: each row of L below the diagonal, then of D, which vanishes where columns depend on others.

    Args:
        A: its columns.
    """
    rows: list[list[Scalar]] = []
    for i, a in enumerate(A):
        row: list[Scalar] = []  # of L D
        for k in range(i):
            row.append(inner(a, A[k]) - inner(row, rows[k][:k]))
        L = [over(x, rows[k][k]) for k, x in enumerate(row)]
        rows.append([*L, inner(a, a) - inner(row, L)])
    return rows


def _least_squares(
    A: Sequence[Sequence[Scalar]], factors: Sequence[Sequence[Scalar]], b: Sequence[Scalar]
) -> list[Scalar]:
    """x of A^T A x = A^T b, by the factors."""
    x: list[Scalar] = []
    for a, row in zip(A, factors, strict=True):
        x.append(inner(a, b) - inner(row[:-1], x))
    x = [over(y, row[-1]) for y, row in zip(x, factors, strict=True)]
    for i in reversed(range(len(x))):
        x[i] = x[i] - _sum(factors[k][i] * x[k] for k in range(i + 1, len(x)))
    return x


def _tested(
    group: list[_Line], unknowns: list[int], A: np.ndarray, values: ValuesAt
) -> tuple[list[SparseRow], list[Scalar]]:
    """(W^T A, W^T b), and (A, b) itself where it is square; unknowns counted from 0."""
    if len(group) == len(unknowns):
        return [_numbered(line.entries, unknowns) for line in group], [line.right for line in group]
    W = [line.test for line in group]
    flat = iter(values([row.get(j, 0) for row in W for j in unknowns]))
    if not _independent(np.array([[float(next(flat)) for _ in unknowns] for _ in W]).T @ A):
        W = [line.entries for line in group]
    rows = [
        {
            k: _sum(row.get(i, 0) * line.entries.get(j, 0) for row, line in zip(W, group, strict=True))
            for k, j in enumerate(unknowns)
        }
        for i in unknowns
    ]
    return rows, [_sum(row[i] * line.right for row, line in zip(W, group, strict=True) if i in row) for i in unknowns]


def _numbered(entries: SparseRow, unknowns: list[int]) -> SparseRow:
    return {k: entries[j] for k, j in enumerate(unknowns) if j in entries}


def _groups(lines: list[_Line]) -> list[tuple[list[_Line], list[int]]]:
    """Lines that share unknowns, directly or through others, and these unknowns."""
    groups: list[tuple[list[_Line], set[int]]] = []
    for line in lines:
        mine, columns = [line], set(line.entries)
        if not columns:
            continue
        for group in [g for g in groups if g[1] & columns]:
            groups.remove(group)
            mine, columns = group[0] + mine, group[1] | columns
        groups.append((mine, columns))
    return [(group, sorted(columns)) for group, columns in groups]


def _independent(A: np.ndarray) -> bool:
    """True if the columns are independent."""
    lengths = lengths_of(A, 0)
    return bool(lengths.all() and np.linalg.svd(A / lengths, compute_uv=False)[-1] > tolerances.RANK)


def _sum(terms: Iterable[Scalar]) -> Scalar:
    return sum(terms, start=0)


def _rest(line: _Line, known: Mapping[int, Scalar]) -> Scalar:
    """b - A x of a line: zero where the equations hold."""
    return line.right - _sum(x * known[j] for j, x in line.entries.items() if j in known)


def _subtract(other: _Line, line: _Line, j: int, pivots: Pivots) -> None:
    """other - factor * line, so that unknown j leaves it."""
    factor = _quotient(other.entries.pop(j), line.entries[j])
    shadow = other.shadow.pop(j) / line.shadow[j]
    other.right = other.right - factor * line.right
    other.test = {k: other.test.get(k, 0) - factor * line.test.get(k, 0) for k in {**other.test, **line.test} if k != j}
    for k, entry in line.entries.items():
        if k == j:
            continue
        x = other.entries.get(k, 0) - factor * entry
        before, taken = other.shadow.get(k, 0), shadow * line.shadow[k]
        stands = abs(before - taken) > pivots.tolerance * max(abs(before), abs(taken))
        if stands or not pivots.vanishes(x):
            other.entries[k], other.shadow[k] = x, before - taken if stands else 0
        else:
            other.entries.pop(k, None)
            other.shadow.pop(k, None)


def _substituted(
    order: list[tuple[int, _Line]], free: tuple[int, ...], pivots: Pivots
) -> tuple[dict[int, Scalar], dict[int, dict[int, Scalar]]]:
    """Back substitution: every pivot by the free unknowns alone."""
    constants: dict[int, Scalar] = {}
    shares: dict[int, dict[int, Scalar]] = {}
    shadows: dict[int, dict[int, Any]] = {}
    for j, line in reversed(order):
        right = line.right
        share: dict[int, Scalar] = {}
        shadow: dict[int, Any] = {}
        sizes: dict[int, Any] = {}
        for k, entry in line.entries.items():
            if k == j:
                continue
            if k in constants:
                right = right - entry * constants[k]
                for f, coefficient in shares[k].items():
                    _add(share, shadow, sizes, f, -entry * coefficient, -line.shadow[k] * shadows[k][f])
            else:
                _add(share, shadow, sizes, k, entry, line.shadow[k])
        pivot = line.entries[j]
        constants[j] = _quotient(right, pivot)
        kept = [f for f in share if abs(shadow[f]) > pivots.tolerance * sizes[f] or not pivots.vanishes(share[f])]
        shares[j] = {f: _quotient(share[f], pivot) for f in kept}
        shadows[j] = {f: shadow[f] / line.shadow[j] for f in kept}
    return constants, shares


def _add(share: SparseRow, shadow: dict[int, Any], sizes: dict[int, Any], f: int, entry: Scalar, value: Any) -> None:
    share[f] = share[f] + entry if f in share else entry
    shadow[f] = shadow.get(f, 0) + value
    sizes[f] = max(sizes.get(f, 0), abs(value))


def _quotient(a: Scalar, b: Scalar) -> Scalar:
    if type(b) is int and b in (1, -1):
        return a if b == 1 else -a
    return over(a, b)


# -------- scaling ---------------------------------------------------------------------------------------------
# Linear equations -> their solution, common factors of rows and columns divided out before.
#
#     a_ij = r_i b_ij s_j,   sum of b_ij y_j = b_i / r_i,   x_j = y_j / s_j
#
# Where the entries of rows and columns differ by plain numbers only, as in a truss with one panel length and one
# height, the numbers b_ij are left, and an elimination stays one of numbers. An x_j whose factor vanishes is
# undetermined by these rows, scaled or not; a row whose factor vanishes says nothing, where another one may say the
# same still.


SWEEPS = 3  # over rows and columns

SymbolPowers = dict[Node, int]


@dataclass
class PowerProduct:
    """number * product of atom ^ power"""

    number: Number
    powers: SymbolPowers

    def scalar(self) -> Scalar:
        total: Scalar = self.number
        for atom, e in self.powers.items():
            for _ in range(abs(e)):
                total = total * atom if e > 0 else over(total, atom)
        return total


@dataclass(frozen=True)
class Scaled:
    """The rows b_ij with their right sides, and the factors.

    Args:
        rows, right: the equations for y.
        tests: rows of the same scaling, whose factors they were given with.
        columns: s_j; a column without one is left as it was.
    """

    rows: list[dict[int, Scalar]]
    right: list[Scalar]
    tests: list[dict[int, Scalar]]
    columns: dict[int, Scalar]


def scaled_solution(system: LinearSystem, pivots: Pivots) -> Solution:
    """Solution by elimination, once the common factors in `pivots.factors` are divided out of rows and columns."""
    found = without_common_factors(system.rows, system.right, frozenset(pivots.factors), pivots.tests, pivots.steady)
    scaled = replace(system, rows=found.rows, right=found.right)
    solution = scaled.eliminated(replace(pivots, tests=found.tests))
    s = found.columns
    constants = {j: over(x, s.get(j, 1)) for j, x in solution.constants.items()}
    shares = {j: {f: over(x * s.get(f, 1), s.get(j, 1)) for f, x in own.items()} for j, own in solution.shares.items()}
    return replace(solution, constants=constants, shares=shares)


def without_common_factors(
    rows: Sequence[Mapping[int, Scalar]],
    right: Sequence[Scalar],
    sure: Collection[Node],
    tests: Sequence[Mapping[int, Scalar]] = (),
    steady: Callable[[Node], bool] = lambda _: True,
) -> Scaled:
    """The equations without their common factors.

    Args:
        sure: the symbols that may stand in what is divided by.
        tests: further rows, of the same number, that are scaled alike.
        steady: says if an atom of these symbols vanishes nowhere: a row is divided by no other.
    """
    entries = {(i, j): monomial(x) for i, row in enumerate(rows) for j, x in row.items()}
    by_row: dict[int, SymbolPowers] = {}
    by_column: dict[int, SymbolPowers] = {}
    own = {atom for entry in entries.values() for atom in entry.powers}
    own = {atom for atom in own if frozenset(sure).issuperset(symbols_of((atom,)))}
    for_rows = set(filter(steady, own))
    for _ in range(SWEEPS):
        taken = _taken(entries, 0, by_row, for_rows) + _taken(entries, 1, by_column, own)
        if not taken:
            break
    r = {i: PowerProduct(1, powers).scalar() for i, powers in by_row.items()}
    s = {j: PowerProduct(1, powers).scalar() for j, powers in by_column.items()}
    found: list[dict[int, Scalar]] = [{} for _ in rows]
    for (i, j), entry in entries.items():
        found[i][j] = entry.scalar()
    alike = [{j: over(over(x, r.get(i, 1)), s.get(j, 1)) for j, x in row.items()} for i, row in enumerate(tests)]
    return Scaled(found, [over(b, r.get(i, 1)) for i, b in enumerate(right)], alike, s)


def monomial(x: Scalar) -> PowerProduct:
    """x as a number times powers of what is no product; a root of a number is an atom."""
    number: Number = Fraction(1)
    powers: SymbolPowers = {}
    stack: list[tuple[Scalar, int]] = [(x, 1)]
    while stack:
        part, e = stack.pop()
        roots = _two_roots(part)
        if roots:
            stack += [(root, e * sign) for root, sign in roots]
        elif type(part) is not Node:
            number = number * Fraction(part) ** e
        elif part.op == "neg":
            number = -number
            stack.append((part.args[0], e))
        elif part.op in ("mul", "div"):
            stack += [(part.args[0], e), (part.args[1], e if part.op == "mul" else -e)]
        else:
            powers[part] = powers.get(part, 0) + e
    whole = number.numerator if number.denominator == 1 else number
    return PowerProduct(whole, {atom: e for atom, e in powers.items() if e})


def _two_roots(x: Scalar) -> tuple[tuple[Scalar, int], ...]:
    """sqrt(n f) = sqrt(n) sqrt(f), sqrt(n/f), sqrt(f/n) with a positive number n: the roots and their powers."""
    if type(x) is not Node or x.op != "sqrt":
        return ()
    (under,) = x.args
    if type(under) is not Node or under.op not in ("mul", "div"):
        return ()
    a, b = under.args
    n = next((part for part in (a, b) if type(part) is not Node), 0)
    root = x.graph.sqrt
    return ((root(a), 1), (root(b), 1 if under.op == "mul" else -1)) if n > 0 else ()


def _taken(
    entries: dict[tuple[int, int], PowerProduct],
    which: int,
    factors: dict[int, SymbolPowers],
    own: Collection[Node],
) -> int:
    """Take the common powers of such atoms out of every row (which = 0) or column (1); how many there were."""
    lines: dict[int, list[PowerProduct]] = {}
    for place, entry in entries.items():
        lines.setdefault(place[which], []).append(entry)
    count = 0
    for k, line in lines.items():
        for atom, e in _common(line, own).items():
            taken = factors.setdefault(k, {})
            taken[atom] = taken.get(atom, 0) + e
            for entry in line:
                entry.powers[atom] = entry.powers.get(atom, 0) - e
                if not entry.powers[atom]:
                    del entry.powers[atom]
            count += 1
    return count


def _common(line: list[PowerProduct], own: Collection[Node]) -> SymbolPowers:
    """The powers of such atoms that all monomials of a line hold."""
    atoms = dict.fromkeys(atom for entry in line for atom in entry.powers if atom in own)
    least = {atom: min(entry.powers.get(atom, 0) for entry in line) for atom in atoms}
    most = {atom: max(entry.powers.get(atom, 0) for entry in line) for atom in atoms}
    return {atom: least[atom] if least[atom] > 0 else most[atom] for atom in atoms if least[atom] > 0 or most[atom] < 0}


# -------- linear systems --------------------------------------------------------------------------------------
# Linear equations over the graph: the way is chosen here for systems of scalars; forces and balances choose theirs.
#
#     way                   for                                          divides by
#     minors                few unknowns hang together, A regular        determinants of blocks: singular where A is
#     elimination           any rows, dependent and too few as well      pivots that do not vanish at a generic state
#     normal equations      what has no pivot that is sure               determinants of W^T A
#     common factors        rows and columns in units of their own       products of the symbols named
#
# Numbers have `symbolic.numeric.dense`, the prime field `symbolic.numeric.arithmetic`.
