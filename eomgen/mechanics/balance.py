"""System -> Balance: every body's own equations, its reactions and its inertia force and couple included.

    sum of reactions + sum of applied forces = inertia:   f = m a_C,   n = d/dt (I w) about the mass centre

In the plane two forces and one moment a body, in ground axes; in space three and three, in the body's axes. The
unknowns are the components of all reactions, of joints and of ties; what drives a given motion is one of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from eomgen.errors import DerivationError
from eomgen.mechanics.contacts import CLOSED, friction_factor
from eomgen.mechanics.inertia import MassProperties, mass_properties
from eomgen.mechanics.kinematics import GROUND, Link, Motion
from eomgen.mechanics.loads import JointEffort, in_ground_axes, weights
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import Row, holds_identically, slide_power
from eomgen.model.forces.load import Couple, PointForce
from eomgen.symbolic.derivative import depends_on, gradient
from eomgen.symbolic.graph import Scalar, is_zero
from eomgen.symbolic.spatial import (
    IDENTITY,
    ZERO,
    Matrix,
    Vector,
    apply,
    cross,
    dot,
    minus,
    plus,
    times,
    transposed,
    vector_of,
)

PLANE_ROWS, SPACE_ROWS = (0, 1, 5), (0, 1, 2, 3, 4, 5)  # of (force, moment) about the mass centre
DIRECTIONS = ("x", "y", "z", "moment x", "moment y", "moment z")


@dataclass(frozen=True)
class Effect:
    """What a unit of a reaction does to one body: force and couple at a place, in the axes of the body's equations.

    Args:
        link: index of the body.
        force, couple: on it.
        arm: from its mass centre to the place [m].
    """

    link: int
    force: Vector
    couple: Vector
    arm: Vector

    @cached_property
    def six(self) -> tuple[Scalar, ...]:
        """Force, and moment about the mass centre."""
        return (*self.force, *plus(self.couple, cross(self.arm, self.force)))


@dataclass(frozen=True)
class Component:
    """One scalar reaction.

    Args:
        owner: the tie, or the body whose joint it is.
        kind: "tie", "joint", or "drive": what moves a driven coordinate at a joint.
        label: "x", "y", "z", "n", "t", "couple", "couple x", "tension", "drive", or "" for a row of no place.
        number: its row in the tie, or its place among the joint's components, from 1.
        effects: of a unit of it, on the child or the first-named body first.
        rubbing: its friction for a unit of it, on the same bodies.
        side: the body on which it is the force of a hinge of several, the coordinate of a drive, or "".
    """

    owner: str
    kind: str
    label: str
    number: int
    effects: tuple[Effect, ...]
    rubbing: tuple[Effect, ...] = ()
    side: str = ""

    @property
    def name(self) -> str:
        """As an output asks for it: reaction_x(B), tension(rope, 2)."""
        if self.label == "tension":
            return f"tension({self.owner})" if self.number == 1 else f"tension({self.owner}, {self.number})"
        if self.label == "drive":
            return f"drive({self.side or self.owner})"
        owner = f"{self.owner}.{self.side}" if self.side else self.owner
        return f"reaction_{self.label.replace(' ', '_')}({owner})"


@dataclass(frozen=True)
class BodyEquation:
    """One scalar equation of one body: sum of coefficients * reactions + applied = inertia.

    Args:
        body: its name.
        direction: index in DIRECTIONS.
        coefficients: {index of the component: coefficient}.
        applied: of everything given, weight included.
        inertia: m a, or the rate of the angular momentum about the mass centre.
    """

    body: str
    direction: int
    coefficients: dict[int, Scalar]
    applied: Scalar
    inertia: Scalar

    @property
    def needed(self) -> Scalar:
        """What the reactions have to make up."""
        return self.inertia - self.applied


@dataclass(frozen=True)
class Balance:
    """All equations of all bodies."""

    system: System
    components: tuple[Component, ...]
    equations: tuple[BodyEquation, ...]


def joint_friction(system: System, link: Link) -> Scalar | None:
    """What a unit of the normal reaction of a path rubs with along the path; None without friction."""
    law = getattr(link.joint, "friction", None)
    if law is None:
        return None
    return friction_factor(law, system.scope.value, link.s_rate[0], system.modes.get(link.name, CLOSED))


def balance_of(system: System) -> Balance:
    """The equations of every body; those that say 0 = 0 are left out.

    Raises:
        DerivationError: a force, an energy or a tie that acts at no place, named.
    """
    refuse_placeless(system)
    axes = _Axes(system.motion)
    components = (*_joint_components(system, axes), *_tie_components(system, axes))
    inertia, applied = _inertia(axes), _applied(system, axes)
    equations = []
    for i, link in enumerate(system.motion.links):
        for d in axes.rows:
            row = {j: value for j, c in enumerate(components) if not is_zero(value := _coefficient(c, i, d))}
            if row or not (is_zero(applied[i][d]) and is_zero(inertia[i][d])):
                equations.append(BodyEquation(link.name, d, row, applied[i][d], inertia[i][d]))
    return Balance(system, components, tuple(equations))


def refuse_placeless(system: System) -> None:
    """Refuse what acts at no place, or on a point that a coordinate moves in its body: some balance would lack it.

    Raises:
        DerivationError: it is named.
    """
    for force in system.loads.applied:
        if force.placeless or any(not hasattr(load, "place") and hasattr(load, "coordinate") for load in force.loads):
            what = f"the force '{force.name}' acts on coordinates and at no place: reactions do not follow"
            raise DerivationError(what, f"forces.{force.name}", "give it as forces and couples on bodies")
        pushes = [load for load in force.loads if isinstance(load, PointForce)]
        if any(_pushes_along(system, slide_power(system.motion, push)) for push in pushes):
            raise _moved_inside(f"the force '{force.name}'", f"forces.{force.name}")
    for row in system.ties.rows:
        if not row.pushes and row.status != "identical":
            raise DerivationError(f"the tie '{row.tie}' acts on coordinates and at no place: reactions do not follow",
                                  f"constraints.{row.tie}", "give it as a tie between bodies")  # fmt: skip
        if row.pushes and _pushes_along(system, row.direct):
            raise _moved_inside(f"the tie '{row.tie}'", f"constraints.{row.tie}")


def _pushes_along(system: System, power: Scalar) -> bool:
    """Whether a force does work on a coordinate by the slide of its point alone."""
    return any(not holds_identically(x) for x in gradient(power, system.symbols.u))


def _moved_inside(what: str, where: str) -> DerivationError:
    return DerivationError(f"{what} acts on a point that a coordinate moves in its body, and no body moves it there",
                           where, "make the point one of a body of its own")  # fmt: skip


@dataclass(frozen=True)
class _Axes:
    """The axes of each body's equations: the ground's in the plane, the body's own in space."""

    motion: Motion

    @property
    def plane(self) -> bool:
        return self.motion.scope.model.space == "plane"

    @property
    def rows(self) -> tuple[int, ...]:
        return PLANE_ROWS if self.plane else SPACE_ROWS

    def of_body(self, link: Link) -> Matrix:
        """From body axes to those of the equations."""
        return link.pose.R if self.plane else IDENTITY

    def of_ground(self, link: Link, vector: Vector) -> Vector:
        """A vector of ground axes."""
        return vector if self.plane else apply(transposed(link.pose.R), vector)

    @cached_property
    def masses(self) -> tuple[MassProperties, ...]:
        return tuple(mass_properties(self.motion.scope, link.name) for link in self.motion.links)

    def arm(self, i: int, place: Vector) -> Vector:
        """From the mass centre to a place given in body axes."""
        link = self.motion.links[i]
        return _turned(self.of_body(link), minus(place, self.masses[i].com))


