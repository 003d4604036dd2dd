"""Joints of one axis: revolute, prismatic, cylindrical, screw."""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import FormulaRule
from eomgen.model.joints.base import (
    Column,
    Effort,
    Joint,
    Move,
    PushAlong,
    Scalars,
    X,
    Y,
    Z,
    across,
    angular,
    linear,
    vector,
)
from eomgen.model.kinds import (
    Angle,
    AngleLimits,
    AngularDamping,
    AngularStiffness,
    ConstantAngle,
    Direction,
    Displacement,
    ForceFormula,
    HingeFriction,
    JointFriction,
    LinearDamping,
    LinearStiffness,
    RestAngle,
    Restitution,
    RestLength,
    RotorInertia,
    SleeveFriction,
    SleeveLimits,
    SlideFriction,
    SlideInertia,
    SlideLimits,
    SlideStop,
    SpaceDirection,
    ThreadFriction,
    Torque,
    TurnStop,
    ValueOf,
)
from eomgen.model.part import PartRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Matrix, Pose, Vector, as_expression, cos, sin

# -------- axis ------------------------------------------------------------------------------------------------
# Joints of one axis: the child turns about it, slides along it, or both.


@dataclass(frozen=True, kw_only=True)
class AxisJoint(Joint):
    """X = (Rot(n, sum a_k s_k) R_0, sum b_k s_k n): each variable s_k turns by a_k about n, advances by b_k along it.

    S has the columns (a_k n, b_k n). W: the torques across n, and n where nothing turns; the forces across n, and n
    where nothing advances; of a thread the force a n with the torque -b n, which does no work.
    """

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of stops that yield: they need limits, and no restitution; with damping a coordinate."""
        stop, limits = getattr(self, "stop", None), getattr(self, "limits", None)
        if stop is None:
            return
        s = getattr(self, self.limited[0])
        if limits is None:
            yield Diagnostic((*path, "stop"), "the stop of the joint has no limits", "limits = [-1, 1]", key=True)
        if getattr(self, "restitution", None) is not None:
            what = "a restitution is one of rigid stops, and 'stop' makes them yield"
            yield Diagnostic((*path, "restitution"), what, "leave one out; damping takes energy", key=True)
        if stop.damping is not None and s is not None and not s.text.isidentifier():
            what = f"the damping of a stop is along a coordinate, and '{s.text}' is no coordinate"
            yield Diagnostic((*path, "stop", "damping"), what, f"a coordinate as {self.limited[0]}, or none", key=True)

    @property
    def driving(self) -> Expression | None:
        """Drive of the one variable, stops that yield in it: beyond a limit by x, max(0, k x + d x') back."""
        given: Expression | None = getattr(self, self.driven_by)
        law, limits = getattr(self, "stop", None), getattr(self, "limits", None)
        if law is None or limits is None:
            return given
        s, found = getattr(self, self.limited[0]), [] if given is None else [f"({given.text})"]
        for bound, sense in ((limits.low, "-"), (limits.high, "")):
            if bound is not None:
                beyond = f"{sense}(({s.text}) - ({bound.text}))"
                push = f"max(0, ({law.stiffness.text})*({beyond}))"
                if law.damping is not None:
                    rate = f"{sense}({law.damping.text})*{s.text}'"
                    push = f"max(0, ({law.stiffness.text})*({beyond}) + ({rate}))*(1 + sign({beyond}))/2"
                found.append(push if sense else f"-{push}")
        return as_expression(" + ".join(found).replace("+ -", "- "))

    @abstractmethod
    def normal(self, value: ValueOf) -> Vector:
        """The unit axis n, parent's (turned) axes."""

    @abstractmethod
    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        """(a, b) of each variable: the turn [1 or rad] and the advance [1 or m] by a unit of it."""

    def mounting(self, value: ValueOf) -> Matrix:
        """R_0, the child's axes at s = 0."""
        return Matrix.IDENTITY

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return sum((a * x for (a, _), x in zip(self.steps(value), s, strict=True)), start=0)

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        n, steps = self.normal(value), self.steps(value)
        R, angle = self.mounting(value), sum((a * x for (a, _), x in zip(steps, s, strict=True)), start=0)
        advance = sum((b * x for (_, b), x in zip(steps, s, strict=True)), start=0)
        return Pose(Matrix.rotation(n, cos(angle), sin(angle)) @ R, advance * n)

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        n = self._seen_from_child(value)
        return tuple((*(a * n), *(b * n)) for a, b in self.steps(value))

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        n, steps = self._seen_from_child(value), self.steps(value)
        turns, slides = any(a != 0 for a, _ in steps), any(b != 0 for _, b in steps)
        sideways = self._across(value)
        torques = map(angular, sideways if turns else (X, Y, Z))
        forces = map(linear, sideways if slides else (X, Y, Z))
        thread = [(*(-b * n), *(a * n)) for a, b in steps] if len(steps) == 1 and turns and slides else []
        return (*torques, *forces, *thread)

    def _across(self, value: ValueOf) -> tuple[Vector, ...]:
        """Two directions across the axis, child's axes."""
        R_CP = self.mounting(value).T
        return tuple(R_CP @ e for e in across(self.normal(value)))

    def _seen_from_child(self, value: ValueOf) -> Vector:
        """n in the child's axes; turning about it does not change it."""
        return self.mounting(value).T @ self.normal(value)


# -------- revolute --------------------------------------------------------------------------------------------
# Revolute: the child turns about one axis.


@dataclass(frozen=True, kw_only=True)
class Revolute(AxisJoint):
    """A hinge, which turns about one axis.

    s = angle, X = Rot(n, s), S = (n, 0); W: the torques across n and every force.

    Args:
        angle: of the child against the parent, 0 = axes agree [rad].
        axis: in the turned axes; need not have unit length; None: z.
        torque: on the child, minus on the parent [N m].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
        limits: [least, largest] of the angle, "inf" for none: rigid stops; plain numbers are in the unit of its
            coordinate q (of `a*q + b`, too; of anything else SI), expressions in SI.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
        stop: instead of rigid ones stops that yield: { stiffness = k, damping = d } pushes back beyond the limits.
        friction: dry: { torque = T } or { coefficient = mu, radius = r }; `static`, the largest at rest; or `smooth`.
    """

    limited: ClassVar[tuple[str, ...]] = ("angle",)
    driven_by: ClassVar[str] = "torque"
    kind: ClassVar[str] = "revolute"
    angle: Angle
    axis: SpaceDirection | None = None
    torque: Torque | None = None
    stiffness: AngularStiffness | None = None
    damping: AngularDamping | None = None
    rest: RestAngle | None = None
    armature: RotorInertia | None = None
    limits: AngleLimits | None = None
    restitution: Restitution | None = None
    stop: Annotated[TurnStop, PartRule(TurnStop)] | None = None
    friction: Annotated[HingeFriction, PartRule(HingeFriction)] | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (Move(self.axis, angle=self.angle),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.angle,)

    def normal(self, value: ValueOf) -> Vector:
        return vector(self.axis, value, Z).unit

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((1, 0),)

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.driving, self.stiffness, self.damping, self.rest, self.armature),)

    def pushes(self) -> tuple[PushAlong, ...]:
        return (
            PushAlong(
                way=self.angle,
                push=self.driving,
                stiffness=self.stiffness,
                damping=self.damping,
                rest=self.rest,
                armature=self.armature,
                friction=self.friction,
            ),
        )


