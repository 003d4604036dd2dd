"""Supports, sliders, guides, clamps, knife edges, and stops of joints."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, ClassVar

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog, not_in_the_plane, owner_of
from eomgen.model.constraints.base import Constraint, FlatSurface, Groove, Meeting
from eomgen.model.constraints.pin import alike, held_together, not_turning, others_of
from eomgen.model.constraints.plane import Touch, left, opposite, same_turn
from eomgen.model.constraints.rolling import complement, laid_in
from eomgen.model.constraints.row import ConstraintRow, direction_of, normals_of
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.forces.load import Couple, LoadContext, PointForce, Push
from eomgen.model.kinds import (
    BodyName,
    Direction,
    Flag,
    FrictionLaw,
    FromField,
    GroundPlace,
    PointName,
    Points,
    Restitution,
    SpaceDirection,
)
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Matrix, Scalar, Vector, over

# -------- clamp -----------------------------------------------------------------------------------------------
# Clamp: a point of a body is built in.


@dataclass(frozen=True, kw_only=True)
class Clamp(Constraint):
    """A clamp: the point is built into the ground as it stands, or the bodies of the points are welded together.

    Rows: those of a pin, and a couple (in space three): no turning against the start. The couple is the one about the
    point.

    Args:
        point: that stays where it stands, with its body.
        points: one of each body instead.
    """

    kind: ClassVar[str] = "clamp"
    one_of: ClassVar[tuple[str, ...]] = ("point", "points")
    point: PointName | None = None
    points: Points | None = None

    def stays(self, component: str) -> bool:
        return self.point is not None or component == "couple"

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """The rows of a pin, and no rotation relative to the start; in space e_i . e_j = 0 of axes in either body."""
        first, *_ = named = [scene.place(p) for p in (*(self.points or ()), self.point) if p is not None]
        rows: list[ConstraintRow] = []
        for other in others_of(scene, named):
            rows += held_together(scene, first, other)
            bodies = first[0], other[0]
            rows += [same_turn(scene, *bodies)] if scene.plane else not_turning(scene, bodies)
        return tuple(rows)

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """The products e_i . e_i of the axes in either body, in space; () in the plane."""
        if scene.plane:
            return ()
        first, *_ = named = [scene.place(p) for p in (*(self.points or ()), self.point) if p is not None]
        return tuple(
            alike(scene, (first[0], other[0]), e) for other in others_of(scene, named) for e in Matrix.IDENTITY
        )


# -------- guide -----------------------------------------------------------------------------------------------
# Guide: a body slides without turning.


@dataclass(frozen=True, kw_only=True)
class Guide(Constraint):
    """A guide: the point moves along `along` (ground axes), and its body does not rotate.

    Rows: the force along the left normal of `along`; the couple. In space two forces across `along` and three couples.

    Args:
        point: the guided point.
        along: direction of the guide, ground axes.
    """

    kind: ClassVar[str] = "guide"
    point: PointName
    along: Direction

    def stays(self, component: str) -> bool:
        return True

    @property
    def lies_by_start(self) -> bool:
        return True

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """n . (p - p_start) = 0 for each n across `along`; theta - theta_start = 0, in space as a clamp."""
        place = scene.place(self.point)
        rows = []
        for name, n in normals_of(scene, direction_of(scene, scene.vector(self.along))):
            height = n @ scene.position(place)
            rows.append(ConstraintRow((PointForce(place, n),), height - scene.start(height), component=name))
        turns = [same_turn(scene, place[0], None)] if scene.plane else not_turning(scene, (place[0], None))
        return (*rows, *turns)

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """The products e_i . e_i of the ground's axes and those that the body carries, in space; () in the plane."""
        body = scene.place(self.point)[0]
        return () if scene.plane else tuple(alike(scene, (body, None), e) for e in Matrix.IDENTITY)


# -------- slider ----------------------------------------------------------------------------------------------
# Slider: a point stays on the line of a body.


