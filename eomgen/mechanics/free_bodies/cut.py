"""Balance -> Pushes: all that acts on each body once it is cut free, one by one, in the ground's axes.

    a push = direction * (sum of shares * components + given)

What a joint or a constraint does to two bodies stands on both, under one name, with opposite directions. The inertia
force -m a_C and its couple -d/dt (I w) are pushes as well, so that those of a body are in equilibrium. Sources: the
`effects` of the components, the loads of the system, the right sides of the balance; no law is said again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field, replace

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies.balance import Balance
from eomgen.mechanics.free_bodies.names_of_reactions import is_named_alone
from eomgen.mechanics.free_bodies.wrenches import Axes, Component, Effect, effects_at_joint, rotors_of
from eomgen.mechanics.kinematics import BodyLink, JointEffort
from eomgen.model import Couple, Element, PointForce
from eomgen.symbolic.expression import Matrix, Scalar, Vector, is_zero, substituted


class ForceKind:
    """Kinds of what acts on a body that is cut free."""

    WEIGHT, SPRING, DAMPER, DRIVE, FRICTION = "weight", "spring", "damper", "drive", "friction"
    APPLIED, REACTION, INERTIA = "applied", "reaction", "inertia"


@dataclass(frozen=True)
class CutForce:
    """A force, or a couple, on a body.

    Args:
        body: its name.
        name: of a reaction as an output writes it, of a load its own.
        kind: one of ForceKind.
        at: the place, ground axes [m].
        direction: of a value of 1, ground axes; of a load all of it.
        turns: it is a couple.
        shares: {component: factor} of its value.
        given: what its value has besides.
        along: a line on which a load lies, in the sense in which its value is positive; None: its own direction.
        has_sense: its sense is no matter of a letter: of loads, pulls of strings, pushes of contacts, sliding friction.
        spread: it replaces a part of a load along a line, together with its other part.
    """

    body: str
    name: str
    kind: str
    at: Vector
    direction: Vector
    turns: bool = False
    shares: Mapping[int, Scalar] = field(default_factory=dict)
    given: Scalar = 0
    along: Vector | None = None
    has_sense: bool = False
    spread: bool = False

    @staticmethod
    def on_bodies(balance: Balance) -> tuple[CutForce, ...]:
        """All that acts on each body: weights, loads, springs, dampers, drives, reactions, inertia; in this order."""
        found = [*_weights(balance.system), *_loads(balance.system), *_efforts(balance), *_reactions(balance)]
        return (*found, *_fluids(balance.system), *_inertia(balance))


# -- loads -----------------------------------------------------------------------------------------


def _weights(system: System) -> Iterator[CutForce]:
    fields = (f.name for f in system.loads.applied if f.is_field)
    name, axes = " + ".join(fields), Axes(system.motion)
    for load in system.loads.weights:
        yield from _given(axes, axes.effects_of(load), name, ForceKind.WEIGHT)


def _loads(system: System) -> Iterator[CutForce]:
    axes = Axes(system.motion)
    for applied in system.loads.applied:
        element = system.scope.model.forces[applied.name].element
        loads = [load for load in applied.loads if isinstance(load, (PointForce, Couple))]
        for kind, own in _parts(system, element, loads):
            for k, load in enumerate(own):
                found = _given(axes, axes.effects_of(load), applied.name, kind, _line(system, element, k))
                yield from (replace(push, spread=bool(applied.spread)) for push in found)


def _given(
    axes: Axes, effects: Iterable[Effect], name: str, kind: str, along: Vector | None = None
) -> Iterator[CutForce]:
    """A load as it acts on bodies."""
    about_z = Vector((0, 0, 1)) if axes.plane and kind != ForceKind.APPLIED else None
    for force in _acting(axes, effects, name, kind):
        line = about_z if force.turns else along
        yield replace(force, given=1, along=line, has_sense=kind in (ForceKind.WEIGHT, ForceKind.APPLIED))


def _acting(axes: Axes, effects: Iterable[Effect], name: str, kind: str) -> Iterator[CutForce]:
    """Forces and couples of effects; the moment of a force that acts beyond its place is in its place."""
    for effect in effects:
        for vector, turns in ((effect.force, False), (effect.couple, True)):
            if not all(map(is_zero, vector)) and not (turns and effect.beyond is not None):
                yield _force(axes, effect, vector, name, kind, turns)


def _force(axes: Axes, effect: Effect, vector: Vector, name: str, kind: str, turns: bool) -> CutForce:
    link = axes.motion.links[effect.link]
    place = axes.masses[effect.link].com if effect.place is None else effect.place
    at = link.pose.point(place + (effect.beyond or Vector.ZERO))
    return CutForce(link.name, name, kind, at, _in_ground(axes, effect.link, vector), turns)


def _in_ground(axes: Axes, link: int, vector: Vector) -> Vector:
    return vector if axes.plane else axes.motion.links[link].pose.R @ vector


def _parts(
    system: System, element: Element | None, loads: list[PointForce | Couple]
) -> Iterator[tuple[str, list[PointForce | Couple]]]:
    """(kind, loads): of a spring with a damper what it does at rest, and what the speeds add."""
    if element is None or element.pull is not None or (element.stiffness is None and element.damping is None):
        yield ForceKind.APPLIED, loads
        return
    if element.stiffness is None or element.damping is None:
        yield (ForceKind.SPRING if element.damping is None else ForceKind.DAMPER), loads
        return
    still = dict.fromkeys(system.symbols.u, 0)
    rest = [Vector(substituted(tuple(_vector(load)), still)) for load in loads]
    yield ForceKind.SPRING, [_with(load, v) for load, v in zip(loads, rest, strict=True)]
    yield ForceKind.DAMPER, [_with(load, _vector(load) - v) for load, v in zip(loads, rest, strict=True)]


def _vector(load: PointForce | Couple) -> Vector:
    return load.couple if isinstance(load, Couple) else load.force


def _with(load: PointForce | Couple, v: Vector) -> PointForce | Couple:
    return replace(load, couple=v) if isinstance(load, Couple) else replace(load, force=v)


def _line(system: System, element: Element | None, k: int) -> Vector | None:
    """The way from the k-th end of a spring or damper to the other: a pull is positive."""
    if element is None or len(element.points) != 2 or element.along is not None or k > 1:
        return None
    here, there = (system.motion.position(system.motion.place(point)) for point in element.points)
    return there - here if k == 0 else here - there


# -- in joints -------------------------------------------------------------------------------------


def _efforts(balance: Balance) -> Iterator[CutForce]:
    """Drives, springs, dampers and rotors of joints, but for those that a whole reaction holds already."""
    system, axes = balance.system, Axes(balance.system.motion)
    for link in system.motion.links:
        if _is_whole(balance, link.name):
            continue
        for effort in (effort for effort in system.loads.efforts if effort.body == link.name):
            for kind, size in _shares_of(system, link, effort):
                if not is_zero(size):
                    effects = effects_at_joint(axes, link, *link.pushed_along(effort.variable, size))
                    yield from _given(axes, effects, f"{kind}({link.name})", kind)
        yield from _given(axes, rotors_of(axes, link), f"rotor({link.name})", ForceKind.INERTIA)


def _shares_of(system: System, link: BodyLink, effort: JointEffort) -> Iterator[tuple[str, Scalar]]:
    """(kind, size) of what acts along one variable of a joint: a drive, a spring, a damper, dry friction."""
    declared = link.joint.efforts()[effort.variable] if link.joint is not None else None
    drive = 0 if declared is None or declared.drive is None else system.scope.value(declared.drive)
    yield ForceKind.DRIVE, drive
    yield ForceKind.SPRING, effort.effort - effort.drive
    yield ForceKind.DAMPER, effort.drive - drive - effort.friction
    yield ForceKind.FRICTION, effort.friction


# -- reactions -------------------------------------------------------------------------------------


def _reactions(balance: Balance) -> Iterator[CutForce]:
    owners = dict.fromkeys(c.owner for c in balance.components)
    for owner in owners:
        mine = {j: c for j, c in enumerate(balance.components) if c.owner == owner}
        whole = _is_whole(balance, owner)
        for j, c in mine.items():
            if not whole or _is_apart(balance, c):
                yield from _of_component(balance, j, c)
        if whole:
            yield from _of_whole(balance, owner, {j: c for j, c in mine.items() if not _is_apart(balance, c)})


def _is_apart(balance: Balance, c: Component) -> bool:
    """True if outputs name a component as it is."""
    plane = balance.system.scope.model.space == "plane"
    return c.kind != "drive" and (is_named_alone(balance, c) or (plane and not c.is_wrench))


def _is_whole(balance: Balance, owner: str) -> bool:
    """True if outputs name forces and couples of an owner along the ground's axes, its drives and springs in them."""
    return any(c.owner == owner and c.kind != "drive" and not _is_apart(balance, c) for c in balance.components)