def _turned(R: Matrix, a: Vector) -> Vector:
    return a if R is IDENTITY else apply(R, a)


def _coefficient(component: Component, link: int, direction: int) -> Scalar:
    """Of the component, its friction included, in one equation of one body."""
    effects = (*component.effects, *component.rubbing)
    return sum((effect.six[direction] for effect in effects if effect.link == link), start=0)


# -- inertia and what is applied -------------------------------------------------------------------


def _inertia(axes: _Axes) -> list[tuple[Scalar, ...]]:
    """(m a_C, d/dt (I w)) of every body, accelerations included."""
    accelerations = _center_accelerations(axes)
    scope = axes.motion.scope
    spins = scope.with_accelerations(tuple(x for link in axes.motion.links for x in link.twist.w))
    rows = []
    for i, (link, mass) in enumerate(zip(axes.motion.links, axes.masses, strict=True)):
        wd, w = vector_of(spins[3 * i : 3 * i + 3]), link.twist.w
        n = plus(apply(mass.I, wd), cross(w, apply(mass.I, w)))
        rows.append((*times(mass.m, accelerations[i]), *_turned(axes.of_body(link), n)))
    return rows


def _center_accelerations(axes: _Axes) -> list[Vector]:
    """Of every mass centre: in the plane from its place, in space from the body's twist."""
    links, scope = axes.motion.links, axes.motion.scope
    if axes.plane:
        places = tuple(x for link, m in zip(links, axes.masses, strict=True) for x in link.pose.point(m.com))
        found = scope.with_accelerations(scope.time_derivative(places))
        return [vector_of(found[3 * i : 3 * i + 3]) for i in range(len(links))]
    velocities = [plus(link.twist.v, cross(link.twist.w, m.com)) for link, m in zip(links, axes.masses, strict=True)]
    moved = [scope.time_derivative(m.com) for m in axes.masses]
    velocities = [plus(v, vector_of(d)) for v, d in zip(velocities, moved, strict=True)]
    rates = scope.with_accelerations(tuple(x for v in velocities for x in v))
    return [
        plus(vector_of(rates[3 * i : 3 * i + 3]), cross(link.twist.w, v))
        for i, (link, v) in enumerate(zip(links, velocities, strict=True))
    ]


