"""Expressions of a model file, units and samples, read by a small parser of the oracle's own.

Imports nothing of eomgen.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[^\W\d_]\w*(?:\.\w+)*)(?P<primes>'*)|(?P<op>\*\*|[-+*/^(),]))"
)

FACTORS = {
    "1": 1, "m": 1, "km": 1e3, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "ft": 0.3048,
    "kg": 1, "g": 1e-3, "mg": 1e-6, "t": 1e3, "s": 1, "ms": 1e-3, "min": 60, "h": 3600,
    "N": 1, "mN": 1e-3, "kN": 1e3, "MN": 1e6, "J": 1, "mJ": 1e-3, "kJ": 1e3, "W": 1, "kW": 1e3, "Pa": 1, "Hz": 1,
    "rad": 1, "mrad": 1e-3, "deg": np.pi / 180, "rev": 2 * np.pi, "rpm": np.pi / 30,
}  # fmt: skip


def factor(unit: str) -> float:
    """SI units in one of a product of powers, such as kg*m^2/s."""
    value, sign = 1.0, 1
    for part in re.findall(r"[*/()]|[A-Za-z0-9]+(?:\^-?\d+)?", unit):
        if part == "/":
            sign = -1
        elif part == "*":
            sign = 1 if "(" not in unit else sign
        elif part in "()":
            continue
        else:
            name, _, power = part.partition("^")
            value *= FACTORS[name] ** (sign * int(power or 1))
    return value


@lru_cache(maxsize=20000)
def parsed(text: str) -> Any:
    """A tree of tuples: ("num", x), ("name", name, primes), ("call", name, arguments), (op, a, b), ("neg", a)."""
    tokens = []
    place = 0
    while place < len(text.rstrip()):
        match = TOKEN.match(text, place)
        if match is None:
            raise ValueError(f"cannot read {text!r} at {place}")
        place = match.end()
        if match["number"]:
            tokens.append(("num", float(match["number"].replace("_", ""))))
        elif match["name"]:
            tokens.append(("name", match["name"], len(match["primes"])))
        else:
            tokens.append(("op", "^" if match["op"] == "**" else match["op"]))
    tokens.append(("end",))
    tree, rest = _sum(tokens, 0)
    if tokens[rest] != ("end",):
        raise ValueError(f"cannot read {text!r}")
    return tree


def _sum(tokens: list, i: int) -> tuple[Any, int]:
    a, i = _product(tokens, i)
    while tokens[i] in (("op", "+"), ("op", "-")):
        op = tokens[i][1]
        b, i = _product(tokens, i + 1)
        a = (op, a, b)
    return a, i


def _product(tokens: list, i: int) -> tuple[Any, int]:
    a, i = _signed(tokens, i)
    while tokens[i] in (("op", "*"), ("op", "/")):
        op = tokens[i][1]
        b, i = _signed(tokens, i + 1)
        a = (op, a, b)
    return a, i


def _signed(tokens: list, i: int) -> tuple[Any, int]:
    if tokens[i] == ("op", "-"):
        a, i = _signed(tokens, i + 1)
        return ("neg", a), i
    if tokens[i] == ("op", "+"):
        return _signed(tokens, i + 1)
    a, i = _atom(tokens, i)
    if tokens[i] == ("op", "^"):
        b, i = _signed(tokens, i + 1)
        a = ("^", a, b)
    return a, i


def _atom(tokens: list, i: int) -> tuple[Any, int]:
    token = tokens[i]
    if token[0] == "num":
        return token, i + 1
    if token == ("op", "("):
        a, i = _sum(tokens, i + 1)
        return a, i + 1
    if token[0] == "name" and tokens[i + 1] == ("op", "("):
        arguments, i = [], i + 2
        while tokens[i] != ("op", ")"):
            a, i = _sum(tokens, i)
            arguments.append(a)
            i += tokens[i] == ("op", ",")
        return ("call", token[1] + "'" * token[2], tuple(arguments)), i + 1
    if token[0] == "name":
        return token, i + 1
    raise ValueError(f"unexpected {token}")


def evaluated(tree: Any, name: Callable, call: Callable) -> Any:
    """The value of a tree; `name(name, primes)` and `call(function, trees)` give what stands in it."""
    from taylor import jet

    kind = tree[0]
    if kind == "num":
        return tree[1]
    if kind == "name":
        return name(tree[1], tree[2])
    if kind == "call":
        return call(tree[1], tree[2])
    a = evaluated(tree[1], name, call)
    if kind == "neg":
        return -a
    b = evaluated(tree[2], name, call)
    if kind == "+":
        return a + b
    if kind == "-":
        return a - b
    if kind == "*":
        return a * b
    if kind == "/":
        return a / b
    return a**b if isinstance(a, float) and isinstance(b, float) else jet(a).power(b)


def names_in(tree: Any) -> set[str]:
    if tree[0] == "name":
        return {tree[1]}
    if tree[0] == "call":
        return set().union(*(names_in(x) for x in tree[2]), set())
    return set().union(*(names_in(x) for x in tree[1:] if isinstance(x, tuple)), set())
