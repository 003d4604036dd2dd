"""Program -> Python: straight-line scalars by `math` for one state, the same lines by numpy for many."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.codegen import solving
from eomgen.codegen.expressions import ExpressionWriter
from eomgen.codegen.program import Program, Solve
from eomgen.codegen.targets.base import (
    RHS,
    Called,
    Description,
    Functions,
    Layout,
    Role,
    Target,
    header,
    layout,
    used_symbols,
)
from eomgen.codegen.targets.samples import python_samples
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric import tolerances

SCALARS = {
    **{name: f"math.{name}" for name in "sqrt sin cos asin acos atan sinh cosh tanh exp log atan2 pow".split()},
    "abs": "abs",
    "sign": "lambda a: 1.0 if a > 0 else -1.0 if a < 0 else a",
    "min": "lambda a, b: a if a < b or a != a else b",
    "max": "lambda a, b: a if a > b or a != a else b",
    "less": "lambda a, b: float(a < b) if a == a and b == b else a + b",
    "less_equal": "lambda a, b: float(a <= b) if a == a and b == b else a + b",
    "select": "lambda given, a, b: b if given == 0 else a if given == given else given",
    "solve": "_solved",
}
ARRAYS = {
    **{name: f"np.{name}" for name in "sqrt sin cos sinh cosh tanh exp log abs sign".split()},
    **{"asin": "np.arcsin", "acos": "np.arccos", "atan": "np.arctan", "atan2": "np.arctan2", "pow": "np.float_power"},
    "min": "np.minimum",
    "max": "np.maximum",
    "less": "lambda a, b: np.where(a < b, 1.0, np.where(a >= b, 0.0, np.nan))",
    "less_equal": "lambda a, b: np.where(a <= b, 1.0, np.where(a > b, 0.0, np.nan))",
    "select": "lambda given, a, b: np.where(given == 0, b, np.where(given == given, a, given))",
    "solve": "_solved_each",
}

_SOLVED = '''
def _solved(values):
    """The unknowns from the lower triangle of M, J, f and g, one after the other in `values`."""
    n, k = SIZES
    rows = n * (n + 1) // 2
    M = [values[i * (i + 1) // 2 : (i + 1) * (i + 2) // 2] for i in range(n)]
    J = [values[rows + m * n : rows + (m + 1) * n] for m in range(k)]
    right = values[rows + k * n :]
    return solve_bordered(M, J, right[:n], right[n:], ZEROS)


def _solved_each(values):
    """The same at many states: an array of unknowns by states."""
    states = np.stack(np.broadcast_arrays(*values), axis=-1).reshape(-1, len(values))
    return np.array([_solved(state) for state in states.tolist()]).T
'''

_CALLS = '''
_constants, _evaluate = _written({scalars})
_constants_of_arrays, _evaluate_arrays = _written({arrays})


def {main}(t, x, {a}p, inputs=None):
    """{result} at one state: a list of {outputs}; inputs None: the model's own."""
    x, p = [float(value) for value in {all_x}], [float(value) for value in p]
    inputs = None if inputs is None else [float(value) for value in inputs]
    return evaluate(float(t), x, p, constants(p), inputs)


def {others}_many(t, x, {a}p, inputs=None):
    """{result} at n states: t n, x n x {states}, {a_size}p {parameters}, inputs None or n x {inputs} -> \
n x {outputs}."""
    x, p = np.asarray({beside}, dtype=float), [float(value) for value in p]
    return evaluate_many(np.asarray(t, dtype=float), x, p, inputs)


def constants(p):
    """What the parameters alone determine."""
    try:
        return _constants(p)
    except (ValueError, ArithmeticError):
        with np.errstate(all="ignore"):
            return [float(value) for value in _constants_of_arrays([np.float64(value) for value in p])]


def evaluate(t, x, p, c, inputs):
    """{result} at one state, all lists of floats; outside a function's domain nan, as in C."""
    try:
        return _evaluate(t, x, p, c, inputs)
    except (ValueError, ArithmeticError):
        given = None if inputs is None else [inputs]
        return evaluate_many(np.array([t]), np.array([x]), p, given)[0].tolist()


