"""System -> Scene: bodies, joints, ties, springs and names of a model, put together."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.bodies.kinematics import BodyLink
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System, system_of
from eomgen.mechanics.formulations.massless_nodes import with_nodes_balanced
from eomgen.mechanics.statics.contacts_at_start import contacts_at_start
from eomgen.model.reader import ModelOrPath, model_at
from eomgen.model.trusses import is_node
from eomgen.scene.anchors import drive_marks
from eomgen.scene.applied import applied_marks, field_marks
from eomgen.scene.bodies import body_marks, piece_marks, places_of_body, without_veils
from eomgen.scene.connections import force_elements, joint_marks, ordered, tie_marks
from eomgen.scene.forms import AxesForm, LabelForm
from eomgen.scene.scene import ROLES, Mark, Scene, SceneFrame
from eomgen.scene.sizes import size_marks
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector, plus, times


def scene_of_system(system: System, equations: EquationsOfMotion | None = None) -> Scene:
    """What can be drawn of a system at a state.

    Args:
        equations: of motion: applied forces and reactions are drawn too.
    """
    motion = system.motion
    frames = [SceneFrame(""), *(SceneFrame(link.name, -1, link.pose) for link in motion.links)]
    marks: list[Mark] = []
    for k, link in enumerate(motion.links, start=1):
        marks += body_marks(system, link, k)
        pieces, drawn = piece_marks(system, link.name, k, len(frames))
        frames += pieces
        marks += drawn + joint_marks(system, link, k)
    marks += tie_marks(system) + force_elements(system)
    marks = without_veils(marks, alone=len(motion.links) == 1)
    marks += [
        *size_marks(system, marks),
        *drive_marks(system),
        *field_marks(system),
        *applied_marks(system),
        *name_marks(system),
    ]
    if system.scope.model.space == "space":
        marks.append(Mark(AxesForm(ZERO), 0, "axes", ""))
    points = tuple(named_points(system))
    return Scene(system, tuple(frames), points, ordered(marks, ROLES), equations)


def scene_of(model: ModelOrPath) -> Scene:
    """What can be drawn of a model at a state, forces left out."""
    model = with_nodes_balanced(model_at(model))
    return scene_of_system(system_of(model, contacts_at_start(model).modes))


def named_points(system: System) -> Iterator[tuple[str, Vector]]:
    """Every named point of the ground and of bodies by its whole name, ground axes [m]."""
    motion, model = system.motion, system.scope.model
    for name, place in model.points.items():
        yield name, motion.scope.vector(place)
    for link in motion.links:
        if is_node(link.name):
            yield link.name, link.pose.p
            continue
        for name in model.body_points(link.name):
            yield f"{link.name}.{name}", motion.position((link.name, motion.points[link.name].get(name, ZERO)))


def name_marks(system: System) -> Iterator[Mark]:
    """The letters of points that somebody named, and the names of bodies."""
    motion, model = system.motion, system.scope.model
    for name, place in model.points.items():
        yield Mark(LabelForm(name, motion.scope.vector(place)), 0, "point", name)
    for k, link in enumerate(motion.links, start=1):
        if is_node(link.name):
            yield Mark(LabelForm(link.name.rpartition(".")[2], ZERO), k, "point", link.name)
            continue
        for name in model.bodies[link.name].points:
            yield Mark(LabelForm(name, motion.points[link.name][name]), k, "point", f"{link.name}.{name}")
        yield Mark(LabelForm(link.name, _middle(system, link)), k, "label", link.name)


def _middle(system: System, link: BodyLink) -> Vector:
    """Where a body's name stands: at its mass centre, else half-way along its middle piece."""
    if (center := system.motion.points[link.name].get("center")) is not None:
        return center
    places = places_of_body(system, link) or [ZERO]
    half = len(places) // 2
    return times(Fraction(1, 2), plus(places[max(half - 1, 0)], places[min(half, len(places) - 1)]))
