"""Linear equations -> their solution, common factors taken out of rows and columns before.

    a_ij = r_i b_ij s_j,   sum of b_ij y_j = b_i / r_i,   x_j = y_j / s_j

Where the entries of rows and columns differ by plain numbers only, as in a truss with one panel length and one height,
the numbers b_ij are left, and an elimination stays one of numbers. An x_j whose factor vanishes is undetermined by
these rows, scaled or not; a row whose factor vanishes says nothing, where another one may say the same still.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.solve.linear import LinearSystem, Pivots, Solution, sparse_solution

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
    """By elimination, once the common factors of rows and columns in `pivots.factors` were taken out."""
    found = without_common_factors(system.rows, system.right, frozenset(pivots.factors), pivots.tests, pivots.steady)
    scaled = replace(system, rows=found.rows, right=found.right)
    solution = sparse_solution(scaled, replace(pivots, tests=found.tests))
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
    """The equations with common factors taken out.

    Args:
        sure: the symbols that may stand in what is divided by.
        tests: further rows, of the same number, that are scaled alike.
        steady: whether an atom of these symbols vanishes nowhere: a row is divided by no other.
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
