"""The solve along what is not zero, and long programs cut into functions: the same numbers as without."""

from __future__ import annotations

import re
import runpy
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hand_made import equations_of, spring_row, symbols
from slow_run import sampled
from tools import RUN_HERE, each_target, marked

import eomgen
from eomgen.codegen import kernels
from eomgen.codegen.kernel_reader import solve_bordered
from eomgen.codegen.lowering import statements
from eomgen.codegen.program import Program, Solve
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets.c import C, c_text
from eomgen.codegen.written_files import vectors
from eomgen.mechanics.dynamics.system import EquationsOfMotion
from eomgen.study.programs import slopes_of
from eomgen.symbolic.exact.factorization import Zeros
from eomgen.symbolic.expression.formula import cos, sin
from eomgen.symbolic.expression.node import is_zero
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow
MODELS = Path(__file__).parent.parent / "models"


def legs_under_a_plate(legs: int, *, massless: bool = False, twice: bool = False) -> EquationsOfMotion:
    """A plate of three coupled coordinates on legs of two each; two rows constraint each leg to it, `twice` says all
    twice."""
    names = [f"p{i}" for i in range(3)] + [f"l{i}{j}" for i in range(legs) for j in range(2)]
    s = symbols(" ".join(names), "m", constraints=2 * legs * (2 if twice else 1))
    (m,), q, n = s.parameters.values(), s.q, len(names)
    M = [[0] * n for _ in range(n)]
    for i in range(3):
        for j in range(3):
            M[i][j] = 5 * m if i == j else m * cos(q[i] - q[j]) if i > j else m * cos(q[j] - q[i])
    for i in range(3, n):
        M[i][i] = 0 if massless else m * (2 + sin(q[i]))
    rows = []
    for leg in range(legs):
        for j in range(2):
            row = [0] * n
            row[:3] = [sin(q[0] + leg + j), cos(q[1] * (leg + 1)), 1 + j * q[2]]
            row[3 + 2 * leg + j] = -1 - q[3 + 2 * leg] ** 2
            row[3 + 2 * leg + 1 - j] = q[3 + 2 * leg + j] / 4
            rows.append(row)
    rows += [[3 * x for x in row] for row in rows] if twice else []
    gamma = [sum((x * u * u for x, u in zip(row, s.u, strict=True) if not is_zero(x)), start=0) for row in rows]
    force = [-x - u / 3 for x, u in zip(q, s.u, strict=True)]
    return equations_of(s, M, [0] * n, force, J=rows, gamma=gamma)


CASES = {
    "legs": {"legs": 4},
    "massless legs": {"legs": 4, "massless": True},
    "every constraint said twice": {"legs": 3, "twice": True},
    "massless legs, every constraint said twice": {"legs": 3, "massless": True, "twice": True},
}
each_case = pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())


def at(made: EquationsOfMotion, t: float, x: tuple[float, ...], p: tuple[float, ...]):
    """M, J, forcing and -gamma as arrays."""
    values = [*(e for row in made.M for e in row), *(e for row in made.J for e in row), *made.forcing, *made.gamma]
    found = RightHandSide.of(Program.of(values, made.symbols), "numpy")(t, x, p)
    n, k = len(made.M), len(made.J)
    M, J, f, gamma = np.split(found, np.cumsum([n * n, k * n, n]))
    return M.reshape(n, n), J.reshape(k, n), f, -gamma


@cache
def whole_systems(case: str):
    """(program, states, accelerations there by numpy's least squares of the whole system), for all languages once."""
    made = legs_under_a_plate(**CASES[case])
    n, k = len(made.M), len(made.J)
    states = [np.random.default_rng(seed).uniform(-0.6, 0.6, size=2 * n) for seed in range(5)]
    found = []
    for x in states:
        M, J, f, g = at(made, 0.0, x, [1.7])
        whole = np.block([[M, -J.T], [J, np.zeros((k, k))]])
        found.append(np.linalg.lstsq(whole, np.concatenate([f, g]), rcond=1e-11)[0][:n])
    return Program.right_hand_side(made), states, found


