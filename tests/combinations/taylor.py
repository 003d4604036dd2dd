"""Numbers that move: a value with its first two Taylor coefficients along many curves at once.

    x(s) = c[0] + c[1] s + c[2] s^2,      shape (3, ..., n): n curves, the last axis

Part of the oracle: imports nothing of eomgen.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class Jet:
    """A quantity along n curves, to second order."""

    __slots__ = ("c",)
    __array_ufunc__ = None

    def __init__(self, c: np.ndarray) -> None:
        self.c = np.asarray(c, dtype=float)

    @property
    def value(self) -> float:
        """At s = 0 of the first curve."""
        return float(self.c[0][..., 0])

    def rate(self) -> Jet:
        """d/ds, known to one order less."""
        return Jet(np.stack([self.c[1], 2 * self.c[2], np.zeros_like(self.c[2])]))

    def __add__(self, other: Any) -> Jet:
        b = jet(other)
        return Jet(self.c + b.c)

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet(-self.c)

    def __sub__(self, other: Any) -> Jet:
        return self + (-jet(other))

    def __rsub__(self, other: Any) -> Jet:
        return jet(other) - self

    def __mul__(self, other: Any) -> Jet:
        if isinstance(other, (int, float)):
            return Jet(self.c * other)
        a, b = self.c, jet(other).c
        return Jet(np.stack([a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[1] * b[1] + a[2] * b[0]]))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Jet:
        if isinstance(other, (int, float)):
            return Jet(self.c / other)
        return self * jet(other).of(lambda x: 1 / x, lambda x: -1 / x**2, lambda x: 2 / x**3)

    def __rtruediv__(self, other: Any) -> Jet:
        return jet(other) / self

    def of(self, f: Any, d: Any, dd: Any) -> Jet:
        """f of it, with f' and f''."""
        x = self.c[0]
        slope = d(x)
        return Jet(np.stack([f(x), slope * self.c[1], slope * self.c[2] + dd(x) / 2 * self.c[1] ** 2]))

    def power(self, e: Any) -> Jet:
        """It to a power, a number where that can be."""
        if isinstance(e, Jet) and not np.any(e.c[1:]) and np.ptp(e.c[0]) == 0:
            e = float(e.c[0].flat[0])
        if isinstance(e, Jet):
            return exp(e * log(self))
        if e == 0:
            return jet(1.0)
        if e == 1:
            return self
        if e == 2:
            return self * self
        return self.of(lambda x: x**e, lambda x: e * x ** (e - 1), lambda x: e * (e - 1) * x ** (e - 2))


def jet(x: Any) -> Jet:
    """A constant as a Jet of one curve (that stands for all)."""
    if isinstance(x, Jet):
        return x
    x = np.asarray(x, dtype=float)[..., None]
    return Jet(np.stack([x, np.zeros_like(x), np.zeros_like(x)]))


def sin(x: Any) -> Jet:
    return jet(x).of(np.sin, np.cos, lambda y: -np.sin(y))


def cos(x: Any) -> Jet:
    return jet(x).of(np.cos, lambda y: -np.sin(y), lambda y: -np.cos(y))


def exp(x: Any) -> Jet:
    return jet(x).of(np.exp, np.exp, np.exp)


def log(x: Any) -> Jet:
    return jet(x).of(np.log, lambda y: 1 / y, lambda y: -1 / y**2)


def sqrt(x: Any) -> Jet:
    return jet(x).of(np.sqrt, lambda y: 0.5 / np.sqrt(y), lambda y: -0.25 / y**1.5)


def absolute(x: Any) -> Jet:
    x = jet(x)
    return x * Jet(np.stack([np.sign(x.c[0]), 0 * x.c[0], 0 * x.c[0]]))


def sign(x: Any) -> Jet:
    x = jet(x)
    return Jet(np.stack([np.sign(x.c[0]), 0 * x.c[0], 0 * x.c[0]]))


def pick(a: Any, b: Any, least: bool) -> Jet:
    """min or max of two, by their values on the first curve; at a constraint by their rates, each curve for itself."""
    a, b = together(jet(a), jet(b))
    first = a.c[0] <= b.c[0] if least else a.c[0] >= b.c[0]
    return Jet(np.where(first, a.c, b.c))


def atan2(y: Any, x: Any) -> Jet:
    y, x = together(jet(y), jet(x))
    r2 = x.c[0] ** 2 + y.c[0] ** 2
    slope = (x * y.rate() - y * x.rate()) / (x * x + y * y)
    return Jet(np.stack([np.arctan2(y.c[0], x.c[0]) + 0 * r2, slope.c[0], slope.c[1] / 2]))


