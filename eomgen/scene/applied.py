"""Loads, reactions -> marks: arrows of what is applied, the field of gravity, forces of joints and ties."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from eomgen.mechanics.bodies.loads import in_ground_axes
from eomgen.mechanics.equations.system import System
from eomgen.model.forces.load import Couple, PointForce
from eomgen.scene.forms import ArrowForm, CoupleForm, FieldForm, LoadForm
from eomgen.scene.scene import Mark
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, times, vector_of


def field_marks(system: System) -> list[Mark]:
    """The direction of the weight."""
    g = system.loads.fields
    return [] if all(map(is_zero, g)) else [Mark(FieldForm(g, "g"), 0, "axes", "")]


def applied_marks(system: System) -> Iterator[Mark]:
    """Forces and couples at bodies, but for weights, springs and dampers, and drives of joints."""
    motion, model = system.motion, system.scope.model
    for applied in system.loads.applied:
        if model.forces[applied.name].element is not None:
            continue
        for spread in applied.spread:
            a, b = motion.position(spread.start), motion.position(spread.end)
            ends = _known(system, spread.at_start), _known(system, spread.at_end)
            yield Mark(LoadForm(a, b, *ends, applied.name), 0, "force", applied.name)
        for load in () if applied.spread else applied.loads:
            if isinstance(load, PointForce) and load.place[0] is not None:
                f = _known(system, in_ground_axes(motion, load.force, load.axes))
                at = motion.position(load.place)
                yield Mark(ArrowForm(at, f, "N", text=applied.name), 0, "force", applied.name)
            elif isinstance(load, Couple):
                at = motion.position(load.place or (load.body, ZERO))
                couple = _known(system, in_ground_axes(motion, load.couple, load.axes))
                yield Mark(CoupleForm(at, couple, applied.name), 0, "force", applied.name)
    yield from _drives(system)


def _known(system: System, v: Vector) -> Vector:
    """A load in which a number that is asked for is drawn as 1."""
    return vector_of(substituted(v, dict.fromkeys(system.symbols.unknowns.values(), 1)))


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
            along = apply(link.pose.R, times(value, w if turns else v))
            form = CoupleForm(at, along) if turns else ArrowForm(at, along, "N", outward=True)
            yield Mark(form, 0, "force", link.name)


def reaction_marks(system: System, values: Mapping[str, Scalar]) -> Iterator[Mark]:
    """The resultant force of every joint and tie, on the body that it holds, from its components `reaction_x(A)`."""
    components = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
    sums: dict[str, Vector] = {}
    for name, value in values.items():
        head, _, owner = name.rstrip(")").partition("(")
        axis = head.removeprefix("reaction_")
        if head.startswith("reaction_") and axis in components:
            x, y, z = sums.get(owner, ZERO)
            e = components[axis]
            sums[owner] = (x + value * e[0], y + value * e[1], z + value * e[2])
    motion = system.motion
    for owner, force in sums.items():
        place = _seat(system, owner)
        if place is not None:
            yield Mark(ArrowForm(motion.position(place), force, "N"), 0, "reaction", owner)


def _seat(system: System, owner: str) -> tuple[str | None, Vector] | None:
    """Where a joint or tie acts."""
    motion = system.motion
    if owner in motion.index:
        return owner, motion.link(owner).point
    pushes = [push for row in system.ties.rows if row.tie == owner for push in row.pushes]
    return next((push.place for push in pushes if isinstance(push, PointForce)), None)
