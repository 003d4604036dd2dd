"""Program -> a module for JAX in doubles: `NAME_rhs(t, x, p, inputs=None)`, to be jitted, mapped and differentiated."""

from __future__ import annotations

from dataclasses import replace

from eomgen.codegen.targets.base import SingleWords, by_cases
from eomgen.codegen.targets.numpy import PYTHON
from eomgen.codegen.targets.python_files import SOLVERS, python_form, python_target

UNARY = {
    **{op: f"jnp.{op}" for op in "sin cos sinh cosh tanh exp log abs sign".split()},
    **{"asin": "jnp.arcsin", "acos": "jnp.arccos", "atan": "jnp.arctan"},
}
BINARY = {"atan2": "jnp.arctan2", "pow": "jnp.power", "min": "jnp.minimum", "max": "jnp.maximum"}
_ARRAYS = """
def _matrix(rows, n, k):
    return jnp.array([x for row in rows for x in row]).reshape(n, k)


def _where_positive(x, a, b):
    return jnp.where(x > 0, a, b)


def _factors(A):
    return cho_factor(A)


def _solved(factors, B):
    return cho_solve(factors, B)


_one = jnp.eye
"""
JAX = replace(
    PYTHON,
    reserved=PYTHON.reserved | {"jnp"},
    functions={
        **{op: f"{name}({{0}})" for op, name in UNARY.items()},
        **{op: f"{name}({{0}}, {{1}})" for op, name in BINARY.items()},
    },
    defined={
        **by_cases(
            "def {name}({arguments}):\n    return {value}\n\n",
            "jnp.where({condition}, {value}, {otherwise})",
            number="{value}.0",
            words={"nan": "jnp.nan"},
            only=("less", "less_equal", "select"),
        ),
        **SOLVERS,
        "through_samples": """
def through_samples(t, n, closed, steps, depth, bounds, degree, v):
    bounds, v = jnp.array(bounds), jnp.array(v).reshape(degree + 2, n + 1)
    k = jnp.searchsorted(bounds, t, side="right")
    k = jnp.where((closed == 1) & (t == bounds[-1]), n - 1, k)
    s, value = t - v[degree + 1, k], 0.0
    for i in range(degree + 1):
        value = value*s + v[i, k]
    return value

""",
    },
    out=("def {name}({arguments}):\n    {out} = [0.0]*{size}", "    return jnp.array({out}, dtype=float)"),
)

_TEXT = '''\
import jax
import jax.numpy as jnp
from jax.scipy.linalg import cho_factor, cho_solve

jax.config.update("jax_enable_x64", True)


def sqrt(a):
    """sqrt with the slope 0 at 0, where that of a choice between it and something else would be nan."""
    return jnp.where(a > 0, jnp.sqrt(jnp.where(a > 0, a, 1.0)), jnp.where(a == 0, 0.0, jnp.nan))

{arrays}
{functions}


@jax.jit
def {main}(t, x, {a}p, inputs=None):
    """{result}: an array of {outputs}; inputs None: the model's own. jax.vmap({main}, (None, 0, None)): many states."""
    t, x, {a}p = jnp.asarray(t, dtype=float), jnp.asarray(x, dtype=float), {a_array}jnp.asarray(p, dtype=float)
    inputs = None if inputs is None else jnp.asarray(inputs, dtype=float)
    return evaluate(t, x, {a}p, constants(p), inputs)


{main}_by_x = jax.jit(jax.jacfwd({main}, argnums=1))  # d {result}/d x
'''


FORM = python_form(
    JAX,
    "{others}_jax",
    _TEXT,
    {"a_array": ("jnp.asarray(a, dtype=float), ", "")},
    marked={"arrays": ("_factors(", _ARRAYS)},
)
USE = ("from {stem}_jax import {stem}_rhs", "python -m pytest")
SINGLE = SingleWords(
    (
        (r'^jax\.config\.update\("jax_enable_x64", True\)\n+', ""),
        (r"\bdtype=float\b", "dtype=jnp.float32"),
        (r"\bin doubles\b", "in single precision"),
    ),
    r'"""\w+ \w+.*?"""|#[^\n]*',
    r"(^|/)(?!test_)\w+_jax\.py$|README\.md$",
)
TARGET = python_target("jax", "Python with JAX, in doubles: jit, vmap, grad", FORM, USE, SINGLE)
