"""Factorization and Program: what is computed, in which order, and how much it costs."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from each import each
from hand_made import cart_pole, pendulum, spring_row, symbols, tied_pendulum

import eomgen
from eomgen.codegen import lowering as layout
from eomgen.codegen.kernel_reader import solve_bordered
from eomgen.codegen.lowering import stripped
from eomgen.codegen.program import RESERVED, Assign, Program, Solve, identifier, identifiers, scheduled, traffic
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets.base import Role
from eomgen.codegen.targets.c import C, c_text
from eomgen.codegen.targets.numpy import PYTHON
from eomgen.codegen.written_files import vectors
from eomgen.errors import DerivationError
from eomgen.symbolic.exact.factorization import factor_solution, operation_count
from eomgen.symbolic.expression.derivatives import operations, order
from eomgen.symbolic.expression.formula import cos, sin
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import is_zero
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate, fifty_digits

MODELS = Path(__file__).parent.parent / "models"


def tree_mass_matrix(parents: list[int]):
    """A symbolic M with the zeros of a tree: M[i][j] is not 0 where one body carries the other."""
    g, n = Graph(), len(parents)
    ancestors = [{i} for i in range(n)]
    for i, parent in enumerate(parents):
        if parent >= 0:
            ancestors[i] |= ancestors[parent]
    M = [
        [g.symbol(f"m{max(i, j)}{min(i, j)}") if i in ancestors[j] or j in ancestors[i] else 0 for j in range(n)]
        for i in range(n)
    ]
    return M, [g.symbol(f"f{i}") for i in range(n)]


TREES = {
    "chain": [-1, 0, 1, 2, 3],
    "two arms": [-1, 0, 1, 0, 3, 0],
    "apart": [-1, -1, -1],
    "leaves first": [2, 2, 3, -1],
}


@each("parents", TREES.values())
def test_the_written_out_factorization_solves_the_system(parents):
    """M a = F at random positive definite M with the zeros of a tree, against numpy."""
    rng = np.random.default_rng(3)
    M, F = tree_mass_matrix(parents)
    a = factor_solution(M, F)
    n = len(F)
    mask = np.array([[not is_zero(entry) for entry in row] for row in M])
    for _ in range(5):
        B = np.tril(rng.normal(size=(n, n))) * mask
        numbers = B.T @ B + 0.1 * np.eye(n)
        f = rng.normal(size=n)
        values = {M[i][j]: numbers[i, j] for i in range(n) for j in range(n) if mask[i, j]}
        found = evaluate(a, values | dict(zip(F, f, strict=True)), FLOAT)
        assert np.allclose(np.where(mask, numbers, 0) @ found, f, rtol=1e-9, atol=1e-9)


def test_a_dense_factorization_of_seven_takes_224_operations():
    """Sum of d^2 + 6 d + 1 over d < 7: one quotient a partner, no repeated divisions."""
    M, F = tree_mass_matrix([-1, 0, 1, 2, 3, 4, 5])
    assert operations(factor_solution(M, F)).total == operation_count(M) == 224


def test_zeros_of_a_tree_stay_zeros():
    """Elimination from the leaves has no fill: a star of n costs O(n), whatever the order of its coordinates."""
    star, turned = [-1, 0, 0, 0, 0, 0], [5, 5, 5, 5, 5, -1]
    for parents in (star, turned):
        M, F = tree_mass_matrix(parents)
        assert operations(factor_solution(M, F)).total == operation_count(M) == 5 * (1 * 2 + 5 + 1) + 1


def test_a_row_without_inertia_is_refused():
    """M = [[m, 0], [0, 0]] has no inverse at any state."""
    g = Graph()
    with pytest.raises(DerivationError, match="row 2"):
        factor_solution([[g.symbol("m"), 0], [0, 0]], [1, 1])


def random_system(rng, n, k):
    B = rng.normal(size=(n, n))
    return B @ B.T + 0.1 * np.eye(n), rng.normal(size=(k, n)), rng.normal(size=n)


def full(n: int, k: int):
    """The lists of a solve in which nothing is known to be zero."""
    return Solve(((1,) * n,) * n, ((1,) * n,) * k, (), ()).tables


def solved_by_rows(M, J, f, g):
    n = len(f)
    found = solve_bordered(M.ravel().tolist(), J.ravel().tolist(), f.tolist(), g.tolist(), full(n, len(g)))
    return np.array(found[:n]), np.array(found[n:])


@each("k", [0, 1, 3])
def test_the_bordered_solve_satisfies_both_its_rows(k):
    """M a - J^T lam = f and J a = g."""
    rng = np.random.default_rng(k)
    M, J, f = random_system(rng, 4, k)
    g = rng.normal(size=k)
    a, lam = solved_by_rows(M, J, f, g)
    assert np.allclose(M @ a - J.T @ lam, f) and np.allclose(J @ a, g)


def test_accelerations_do_not_feel_that_a_tie_is_said_twice():
    """rank J < k: a is that of the independent rows, and J^T lam is the same force."""
    rng = np.random.default_rng(5)
    M, J, f = random_system(rng, 4, 2)
    g = rng.normal(size=2)
    a, lam = solved_by_rows(M, J, f, g)
    twice, gg = np.vstack([J, J[0] + 3 * J[1]]), np.append(g, g[0] + 3 * g[1])
    again, more = solved_by_rows(M, twice, f, gg)
    assert np.allclose(a, again) and np.allclose(J.T @ lam, twice.T @ more)


def test_a_massless_coordinate_that_a_tie_moves_has_an_acceleration():
    """M = diag(m, 0), J = [1, -1]: both move as one."""
    a, _ = solved_by_rows(np.diag([2.0, 0.0]), np.array([[1.0, -1.0]]), np.array([4.0, 0.0]), np.zeros(1))
    assert np.allclose(a, [2, 2])


def test_what_moves_no_mass_and_is_not_tied_has_no_acceleration():
    """M singular on J a = 0: nan, never a made-up number."""
    a, lam = solved_by_rows(np.diag([2.0, 0.0]), np.array([[1.0, 0.0]]), np.array([4.0, 1.0]), np.zeros(1))
    assert np.isnan(a).all() and np.isnan(lam).all()


def test_statements_come_after_what_they_need():
    """Every argument of a statement is an argument of the program, hoisted, or assigned before."""
    program = Program.right_hand_side(cart_pole(F=0))
    known = {program.symbols.t, *program.states, *program.symbols.parameters.values()}
    known |= set(program.symbols.inputs.values()) | {s.node for s in program.hoisted}
    for statement in program.statements:
        assert isinstance(statement, Assign)
        arguments = {a for a in statement.node.args if hasattr(a, "op")}
        assert {a.args[0] if a.op == "neg" else a for a in arguments} <= known
        known.add(statement.node)


def long_program(seed: int):
    """(what each reads, what is read at the end) of operations on what came before, a few of them calls."""
    rng, graph = random.Random(seed), Graph()
    nodes = [graph.symbol(f"x{k}") for k in range(5)]
    for _ in range(200):
        a, b = rng.choices(nodes if rng.random() < 0.3 else nodes[-30:], k=2)
        made = rng.choice((a + b, a * b, a - b, cos(a), a / b))
        nodes += [made] if type(made) is type(a) else []
    last = frozenset(nodes[-6:])
    return {x: stripped(x.args) if x.op != "symbol" else set() for x in order(last)}, last


@each("seed", range(8))
def test_a_schedule_has_every_statement_after_what_it_needs_and_moves_less(seed):
    """Each once; fewer loads and stores than in the order of making."""
    made, last = long_program(seed)
    needs = {x: needed for x, needed in made.items() if x.op != "symbol"}
    found = scheduled(needs, last)
    place = {x: k for k, x in enumerate(found)}
    assert sorted(found, key=lambda x: x.index) == list(needs)
    assert all(place[a] < place[x] for x in needs for a in needs[x] if a in place)
    assert traffic([*(made.keys() - needs.keys()), *found], made, last) < traffic(list(made), made, last)


def test_values_that_wait_in_registers_are_not_moved():
    """Thirty squares that are added up, each at once: no load, no store; all squares first, then the sums: many."""
    graph = Graph()
    x = [graph.symbol(f"x{k}") for k in range(30)]
    squares, total, sums = [a * a for a in x], 0, []
    for a in squares:
        total = total + a
        sums.append(total)
    last, made = {total}, {y: stripped(y.args) if y.op != "symbol" else set() for y in (*x, *squares, *sums[1:])}
    near = [x[0], squares[0], *(z for k in range(1, 30) for z in (x[k], squares[k], sums[k]))]
    assert traffic(near, made, last) == 0 < 30 < traffic(list(made), made, last)


@pytest.mark.slow
def test_a_schedule_changes_no_bit(monkeypatch):
    """The right-hand side in C at random states, scheduled and in the order of making."""
    program = eomgen.derive(MODELS / "arm3.toml").program
    texts, values = [], []
    for way in (scheduled, lambda needs, later: list(needs)):
        monkeypatch.setattr(layout, "scheduled", way)
        texts.append(c_text(program, "eomgen", Role.RHS))
        rhs = RightHandSide.of(program, "c")
        states = np.random.default_rng(1).normal(size=(20, len(program.states)))
        values.append([rhs(0.3, x, np.arange(1.0, 1 + len(program.symbols.parameters))).tolist() for x in states])
    assert texts[0] != texts[1] and values[0] == values[1]


def test_what_parameters_alone_determine_is_hoisted():
    """theta'' = -(m g l) sin(theta) / (m l^2): the products of parameters are computed once for given p."""
    program = Program.right_hand_side(pendulum())
    parameters = set(program.symbols.parameters.values())
    assert program.count.hoisted == len(program.hoisted) > 0
    assert program.count.total == 3  # sine, product, quotient
    for statement in program.hoisted:
        assert all(not hasattr(a, "op") or a.op != "symbol" or a in parameters for a in statement.node.args)


def test_the_cheaper_of_two_ways_is_taken():
    """Explicit accelerations are used where they cost less than the factorization, and only there."""
    given = cart_pole(F=0)
    s = given.symbols
    cheap, dear = (s.q[0], s.q[1]), tuple(sin(cos(sin(q + 1) + 1) * q) / (q + 2) for q in s.q + s.u)[:2]
    without = Program.right_hand_side(given).count.total
    shorter = Program.right_hand_side(replace(given, accelerations=cheap))
    assert shorter.outputs[2:] == cheap and shorter.count.total < without
    longer = tuple(dear[0] ** 7 * dear[1] ** 5 + sin(x * dear[0]) * cos(x + dear[1]) for x in s.q)
    assert Program.right_hand_side(replace(given, accelerations=longer)).count.total == without


def test_a_large_system_is_solved_in_a_loop_and_a_small_one_written_out():
    """Never unroll an O(n^3) solve: n = 12 is written out, n = 20 is one Solve statement."""
    kinds = {
        n: [s.kind for s in Program.right_hand_side(spring_row(n)).statements if isinstance(s, Solve)] for n in (12, 20)
    }
    assert kinds == {12: [], 20: ["dense"]}
    constraints = [s.kind for s in Program.right_hand_side(tied_pendulum()).statements if isinstance(s, Solve)]
    assert constraints == ["kkt"]


def test_a_symbol_that_is_no_argument_is_refused_by_name():
    """A program depends on t, x, p and inputs only."""
    s = symbols("x")
    with pytest.raises(DerivationError, match="'mass'"):
        Program.of([s.graph.symbol("mass") * s.q[0]], s)


def test_an_input_without_an_expression_is_refused_where_it_is_needed():
    """A number that nobody gave is never made up."""
    with pytest.raises(DerivationError, match="'F'"):
        Program.right_hand_side(cart_pole())
    s = cart_pole().symbols
    assert Program.of([s.q[0]], s).outputs == (s.q[0],)


def test_every_name_becomes_an_identifier_of_its_own():
    """No keyword, no function of math.h, no two alike; Greek letters spelled."""
    names = [
        "theta",
        "theta'",
        "theta_dot",
        "θ",
        "I",
        "int",
        "lambda",
        "x",
        "t",
        "v1",
        "sin",
        "solve_M",
        "ω₁",
        "m-1",
        "é",
    ]
    reserved = RESERVED | C.reserved | PYTHON.reserved
    words = identifiers(names, reserved)
    assert words["theta"] == "theta" and words["ω₁"] == "omega1" and words["m-1"] == "m_1" and words["é"] == "e"
    assert len(set(words.values())) == len(names)
    assert all(word.isidentifier() and word.isascii() and word not in reserved for word in words.values())
    assert not {"v1", "solve_M"} & set(words.values())
    assert identifier("7-axis arm") == "n7_axis_arm"


def random_name(rng: random.Random) -> str:
    return "".join(rng.choice("aIθω'_1x²ß漢") for _ in range(rng.randint(1, 6)))


def test_any_names_become_different_identifiers():
    """Whatever letters a name has."""
    rng = random.Random(2)
    names = {random_name(rng) for _ in range(300)}
    words = identifiers(names, RESERVED)
    assert len(set(words.values())) == len(names) and all(word.isidentifier() for word in words.values())


def test_a_loop_of_grams_and_tonnes_keeps_its_digits():
    """M a - J^T lam = f, J a = g with masses from 1 to 1e9: doubles against 50 digits"""
    rng = np.random.default_rng(5)
    size, rows = 5, 2
    A = rng.normal(size=(size, size))
    scale = np.logspace(0, 4.5, size)
    M = scale[:, None] * (A @ A.T + size * np.eye(size)) * scale
    M = M.ravel().tolist()
    J, f, g = rng.normal(size=rows * size).tolist(), rng.normal(size=size).tolist(), rng.normal(size=rows).tolist()
    exact = fifty_digits().number(1)
    tables = full(size, rows)
    long = solve_bordered(*([exact * x for x in values] for values in (M, J, f, g)), tables)
    assert solve_bordered(M, J, f, g, tables) == pytest.approx([float(x) for x in long], rel=1e-13)


@each("made", [pendulum, lambda: spring_row(20), tied_pendulum])
def test_what_holds_accelerations_takes_those_of_the_right_hand_side(made):
    """f(q, u, a) along the motion = f with the a that the right-hand side returns, by the same kind of solution."""
    equations = made()
    symbols = equations.symbols
    outputs = tuple(3 * a + x * u for a, x, u in zip(symbols.a, symbols.q, symbols.u, strict=True))
    rhs, along = Program.right_hand_side(equations), Program.in_motion(outputs, equations)
    kinds = [[type(s) for s in program.statements if type(s) is Solve] for program in (rhs, along)]
    assert kinds[0] == kinds[1]
    for v in vectors(rhs):
        n = len(symbols.q)
        right = [3 * a + x * u for a, x, u in zip(v.result[n:], v.x[:n], v.x[n:], strict=True)]
        assert RightHandSide.of(along, "numpy")(v.t, v.x, v.p) == pytest.approx(right, rel=1e-9, abs=1e-9)
