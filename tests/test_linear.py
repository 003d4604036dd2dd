"""Sparse linear equations over the graph: solved without dividing by what vanishes where they are regular."""

from __future__ import annotations

from fractions import Fraction

from each import each

from eomgen.symbolic.exact.equality import equal_at_random_states, equal_at_real_states
from eomgen.symbolic.exact.linear import LinearSystem, Pivots
from eomgen.symbolic.expression.derivatives import symbols_of
from eomgen.symbolic.expression.formula import cos, function, sin, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits


def system(rows, right, unknowns, **how):
    """The solution, shadows at a fixed state."""
    number = fifty_digits().number

    def values(scalars):
        state = {x: number(Fraction(7 + 3 * k, 11)) for k, x in enumerate(symbols_of(scalars))}
        return evaluate(scalars, state, fifty_digits())

    return LinearSystem(rows, right, unknowns, values).eliminated(Pivots(**how))


def rank(a) -> int:
    return 0 if type(a) is not Node else 2


def test_a_force_along_a_direction_is_found_without_dividing_by_its_components():
    """-sin T = b1, cos T = b2: T = -sin b1 + cos b2, also where sin = 0."""
    g = Graph()
    theta, b = g.symbol("theta"), [g.symbol("b1"), g.symbol("b2")]
    solution = system([{0: -sin(theta)}, {0: cos(theta)}], b, 1, rank=rank, sure=1)
    assert solution.determined(0) and len(solution.left) == 1
    assert equal_at_random_states([(solution.constants[0], -sin(theta) * b[0] + cos(theta) * b[1])]).equal
    divided = system([{0: -sin(theta)}, {0: cos(theta)}], b, 1, rank=rank)
    assert not equal_at_random_states([(divided.constants[0], solution.constants[0])]).equal  # only for consistent b


def test_a_small_coefficient_is_none_the_less_one():
    """x + r sin(t) y = 0, y = b: x = -r sin(t) b, also at r = 1e-40, beside which 50 digits of others end."""
    g = Graph()
    r, theta, b = g.symbol("r"), g.symbol("theta"), g.symbol("b")
    state = {r: fifty_digits().number(Fraction(1, 10**40)), theta: fifty_digits().number(1)}
    rows = LinearSystem([{0: 1, 1: r * sin(theta)}, {1: 1}], [0, b], 2, lambda x: evaluate(x, state, fifty_digits()))
    found = rows.eliminated(Pivots(rank=rank, sure=1, factors=[r])).constants
    assert equal_at_random_states([(found[0], -r * sin(theta) * b)]).equal
    state[theta] = state[r]  # an angle that constraints hold at 0, in numbers of 50 digits
    assert rows.eliminated(Pivots(rank=rank, sure=1, factors=[r])).constants[0] == 0


def test_what_vanishes_where_ties_hold_and_not_beside_stays_and_is_no_pivot():
    """x + s y = b1, c x + y = b2, s = 0 on the constraints: (1 - c s) y = b2 - c b1 off them too; zeros throughout
    go."""
    g = Graph()
    s, c, b = g.symbol("s"), g.symbol("c"), [g.symbol("b1"), g.symbol("b2")]
    state = {s: fifty_digits().number(0), c: fifty_digits().number(2)}
    nothing = sin(c) * sin(c) + cos(c) * cos(c) - 1
    lines = [{0: 1, 1: s}, {0: c, 1: 1, 2: nothing}, {1: nothing, 2: s + 1}]
    rows = LinearSystem(lines, [*b, 3], 3, lambda x: evaluate(x, state, fifty_digits()))
    found = rows.eliminated(Pivots(vanishes=lambda x: equal_at_random_states([(x, 0)]).equal)).constants
    assert equal_at_random_states([(found[1] * (1 - c * s), b[1] - c * b[0]), (found[0], b[0] - s * found[1])]).equal
    assert found[2] == 3 / (s + 1)


@each("size", [lambda s: sqrt(s * s), lambda s: function("abs", s)])
def test_what_vanishes_in_the_piece_of_one_state_is_not_zero_in_the_others(size):
    """x + (s + |s|) y = b, y = c: x = b - (s + |s|) c, though the shadow is taken where s < 0."""
    g = Graph()
    s, b, c = g.symbol("s"), g.symbol("b"), g.symbol("c")
    state = {s: fifty_digits().number(-2)}
    rows = LinearSystem([{0: 1, 1: s + size(s)}, {1: 1}], [b, c], 2, lambda x: evaluate(x, state, fifty_digits()))
    found = rows.eliminated(Pivots()).constants
    assert equal_at_real_states([(found[0], b - (s + size(s)) * c)], states=8).equal


@each("sure", [None, 1])
def test_what_is_indeterminate_stays_so(sure):
    """One row for two unknowns: the second is free, the first follows from it; a third is determined all the same."""
    g = Graph()
    theta, b, c = g.symbol("theta"), g.symbol("b"), g.symbol("c")
    rows = [{0: cos(theta), 1: sin(theta)}, {2: sin(theta)}]
    solution = system(rows, [b, c], 3, rank=rank, sure=sure)
    assert len(solution.free) == 1 and solution.determined(2) and not solution.determined(0)
    assert equal_at_random_states([(solution.constants[2], c / sin(theta))]).equal


@each("pivot, worst", [(1, 0), ("theta", None)])
def test_where_all_pivots_are_sure_nothing_waits_for_normal_equations(pivot, worst):
    """Pivots of rank <= sure, one after the other: the solution is that without such a bound, and says so."""
    g = Graph()
    theta, a, b, c = (g.symbol(name) for name in ("theta", "a", "b", "c"))
    rows = [{0: 2, 1: sin(theta)}, {1: pivot if pivot == 1 else cos(theta), 2: a}, {2: -3}]
    bound, free = (system(rows, [a, b, c], 3, rank=rank, sure=sure) for sure in (1, None))
    assert bound.worst == worst and (free.worst == 0) is (worst == 0)
    assert (bound.constants == free.constants and bound.shares == free.shares) or worst is None


def test_numbers_go_before_normal_equations():
    """x0 = b - c x1 stays as it is; the two rows of x1 alone are brought together."""
    g = Graph()
    theta, b = g.symbol("theta"), [g.symbol(name) for name in ("b0", "b1", "b2")]
    s, c = sin(theta), cos(theta)
    solution = system([{0: 1, 1: c}, {1: s}, {1: c, 0: 1}], [b[0], b[1], b[0]], 2, rank=rank, sure=1)
    assert solution.determined(0) and solution.determined(1)
    assert equal_at_random_states([(solution.constants[0] + c * solution.constants[1], b[0])]).equal


def test_a_normal_reaction_with_friction_is_tested_by_its_push_alone():
    """(n + mu t) N = b with n = (-sin, cos), t = -(cos, sin): n . (n + mu t) = 1, and N = n . b."""
    g = Graph()
    theta, mu, b = g.symbol("theta"), g.symbol("mu"), [g.symbol("b1"), g.symbol("b2")]
    s, c = sin(theta), cos(theta)
    rows = [{0: -s - mu * c}, {0: c - mu * s}]
    solution = system(rows, b, 1, rank=rank, sure=1, tests=[{0: -s}, {0: c}])
    assert equal_at_random_states([(solution.constants[0], -s * b[0] + c * b[1])]).equal
