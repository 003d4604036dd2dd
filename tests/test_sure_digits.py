"""Values and equations at 50 digits by balls are those by mpmath, or there are none."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest

from eomgen.symbolic.expression.derivatives import gradient, jacobian
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric import sure_digits, tolerances
from eomgen.symbolic.numeric.arithmetic import balls
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits, solved_quickly, sums_of_products

NUMBER = fifty_digits().number
BY_MPMATH = replace(fifty_digits(), quickly=None)


def long_sum(graph: Graph):
    """A hundred terms of two symbols, their quotients, roots, sines and cosines."""
    x, y = graph.symbol("x"), graph.symbol("y")
    total = graph.sqrt(2) * x + (x - y) ** 3 - (2 + x * x) ** Fraction(-3, 2)
    for k in range(1, 100):
        total = total + graph.call("sin", k * x + y) * graph.call("cos", total) / (k + graph.sqrt(1 + x * x)) - y
    return total, x, y


def test_a_value_by_balls_is_that_by_mpmath():
    """f(x, y) by Arb = f(x, y) by mpmath to 40 digits; the same type of number."""
    graph = Graph()
    total, x, y = long_sum(graph)
    state = {x: NUMBER(1) / 3, y: NUMBER(-7) / 11}
    (quick,), (slow,) = evaluate([total], state, fifty_digits()), evaluate([total], state, BY_MPMATH)
    assert type(quick) is type(slow)
    assert abs(quick - slow) < tolerances.MET_AT_50 * abs(slow)


def test_what_has_no_value_is_refused_by_balls_too():
    """1/0 and sqrt(-1) deep inside a long sum: NoValue, as by mpmath."""
    graph = Graph()
    total, x, y = long_sum(graph)
    for wrong, state in (
        (total + 1 / (x - y), {x: NUMBER(2), y: NUMBER(2)}),
        (total + graph.sqrt(x - y), {x: NUMBER(2), y: NUMBER(3)}),
    ):
        with pytest.raises(NoValue):
            evaluate([wrong], state, BY_MPMATH)
        with pytest.raises(NoValue):
            evaluate([wrong], state, fifty_digits())


def test_what_cancels_is_left_to_mpmath():
    """(f + 10^80 x) - 10^80 z at x = z: no digit is left, no ball says that one is, and mpmath's own noise comes."""
    graph = Graph()
    total, x, y = long_sum(graph)
    lost = (total + 10**80 * x) - 10**80 * graph.symbol("z")
    state = {x: NUMBER(1) / 3, y: NUMBER(2) / 7, graph.symbol("z"): NUMBER(1) / 3}
    assert evaluate([lost], state, fifty_digits()) == evaluate([lost], state, BY_MPMATH)
    assert evaluate([total], state, fifty_digits()) != evaluate([lost], state, fifty_digits())


@pytest.mark.parametrize("digits", [30, 120])
def test_a_ball_holds_the_value_whichever_way_it_came(digits):
    """|x - x'| <= r + r' of Arb's ball and ours, both narrow; what was given with a radius stays as wide."""
    graph = Graph()
    total, x, y = long_sum(graph)
    narrow, arithmetic = balls(digits), replace(balls(digits), quickly=None)
    exact = {x: narrow.number(Fraction(1, 3)), y: narrow.number(Fraction(-7, 11))}
    wide = exact | {x: (exact[x][0], exact[x][0] * 0 + 1e-12)}
    for state, width in ((exact, 10 ** (12 - digits)), (wide, 1e-3)):
        (one,), (other,) = evaluate([total], state, narrow), evaluate([total], state, arithmetic)
        assert type(one[0]) is type(other[0]) and one != other  # not by the same way
        assert abs(one[0] - other[0]) <= one[1] + other[1] <= 2 * width * abs(one[0])
        assert one[1] > 1e-14 or state is exact


def test_nothing_is_said_by_balls_without_an_end():
    """1/(x - y) at x = y: none, as by mpmath; within 1e-12 of it: anything."""
    graph = Graph()
    total, x, y = long_sum(graph)
    two = balls(30).number(2)
    for width, ends in ((0.0, "nan"), (1e-12, "inf")):
        ((at, reach),) = evaluate([total + 1 / (x - y)], {x: (two[0], two[1] + width), y: two}, balls(30))
        assert str(at if ends == "nan" else reach) in (ends, f"+{ends}")


def test_sums_of_products_by_balls_are_those_by_mpmath(monkeypatch):
    """(row x, |row| |x|), of numbers of 50 digits and of doubles; a number beyond all size is left to mpmath."""
    rng = Random(2)
    rows = [
        [rng.choice((0.0, rng.uniform(-1, 1), NUMBER(rng.randint(-99, 99)) / 7)) for _ in range(7)] for _ in range(9)
    ]
    columns = [[NUMBER(rng.randint(-99, 99)) / 11 for _ in range(7)] for _ in range(2)]
    quick = sums_of_products(rows, columns)
    assert sure_digits.sums_by_balls(NUMBER(1).context, rows, columns) == quick
    assert sure_digits.sums_by_balls(NUMBER(1).context, [*rows, [NUMBER(1).context.inf] * 7], columns) is None
    monkeypatch.setattr(sure_digits, "ROWS", 10)  # too few to be handed over
    for one, other in zip(quick, sums_of_products(rows, columns), strict=True):
        for (sum_, size), (own, own_size) in zip(one, other, strict=True):
            assert (
                abs(sum_ - own) <= tolerances.MET_AT_50 * size
                and abs(size - own_size) <= tolerances.MET_AT_50 * size
                and size > 0
            )


def test_equations_by_balls_are_solved_and_singular_ones_are_not():
    """A x = b: what is left is rounding; a row that follows from another leaves nothing said."""
    rng = Random(1)
    n = 12
    rows = [[NUMBER(rng.randint(-99, 99)) / 7 for _ in range(n + 1)] for _ in range(n)]
    x = solved_quickly(rows)
    assert x is not None
    left = [sum(a * y for a, y in zip(row, x, strict=False)) - row[-1] for row in rows]
    assert max(map(abs, left)) < tolerances.MET_AT_50
    assert solved_quickly([*rows[:-1], [2 * a for a in rows[0]]]) is None
    assert solved_quickly(rows[:3]) is None


def test_a_jacobian_by_rows_is_that_by_columns():
    """Of a long matrix, swept from each output back, every entry is the derivative."""
    graph = Graph()
    n = 40
    angles = [graph.symbol(f"q{k}") for k in range(n)]
    waves, total = [], 0
    for q in angles:
        total = total + q
        waves.append(graph.call("sin", total))
    outputs = []
    for k in range(n):
        row = 0
        for j in range(k, n):
            row = row + (1 + j + k) * waves[j]
        outputs.append(row)
    found = jacobian(outputs, angles)
    assert found == tuple(gradient(x, angles) for x in outputs)  # by rows: they are the very nodes
    state = {q: NUMBER(k + 1) / 9 for k, q in enumerate(angles)}
    for i in (0, 17, 39):
        for j in (0, 20, 39):
            (value,) = evaluate([found[i][j]], state, BY_MPMATH)
            cosines = evaluate([graph.call("cos", sum(angles[: m + 1])) for m in range(n)], state, BY_MPMATH)
            expected = sum((1 + m + i) * cosines[m] for m in range(max(i, j), n))
            assert abs(value - expected) < tolerances.MET_AT_50 * 1000
