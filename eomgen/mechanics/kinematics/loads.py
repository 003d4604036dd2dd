"""Motion -> Loads: every applied force, as loads at places and as potentials.

One description serves both ways to the generalized forces: virtual work on positions,
Q_k = sum F . dp/dq_k - dV/dq_k, and wrenches on twists, Q = sum B^T W.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from functools import cached_property

from eomgen.errors import DerivationError, NotYet
from eomgen.frozen import dataclass
from eomgen.mechanics.kinematics.motion import BodyLink, Motion
from eomgen.mechanics.kinematics.scene import ContactMode, ContactModes, SystemScene
from eomgen.model import Couple, GeneralizedForce, JointFriction, Load, PointForce, Push, SpreadLoad, UniformField
from eomgen.symbolic.expression import (
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    ScalarRows,
    Vector,
    Wrench,
    depends_on,
    gradient,
    is_zero,
    jacobian,
    over,
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
        friction: the dry friction in it along the rate `slip`; 0 of others, and while it sticks.
    """

    name: str
    loads: tuple[Load, ...]
    potential: Scalar | None
    placeless: bool
    spread: tuple[SpreadLoad, ...] = ()
    friction: Scalar = 0
    slip: Scalar = 0

    @property
    def is_field(self) -> bool:
        """True if it is a field of acceleration, which acts on every mass."""
        return any(isinstance(load, UniformField) for load in self.loads)

    @property
    def is_along_coordinate(self) -> bool:
        """True if it acts along a coordinate, and at no place."""
        return any(isinstance(load, GeneralizedForce) for load in self.loads)


