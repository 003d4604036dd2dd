"""System -> Scene: bodies, joints, ties, springs and names of a model, put together."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System, system_of
from eomgen.mechanics.statics.contacts_at_start import contacts_at_start
from eomgen.model.reader import ModelOrPath, model_at
from eomgen.model.trusses import is_node
from eomgen.scene.bodies import body_marks, piece_marks
from eomgen.scene.connections import force_elements, joint_marks, ordered, tie_marks
from eomgen.scene.forms import LabelForm
from eomgen.scene.scene import ROLES, Mark, Scene, SceneFrame
from eomgen.symbolic.expression.spatial import ZERO, Vector

UNNAMED = ("origin", "center", "start")  # points that need no letter


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
    points = tuple(named_points(system))
    marks += [
        Mark(LabelForm(name.rpartition(".")[2], at), 0, "point", name) for name, at in points if _has_letter(name)
    ]
    return Scene(system, tuple(frames), points, ordered(marks, ROLES), equations)


def scene_of(model: ModelOrPath) -> Scene:
    """What can be drawn of a model at a state, forces left out."""
    model = model_at(model)
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


def _has_letter(name: str) -> bool:
    return name.rpartition(".")[2] not in UNNAMED
