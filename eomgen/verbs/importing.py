"""eomgen import: a robot of another program's file as a model file, with a list of omissions."""

from __future__ import annotations

import shlex
from dataclasses import replace

from eomgen import files
from eomgen.documents import Document, lines_document
from eomgen.pipeline import derive
from eomgen.proof import imported_otherwise, mjcf_otherwise, sdf_otherwise, without_units
from eomgen.robots import ImportedRobot, first_element, imported

MOST_COMPARED = 20  # coordinates of a robot whose forces are derived to be compared
OTHERWISE = {"robot": imported_otherwise, "sdf": sdf_otherwise}


def import_document(
    file: str, *, output: str | None = None, floating: bool = False, model: str | None = None
) -> Document:
    """The model file, written where an output is given; and the parts of the robot's file without a counterpart in it.

    Raises:
        ModelError: no robot can be read from the file.
        WriteFailed: it cannot be written.
    """
    robot = imported(file, floating=floating, model=model)
    made, left_out = robot.model, [each.as_dict() for each in robot.left_out]
    if output is not None:
        files.write(output, robot.text)
    entries = {
        "name": made.name,
        "file": output,
        "text": None if output else robot.text,
        "bodies": list(made.bodies),
        "coordinates": list(made.coordinates),
        "inputs": list(made.inputs),
        "constraints": list(made.constraints),
        "left_out": left_out,
    }
    document = lines_document(lambda: entries, *([output] if output else robot.text.splitlines()))
    wrong = _otherwise(file, robot)
    reported = tuple(f"left out: {each}" for each in robot.left_out)
    return replace(
        document, failed=wrong, notes=(*reported, *([f"now try: eomgen check {shlex.quote(output)}"] if output else ()))
    )


def _otherwise(file: str, robot: ImportedRobot) -> str:
    """First difference between a robot's file, read in another way, and the model; "" if there is none."""
    root = first_element(robot.source)
    if bare := without_units(robot.model):
        return bare
    if root == "mujoco":
        small = len(robot.model.coordinates) <= MOST_COMPARED
        equations = derive(robot.model).graph if small and robot.model.coordinates else None
        left = [(each.what, each.where) for each in robot.left_out if each.nearest is not None]
        return mjcf_otherwise(file, robot.source, robot.model, equations, left)
    return OTHERWISE[root](robot.source, robot.model) if root in OTHERWISE else ""