def evaluate_many(t, x, p, inputs):
    """{result} at n states."""
    with np.errstate(all="ignore"):
        p = [np.float64(value) for value in p]
        rows = None if inputs is None else np.asarray(inputs, dtype=float).T
        {result} = _evaluate_arrays(t, x.T, p, _constants_of_arrays(p), rows)
        return np.stack([np.broadcast_to(value, t.shape) for value in {result}], axis=-1) if {result} else \
np.empty((len(t), 0))
'''


def python_text(program: Program, stem: str, role: Role = RHS) -> str:
    """A module with NAME_rhs(t, x, p, inputs=None) and NAME_many, or what the role says."""
    bodies, given = layout(program), len(program.accelerations)
    used = sorted((bodies.ops & SCALARS.keys()) | ({"solve"} if bodies.solve else set()))
    written = textwrap.indent("\n".join([*_constants(bodies), "", *_evaluate(bodies)]), "    ")
    calls = _CALLS.format(
        main=role.main(stem),
        others=role.others(stem),
        result=role.result,
        scalars=", ".join(SCALARS[name] for name in used),
        arrays=", ".join(ARRAYS[name] for name in used),
        outputs=len(program.outputs),
        states=len(program.states),
        a="a, " if given else "",
        all_x="[*x, *a]" if given else "x",
        a_size=f"a n x {given}, " if given else "",
        beside="np.hstack([x, a])" if given else "x",
        parameters=len(program.symbols.parameters),
        inputs=len(program.symbols.inputs),
    )
    return "\n".join(
        [
            "import math\n\nimport numpy as np\n",
            _solving_text(bodies.solve) if bodies.solve else "",
            f"{python_samples(bodies)}\ndef _written({', '.join(used)}):",
            '    """The functions in the arithmetic of the functions given."""',
            "",
            written,
            "",
            "    return constants, evaluate",
            "",
            calls,
        ]
    )


def numpy_functions(program: Program) -> Functions:
    """The program's text, made functions."""
    space: dict[str, Any] = {}
    exec(compile(python_text(program, "eomgen"), "<eomgen program>", "exec"), space)  # our own text, from the graph
    import numpy as np

    constants, evaluate, many = space["constants"], space["evaluate"], space["evaluate_many"]

    def constants_of(p: Any) -> tuple[list[float], Any]:
        values = np.asarray(p, dtype=float).tolist()
        return values, constants(values)

    def one(t: float, x: Any, known: tuple[list[float], Any], inputs: Any) -> Any:
        given = None if inputs is None else [float(value) for value in inputs]
        return np.array(evaluate(float(t), [float(value) for value in x], *known, given), dtype=float)

    return Functions(constants_of, one, many)


def numpy_files(program: Program, stem: str, description: Description) -> dict[str, str]:
    """NAME_rhs.py, a module of its own: it needs numpy and nothing of ours."""
    head = "\n".join(header(program, description)).replace("\\", "/").replace('"""', "'''")
    text = python_text(program, stem, description.role)
    return {f"{description.role.main(stem)}.py": f'"""{head}\n"""\n\n{text}'}


def run(texts: Mapping[str, str], program: Program, stem: str, role: Role) -> Called:
    """NAME_rhs of the file, executed."""
    space: dict[str, Any] = {}
    exec(compile(texts[f"{role.main(stem)}.py"], role.main(stem), "exec"), space)  # our own text, from the graph
    function = space[role.main(stem)]

    def called(
        t: float, x: Sequence[float], a: Sequence[float], p: Sequence[float], inputs: Sequence[float] | None
    ) -> Sequence[float]:
        found: Sequence[float] = function(t, x, a, p, inputs) if program.accelerations else function(t, x, p, inputs)
        return found

    return called


def _constants(bodies: Layout) -> list[str]:
    writer = ExpressionWriter(bodies.calls(_call), bodies.names)
    parameters = list(bodies.program.symbols.parameters.values())
    lines = _unpacked(bodies, "p", parameters, used_symbols(bodies.kept, ())) if bodies.kept else []
    lines += _assignments(writer, [s.node for s in bodies.program.hoisted], bodies.once)
    lines.append(f"return [{', '.join(writer.value(x) for x in bodies.kept)}]")
    return _function("def constants(p):", lines)


