"""Motion -> Loads: every applied force, as loads at places and as potentials.

One description serves both ways to the generalized forces: virtual work on positions,
Q_k = sum F . dp/dq_k - dV/dq_k, and wrenches on twists, Q = sum B^T W.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property

from eomgen.errors import DerivationError, NotYet
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.motion import BodyLink, Motion
from eomgen.mechanics.kinematics.scene import SystemScene
from eomgen.model import Couple, GeneralizedForce, Load, PointForce, SpreadLoad, UniformField
from eomgen.symbolic.expression import (
    ZERO,
    Fraction,
    Node,
    Scalar,
    Vector,
    Wrench,
    apply,
    cross,
    depends_on,
    dot,
    is_zero,
    over,
    plus,
    times,
    transposed,
)


@dataclass(frozen=True)
class Applied:
    """One named force of the model.

    Args:
        name: its name.
        loads: forces and couples, whether or not they have a potential.
        potential: V [J], or None where it has none.
        placeless: it is an energy of coordinates alone, which acts at no place.
        spread: what is spread along lines, of which `loads` holds the resultants.
    """

    name: str
    loads: tuple[Load, ...]
    potential: Scalar | None
    placeless: bool
    spread: tuple[SpreadLoad, ...] = ()


@dataclass(frozen=True)
class JointEffort:
    """A scalar force on a joint's variable: drive, spring and damper of the joint.

    Args:
        body: the child; the parent bears the opposite.
        variable: index of the joint's variable s.
        drive: torque or force without a potential (damping included) [N m or N].
        potential: k (s - rest)^2 / 2 [J], or 0.
        effort: the whole effort along s, -dV/ds included.
    """

    body: str
    variable: int
    drive: Scalar
    potential: Scalar
    effort: Scalar


@dataclass(frozen=True)
class Loads:
    """All that is applied to the system.

    Args:
        begun: where coordinates start that the constraints place, for springs of the start's length.
    """

    motion: Motion
    applied: tuple[Applied, ...]
    efforts: tuple[JointEffort, ...]
    begun: Mapping[Node, Scalar] = field(default_factory=dict)

    @cached_property
    def potential_energy(self) -> Scalar:
        """V, of every force that has one [J]."""
        total: Scalar = 0
        for force in self.applied:
            total = total + (0 if force.potential is None else force.potential)
        return sum((e.potential for e in self.efforts), start=total)

    @property
    def fields(self) -> Vector:
        """The sum of the uniform acceleration fields on every mass [m/s^2]."""
        total = ZERO
        for load in self._all:
            if isinstance(load, UniformField):
                total = plus(total, load.acceleration)
        return total

    @property
    def placed(self) -> tuple[PointForce | Couple, ...]:
        """Forces and couples at bodies, the uniform fields left out."""
        return tuple(load for load in self._all if isinstance(load, (PointForce, Couple)))

    @property
    def generalized(self) -> tuple[GeneralizedForce, ...]:
        return tuple(load for load in self._all if isinstance(load, GeneralizedForce))

    @property
    def _all(self) -> tuple[Load, ...]:
        return tuple(load for force in self.applied for load in force.loads)


def loads_of(motion: Motion, begun: Mapping[Node, Scalar] | None = None) -> Loads:
    """Every applied force of the model, as loads and potentials.

    Args:
        begun: where coordinates start that do not start where they are declared to.
    """
    applied, begun = [], begun or {}
    for name, force in motion.scope.model.forces.items():
        scene = SystemScene(motion, f"forces.{name}", begun)
        if not force.works:
            raise NotYet(
                f"forces of kind '{force.kind}' are not derived yet",
                f"forces.{name}",
                fix="declare it by forces that are: see eomgen schema",
            )
        loads, spread = tuple(force.loads(scene)), tuple(force.spread(scene))
        applied.append(Applied(name, loads, force.potential(scene), force.placeless, spread))
    efforts = [effort for link in motion.links for effort in _joint_efforts(motion, link)]
    _refuse_accelerations(motion, applied, efforts)
    return Loads(motion, tuple(applied), tuple(efforts), begun)


def _refuse_accelerations(motion: Motion, applied: list[Applied], efforts: list[JointEffort]) -> None:
    accelerations = motion.scope.symbols.a
    for force in applied:
        parts = [x for load in force.loads for x in _scalars(load)]
        if accelerations and any(depends_on(x, accelerations) for x in parts):
            raise DerivationError(
                "a force cannot depend on accelerations",
                f"forces.{force.name}",
                fix="write the inertia as a body's mass, or by a coordinate of its own",
            )
    for effort in efforts:
        if accelerations and depends_on(effort.effort, accelerations):
            raise DerivationError(
                "a joint's drive cannot depend on accelerations",
                f"bodies.{effort.body}.joint",
                fix="write the inertia as a rotor of the joint",
            )


def _scalars(load: Load) -> tuple[Scalar, ...]:
    if isinstance(load, PointForce):
        return load.force
    if isinstance(load, Couple):
        return load.couple
    return (load.value,) if isinstance(load, GeneralizedForce) else load.acceleration


def _joint_efforts(motion: Motion, link: BodyLink) -> list[JointEffort]:
    """Drive, spring and damper of one joint: effort = drive - c s' - k (s - rest)."""
    if link.joint is None:
        return []
    scope, rows = motion.scope, []
    for k, e in enumerate(link.joint.efforts()):
        if e is None or (e.drive is None and e.stiffness is None and e.damping is None):
            continue
        drive = scope.value(e.drive) - scope.value(e.damping) * link.s_rate[k]
        if motion.moves((*link.before.p, *link.point)):
            raise DerivationError(
                "a joint with a drive, spring or damper sits at a place that moves in its body",
                f"bodies.{link.name}.joint",
                "let another joint carry the motion of the seat",
            )
        stretch = link.s[k] - scope.value(e.rest)
        stiffness = scope.value(e.stiffness)
        potential = Fraction(1, 2) * stiffness * stretch * stretch
        rows.append(JointEffort(link.name, k, drive, potential, drive - stiffness * stretch))
    return rows


