"""System -> a drawing of a plane model in one configuration: bodies, hinges, supports, wires; arrows beside them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.mechanics.bodies.kinematics import GROUND, BodyLink
from eomgen.mechanics.bodies.loads import SystemScene
from eomgen.mechanics.equations.system import System
from eomgen.model.composite import pose_of
from eomgen.model.constraints.base import Constraint
from eomgen.model.forces.load import Couple, PointForce
from eomgen.model.trusses import is_node
from eomgen.report.figures import halo
from eomgen.report.support_symbols import GROUNDED, PagePoint, clamp, coil, hinge, pin, rail, roller, weld
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.spatial import Matrix, Pose, Vector, apply
from eomgen.symbolic.numeric.sure_numbers import numbers_of
from eomgen.symbolic.numeric.tolerances import COMPUTED

BODY, LOAD, REACTION = "#2f5d8a", "#b03a2e", "#2e7d4f"
FILL, PAPER = "#c9d8e8", "#ffffff"
SYMBOL = 0.028  # size of hinges and supports, of the drawing's extent
AWAY = 10  # from a line to its name [points]
ARROW = 0.13  # length of the longest arrow, of the extent


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
        return numbers_of(scalars, self.values)

    def place(self, point: Vector) -> PagePoint:
        """A place of the ground's axes."""
        x, y = self.numbers(point[:2])
        return x, y

    def position(self, place: tuple[str | None, Vector]) -> PagePoint:
        """Where a place of a body is."""
        return self.place(self.system.motion.position(place))

    def lines(self, link: BodyLink) -> list[np.ndarray]:
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
            points[:0] = [] if any(math.dist(seat, p) < COMPUTED for p in points) else [seat]
        return [_straightened(np.array(points))] if len(points) > 1 else []

    def outlines(self, link: BodyLink) -> list[tuple[np.ndarray, str]]:
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
            lines = [_traced(flat) for form in shape.forms(self._value) for flat in form.flat()]
            for number, line in enumerate(lines[:1] if color == PAPER else lines):
                found.append((whole(own(line)), PAPER if number else color))
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
    def points(self) -> dict[str, PagePoint]:
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


def _traced(form: Any) -> np.ndarray:
    """A form of the plane as points."""
    if form.kind != "arc":
        points = np.array([[float(x) for x in p[:2]] for p in form.points])
        return np.vstack([points, points[:1]]) if form.kind == "polygon" else points
    start, end = (0.0, math.tau) if form.start is None else (float(form.start), float(form.end))
    turns = np.linspace(start, end, 73)
    arc = np.column_stack([float(form.radius) * np.cos(turns), float(form.radius_y) * np.sin(turns)])
    return np.vstack([np.zeros((1, 2)), arc, np.zeros((1, 2))]) if form.close == "center" else arc


def draw_model(panel: Any, sketch: Sketch, *, names: bool = True, colors: Mapping[str, str] | None = None) -> None:
    """Bodies, wires, hinges and supports on matplotlib axes; the axes have equal scales and no frame.

    Args:
        names: bodies and points are named.
        colors: of bodies, where they have one of their own.
    """
    panel.set_aspect("equal")
    panel.axis("off")
    for link in sketch.system.motion.links:
        _body(panel, sketch, link, names, (colors or {}).get(link.name, BODY))
    _members(panel, sketch)
    _springs(panel, sketch)
    _joints(panel, sketch)
    if names:
        _points(panel, sketch)
    panel.margins(0.12)


# -- bodies ----------------------------------------------------------------------------------------


def _body(panel: Any, sketch: Sketch, link: BodyLink, named: bool, color: str) -> None:
    lines = sketch.lines(link)
    insides = [inside for _, inside in sketch.outlines(link)] or [FILL] * len(lines)
    for line, inside in zip(lines, insides, strict=True):
        closed = _is_closed(line)
        if closed:
            panel.fill(*line.T, color=inside, alpha=0.6 if inside == FILL else 1.0, linewidth=0)
        panel.plot(*line.T, color=color, linewidth=1.4 if closed else 2.6, solid_capstyle="round", zorder=2)
    if lines and named:
        x, y = _beside(lines[0])
        side = "right" if x < -AWAY / 2 else "left" if x > AWAY / 2 else "center"
        panel.annotate(
            _escaped(link.name),
            _middle(lines[0]),
            xytext=(x, y),
            textcoords="offset points",
            color=color,
            fontsize=9,
            ha=side,
            va="center",
            zorder=6,
            path_effects=halo(),
        )
    if not lines and not is_node(link.name):
        panel.plot(*sketch.place(link.pose.p), marker="o", markersize=6, color=color, zorder=3)


def _is_closed(line: np.ndarray) -> bool:
    return len(line) > 3 and bool(np.allclose(line[0], line[-1]))


def _middle(line: np.ndarray) -> PagePoint:
    """Half-way along the longest piece of an open line, the middle of a closed one."""
    x, y = line[:-1].mean(axis=0) if _is_closed(line) else np.mean(_longest(line), axis=0)
    return float(x), float(y)


