"""Program -> C99: `void NAME_rhs(double t, const double *x, const double *p, const double *inputs, double *dx)`.

The reactions alike: `NAME_reactions(..., double *out)`; inverse dynamics has the accelerations after x:
`NAME_inverse(double t, const double *x, const double *a, ..., double *tau)`.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence

from eomgen.codegen.build import library
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
from eomgen.codegen.targets.c_loading import functions_of
from eomgen.codegen.targets.c_self_test import self_test
from eomgen.codegen.targets.c_solving import solving_text
from eomgen.codegen.targets.parts import Parts, program_parts
from eomgen.codegen.targets.samples import c_samples
from eomgen.symbolic.expression.graph import Node, Scalar

_DEFINED = {  # C has none of these, or drops a NaN
    "sign": "(double a) { return a > 0 ? 1 : a < 0 ? -1 : a; }",
    "min": "(double a, double b) { return a < b || a != a ? a : b; }",
    "max": "(double a, double b) { return a > b || a != a ? a : b; }",
    "less": "(double a, double b) { return a < b ? 1 : a >= b ? 0 : NAN; }",
    "less_equal": "(double a, double b) { return a <= b ? 1 : a > b ? 0 : NAN; }",
    "select": "(double given, double a, double b) { return given == 0 ? b : given == given ? a : given; }",
}


def arguments(program: Program, many: bool = False) -> str:
    """t, x, a where it is one, p: of one instant, or arrays over many."""
    arrays = ["x", "a", "p"] if program.accelerations else ["x", "p"]
    return ", ".join(["const double *t" if many else "double t", *(f"const double *{name}" for name in arrays)])


def c_text(program: Program, stem: str, role: Role = RHS, remarks: Mapping[str, str] | None = None) -> str:
    """The functions of a program: NAME_constants, NAME_evaluate, NAME_rhs and NAME_many, or what its role says.

    Args:
        program: what is computed.
        stem: NAME, an identifier.
        remarks: of an argument's name: its unit and what it is, for the comments.
    """
    bodies = layout(program)
    remarks = remarks or {}
    solve = solving_text(bodies.solve.zeros) if bodies.solve else ""
    parts = [
        "#include <math.h>\n#include <stddef.h>\n",
        solve,
        "".join(f"static double {op}{_DEFINED[op]}\n" for op in sorted(bodies.ops & _DEFINED.keys())),
        c_samples(bodies),
        _constants(bodies, role.others(stem), remarks),
        _evaluate(bodies, role.others(stem), role.result, remarks),
        _wrappers(bodies, stem, role),
    ]
    return "\n".join(part for part in parts if part)


def prototypes(program: Program, stem: str, role: Role = RHS) -> str:
    """The declarations of what `c_text` defines, and the sizes of its arrays."""
    bodies, others, result = layout(program), role.others(stem), role.result
    symbols, name = program.symbols, others.upper()
    size = f"#define {name}_OUTPUTS {len(program.outputs)}\n" if role is not RHS else ""
    rows = "states" if role is RHS else "outputs"
    given = "a n x speeds, " if program.accelerations else ""
    return (
        f"#define {name}_STATES {len(program.states)}\n"
        f"#define {name}_PARAMETERS {len(symbols.parameters)}\n"
        f"#define {name}_INPUTS {len(symbols.inputs)}\n"
        f"#define {name}_CONSTANTS {len(bodies.kept)}\n{size}\n"
        f"/* {result} at (t, x, p); inputs NULL: the model's own. */\n"
        f"void {role.main(stem)}({arguments(program)}, const double *inputs, double *{result});\n\n"
        f"/* The same in two steps: c once for given p, then as often as one likes. */\n"
        f"void {others}_constants(const double *p, double *c);\n"
        f"void {others}_evaluate({arguments(program)}, const double *c, const double *inputs, double *{result});\n\n"
        f"/* n instants at once: t n, x n x states, {given}inputs NULL or n x inputs, {result} n x {rows}. */\n"
        f"void {others}_many(size_t n, {arguments(program, many=True)}, const double *inputs, double *{result});\n"
    )


def _constants(bodies: Layout, stem: str, remarks: Mapping[str, str]) -> str:
    """What the parameters alone determine."""
    nodes = [s.node for s in bodies.program.hoisted]
    writer = ExpressionWriter(bodies.calls(_call), bodies.names)
    used = used_symbols(bodies.kept, ())
    lines = _loads(bodies, "p", list(bodies.program.symbols.parameters.values()), used, remarks)
    lines += _assignments(writer, nodes, bodies.once)
    lines += [f"c[{place}] = {writer.value(x)};" for place, x in enumerate(bodies.kept)]
    if not bodies.kept:
        lines = ["(void)p;", "(void)c;"]
    return _function(f"void {stem}_constants(const double *p, double *c)", lines)


def _evaluate(bodies: Layout, stem: str, result: str, remarks: Mapping[str, str]) -> str:
    """Everything else."""
    program, solve = bodies.program, bodies.solve
    symbols = program.symbols
    written = (*(solve.entries if solve else ()), *program.outputs)
    inputs = [x for x in symbols.inputs.values() if x in used_symbols(written, bodies.kept)]
    parts = program_parts(bodies)
    elsewhere = parts.names("between")
    loaded = used_symbols([*written, *(program.defaults if inputs else ()), *inputs], [*bodies.kept, *elsewhere])
    loaded |= frozenset(inputs)
    writer = ExpressionWriter(bodies.calls(_call), _names(bodies) | elsewhere)
    lines = _loads(bodies, "x", program.states, loaded, remarks)
    lines += _loads(bodies, "a", program.accelerations, loaded, remarks)
    lines += _loads(bodies, "p", list(symbols.parameters.values()), loaded, remarks)
    lines += _inputs(bodies, inputs, remarks)
    lines += [f"double between[{len(elsewhere)}];"] if parts.all else []
    lines += [f"{elsewhere[x]} = {bodies.names[x]};" for x in inputs if x in elsewhere]
    lines += _run(parts, 0, len(parts.before), program) or _assignments(writer, bodies.before, bodies.once)
    if solve:
        lines += _solve(solve, writer, elsewhere)
    lines += _run(parts, len(parts.before), len(parts.all), program) or _assignments(writer, bodies.after, bodies.once)
    lines += [f"{result}[{place}] = {writer.value(x)};" for place, x in enumerate(program.outputs)]
    head = f"void {stem}_evaluate({arguments(program)}, const double *c, const double *inputs, double *{result})"
    whole = _function(head, [*_silenced(bodies, loaded, inputs, result, parts), *lines])
    return "\n".join([*_functions_of_parts(bodies, parts), whole])


def _run(parts: Parts, first: int, last: int, program: Program) -> list[str]:
    """Parts one after the other, by their addresses: a compiler would make one function of them again."""
    if first == last:
        return []
    a = ", a" if program.accelerations else ""
    return [f"for (int i = {first}; i < {last}; i++) parts[i](t, x{a}, p, c, between);"]


def _functions_of_parts(bodies: Layout, parts: Parts) -> list[str]:
    """A function of every part, and the list of them."""
    if not parts.all:
        return []
    program = bodies.program
    takes = f"{arguments(program)}, const double *c, double *between"
    texts = [_function(f"static void part{i}({takes})", _part(bodies, parts, part)) for i, part in enumerate(parts.all)]
    names = ", ".join(f"part{i}" for i in range(len(parts.all)))
    return [*texts, f"static void (*const parts[])({takes}) = {{ {names} }};\n"]


def _part(bodies: Layout, parts: Parts, nodes: Sequence[Node]) -> list[str]:
    """What one part computes; what is read elsewhere goes into the array."""
    program, others = bodies.program, parts.names("between", without=nodes)
    stored = {x: text for x, text in parts.names("between").items() if x not in others}
    writer = ExpressionWriter(bodies.calls(_call), _names(bodies) | others)
    used = used_symbols([a for x in nodes for a in x.args], [*nodes, *bodies.kept, *others])
    arrays = {"x": program.states, "a": program.accelerations, "p": tuple(program.symbols.parameters.values())}
    lines = [f"(void)t; (void)x; {'(void)a; ' if program.accelerations else ''}(void)p; (void)c; (void)between;"]
    for array, symbols in arrays.items():
        lines += _loads(bodies, array, symbols, used, {})
    lines += _assignments(writer, nodes, bodies.once - stored.keys())
    return [*lines, *(f"{text} = {writer.value(x)};" for x, text in stored.items())]


def _names(bodies: Layout) -> dict[Node, str]:
    return bodies.names | {x: f"c[{place}]" for place, x in enumerate(bodies.kept)}


def _silenced(bodies: Layout, loaded: frozenset[Node], inputs: Sequence[Node], result: str, parts: Parts) -> list[str]:
    """(void) for arguments that this program does not need."""
    program = bodies.program
    if parts.all:
        return [] if inputs else ["(void)inputs;"]
    needed = {
        "t": program.symbols.t in loaded,
        "x": any(x in loaded for x in program.states),
        "p": any(x in loaded for x in program.symbols.parameters.values()),
        "c": bool(bodies.kept),
        "inputs": bool(inputs),
        result: bool(program.outputs),
    }
    if program.accelerations:
        needed["a"] = any(x in loaded for x in program.accelerations)
    return [f"(void){name};" for name, is_needed in needed.items() if not is_needed]


def _loads(
    bodies: Layout, array: str, symbols: Sequence[Node], used: frozenset[Node], remarks: Mapping[str, str]
) -> list[str]:
    lines = []
    for place, x in bodies.loads(symbols, used):
        lines.append(f"const double {bodies.names[x]} = {array}[{place}];{_remark(x.name, bodies.names[x], remarks)}")
    return lines


def _remark(name: str, word: str, remarks: Mapping[str, str]) -> str:
    text = remarks.get(name, "")
    said = f"{name}: {text}" if text and name != word else text or (name if name != word else "")
    return f" /* {comment(said)} */" if said else ""


def comment(text: str) -> str:
    """Text that cannot end the comment it stands in, on one line."""
    for mark, harmless in (("*/", "* /"), ("/*", "/ *"), ("??", "? ?"), ("\\", "/")):
        text = text.replace(mark, harmless)
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _inputs(bodies: Layout, inputs: Sequence[Node], remarks: Mapping[str, str]) -> list[str]:
    """Each input from the caller, or by the model's own expression."""
    if not inputs:
        return []
    program, places = bodies.program, {x: i for i, x in enumerate(bodies.program.symbols.inputs.values())}
    writer = ExpressionWriter(bodies.calls(_call), _names(bodies), prefix="i")
    own = _assignments(writer, [s.node for s in program.preamble], bodies.once)
    lines = [f"double {bodies.names[x]};{_remark(x.name, bodies.names[x], remarks)}" for x in inputs]
    lines += ["if (inputs != NULL) {"]
    lines += [f"    {bodies.names[x]} = inputs[{places[x]}];" for x in inputs]
    lines += ["} else {", *(f"    {line}" for line in own)]
    lines += [f"    {bodies.names[x]} = {writer.value(program.defaults[places[x]])};" for x in inputs]
    return [*lines, "}"]