def _applied(system: System, axes: _Axes) -> list[tuple[Scalar, ...]]:
    """(force, moment about the mass centre) of everything given, on every body."""
    totals: list[tuple[Scalar, ...]] = [(0,) * 6 for _ in axes.motion.links]
    effects = [e for load in (*system.loads.placed, *weights(system.loads)) for e in _effects(axes, load)]
    for effect in (*effects, *joint_effects(system)):
        totals[effect.link] = tuple(a + b for a, b in zip(totals[effect.link], effect.six, strict=True))
    return totals


def joint_effects(system: System) -> list[Effect]:
    """What drives, springs, dampers and rotors of all joints do, on both bodies of each."""
    axes = _Axes(system.motion)
    effects = [e for effort in system.loads.efforts for e in _effort_effects(axes, effort)]
    for link in axes.motion.links:
        for k, armature in _armatures(axes.motion, link):
            rate = axes.motion.scope.with_accelerations((link.s_rate[k],))[0]
            effects += _joint_effects(axes, link, *_scaled(axes, link.name, k, -armature * rate))
    return effects


def efforts_of(system: System, body: str) -> list[Effect]:
    """What drive, spring and damper of a body's joint do, on the body first."""
    axes = _Axes(system.motion)
    return [e for effort in system.loads.efforts if effort.body == body for e in _effort_effects(axes, effort)]


def _effort_effects(axes: _Axes, effort: JointEffort) -> list[Effect]:
    link = axes.motion.link(effort.body)
    return _joint_effects(axes, link, *_scaled(axes, effort.body, effort.variable, effort.effort))


def _armatures(motion: Motion, link: Link) -> list[tuple[int, Scalar]]:
    efforts = () if link.joint is None else link.joint.efforts()
    return [(k, motion.scope.value(e.armature)) for k, e in enumerate(efforts) if e is not None and e.armature]