def _evaluate(bodies: Layout) -> list[str]:
    program, solve = bodies.program, bodies.solve
    symbols = program.symbols
    inputs = list(symbols.inputs.values())
    written = (*(solve.entries if solve else ()), *program.outputs)
    used = used_symbols(written, bodies.kept)
    given = [x for x in inputs if x in used]
    loaded = used | (used_symbols(program.defaults, bodies.kept) if given else frozenset())
    writer = ExpressionWriter(bodies.calls(_call), _names(bodies))
    lines = _unpacked(bodies, "x", program.moving, loaded)
    lines += _unpacked(bodies, "p", list(symbols.parameters.values()), loaded)
    if bodies.kept:
        lines.append(f"{_targets(_constant_names(bodies))} = c")
    lines += _inputs(bodies, inputs) if given else []
    lines += _assignments(writer, bodies.before, bodies.once)
    if solve:
        lines += _solve(solve, writer, bodies)
    lines += _assignments(writer, bodies.after, bodies.once)
    lines.append(f"return [{', '.join(writer.value(x) for x in program.outputs)}]")
    return _function("def evaluate(t, x, p, c, inputs):", lines)


def _inputs(bodies: Layout, inputs: Sequence[Node]) -> list[str]:
    """All inputs from the caller, or all by the model's own expressions."""
    program = bodies.program
    writer = ExpressionWriter(bodies.calls(_call), _names(bodies), prefix="i")
    own = _assignments(writer, [s.node for s in program.preamble], bodies.once)
    own += [f"{bodies.names[x]} = {writer.value(d)}" for x, d in zip(inputs, program.defaults, strict=True)]
    given = f"{_targets([bodies.names[x] for x in inputs])} = inputs"
    return ["if inputs is not None:", f"    {given}", "else:", *(f"    {line}" for line in own)]


def _solve(solve: Solve, writer: ExpressionWriter, bodies: Layout) -> list[str]:
    values = ", ".join(writer.value(x) for x in solve.entries)
    for x in solve.unknowns:
        writer.define(x, bodies.names[x])
    unknowns = _targets([bodies.names[x] for x in solve.unknowns])
    return [f"{unknowns} = solve([{values}])"]


def _unpacked(bodies: Layout, array: str, symbols: Sequence[Node], used: frozenset[Node]) -> list[str]:
    if not any(x in used for x in symbols):
        return []
    return [f"{_targets([bodies.names[x] for x in symbols])} = {array}"]


def _targets(names: Sequence[str]) -> str:
    return f"({', '.join(names)},)"


def _constant_names(bodies: Layout) -> list[str]:
    return [f"_c{place}" for place in range(len(bodies.kept))]


def _names(bodies: Layout) -> dict[Node, str]:
    return bodies.names | dict(zip(bodies.kept, _constant_names(bodies), strict=True))


def _assignments(writer: ExpressionWriter, nodes: Sequence[Node], once: frozenset[Node]) -> list[str]:
    return [f"{variable} = {text}" for variable, text in writer.assignments(nodes, once)]


def _function(head: str, lines: Sequence[str]) -> list[str]:
    return [head, *(f"    {line}" for line in lines)]


def _call(op: str, arguments: list[str]) -> str:
    return f"{op}({', '.join(arguments)})"


def _solving_text(solve: Solve) -> str:
    text = inspect.getsource(solving)
    sizes = f"SIZES = {len(solve.matrix)}, {len(solve.border)}  # accelerations, multipliers"
    zeros = f"ZEROS = {solve.lists!r}  # what may not be zero in the factors: (partners, reach, rows)"
    limits = [f"{name} = {getattr(tolerances, name)!r}" for name in solving.TOLERANCES]
    return "\n".join([*limits, "", text[text.index("\ndef ") :], "", sizes, zeros, _SOLVED])


TARGET = Target("numpy", "Python with numpy", python_text, numpy_files, numpy_functions, run)
