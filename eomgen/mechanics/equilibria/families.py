"""Places of rest -> each once: e and -e are one orientation, and of a body that may turn freely one place is enough.

Where the second variation K vanishes in some direction, places of rest can make up a whole family: a body on a ball
joint hangs at any angle about the vertical, a sleigh stands at any angle. Two places of one family have the same V and
the same spectrum of K.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from eomgen.mechanics.equilibria.static_equations import StaticEquations
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.expression.node import ScalarRows
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import CARRIED, SAME_PLACE, TINIEST, ZERO_AT_50


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
