"""Loads, reactions -> marks: arrows of what is applied, the field of gravity, forces of joints and constraints."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Axes, Component
from eomgen.mechanics.kinematics import Motion, SystemScene
from eomgen.model import Couple, PointForce, SpreadLoad
from eomgen.scene.forms import ArrowForm, CoupleForm, FieldForm, LoadForm
from eomgen.scene.scene import Mark
from eomgen.symbolic.expression import Matrix, Scalar, Vector, is_zero, over, substituted


def field_marks(system: System) -> list[Mark]:
    """The direction of the weight."""
    g = system.loads.fields
    return [] if all(map(is_zero, g)) else [Mark(FieldForm(g, "g"), 0, "axes", "")]


def applied_marks(system: System) -> Iterator[Mark]:
    """Forces and couples at bodies, but for weights, springs and dampers, and drives of joints."""
    motion, model = system.motion, system.scope.model
    for applied in system.loads.applied:
        force = model.forces[applied.name]
        if force.element is not None or force.strands_at(SystemScene(motion, f"forces.{applied.name}")):
            continue
        for spread in applied.spread:
            ends = _known(system, spread.at_start), _known(system, spread.at_end)
            yield spread_mark(motion, replace(spread, at_start=ends[0], at_end=ends[1]), applied.name, applied.name)
        for load in () if applied.spread else applied.loads:
            if isinstance(load, PointForce) and load.place[0] is not None:
                f = _known(system, motion.in_ground_axes(load.force, load.axes))
                at = motion.position(load.place)
                yield Mark(ArrowForm(at, f, "N", text=applied.name), 0, "force", applied.name)
            elif isinstance(load, Couple):
                at = motion.position(load.place or (load.body, Vector.ZERO))
                couple = _known(system, motion.in_ground_axes(load.couple, load.axes))
                yield Mark(CoupleForm(at, couple, applied.name), 0, "force", applied.name)
    yield from _drives(system)


def spread_mark(motion: Motion, load: SpreadLoad, of: str, text: str) -> Mark:
    """A load along a line with its name."""
    ends = motion.position(load.start), motion.position(load.end)
    return Mark(LoadForm(*ends, load.at_start, load.at_end, text), 0, "force", of)


def _given(system: System) -> Iterator[Mark]:
    """Weights at the mass centres, and what springs and dampers do to the bodies at their ends."""
    motion, model = system.motion, system.scope.model
    for weight in system.loads.weights:
        yield Mark(_from(motion.position(weight.place), weight.force), 0, "force", f"weight({weight.place[0]})")
    for applied in system.loads.applied:
        if model.forces[applied.name].element is None:
            continue
        for load in applied.loads:
            if isinstance(load, PointForce) and load.place[0] is not None:
                yield Mark(_from(motion.position(load.place), load.force), 0, "force", applied.name)
    for effort in system.loads.efforts:
        link = motion.link(effort.body)
        w, v = link.S[effort.variable]
        declared = None if link.joint is None else link.joint.efforts()[effort.variable]
        drive = 0 if declared is None or declared.drive is None else system.scope.value(declared.drive)
        size = effort.effort - drive
        if all(map(is_zero, w)) and not is_zero(size):
            along = link.pose.R @ (over(size, v @ v) * v)
            yield Mark(_from(link.pose.point(link.point), along), 0, "force", f"spring({effort.body})")


def _from(at: Vector, force: Vector) -> ArrowForm:
    return ArrowForm(at, force, "N", outward=True)


def _known(system: System, v: Vector) -> Vector:
    """A load in which an unknown number, to be found, is drawn as 1."""
    return Vector(substituted(v, dict.fromkeys(system.symbols.unknowns.values(), 1)))


def _drives(system: System) -> Iterator[Mark]:
    """The drives of joints, on the child."""
    for link in system.motion.links:
        efforts = () if link.joint is None else link.joint.efforts()
        for (w, v), effort in zip(link.S, efforts, strict=False):
            if effort is None or effort.drive is None:
                continue
            value = system.scope.value(effort.drive)
            at = link.pose.point(link.point)
            turns = not all(map(is_zero, w))
            along = link.pose.R @ (value * (w if turns else v))
            form = CoupleForm(at, along) if turns else ArrowForm(at, along, "N", outward=True)
            yield Mark(form, 0, "force", link.name)


@dataclass(frozen=True)
class Resultant:
    """Force of a joint or constraint on the body that it holds: the sum of its components along unit vectors.

    Args:
        owner: the constraint, or the body whose joint it is.
        at: the point where it acts, ground axes [m].
        units: of each component by its name, `reaction_x(A)` or `reaction_n(wall)`, the direction, ground axes.
        pulls: it is the tension of a string: its arrow begins at its place.
    """

    owner: str
    at: Vector
    units: Mapping[str, Vector]
    pulls: bool = False

    def of(self, values: Mapping[str, Scalar]) -> Vector:
        """The resultant, ground axes [N]."""
        total = Vector.ZERO
        for name, along in self.units.items():
            total = total + values[name] * along
        return total


def resultants(system: System, names: Container[str]) -> Iterator[Resultant]:
    """Resultants of the joints and constraints all of whose forces are among the names.

    Components along x, y, z are whole as they are. Others, normal forces and friction, are each along what a unit of it
    does to the first-named body, where all of them act at one place.
    """
    if not names:
        return
    motion = system.motion
    along = "xy" if system.scope.model.space == "plane" else "xyz"
    owners: dict[str, list[Component]] = {}
    for component in Axes(motion).components_of(system):
        if component.kind != "drive":
            owners.setdefault(component.owner, []).append(component)
    for owner, components in owners.items():
        seat, units = (
            _seat(system, owner),
            {f"reaction_{axis}({owner})": e for axis, e in zip(along, Matrix.IDENTITY, strict=False)},
        )
        if seat is not None and all(name in names for name in units):
            yield Resultant(owner, motion.position(seat), units)
        elif (contact := _contact(motion, components)) is not None and all(name in names for name in contact.units):
            yield contact
        yield from (pull for pull in _pulls(system, owner, components) if all(name in names for name in pull.units))


def _pulls(system: System, owner: str, components: Sequence[Component]) -> Iterator[Resultant]:
    """The tension of each strand of a string on the bodies at its ends, where it touches them; of a link the same."""
    tensions = {component.number: component for component in components if component.label == "tension"}
    constraint = system.scope.model.constraints.get(owner)
    if not tensions or constraint is None:
        return
    strands = constraint.strands_at(SystemScene(system.motion, f"constraints.{owner}"))
    for strand, number in zip(strands, constraint.strand_rows(), strict=True):
        for stop, at, along in zip((strand.first, strand.second), strand.ends, (strand.d, -strand.d), strict=True):
            if stop.body is not None and number in tensions:
                yield Resultant(owner, at, {tensions[number].name: along}, pulls=True)
    for component in tensions.values() if not strands else ():
        for effect in component.effects:
            pose, plane = system.motion.links[effect.link].pose, system.scope.model.space == "plane"
            if effect.place is not None and not all(map(is_zero, effect.force)):
                along = effect.force if plane else pose.R @ effect.force
                yield Resultant(owner, pose.point(effect.place), {component.name: along}, pulls=True)


def _contact(motion: Motion, components: Sequence[Component]) -> Resultant | None:
    """Resultant of the forces at one place along directions of their own; None of hinges, strings and placed bodies."""
    owner, on = components[0].owner, components[0].effects[0].link
    pose, plane = motion.links[on].pose, motion.scope.model.space == "plane"
    pushes = [(c.label, c.name, c.effects) for c in components]
    pushes += [(s.label, f"reaction_{s.label}({owner})", s.effects) for c in components for s in c.friction]
    places: set[Vector] = set()
    units: dict[str, Vector] = {}
    for label, name, effects in pushes:
        mine = [e for e in effects if e.link == on and not all(map(is_zero, e.force))]
        if not mine and label.startswith("couple"):
            continue
        if len(mine) != 1 or name in units or label[:1] not in ("n", "t", "s") or label == "tension":
            return None
        (push,) = mine
        if push.place is None:
            return None
        places.add(push.place + (push.beyond or Vector.ZERO))
        units[name] = push.force if plane else pose.R @ push.force
    return Resultant(owner, pose.point(places.pop()), units) if len(places) == 1 else None


def force_marks(system: System, forces: Iterable[tuple[Resultant, Vector]]) -> Iterator[Mark]:
    """Weights, forces of springs and dampers, and the resultant force of every joint and constraint, on the body that
    it holds."""
    yield from _given(system)
    for resultant, force in forces:
        yield Mark(ArrowForm(resultant.at, force, "N", outward=resultant.pulls), 0, "reaction", resultant.owner)


def _seat(system: System, owner: str) -> tuple[str | None, Vector] | None:
    """(body, place) at which a joint or constraint acts; None if at no single place."""
    motion = system.motion
    if owner in motion.index:
        return owner, motion.link(owner).point
    pushes = [push for row in system.constraints.rows if row.constraint == owner for push in row.pushes]
    return next((push.place for push in pushes if isinstance(push, PointForce)), None)