@sampled(4)
@each_target
@pytest.mark.parametrize("case", CASES)
def test_accelerations_are_those_of_the_whole_system(target, case):
    """[[M, -J^T], [J, 0]] [a; lam] = [f; g] by numpy's least squares, no zeros used."""
    program, states, expected = whole_systems(case)
    rhs = RightHandSide.of(program, target)
    for x, a in zip(states, expected, strict=True):
        assert rhs(0.0, x, [1.7])[len(a) :] == pytest.approx(a, rel=1e-8, abs=1e-8)


@cache
def with_vectors(case: str):
    """(program, its vectors), for all languages once."""
    program = whole_systems(case)[0]
    return program, vectors(program)


@each_target
@pytest.mark.parametrize("case", CASES)
def test_emitted_solves_agree_with_fifty_digits(target, case):
    """dx of every case."""
    program, told = with_vectors(case)
    function = RightHandSide.of(program, target)
    for v in told:
        assert np.abs(function(v.t, v.x, v.p) - v.result).max() <= v.tolerance * max(1, *map(abs, v.result))


def turning_bars(n: int = 13) -> EquationsOfMotion:
    """Bars on one another by their angles: every entry of M turns, and it is factored in a loop."""
    s = symbols(" ".join(f"q{i}" for i in range(n)))
    M = [[cos(a - b) + (3 if a is b else 0) for b in s.q] for a in s.q]
    return equations_of(s, M, [0] * n, [-sin(a) - u / 3 for a, u in zip(s.q, s.u, strict=True)])


MANY = {"a full matrix": turning_bars, "massless legs": lambda: legs_under_a_plate(2, massless=True)}


@cache
def slopes_by_differences(name: str):
    """(program of A = df/dx, a state, parameters, the differences of f there), for all languages once."""
    made = MANY[name]()
    found = slopes_of(made)
    assert len(found.solves) > 1
    program = found.program(made)
    rhs, n = RightHandSide.of(Program.right_hand_side(made), "numpy"), 2 * len(made.M)
    x, h, p = np.random.default_rng(1).uniform(-0.3, 0.3, n), 1e-5, [1.7] * len(made.symbols.parameters)
    moved = [(rhs(0.0, x + h * e, p) - rhs(0.0, x - h * e, p)) / (2 * h) for e in np.eye(n)]
    return program, x, p, np.transpose(moved)


@sampled(2)
@marked(name for name in RUN_HERE if name not in ("jax", "numba", "fmu"))  # which take long, by the texts of others
@pytest.mark.parametrize("name", MANY)
def test_many_right_sides_have_one_factorization(target, name):
    """A = df/dx by the solve of the motion, factored once in the text, in every language: the differences of f."""
    program, x, p, moved = slopes_by_differences(name)
    once = re.findall(r"^ +solve_(?:factors|plain)\(", c_text(program, "m"), flags=re.MULTILINE)
    assert len(once) == 1
    function, n = RightHandSide.of(program, target), len(x)
    A = function(0.0, x, p).reshape(n, n)
    assert moved == pytest.approx(A, rel=1e-7, abs=1e-7)
    assert function.many([0.0, 0.0], [x, x], p)[1].reshape(n, n) == pytest.approx(A, rel=1e-11, abs=1e-11)