# -------- prismatic -------------------------------------------------------------------------------------------
# Prismatic: the child slides along one axis.


@dataclass(frozen=True, kw_only=True)
class Prismatic(AxisJoint):
    """A slide along `axis`.

    s = displacement, X = (Rot(angle), s n), S = (0, R^T n); W: every torque and the forces across n.

    Args:
        axis: n, in the turned axes; need not have unit length.
        displacement: along n [m].
        angle: the constant angle of the child's axes (about z in the plane, about n in space) [rad].
        force: on the child, minus on the parent [N].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
        limits: [least, largest] of the displacement, "inf" for none: rigid stops; plain numbers are in the unit of its
            coordinate q (of `a*q + b`, too; of anything else SI), expressions in SI.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
        stop: instead of rigid ones stops that yield: { stiffness = k, damping = d } pushes back beyond the limits.
        friction: dry: { force = F } or { coefficient = mu }; `static`, the largest at rest; or `smooth`.
    """

    limited: ClassVar[tuple[str, ...]] = ("displacement",)
    driven_by: ClassVar[str] = "force"
    kind: ClassVar[str] = "prismatic"
    axis: Direction
    displacement: Displacement
    angle: ConstantAngle | None = None
    force: ForceFormula | None = None
    stiffness: LinearStiffness | None = None
    damping: LinearDamping | None = None
    rest: RestLength | None = None
    armature: SlideInertia | None = None
    limits: SlideLimits | None = None
    restitution: Restitution | None = None
    stop: Annotated[SlideStop, PartRule(SlideStop)] | None = None
    friction: Annotated[SlideFriction, PartRule(SlideFriction)] | None = None

    def turns(self) -> tuple[Expression, ...]:
        return ()

    def moves(self) -> tuple[Move, ...]:
        turn_axis = None if len(self.axis) == 2 else self.axis
        return (Move(self.axis, self.displacement), Move(turn_axis, angle=self.angle))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.displacement,)

    def normal(self, value: ValueOf) -> Vector:
        return vector(self.axis, value).unit

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((0, 1),)

    def mounting(self, value: ValueOf) -> Matrix:
        angle = self.turn((), value)
        return Matrix.rotation(Z if len(self.axis) == 2 else self.normal(value), cos(angle), sin(angle))

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return 0 if self.angle is None else value(self.angle)

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.driving, self.stiffness, self.damping, self.rest, self.armature),)

    def pushes(self) -> tuple[PushAlong, ...]:
        return (
            PushAlong(
                way=self.displacement,
                push=self.driving,
                stiffness=self.stiffness,
                damping=self.damping,
                rest=self.rest,
                armature=self.armature,
                friction=self.friction,
            ),
        )


