"""Joints, constraints, force elements and loads -> marks.

Joints, constraints and force elements -> marks: hinges and supports, strings, members, springs and dampers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from typing import Any

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import GROUND, BodyLink, SystemScene
from eomgen.model import ArcForm, Couple, EllipsoidForm, LineForm, Meeting, PointForce, Stop, Strand
from eomgen.scene.bodies import gimbal_of, is_block, is_cylinder, parameters_as_drawn, seen, shaft_of, wedge_of
from eomgen.scene.forms import (
    CylinderForm,
    DamperForm,
    LabelForm,
    RodForm,
    SpringForm,
    SymbolForm,
    TrackForm,
    WheelForm,
)
from eomgen.scene.scene import Mark
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Pose,
    Scalar,
    Vector,
    function,
    is_zero,
    symbols_of,
)
from eomgen.symbolic.numeric import FLOAT, evaluate

BESIDE = 1  # of springs and dampers between the same places, each to its side [symbol units]


# -- joints ----------------------------------------------------------------------------------------


def joint_marks(system: System, link: BodyLink, frame: int) -> list[Mark]:
    """The symbol of a body's joint, by its free directions; springs and dampers in it."""
    if link.joint is None or not link.joint.carries_reaction:
        return []
    turning = [w for w, _ in link.S if not all(map(is_zero, w))]
    sliding = [v for w, v in link.S if all(map(is_zero, w))]
    draw = _plane_joint if system.scope.model.space == "plane" else _space_joint
    return [*draw(system, link, frame, turning, sliding), *_joint_elements(system, link, frame, bool(turning))]


def _plane_joint(
    system: System, link: BodyLink, frame: int, turning: Sequence[Vector], sliding: Sequence[Vector]
) -> list[Mark]:
    grounded, own = link.parent == GROUND, link.name
    above = 0 if grounded else link.parent + 1
    if len(sliding) > 1 or len(link.S) > 2:
        return []
    if sliding:
        return _guided(system, link, frame, bool(turning), sliding[0])
    if turning:
        return [Mark(SymbolForm("pin" if grounded else "hinge", link.before.p), above, "support", own)]
    return [Mark(SymbolForm("clamp" if grounded else "weld", link.before.p), above, "support", own)]


def _guided(system: System, link: BodyLink, frame: int, turns: bool, own: Vector) -> list[Mark]:
    """A block on its guide: on the ground's hatched, above it; a body that hangs on a spring has no other guide."""
    part, grounded = system.scope.model.bodies[link.name], link.parent == GROUND
    above = 0 if grounded else link.parent + 1
    if is_cylinder(link):
        return []
    if guides := link.joint.guides(system.scope.value, link.before):
        return [Mark(form, above, "track", link.name) for form in guides]
    along = link.before.R @ (link.relative.R @ own)
    upward = Vector((-along[1], along[0], 0))
    point, bare = part.shape is not None and part.shape.is_point, part.shape is None and part.parts is None
    wedge, block = wedge_of(system, link), is_block(system, link)
    on_wedge = not grounded and wedge_of(system, system.motion.links[link.parent]) is not None
    below = 0 if wedge else Fraction(3, 5) if bare or block else Fraction(1, 4) if point else 0
    sprung = any(effort is not None and effort.stiffness is not None for effort in link.joint.efforts())
    found = []
    if (not sprung or grounded) and not on_wedge and not _hangs(system, link, along):
        found = [Mark(TrackForm(link.before.p, along, upward if grounded else None, below), above, "track", link.name)]
    if (bare or block) and wedge is None:
        found.append(Mark(SymbolForm("slider" if turns else "block", link.point, own), frame, "body", link.name))
    return found


def _hangs(system: System, link: BodyLink, along: Vector) -> bool:
    """True if a body stands or hangs on springs and moves along its weight: no guide is drawn then."""
    weight = system.loads.fields
    if all(map(is_zero, weight)) or not all(map(is_zero, along.cross(weight))):
        return False
    elements = (force.element for force in system.scope.model.forces.values())
    ends = [point for x in elements if x is not None and x.stiffness is not None for point in x.points]
    return any(system.motion.place(point)[0] == link.name for point in ends)