@each_case
def test_nothing_is_lost_along_the_lists(case):
    """A solve that knows its zeros and one that knows none give the same a, whichever of the two factors it takes."""
    made = legs_under_a_plate(**case)
    solve = Solve.bordered(made)
    x = np.random.default_rng(7).uniform(-0.6, 0.6, size=2 * len(made.M))
    M, J, f, g = at(made, 0.0, x, [0.9])
    order = [made.symbols.a.index(a) for a in solve.unknowns[: len(f)]]
    rows = [made.symbols.lam.index(lam) for lam in solve.unknowns[len(f) :]]
    pairs = (M[np.ix_(order, order)], J[np.ix_(rows, order)], f[order], g[rows])
    arguments = [array.ravel().tolist() for array in pairs]
    full = Solve(((1,) * len(f),) * len(f), ((1,) * len(f),) * len(g), (), ())
    known, unknown = solve_bordered(*arguments, solve.tables), solve_bordered(*arguments, full.tables)
    assert known[: len(f)] == pytest.approx(unknown[: len(f)], rel=1e-10, abs=1e-10)


@each_case
def test_nothing_is_read_beside_the_lists(case, monkeypatch):
    """a(M, J) does not change by a bit where all that the factors leave 0, and all room, holds no number."""
    made = legs_under_a_plate(**case)
    solve, x = Solve.bordered(made), np.random.default_rng(7).uniform(-0.6, 0.6, size=2 * len(made.M))
    entries = (*(e for row in solve.matrix for e in row), *(e for row in solve.border for e in row), *solve.right)
    values = RightHandSide.of(Program.of(entries, made.symbols), "numpy")(0.0, x, [0.9]).tolist()
    n, k = len(solve.matrix), len(solve.border)
    M, J, right = values[: n * n], values[n * n : n * (n + k)], values[n * (n + k) :]
    whole = solve_bordered(M, J, right[:n], right[n:], solve.tables)
    monkeypatch.setattr(kernels, "room", lambda size: [float("nan")] * size)
    for numbers, places in zip((M, J), solve.places, strict=True):
        numbers[:] = [value if at in places else float("nan") for at, value in enumerate(numbers)]
    assert solve_bordered(M, J, right[:n], right[n:], solve.tables) == whole


@pytest.mark.parametrize("seed", range(6))
def test_the_lists_hold_what_elimination_fills_in(seed):
    """L of M = L D L^T and L^-1 J^T, by numpy at random numbers, are not zero there, and nowhere else."""
    rng = np.random.default_rng(seed)
    mask = rng.random((9, 9)) < 0.1
    mask = np.tril(mask | mask.T, -1)
    touched = (rng.random((5, 9)) < 0.2) | np.eye(5, 9, dtype=bool)
    M = [[int(i == j or mask[max(i, j), min(i, j)]) for j in range(9)] for i in range(9)]
    rows = touched.astype(int).tolist()
    half = np.where(mask, rng.uniform(0.1, 1, (9, 9)), 0)
    for zeros, W in ((Zeros.of(M, rows), 0.0), (Zeros.with_constraints(M, rows), 1.0)):
        J = np.where(touched, rng.uniform(0.1, 1, (5, 9)), 0)
        numbers = half + half.T + 20 * np.eye(9) + W * J.T @ J
        C = np.linalg.cholesky(numbers)
        found = [tuple(i for i in range(j + 1, 9) if abs(C[i, j]) > 1e-14) for j in range(9)]
        reach = [tuple(np.flatnonzero(np.abs(row) > 1e-14)) for row in np.linalg.solve(C, J.T).T]
        assert zeros.partners == tuple(found) and zeros.reach == tuple(reach)
        Y = np.linalg.solve(C, J.T)
        factor = np.linalg.cholesky(Y.T @ Y)
        later = [tuple(i for i in range(m + 1, len(J)) if abs(factor[i, m]) > 1e-14) for m in range(len(J))]
        assert zeros.later == tuple(later)


def test_a_leg_more_costs_what_a_leg_costs():
    """Legs meet only in the plate: L fills in nowhere, and without the multipliers the operations grow in step."""
    degrees = [sum(map(len, Solve.bordered(legs_under_a_plate(n)).zeros[0].partners)) for n in (2, 4, 8)]
    assert degrees == [3, 3, 3]
    assert [len(reach) for reach in Solve.bordered(legs_under_a_plate(4)).zeros[0].reach] == [5] * 8