def _scaled(axes: _Axes, body: str, variable: int, magnitude: Scalar) -> tuple[Vector, Vector]:
    """(force, couple) along a joint's variable that do the work magnitude * s', child's axes."""
    w, v = axes.motion.link(body).S[variable]
    if not all(is_zero(x) for x in w):
        return ZERO, times(_over_square(magnitude, w), w)
    return times(_over_square(magnitude, v), v), ZERO


def _over_square(magnitude: Scalar, n: Vector) -> Scalar:
    square = dot(n, n)
    return magnitude if type(square) is int and square == 1 else magnitude / square


def _effects(axes: _Axes, load: PointForce | Couple) -> tuple[Effect, ...]:
    """A load on its body; none on the ground."""
    body = load.body if isinstance(load, Couple) else load.place[0]
    if body is None:
        return ()
    i = axes.motion.index[body]
    link = axes.motion.links[i]
    given = load.couple if isinstance(load, Couple) else load.force
    vector = given if load.axes == body and not axes.plane else axes.of_ground(
        link, in_ground_axes(axes.motion, given, load.axes))  # fmt: skip
    if isinstance(load, Couple):
        return (Effect(i, ZERO, vector, ZERO),)
    return (Effect(i, vector, ZERO, axes.arm(i, load.place[1])),)


# -- reactions -------------------------------------------------------------------------------------


def _tie_components(system: System, axes: _Axes) -> list[Component]:
    found = []
    for row in system.ties.rows:
        effects = tuple(e for push in row.pushes for e in _effects(axes, push))
        if not effects:
            continue
        rubbing: tuple[Effect, ...] = ()
        if row.friction is not None:
            rubbing = tuple(_times(row.friction, e) for push in row.tangent for e in _effects(axes, push))
        found.append(_of_tie(system, row, effects, rubbing))
    return found


def _of_tie(system: System, row: Row, effects: tuple[Effect, ...], rubbing: tuple[Effect, ...]) -> Component:
    """The component; of a hinge of several bodies, the force on the one that the row adds.

    Where the first-named point is the ground's, it is the force on the body.
    """
    first = row.pushes[0]
    held = row.component in ("x", "y", "z") and isinstance(first, PointForce)
    points = getattr(system.scope.model.constraints.get(row.tie), "points", None) or ()
    if held and (len(points) > 2 or first.place[0] is None):
        side = system.motion.links[effects[-1].link].name if len(points) > 2 else ""
        turned = tuple(_times(-1, e) for e in effects)
        return Component(row.tie, "tie", row.component, row.number, turned, (), side)
    return Component(row.tie, "tie", row.component, row.number, effects, rubbing)


def _times(k: Scalar, effect: Effect) -> Effect:
    return Effect(effect.link, times(k, effect.force), times(k, effect.couple), effect.arm)


def _joint_components(system: System, axes: _Axes) -> list[Component]:
    found = []
    driven = _driven_joints(axes.motion)
    for link in axes.motion.links:
        joint = link.joint
        if joint is None or not joint.carries_reaction:
            continue
        pushes = _basis(axes, link)
        for number, (label, force, couple) in enumerate(pushes, start=1):
            effects = tuple(_joint_effects(axes, link, force, couple))
            factor = joint_friction(system, link) if label == "n" else None
            rubbing = () if factor is None else tuple(_joint_effects(axes, link, *_scaled(axes, link.name, 0, factor)))
            found.append(Component(link.name, "joint", label, number, effects, rubbing))
        for k, s in enumerate(link.s):
            if link.name in driven and _is_driven(axes.motion, s):
                effects = tuple(_joint_effects(axes, link, *_scaled(axes, link.name, k, 1)))
                found.append(Component(link.name, "drive", "drive", k + 1, effects, (), driven[link.name]))
    return found