def _space_joint(
    system: System, link: BodyLink, frame: int, turning: Sequence[Vector], sliding: Sequence[Vector]
) -> list[Mark]:
    kinds = {(0, 0): "weld", (1, 0): "hinge", (0, 1): "slider", (1, 1): "tube", (2, 0): "cross", (3, 0): "ball"}
    symbol = kinds.get((len(turning), len(sliding)))
    if symbol is None or gimbal_of(system, link) or shaft_of(system, link) or is_cylinder(link):
        return []
    along = turning[0] if turning else sliding[0] if sliding else None
    return [
        Mark(SymbolForm(symbol, link.point, along), frame, "joint", link.name),
        *_reach(system, link, bool(sliding)),
    ]


def _reach(system: System, link: BodyLink, slides: bool) -> list[Mark]:
    """Marks of the line along which a body in space has slid, and of the seat of the only joint on the ground."""
    grounded, motion = link.parent == GROUND, system.motion
    above = Pose() if grounded else motion.links[link.parent].pose
    seat = above.point(link.before.p)
    found = []
    if slides and not any(e is not None and e.stiffness is not None for e in link.joint.efforts()):
        found.append(Mark(RodForm(seat, link.pose.point(link.point)), 0, "track" if grounded else "body", link.name))
    alone = sum(other.parent == GROUND for other in motion.links) == 1
    if grounded and alone and not all(map(is_zero, seat)):
        found.append(Mark(LineForm((Vector.ZERO, seat), fine=True), 0, "ground", link.name))
    return found


def _joint_elements(system: System, link: BodyLink, frame: int, turns: bool) -> list[Mark]:
    """Springs and dampers in a joint: along a sliding direction, a spiral where it turns; of a drive the cylinder."""
    efforts = [effort for effort in link.joint.efforts() if effort is not None]
    springs, dampers = (any(getattr(e, name) is not None for e in efforts) for name in ("stiffness", "damping"))
    if is_cylinder(link):
        a, b = system.motion.links[link.parent].pose.point(link.before.p), link.pose.point(link.point)
        sprung = elements(a, b, True, False, link.name, BESIDE) if springs else []
        return [*sprung, Mark(CylinderForm(a, b), 0, "cylinder", link.name)]
    if not (springs or dampers):
        return []
    if turns:
        return [Mark(SymbolForm("coil", link.point), frame, "spring", link.name)] if springs else []
    above = system.motion.links[link.parent].pose if link.parent != GROUND else Pose()
    a, b = above.point(link.before.p), link.pose.point(link.point)
    held = walls(system, (a,), b, link.name) if link.parent == GROUND else []
    return [*held, *elements(a, b, springs, dampers, link.name)]


def elements(a: Vector, b: Vector, spring: bool, damper: bool, of: str, aside: int = 0) -> list[Mark]:
    """A spring and a damper between two places, `aside` of the line; both stand side by side."""
    side = BESIDE if spring and damper else 0
    found = [Mark(SpringForm(a, b, aside + side), 0, "spring", of)] if spring else []
    return [*found, *([Mark(DamperForm(a, b, aside - side), 0, "damper", of)] if damper else [])]


def force_elements(system: System) -> list[Mark]:
    """Springs, dampers and pulls between points; a torsion spring at the joint of its second body."""
    motion, found, sides = system.motion, list[Mark](), _sides(system)
    for name, force in system.scope.model.forces.items():
        element = force.element
        if strands := force.strands_at(SystemScene(motion, f"forces.{name}")):
            found += [*string_marks(strands, name), *_rims(system, strands), *_fastened(system, strands, name)]
        if force.drawn_at is not None:
            found.append(_rubbing(system, name, force.drawn_at))
        if element is None:
            continue
        for body in element.bodies[1:] if element.stiffness is not None else ():
            assert body is not None, "only the first may be the ground"
            found.append(Mark(SymbolForm("coil", motion.link(body).point), motion.index[body] + 1, "spring", name))
        if len(element.points) != 2:
            continue
        places = [motion.place(point) for point in element.points]
        a, b = map(motion.position, places)
        if element.stiffness is not None or element.damping is not None:
            free = b if places[0][0] is None else a
            grounded = [at for at, (body, _) in zip((a, b), places, strict=True) if body is None]
            found += walls(system, grounded, free, name)
        found += elements(a, b, element.stiffness is not None, element.damping is not None, name, sides.get(name, 0))
        if element.pull is not None and "r" in element.pull.names:
            found.append(Mark(LineForm((a, b), fine=True), 0, "spring", name))
        elif element.pull is not None or element.pressed is not None:
            found += _cylinder(system, a, b, [body for body, _ in places], name)
    return found