# -------- cylindrical -----------------------------------------------------------------------------------------
# Cylindrical: the child turns about an axis and slides along it.


@dataclass(frozen=True, kw_only=True)
class Cylindrical(AxisJoint):
    """A sleeve on a shaft: turns about an axis and slides along it.

    s = (d, angle), X = (Rot(n, angle), d n), S = (0, n), (n, 0); W: all across n.

    Args:
        axis: n, in the turned axes; need not have unit length; None: z.
        displacement, angle: along n [m] and about it [rad].
        force, torque: along n and about it on the child, minus on the parent [N, N m].
        limits: rigid stops: { displacement = [least, largest], angle = [least, largest] }.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
        friction: dry: { displacement = { force = F }, angle = { torque = T } }, each with `static` or `smooth`.
    """

    limited: ClassVar[tuple[str, ...]] = (
        "displacement",
        "angle",
    )
    kind: ClassVar[str] = "cylindrical"
    only_space: ClassVar[bool] = True
    axis: SpaceDirection | None = None
    displacement: Displacement
    angle: Angle
    force: ForceFormula | None = None
    torque: Torque | None = None
    limits: Annotated[SleeveLimits, PartRule(SleeveLimits)] | None = None
    restitution: Restitution | None = None
    friction: Annotated[SleeveFriction, PartRule(SleeveFriction)] | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (Move(self.axis, self.displacement, self.angle),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.displacement, self.angle)

    def normal(self, value: ValueOf) -> Vector:
        return vector(self.axis, value, Z).unit

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((0, 1), (1, 0))

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.force), Effort(self.torque))

    def pushes(self) -> tuple[PushAlong, ...]:
        sliding, turning = (None, None) if self.friction is None else (self.friction.displacement, self.friction.angle)
        return (
            PushAlong(way=self.displacement, push=self.force, friction=sliding),
            PushAlong(way=self.angle, push=self.torque, friction=turning),
        )


# -------- screw -----------------------------------------------------------------------------------------------
# Screw: the child turns about an axis and advances with it.


Pitch = Annotated[Expression, FormulaRule("m")]


@dataclass(frozen=True, kw_only=True)
class Screw(AxisJoint):
    """A nut on a thread: turns about an axis and advances by `pitch` a radian.

    With the pitch h: s = angle, X = (Rot(n, s), h s n), S = (n, h n).

    W: torques and forces across n, and the thread's thrust: a force n with the torque -h n.

    Args:
        axis: n, in the turned axes; need not have unit length; None: z.
        angle: about n [rad].
        pitch: h, advance per radian [m].
        torque: about n on the child, minus on the parent [N m].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
        limits: [least, largest] of the angle, "inf" for none: rigid stops; plain numbers are in the unit of its
            coordinate q (of `a*q + b`, too; of anything else SI), expressions in SI.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
        stop: instead of rigid ones stops that yield: { stiffness = k, damping = d } pushes back beyond the limits.
        friction: dry: { torque = T } or { coefficient = mu, radius = r }; `static`, the largest at rest; or `smooth`.
    """

    limited: ClassVar[tuple[str, ...]] = ("angle",)
    driven_by: ClassVar[str] = "torque"
    kind: ClassVar[str] = "screw"
    only_space: ClassVar[bool] = True
    axis: SpaceDirection | None = None
    angle: Angle
    pitch: Pitch
    torque: Torque | None = None
    stiffness: AngularStiffness | None = None
    damping: AngularDamping | None = None
    rest: RestAngle | None = None
    armature: RotorInertia | None = None
    limits: AngleLimits | None = None
    restitution: Restitution | None = None
    stop: Annotated[TurnStop, PartRule(TurnStop)] | None = None
    friction: Annotated[ThreadFriction, PartRule(ThreadFriction)] | None = None

    @property
    def frictions(self) -> tuple[tuple[int, str, JointFriction], ...]:
        """The friction of the thread: of a unit of the flanks' force along the axis, mu (r + h^2/r) along the angle."""
        law = self.friction
        if law is None or law.radius is None:
            return () if law is None else ((0, "angle", law),)
        r, h = law.radius.text, self.pitch.text
        return ((0, "angle", law.altered(radius=as_expression(f"{r} + ({h})^2/({r})"))),)

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (Move(self.axis, self.pitch * self.angle, self.angle),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.angle,)

    def normal(self, value: ValueOf) -> Vector:
        return vector(self.axis, value, Z).unit

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((1, value(self.pitch)),)

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.driving, self.stiffness, self.damping, self.rest, self.armature),)

    def pushes(self) -> tuple[PushAlong, ...]:
        return (
            PushAlong(
                way=self.angle,
                push=self.driving,
                stiffness=self.stiffness,
                damping=self.damping,
                rest=self.rest,
                armature=self.armature,
                friction=self.friction,
            ),
        )