@dataclass(frozen=True, kw_only=True)
class Slider(Constraint):
    """A slider: the point stays on the line (`line = ["A", "B"]`) of body `on`.

    One row: the force along the left normal of the line from A to B, on the point; where the point is one of the
    ground, on the body. In space two forces across the line; it holds on all sides, so that it is not `unilateral`
    there.

    Args:
        point: the sliding point.
        on: the body whose line it is.
        unilateral: it can only push (in the plane).
        friction: in the contact.
        restitution: where it closes again it rebounds with this share of its speed, 0 to 1 (None: not at all).
    """

    kind: ClassVar[str] = "slider"
    holds_ground: ClassVar[bool] = True
    on_line: ClassVar[bool] = True
    point: PointName
    on: BodyName
    unilateral: Flag = False
    friction: FrictionLaw | None = None
    restitution: Restitution | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics: the body needs a line, another body than that of the point; in space the slider cannot end."""
        yield from self.never_rebounds(path)
        if _lacks_line(catalog, self.on):
            what = f"'{path[1]}' slides on the line of body '{self.on}', which has none"
            yield Diagnostic((*path, "on"), what, f'give body \'{self.on}\' its line = ["A", "B"]')
        if self.unilateral and catalog.model.space == "space":
            what = f"'{path[1]}' holds its point on a line in space from all sides: it cannot end"
            yield Diagnostic((*path, "unilateral"), what, "leave it out, or use a support", key=True)
        if self.point is not None and owner_of(self.point) == self.on:
            what = f"the point '{self.point}' of '{path[1]}' is on the body along which it should slide"
            yield Diagnostic((*path, "point"), what)

    def meeting(self) -> Meeting:
        """The point, on the body's line."""
        return Meeting(point=self.point, line=self.on)

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """n . (p - p_A) = 0 for each n across A -> B in the body; the line pushes along n, friction along A -> B.

        In the plane n is the left normal; in space there are two, and |N| = sqrt(N_1^2 + N_2^2). A point of the ground
        pushes the body: then n and friction are what acts on the body.
        """
        (_, A), (_, B) = line = scene.line(self.on)
        if scene.moves((*A, *B)):
            raise ModelError(f"the line of body '{self.on}' moves in the body", scene.where, "choose points that stay")
        d, R = direction_of(scene, B - A), scene.orientation(self.on)
        place = scene.place(self.point)
        arm = scene.position(place) - scene.position(line[0])
        touch, sense = (Touch(place), Touch(line[0], arm)), 1
        if place[0] is None:
            touch, sense = (touch[1], touch[0]), -1
        rows = [
            ConstraintRow(opposite(*touch, R @ n), sense * (R @ n @ arm), component=name)
            for name, n in normals_of(scene, d)
        ]
        rows[-1] = replace(rows[-1], tangent=opposite(*touch, R @ d), round=not scene.plane)
        return tuple(rows)


def _lacks_line(catalog: Catalog, body: Any) -> bool:
    part = catalog.table("bodies").get(body)
    return part is not None and part.line is None and ("bodies", body, "line") not in catalog.broken


# -------- support ---------------------------------------------------------------------------------------------
# Support: a point stays on a line or a plane.


@dataclass(frozen=True, kw_only=True)
class Support(Constraint):
    """A support: the point stays on the line (in space a plane) across `normal` through `at`, or its start position.

    One row: n . (p - p_0) = 0, n = `normal` made a unit vector: the normal force, along n.

    Args:
        point: the supported point.
        normal: ground axes, 2 or 3.
        at: a place on the line, or a ground point's name (None: where the point stands).
        unilateral: it can only push.
        friction: in the contact.
        restitution: where it closes again it rebounds with this share of its speed, 0 to 1 (None: not at all).
    """

    kind: ClassVar[str] = "support"
    point: PointName
    normal: Direction
    at: GroundPlace | None = None
    unilateral: Flag = False
    friction: FrictionLaw | None = None
    restitution: Restitution | None = None

    def meeting(self) -> Meeting:
        """The point, on its line or plane."""
        return Meeting(point=self.point, flat=FlatSurface(None, self.at, self.normal))

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """n . (p - p_0) = 0, n of unit length; the support pushes along n; friction along t, with t, n as x, y.

        In space along t and s, as those of a rolling body.
        """
        n = direction_of(scene, scene.vector(self.normal))
        place = scene.place(self.point)
        position = scene.position(place)
        origin = Vector(map(scene.start, position)) if self.at is None else scene.ground_place(self.at)
        along: tuple[Vector, ...] = (Vector((n[1], -n[0], 0)),) if scene.plane else laid_in(scene, n)
        tangents = [(PointForce(place, t),) for t in along]
        gap = n @ (position - origin)
        row = ConstraintRow((PointForce(place, n),), gap, component="n", tangent=tangents[0])
        return (row if scene.plane else replace(row, cross_tangent=tangents[1]),)


# -------- skate -----------------------------------------------------------------------------------------------
# Skate: a knife edge.


