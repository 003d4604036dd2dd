"""System -> a drawing of a plane model in one configuration: bodies, hinges, supports, wires; arrows beside them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.mechanics.kinematics import GROUND, Link
from eomgen.mechanics.system import System
from eomgen.model.composite import pose_of
from eomgen.model.forces.load import Couple, PointForce
from eomgen.model.trusses import is_node
from eomgen.symbolic.evaluation import FLOAT, evaluate
from eomgen.symbolic.expressions import Expression
from eomgen.symbolic.graph import Node, Scalar, is_zero
from eomgen.symbolic.spatial import Matrix, Pose, Vector, apply

BODY, GROUNDED, LOAD, REACTION = "#2f5d8a", "#5a5a5a", "#b03a2e", "#2e7d4f"
FILL, PAPER = "#c9d8e8", "#ffffff"
SYMBOL = 0.028  # size of hinges and supports, of the drawing's extent
AWAY = 10  # from a line to its name [points]
ARROW = 0.13  # length of the longest arrow, of the extent

Place = tuple[float, float]


@dataclass(frozen=True)
class Sketch:
    """A plane system in one configuration, in numbers.

    Args:
        system: the system.
        values: of t, the coordinates and the parameters.
    """

    system: System
    values: Mapping[Node, float]

    def numbers(self, scalars: Iterable[Scalar]) -> list[float]:
        """What scalars are worth there."""
        return [float(x) for x in evaluate(tuple(scalars), self.values, FLOAT)]

    def place(self, point: Vector) -> Place:
        """A place of the ground's axes."""
        x, y = self.numbers(point[:2])
        return x, y

    def position(self, place: tuple[str | None, Vector]) -> Place:
        """Where a place of a body is."""
        return self.place(self.system.motion.position(place))

    def lines(self, link: Link) -> list[np.ndarray]:
        """A body: the outlines of its shape or its parts; without them the line through its points, in their order."""
        part = self.system.scope.model.bodies.get(link.name)
        if part is None:
            return []
        if outlines := self.outlines(link):
            return [line for line, _ in outlines]
        own = self.system.motion.points[link.name]
        points = [self.position((link.name, own[name])) for name in part.points]
        if link.joint is not None and link.joint.carries_reaction:
            seat = self.position((link.name, link.point))
            points[:0] = [] if any(math.dist(seat, p) < 1e-9 for p in points) else [seat]
        return [_straightened(np.array(points))] if len(points) > 1 else []

    def outlines(self, link: Link) -> list[tuple[np.ndarray, str]]:
        """The outlines of a body's shape or parts, each with the colour inside: of a hole that of the paper."""
        part = self.system.scope.model.bodies.get(link.name)
        if part is None:
            return []
        shapes = [] if part.shape is None else [(Pose(), part.shape, FILL)]
        shapes += [(pose_of(p, self._value), p.shape, PAPER if p.hole else FILL) for p in part.parts or ()]
        whole = self._placed(link.pose.R, link.pose.p)
        found = []
        for pose, shape, color in shapes:
            own = self._placed(pose.R, pose.p)
            lines = shape.outline(self._value)
            for number, line in enumerate(lines[:1] if color == PAPER else lines):
                found.append((whole(own(np.array(line))), PAPER if number else color))
        return sorted(found, key=lambda outline: outline[1] == PAPER)

    def _placed(self, R: Matrix, p: Vector) -> Callable[[np.ndarray], np.ndarray]:
        """Points of a frame, seen from where it stands."""
        turn, origin = np.array([self.numbers(row[:2]) for row in R[:2]]), np.array(self.place(p))
        return lambda points: points @ turn.T + origin

    def _value(self, expression: Expression) -> float:
        return self.numbers((self.system.scope.value(expression),))[0]

    @cached_property
    def extent(self) -> float:
        """The larger side of the box around all bodies [m]."""
        lines = [line for link in self.system.motion.links for line in self.lines(link)]
        corners = np.vstack([np.zeros((0, 2)), *lines, *(np.array([place]) for place in self.points.values())])
        return float(np.max(np.ptp(corners, axis=0), initial=0.0)) or 1.0 if len(corners) else 1.0

    @cached_property
    def points(self) -> dict[str, Place]:
        """Every named point of the bodies and of the ground by its whole name; origins and mass centres left out."""
        motion, model = self.system.motion, self.system.scope.model
        found = {name: self.place(motion.scope.vector(place)) for name, place in model.points.items()}
        for link in motion.links:
            if is_node(link.name):
                found[link.name] = self.place(link.pose.p)
                continue
            own = model.body_points(link.name)
            for name in (name for name in own if name not in ("origin", "center")):
                found[f"{link.name}.{name}"] = self.position((link.name, motion.points[link.name][name]))
        return found

    @property
    def symbol(self) -> float:
        """The size of hinges and supports [m]."""
        return SYMBOL * self.extent


