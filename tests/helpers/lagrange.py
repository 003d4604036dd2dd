"""Lagrange's equations by plain sympy, in numbers: an engine of its own, to compare with.

d/dt dT/dq' - d(T - V)/dq + dD/dq' = Q + (dphi/dq)^T lam,   phi = 0
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import sympy

t = sympy.Symbol("t")


@dataclass(frozen=True)
class Frame:
    """Symbols of a system: `q["x"]`, its rate `u["x"]`, its acceleration `a["x"]`, parameters and inputs `p["m"]`.

    Args:
        names: the free coordinates.
        given: {coordinate: its rate, a function of t} of the driven ones.
        constants: parameters and inputs.
    """

    names: Sequence[str]
    given: Mapping[str, Any]
    constants: Sequence[str]

    @property
    def q(self) -> dict[str, Any]:
        return {n: sympy.Symbol(f"q_{n}") for n in (*self.names, *self.given)}

    @property
    def u(self) -> dict[str, Any]:
        return {n: sympy.Symbol(f"u_{n}") for n in self.names} | dict(self.given)

    @property
    def a(self) -> dict[str, Any]:
        return {n: sympy.Symbol(f"a_{n}") for n in self.names}

    @property
    def p(self) -> dict[str, Any]:
        return {n: sympy.Symbol(f"p_{n}") for n in self.constants}

    def rate(self, x: Any) -> Any:
        """dx/dt"""
        x = sympy.sympify(x)
        total = x.diff(t) + sum(x.diff(q) * self.u[n] for n, q in self.q.items())
        return total + sum(x.diff(self.u[n]) * a for n, a in self.a.items())

    def square(self, *place: Any) -> Any:
        """v^2 of a place."""
        return sum(self.rate(x) ** 2 for x in place)


@dataclass(frozen=True)
class Book:
    """What is known of a system.

    Args:
        T, V, D: kinetic and potential energy [J], half the power that dampers take [W].
        Q: generalized forces of the rest.
        phi: what the constraints keep at zero.
        outputs: the value of each output of the model.
    """

    T: Any
    V: Any = sympy.Integer(0)
    D: Any = sympy.Integer(0)
    Q: Mapping[str, Any] = field(default_factory=dict)
    phi: Sequence[Any] = ()
    outputs: Mapping[str, Any] = field(default_factory=dict)


def accelerations(frame: Frame, book: Book) -> Callable[..., np.ndarray]:
    """a(t, q, u, p), each argument after t a list of numbers, by a dense solve of the bordered system."""
    a, gaps = list(frame.a.values()), [frame.rate(frame.rate(phi)) for phi in book.phi]
    still = dict.fromkeys(a, 0)
    sides = [_side(frame, book, name) for name in frame.names]
    M = sympy.Matrix([[side.diff(x) for x in a] for side in sides])
    J = sympy.Matrix(len(gaps), len(a), lambda i, j: gaps[i].diff(a[j]))
    right = sympy.Matrix([-x.subs(still) for x in (*sides, *gaps)])
    function = sympy.lambdify(_arguments(frame), (M, J, right), "numpy", cse=True)

    def solved(*state: Any) -> np.ndarray:
        M, J, right = (np.array(x, dtype=float) for x in function(*state))
        J = J.reshape(len(gaps), len(a))
        bordered = np.block([[M, -J.T], [J, np.zeros((len(gaps), len(gaps)))]])
        return np.linalg.solve(bordered, right.ravel())[: len(a)]

    return solved


def _side(frame: Frame, book: Book, name: str) -> Any:
    """d/dt dT/dq' - d(T - V)/dq + dD/dq' - Q"""
    q, u = frame.q[name], frame.u[name]
    conservative = frame.rate(sympy.diff(book.T, u)) - sympy.diff(book.T - book.V, q)
    return sympy.sympify(conservative + sympy.diff(book.D, u) - book.Q.get(name, 0))


def numbers(frame: Frame, expressions: Sequence[Any]) -> Callable[..., list[float]]:
    """The expressions as a function of t, q, u, p, a."""
    return sympy.lambdify([*_arguments(frame), list(frame.a.values())], list(expressions), "numpy", cse=True)


def _arguments(frame: Frame) -> list[Any]:
    free = [frame.u[n] for n in frame.names]
    return [t, [frame.q[n] for n in (*frame.names, *frame.given)], free, list(frame.p.values())]
