"""Places of rest -> each once: e and -e are one orientation, and of a body that may turn freely one place is enough.

Where the second variation K vanishes in some direction, places of rest can make up a whole family: a body on a ball
joint hangs at any angle about the vertical, a sleigh stands at any angle. Two places of one family have the same V and
the same spectrum of K. Of a family that is a curve the way along it is gone, in both directions:

    F(z) = 0,   F'(z) t = 0:   z + h t, back onto F = 0 by the shortest way
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.node import ScalarRows
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.numeric.tolerances import CARRIED, SAME_PLACE, TINIEST, ZERO_AT_50


@dataclass(frozen=True)
class Curve:
    """Places of rest that make up a curve.

    Args:
        points: coordinates and multipliers along it, a row a place, the one that was found first among them.
        closed: whether it comes back to where it began, or goes on by whole turns.
    """

    points: np.ndarray
    closed: bool

    def holds(self, q: np.ndarray, turning: Sequence[bool]) -> bool:
        """Whether a place lies on it, as near as its own points lie together."""
        away = np.abs(self.points[:, : len(q)] - q)
        away = np.where(turning, np.minimum(away % math.tau, math.tau - away % math.tau), away)
        return bool(np.min(np.max(away, axis=1)) <= STRIDE)


def nearest_first(statics: StaticEquations, found: Sequence[np.ndarray], guess: np.ndarray) -> list[np.ndarray]:
    """The places with that of e and -e which is nearer to the guess, of every quaternion; the nearest first."""
    if not statics.norms:
        return list(found)
    turned = (_turned(statics, z, guess) for z in found)
    return sorted(turned, key=lambda z: float(np.sum((z[: len(guess)] - guess) ** 2)))


def each_once(statics: StaticEquations, found: Sequence[np.ndarray], floats: Mapping[Node, float]) -> list[np.ndarray]:
    """The places, the first of those that are one, or one family.

    Args:
        found: coordinates and multipliers of each, the nearest to the guess first.
        floats: of the parameters.
    """
    if not statics.q or (not statics.norms and not statics.beside):
        return list(found)
    slopes = jacobian(statics.forces, statics.q)
    kept: list[tuple[np.ndarray, np.ndarray]] = []
    for z in found:
        values = {**floats, **dict(zip(statics.unknowns, map(float, z), strict=True))}
        marks = _marks(statics, slopes, z, values)
        if not any(_is_one(statics, (z, marks), other) for other in kept):
            kept.append((z, marks))
    return [z for z, _ in kept]


def along_curves(
    statics: StaticEquations, found: Sequence[np.ndarray], floats: Mapping[Node, float], turning: frozenset[Node]
) -> list[tuple[np.ndarray, Curve | None]]:
    """The places, the first of each curve of them alone, with that.

    Args:
        found: coordinates and multipliers of each, the nearest to the guess first.
        floats: of the parameters.
        turning: coordinates for which a whole turn changes nothing.
    """
    if len(found) < 2 or statics.norms or statics.beside or not statics.q:
        return [(z, None) for z in found]
    way = _Way(statics, floats, tuple(q in turning for q in statics.q))
    kept: list[tuple[np.ndarray, Curve | None]] = []
    n = len(statics.q)
    for z in found:
        if not any(curve is not None and curve.holds(z[:n], way.turning) for _, curve in kept):
            kept.append((z, way.curve(z) if len(kept) < MOST_CURVES else None))
    return kept


STRIDE = 0.1  # of a way along a curve, in radians or metres
STRIDES = 150  # in one direction
MOST_CURVES = 12  # places of which it is tried whether they lie on one
CORRECTIONS = 6  # back onto it


@dataclass(frozen=True)
class _Way:
    """Along curves of places of rest."""

    statics: StaticEquations
    floats: Mapping[Node, float]
    turning: tuple[bool, ...]

    @cached_property
    def _slopes(self) -> ScalarRows:
        return jacobian(self.statics.equations, self.statics.unknowns)

    def _at(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(F, F') of a place."""
        values = {**self.floats, **dict(zip(self.statics.unknowns, map(float, z), strict=True))}
        equations = self.statics.equations
        flat = np.array(evaluate([*equations, *(x for row in self._slopes for x in row)], values, FLOAT), dtype=float)
        return flat[: len(equations)], flat[len(equations) :].reshape(len(equations), -1)

    def _along(self, z: np.ndarray) -> np.ndarray | None:
        """t, its part of the coordinates 1 long; None where there is not one such direction."""
        _, slopes = self._at(z)
        slopes = slopes / np.maximum(np.max(np.abs(slopes), axis=1, keepdims=True), TINIEST)
        _, sizes, axes = np.linalg.svd(slopes)
        rank = int(np.sum(sizes > CARRIED * max(sizes, default=0.0)))
        null = axes[rank:, : len(self.statics.q)]
        _, moved, mixed = np.linalg.svd(null.T) if len(null) else (None, np.zeros(0), None)
        if mixed is None or int(np.sum(moved > CARRIED)) != 1:
            return None
        t = mixed[0] @ axes[rank:]
        return np.asarray(t / np.linalg.norm(t[: len(self.statics.q)]))

    def _onto(self, z: np.ndarray, t: np.ndarray) -> np.ndarray | None:
        """The place of rest that is reached across t; None where there is none."""
        start, n = z, len(self.statics.q)
        unit = np.where(np.arange(len(z)) < n, 1.0, np.maximum(np.abs(z), 1.0))  # multipliers change as they are large
        for _ in range(CORRECTIONS):
            F, slopes = self._at(z)
            size = np.maximum(np.max(np.abs(slopes), axis=1), TINIEST)
            if np.all(np.abs(F) <= SAME_PLACE * CARRIED * size):
                return z if np.linalg.norm((z - start)[:n]) < STRIDE / 2 else None
            rows = np.vstack([slopes / size[:, None], np.append(t[:n], np.zeros(len(z) - n))]) * unit
            if not np.all(np.isfinite(rows)):
                return None
            z = z - unit * np.linalg.lstsq(rows, np.append(F / size, 0.0), rcond=CARRIED)[0]
        return None

    def curve(self, z: np.ndarray) -> Curve | None:
        """The curve on which a place lies; None where it is alone, or one of more than a curve."""
        try:
            first = self._along(z)
            if first is None:
                return None
            ways, closed = [], False
            for sign in (1, -1):
                points, closed = ([], closed) if closed else self._gone(z, sign * first)
                ways.append(points)
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            return None
        if not any(ways):
            return None
        return Curve(np.array([*reversed(ways[1]), z, *ways[0]]), closed)

    def _gone(self, z: np.ndarray, t: np.ndarray) -> tuple[list[np.ndarray], bool]:
        """(places along the curve in one direction, whether it comes back to the first)."""
        n, begun, points = len(self.statics.q), z, []
        for k in range(STRIDES):
            steps = (self._onto(z + step * t, t) for step in (STRIDE, STRIDE / 4))
            there = next((x for x in steps if x is not None), None)
            if there is None:
                break
            points.append(there)
            new = self._along(there)
            if new is None:
                break
            z, t = there, new if new[:n] @ t[:n] > 0 else -new
            away = np.abs((z - begun)[:n])
            away = np.where(self.turning, np.minimum(away % math.tau, math.tau - away % math.tau), away)
            if k > 2 and np.max(away) < STRIDE:
                return points, True
        return points, False