class Counted(float):
    """A number whose operations are counted."""

    made = 0

    @staticmethod
    def _of(name):
        def operation(self, other):
            Counted.made += 1
            return Counted(getattr(float, name)(self, float(other)))

        return operation

    __add__, __sub__, __mul__, __truediv__ = map(_of, ("__add__", "__sub__", "__mul__", "__truediv__"))
    __radd__, __rsub__, __rmul__, __rtruediv__ = map(_of, ("__radd__", "__rsub__", "__rmul__", "__rtruediv__"))

    def __neg__(self):
        return Counted(-float(self))


def row_of_four_bars(n: int) -> eomgen.Model:
    """n loops side by side."""
    return eomgen.loads(runpy.run_path(str(MODELS / "four_bars.py"))["four_bars"](n))


def solved_with_counts(n: int) -> tuple[int, int]:
    """(operations that the kernel makes for n loops at the start, those that are told of it)."""
    equations = eomgen.derive(row_of_four_bars(n))
    solve = next(s for s in equations.program.statements if isinstance(s, Solve))
    s = equations.graph.symbols
    state = dict(zip((*s.q, *s.u), map(float, equations.start()), strict=True))
    state |= dict(zip(s.parameters.values(), (1.0, 1.0, 9.81), strict=True)) | {s.t: 0.0}
    flat = [x for row in (*solve.matrix, *solve.border, solve.right) for x in row]
    values = list(map(Counted, evaluate(flat, state, FLOAT)))
    N, K = len(solve.matrix), len(solve.border)
    cuts = (values[: N * N], values[N * N : N * (N + K)], values[N * (N + K) : N * (N + K) + N], values[-K:])
    Counted.made = 0
    a = solve_bordered(*cuts, solve.tables)[:N]
    done = Counted.made
    M, J, f, g = (np.array(list(map(float, x))) for x in cuts)
    M, J = M.reshape(N, N), J.reshape(K, N)
    whole = np.block([[M, -J.T], [J, np.zeros((K, K))]])
    assert list(map(float, a)) == pytest.approx(np.linalg.solve(whole, np.append(f, g))[:N], rel=1e-9, abs=1e-9)
    return done, solve.operations


def test_a_loop_more_costs_what_a_loop_costs():
    """A row of n four-bars: as many operations a loop of 20 as of 10, and no fewer are told than are made."""
    (ten, reported), (twenty, reported_of_twenty) = solved_with_counts(10), solved_with_counts(20)
    assert twenty / 20 == pytest.approx(ten / 10, rel=0.05)
    assert reported_of_twenty / 20 == pytest.approx(reported / 10, rel=0.05)
    assert 0.8 < ten / reported < 1.3


def test_forty_loops_take_forty_thousand_operations_at_most():
    """The whole right-hand side, forces and all."""
    assert eomgen.derive(row_of_four_bars(40)).program.count.total <= 40_000


NEAR = {
    "waits, and counts": [(1, 0, 0), (1, 1e-3, 0), (0.3, 0.5, 0.8)],
    "waits, and follows": [(1, 0, 0), (1, 1e-3, 0), (0.3, 0.5, 0)],
    "two wait": [(0.2, 1, 0), (0.2, 1, 1e-3), (0, 0.3, 1), (1, 0.1, 0.1), (0.3, 0.5, 0.8)],
    "all of it hangs on two that are near": [
        (1, 0, 0),
        (1, 1e-5, 0),
        (1, 2e-5, 1e-5),
        (0.3, 0.5, 0.8),
        (-0.2, 0.9, 0.4),
    ],
}