def _assignments(writer: ExpressionWriter, nodes: Sequence[Node], once: frozenset[Node]) -> list[str]:
    return [f"const double {variable} = {text};" for variable, text in writer.assignments(nodes, once)]


def _solve(solve: Solve, writer: ExpressionWriter, elsewhere: Mapping[Node, str]) -> list[str]:
    """Fill the arrays, solve, name the unknowns, and leave them where other functions read them."""
    n, k = len(solve.matrix), len(solve.border)
    lines = [f"double solve_M[{n * n}] = {{0}}, solve_f[{n}];"]
    lines += [f"double solve_J[{k * n}] = {{0}}, solve_g[{k}];"] if k else []
    lines += _filled("solve_M", [(j * n + i, solve.matrix[i][j]) for i in range(n) for j in range(i + 1)], writer)
    lines += _filled("solve_J", [(m * n + i, solve.border[m][i]) for m in range(k) for i in range(n)], writer)
    lines += [f"solve_f[{i}] = {writer.value(solve.right[i])};" for i in range(n)]
    lines += [f"solve_g[{m}] = {writer.value(solve.right[n + m])};" for m in range(k)]
    lines += ["solve(solve_M, solve_J, solve_f, solve_g);" if k else "solve(solve_M, solve_f);"]
    for place, x in enumerate(solve.unknowns):
        text = f"solve_f[{place}]" if place < n else f"solve_g[{place - n}]"
        lines += [f"{elsewhere[x]} = {text};"] if x in elsewhere else []
        writer.define(x, text)
    return lines