def _driven_joints(motion: Motion) -> dict[str, str]:
    """{body: coordinate} of the joints at which somebody has to drive a given motion ("": time alone).

    They are those whose variable follows it alone; where there is none, those in which it has a part.
    """
    symbols, table = motion.scope.symbols, motion.scope.model.coordinates
    free = [q for q in symbols.q if not table[q.name].driven]
    found: dict[str, str] = {}
    for driver in (*(q for q in symbols.q if table[q.name].driven), symbols.t):
        name = "" if driver is symbols.t else driver.name
        joints = [link for link in motion.links if link.joint is not None and link.joint.carries_reaction]
        moved = {link.name: link for link in joints if any(depends_on(s, (driver,)) for s in link.s)}
        alone = [body for body, link in moved.items() if not any(depends_on(s, free) for s in link.s)]
        found |= dict.fromkeys(alone or moved, name)
    return found


def _is_driven(motion: Motion, s: Scalar) -> bool:
    """Whether a joint's variable follows a given motion."""
    driven = [q for q in motion.scope.symbols.q if motion.scope.model.coordinates[q.name].driven]
    return depends_on(s, (*driven, motion.scope.symbols.t))


def _basis(axes: _Axes, link: Link) -> list[tuple[str, Vector, Vector]]:
    """(label, force, couple) of each reaction of a joint, child's axes: the complement of its freedom.

    Where every force in the plane (in space: every force, every couple) can be carried, along the equations' axes.
    """
    columns = link.joint.complement(link.s, axes.motion.scope.value)
    forces = [c[3:] for c in columns if all(is_zero(x) for x in c[:3])]
    couples = [c[:3] for c in columns if all(is_zero(x) for x in c[3:])]
    mixed = [c for c in columns if any(not is_zero(x) for x in c[:3]) and any(not is_zero(x) for x in c[3:])]
    R_CE = transposed(axes.of_body(link))
    axis = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    if axes.plane:
        forces = [f for f in forces if any(not is_zero(x) for x in f[:2])]
        couples = [c for c in couples if not is_zero(c[2])]
        held = 2
    else:
        held = 3
    if len(forces) == held:
        found = [("xyz"[k], _turned(R_CE, axis[k]), ZERO) for k in range(held)]
    else:
        found = [(label, f, ZERO) for label, f in _normals(axes, link, forces)]
    if axes.plane:
        return [*found, *(("couple", ZERO, c) for c in couples)]
    if len(couples) == 3:
        found += [(f"couple {name}", ZERO, e) for name, e in zip("xyz", axis, strict=True)]
    else:
        found += [("couple" if len(couples) == 1 else f"couple {k}", ZERO, c) for k, c in enumerate(couples, start=1)]
    return [*found, *((f"wrench {k}", tuple(c[3:]), tuple(c[:3])) for k, c in enumerate(mixed, start=1))]


def _normals(axes: _Axes, link: Link, forces: list[Vector]) -> list[tuple[str, Vector]]:
    """The forces that a guide can carry; in the plane the one along the left normal of its motion."""
    sliding = [v for w, v in link.S if all(is_zero(x) for x in w)]
    if axes.plane and len(forces) == 1 and len(sliding) == 1:
        v = sliding[0]
        return [("n", (-v[1], v[0], 0))]
    return [(f"n {k}" if len(forces) > 1 else "n", f) for k, f in enumerate(forces, start=1)]


def _joint_effects(axes: _Axes, link: Link, force: Vector, couple: Vector) -> list[Effect]:
    """Force and couple (child's axes) at a joint, on the child and opposite on the parent."""
    i = axes.motion.index[link.name]
    R = axes.of_body(link)
    effects = [Effect(i, _turned(R, force), _turned(R, couple), axes.arm(i, link.point))]
    if link.parent != GROUND:
        to_parent = R if axes.plane else link.local.R
        f, n = times(-1, _turned(to_parent, force)), times(-1, _turned(to_parent, couple))
        effects.append(Effect(link.parent, f, n, axes.arm(link.parent, link.local.p)))
    return effects