def _rubbing(system: System, name: str, drawn_at: tuple[str, str]) -> Mark:
    """The symbol of a brake or a clutch, at the joint of a body."""
    symbol, body = drawn_at
    link = system.motion.link(body)
    w, v = link.S[0] if link.S else (Vector.ZERO, Vector.ZERO)
    along = None if system.scope.model.space == "plane" and any(w) else w if any(w) else v
    return Mark(SymbolForm(symbol, link.point, along), system.motion.index[body] + 1, "joint", name)


def _cylinder(system: System, a: Vector, b: Vector, bodies: Sequence[str | None], of: str) -> list[Mark]:
    """A cylinder whose pull is no law of its length, on hinges at both ends."""
    found = [Mark(CylinderForm(a, b), 0, "cylinder", of)]
    if system.scope.model.space == "plane":
        kinds = ("pin" if body is None else "hinge" for body in bodies)
        found += [Mark(SymbolForm(kind, at), 0, "support", of) for kind, at in zip(kinds, (a, b), strict=True)]
    return found


def _sides(system: System) -> dict[str, int]:
    """Offset of each spring or damper to the left of its line, where several join the same places [symbol units]."""
    together: dict[frozenset[Any], list[tuple[str, Any]]] = {}
    for name, force in system.scope.model.forces.items():
        element = force.element
        if element is not None and len(element.points) == 2 and element.pull is None and element.pressed is None:
            ends = [system.motion.place(point) for point in element.points]
            together.setdefault(frozenset(ends), []).append((name, ends[0]))
    return {
        name: (2 * k + 1 - len(beside)) * BESIDE * (1 if first == beside[0][1] else -1)
        for beside in together.values()
        for k, (name, first) in enumerate(beside)
    }


# -- constraints --------------------------------------------------------------------------------------------


def constraint_marks(system: System) -> list[Mark]:
    """Strings, members of trusses, links, tracks, hinges and supports."""
    found = [*_members(system), *_belts(system)]
    for name, constraint in system.scope.model.constraints.items():
        scene = SystemScene(system.motion, f"constraints.{name}")
        rows = [row for row in system.constraints.rows if row.constraint == name]
        if strands := constraint.strands_at(scene):
            found += [*string_marks(strands, name), *_rims(system, strands), *_fastened(system, strands, name)]
        elif (wheels := constraint.wheels()) is not None:
            found += _belt_of(system, scene, wheels, name)
        elif (meeting := constraint.meeting()) is not None:
            found += _met(system, meeting, rows, name)
        elif not any(row.part for row in rows):
            found += _held(system, rows, name)
    return list({(mark if mark.role != "track" else (mark.form, mark.frame)): mark for mark in found}.values())


def _members(system: System) -> list[Mark]:
    """The members of trusses."""
    at = system.motion.position
    return [
        Mark(RodForm(at((first, Vector.ZERO)), at((second, Vector.ZERO))), 0, "member", f"{truss}.{member}")
        for truss, member, (first, second) in system.scope.model.truss_members
    ]


def string_marks(strands: Sequence[Strand], of: str) -> list[Mark]:
    """The straight pieces, the arcs on pulleys, and the pegs."""
    found = [Mark(LineForm(strand.ends), 0, "string", of) for strand in strands]
    loop = strands[0].first.round and strands[0].first.place == strands[-1].second.place
    for one, other in pairwise((*strands, strands[0]) if loop else strands):
        if one.second.round:
            found.append(Mark(_wrapped(one.second, one.d, other.d), 0, "string", of))
    stops = {id(stop): stop for strand in strands for stop in (strand.first, strand.second)}
    for stop in stops.values():
        if stop.round and stop.body is None:
            r = function("abs", stop.offset)
            found.append(Mark(ArcForm(stop.center, r, r, close="chord"), 0, "joint", of))
    return found