@pytest.mark.parametrize("rows", NEAR.values(), ids=NEAR.keys())
def test_rows_that_nearly_depend_wait_for_the_others(rows):
    """Three masses of 1: a and J^T lam are those of least squares, and no multiplier is a quotient of rounding."""
    J, f, k = np.array(rows, dtype=float), np.array([1.0, 2.0, 3.0]), len(rows)
    ones = Solve(((1,) * 3,) * 3, ((1,) * 3,) * k, (), ())
    found = solve_bordered(np.eye(3).ravel().tolist(), J.ravel().tolist(), f.tolist(), [0.0] * k, ones.tables)
    a, lam = np.array(found[:3]), np.array(found[3:])
    assert a == pytest.approx(f - np.linalg.pinv(J, rcond=1e-9) @ (J @ f), abs=1e-9)
    assert a - J.T @ lam == pytest.approx(f, abs=1e-9)
    assert np.max(np.abs(lam)) < 1e4


def pieces(program: Program) -> int:
    """How many parts C cuts a program into."""
    return sum(function.apart for function in statements(program, C, "dx").bodies)


def long_row(n: int) -> EquationsOfMotion:
    """A full row of springs whose forces are long: solved in a loop, with more before it than C has in a function."""
    made = spring_row(n)
    q, u = made.symbols.q, made.symbols.u
    x, forces = q[0], []
    for i in range(C.longest // 4):
        x = sin(x + i) * cos(q[i % n]) + u[i % n] / 7
        forces.append(x)
    forcing = tuple(f + sum(forces[i::n], start=0) for i, f in enumerate(made.forcing))
    return equations_of(made.symbols, made.M, [0] * n, forcing)


@cache
def long_program(n: int):
    """(program in parts, its vectors), for all languages once."""
    program = Program.right_hand_side(long_row(n))
    assert pieces(program) > 2
    assert any(isinstance(s, Solve) for s in program.statements) is (n == 20)
    return program, vectors(program, count=2)


@sampled(4)
@each_target
@pytest.mark.parametrize("n", [3, 20], ids=["written out", "solve"])
def test_a_long_program_in_parts_returns_what_its_graph_does(target, n):
    """Parts hand each other what they share: dx against 50 digits."""
    program, told = long_program(n)
    function = RightHandSide.of(program, target)
    for v in told:
        assert np.abs(function(v.t, v.x, v.p) - v.result).max() <= v.tolerance * max(1, *map(abs, v.result))


def test_a_tree_of_twenty_bodies_in_space_is_cut_and_runs():
    """Twenty hinged bodies, axes of all directions: C = numpy, with inputs given or not."""
    text = ["eomgen = 1", 'space = "space"', "parameters = { g = 9.81, l = 0.3 }", "[inputs]", 'F = "sin(t)"']
    text += ["[coordinates]", *(f"q{i} = {0.1 * (i % 7) - 0.3:.1f}" for i in range(20))]
    for i in range(20):
        on = f'on = "b{(2 * i) // 3}.end", ' if i else ""
        axis = ([1, 0, 0], [0, 1, 0], [1, 2, 2])[i % 3]
        drive = ', torque = "F"' if i == 12 else ""
        text += [
            f"[bodies.b{i}]",
            f"mass = {1 + i % 3}",
            'center = [0.02, 0, "l/2"]',
            "inertia = [0.02, 0.03, 0.01]",
            'points = { end = [0, 0, "l"] }',
            f'joint = {{ kind = "revolute", {on}axis = {axis}, angle = "q{i}"{drive} }}',
        ]
    text += ["[forces.weight]", 'kind = "gravity"', 'acceleration = [0, 0, "-g"]']
    equations = eomgen.derive(eomgen.loads("\n".join(text)))
    assert pieces(equations.program) > 0
    in_c, in_numpy = equations.rhs("c"), equations.rhs("numpy")
    x = in_c.x0 + np.random.default_rng(3).normal(size=40) / 3
    for inputs in ((), (0.7,)):
        found, right = in_c(0.4, x, in_c.p0, inputs), in_numpy(0.4, x, in_c.p0, inputs)
        assert np.abs(found - right).max() <= 1e-10 * np.abs(right).max()
    assert np.abs(in_c(0.4, x, in_c.p0) - in_c(0.4, x, in_c.p0, (0.7,))).max() > 1e-3
