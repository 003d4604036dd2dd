"""Square linear equations over the graph, by determinants."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from each import each

from eomgen.errors import DerivationError
from eomgen.symbolic.exact.cramer import components, determinant, matching, solution_by_minors
from eomgen.symbolic.expression.derivatives import symbols_of
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.evaluation import RATIONAL, evaluate


def random_system(seed: int, n: int, density: float):
    """(rows, right) with symbols and numbers; regular, for the diagonal of a random order is filled."""
    rng, graph = Random(seed), Graph()
    order = rng.sample(range(n), n)
    rows = []
    for i in range(n):
        row = {}
        for j in range(n):
            if order[i] == j or rng.random() < density:
                row[j] = graph.symbol(f"x{i}{j}") if rng.random() < 0.6 else rng.choice((-3, -1, 1, 2, Fraction(1, 2)))
        rows.append(row)
    right = [[graph.symbol(f"r{i}"), rng.randint(-3, 3)] for i in range(n)]
    return rows, right


@each("seed", range(20))
@pytest.mark.parametrize(("n", "density"), [(1, 1), (2, 1), (4, 0.3), (5, 1), (8, 0.15)])
def test_the_solution_solves(seed, n, density):
    """A X = right, exactly."""
    rows, right = random_system(seed, n, density)
    X, _ = solution_by_minors(rows, right)
    rng = Random(seed)
    symbols = symbols_of([x for row in (*rows, *map(_by_place, right)) for x in row.values()])
    values = {x: Fraction(rng.choice((-1, 1)) * rng.randint(1, 3000), rng.randint(1, 9)) for x in symbols}
    for row, sides in zip(rows, right, strict=True):
        for k, side in enumerate(sides):
            total = sum((a * X[j][k] for j, a in row.items()), start=0)
            assert evaluate([total - side], values, RATIONAL) == [0]


def _by_place(row):
    return dict(enumerate(row))


def test_no_pivot_vanishes_where_the_determinant_does_not():
    """[[x, 1], [1, y]] at x = y = 0 is regular."""
    g = Graph()
    x, y, a, b, c, d = (g.symbol(name) for name in "xyabcd")
    X, blocks = solution_by_minors([{0: x, 1: a}, {0: b, 1: y}], [[c], [d]])
    values = dict(zip((x, y, a, b, c, d), map(Fraction, (0, 0, 2, 3, 4, 5)), strict=True))
    assert evaluate([X[0][0], X[1][0]], values, RATIONAL) == [Fraction(5, 3), 2]
    assert [block.unknowns for block in blocks] == [(0, 1)]


def test_blocks_are_as_small_as_can_be():
    """A chain of loops is solved loop by loop; what numbers determine is no block at all."""
    g = Graph()
    s = [g.symbol(f"s{k}") for k in range(7)]
    rows = [{0: s[0], 1: s[1]}, {0: s[2], 1: s[3]}, {1: s[4], 2: s[5]}, {2: s[6], 3: -1}]
    _, blocks = solution_by_minors(rows, [[1]] * 4)
    assert [(block.unknowns, block.equations) for block in blocks] == [((0, 1), (0, 1)), ((2,), (2,))]


def test_determinants_by_minors():
    """det of a 3 x 3 matrix of numbers, and of none."""
    assert determinant([[1, 2, 3], [0, 4, 5], [1, 0, 6]]) == 22
    assert determinant([]) == 1


def test_groups_come_after_what_they_need():
    """0 and 2 need one another, both need 1."""
    assert components([[2, 1], [], [0]]) == [[1], [0, 2]]


def test_equations_without_an_unknown_of_their_own_are_refused():
    """Two equations in one unknown do not determine two."""
    with pytest.raises(DerivationError, match="do not determine their unknowns"):
        matching([[0], [0]])


def test_a_block_that_is_too_large_is_refused():
    """2^n minors of n unknowns."""
    g = Graph()
    rows = [{j: g.symbol(f"x{i}_{j}") for j in range(11)} for i in range(11)]
    with pytest.raises(DerivationError, match="11 unknowns hang together"):
        solution_by_minors(rows, [[1]] * 11)