def _turned(statics: StaticEquations, z: np.ndarray, guess: np.ndarray) -> np.ndarray:
    """The place with that of e and -e which is nearer to the guess, of every quaternion."""
    z = z.copy()
    for four in statics.system.scope.quaternions:
        places = [statics.q.index(e) for e in four if e in statics.q]
        if places and float(z[places] @ guess[places]) < 0:
            z[places] = -z[places]
        z[places] = np.where(abs(z[places]) < ZERO_AT_50, 0.0, z[places])
    return z


def _marks(statics: StaticEquations, slopes: ScalarRows, z: np.ndarray, values: Mapping[Node, float]) -> np.ndarray:
    """V, and the eigenvalues of K along the ties, by size."""
    n = len(statics.q)
    J = statics.slopes(statics.J, z[:n], values)
    H = -np.array(evaluate([x for row in slopes for x in row], values, FLOAT), dtype=float).reshape(n, n)
    _, sizes, axes = np.linalg.svd(J)
    Z = axes[int(np.sum(sizes > CARRIED * sizes[0])) :].T
    symbols = statics.system.symbols
    given = {**{x: 0.0 for x in (*symbols.q, *symbols.u)}, symbols.t: 0.0}
    (V,) = evaluate((statics.system.loads.potential_energy,), {**_given(statics, values), **given, **values}, FLOAT)
    spectrum = np.linalg.eigvals(Z.T @ H @ Z)
    return np.array([V, *sorted(spectrum.real)], dtype=float)


def _given(statics: StaticEquations, values: Mapping[Node, float]) -> dict[Node, float]:
    found = evaluate(tuple(statics.given.values()), values, FLOAT)
    return dict(zip(statics.given, map(float, found), strict=True))


def _is_one(statics: StaticEquations, one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]) -> bool:
    """Whether two places are the same, or of one family."""
    (z, marks), (y, others) = one, other
    if np.all(abs(z - y)[: len(statics.q)] <= SAME_PLACE):
        return True
    size = TINIEST + np.max(abs(np.concatenate([marks, others])))
    flat = np.min(abs(marks[1:]), initial=np.inf) <= CARRIED * size
    return bool(flat and np.all(abs(marks - others) <= SAME_PLACE * size))