def _fastened(system: System, strands: Sequence[Strand], of: str) -> Iterator[Mark]:
    """The walls on which a string ends at the ground."""
    for strand, stop in ((strands[0], strands[0].first), (strands[-1], strands[-1].second)):
        if stop.body is None and not stop.round:
            near, far = strand.ends if stop is strand.first else strand.ends[::-1]
            yield from walls(system, (near,), far, of)


def _belt_of(system: System, scene: SystemScene, wheels: tuple[str, str, Expression], of: str) -> list[Mark]:
    """The belt that two round wheels need which turn in one sense, apart, as their radii have it; in the plane."""
    *bodies, ratio = wheels
    rims = [r for body in bodies for r in (next(iter(_arcs(system, body)), None),) if r is not None]
    if system.scope.model.space == "space" or len(rims) < 2:
        return []
    centers = [scene.place(f"{body}.origin") for body in bodies]
    reach = scene.position(centers[1]) - scene.position(centers[0])
    square, r, R = (scene.value_at_start(x) for x in (reach @ reach, *rims))
    if square is None or r is None or R is None or square <= (r + R) ** 2:
        return []
    if not is_zero(scene.value(ratio) * rims[0] - rims[1]):
        return []
    first, second = (Stop(scene, place, r) for place, r in zip(centers, rims, strict=True))
    there, back = Strand.between(scene, first, second), Strand.between(scene, second, first)
    forms = (
        LineForm(there.ends),
        LineForm(back.ends),
        _wrapped(second, there.d, back.d),
        _wrapped(first, back.d, there.d),
    )
    return [Mark(form, 0, "string", of) for form in forms]


@dataclass(frozen=True)
class _WoundEnd:
    """An end of a string that lies on something round: where it arrives there, clockwise if its offset is positive."""

    of: str
    stop: Stop
    d: Vector
    offset: Scalar

    def leaves_to(self, other: _WoundEnd) -> bool:
        """True if a string that arrives here could leave, round the same thing in the same sense, by the other end."""
        return self.of != other.of and self.stop.place == other.stop.place and is_zero(self.offset + other.offset)


def _belts(system: System) -> Iterator[Mark]:
    """The arcs that join two strings on the same pulley as one belt; in the plane."""
    ends: list[_WoundEnd] = []
    for name, constraint in system.scope.model.constraints.items() if system.scope.model.space == "plane" else ():
        strands = constraint.strands_at(SystemScene(system.motion, f"constraints.{name}"))
        if strands and strands[0].first.round:
            ends.append(_WoundEnd(name, strands[0].first, -strands[0].d, -strands[0].first.offset))
        if strands and strands[-1].second.round:
            ends.append(_WoundEnd(name, strands[-1].second, strands[-1].d, strands[-1].second.offset))
    for one, other in combinations(ends, 2):
        if one.leaves_to(other):
            stop = replace(one.stop, offset=one.offset)
            yield Mark(_wrapped(stop, one.d, -other.d), 0, "string", one.of)


def _rims(system: System, strands: Sequence[Strand]) -> Iterator[Mark]:
    """The drums, hubs and steps of bodies on which strings lie, where no shape shows them; the larger first."""
    stops = {(stop.place, stop.offset): stop for strand in strands for stop in (strand.first, strand.second)}
    round_ones = [stop for stop in stops.values() if stop.round and stop.body is not None]
    for stop in sorted(round_ones, key=lambda stop: -abs(stop.scene.value_at_start(stop.offset) or 0.0)):
        body, at = stop.place
        assert body is not None, "only these were taken"
        shown = list(_arcs(system, body))
        if any(is_zero(stop.offset - r) or is_zero(stop.offset + r) for r in shown):
            continue
        r, frame = -1 * stop.offset if _is_negative(stop) else stop.offset, system.motion.index[body] + 1
        yield Mark(ArcForm(at, r, r, close="none" if shown else "chord"), frame, "rim", body)
        if not shown:
            yield Mark(LineForm((at, at + r * Vector((1, 0, 0))), fine=True), frame, "rim", body)


def _arcs(system: System, body: str) -> Iterator[Scalar]:
    """Radii of the circles that the shapes of a body show."""
    part = system.scope.model.bodies[body]
    shapes = [piece.shape for piece in part.parts] if part.parts is not None else [part.shape] if part.shape else []
    for shape in shapes:
        for form in () if shape.is_point else seen(system, shape.forms(system.scope.value)):
            if isinstance(form, ArcForm):
                yield form.radius