def draw_model(panel: Any, sketch: Sketch, *, names: bool = True) -> None:
    """Bodies, wires, hinges and supports on matplotlib axes; the axes have equal scales and no frame.

    Args:
        names: bodies and points are named.
    """
    panel.set_aspect("equal")
    panel.axis("off")
    for link in sketch.system.motion.links:
        _body(panel, sketch, link, names)
    _members(panel, sketch)
    _joints(panel, sketch)
    if names:
        _points(panel, sketch)
    panel.margins(0.12)


# -- bodies ----------------------------------------------------------------------------------------


def _body(panel: Any, sketch: Sketch, link: Link, named: bool) -> None:
    lines = sketch.lines(link)
    colors = [color for _, color in sketch.outlines(link)] or [FILL] * len(lines)
    for line, color in zip(lines, colors, strict=True):
        closed = _is_closed(line)
        if closed:
            panel.fill(*line.T, color=color, alpha=0.6 if color == FILL else 1.0, linewidth=0)
        panel.plot(*line.T, color=BODY, linewidth=1.4 if closed else 2.6, solid_capstyle="round", zorder=2)
    if lines and named:
        panel.annotate(_escaped(link.name), _middle(lines[0]), xytext=_beside(lines[0]), textcoords="offset points",
                       color=BODY, fontsize=9, ha="center", va="center", zorder=6)  # fmt: skip
    if not lines and not is_node(link.name):
        panel.plot(*sketch.place(link.pose.p), marker="o", markersize=6, color=BODY, zorder=3)


def _is_closed(line: np.ndarray) -> bool:
    return len(line) > 3 and bool(np.allclose(line[0], line[-1]))


def _middle(line: np.ndarray) -> Place:
    """Half-way along an open line, the middle of a closed one."""
    if _is_closed(line):
        x, y = line[:-1].mean(axis=0)
        return float(x), float(y)
    run = _run(line)
    x, y = (float(np.interp(run[-1] / 2, run, column)) for column in line.T)
    return x, y


def _beside(line: np.ndarray) -> Place:
    """From the middle to the name [points]: above an open line, or left of it; nothing for a closed one."""
    if _is_closed(line):
        return (0.0, 0.0)
    run = _run(line)
    k = min(int(np.searchsorted(run, run[-1] / 2, side="right")), len(line) - 1)
    x, y = line[k] - line[k - 1]
    across = np.array([-y, x]) / (np.hypot(x, y) or 1.0)
    up = across if across[1] > 1e-9 or (abs(across[1]) <= 1e-9 and across[0] < 0) else -across
    return float(AWAY * up[0]), float(AWAY * up[1])


