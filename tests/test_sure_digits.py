"""Values and equations at 50 digits by Arb are those by mpmath, or there are none."""

from __future__ import annotations

import operator
import pickle
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from random import Random

import mpmath
import numpy as np
import pytest

from eomgen.proof.small_motions import _determinant
from eomgen.symbolic.expression.derivatives import gradient, jacobian
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.arithmetic import balls, is_rounding
from eomgen.symbolic.numeric.digits import (
    ball_of,
    eigenpairs_in_digits,
    precision,
    real,
    solved_quickly,
    sums_of_products,
)
from eomgen.symbolic.numeric.evaluation import Arithmetic, NoValue, evaluate, fifty_digits

NUMBER = fifty_digits().number
STEP_BY_STEP = replace(fifty_digits(), quickly=None)
MP = mpmath.MPContext()
MP.dps = 50


def _none(x):
    raise NoValue(x.op)


BY_MPMATH = Arithmetic(
    "mpmath",
    lambda c: MP.mpf(c.numerator) / c.denominator,
    {"neg": operator.neg, "add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": operator.truediv}
    | {op: getattr(MP, op) for op in "sin cos".split()}
    | {"sqrt": lambda x: MP.sqrt(x) if x >= 0 else MP.mpf("1e400") / 0, "pow": operator.pow},
    _none,
)


def by_mpmath(scalar, state):
    """The value as one of 50 digits."""
    (value,) = evaluate([scalar], {x: MP.mpf(v) for x, v in state.items()}, BY_MPMATH)
    return NUMBER(Fraction(MP.nstr(value, 60)))


def long_sum(graph: Graph):
    """A hundred terms of two symbols, their quotients, roots, sines and cosines."""
    x, y = graph.symbol("x"), graph.symbol("y")
    total = graph.sqrt(2) * x + (x - y) ** 3 - (2 + x * x) ** Fraction(-3, 2)
    for k in range(1, 100):
        total = total + graph.call("sin", k * x + y) * graph.call("cos", total) / (k + graph.sqrt(1 + x * x)) - y
    return total, x, y


def test_a_value_is_that_by_mpmath():
    """f(x, y) by Arb, at once and step by step, = f(x, y) by mpmath to 40 digits."""
    graph = Graph()
    total, x, y = long_sum(graph)
    state = {x: NUMBER(1) / 3, y: NUMBER(-7) / 11}
    (quick,), (slow,) = evaluate([total], state, fifty_digits()), evaluate([total], state, STEP_BY_STEP)
    right = by_mpmath(total, state)
    assert type(quick) is type(slow)
    for value in (quick, slow):
        assert abs(value - right) < tolerances.MET_AT_50 * abs(right)


def test_what_has_no_value_is_refused():
    """1/0 and sqrt(-1) deep inside a long sum: NoValue, as by mpmath; nan, where nan is a value."""
    graph = Graph()
    total, x, y = long_sum(graph)
    for wrong, state in (
        (total + 1 / (x - y), {x: NUMBER(2), y: NUMBER(2)}),
        (total + graph.sqrt(x - y), {x: NUMBER(2), y: NUMBER(3)}),
    ):
        with pytest.raises(NoValue):
            by_mpmath(wrong, state)
        for arithmetic in (STEP_BY_STEP, fifty_digits()):
            with pytest.raises(NoValue):
                evaluate([wrong], state, arithmetic)
        (value,) = evaluate([wrong], state, fifty_digits(partial=True))
        assert value != value


def test_what_cancels_is_left_to_rounding():
    """(f + 10^80 x) - 10^80 z at x = z: no digit is left, no ball says that one is, and the steps' own noise comes."""
    graph = Graph()
    total, x, y = long_sum(graph)
    lost = (total + 10**80 * x) - 10**80 * graph.symbol("z")
    state = {x: NUMBER(1) / 3, y: NUMBER(2) / 7, graph.symbol("z"): NUMBER(1) / 3}
    assert evaluate([lost], state, fifty_digits()) == evaluate([lost], state, STEP_BY_STEP)
    assert evaluate([total], state, fifty_digits()) != evaluate([lost], state, fifty_digits())


@pytest.mark.parametrize("bits", [100, 400])
def test_a_ball_holds_the_value(bits):
    """|x - x'| <= r of a value of 400 bits more; narrow; what was given with a radius stays as wide."""
    graph = Graph()
    total, x, y = long_sum(graph)
    with precision(bits + 400):
        (true,) = evaluate([total], {x: ball_of(Fraction(1, 3)), y: ball_of(Fraction(-7, 11))}, balls())
    with precision(bits):
        exact = {x: ball_of(Fraction(1, 3)), y: ball_of(Fraction(-7, 11))}
        wide = exact | {x: ball_of(Fraction(1, 3), 1e-12)}
        for state, width in ((exact, 2.0 ** (40 - bits)), (wide, 1e-3)):
            (ball,) = evaluate([total], state, balls())
            assert ball.contains(true.mid()) and ball.rad() <= width * abs(true)
            assert ball.rad() > 1e-14 or state is exact


def test_nothing_is_said_by_balls_without_an_end():
    """1/(x - y) at x = y: none, as by mpmath; within 1e-12 of it: anything."""
    graph = Graph()
    total, x, y = long_sum(graph)
    for width in (0.0, 1e-12):
        (ball,) = evaluate([total + 1 / (x - y)], {x: ball_of(2, width), y: ball_of(2)}, balls())
        assert ball.is_nan() is (not width) and not ball.is_finite()