def _wrapped(stop: Stop, arriving: Vector, leaving: Vector) -> ArcForm:
    """The arc between where a string touches and leaves, counter-clockwise from the one or from the other."""
    begin, end = (_direction(stop, d) for d in (arriving, leaving))
    turns_left = type(stop.offset) is not int and _is_negative(stop)
    start, stop_at = (begin, end) if turns_left else (end, begin)
    r = function("abs", stop.offset)
    return ArcForm(stop.center, r, r, start, stop_at)


def _direction(stop: Stop, d: Vector) -> Any:
    """The angle of the touching point, seen from the centre."""
    x, y, _ = (stop.offset * e for e in stop.left(d))
    return function("atan2", y, x)


def _is_negative(stop: Stop) -> bool:
    """True if the round stop is run counter-clockwise: the offset is minus the radius."""
    return (stop.scene.value_at_start(stop.offset) or 0.0) < 0


def _met(system: System, meeting: Meeting, rows: Sequence[Any], of: str) -> list[Mark]:
    """Marks of a touched surface, and of the support of a point on it."""
    found = [*_surface(system, meeting, of), *_round(system, meeting)]
    if meeting.point and meeting.round is None:
        found += _point_support(system, meeting, rows, of)
    return found


def _surface(system: System, meeting: Meeting, of: str) -> list[Mark]:
    """The line, plane, circle or ball that is touched; nothing where a shape shows it already."""
    flat, surface, scope = meeting.flat, meeting.round, system.scope
    frame = 0 if meeting.on is None else system.motion.index[meeting.on] + 1
    if flat is not None:
        n = scope.vector(flat.normal).unit
        along = Vector((n[1], -n[0], 0)) if scope.model.space == "plane" else None
        at = _level(system, meeting)
        return [Mark(TrackForm(at, along, n), frame, "track", of)] if system.symbols.q and at is not None else []
    if surface is not None and surface.at is not None:
        at = scope.ground_place(surface.at) if surface.on is None else scope.vector(surface.at)
        r = scope.value(surface.radius)
        return [Mark(ArcForm(at, r, r), frame, "track", of)]
    return []


def _level(system: System, meeting: Meeting) -> Vector | None:
    """A place of a flat surface, in the axes of its body: where it is said to be, else where the point starts."""
    scene, flat = SystemScene(system.motion), meeting.flat
    if flat is not None and flat.at is not None:
        return scene.ground_place(flat.at) if flat.on is None else scene.vector(flat.at)
    if not meeting.point:
        return None
    return Vector(map(scene.start, scene.position(scene.place(meeting.point))))


def _round(system: System, meeting: Meeting) -> list[Mark]:
    """A round body that no shape shows, by the radius with which it rolls."""
    what = meeting.ball
    if what is None or (what.radius is None and what.semiaxes is None):
        return []
    part = system.scope.model.bodies[what.body]
    if part.parts is not None or (part.shape is not None and not part.shape.is_point):
        return []
    r = system.scope.value(what.radius)  # 0 where there is none
    at = system.motion.points[what.body][what.center or "origin"]
    frame = system.motion.index[what.body] + 1
    if what.axis is not None:
        return [Mark(WheelForm(at, system.scope.vector(what.axis), r), frame, "body", what.body)]
    ball = EllipsoidForm(at, Vector((r, r, r) if what.semiaxes is None else system.scope.vector(what.semiaxes)))
    return [Mark(form, frame, "body", what.body) for form in seen(system, (ball,))]


def _point_support(system: System, meeting: Meeting, rows: Sequence[Any], of: str) -> list[Mark]:
    """A roller on the ground's line, a block on a body's line."""
    if system.scope.model.space != "plane" or not meeting.point:
        return []
    at = system.motion.position(system.motion.place(meeting.point))
    groove = meeting.groove
    if meeting.flat is not None:
        n = system.scope.vector(meeting.flat.normal).unit
        if system.symbols.q and system.motion.moves(at):
            return []
        return [Mark(SymbolForm("roller", at, Vector((n[1], -n[0], 0))), 0, "support", of)]
    if groove is not None and groove.on is not None:
        place, link = system.motion.place(meeting.point), system.motion.link(groove.on)
        along = system.scope.vector(groove.along)
        return [Mark(SymbolForm("blade", place[1], along), system.motion.index[link.name] + 1, "joint", of)]
    if meeting.line is not None:
        (_, A), (_, B) = SystemScene(system.motion).line(meeting.line)
        R = system.motion.link(meeting.line).pose.R
        along = R @ Vector((B[0] - A[0], B[1] - A[1], B[2] - A[2]))
        return [Mark(SymbolForm("slider", at, along), 0, "joint", of)]
    return []


