"""eomgen codegen: a right-hand side, and the reactions, that compile as they are, with test vectors."""

from __future__ import annotations

from dataclasses import replace

from eomgen import pipeline
from eomgen.codegen import Role, targets_named
from eomgen.documents import Document, Lines, lines_document, plain_document, proven
from eomgen.generated import Generated, generate
from eomgen.model import Model
from eomgen.verbs.outcome import with_constraints_closed


def codegen_document(
    model: Model,
    *,
    stem: str,
    origin: str,
    targets: tuple[str, ...],
    directory: str,
    inverse: bool = False,
    actuated: tuple[str, ...] = (),
    jacobian: bool = False,
    regressor: bool = False,
    baumgarte: tuple[float, float] | None = None,
    integrator: bool = False,
    float32: bool = False,
    certify: bool = True,
) -> Document:
    """The right-hand side and the reactions as files that compile as they are; none where their proof fails.

    Args:
        targets: the languages; the files of one lie in the directory, of several each in a folder of its name.
        inverse: write inverse dynamics too, of the actuated coordinates, speeds, inputs or joints.
        jacobian: write the slopes of the right-hand side too.
        regressor: write Y, y0 and the columns of the base parameters too.
        baumgarte: alpha and beta of the feedback of gaps in the constraint rows [1/s]; None: without feedback.
        integrator: an integrator in C too.
        float32: single precision.
    """
    acting = actuated if inverse or actuated else None
    found = generate(
        model,
        targets,
        name=stem,
        origin=origin,
        actuated=acting,
        jacobian=jacobian,
        regressor=regressor,
        baumgarte=baumgarte,
        integrator=integrator,
        float32=float32,
    )
    certificate = found.certify() if certify else None
    refused = certificate is not None and certificate.ok is False
    paths = [] if refused else [str(path) for path in found.write(directory)]
    lines = ("no files were written",) if refused else tuple(paths)
    document = plain_document(model, lambda: _payload(found, paths), Lines(lines))
    document = with_constraints_closed(replace(document, notes=tuple(found.notes)), pipeline.derive(found.model).system)
    return proven(document, certificate)


def _payload(found: Generated, paths: list[str]) -> dict[str, object]:
    program, rhs, reactions, moved = found.motion[0], found.equations, found.reactions, found.inverse
    payload: dict[str, object] = {
        "name": found.model.name,
        "target": found.targets[0],
        "targets": list(found.targets),
        "files": paths,
        "operations": program.count.total,
        "hoisted_operations": program.count.hoisted,
        "coordinates": list(rhs.coordinates),
        "speeds": list(rhs.speeds),
        "parameters": list(rhs.parameters),
        "inputs": list(rhs.inputs),
        "reactions": list(reactions[1].outputs) if reactions else None,
        "reaction_operations": reactions[0].count.total if reactions else None,
    }
    for role in (Role.OUTPUTS, Role.MATRICES, Role.JACOBIAN, Role.REGRESSOR):
        if role in found.functions:
            program, reported = found.functions[role]
            payload[role.word] = list(reported.outputs or [name for name, *_ in reported.blocks])
            payload[f"{role.word}_operations"] = program.count.total
    if moved:
        payload |= {"actuated": list(moved[1].outputs), "inverse_operations": moved[0].count.total}
    return payload


def languages() -> Document:
    """The targets that there are, a line each."""
    found = [{"name": target.name, "about": target.about} for target in targets_named()]
    return lines_document(lambda: {"targets": found}, *(f"{each['name']:10} {each['about']}" for each in found))