@dataclass(frozen=True, kw_only=True)
class Skate(Constraint):
    """A knife edge: the point has no velocity across `along` (body axes).

    One row, of velocities alone: the force along the left normal of `along`. In space it is along n x `along`, of unit
    length, with the `normal` n of the ice.

    Args:
        point: of the edge.
        along: the edge, body axes.
        normal: in space, of the ice on which it cuts, ground axes; None: z.
    """

    kind: ClassVar[str] = "skate"
    point: PointName
    along: Direction
    normal: SpaceDirection | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of a normal of the ice that is given in the plane."""
        yield from not_in_the_plane(catalog, path, self, ("normal",))

    def meeting(self) -> Meeting:
        """The point, in the groove that it cuts."""
        return Meeting(point=self.point, groove=Groove(self.point.rpartition(".")[0] or None, self.along, self.normal))

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """n . v = 0; a row of velocities alone, which no gap has for a rate.

        n is the left normal of `along`; in space, on ice of the normal e and with the edge d, n = e x d / |e x d|.
        """
        place = scene.place(self.point)
        along = direction_of(scene, scene.vector(self.along))
        if scene.plane:
            return (ConstraintRow((PointForce(place, left(along), axes=place[0]),), None, component="n"),)
        e = Vector((0, 0, 1)) if self.normal is None else direction_of(scene, scene.vector(self.normal))
        d = along if place[0] is None else scene.orientation(place[0]) @ along
        n = over(1, complement(scene, e @ d)) * e.cross(d)
        return (ConstraintRow((PointForce(place, n),), None, component="n"),)


# -------- limit -----------------------------------------------------------------------------------------------
# Limit: a rigid stop of a joint's variable.


@dataclass(frozen=True, kw_only=True)
class Limit(Constraint):
    """A rigid stop of a joint: its variable does not pass a bound. The `limits` of joints make them.

    One row: the couple or force along the joint, on the body, away from the bound, and its opposite on the parent.

    Args:
        body: whose joint it is.
        variable: number of the joint's variable.
        bound: which it does not pass [rad or m].
        upper: True: from below.
        restitution: of the joint.
    """

    kind: ClassVar[str] = "limit"
    unilateral: ClassVar[bool] = True
    about_joint: ClassVar[bool] = True
    body: BodyName
    variable: FromField
    bound: FromField
    upper: Flag = False
    restitution: FromField | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of limits that are crossed, and of those of a joint that a motion drives."""
        joint = catalog.table("bodies")[self.body].joint
        where = ("bodies", self.body, "joint", "limits")
        ((field, limits),) = ((name, x) for k, name, x in joint.limits_of_variables if k == self.variable)
        if self.upper and limits.low is not None and limits.high is not None:
            settled = limits.in_si(joint.unit_of_limits(field, catalog.table("coordinates")))
            low, high = (x.value_at({"pi": math.pi}) for x in (settled.low, settled.high))
            if low is not None and high is not None and not low < high:
                what = f"the limits of '{self.body}' leave nothing between {limits.low.text} and {limits.high.text}"
                yield Diagnostic(where, what, "least first")
        given = {name for name, part in catalog.table("coordinates").items() if part is not None and part.driven}
        given |= {part.drives() for part in catalog.table("constraints").values() if part is not None}
        variable = joint.variable_of(field)
        if variable is None:  # of a quaternion: the joint refuses its limits
            return
        moving = variable.names & catalog.table("coordinates").keys()
        if moving and moving <= given and (self.upper or limits.low is None or limits.high is None):
            what = f"'{min(moving)}' is driven: no stop can hold the joint of '{self.body}' where its motion leads on"
            yield Diagnostic(where, what, "leave out the limits, or the motion")

    def impulse_unit(self, catalog: Catalog) -> str:
        return "N*m*s" if self.gap_unit(catalog.table("bodies")) == "rad" else "N*s"

    def gap_unit(self, bodies: Mapping[str, Any]) -> str:
        joint = bodies[self.body].joint
        found: str = joint.unit_of(joint.limited[self.variable])
        return found

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """s - bound >= 0, of an upper one bound - s >= 0; the push along the joint does the work of a unit times s'."""
        sense = -1 if self.upper else 1
        s, force, couple, child, parent, arm = scene.along_joint(self.body, self.variable)
        gap = sense * (s - scene.value(self.bound))
        force, couple = sense * force, sense * couple
        pushes: tuple[Push, ...] = () if _is_none(force) else opposite(Touch(child), Touch(parent, arm), force)
        if not _is_none(couple):
            turned = ((child, couple), (parent, -couple))
            pushes += tuple(Couple(at[0], c, place=at) for at, c in turned if at[0] is not None)
        return (ConstraintRow(pushes, gap, component="n" if _is_none(couple) else "couple"),)


def _is_none(vector: Vector) -> bool:
    return all(type(x) is int and x == 0 for x in vector)