def _held(system: System, rows: Sequence[Any], of: str) -> list[Mark]:
    """A hinge or support, by the reactions of its rows; a link as a bar."""
    pushes = [push for row in rows for push in row.pushes if isinstance(push, PointForce)]
    parts = {row.component for row in rows}
    if not pushes:
        return []
    if "tension" in parts:
        ends = [system.motion.position(push.place) for push in pushes]
        return [Mark(RodForm(a, b), 0, "string", of) for a, b in zip(ends[::2], ends[1::2], strict=False)]
    at = system.motion.position(pushes[0].place)
    between = len({push.place[0] for push in pushes if push.place[0] is not None}) > 1
    held = any(isinstance(push, Couple) for row in rows for push in row.pushes)
    if system.scope.model.space == "space":
        return [Mark(SymbolForm("weld" if held else "ball", at), 0, "joint", of)]
    if {"x", "y"} <= parts:
        return [Mark(SymbolForm("clamp" if held else "hinge" if between else "pin", at), 0, "support", of)]
    if "n" in parts and not between:
        (row,) = (row for row in rows if row.component == "n")
        x, y, _ = row.pushes[0].force
        return [Mark(SymbolForm("roller", at, Vector((y, -x, 0))), 0, "support", of)]
    return [Mark(SymbolForm("hinge", at), 0, "joint", of)]


def ordered(marks: Iterable[Mark], roles: Sequence[str]) -> tuple[Mark, ...]:
    """The marks as they are drawn: by their roles, then as they came."""
    return tuple(sorted(marks, key=lambda mark: roles.index(mark.role)))


# -------- anchors ---------------------------------------------------------------------------------------------
# Springs at the ground, driven coordinates -> marks in the plane: walls that hold the ones, arrows of the others.


def walls(system: System, grounded: Sequence[Vector], free: Vector, of: str) -> list[Mark]:
    """The hatched lines on which a spring or damper ends at the ground, along x or y, its free end before them."""
    if system.scope.model.space == "space":
        return []
    scene, known = SystemScene(system.motion), parameters_as_drawn(system)
    found = []
    for at in grounded:
        way = tuple(map(scene.start, free - at))
        still = dict.fromkeys(symbols_of(way), 0.0)  # the share of a virtual displacement
        dx, dy, _ = (float(x) for x in evaluate(way, still | known, FLOAT))
        if math.hypot(dx, dy) > 0:
            level = abs(dy) >= abs(dx)
            along: Vector = Vector((int(math.copysign(1, dy)), 0, 0) if level else (0, -int(math.copysign(1, dx)), 0))
            found.append(Mark(SymbolForm("wall", at, along), 0, "support", of))
    return found


def drive_marks(system: System) -> list[Mark]:
    """An arrow at the first joint that turns or slides as a driven coordinate says, and the coordinate's name."""
    if system.scope.model.space == "space":
        return []
    driven, constraints = system.scope.model.driven_coordinates, system.scope.model.driving_constraints
    waiting = [q for q in system.symbols.q if q.name in driven]
    found = []
    for k, link in enumerate(system.motion.links, start=1):
        for q in [q for q in waiting if q in symbols_of(link.s)]:
            waiting.remove(q)
            of = constraints.get(q.name, (link.name,))[0]
            found += [
                Mark(_arrow(link, q), k, "support", of),
                Mark(LabelForm(q.name, link.point), k, "dimension", of),
            ]
    return found


def _arrow(link: BodyLink, q: Node) -> SymbolForm:
    """Arrow round the joint, or along its sliding direction."""
    w, v = next(column for s, column in zip(link.s, link.S, strict=False) if q in symbols_of((s,)))
    return SymbolForm("shifted", link.point, v) if all(map(is_zero, w)) else SymbolForm("turned", link.point)
