"""Ties -> what the rows of velocities alone really are: holonomic or not, and how many freedoms there are in position.

Over y = (q, t) a row J q' + sigma = 0 is a form w = J dq + sigma dt; rows with a gap, the norms of quaternions and
driven coordinates are others, each of them integrable. By Frobenius a row can be integrated together with these where

    dw(X, Y) = X^T (dw_b/dy_a - dw_a/dy_b) Y = 0   for all X, Y that all of them allow.

What velocities reach is spanned by the fields X and their Lie brackets [X, Y] = (dY/dy) X - (dX/dy) Y, taken until
nothing new comes: its dimension, less one for t, counts the freedoms in position (Rashevskii, Chow).
Source: Bloch, Nonholonomic Mechanics and Control, 2nd ed., sections 2.2 and 4.1.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.scope import primitive
from eomgen.mechanics.bodies.system_scene import SystemScene
from eomgen.mechanics.constraints.closure import generic_state
from eomgen.mechanics.constraints.ties import Row, Ties, holds_identically
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import simplest
from eomgen.symbolic.expression.derivative import depends_on, gradient, jacobian, tangent
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import CERTAIN_AT_50, RANK
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size
from eomgen.symbolic.solve.linear_systems import LinearSystem, Pivots, general_solution

LONGEST = 400  # characters of a form that is integrated in closed form

DifferentialForm = tuple[Scalar, ...]


@dataclass(frozen=True)
class VelocityRow:
    """A row of velocities alone.

    Args:
        tie, number: the row, from 1.
        integrable: it says the same as a gap.
        integral: phi(q, t), 0 at the start, that it keeps at zero, where it was found in closed form; else None.
    """

    tie: str
    number: int
    integrable: bool
    integral: Scalar | None = None


@dataclass(frozen=True)
class Integrability:
    """What the rows of velocities alone are.

    Args:
        rows: each of them.
        positions: the freedoms in position; those in velocity are fewer where rows are not integrable.
    """

    rows: tuple[VelocityRow, ...]
    positions: int


@dataclass(frozen=True)
class _Forms:
    """The rows as forms over y = (q, t).

    Args:
        y: the coordinates, then t.
        held: of the rows that are integrable by what they are.
        moving: (row, form) of those of velocities alone.
        state: a generic one in which the ties hold.
    """

    ties: Ties
    y: tuple[Node, ...]
    held: tuple[DifferentialForm, ...]
    moving: tuple[tuple[Row, DifferentialForm], ...]
    state: State

    def values(self, scalars: Sequence[Scalar]) -> list[Any]:
        return evaluate(scalars, self.state, fifty_digits())

    def numbers(self, scalars: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in self.values(scalars)])

    def allowed(self, forms: Sequence[DifferentialForm]) -> np.ndarray:
        """A basis of what these forms and the held ones allow, one in each column."""
        rows = [self.numbers(form) for form in (*self.held, *forms)]
        A = np.array([row / (np.linalg.norm(row) or 1) for row in rows])
        _, sizes, V = np.linalg.svd(A)
        return V[int(np.sum(sizes > RANK)) :].T

    def closes(self, form: DifferentialForm, allowed: np.ndarray) -> bool:
        """dw(X, Y) = 0 of all that is allowed."""
        n = len(self.y)
        slopes = self.numbers([x for row in jacobian(form, self.y) for x in row]).reshape(n, n)
        turning = slopes.T - slopes  # entry (a, b): dw_b/dy_a - dw_a/dy_b
        size = max(1.0, float(np.abs(turning).max(initial=0)))
        return bool(np.abs(allowed.T @ turning @ allowed).max(initial=0) < RANK * size)


def integrability_of(ties: Ties) -> Integrability | None:
    """What the closing rows of velocities alone are; None where there are none.

    Args:
        ties: over the rates, before any elimination.
    Raises:
        MissingValues, DerivationError: the ties do not close near the start.
    """
    moving = tuple(row for row in ties.closing if row.gap is None)
    if not moving:
        return None
    forms = _forms_of(ties, generic_state(ties))
    together = forms.allowed([form for _, form in forms.moving])
    complete = all(forms.closes(form, together) for _, form in forms.moving)
    rows = [_judged(forms, row, form, complete) for row, form in forms.moving]
    reached = together.shape[1] if complete else _reached(forms)
    return Integrability(tuple(rows), reached - 1)


def _judged(forms: _Forms, row: Row, form: DifferentialForm, complete: bool) -> VelocityRow:
    alone = forms.closes(form, forms.allowed([form]))
    return VelocityRow(row.tie, row.number, alone or complete, integral_of(forms.ties, form) if alone else None)


def _forms_of(ties: Ties, state: State) -> _Forms:
    scope = ties.motion.scope
    q, t = scope.symbols.q, scope.symbols.t
    free = [k for k, x in enumerate(q) if not scope.model.coordinates[x.name].driven]

    def form(entries: dict[int, Scalar], at_rest: Scalar) -> DifferentialForm:
        return (*(entries.get(k, 0) for k in range(len(q))), at_rest)

    rows = [
        (row, form(dict(zip(free, J, strict=True)), sigma))
        for row, J, sigma in zip(ties.closing, ties.J, ties.sigma, strict=True)
    ]
    driven = [form({k: 1}, -nu) for k, nu in enumerate(scope.nu) if k not in free]
    norms = [form({q.index(e): e for e in four}, 0) for four in scope.quaternions]
    held = (*(w for row, w in rows if row.gap is not None), *driven, *norms)
    return _Forms(ties, (*q, t), held, tuple((row, w) for row, w in rows if row.gap is None), state)


# -- what is reached -------------------------------------------------------------------------------


def _reached(forms: _Forms) -> int:
    """The dimension that the allowed fields and their brackets span."""
    first = _fields(forms)
    found = [(X, forms.numbers(X)) for X in first]
    most, newest = len(forms.y) - _rank([forms.numbers(w) for w in forms.held]), first
    while newest and len(found) < most:
        brackets = [_bracket(forms.y, X, Y) for X in first for Y in newest]
        newest = []
        for field in brackets:
            value = forms.numbers(field)
            if np.linalg.norm(value) > CERTAIN_AT_50 and _rank([*(v for _, v in found), value]) > len(found):
                found.append((field, value))
                newest.append(field)
    return len(found)


def _fields(forms: _Forms) -> list[DifferentialForm]:
    """Fields that span what all rows allow, as functions of y."""
    n = len(forms.y)
    rows = [{k: x for k, x in enumerate(w) if not is_zero(x)} for w in (*forms.held, *(w for _, w in forms.moving))]
    solution = general_solution(LinearSystem(rows, [0] * len(rows), n, forms.values), Pivots(last=(n - 1,)))
    return [
        tuple(1 if k == f else -solution.shares[k].get(f, 0) if k in solution.shares else 0 for k in range(n))
        for f in solution.free
    ]


def _bracket(y: Sequence[Node], X: DifferentialForm, Y: DifferentialForm) -> DifferentialForm:
    """[X, Y] = (dY/dy) X - (dX/dy) Y"""
    along_X, along_Y = tangent(Y, dict(zip(y, X, strict=True))), tangent(X, dict(zip(y, Y, strict=True)))
    return tuple(a - b for a, b in zip(along_X, along_Y, strict=True))


def _rank(rows: Sequence[np.ndarray]) -> int:
    scaled = [row / (np.linalg.norm(row) or 1) for row in rows]
    return int(np.linalg.matrix_rank(np.array(scaled), tol=RANK)) if scaled else 0


# -- in closed form --------------------------------------------------------------------------------


def integral_of(ties: Ties, form: DifferentialForm) -> Scalar | None:
    """phi(q, t), 0 at the start, with dphi = k w for a factor k among 1, 1/w_i and 1/(w_i w_j); None: none found."""
    scope = ties.motion.scope
    y = (*scope.symbols.q, scope.symbols.t)
    positive = scope.positive
    entries = [simplest(x, Work.FORMULA, positive) for x in form]
    if sum(text_size(x) for x in entries) > LONGEST:
        return None
    for factor in _factors(entries, y):
        try:
            found = _potential([simplest(x * factor, Work.FORMULA, positive) for x in entries], y)
        except (DerivationError, NoValue, ZeroDivisionError):  # no closed form
            found = None
        if found is not None:
            return simplest(found - SystemScene(ties.motion).start(found), Work.FORMULA, positive)
    return None


def _factors(entries: Sequence[Scalar], y: Sequence[Node]) -> list[Scalar]:
    """1, and what is no constant of the others: a constant times an integral is one."""
    own = [x for x in entries if depends_on(x, y)]
    return [1, *(over(1, x) for x in own), *(over(1, a * b) for a, b in combinations_with_replacement(own, 2))]


def _potential(form: Sequence[Scalar], y: Sequence[Node]) -> Scalar | None:
    """phi with dphi/dy_k = w_k, one variable after the other; None where the form is not exact, or none is found."""
    slopes = jacobian(form, y)
    if any(not holds_identically(slopes[a][b] - slopes[b][a]) for a in range(len(y)) for b in range(a)):
        return None
    phi: Scalar = 0
    for k, w in enumerate(form):
        rest = w - (gradient(phi, y)[k] if type(phi) is Node else 0)
        if is_zero(rest) or holds_identically(rest):
            continue
        gained = primitive(simplest(rest, Work.FORMULA), y[k])
        if gained is None:
            return None
        phi = phi + gained
    return phi if all(holds_identically(a - b) for a, b in zip(gradient(phi, y), form, strict=True)) else None
