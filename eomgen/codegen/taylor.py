"""Program -> C text of the power series of its motion, compiled.

Program -> C text of the power series of its motion: x(t + h) = sum of X[j] h^j, from x' = f(t, x).

Every node of the graph has its own series; the coefficient j of a result follows from those of its arguments up to j:

    (a b)_j = sum of a_i b_(j-i),    (a/b)_j = (a_j - sum over i > 0 of b_i (a/b)_(j-i)) / b_0,
    j sin(a)_j = sum of i a_i cos(a)_(j-i),    x_(j+1) = f_j / (j + 1)

A linear system is solved for each coefficient with the matrix of the first: what is known of the products goes to the
right side. Source: Griewank & Walther, Evaluating Derivatives, 2nd ed., ch. 13.
"""

from __future__ import annotations

import ctypes
import math
from dataclasses import field
from typing import Any

from eomgen.codegen.build import function_of, library
from eomgen.codegen.lowering import Layout, statements
from eomgen.codegen.program import Assign, Program, Solve
from eomgen.codegen.statements import Language
from eomgen.codegen.targets.c import C
from eomgen.codegen.targets.c_lanes import WIDTH, text_of, vector_compiler
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Node, Scalar

MOST_UNROLLED = 8000  # sums x order^2 that are written out for each order: they take a compiler a second
UNROLL, INLINE = '_Pragma("GCC unroll 32")', "static inline __attribute__((always_inline))"
_PAIRS = {"sin": ("cos", "-"), "cos": ("sin", "-"), "sinh": ("cosh", ""), "cosh": ("sinh", "")}  # and signs of rates
_PARTS = {"tan": ("sin", "cos"), "tanh": ("sinh", "cosh")}
_ANALYTIC = frozenset((*_PAIRS, *_PARTS, "add", "sub", "mul", "div", "pow", "sqrt", "exp", "log", "atan"))


def without_series(program: Program) -> str:
    """First part of a program without a power series here, by its name in models; "" where all have one."""
    for statement in (*program.statements, *program.preamble):
        if type(statement) is Assign:
            x = statement.node
            if x.op not in _ANALYTIC:
                return {"sampled": "samples", "select": "a condition"}.get(x.op, x.op)
            if x.op == "pow" and type(x.args[1]) is Node:
                return "a power that is no number"
    return ""


def series_text(program: Program, language: Language, order: int) -> tuple[str, int]:
    """(the function that gives the coefficients up to an order, the size of its work array).

    `void eomgen_series(REAL t, const REAL *x, const REAL *p, const REAL *c, REAL *X, REAL *W)`, X of order + 1 rows of
    states, c as eomgen_constants gives it. It stands behind taylor.c and the kernels of the program. What is short is
    written for each j apart: a compiler then knows the length of every sum.
    """
    written = _Writer(Layout(program, language, "dx", "eomgen_", {}), order)
    text = written.text()
    return text, written.summed_at + 2 * (order - 1) * written.summed