def test_a_rounded_number_holds_what_it_was_rounded_from():
    """x^2 - 2 at x = sqrt(2) of 50 digits may be 0; x^2 - 2 - 1e-45 may not."""
    x = Graph().symbol("x")
    at = {x: real(2).sqrt()}
    assert is_rounding((x * x - 2,), at) and not is_rounding((x * x - 2, x * x - 2 - Fraction(1, 10**45)), at)


def test_a_real_number_is_a_number():
    """Its arithmetic, order, hash, forms and pickle are those of the number that it is."""
    third = NUMBER(Fraction(1, 3))
    for made, right in (
        (1 - third, Fraction(2, 3)),
        (2 / third, 6),
        (np.float64(0.5) * third, Fraction(1, 6)),
        (third * np.int64(3), 1),
        (third**-2, 9),
        (2**third * 2 ** (1 - third), 2),
        (Fraction(1, 3) - third, 0),
        (abs(-third), Fraction(1, 3)),
    ):
        assert abs(made - NUMBER(right)) < tolerances.MET_AT_50
    assert NUMBER(2) == 2 == NUMBER(2) and NUMBER(2) != 3 and hash(NUMBER(2)) == hash(2) and not NUMBER(0)
    assert third < 0.5 and 1 > third and third >= third and sorted([third, NUMBER(-1), 0])[2] is third
    assert [int(NUMBER(Fraction(x, 2))) for x in (-5, 5, 2**90)] == [-2, 2, 2**89]
    assert pickle.loads(pickle.dumps(third)) == third
    assert third.decimal(5) == Decimal("0.33333") and NUMBER(Fraction(2, 3)).decimal(3) == Decimal("0.667")
    assert NUMBER(10**40).decimal(50) == 10**40
    for wrong in (lambda: third / 0, lambda: 1 / NUMBER(0), lambda: NUMBER(0) ** -1):
        with pytest.raises(ZeroDivisionError):
            wrong()
    with pytest.raises(TypeError):
        third + "1"


def test_sums_of_products_are_those_term_by_term():
    """(row x, |row| |x|), of numbers of 50 digits, doubles and whole numbers."""
    rng = Random(2)
    rows = [
        [rng.choice((0.0, 3, rng.uniform(-1, 1), NUMBER(rng.randint(-99, 99)) / 7)) for _ in range(7)] for _ in range(9)
    ]
    columns = [[NUMBER(rng.randint(-99, 99)) / 11 for _ in range(7)] for _ in range(2)]
    for column, pairs in zip(columns, sums_of_products(rows, columns), strict=True):
        for row, (total, size) in zip(rows, pairs, strict=True):
            terms = [a * b for a, b in zip(row, column, strict=True)]
            assert abs(total - sum(terms)) <= tolerances.MET_AT_50 * size and size > 0
            assert abs(size - sum(map(abs, terms))) <= tolerances.MET_AT_50 * size
    assert sums_of_products([], columns) == [[], []] and sums_of_products(rows, []) == []


def test_determinants_and_eigenvalues_are_those_by_mpmath():
    """det A; A v = lambda v; K v = w M v with v^T M v = 1, a double w and sizes 1e20 apart."""
    rng, n = Random(5), 6
    A = [[rng.uniform(-1, 1) * 10 ** (3 * i) for _ in range(n)] for i in range(n)]
    with mpmath.workdps(60):
        det = Fraction(mpmath.nstr(mpmath.det(mpmath.matrix(A)), 50))
        right = sorted(map(complex, mpmath.eig(mpmath.matrix(A), right=False)), key=lambda x: (abs(x), x.imag))
    assert abs(_determinant([list(map(NUMBER, row)) for row in A]) / det - 1) < tolerances.MET_AT_50
    assert _determinant([[NUMBER(1), NUMBER(2)], [NUMBER(2), NUMBER(4)]]) == 0
    values, vectors = eigenpairs_in_digits(A)
    assert sorted(values, key=lambda x: (abs(x), x.imag)) == pytest.approx(right, rel=1e-14)
    left = np.array(A) @ vectors - np.array(vectors) * values
    assert np.all(abs(left) <= 1e-13 * (abs(np.array(A)) @ abs(np.array(vectors))))
    L = np.tril([[rng.randint(1, 9) for _ in range(n)] for _ in range(n)]).astype(object)
    sizes = [1, 1, 10**5, 10**10, 10**15, 10**20]
    w, V = eigenpairs_in_digits((L @ np.diag(sizes).astype(object) @ L.T).tolist(), (L @ L.T).tolist())
    assert [float(x) for x in w] == pytest.approx(sizes, rel=1e-15)
    V = np.array(V, dtype=object)
    assert abs(V.T @ L @ L.T @ V - np.eye(n)).max() < 1e-30


def test_equations_are_solved_and_singular_ones_are_not():
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
            value = by_mpmath(found[i][j], state)
            cosines = evaluate([graph.call("cos", sum(angles[: m + 1])) for m in range(n)], state, STEP_BY_STEP)
            expected = sum((1 + m + i) * cosines[m] for m in range(max(i, j), n))
            assert abs(value - expected) < tolerances.MET_AT_50 * 1000
