"""Centrodes, an instant -> a panel: the curve in the ground, and the body's own that rolls on it, as it lies then."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import compiled
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.centrodes import Centrodes
from eomgen.mechanics.fields.field import field_of
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED

STEPS = 240  # to each side
FAR = 8.0  # sizes of the mechanism beyond which a centre is not drawn
FIXED, MOVING = "#2f5d8a", "#b03a2e"


def centrode_panel(panel: Any, system: System, centrodes: Centrodes, values: State) -> None:
    """Draw both centrodes of a body.

    Args:
        panel: matplotlib axes.
        values: numbers of t, the coordinates, speeds and parameters at the instant.
    """
    way = _configurations(system, centrodes.body, values)
    size = _size(system, values)
    fixed = _cut(_places(centrodes.fixed, way), size)
    moving = _cut(_in_ground(system, centrodes.body, _places(centrodes.moving, way), values), size)
    panel.plot(*fixed.T, color=FIXED, linewidth=1.6, label="fixed centrode")
    panel.plot(*moving.T, color=MOVING, linewidth=1.3, linestyle="--", label="moving centrode")
    now = _places(centrodes.fixed, [values])[0]
    if np.all(np.isfinite(now)):
        panel.plot(*now, "o", color="black", markersize=4)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_title(f"centrodes of {centrodes.body}".replace("$", r"\$"), fontsize=10)
    panel.legend(fontsize=8)


def _places(place: tuple[Scalar, ...], way: list[State]) -> np.ndarray:
    """A place in the plane at each of the configurations."""
    return np.array([evaluate(place[:2], values, FLOAT) for values in way], dtype=float)


def _in_ground(system: System, body: str, places: np.ndarray, values: State) -> np.ndarray:
    """Places of a body, where they are in the ground at the instant."""
    pose = system.motion.link(body).pose
    turn = np.array(evaluate([x for row in pose.R[:2] for x in row[:2]], values, FLOAT), dtype=float).reshape(2, 2)
    moved: np.ndarray = places @ turn.T + np.array(evaluate(pose.p[:2], values, FLOAT), dtype=float)
    return moved


def _cut(places: np.ndarray, size: float) -> np.ndarray:
    """What is too far away breaks the line."""
    near = places[np.isfinite(places).all(axis=1)]
    middle = np.median(near, axis=0) if len(near) else np.zeros(2)
    far = ~np.isfinite(places).all(axis=1) | (np.abs(places - middle).max(axis=1) > FAR * size)
    return np.where(far[:, None], np.nan, places)


def _size(system: System, values: State) -> float:
    """The size of the mechanism: the largest distance of a point from its body's origin."""
    points = [x for body in system.motion.points.values() for place in body.values() for x in place]
    found = [abs(x) for x in evaluate(points, values, FLOAT) if math.isfinite(x)]
    return max(found, default=0.0) or 1.0


def _configurations(system: System, body: str, values: State) -> list[State]:
    """Configurations before and after the instant, of the one freedom, or in time."""
    symbols, scope = system.symbols, system.scope
    if symbols.u:
        rates, length = (0, *(row[0] for row in scope.N)), _reach(system, values)
    else:
        spin = abs(float(evaluate((field_of(system.motion, body).w[2],), values, FLOAT)[0]))
        rates, length = (1, *scope.rates), math.pi / spin if spin > COMPUTED else 1.0
    slope = _slope(system, rates, values)
    before, after = (_followed(system, slope, values, sign * length / STEPS) for sign in (-1, 1))
    return [*reversed(before), values, *after]


def _reach(system: System, values: State) -> float:
    """How far the one freedom is followed to each side: half a turn of an angle, else sizes of the mechanism."""
    symbols = system.symbols
    leading = next(q for q, rate in zip(symbols.q, system.scope.rates, strict=True) if rate is symbols.u[0])
    poses = [x for link in system.motion.links for row in link.pose.R for x in row]
    turns = any(node.op in ("sin", "cos") and depends_on(node, (leading,)) for node in order(poses))
    return math.pi if turns else 2 * _size(system, values)


PlaneSlope = Callable[[np.ndarray], np.ndarray]


def _slope(system: System, rates: tuple[Scalar, ...], values: State) -> PlaneSlope:
    """The rates as functions of t and the coordinates."""
    symbols = system.symbols
    function = compiled(program_of(rates, symbols), "numpy")
    p = np.array([values[node] for node in symbols.parameters.values()])
    speeds = np.ones(len(symbols.u))
    return lambda x: np.asarray(function(float(x[0]), np.append(x[1:], speeds), p), dtype=float)


def _followed(system: System, slope: PlaneSlope, values: State, step: float) -> list[State]:
    """Configurations one after the other, by Runge and Kutta's method, as far as there are any."""
    moving = (system.symbols.t, *system.symbols.q)
    x = np.array([values[node] for node in moving], dtype=float)
    found: list[State] = []
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            k1 = slope(x)
            k2 = slope(x + step / 2 * k1)
            k3 = slope(x + step / 2 * k2)
            x = x + step / 6 * (k1 + 2 * k2 + 2 * k3 + slope(x + step * k3))
            if not np.all(np.isfinite(x)):
                break
            found.append({**values, **dict(zip(moving, map(float, x), strict=True))})
    return found