def _of_component(balance: Balance, j: int, c: Component) -> Iterator[CutForce]:
    """A component on every body, and its friction."""
    axes, kind = Axes(balance.system.motion), ForceKind.DRIVE if c.kind == "drive" else ForceKind.REACTION
    effects = _at_rims(axes, c.effects) if c.label == "tension" else c.effects
    parts: list[tuple[str, Scalar, tuple[Effect, ...], bool]]
    parts = [(c.name, 1, effects, _has_sense(balance, c))]
    parts += [(f"reaction_{s.label}({c.owner})", s.factor, s.effects, True) for s in c.friction]
    for name, factor, acting, has_sense in parts:
        for force in _acting(axes, acting, name, kind):
            yield replace(force, shares={j: factor}, has_sense=has_sense)


def _has_sense(balance: Balance, c: Component) -> bool:
    """True if a reaction can only pull, as a string does, or only push, as a contact does that can end."""
    constraint = balance.system.scope.model.constraints.get(c.owner)
    if constraint is None or c.kind == "drive":
        return False
    one_sided = c.label in ("n", "couple") and bool(getattr(constraint, "unilateral", False))
    return one_sided or (c.label == "tension" and bool(constraint.strand_rows()))


def _at_rims(axes: Axes, effects: tuple[Effect, ...]) -> tuple[Effect, ...]:
    """Pulls of a string on rims: of a pull d at the centre and the couple c = r x d after it one at r = d x c."""
    found: list[Effect] = []
    for effect in effects:
        before = found[-1] if found else None
        turns = all(map(is_zero, effect.force))
        if turns and before is not None and before.link == effect.link and before.place is not None:
            R_BE = axes.of_body(axes.motion.links[effect.link]).T
            found[-1] = replace(before, beyond=R_BE @ before.force.cross(effect.couple))
        else:
            found.append(effect)
    return tuple(found)