def joint_wrenches(motion: Motion, effort: JointEffort) -> list[tuple[str, Wrench]]:
    """The effort of a joint as wrenches at the origins of child and parent, each in its own axes.

    The wrench is dual to the joint's column: it does the work effort * s' on the relative motion.
    """
    link = motion.link(effort.body)
    w, v = link.S[effort.variable]
    square = dot(w, w) if not all(is_zero(x) for x in w) else dot(v, v)
    rotary = not all(is_zero(x) for x in w)
    direction = w if rotary else v
    magnitude = effort.effort if type(square) is int and square == 1 else over(effort.effort, square)
    at_joint = Wrench(times(magnitude, direction), ZERO) if rotary else Wrench(ZERO, times(magnitude, direction))
    rows = [(link.name, at_joint.moved(link.point))]
    if link.parent >= 0:
        local = link.before.then(link.relative)
        on_parent = Wrench(times(-1, at_joint.tau), times(-1, at_joint.f)).turned(local.R)
        rows.append((motion.links[link.parent].name, on_parent.moved(local.p)))
    return rows


def body_wrench(motion: Motion, load: PointForce | Couple) -> tuple[str, Wrench] | None:
    """A load as a wrench at its body's origin in body axes (None: it acts on the ground)."""
    if isinstance(load, Couple):
        return load.body, Wrench(in_body_axes(motion, load.body, load.couple, load.axes), ZERO)
    body, r = load.place
    if body is None:
        return None
    f = in_body_axes(motion, body, load.force, load.axes)
    return body, Wrench(cross(r, f), f)


def in_body_axes(motion: Motion, body: str, vector: Vector, axes: str | None) -> Vector:
    """A vector given in the axes of the ground (None) or of a body, in the axes of `body`."""
    if axes == body:
        return vector
    return apply(transposed(motion.link(body).pose.R), in_ground_axes(motion, vector, axes))


def in_ground_axes(motion: Motion, vector: Vector, axes: str | None) -> Vector:
    """A vector given in the axes of a body, in the ground's."""
    return vector if axes is None else apply(motion.link(axes).pose.R, vector)


def weights(loads: Loads) -> tuple[PointForce, ...]:
    """The uniform fields as forces m g at the mass centres."""
    g = loads.fields
    if all(is_zero(x) for x in g):
        return ()
    return tuple(PointForce(place, times(m, g)) for place, m in SystemScene(loads.motion).masses(None))