def _filled(array: str, entries: Sequence[tuple[int, Scalar]], writer: ExpressionWriter) -> list[str]:
    filled = [(place, x) for place, x in entries if type(x) is Node or x != 0]
    return [f"{array}[{place}] = {writer.value(x)};" for place, x in filled]


def _wrappers(bodies: Layout, stem: str, role: Role) -> str:
    others, result, program = role.others(stem), role.result, bodies.program
    size = max(len(bodies.kept), 1)
    a = ", a" if program.accelerations else ""
    each = f", a + i*{len(program.accelerations)}" if a else ""
    states, inputs, outputs = (
        len(bodies.program.states),
        len(bodies.program.symbols.inputs),
        len(bodies.program.outputs),
    )
    one = [f"double c[{size}];", f"{others}_constants(p, c);", f"{others}_evaluate(t, x{a}, p, c, inputs, {result});"]
    many = [
        f"double c[{size}];",
        f"{others}_constants(p, c);",
        "for (size_t i = 0; i < n; i++)",
        f"    {others}_evaluate(t[i], x + i*{states}{each}, p, c, inputs ? inputs + i*{inputs} : NULL, "
        f"{result} + i*{outputs});",
    ]
    head = f"void {others}_many(size_t n, {arguments(program, many=True)}, const double *inputs, "
    return "\n".join(
        [
            _function(f"void {role.main(stem)}({arguments(program)}, const double *inputs, double *{result})", one),
            _function(f"{head}double *{result})", many),
        ]
    )


