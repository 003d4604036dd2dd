"""Program -> right answers at random states, in 50 digits: what emitted code is held against."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from eomgen.codegen.kernel_reader import solve_bordered
from eomgen.codegen.program import Program, Solve
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.codegen.spheres import on_spheres, spheres_of
from eomgen.codegen.targets.base import TestVector
from eomgen.errors import DerivationError
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import Arithmetic, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, SOLVED

TRIES = 60
PARTIAL = 2  # states, at most, at which some result has no value
NEAR = Fraction(1, 10**6)  # of a state: so far from it, what has no value there has none either


def vectors(
    program: Program,
    *,
    x0: Any = None,
    p0: Any = None,
    count: int = 6,
    seed: int = 1,
    held: Sequence[tuple[float, Sequence[float], Sequence[float]]] = (),
) -> tuple[TestVector, ...]:
    """Right answers near the start (else near 0), half of them with inputs given where there are any; and there.

    Args:
        x0, p0: start and parameter values; where None, states near 0 and parameters between 0.5 and 2.
        held: (t, x, p) at which all ties hold: right answers there too.
    Raises:
        DerivationError: no states were found at which the right-hand side has a value.
    """
    rng = random.Random(seed)
    floats = compiled(program, "numpy")
    found: list[TestVector] = []
    partial: list[TestVector] = []
    for _ in range(TRIES):
        if len(found) == count:
            break
        vector = _vector(program, floats, _state(program, rng, x0, p0, with_inputs=len(found) % 2 == 1))
        if vector is not None:
            (found if all(value == value for value in vector.result) else partial).append(vector)
    if not found:
        raise DerivationError(
            "the equations have no value at any of the states tried for test vectors",
            mend="give a start, and parameters, at which the equations have values",
        )
    where_held = [replace(found[0], t=t, x=tuple(x), p=tuple(p), inputs=None, result=()) for t, x, p in held]
    states = (*where_held, *_special(program, found[0], x0))
    special = (_vector(program, floats, state) for state in states)
    return (*found, *(vector for vector in special if vector is not None), *partial[:PARTIAL])


def _special(program: Program, like: TestVector, x0: Any) -> list[TestVector]:
    """Where pieces and singular positions are met: the start itself, and at rest there; without one, all zero."""
    x = tuple([0.0] * len(program.states) if x0 is None else [float(v) for v in x0])
    nq = len(program.symbols.q)
    states = dict.fromkeys([x, (*x[:nq], *(0.0 for _ in x[nq:]))])
    return [replace(like, t=0.0, x=state, inputs=None, result=()) for state in states]


def outputs_at(program: Program, values: dict[Node, Any], arithmetic: Arithmetic) -> list[Any]:
    """The program's outputs in any arithmetic.

    Args:
        values: of t, x, p, and of inputs that are given; the others follow from their own expressions.
    """
    inputs = list(program.symbols.inputs.values())
    missing = [x for x in inputs if x not in values]
    own = [program.defaults[inputs.index(x)] for x in missing]
    values = values | dict(zip(missing, evaluate(own, values, arithmetic), strict=True))
    for solve in (s for s in program.statements if type(s) is Solve):
        values = values | _solved(solve, evaluate(solve.entries, values, arithmetic))
    return evaluate(program.outputs, values, arithmetic)


def _solved(solve: Solve, entries: Sequence[Any]) -> dict[Node, Any]:
    n, k = len(solve.matrix), len(solve.border)
    rows = n * (n + 1) // 2
    M = [entries[max(i, j) * (max(i, j) + 1) // 2 + min(i, j)] for i in range(n) for j in range(n)]
    J, right = entries[rows : rows + k * n], entries[rows + k * n :]
    return dict(zip(solve.unknowns, solve_bordered(M, J, right[:n], right[n:], solve.tables), strict=True))


def _state(program: Program, rng: random.Random, x0: Any, p0: Any, with_inputs: bool) -> TestVector:
    """A state without its answer; short decimals, for the reader."""
    symbols = program.symbols
    start = [0.0] * len(program.states) if x0 is None else [float(v) for v in x0]
    x = tuple(on_spheres([round(v + rng.uniform(-1, 1), 3) for v in start], spheres_of(program)).tolist())
    p = tuple(round(rng.uniform(0.5, 2), 3) for _ in symbols.parameters) if p0 is None else tuple(map(float, p0))
    inputs = tuple(round(rng.uniform(-1, 1), 3) for _ in symbols.inputs)
    t, a = round(rng.uniform(0, 2), 3), tuple(round(rng.uniform(-2, 2), 3) for _ in program.accelerations)
    return TestVector(t, x, p, inputs if with_inputs and inputs else None, (), SOLVED, a)


def _vector(program: Program, floats: RightHandSide, state: TestVector) -> TestVector | None:
    """The state with its answer, or None where there is none."""
    symbols = program.symbols
    arguments = [symbols.t, *program.moving, *symbols.parameters.values()]
    numbers = [state.t, *state.x, *state.a, *state.p]
    if state.inputs is not None:
        arguments += symbols.inputs.values()
        numbers += state.inputs
    exact = dict(zip(arguments, map(Fraction, numbers), strict=True))
    result = _right(program, exact)
    found = floats(state.t, [*state.x, *state.a], state.p, state.inputs or ())
    known = [(a, b) for a, b in zip(found, result, strict=True) if b == b]
    largest = max(1.0, *(abs(b) for _, b in known)) if known else 1.0
    error = max((abs(a - b) for a, b in known), default=0.0) / largest
    if not error < COMPUTED or (len(known) < len(result) and not _is_partial_nearby(program, exact, result)):
        return None
    return replace(state, result=result, tolerance=float(max(SOLVED, 10 * error)))


def _right(program: Program, exact: dict[Node, Fraction]) -> tuple[float, ...]:
    """The outputs from 50 digits, nan where there is no value."""
    arithmetic = fifty_digits(partial=True)
    values = {node: arithmetic.number(number) for node, number in exact.items()}
    return tuple(float(value) for value in outputs_at(program, values, arithmetic))


def _is_partial_nearby(program: Program, exact: dict[Node, Fraction], result: Sequence[float]) -> bool:
    """Whether the same outputs have no value a little before and after: not at an edge, nor by a division by zero."""
    missing = [value != value for value in result]
    near = ({node: x * (1 + away) + away for node, x in exact.items()} for away in (NEAR, -NEAR))
    return all([value != value for value in _right(program, state)] == missing for state in near)