FUNCTIONS = {
    "sin": sin,
    "cos": cos,
    "exp": exp,
    "log": log,
    "sqrt": sqrt,
    "abs": absolute,
    "sign": sign,
    "atan2": atan2,
    "tan": lambda x: jet(x).of(np.tan, lambda y: 1 + np.tan(y) ** 2, lambda y: 2 * np.tan(y) * (1 + np.tan(y) ** 2)),
    "atan": lambda x: jet(x).of(np.arctan, lambda y: 1 / (1 + y * y), lambda y: -2 * y / (1 + y * y) ** 2),
    "asin": lambda x: jet(x).of(np.arcsin, lambda y: (1 - y * y) ** -0.5, lambda y: y * (1 - y * y) ** -1.5),
    "acos": lambda x: jet(x).of(np.arccos, lambda y: -((1 - y * y) ** -0.5), lambda y: -y * (1 - y * y) ** -1.5),
    "sinh": lambda x: jet(x).of(np.sinh, np.cosh, np.sinh),
    "cosh": lambda x: jet(x).of(np.cosh, np.sinh, np.cosh),
    "tanh": lambda x: jet(x).of(
        np.tanh, lambda y: 1 - np.tanh(y) ** 2, lambda y: -2 * np.tanh(y) * (1 - np.tanh(y) ** 2)
    ),
}


def together(a: Jet, b: Jet) -> tuple[Jet, Jet]:
    """Both with as many curves."""
    shape = np.broadcast_shapes(a.c.shape, b.c.shape)
    return Jet(np.broadcast_to(a.c, shape)), Jet(np.broadcast_to(b.c, shape))


def vector(entries: Any) -> Jet:
    """Jets (numbers among them) as one column: shape (3, rows, n)."""
    jets = [jet(x).c for x in entries]
    n = max(x.shape[-1] for x in jets)
    return Jet(np.stack([np.broadcast_to(x, (3, n)) for x in jets], axis=1))


def component(a: Jet, *index: int) -> Jet:
    return Jet(a.c[(slice(None), *index)])


def matmul(A: Any, B: Any) -> Jet:
    """A B of two matrices, or of a matrix and a column."""
    a, b = jet(A).c, jet(B).c
    form = "ijn,jkn->ikn" if b.ndim == 4 else "ijn,jn->in"

    def product(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        n = max(x.shape[-1], y.shape[-1])
        x, y = np.broadcast_to(x, (*x.shape[:-1], n)), np.broadcast_to(y, (*y.shape[:-1], n))
        return np.einsum(form, x, y)

    return Jet(
        np.stack(
            [
                product(a[0], b[0]),
                product(a[0], b[1]) + product(a[1], b[0]),
                product(a[0], b[2]) + product(a[1], b[1]) + product(a[2], b[0]),
            ]
        )
    )


def transpose(A: Jet) -> Jet:
    return Jet(np.swapaxes(A.c, 1, 2))


def dot(a: Any, b: Any) -> Jet:
    p = jet(a) * jet(b)
    return Jet(p.c.sum(axis=1))


def cross(a: Any, b: Any) -> Jet:
    a, b = jet(a), jet(b)
    x = [component(a, i) for i in range(3)]
    y = [component(b, i) for i in range(3)]
    return vector([x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]])


def norm(a: Jet) -> Jet:
    return sqrt(dot(a, a))


def turn(axis: Any, angle: Any) -> Jet:
    """The rotation by an angle about a constant axis (Rodrigues)."""
    e = np.asarray(axis, dtype=float)
    e = e / np.linalg.norm(e)
    K = np.array([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]])
    s, c = sin(angle), cos(angle)
    return jet(np.eye(3)) + _spread(s, K) + _spread(1 - c, K @ K)


def _spread(x: Jet, K: np.ndarray) -> Jet:
    return Jet(x.c[:, None, None, :] * K[None, :, :, None])


def vee(A: Jet) -> Jet:
    """The vector of the skew part of a matrix."""
    c = A.c
    rows = [(c[:, 2, 1] - c[:, 1, 2]) / 2, (c[:, 0, 2] - c[:, 2, 0]) / 2, (c[:, 1, 0] - c[:, 0, 1]) / 2]
    return Jet(np.stack(rows, axis=1))