def _run(line: np.ndarray) -> np.ndarray:
    """How far along the line each of its points is."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])


def _straightened(points: np.ndarray) -> np.ndarray:
    """The points in their order; where all of them lie on one line, the two ends."""
    along = points[np.argmax(np.linalg.norm(points - points[0], axis=1))] - points[0]
    r = points - points[0]
    if np.max(np.abs(r[:, 0] * along[1] - r[:, 1] * along[0])) > 1e-9 * float(along @ along):
        return points
    run = r @ along
    return points[[int(np.argmin(run)), int(np.argmax(run))]]


def _points(panel: Any, sketch: Sketch) -> None:
    """Letters of points; of several at one place the first."""
    named: dict[tuple[int, int], str] = {}
    for name, (x, y) in sketch.points.items():
        key = (round(1e4 * x / sketch.extent), round(1e4 * y / sketch.extent))
        if key not in named:
            named[key] = name
            panel.annotate(_escaped(name.rpartition(".")[2]), (x, y), xytext=(5, 5), textcoords="offset points",
                           fontsize=8, color=GROUNDED, zorder=6)  # fmt: skip


def _escaped(name: str) -> str:
    return name.replace("$", r"\$")


# -- what ties and joints look like ----------------------------------------------------------------


def _members(panel: Any, sketch: Sketch) -> None:
    """Wires, links and members of trusses: lines between the places that they pull."""
    for row in sketch.system.ties.rows:
        if row.component != "tension":
            continue
        ends = [sketch.position(push.place) for push in row.pushes if isinstance(push, PointForce)]
        for a, b in zip(ends[::2], ends[1::2], strict=False):
            panel.plot(*zip(a, b, strict=True), color=GROUNDED, linewidth=1.6, zorder=1)


def _joints(panel: Any, sketch: Sketch) -> None:
    """Hinges and supports, by what they can carry."""
    owners: dict[str, list[Any]] = {}
    for row in sketch.system.ties.rows:
        owners.setdefault(row.tie, []).append(row)
    for rows in owners.values():
        _tie(panel, sketch, rows)
    for link in sketch.system.motion.links:
        if link.joint is not None and link.joint.carries_reaction:
            _joint(panel, sketch, link)


def _tie(panel: Any, sketch: Sketch, rows: Sequence[Any]) -> None:
    pushes = [push for row in rows for push in row.pushes if isinstance(push, PointForce)]
    parts = {row.component for row in rows}
    if not pushes or "tension" in parts:
        return
    at = sketch.position(pushes[0].place)
    between = len({push.place[0] for push in pushes if push.place[0] is not None}) > 1
    held = any(isinstance(push, Couple) for row in rows for push in row.pushes)
    if {"x", "y"} <= parts:
        (_clamp if held else _hinge if between else _pin)(panel, sketch, at)
    elif "n" in parts and not between:
        (row,) = (row for row in rows if row.component == "n")
        x, y = sketch.numbers(row.pushes[0].force[:2])
        _roller(panel, sketch, at, math.atan2(y, x) - math.pi / 2)
    else:
        _hinge(panel, sketch, at)


def _joint(panel: Any, sketch: Sketch, link: Link) -> None:
    at = sketch.position((link.name, link.point))
    turning = [w for w, v in link.S if not all(is_zero(x) for x in w)]
    sliding = [v for w, v in link.S if all(is_zero(x) for x in w)]
    if link.parent != GROUND:
        (_hinge if turning or sliding else _weld)(panel, sketch, at)
    elif turning and not sliding:
        _pin(panel, sketch, at)
    elif sliding and not turning:
        x, y = sketch.numbers(apply(link.pose.R, sliding[0])[:2])
        _rail(panel, sketch, at, math.atan2(y, x))
    elif not sliding:
        _clamp(panel, sketch, at)


def _turned(at: Place, turn: float, points: Iterable[Place]) -> np.ndarray:
    c, s = math.cos(turn), math.sin(turn)
    return np.array([(at[0] + c * x - s * y, at[1] + s * x + c * y) for x, y in points])


def _hinge(panel: Any, sketch: Sketch, at: Place, turn: float = 0.0) -> None:
    panel.plot(*at, marker="o", markersize=6, markerfacecolor="white", markeredgecolor=GROUNDED, zorder=5)


def _weld(panel: Any, sketch: Sketch, at: Place) -> None:
    panel.plot(*at, marker="s", markersize=5, color=GROUNDED, zorder=5)


def _pin(panel: Any, sketch: Sketch, at: Place, turn: float = 0.0) -> None:
    d = sketch.symbol
    panel.fill(*_turned(at, turn, [(0, 0), (-d, -1.7 * d), (d, -1.7 * d)]).T, facecolor="white", edgecolor=GROUNDED,
               zorder=4)  # fmt: skip
    _ground(panel, sketch, at, turn, -1.7 * d)
    _hinge(panel, sketch, at)


def _roller(panel: Any, sketch: Sketch, at: Place, turn: float) -> None:
    d = sketch.symbol
    panel.fill(*_turned(at, turn, [(0, 0), (-d, -1.4 * d), (d, -1.4 * d)]).T, facecolor="white", edgecolor=GROUNDED,
               zorder=4)  # fmt: skip
    wheel = [(0.28 * d * math.cos(a), 0.28 * d * math.sin(a) - 1.7 * d) for a in np.linspace(0, 2 * math.pi, 25)]
    for side in (-0.55 * d, 0.55 * d):
        panel.plot(*_turned(at, turn, [(x + side, y) for x, y in wheel]).T, color=GROUNDED, linewidth=0.9, zorder=4)
    _ground(panel, sketch, at, turn, -2.0 * d)
    _hinge(panel, sketch, at)


def _clamp(panel: Any, sketch: Sketch, at: Place) -> None:
    d = sketch.symbol
    panel.plot(*at, marker="s", markersize=7, color=GROUNDED, zorder=5)
    _ground(panel, sketch, at, 0.0, -0.5 * d)


def _rail(panel: Any, sketch: Sketch, at: Place, turn: float) -> None:
    d = sketch.symbol
    panel.plot(*_turned(at, turn, [(-3 * d, 0), (3 * d, 0)]).T, color=GROUNDED, linewidth=0.9, zorder=1)
    panel.plot(*at, marker="s", markersize=7, markerfacecolor="white", markeredgecolor=GROUNDED, zorder=4)


def _ground(panel: Any, sketch: Sketch, at: Place, turn: float, below: float) -> None:
    """A line with hatching."""
    d = sketch.symbol
    panel.plot(*_turned(at, turn, [(-1.7 * d, below), (1.7 * d, below)]).T, color=GROUNDED, linewidth=1.2, zorder=4)
    for k in range(6):
        x = (-1.5 + 0.6 * k) * d
        panel.plot(*_turned(at, turn, [(x, below), (x - 0.5 * d, below - 0.6 * d)]).T, color=GROUNDED, linewidth=0.7,
                   zorder=4)  # fmt: skip