def _of_whole(balance: Balance, owner: str, mine: Mapping[int, Component]) -> Iterator[CutForce]:
    """Force and couple of an owner on each body that it touches, along the ground's axes."""
    axes = Axes(balance.system.motion)
    efforts = Effect.of_joint(balance.system, owner)
    effects = [(j, e) for j, c in mine.items() for e in (*c.effects, *c.friction_effects)]
    first = next(e.link for j, e in effects if mine[j].kind != "drive")
    sides = {axes.motion.index[c.side]: c.side for c in mine.values() if c.side and c.side in axes.motion.index}
    for link in dict.fromkeys(e.link for _, e in effects):
        side = f".{sides[link]}" if link in sides else ""
        sense = 1 if link == first or side else -1
        own = [(j, e) for j, e in effects if e.link == link]
        given = [e for e in efforts if e.link == link]
        places = [e for _, e in own if not all(map(is_zero, e.force))] or [e for _, e in own]
        for turns in (False, True):
            vectors = [(j, _in_ground(axes, link, e.couple if turns else e.force)) for j, e in own]
            more = [_in_ground(axes, link, e.couple if turns else e.force) for e in given]
            for k in range(3):
                shares: dict[int, Scalar] = {}
                for j, v in vectors:
                    shares[j] = shares.get(j, 0) + sense * v[k]
                shares = {j: x for j, x in shares.items() if not is_zero(x)}
                total = sense * sum((v[k] for v in more), start=0)
                if shares or not is_zero(total):
                    name = f"reaction_{'couple_' if turns else ''}{'xyz'[k]}({owner}{side})"
                    name = f"reaction_couple({owner}{side})" if turns and axes.plane else name
                    unit = sense * Matrix.IDENTITY[k]
                    push = _force(axes, places[0], Vector.ZERO, name, ForceKind.REACTION, turns)
                    yield replace(push, direction=unit, shares=shares, given=total)


# -- inertia ---------------------------------------------------------------------------------------


def _fluids(system: System) -> Iterator[CutForce]:
    """Pushes of the fluid that moves with a body, by its inertia."""
    for name, effect in Effect.of_fluids(system).items():
        yield from _given(Axes(system.motion), (effect,), f"fluid({name})", ForceKind.INERTIA)


def _inertia(balance: Balance) -> Iterator[CutForce]:
    """-m a_C and -d/dt (I w) of every body."""
    axes = Axes(balance.system.motion)
    for i, link in enumerate(axes.motion.links):
        six: list[Scalar] = [0] * 6
        for equation in balance.equations:
            if equation.body == link.name:
                six[equation.direction] = equation.inertia
        for turns in (False, True):
            vector = -Vector(six[3:] if turns else six[:3])
            if not all(map(is_zero, vector)):
                at = link.pose.point(axes.masses[i].com)
                about_z = Vector((0, 0, 1)) if turns and axes.plane else None
                direction = _in_ground(axes, i, vector)
                name = f"inertia_couple({link.name})" if turns else f"inertia({link.name})"
                yield CutForce(link.name, name, ForceKind.INERTIA, at, direction, turns, {}, 1, about_z, True)