def _beside(line: np.ndarray) -> PagePoint:
    """From the middle to the name [points]: above an open line, or left of it; nothing for a closed one."""
    if _is_closed(line):
        return (0.0, 0.0)
    a, b = _longest(line)
    x, y = b - a
    across = np.array([-y, x]) / (np.hypot(x, y) or 1.0)
    up = across if across[1] > COMPUTED or (abs(across[1]) <= COMPUTED and across[0] < 0) else -across
    return float(AWAY * up[0]), float(AWAY * up[1])


def _longest(line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The ends of its longest piece, the first of several."""
    k = int(np.argmax(np.linalg.norm(np.diff(line, axis=0), axis=1).round(9)))
    return line[k], line[k + 1]


def _straightened(points: np.ndarray) -> np.ndarray:
    """The points in their order; where all of them lie on one line, the two ends."""
    along = points[np.argmax(np.linalg.norm(points - points[0], axis=1))] - points[0]
    r = points - points[0]
    if np.max(np.abs(r[:, 0] * along[1] - r[:, 1] * along[0])) > COMPUTED * float(along @ along):
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
            panel.annotate(
                _escaped(name.rpartition(".")[2]),
                (x, y),
                xytext=(5, 5),
                textcoords="offset points",
                fontsize=8,
                color=GROUNDED,
                zorder=6,
            )


def _escaped(name: str) -> str:
    return name.replace("$", r"\$")


# -- what ties and joints look like ----------------------------------------------------------------


def _members(panel: Any, sketch: Sketch) -> None:
    """Strings, wires, links and members of trusses: lines between the places that they pull."""
    model = sketch.system.scope.model
    strings = [name for name, tie in model.constraints.items() if _string(panel, sketch, name, tie)]
    for row in sketch.system.ties.rows:
        if row.component != "tension" or row.tie in strings:
            continue
        ends = [sketch.position(push.place) for push in row.pushes if isinstance(push, PointForce)]
        for a, b in zip(ends[::2], ends[1::2], strict=False):
            panel.plot(*zip(a, b, strict=True), color=GROUNDED, linewidth=1.6, zorder=1)


def _springs(panel: Any, sketch: Sketch) -> None:
    """Zigzags: springs between points, and joints that slide against a stiffness."""
    motion = sketch.system.motion
    for force in sketch.system.scope.model.forces.values():
        if force.element is not None and force.element.spring_ends:
            _spring(panel, sketch, *(sketch.position(motion.place(point)) for point in force.element.spring_ends))
    for link in motion.links:
        efforts = () if link.joint is None else link.joint.efforts()
        slides = all(is_zero(x) for w, _ in link.S for x in w)
        if slides and any(effort is not None and effort.stiffness is not None for effort in efforts):
            above = motion.links[link.parent].pose if link.parent != GROUND else Pose()
            _spring(panel, sketch, sketch.place(above.point(link.before.p)), sketch.position((link.name, link.point)))


def _spring(panel: Any, sketch: Sketch, a: PagePoint, b: PagePoint) -> None:
    """A zigzag."""
    panel.plot(*coil(a, b, sketch.symbol / 2).T, color=GROUNDED, linewidth=1.2, zorder=1)


def _string(panel: Any, sketch: Sketch, name: str, tie: Constraint) -> bool:
    """Its straight pieces, and the pegs that it lies on; False where it is no string."""
    strands = tie.strands_at(SystemScene(sketch.system.motion, f"constraints.{name}"))
    for strand in strands:
        panel.plot(*np.transpose([sketch.place(end) for end in strand.ends]), color=GROUNDED, linewidth=1.6, zorder=1)
    pegs = {id(stop): stop for strand in strands for stop in (strand.first, strand.second) if stop.body is None}
    for peg in pegs.values():
        (radius,) = sketch.numbers((peg.offset,))
        turn = np.linspace(0, 2 * np.pi, 61)
        x, y = sketch.place(peg.center)
        panel.plot(x + radius * np.cos(turn), y + radius * np.sin(turn), color=GROUNDED, linewidth=1.0, zorder=1)
    return bool(strands)


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
        (clamp if held else hinge if between else pin)(panel, sketch.symbol, at)
    elif "n" in parts and not between:
        (row,) = (row for row in rows if row.component == "n")
        x, y = sketch.numbers(row.pushes[0].force[:2])
        roller(panel, sketch.symbol, at, math.atan2(y, x) - math.pi / 2)
    else:
        hinge(panel, sketch.symbol, at)


def _joint(panel: Any, sketch: Sketch, link: BodyLink) -> None:
    at = sketch.position((link.name, link.point))
    turning = [w for w, v in link.S if not all(is_zero(x) for x in w)]
    sliding = [v for w, v in link.S if all(is_zero(x) for x in w)]
    if link.parent != GROUND:
        (hinge if turning or sliding else weld)(panel, sketch.symbol, at)
    elif turning and not sliding:
        pin(panel, sketch.symbol, at)
    elif sliding and not turning:
        x, y = sketch.numbers(apply(link.pose.R, sliding[0])[:2])
        rail(panel, sketch.symbol, at, math.atan2(y, x))
    elif not sliding:
        clamp(panel, sketch.symbol, at)
