"""eomgen import: a robot of another program's file as a model file, with a list of omissions."""

from __future__ import annotations

import shlex
from dataclasses import replace

from eomgen import files, pipeline
from eomgen.documents import Document, lines_document
from eomgen.proof import robot_otherwise
from eomgen.robots import imported


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
    wrong = robot_otherwise(file, robot, lambda: pipeline.derive(made).graph)
    reported = tuple(f"left out: {each}" for each in robot.left_out)
    return replace(
        document, failed=wrong, notes=(*reported, *([f"now try: eomgen check {shlex.quote(output)}"] if output else ()))
    )
