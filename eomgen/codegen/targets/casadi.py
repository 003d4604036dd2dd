"""Program -> a module for CasADi: `NAME_rhs(t, x, p, inputs=None)`; `rhs` and its `slopes` are SX functions."""

from __future__ import annotations

from dataclasses import replace

from eomgen.codegen.targets.base import by_cases
from eomgen.codegen.targets.numpy import PYTHON
from eomgen.codegen.targets.python_files import SOLVERS, python_form, python_target

UNARY = "sin cos asin acos atan sinh cosh tanh exp log sqrt".split()
_ARRAYS = """
def _matrix(rows, n, k):
    return ca.SX(n, k) if not rows else ca.vertcat(*(ca.horzcat(*row) for row in rows))


def _where_positive(x, a, b):
    return ca.if_else(x > 0, a, b)


def _factors(A):
    return ca.chol(ca.densify(A))


def _solved(factors, B):
    return ca.solve(factors, ca.solve(factors.T, ca.densify(B)))


_one = ca.SX.eye
"""
CASADI = replace(
    PYTHON,
    reserved=PYTHON.reserved | {"ca"},
    functions={
        **{op: f"ca.{op}({{0}})" for op in UNARY},
        "abs": "ca.fabs({0})",
        "atan2": "ca.atan2({0}, {1})",
        "pow": "ca.power({0}, {1})",
        "select": "select({0}, {1}, {2})",
    },
    defined={
        **by_cases(
            "def {name}({arguments}):\n    return {value}\n\n",
            "ca.if_else({condition}, {value}, {otherwise})",
            words={"nan": 'float("nan")'},
            only=("sign", "less", "less_equal"),
        ),
        "min": "def min(a, b):\n    return ca.if_else(a < b, a, ca.if_else(a >= b, b, a + b))\n\n",
        "max": "def max(a, b):\n    return ca.if_else(a > b, a, ca.if_else(a <= b, b, a + b))\n\n",
        "select": "def select(given, a, b):\n"
        '    return ca.if_else(given == 0, b, ca.if_else(ca.logic_or(given > 0, given < 0), a, float("nan")))\n\n',
        **SOLVERS,
        "through_samples": """
def through_samples(t, n, closed, steps, depth, bounds, degree, v):
    found = 0
    for k in range(n + 1):
        s, value = t - v[(degree + 1)*(n + 1) + k], 0.0
        for i in range(degree + 1):
            value = value*s + v[i*(n + 1) + k]
        last = closed == 1 and k == n
        found = value if k == 0 else ca.if_else(t > bounds[k - 1] if last else t >= bounds[k - 1], value, found)
    return found

""",
    },
)

_TEXT = '''\
import casadi as ca

sqrt = ca.sqrt
{arrays}
{functions}


def _made(given):
    t, x, p = ca.SX.sym("t"), ca.SX.sym("x", {states}), ca.SX.sym("p", {parameters})
    {a_made}inputs = ca.SX.sym("inputs", {inputs})
    arguments = [t, x, {a}p, *([inputs] if given else [])]
    names = ["t", "x", {a_name}"p", *(["inputs"] if given else [])]
    {result} = evaluate(t, x, {a}p, constants(p), inputs if given else None)
    {result} = ca.vertcat(*{result}) if {result} else ca.SX(0, 1)
    slopes = [ca.jacobian({result}, x), *([ca.jacobian({result}, inputs)] if given else [])]
    slope_names = ["by_x", *(["by_inputs"] if given else [])]
    return (
        ca.Function("{role}", arguments, [{result}], names, ["{result}"]),
        ca.Function("{role}_by_x", arguments, slopes, names, slope_names),
    )


own, own_slopes = _made(False)  # of (t, x, {a}p), by the model's own inputs
{role}, slopes = _made(True)  # of (t, x, {a}p, inputs)


def {main}(t, x, {a}p, inputs=None):
    """{result}: {outputs} numbers, or expressions where the arguments are; inputs None: the model's own."""
    return own(t, x, {a}p) if inputs is None else {role}(t, x, {a}p, inputs)
'''


FORM = python_form(
    CASADI,
    "{others}_casadi",
    _TEXT,
    {"a_name": ('"a", ', ""), "a_made": ('a = ca.SX.sym("a", {accelerations})\n    ', "")},
    marked={"arrays": ("_factors(", _ARRAYS)},
)
USE = ("from {stem}_casadi import rhs, slopes", "python -m pytest")
TARGET = python_target("casadi", "SX functions of CasADi with their jacobians", FORM, USE)