@dataclass
class _Writer:
    """The lines of the function: those of the first coefficients, and those of coefficient j.

    Args:
        rows: places of the series that are read, by their keys.
        first, rest: (the row without which it is not needed, a line).
        named: name of the coefficient of each scalar that is no constant.
        same: of an input what it stands for.
        kept: numbers that stay from the first coefficients on.
        sums: the two rows of each sum over products of coefficients.
    """

    layout: Layout
    order: int
    rows: dict[object, int] = field(default_factory=dict)
    first: list[tuple[object, str]] = field(default_factory=list)
    rest: list[tuple[object, str]] = field(default_factory=list)
    named: dict[object, str] = field(default_factory=dict)
    same: dict[Node, Scalar] = field(default_factory=dict)
    kept: int = 0
    sums: list[tuple[str, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.texts, self.number = self.layout.writer(), self.layout.language.real

    def text(self) -> str:
        """The functions."""
        program, n, order = self.layout.program, len(self.layout.program.states), self.order
        self._arguments()
        for x in self.layout.preamble:
            self._node(x)
        for symbol, value in zip(self.layout.inputs, self.layout.defaults, strict=True):
            self.same[symbol] = value
            self.texts.define(symbol, self.texts.factor(value))
        for statement in program.statements:
            if isinstance(statement, Solve):
                self._solve(statement)
            else:
                self._node(statement.node)
        for k, output in enumerate(program.outputs):
            self.say(f"X[{n + k}] = {self.texts.value(output)};", f"X[(j + 1)*{n} + {k}] = {self.now(output)}*next;")
        first, rest = self.needed(self.first), self.needed(self.rest)
        short = len(self.sums) * order * order < MOST_UNROLLED
        arrays = "const REAL *restrict p, const REAL *restrict c, REAL *restrict X, REAL *restrict W"
        zero, one, called = self.number(0), self.number(1), "eomgen_next({}, p, c, X, W);"
        steps = [called.format(j) for j in range(1, order)]
        loop = [f"for (size_t j = 1; j < {order}; j++)", f"    {called.format('j')}"]
        lines = [
            f"enum {{ KEPT = {(order + 1) * len(self.rows)}, SUMMED = {self.summed_at} }};",
            f"SERIES_INLINE void eomgen_next(const size_t j, {arrays})",
            "{",
            f"    const REAL whole = {zero} + (double)j, each = {one}/whole, next = {one}/(whole + {one});",
            "    (void)each, (void)p, (void)c, (void)W;",
            "    SERIES_BEGIN(W + SUMMED, j)",
            *(f"    {line}" for line in rest),
            *(f"    SERIES_END(W + SUMMED, j, {k}, {a}, {b})" for k, (a, b) in enumerate(self.sums)),
            "}",
            "",
            f"void eomgen_series(REAL t, const REAL *restrict x, {arrays})",
            "{",
            "    (void)p, (void)c, (void)W;",
            *(f"    X[{k}] = x[{k}];" for k in range(n)),
            *(f"    {line}" for line in (*first, *(steps if short else loop))),
            "}",
        ]
        defined = {
            "STATES": n,
            "ORDER": order,
            "SUMS": self.summed,
            "UNROLL": UNROLL if short else "",
            "INLINE": INLINE if short else "static",
        }
        heads = [f"#define SERIES_{name} {value}" for name, value in defined.items()]
        return "\n".join([*heads, text_of("taylor.c"), *lines])

    def _arguments(self) -> None:
        """t, the states, the parameters."""
        program = self.layout.program
        for k, p in enumerate(program.symbols.parameters.values()):
            self.texts.define(p, f"p[{k}]")
        self.define(program.symbols.t, "t_0", "t", f"j == 1 ? {self.number(1)} : {self.number(0)}")
        for k, x in enumerate(program.states):
            self.define(x, f"x_{k}", f"x[{k}]", f"X[j*{len(program.states)} + {k}]")

    # -- series -------------------------------------------------------------------------------------

    def needed(self, lines: list[tuple[object, str]]) -> list[str]:
        """The lines, without those that fill a row which is not read."""
        there = [(key, line) for key, line in lines if key is None or key in self.rows]
        return [line if key is None else line.format(self.row(key)) for key, line in there]

    def say(self, first: str, rest: str = "") -> None:
        """Lines of the first coefficients and of the others."""
        self.first += [(None, first)] if first else []
        self.rest += [(None, rest)] if rest else []

    def row(self, key: object) -> str:
        """Index of the row of a series."""
        return str(self.rows.setdefault(key, len(self.rows)))

    def define(self, key: object, name: str, first: str, rest: str) -> None:
        """A value and its coefficient j, with a name; into its rows."""
        self.named[key] = name
        if type(key) is Node:
            self.texts.define(key, name)
        self.say(f"const REAL {name} = {first};", f"const REAL {name} = {rest};")
        self.first.append((key, f"SERIES_FIRST({{}}) = {name};"))
        self.rest += [(key, f"SERIES_PUT({{}}, j, {name})"), (("rate", key), f"SERIES_PUT({{}}, j, whole*{name})")]

    def key(self, x: Scalar) -> object:
        """Key of the row of a scalar's series."""
        x = self.same.get(x, x) if type(x) is Node else x
        return (x.op, x.args[0]) if type(x) is Node and x.op in _PAIRS else x

    def moves(self, x: Scalar) -> bool:
        """True if the scalar may change with time: a coefficient after the first may differ from zero."""
        key = self.key(x)
        return key in self.named or (type(key) is Node and key.op == "neg" and self.moves(key.args[0]))

    def now(self, x: Scalar) -> str:
        """Coefficient j."""
        return self.texts.factor(x) if self.moves(x) else self.number(0)

    def of(self, x: Scalar) -> str:
        """Row of the series of a scalar that moves."""
        key = self.key(x)
        if key not in self.named:  # what is negative has none yet
            text = self.texts.factor(x)
            self.define(key, f"less_{len(self.named)}", text, text)
        return self.row(key)

    def rate(self, x: Scalar) -> str:
        """Row of the numbers i x_i."""
        self.of(x)
        return self.row(("rate", self.key(x)))

    @property
    def summed(self) -> int:
        """Number of sums, rounded up to whole vectors."""
        return -(-max(len(self.sums), 1) // WIDTH) * WIDTH

    @property
    def summed_at(self) -> int:
        """Place at which the sums begin, after the series, rounded up to whole vectors."""
        return -(-((self.order + 1) * len(self.rows) + self.kept) // WIDTH) * WIDTH

    def below(self, a: str, b: str) -> str:
        """sum over i > 0 of a_i b_(j-i)"""
        return f"(SERIES_NOW({a}, j)*SERIES_FIRST({b}) + {self.between(a, b)})"

    def between(self, a: str, b: str) -> str:
        """sum over 0 < i < j of a_i b_(j-i)"""
        self.sums.append((a, b))
        return f"SERIES_SUM({len(self.sums) - 1}, {a}, {b}, j)"

    def product(self, a: str, b: str) -> str:
        """sum of a_i b_(j-i); terms with the newest coefficients are added last, so that nothing waits for them"""
        last = f"(SERIES_FIRST({a})*SERIES_NOW({b}, j) + {self.between(a, b)})"
        return f"(SERIES_NOW({a}, j)*SERIES_FIRST({b}) + {last})"

    def square(self, a: str) -> str:
        """sum of a_i a_(j-i)"""
        self.sums.append((a, a))
        twice = f"(SERIES_FIRST({a}) + SERIES_FIRST({a}))"
        return f"({twice}*SERIES_NOW({a}, j) + SERIES_SQUARE({len(self.sums) - 1}, {a}, j))"

    def over(self, name: str, text: str) -> str:
        """The reciprocal of a first coefficient."""
        return self.store(f"{self.number(1)}/{text}")

    def store(self, first: str, size: int = 1) -> str:
        """Numbers that stay from the first coefficients on."""
        place, self.kept = f"W[KEPT + {self.kept}]", self.kept + size
        self.say(f"{place} = {first};" if first else "")
        return place

    # -- operations ---------------------------------------------------------------------------------

    def _node(self, x: Node) -> None:
        """The lines of one operation."""
        if x.op in _PAIRS and self.moves(x.args[0]):
            self.texts.define(x, self.pair(x.op, x.args[0]))
            return
        ((name, text),) = self.texts.assignments([x], frozenset())
        if any(map(self.moves, x.args)):
            rest = getattr(self, f"of_{x.op}")(x, name, text)
            self.define(x, name, text, rest)
        else:  # of parameters alone
            self.texts.define(x, self.store(text))

    def pair(self, op: str, a: Scalar) -> str:
        """sin and cos, or sinh and cosh, at once: j sin(a)_j = sum of i a_i cos(a)_(j-i), j cos(a)_j = - ..."""
        if (op, a) not in self.named:
            argument, rate, count = self.texts.value(a), self.rate(a), len(self.named)
            for one in (op, _PAIRS[op][0]):
                other, sign = _PAIRS[one]
                rest = f"{self.below(rate, self.row((other, a)))}*each"
                first = self.layout.called(one, [argument])
                self.define((one, a), f"{one}_{count}", first, f"-{rest}" if sign and one == "cos" else rest)
        return self.named[op, a]

    def of_add(self, x: Node, _: str, text: str) -> str:
        return text if all(map(self.moves, x.args)) else "".join(map(self.now, filter(self.moves, x.args)))

    def of_sub(self, x: Node, _: str, text: str) -> str:
        a, b = x.args
        return text if self.moves(a) and self.moves(b) else self.now(a) if self.moves(a) else f"-{self.now(b)}"

    def of_mul(self, x: Node, _: str, text: str) -> str:
        a, b = x.args
        if not (self.moves(a) and self.moves(b)):
            return text
        if a is b:
            return self.square(self.of(a))
        for one, other in ((a, b), (b, a)):  # a (k a)
            if one.op == "mul" and other in one.args and sum(map(self.moves, one.args)) == 1:
                k = next(each for each in one.args if each is not other)
                return f"{self.texts.factor(k)}*{self.square(self.of(other))}"
        return self.product(self.of(a), self.of(b))

    def of_div(self, x: Node, name: str, text: str) -> str:
        """(a - sum over i > 0 of b_i x_(j-i)) / b_0"""
        a, b = x.args
        if not self.moves(b):
            return text
        over = self.over(name, self.texts.factor(b))
        return f"({self.now(a)} - {self.below(self.of(b), self.row(x))})*{over}"

    def of_tan(self, x: Node, name: str, _: str) -> str:
        """sin(a)/cos(a)"""
        s, c = (self.pair(op, x.args[0]) for op in _PARTS[x.op])
        below = self.below(self.row((_PARTS[x.op][1], x.args[0])), self.row(x))
        return f"({s} - {below})*{self.over(name, c)}"

    of_tanh = of_tan

    def of_sqrt(self, x: Node, name: str, text: str) -> str:
        """(a - sum over 0 < i < j of x_i x_(j-i)) / (2 x_0)"""
        over = self.over(name, f"({text} + {text})")
        return f"({self.now(x.args[0])} - {self.between(self.row(x), self.row(x))})*{over}"

    def of_pow(self, x: Node, name: str, _: str) -> str:
        """j a_0 x_j = sum over i > 0 of (n i - (j - i)) a_i x_(j-i);  products, where n is whole: a_0 may be 0"""
        a, n = x.args
        if type(n) is int and n > 1:
            return self.power(a, n)[0]
        more, less = self.below(self.rate(a), self.row(x)), self.below(self.of(a), self.row(x))
        over = self.over(name, self.texts.factor(a))
        return f"({self.texts.factor(n + 1)}*{more}*each - {less})*{over}"

    def power(self, a: Scalar, n: int) -> tuple[str, str]:
        """(coefficient j, where its series lies) of a^n."""
        key = ("power", self.key(a), n)
        if n == 1:
            return self.texts.factor(a), self.of(a)
        if key not in self.named:
            one, row = self.power(a, n - 1 if n % 2 else n // 2)
            if n % 2 == 0:
                other, rest = one, self.square(row)
            else:
                other, rest = self.texts.factor(a), self.product(row, self.of(a))
            self.define(key, f"power_{len(self.named)}", f"{one}*{other}", rest)
        return self.named[key], self.row(key)

    def of_exp(self, x: Node, _: str, __: str) -> str:
        """j x_j = sum over i > 0 of i a_i x_(j-i)"""
        return f"{self.below(self.rate(x.args[0]), self.row(x))}*each"

    def of_log(self, x: Node, name: str, _: str) -> str:
        """j a_0 x_j = j a_j - sum over 0 < i < j of i x_i a_(j-i)"""
        a = x.args[0]
        over = self.over(name, self.texts.factor(a))
        return f"({self.now(a)} - {self.between(self.row(('rate', x)), self.of(a))}*each)*{over}"

    def of_atan(self, x: Node, name: str, _: str) -> str:
        """j w_0 x_j = j a_j - sum over 0 < i < j of i x_i w_(j-i),  w = 1 + a a"""
        a, own = x.args[0], ("1 + square", x)
        held, series = self.texts.factor(a), self.of(a)
        self.define(own, f"w_{name}", f"{self.number(1)} + {held}*{held}", self.square(series))
        over = self.over(name, f"w_{name}")
        return f"({self.now(a)} - {self.between(self.row(('rate', x)), self.row(own))}*each)*{over}"

    # -- a linear system ------------------------------------------------------------------------------

    def _solve(self, solve: Solve) -> None:
        """M_0 a_j - J_0^T lam_j = f_j - sum over i > 0 of (M_i a_(j-i) - J_i^T lam_(j-i)),  J_0 a_j = g_j - ..."""
        n, k = len(solve.matrix), len(solve.border)
        lower = [(i, j, solve.matrix[i][j]) for i in range(n) for j in range(i + 1)]
        border = [(m, i, solve.border[m][i]) for m in range(k) for i in range(n)]
        M, J = self.store("", n * n), self.store("", k * n)
        fills = [(M, n * n, [(j * n + i, x) for i, j, x in lower]), (J, k * n, [(m * n + i, x) for m, i, x in border])]
        for array, size, entries in fills:
            self.say(f"memset(&{array}, 0, {size}*sizeof(REAL));")
            for at, x in entries:
                if type(x) is Node or x != 0:
                    self.say(f"(&{array})[{at}] = {self.texts.value(x)};")
        unknown = [f"solve_f[{i}]" for i in range(n)] + [f"solve_g[{m}]" for m in range(k)]
        self.say(*2 * (f"REAL solve_f[{n}], solve_g[{max(k, 1)}];",))
        for place, x in zip(unknown, solve.right, strict=True):
            self.say(f"{place} = {self.texts.value(x)};", f"{place} = {self.now(x)};")
        a, lam = solve.unknowns[:n], solve.unknowns[n:]
        for i, j, x in lower:
            if self.moves(x):
                self.say("", f"solve_f[{i}] -= {self.below(self.of(x), self.row(a[j]))};")
                if i != j:
                    self.say("", f"solve_f[{j}] -= {self.below(self.of(x), self.row(a[i]))};")
        for m, i, x in border:
            if self.moves(x):
                self.say("", f"solve_f[{i}] += {self.below(self.of(x), self.row(lam[m]))};")
                self.say("", f"solve_g[{m}] -= {self.below(self.of(x), self.row(a[i]))};")
        if k:
            factors = ", ".join(f"&{self.store('', size)}" for size in (n * n, k, n, k * n, k * k))
            kept = f"&{M}, &{J}, {factors}, (long *)&{self.store('', k + 3)}"
            self.say(f"solve_factors({kept});")
            self.say(*2 * (f"solve_by({kept}, solve_f, solve_g);",))
        else:
            self.say(*(f"(void)solve_g, solve_plain{by}(&{M}, solve_f);" for by in ("", "_by")))
        for place, x in zip(unknown, solve.unknowns, strict=True):
            self.define(x, f"own_{len(self.named)}", place, place)


# -------- series ----------------------------------------------------------------------------------------------
# Program -> the power series of its motion, compiled, and the order to which they go.


LEAST, MOST = 3, 20  # orders: the highest is what 1e-16 needs
ALONE = 24.0  # products in addition to its sums that a coefficient takes where one motion is followed: measured


@dataclass(frozen=True)
class Series:
    """Compiled functions of the series of a motion.

    Args:
        address: of that which gives the coefficients; along: of that which gives x and x' by them.
        size: the first works in so many numbers.
        kept: object that keeps it alive.
    """

    address: int
    along: int
    size: int
    kept: Any


def series_of(program: Program, order: int) -> Series | None:
    """The series of a program in C, up to an order; None if it has none.

    Raises:
        RunFailed, ToolMissing: as of `library`.
    """
    if without_series(program):
        return None
    text, size = series_text(program, C, order)
    made = statements(program, C, "dx", "eomgen_")
    kernels = made.texts(C)[: -len(made.bodies)]
    found = library("\n".join(["#include <math.h>\n#include <string.h>", *kernels, text]), by=vector_compiler())
    functions = (function_of(found, f"eomgen_{name}") for name in ("series", "along"))
    series, along = (ctypes.cast(each, ctypes.c_void_p).value or 0 for each in functions)
    return Series(series, along, size, found)


def order_for(rtol: float, *, alone: bool = False) -> int:
    """The order of the series at a relative tolerance, where many motions are followed together, or one alone."""
    return cheapest_order(rtol, ALONE if alone else 0.0)


def cheapest_order(rtol: float, beside: float) -> int:
    """The order that costs least at a relative tolerance: 1 + p, p (p + beside) exp(-ln(rtol)/p) least.

    A step goes as far as exp(ln(rtol)/p), and takes p^2 products in its sums, and in addition p times so much as
    `beside` of them: then 1/p + 1/(p + beside) = -ln(rtol)/p^2, which is p = -ln(rtol)/2 where `beside` is 0.

    Source: Jorba & Zou, Experimental Mathematics 14 (2005), 99-117.
    """
    digits = -math.log(rtol)
    least = (digits - beside + math.hypot(digits - beside, math.sqrt(8 * beside * digits))) / 4
    return min(MOST, max(LEAST, math.ceil(1 + least)))