@dataclass(frozen=True)
class JointEffort:
    """A scalar force on a joint's variable: drive, spring, damper and dry friction of constant size.

    Args:
        body: the child; the parent bears the opposite.
        variable: index of the joint's variable s.
        drive: torque or force without a potential (damping and friction included) [N m or N].
        potential: k (s - rest)^2 / 2 [J], or 0.
        effort: the whole effort along s, -dV/ds included.
        friction: the dry friction in it.
    """

    body: str
    variable: int
    drive: Scalar
    potential: Scalar
    effort: Scalar
    friction: Scalar = 0

    def wrenches(self, motion: Motion) -> list[tuple[str, Wrench]]:
        """The effort of a joint as wrenches at the origins of child and parent, each in its own axes.

        The wrench is dual to the joint's column: it does the work effort * s' on the relative motion.
        """
        link = motion.link(self.body)
        w, v = link.S[self.variable]
        square = w @ w if not all(is_zero(x) for x in w) else v @ v
        rotary = not all(is_zero(x) for x in w)
        direction = w if rotary else v
        magnitude = self.effort if type(square) is int and square == 1 else over(self.effort, square)
        at_joint = Wrench(magnitude * direction, Vector.ZERO) if rotary else Wrench(Vector.ZERO, magnitude * direction)
        rows = [(link.name, at_joint.moved(link.point))]
        if link.parent >= 0:
            local = link.before.then(link.relative)
            on_parent = Wrench(-at_joint.tau, -at_joint.f).turned(local.R)
            rows.append((motion.links[link.parent].name, on_parent.moved(local.p)))
        return rows


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
        total = Vector.ZERO
        for load in self._all:
            if isinstance(load, UniformField):
                total = total + load.acceleration
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

    @property
    def weights(self) -> tuple[PointForce, ...]:
        """The uniform fields as forces m g at the mass centres."""
        g = self.fields
        if all(is_zero(x) for x in g):
            return ()
        return tuple(PointForce(place, m * g) for place, m in SystemScene(self.motion).masses(None))

    # -- generalized forces, by virtual work on positions and by derivatives of the potential energy -------

    @property
    def generalized_forces(self) -> ScalarRow:
        """Q_k of everything applied: -dV/dq_k where there is a potential, else the virtual work per unit of q_k."""
        rows = [self.force_row(force) for force in self.applied] + [self.effort_row(e) for e in self.efforts]
        return _summed(rows, len(self.motion.scope.symbols.u))

    @property
    def powered_forces(self) -> ScalarRow:
        """Q_nc: the part of Q that comes from no potential, by virtual work."""
        motion = self.motion
        rows = [self.force_row(force) for force in self.applied if force.potential is None]
        rows += [self.drive_row(effort) for effort in self.efforts]
        return _summed(rows, len(motion.scope.symbols.u))

    def acting(self, holds: Callable[[ScalarRow], bool]) -> str:
        """Names of the forces and joints whose rows of Q have a property: "the force 'd' and the joint of 'x'"."""
        found = [f"the force '{force.name}'" for force in self.applied if holds(self.force_row(force))]
        found += [f"the joint of '{effort.body}'" for effort in self.efforts if holds(self.effort_row(effort))]
        return " and ".join(dict.fromkeys(found))

    def force_row(self, force: Applied) -> ScalarRow:
        """Q of one named force."""
        if force.potential is not None:
            return self.motion.scope.from_potential(force.potential)
        size = len(self.motion.scope.symbols.u)
        return _summed([self.load_row(load) for load in force.loads], size)

    def effort_row(self, effort: JointEffort) -> ScalarRow:
        """Q of a joint's drive, spring and damper: drive ds/dq - dV/dq."""
        elastic = self.motion.scope.from_potential(effort.potential)
        return tuple(d + e for d, e in zip(self.drive_row(effort), elastic, strict=True))

    def drive_row(self, effort: JointEffort) -> ScalarRow:
        """Q of what a joint's drive and damper do: drive ds/dq."""
        s = self.motion.link(effort.body).s[effort.variable]
        return tuple(effort.drive * d for d in self.motion.scope.per_speed(gradient(s, self.motion.scope.symbols.q)))

    def load_row(self, load: Load) -> ScalarRow:
        """Q of one load by virtual work."""
        motion = self.motion
        symbols = motion.scope.symbols
        if isinstance(load, GeneralizedForce):
            row = tuple(load.value if q.name == load.coordinate else 0 for q in symbols.q)
            return motion.scope.per_speed(row)
        if isinstance(load, UniformField):
            return _summed([self.load_row(weight) for weight in self.weights], len(symbols.u))
        if isinstance(load, Couple):
            spin = jacobian(motion.spin(motion.link(load.body)), symbols.u)
            couple = motion.in_body_axes(load.body, load.couple, load.axes)
            return _weighted(couple, spin, len(symbols.u))
        position = jacobian(motion.position(load.place), symbols.q)
        force = motion.in_ground_axes(load.force, load.axes)
        return motion.scope.per_speed(_weighted(force, position, len(symbols.q)))

    @property
    def placeless_forces(self) -> ScalarRow:
        """Q of what no twist contains: generalized forces, energies of coordinates, forces on sliding points."""
        size = len(self.motion.scope.symbols.u)
        rows = [self.load_row(load) for load in self.generalized]
        energies = [force.potential for force in self.applied if force.placeless]
        rows += [self.motion.scope.from_potential(V) for V in energies if V is not None]
        rows += [self._sliding_row(load) for load in self.placed if isinstance(load, PointForce)]
        return _summed(rows, size)

    def _sliding_row(self, force: PointForce) -> ScalarRow:
        """Q of a force whose point moves in its body: F . d(R r')/du."""
        u = self.motion.scope.symbols.u
        slide = self.motion.slide(force.place)
        if slide == Vector.ZERO:
            return (0,) * len(u)
        return _weighted(self.motion.in_ground_axes(force.force, force.axes), jacobian(slide, u), len(u))

    @property
    def joint_forces(self) -> ScalarRow:
        """Q of the joints' efforts on the joint variables: D^T effort."""
        motion = self.motion
        size = len(motion.scope.symbols.u)
        rows = []
        for effort in self.efforts:
            rate = motion.link(effort.body).s_rate[effort.variable]
            rows.append(tuple(effort.effort * d for d in gradient(rate, motion.scope.symbols.u)))
        return _summed(rows, size)

    @staticmethod
    def of(motion: Motion, begun: Mapping[Node, Scalar] | None = None, modes: ContactModes | None = None) -> Loads:
        """Every applied force of the model, as loads and potentials.

        Args:
            begun: where coordinates start that do not start where they are declared to.
            modes: how joints with dry friction slip or stick.
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
            one = Applied(name, loads, force.potential(scene), force.placeless, spread)
            if force.friction is not None:
                one = _rubbing(motion, one, force.friction, force.pushes(scene), modes or {})
            applied.append(one)
        efforts = [effort for link in motion.links for effort in _joint_efforts(motion, link, modes or {})]
        _refuse_accelerations(motion, applied, efforts)
        return Loads(motion, tuple(applied), tuple(efforts), begun)


def _rubbing(
    motion: Motion, applied: Applied, law: JointFriction, pushes: tuple[Push, ...], modes: ContactModes
) -> Applied:
    """A force with its dry friction, - F sign(v) along its rate of slipping v, of which the pushes are a unit."""
    assert law.size is not None, "a force that rubs has a size"
    scope, slip = motion.scope, motion.power(pushes)
    factor = modes.get(applied.name, ContactMode()).joint_factor(law, scope.value, slip)
    friction = ContactMode.size_of(scope, law.size) * factor
    rubs = () if is_zero(friction) else tuple(push.times(friction) for push in pushes)
    return replace(applied, loads=(*applied.loads, *rubs), friction=friction, slip=slip)


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


def _joint_efforts(motion: Motion, link: BodyLink, modes: ContactModes) -> list[JointEffort]:
    """Drive, spring, damper and friction of one joint: effort = drive - c s' - T sign(s') - k (s - rest)."""
    if link.joint is None:
        return []
    scope, rows = motion.scope, []
    frictions = {k: (link.joint.named_contact(link.name, field), law) for k, field, law in link.joint.frictions}
    for k, e in enumerate(link.joint.efforts()):
        name, law = frictions.get(k, ("", None))
        size = None if law is None else law.size
        given = (None,) * 4 if e is None else (e.drive, e.damping, e.stiffness, e.rest)
        if size is None and not any(x is not None for x in given[:3]):
            continue
        acting, damping, stiffness, rest = map(scope.value, given)
        factor = 0 if law is None else modes.get(name, ContactMode()).joint_factor(law, scope.value, link.s_rate[k])
        friction = 0 if size is None else ContactMode.size_of(scope, size) * factor
        drive = acting - damping * link.s_rate[k] + friction
        if motion.moves((*link.before.p, *link.point)):
            raise DerivationError(
                "a joint with a drive, spring, damper or friction sits at a place that moves in its body",
                f"bodies.{link.name}.joint",
                "let another joint carry the motion of the seat",
            )
        stretch = link.s[k] - rest
        potential = Fraction(1, 2) * stiffness * stretch * stretch
        rows.append(JointEffort(link.name, k, drive, potential, drive - stiffness * stretch, friction))
    return rows


def _summed(rows: list[ScalarRow], size: int) -> ScalarRow:
    """The sum of rows, entry by entry."""
    sums: list[Scalar] = [0] * size
    for row in rows:
        sums = [a + b for a, b in zip(sums, row, strict=True)]
    return tuple(sums)


def _weighted(force: Vector, rows: ScalarRows, size: int) -> ScalarRow:
    """force . d(position)/dq_k for each k."""
    return tuple(force @ Vector(row[k] for row in rows) for k in range(size))