def _function(head: str, lines: Sequence[str]) -> str:
    return "\n".join([head, "{", *(f"    {line}" for line in lines), "}", ""])


def _call(op: str, arguments: list[str]) -> str:
    return f"{'fabs' if op == 'abs' else op}({', '.join(arguments)})"


def c_functions(program: Program) -> Functions:
    """The program compiled (or found in the cache) and callable."""
    return functions_of(library(c_text(program, "eomgen")), program, "eomgen", len(layout(program).kept))


def c_files(program: Program, stem: str, description: Description) -> dict[str, str]:
    """NAME_rhs.c and NAME_rhs.h; the former with a self-test: `cc -DEOMGEN_SELFTEST NAME_rhs.c -lm && ./a.out`."""
    role = description.role
    name = role.main(stem)
    guard = f"{name.upper()}_H"
    head = "\n".join(["/*", *(f" * {comment(line)}".rstrip() for line in header(program, description)), " */", ""])
    declared = (
        f"{head}#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n\n"
        '#ifdef __cplusplus\nextern "C" {\n#endif\n\n'
        f"{prototypes(program, stem, role)}\n#ifdef __cplusplus\n}}\n#endif\n\n#endif\n"
    )
    defined = f'{head}#include "{name}.h"\n\n{c_text(program, stem, role, description.remarks)}'
    test = self_test(program, stem, description.vectors, role)
    return {f"{name}.c": f"{defined}\n{test}", f"{name}.h": declared}


def run(texts: Mapping[str, str], program: Program, stem: str, role: Role) -> Called:
    """NAME_rhs of the files, compiled."""
    name = role.main(stem)
    text = texts[f"{name}.c"].replace(f'#include "{name}.h"\n', texts[f"{name}.h"], 1)
    function, outputs = getattr(library(text, quickly=True), name), len(program.outputs)
    reals = ctypes.POINTER(ctypes.c_double)
    function.argtypes = [ctypes.c_double, *[reals] * (5 if program.accelerations else 4)]
    function.restype = None

    def called(
        t: float, x: Sequence[float], a: Sequence[float], p: Sequence[float], inputs: Sequence[float] | None
    ) -> Sequence[float]:
        arrays = [(ctypes.c_double * max(len(y), 1))(*y) for y in ((x, a, p) if program.accelerations else (x, p))]
        acting = None if inputs is None else (ctypes.c_double * max(len(inputs), 1))(*inputs)
        found = (ctypes.c_double * max(outputs, 1))()
        function(t, *arrays, acting, found)
        return found[:outputs]

    return called


TARGET = Target("c", "C99, no dependencies", c_text, c_files, c_functions, run)
